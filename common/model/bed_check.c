/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/bed_check.h"

#include <math.h>
#include <stdbool.h>
#include <gsl/gsl_errno.h>
#include "geometry/periodic.h"
#include "geometry/vec3.h"

struct bed_outsiders bed_find_outsiders(const struct scene *s,
                                        const struct bed *b) {
  struct bed_outsiders o = {.distance = INFINITY};
  for (size_t i = 0; i < b->n; i++) {
    bool out = false;
    if (bed_is_fixed(b, i))
      continue;
    for (size_t k = 0; k < s->walls_count; k++) {
      const double d = wall_distance(&s->walls[k], b->x + 3 * i);
      if (d > 0)
        continue;
      out = true;
      if (!(d >= o.distance) && !isnan(o.distance)) { /* a NaN stays */
        o.distance = d;
        o.sphere = i;
        o.wall = k;
      }
    }
    o.count += out;
  }
  return o;
}

int bed_find_crowd(const double period[3], const struct bed *b,
                   struct bed_crowd *c) {
  struct neighbors near = {0};
  struct bed_crowd found = {0};
  const int status = periodic_find(&near, b->n, b->x, 3, b->r, 0, period);
  if (status != GSL_SUCCESS) {
    neighbors_free(&near);
    return status;
  }
  double closest = bed_closest;
  for (size_t p = 0; p < near.count; p++) {
    const size_t i = near.i[p], j = near.j[p];
    if (bed_is_fixed(b, i) && bed_is_fixed(b, j))
      continue;
    double u[3];
    vec3_sub(b->x + 3 * i, b->x + 3 * j, u);
    periodic_nearest(period, u);
    const double d = vec3_norm(u), touch = b->r[i] + b->r[j];
    if (!(d < bed_closest * touch))
      continue;
    found.pairs++;
    if (d < closest * touch || found.pairs == 1) {
      closest = d / touch;
      found.i = i;
      found.j = j;
      found.distance = d;
      found.expected = bed_closest * touch;
    }
  }
  neighbors_free(&near);
  *c = found;
  return GSL_SUCCESS;
}
