/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/region.h"

#include <math.h>
#include <string.h>
#include "geometry/box.h"
#include "geometry/periodic.h"
#include "geometry/volume.h"

bool region_valid(const struct region *g) {
  return box_valid(g->box);
}

bool region_holds(const struct region *g, const double x[3]) {
  return periodic_in_box(g->period, g->box, x);
}

double region_volume(const struct region *g) {
  return box_volume(g->box);
}

double region_depth(const struct region *g, const double x[3]) {
  double depth = INFINITY;
  for (int k = 0; k < 3; k++)
    if (!(g->period[k] > 0))
      depth = fmin(depth, fmin(x[k] - g->box[2 * k], g->box[2 * k + 1] - x[k]));
  return depth;
}

double region_ball(const struct region *g, const double x[3], double radius) {
  double box[6];
  memcpy(box, g->box, sizeof box);
  for (int k = 0; k < 3; k++)
    if (g->period[k] > 0) { /* no face in reach */
      box[2 * k] = x[k] - 2 * radius;
      box[2 * k + 1] = x[k] + 2 * radius;
    }
  return volume_ball_box(x, radius, box);
}
