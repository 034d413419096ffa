/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where centres are looked at: a box, whose axes may be periodic, or a piece of
   a tube. A periodic axis has no faces: the box is one cell of what repeats
   along it. Lengths in m. Not in the paper. Safe in any thread. Tested in
   tests/test_structure.c. */
#ifndef REGION_H
#define REGION_H

#include <stdbool.h>

struct region {
  double box[6];    /* along a periodic axis the cell, from 0 to the period */
  double period[3]; /* 0: the axis has faces */
  /* instead of a box, where the radius is above 0: the inside of a cylinder, by
     a point on its axis and the axis' direction, between ends that are
     distances from the point along it; nothing is periodic then */
  double radius, point[3], axis[3], ends[2];
};

/* Has it a volume above 0, as box_valid says it? */
bool region_valid(const struct region *g);
/* Is a place, or any image of it, in the region? */
bool region_holds(const struct region *g, const double x[3]);
double region_volume(const struct region *g);
/* Of a place in the region, to the nearest face; infinite without any. */
double region_depth(const struct region *g, const double x[3]);
/* Volume of the ball about a place in the region that is within its faces. */
double region_ball(const struct region *g, const double x[3], double radius);

#endif
