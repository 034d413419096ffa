/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expectations of others for the random close packing of hard spheres without
   friction, by their sizes alone: figures to hold a bed against. Not in the
   paper. Safe in any thread. Tested in tests/test_mixture.c. */
#ifndef CLOSE_PACKING_H
#define CLOSE_PACKING_H

#include <stddef.h>

/* Any sizes: R. S. Farr, R. D. Groot, J. Chem. Phys. 131 (2009) 244104, within
   0.01 up to size ratios of 10 by their account. Chords of the spheres are rods
   on a line, which are put one by one, the longest first, into the widest gap;
   two neighbours keep at least 0.7654 of the shorter one apart. The rods' share
   of the line is the fraction, 0.6435 for equal spheres. r: n radii, n > 0.
   GSL_SUCCESS, GSL_ENOMEM. */
int close_packing_rods(size_t n, const double r[], double *fraction);

/* Spread of the radii: standard deviation by mean, and skewness, 0 where all
   are equal. */
void close_packing_spread(size_t n, const double r[], double *deviation,
                          double *skewness);

/* Narrow distributions, deviation up to 0.4: 0.634 + 0.0658 d + 0.0857 S d^2,
   K. W. Desmond, E. R. Weeks, Phys. Rev. E 90 (2014) 022204. */
double close_packing_spread_fraction(double deviation, double skewness);

#endif
