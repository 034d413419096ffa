/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/region.h"

#include <math.h>
#include <string.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "geometry/periodic.h"
#include "geometry/tube.h"
#include "geometry/volume.h"

/* Along a tube's axis from its point, and away from the axis. */
static void in_tube(const struct region *g, const double x[3], double *along,
                    double *away) {
  double d[3];
  vec3_sub(x, g->point, d);
  *along = vec3_dot(d, g->axis);
  vec3_axpy(-*along, g->axis, d);
  *away = vec3_norm(d);
}

bool region_valid(const struct region *g) {
  if (!(g->radius > 0))
    return box_valid(g->box);
  return g->ends[0] < g->ends[1] && region_volume(g) > 0 &&
         isfinite(region_volume(g));
}

bool region_holds(const struct region *g, const double x[3]) {
  double along, away;
  if (!(g->radius > 0))
    return periodic_in_box(g->period, g->box, x);
  in_tube(g, x, &along, &away);
  return away <= g->radius && along >= g->ends[0] && along <= g->ends[1];
}

double region_volume(const struct region *g) {
  if (!(g->radius > 0))
    return box_volume(g->box);
  return M_PI * g->radius * g->radius * (g->ends[1] - g->ends[0]);
}

double region_depth(const struct region *g, const double x[3]) {
  if (g->radius > 0) {
    double along, away;
    in_tube(g, x, &along, &away);
    return fmin(g->radius - away, fmin(along - g->ends[0], g->ends[1] - along));
  }
  double depth = INFINITY;
  for (int k = 0; k < 3; k++)
    if (!(g->period[k] > 0))
      depth = fmin(depth, fmin(x[k] - g->box[2 * k], g->box[2 * k + 1] - x[k]));
  return depth;
}

double region_ball(const struct region *g, const double x[3], double radius) {
  if (g->radius > 0) {
    double along, away;
    in_tube(g, x, &along, &away);
    return tube_ball_volume(away, g->radius, g->ends[0] - along,
                            g->ends[1] - along, radius);
  }
  double box[6];
  memcpy(box, g->box, sizeof box);
  for (int k = 0; k < 3; k++)
    if (g->period[k] > 0) { /* no face in reach */
      box[2 * k] = x[k] - 2 * radius;
      box[2 * k + 1] = x[k] + 2 * radius;
    }
  return volume_ball_box(x, radius, box);
}
