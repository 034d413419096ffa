/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Boxes {x0, x1, y0, y1, z0, z1} along the axes (m). Pure inline functions,
   safe in any thread. Tested in tests/test_analyze_structure.sh
   and tests/test_solid.c. */
#ifndef BOX_H
#define BOX_H

#include <math.h>
#include <stdbool.h>

/* Whether x is within the box, its faces included. */
static inline bool box_holds(const double box[6], const double x[3]) {
  for (int k = 0; k < 3; k++)
    if (!(x[k] >= box[2 * k] && x[k] <= box[2 * k + 1]))
      return false;
  return true;
}

/* Whether it holds a ball whole, and whether it holds nothing of it. */
static inline bool box_holds_ball(const double box[6], const double c[3],
                                  double r) {
  for (int k = 0; k < 3; k++)
    if (!(c[k] - r >= box[2 * k] && c[k] + r <= box[2 * k + 1]))
      return false;
  return true;
}

static inline bool box_misses_ball(const double box[6], const double c[3],
                                   double r) {
  double d2 = 0;
  for (int k = 0; k < 3; k++) {
    const double d = fmax(0, fmax(box[2 * k] - c[k], c[k] - box[2 * k + 1]));
    d2 += d * d;
  }
  return d2 >= r * r;
}

/* Distance to what is beyond a box; negative there. */
static inline double box_distance(const double box[6], const double p[3]) {
  double least = INFINITY;
  for (int k = 0; k < 3; k++)
    least = fmin(least, fmin(p[k] - box[2 * k], box[2 * k + 1] - p[k]));
  return least;
}

static inline double box_volume(const double box[6]) {
  return (box[1] - box[0]) * (box[3] - box[2]) * (box[5] - box[4]);
}

/* Whether it has a volume to divide by: faces in order and finite, and a
   product that neither overflows nor vanishes. */
static inline bool box_valid(const double box[6]) {
  return box[0] < box[1] && box[2] < box[3] && box[4] < box[5] &&
         box_volume(box) > 0 && isfinite(box_volume(box));
}

#endif
