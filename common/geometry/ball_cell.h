/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volume of a ball inside a small box, to the rounding of the box; not in the
   paper. volume_ball_box is exact to the rounding of the whole ball, which for
   a cell of a fine grid is that of (r/h)^3 cells; here the integral stays
   within the cell. Lengths in m, boxes {x0, x1, y0, y1, z0, z1}. Tested in
   tests/test_voxels.c. */
#ifndef BALL_CELL_H
#define BALL_CELL_H

enum { BALL_CELL_RULES = 3 };

/* Gauss-Legendre nodes and weights on [0, 1]. */
struct ball_cell {
  struct {
    double node[16], weight[16];
  } rule[BALL_CELL_RULES];
};

/* Returns GSL_SUCCESS or GSL_ENOMEM. */
int ball_cell_init(struct ball_cell *q);

/* Ball of radius r about c inside cell. The error is about
   4 DBL_EPSILON (r/h) of the cell where its edges h are below about r/10, and
   that of volume_ball_box where they are not. Safe in any thread. */
double ball_cell_volume(const struct ball_cell *q, const double c[3], double r,
                        const double cell[6]);

#endif
