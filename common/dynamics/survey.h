/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a state's contacts say in one pass over the list: energies, the deepest
   overlap and the spheres' places before the walls. Internal to dynamics.c.
   Safe in any thread. Tested in tests/test_watch.c. */
#ifndef SURVEY_H
#define SURVEY_H

#include "dynamics/dynamics.h"
#include "dynamics/kernel.h"

/* Of n rows y; rows, not spheres, in s->sphere. */
void survey_take(const struct kernel_data *k, size_t n, const double *y,
                 struct dynamics_survey *s);

#endif
