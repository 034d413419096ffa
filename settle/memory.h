/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run takes of memory, before hours are spent on it. Tested in
   tests/test_limits.sh. */
#ifndef MEMORY_H
#define MEMORY_H

#include "settings.h"

/* Exits with EXIT_IO where a run of so many spheres takes more than it may
   have, and warns where it takes more than nobody uses. */
void memory_check(const struct settings *s, size_t spheres);

#endif
