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

/* As neighbors_find, of each sphere and the nearest image of each other. reach
   and two radii are to come to less than half of a period for that to be all
   there is. */
int periodic_find(struct neighbors *nb, size_t n, const double *x,
                  size_t stride, const double *radius, double reach,
                  const double period[3]);

#endif
