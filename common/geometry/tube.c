/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Planes across the axis cut the ball in discs and the cylinder in one disc,
   whose common part is a lens. Where one disc holds the other the integral over
   the planes is elementary; between, the lens begins and ends with a power 3/2
   of the height, and the substitution z = c + h (3 u - u^3)/2, whose slope is
   zero at u = +-1, makes it smooth. */
#include "geometry/tube.h"

#include <math.h>
#include <stddef.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>

/* Area common to discs of radii s and R, a apart. */
static double lens_area(double s, double R, double a) {
  if (a + s <= R)
    return M_PI * s * s;
  if (a + R <= s)
    return M_PI * R * R;
  if (a >= s + R)
    return 0;
  /* distances of the common chord from both centres */
  const double x = (a * a + (s - R) * (s + R)) / (2 * a), y = a - x;
  const double half = sqrt(fmax(0, (s - x) * (s + x)));
  return s * s * atan2(half, x) + R * R * atan2(half, y) - a * half;
}

struct lenses {
  double away, R, r, middle, half;
};

static double lens_at(double u, void *params) {
  const struct lenses *l = params;
  const double z = l->middle + l->half * u * (3 - u * u) / 2;
  const double s = sqrt(fmax(0, (l->r - z) * (l->r + z)));
  return lens_area(s, l->R, l->away) * l->half * 1.5 * (1 - u) * (1 + u);
}

/* From z = from to until, 0 <= from, where discs cross. */
static double lenses_between(double away, double R, double r, double from,
                             double until) {
  if (!(from < until))
    return 0;
  struct lenses l = {away, R, r, (from + until) / 2, (until - from) / 2};
  gsl_function f = {lens_at, &l};
  double volume = 0, error;
  size_t count;
  /* the best that 87 points give, should that be less than is asked for */
  gsl_integration_qng(&f, -1, 1, 1e-11 * gsl_pow_3(r), 0, &volume, &error,
                      &count);
  return volume;
}

/* Between the planes z = 0 and z, 0 <= z <= r. */
static double upper_part(double away, double R, double r, double z) {
  /* below `full` the cylinder's disc is whole, above `whole` the ball's */
  const double apart = fabs(R - away), sum = R + away;
  const double full = r > sum ? sqrt((r - sum) * (r + sum)) : 0;
  const double whole = r > apart ? sqrt((r - apart) * (r + apart)) : 0;
  double volume = M_PI * R * R * fmin(z, full);
  volume += lenses_between(away, R, r, full, fmin(z, whole));
  if (z > whole && away < R)
    volume +=
        M_PI * (z - whole) * (r * r - (z * z + z * whole + whole * whole) / 3);
  return volume;
}

double tube_ball_volume(double away, double R, double low, double high,
                        double r) {
  const double a = fmax(-r, fmin(r, low)), b = fmax(-r, fmin(r, high));
  return copysign(upper_part(away, R, r, fabs(b)), b) -
         copysign(upper_part(away, R, r, fabs(a)), a);
}
