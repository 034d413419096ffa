/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks that a bed is one: no centres outside of walls, no two spheres nearly
   in one place; obstacles may be anywhere. settle refuses another start and
   calls another end a failure, so that it takes as a start every bed that it
   calls good. Not in the paper. Safe in any thread. Tested in
   tests/test_bed_check.c. */
#ifndef BED_CHECK_H
#define BED_CHECK_H

#include <stddef.h>
#include "model/bed.h"
#include "model/scene.h"

/* Centres outside of walls or on them, or nowhere (NaN). */
struct bed_outsiders {
  size_t count;        /* spheres */
  size_t sphere, wall; /* the one that is furthest out, and of which wall */
  double distance;     /* from that wall, not positive (m); infinite for none */
};

struct bed_outsiders bed_find_outsiders(const struct scene *s,
                                        const struct bed *b);

/* Settled spheres overlap, the more so the softer they are (kappa = 30 1/m: by
   0.12 m); with their centres closer than this share of the sum of their radii
   they were never a bed. */
static const double bed_closest = 0.4;

struct bed_crowd {
  size_t pairs;              /* that are closer */
  size_t i, j;               /* the closest by that measure */
  double distance, expected; /* of their centres, at least (m) */
};

/* Across periodic axes too (geometry/periodic.h). GSL_SUCCESS, GSL_EINVAL where
 * a coordinate is not finite, GSL_ENOMEM. */
int bed_find_crowd(const double period[3], const struct bed *b,
                   struct bed_crowd *c);

#endif
