/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The place in a box that is farthest from everything solid and from the box's
   faces: a point that is certainly in the pore. Not in the paper. Safe in any
   thread. Tested in tests/test_solid.c. */
#ifndef CLEARANCE_H
#define CLEARANCE_H

#include "geometry/solid.h"

/* point: its distance, *clearance, is within 1 % of the largest there is; in a
   box so flat that a million blocks are not enough, the deepest of these.
   Returns GSL_SUCCESS, GSL_EDOM if nothing in the box is free, GSL_EINVAL for a
   box without volume, GSL_ENOMEM. */
int clearance_deepest(const struct solid *s, const double box[6],
                      double point[3], double *clearance);

#endif
