/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/hard.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>

static int check(size_t n, const double kr[], const double fraction[]) {
  double least = GSL_POSINF, most = 0;
  for (size_t k = 0; k < n; k++) {
    if (!(kr[k] > 0) || !isfinite(kr[k]) || !isfinite(fraction[k]))
      return GSL_EINVAL;
    least = GSL_MIN(least, kr[k]);
    most = GSL_MAX(most, kr[k]);
  }
  if (n < 2)
    return GSL_EINVAL;
  return most > (1 + 1e-9) * least ? GSL_SUCCESS : GSL_EDOM;
}

int hard_limit_fit(size_t n, const double kr[], const double fraction[],
                   double deviation, struct hard_limit *out) {
  const int status = check(n, kr, fraction);
  if (status != GSL_SUCCESS)
    return status;
  double *softness = malloc(n * sizeof *softness);
  if (!softness)
    return GSL_ENOMEM;
  for (size_t k = 0; k < n; k++)
    softness[k] = 1 / kr[k];
  double u, c, uu, uc, cc, squares;
  gsl_fit_linear(softness, 1, fraction, 1, n, &u, &c, &uu, &uc, &cc, &squares);
  double error, quantile;
  if (n == 2) {
    /* two points are met exactly: U = (x2 y1 - x1 y2)/(x2 - x1) */
    error = deviation * hypot(softness[0], softness[1]) /
            fabs(softness[0] - softness[1]);
    quantile = gsl_cdf_ugaussian_Pinv(0.975);
  } else {
    deviation = sqrt(squares / (double)(n - 2));
    error = sqrt(uu);
    quantile = gsl_cdf_tdist_Pinv(0.975, (double)(n - 2));
  }
  free(softness);
  *out = (struct hard_limit){.value = u,
                             .low = u - quantile * error,
                             .high = u + quantile * error,
                             .slope = c,
                             .deviation = deviation};
  return GSL_SUCCESS;
}
