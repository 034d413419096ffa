/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The box over the base of a container, where a bed is measured. Not in the
   paper. Safe in any thread. Tested in tests/test_boxes.sh and
   tests/test_containers.sh. */
#ifndef BASE_BOX_H
#define BASE_BOX_H

#include <stdbool.h>
#include "model/scene.h"

/* Puts the faces of a box where a plane is across an axis, and says of each
   face whether one is; the last of several counts. */
void base_faces(const struct scene *s, double box[6], bool walled[6]);

/* The bottom cube of the base that the walls enclose: on the floor, between
   side walls along x and y, as high as the shorter of the two is wide. Periodic
   sides are like walls; in an upright tube it is the square inscribed. False,
   and nothing done, where there are not all of them. */
bool base_box(const struct scene *s, double box[6]);

#endif
