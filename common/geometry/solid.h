/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solid of a bed that is handed on: spheres, bridges between them, and the
   container around; and its exact volume in a box. Not in the
   paper. Lengths in m, volumes in m^3, boxes {x0, x1, y0, y1, z0, z1}.

   A bridge is a cylinder about the line of two centres, from one to the other,
   with a radius below those of its spheres. Its ends are within them, so that
   what it adds is a collar around the contact.

   Safe in any thread. Tested in tests/test_solid.c. */
#ifndef SOLID_H
#define SOLID_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "geometry/container.h"
#include "geometry/line.h"
#include "geometry/vec3.h"

struct solid {
  size_t n;
  const double *x, *r; /* centres, 3n, and radii, n */
  size_t bridges;
  const uint32_t (*ends)[2]; /* each bridge's spheres, two different ones */
  double bridge_radius;
  const struct container *container; /* what is beyond is solid; NULL: none */
};

/* Parts of the volume that share no point, and an estimate of the error beyond
   rounding: bridges that meet more than their own two spheres, and what of
   spheres is beyond a tube, are integrated numerically. */
struct solid_volume {
  double total, spheres, bridges, walls, error;
};

/* Volume of the solid within a box. Returns GSL_SUCCESS, GSL_EINVAL for
   numbers that are not finite, GSL_EDOM for a bridge whose radius is not below
   its spheres', GSL_ENOMEM. */
int solid_volume(const struct solid *s, const double box[6],
                 struct solid_volume *volume);

/* Mean over a box of a phase field that is diffuse at the spheres' surfaces:
   (1 - tanh(d / (2 xi)))/2, d the distance to the nearest surface, negative
   inside, as |x - c| - r has it; the largest value where spheres overlap. The
   points with d < s are the union of balls of radius r + s, whose volumes V(s)
   are exact, so the mean is int V(s) sech^2(s / (2 xi)) / (4 xi) ds by the
   box's volume. xi above 0. Relative error below 1e-5. Returns GSL_SUCCESS,
   GSL_EINVAL, GSL_ENOMEM. */
int solid_diffuse(size_t n, const double *x, const double *r,
                  const double box[6], double xi, double *mean);

/* Pairs of spheres to bridge, those whose gap is at most reach (m); to be
   freed. Returns GSL_SUCCESS, GSL_EINVAL as neighbors_find, GSL_ENOMEM. */
int solid_pairs(size_t n, const double *x, const double *r, double reach,
                uint32_t (**ends)[2], size_t *count);

/* Moves the bridges that add anything to the spheres to the front of ends,
   which s->ends may be, in their order; how many. Others lie within the circle
   in which their spheres meet. */
size_t solid_visible(const struct solid *s, uint32_t (*ends)[2]);

/* The factor, at most 1, that makes no two spheres nearer than gap (m) if every
   radius is multiplied by it. Returns GSL_SUCCESS, GSL_EDOM if there is none
   above 0, GSL_EINVAL, GSL_ENOMEM. */
int solid_shrink(size_t n, const double *x, const double *r, double gap,
                 double *factor);

/* Distances to surfaces, negative inside (m). */
static inline double solid_ball_distance(const double c[3], double r,
                                         const double p[3]) {
  double d[3];
  vec3_sub(p, c, d);
  return vec3_norm(d) - r;
}

/* Of a cylinder from a to b. */
static inline double solid_cylinder_distance(const double a[3],
                                             const double b[3], double radius,
                                             const double p[3]) {
  double axis[3], d[3];
  vec3_sub(b, a, axis);
  vec3_sub(p, a, d);
  const double length = vec3_norm(axis), along = vec3_dot(d, axis) / length;
  vec3_axpy(-along / length, axis, d);
  const double side = vec3_norm(d) - radius;
  const double end = fmax(-along, along - length);
  if (side <= 0 && end <= 0)
    return fmax(side, end);
  return hypot(fmax(side, 0), fmax(end, 0));
}

/* As line_ball, of a cylinder from a to b. */
static inline bool solid_line_cylinder(const double a[3], const double b[3],
                                       double radius, const double p[3],
                                       const double e[3], double t[2]) {
  double axis[3], d[3], across[3] = {e[0], e[1], e[2]};
  vec3_sub(b, a, axis);
  vec3_sub(p, a, d);
  const double square = vec3_dot(axis, axis);
  const double along = vec3_dot(d, axis) / square;
  const double slope = vec3_dot(e, axis) / square;
  vec3_axpy(-along, axis, d);
  vec3_axpy(-slope, axis, across);
  t[0] = -INFINITY;
  t[1] = INFINITY;
  static const double none[3];
  if (vec3_dot(across, across) > 1e-24 * vec3_dot(e, e)) {
    if (!line_ball(none, radius, d, across, t))
      return false;
  } else if (vec3_dot(d, d) >= radius * radius) {
    return false;
  }
  if (fabs(slope) * sqrt(square) > 1e-12 * vec3_norm(e)) {
    const double first = -along / slope, last = (1 - along) / slope;
    t[0] = fmax(t[0], fmin(first, last));
    t[1] = fmin(t[1], fmax(first, last));
  } else if (along < 0 || along > 1) {
    return false;
  }
  return t[0] < t[1];
}

/* Length of the part of [low, high] that intervals cover; sorts them. */
double solid_covered(size_t count, double (*interval)[2], double low,
                     double high);

#endif
