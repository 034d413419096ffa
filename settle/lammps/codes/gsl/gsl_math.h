/* SPDX-License-Identifier: GPL-2.0-or-later */
/* See gsl_errno.h: what the sources of rkc and of the kernel use beside C's own
   library. */
#ifndef CODES_GSL_MATH_H
#define CODES_GSL_MATH_H

#include <float.h>
#include <math.h>

#define GSL_NAN ((double)NAN)
#define GSL_DBL_EPSILON DBL_EPSILON
#define GSL_MIN(a, b) ((a) < (b) ? (a) : (b))
#define GSL_MAX(a, b) ((a) > (b) ? (a) : (b))

static inline int gsl_finite(double x) {
  return isfinite(x);
}

static inline double gsl_pow_int(double x, int n) {
  return pow(x, n);
}

#endif
