/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of hard contacts from beds of soft ones, whose fraction follows
   union = U + c/(kappa r) from kappa r = 30 on (measured, docs/softness.md).
   Not in the paper. Safe in any thread. Tested in tests/test_hard.c. */
#ifndef HARD_H
#define HARD_H

#include <stddef.h>

struct hard_limit {
  double value, low, high; /* U and the ends of its 95 % interval */
  double slope;            /* c */
  double deviation;        /* standard deviation of a bed from the law */
};

/* The fit to n beds by least squares; two of different kappa r determine it.
   deviation: that of one bed by chance, which counts where there are only two
   beds; from three on it is that of the fit, and the interval is by Student's
   distribution. GSL_EINVAL if n < 2, a number is not finite or a kr not
   positive, GSL_EDOM if all kr are one, GSL_ENOMEM. */
int hard_limit_fit(size_t n, const double kr[], const double fraction[],
                   double deviation, struct hard_limit *out);

#endif
