/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/correlation.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/periodic.h"
#include "geometry/vec3.h"

static double edge(double rmax, size_t bins, size_t k) {
  return rmax * (double)k / (double)bins;
}

static double ball(double r) {
  return 4 * M_PI / 3 * gsl_pow_3(r);
}

static int count_pairs(size_t n, const double *x, const double period[3],
                       double rmax, size_t bins, double *pairs) {
  struct periodic_pairs near = {0};
  const int status = periodic_pairs_find(&near, n, x, rmax, period);
  for (size_t p = 0; p < near.near.count; p++) {
    size_t i, j;
    double u[3];
    if (!periodic_pair(&near, p, &i, &j, u) || i == j)
      continue;
    const double at = vec3_norm(u) / rmax * (double)bins;
    if (at < (double)bins)
      pairs[(size_t)at]++;
  }
  periodic_pairs_free(&near);
  return status;
}

/* Adds the shells around one point: whole ones up to the nearest face, then
   differences of clipped balls. whole[k]: points whose shell k is whole. */
static void add_shells(const double x[3], const struct region *region,
                       double rmax, size_t bins, double *volume,
                       double *whole) {
  const double nearest = region_depth(region, x);
  size_t k = 0;
  for (; k < bins && edge(rmax, bins, k + 1) <= nearest; k++)
    whole[k]++;
  double inner = ball(edge(rmax, bins, k));
  for (; k < bins; k++) {
    const double outer = region_ball(region, x, edge(rmax, bins, k + 1));
    volume[k] += outer - inner;
    inner = outer;
  }
}

int correlation_count(size_t n, const double *x, const struct region *region,
                      double rmax, size_t bins, const struct observer *observer,
                      double *pairs, double *expected) {
  double *count = calloc(3 * bins + 1, sizeof *count);
  if (!count)
    return GSL_ENOMEM;
  double *volume = count + bins, *whole = volume + bins;
  const int status = count_pairs(n, x, region->period, rmax, bins, count);
  if (status != GSL_SUCCESS) {
    free(count);
    return status;
  }
  for (size_t i = 0; i < n; i++) {
    observer_tell(observer, i, n);
    add_shells(x + 3 * i, region, rmax, bins, volume, whole);
  }
  const double density = n ? ((double)n - 1) / region_volume(region) : 0;
  for (size_t k = 0; k < bins; k++) {
    const double shell =
        ball(edge(rmax, bins, k + 1)) - ball(edge(rmax, bins, k));
    pairs[k] = count[k];
    expected[k] = 0.5 * density * (volume[k] + whole[k] * shell);
  }
  free(count);
  return GSL_SUCCESS;
}
