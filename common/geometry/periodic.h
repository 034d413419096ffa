/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Periodic axes: what leaves at one side comes in at the other. period: the
   length along each axis, 0 where it is not periodic (m); places may be
   anywhere along it. Not in the paper. Safe in any thread. Tested in
   tests/test_containers.c. */
#ifndef PERIODIC_H
#define PERIODIC_H

#include <math.h>
#include <stdbool.h>
#include "geometry/neighbors.h"
#include "geometry/vec3.h"

static inline bool periodic_any(const double period[3]) {
  return period[0] > 0 || period[1] > 0 || period[2] > 0;
}

/* Makes u, from a place to another, the way to its nearest image. */
static inline void periodic_nearest(const double period[3], double u[3]) {
  for (int k = 0; k < 3; k++)
    if (period[k] > 0)
      u[k] -= period[k] * rint(u[k] / period[k]);
}

/* Puts a place into the cell from 0 to period. */
static inline void periodic_wrap(const double period[3], double x[3]) {
  for (int k = 0; k < 3; k++)
    if (period[k] > 0) {
      x[k] -= period[k] * floor(x[k] / period[k]);
      if (x[k] >= period[k]) /* just below 0, rounded */
        x[k] = 0;
    }
}

/* Is any image of a place in the box, faces included? */
static inline bool periodic_in_box(const double period[3], const double box[6],
                                   const double x[3]) {
  for (int k = 0; k < 3; k++) {
    const double low = box[2 * k], high = box[2 * k + 1];
    double at = x[k];
    if (period[k] > 0 && !(at >= low && at <= high))
      at -= period[k] * floor((at - low) / period[k]);
    if (!(at >= low && at <= high))
      return false;
  }
  return true;
}

/* As neighbors_find, of each sphere and the nearest image of each other. reach
   and two radii are to come to less than half of a period for that to be all
   there is. */
int periodic_find(struct neighbors *nb, size_t n, const double *x,
                  size_t stride, const double *radius, double reach,
                  const double period[3]);

/* Spheres, then images of them: image k is of sphere of[k]. Begins as zeros. */
struct periodic_images {
  size_t count, size;
  double *x, *radius;
  uint32_t *of;
};
void periodic_images_free(struct periodic_images *m);

/* All images that reach into a box along the periodic axes, the spheres
   themselves among them if they do: what fills it. GSL_ERANGE if they are more
   than 10^7, GSL_ENOMEM. */
int periodic_images_in_box(struct periodic_images *m, size_t n, const double *x,
                           const double *radius, const double period[3],
                           const double box[6]);

/* All pairs of points and images of points within reach, each once, however
   long reach is beside a period; a point and an image of itself are a pair.
   Begins as zeros. */
struct periodic_pairs {
  size_t n; /* points, the first of the images */
  struct periodic_images images;
  struct neighbors near; /* of images; for periodic_pair */
};
/* Returns as neighbors_find does. */
int periodic_pairs_find(struct periodic_pairs *p, size_t n, const double *x,
                        double reach, const double period[3]);
/* The two points of pair k < p->near.count, and the way u from one to the
   other's image (m). False where that is no pair: two images, which are a pair
   of others again. */
static inline bool periodic_pair(const struct periodic_pairs *p, size_t k,
                                 size_t *i, size_t *j, double u[3]) {
  const size_t a = p->near.i[k], b = p->near.j[k];
  if (a >= p->n)
    return false;
  *i = a;
  *j = p->images.of[b];
  vec3_sub(p->images.x + 3 * a, p->images.x + 3 * b, u);
  return true;
}
void periodic_pairs_free(struct periodic_pairs *p);

#endif
