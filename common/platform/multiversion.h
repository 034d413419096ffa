/* SPDX-License-Identifier: GPL-2.0-or-later */
/* MULTIVERSION before a function compiles its plain loops for several
   instruction sets; the loader takes the best that the machine has. Needs a
   loader that chooses (glibc) and a compiler that knows the levels by name; not
   under the sanitizers, which are not up yet when it chooses. */
#ifndef MULTIVERSION_H
#define MULTIVERSION_H

#include <limits.h> /* says which C library this is */

#if defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MULTIVERSION_OFF
#endif
#endif

#if defined __x86_64__ && defined __GLIBC__ && defined __GNUC__ &&             \
    __GNUC__ >= 12 && !defined __clang__ && !defined __SANITIZE_ADDRESS__ &&   \
    !defined __SANITIZE_THREAD__ && !defined MULTIVERSION_OFF
#define MULTIVERSION                                                           \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define MULTIVERSION
#endif

#endif
