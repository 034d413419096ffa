/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A box cut into equal cells, with a value of each cell: the exact solid
   fraction, whether its midpoint is solid, or the midpoint's distance to the
   surface. Row by row, so that a grid needs no memory of its own; not in the
   paper. Lengths in m, boxes {x0, x1, y0, y1, z0, z1}. Tested in
   tests/test_voxels.c. */
#ifndef VOXELS_H
#define VOXELS_H

#include <stddef.h>
#include "geometry/solid.h"

enum voxels_value {
  /* Share of the cell inside the solid, in [0, 1]. Where one sphere meets the
     cell, or spheres do that do not overlap, to the rounding of the cell
     (ball_cell.h); where overlapping ones do, to that of volume_union. Where
     the surface of a bridge, a tube or a slanting wall does, by 24^2 lines
     through the cell, of which each is cut exactly: to some 1e-3. */
  VOXELS_FRACTION,
  /* 1 if the midpoint is solid, else 0: of spheres what volume_sampled
     counts. */
  VOXELS_MIDPOINT,
  /* Smallest distance of the midpoint x to the surface of a sphere, bridge or
     wall, negative inside: |x - c| - r (m). Outside of them all the exact
     distance to the solid's surface. Inside its size is a lower bound of that
     distance, exact for a sphere that nothing else overlaps: the nearest point
     of a sphere's surface may lie within another. Infinite without a solid. */
  VOXELS_DISTANCE
};

struct voxels;

/* Prepares the voxels of a solid, of which it keeps nothing (spheres with radii
   of 0 and less are left out), on a grid of cells[k] cells along axis k.
   Returns GSL_SUCCESS, GSL_EINVAL for a box without volume, no cells, or what
   is not finite, GSL_ENOMEM. */
int voxels_open(struct voxels **v, const struct solid *s, const double box[6],
                const size_t cells[3]);

/* Rows j0 <= j < j1 of layer k, x fastest: value has cells[0] (j1 - j0) places.
   The same numbers for any count of threads and any division into calls. One
   call at a time for a grid. Returns GSL_SUCCESS, GSL_ENOMEM. */
int voxels_rows(struct voxels *v, enum voxels_value what, size_t k, size_t j0,
                size_t j1, size_t threads, double *value);

void voxels_close(struct voxels *v);

#endif
