/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Operations on double[3]: coordinates in metres, or any other unit that the
   caller uses throughout. Pure inline functions, safe in any thread. */
#ifndef VEC3_H
#define VEC3_H

#include <math.h>

static inline double vec3_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; c may not be a or b. */
static inline void vec3_cross(const double a[3], const double b[3],
                              double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double vec3_norm(const double a[3]) {
  return sqrt(vec3_dot(a, a));
}

/* c = a - b */
static inline void vec3_sub(const double a[3], const double b[3], double c[3]) {
  for (int k = 0; k < 3; k++)
    c[k] = a[k] - b[k];
}

/* A unit vector across a: a x the axis that a has least of. */
static inline void vec3_across(const double a[3], double u[3]) {
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(a[k]) < fabs(a[least]))
      least = k;
  double other[3] = {0, 0, 0};
  other[least] = 1;
  vec3_cross(a, other, u);
  const double norm = vec3_norm(u);
  for (int k = 0; k < 3; k++)
    u[k] /= norm;
}

/* y += s x */
static inline void vec3_axpy(double s, const double x[3], double y[3]) {
  for (int k = 0; k < 3; k++)
    y[k] += s * x[k];
}

#endif
