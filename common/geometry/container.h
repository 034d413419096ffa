/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The container of a bed that is handed on: a convex region between planes and
   within a tube; what is beyond is solid. Not in the paper. Lengths in m, boxes
   {x0, x1, y0, y1, z0, z1}. Safe in any thread. Tested in
   tests/test_container.c. */
#ifndef CONTAINER_H
#define CONTAINER_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include "geometry/box.h"
#include "geometry/vec3.h"

struct container {
  double box[6]; /* planes along the axes, infinite where there is none */
  size_t planes;
  const double (*plane)[4]; /* others: inside, plane[0..2].x <= plane[3], with
                               a unit normal */
  double radius;            /* of the tube; 0: none */
  double point[3], axis[3]; /* on its axis, and a unit vector along it */
};

/* All of space. */
static inline struct container container_none(void) {
  return (struct container){
      .box = {-INFINITY, INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY}};
}

/* Does it end at more than planes along the axes? */
static inline bool container_slants(const struct container *c) {
  return c->planes > 0 || c->radius > 0;
}

/* From p to the tube's axis, and its length. */
static inline double container_away(const struct container *c,
                                    const double p[3], double d[3]) {
  vec3_sub(p, c->point, d);
  vec3_axpy(-vec3_dot(d, c->axis), c->axis, d);
  return vec3_norm(d);
}

/* Distance to the planes and the tube that are not along the axes, and to all
   of them; negative beyond, and no longer exact there. No distance changes by
   more than the way. */
static inline double container_slant_distance(const struct container *c,
                                              const double p[3]) {
  double d[3], least = INFINITY;
  for (size_t k = 0; k < c->planes; k++)
    least = fmin(least, c->plane[k][3] - vec3_dot(c->plane[k], p));
  if (c->radius > 0)
    least = fmin(least, c->radius - container_away(c, p, d));
  return least;
}

static inline double container_distance(const struct container *c,
                                        const double p[3]) {
  return fmin(box_distance(c->box, p), container_slant_distance(c, p));
}

/* Where the line p + t e, for any e but 0, runs inside: t[0] < t < t[1]. False
   if nowhere. */
bool container_line(const struct container *c, const double p[3],
                    const double e[3], double t[2]);

/* Volume of its part in a box: exact for planes along the axes, else an
   integral over slices of exact areas, to rounding of the box. Returns
   GSL_SUCCESS, GSL_EINVAL for numbers that are not finite, GSL_ENOMEM. */
int container_volume(const struct container *c, const double box[6],
                     double *volume);

#endif
