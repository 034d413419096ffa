/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact volumes of spheres clipped by planes and boxes, alone, summed and
   united; not in the paper, whose count of midpoints is volume_sampled.

   One primitive serves all: the ball's part inside the tetrahedron (centre,
   foot on a face's plane, foot on an edge, end of the edge) is elementary, and
   a ball clipped by a polyhedron is the signed sum of such parts over faces
   and edges. Compare Strobl, Formella, Poeschel, J. Comput. Phys. 311 (2016)
   158, and, for the union by power cells, Avis, Bhattacharya, Imai, The Visual
   Computer 3 (1988) 323. Lengths in m, volumes in m^3; boxes are
   {x0, x1, y0, y1, z0, z1}. Safe in any thread. Tested in
   tests/test_volume.c. */
#ifndef VOLUME_H
#define VOLUME_H

#include <stddef.h>
#include "geometry/observer.h"

/* Ball of radius r about the origin inside every half-space
   {x: normal.x <= offset}; planes: count rows of {nx, ny, nz, offset} with unit
   normals. The intersection need not be bounded nor hold the centre. */
double volume_ball_planes(double r, size_t count, const double (*planes)[4]);

/* Ball of radius r about c inside a box. */
double volume_ball_box(const double c[3], double r, const double box[6]);

/* Sum of the volumes of n spheres inside a box: what the paper calls volume
   fraction, times the volume of the box. x: 3n, r: n. */
double volume_sum(size_t n, const double *x, const double *r,
                  const double box[6]);

/* Volume of the union of n spheres inside a box. Returns GSL_SUCCESS,
   GSL_EINVAL for coordinates that are not finite, GSL_ENOMEM. */
int volume_union(size_t n, const double *x, const double *r,
                 const double box[6], double *volume);
/* The same, and tells an observer, which may be NULL. */
int volume_union_told(size_t n, const double *x, const double *r,
                      const double box[6], const struct observer *observer,
                      double *volume);
/* The same within further planes, {x: plane[0..2].x <= plane[3]} with unit
   normals. */
int volume_union_planes(size_t n, const double *x, const double *r,
                        const double box[6], size_t count,
                        const double (*plane)[4],
                        const struct observer *observer, double *volume);

/* The paper's count on count^3 midpoints of a box: sum counts a point once for
   every sphere that it lies in, united once. observer may be NULL. Returns
   GSL_SUCCESS, GSL_ENOMEM. */
int volume_sampled(size_t n, const double *x, const double *r,
                   const double box[6], size_t count,
                   const struct observer *observer, double *sum,
                   double *united);

#endif
