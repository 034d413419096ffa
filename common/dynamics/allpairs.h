/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's own way to evaluate forces: for each sphere every other one, so
   each pair twice, and every wall. The baseline of the benchmarks. Internal to
   dynamics.c. */
#ifndef ALLPAIRS_H
#define ALLPAIRS_H

#include "dynamics/kernel.h"

/* Rates of spheres [from, to) of n; false if they are not all finite. */
bool allpairs_rates(const struct kernel_data *k, size_t walls, size_t n,
                    const double *y, double *dydt, size_t from, size_t to);

#endif
