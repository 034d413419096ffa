/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines through balls. Lengths in m. Pure inline functions, safe in any thread.
   Tested in tests/test_solid.c. */
#ifndef LINE_H
#define LINE_H

#include <math.h>
#include <stdbool.h>
#include "geometry/vec3.h"

/* Where the line p + t e, for any e but 0, runs inside: t[0] < t < t[1]. False
   if nowhere. */
static inline bool line_ball(const double c[3], double r, const double p[3],
                             const double e[3], double t[2]) {
  double d[3];
  vec3_sub(p, c, d);
  const double a = vec3_dot(e, e), b = vec3_dot(d, e);
  const double rest = vec3_dot(d, d) - r * r, square = b * b - a * rest;
  if (!(square > 0))
    return false;
  /* neither root by a difference */
  const double q = -(b + copysign(sqrt(square), b));
  t[0] = fmin(q / a, rest / q);
  t[1] = fmax(q / a, rest / q);
  return true;
}

#endif
