/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Power cells of discs and balls, for volume.c and area.c. A point is in
   the cell of the ball to which its power |x - c|^2 - r^2 is least, so that the
   cells share out space and the union of the balls is the sum of what each has
   of its own cell: Avis, Bhattacharya, Imai, The Visual Computer 3 (1988) 323.
   Not in the paper. Lengths in m. Reading is safe in any thread. Tested in
   tests/test_volume.c and tests/test_area.c. */
#ifndef POWER_H
#define POWER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Balls that reach a place. Sphere i's partners, those that it touches or
   overlaps, are partner[start[i]] ... partner[start[i + 1] - 1]. */
struct power {
  int dim;       /* 2: discs, whose third coordinate is 0; 3: balls */
  size_t n;      /* of those that reach the place */
  double *x, *r; /* 3n, n */
  size_t *start; /* n + 2 */
  uint32_t *partner;
  size_t most; /* partners of a ball */
};

/* Takes those of n balls (x: dim n, r: n) that reach a place, and finds their
   partners. Returns GSL_SUCCESS, GSL_EINVAL for numbers that are not finite,
   GSL_ENOMEM. */
int power_alloc(struct power **out, int dim, size_t n, const double *x,
                const double *r,
                bool (*reaches)(const double *c, double r, const void *place),
                const void *place);
void power_free(struct power *p);

/* The space around ball i that partner j leaves: the half-space {y:
   plane[0..2].(y - x_i) <= plane[3]} with a unit normal; or, where the two are
   concentric to rounding, ALL or NONE of it. Of equals the first one stays. */
enum power_leaves { POWER_HALF, POWER_ALL, POWER_NONE };
enum power_leaves power_plane(const struct power *p, size_t i, size_t j,
                              double plane[4]);

#endif
