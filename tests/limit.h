/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An end to loops without end: by CPU time, since a busy machine is no fault.
   For files that define _POSIX_C_SOURCE. */
#ifndef LIMIT_H
#define LIMIT_H

#include <sys/resource.h>

/* Has SIGXCPU end this program after this CPU time of all threads: many times
   what it needs. */
static inline void limit_cpu(unsigned seconds) {
  setrlimit(RLIMIT_CPU, &(struct rlimit){seconds, seconds + 1});
}

#endif
