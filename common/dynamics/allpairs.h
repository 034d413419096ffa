/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's own way to evaluate forces: for each sphere every other one, so
   each pair twice, and every wall. The baseline of the benchmarks. Internal to
   dynamics.c. */
#ifndef ALLPAIRS_H
#define ALLPAIRS_H

#include "dynamics/contact_list.h"

/* Rates of rows [from, to); false if they are not all finite. Of the list only
   what is the scene's and the spheres' is used, not its contacts. Safe in any
   thread. Tested in tests/test_dynamics.c. */
bool allpairs_rates(const struct contact_list *list, const double *y,
                    double *dydt, size_t from, size_t to);

#endif
