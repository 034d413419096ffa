/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact areas of discs in a rectangle and of spheres on the shell of a
   cylinder, summed and united: the cuts of spheres by a plane or by a shell at
   some distance from a wall. Not in the paper. Lengths in m, areas in m^2;
   rectangles are {x0, x1, y0, y1}. The union of discs is found as that of balls
   is in volume.h, by power cells (Avis, Bhattacharya, Imai, The Visual Computer
   3 (1988) 323). Safe in any thread. Tested in tests/test_area.c. */
#ifndef AREA_H
#define AREA_H

#include <stddef.h>

/* Disc of radius r about the origin inside every half-plane
   {x: normal.x <= offset}; lines: count rows of {nx, ny, offset} with unit
   normals. The intersection need not be bounded nor hold the centre. */
double area_disc_lines(double r, size_t count, const double (*lines)[3]);

/* Sum of the areas of n discs inside a rectangle. c: 2n, r: n. */
double area_sum(size_t n, const double *c, const double *r,
                const double rectangle[4]);

/* Area of the union of n discs inside a rectangle. Returns GSL_SUCCESS,
   GSL_EINVAL for numbers that are not finite, GSL_ENOMEM. */
int area_union(size_t n, const double *c, const double *r,
               const double rectangle[4], double *area);

/* The mantle of a cylinder whose axis is along z. */
struct area_shell {
  double axis[2]; /* x and y of the axis */
  double radius;  /* above 0 */
  double z[2];    /* ends */
};

/* The area of a shell that n spheres cover, each by itself and united; exact,
   by elliptic integrals. x: 3n, r: n. Returns GSL_SUCCESS, GSL_EINVAL for
   numbers that are not finite or a shell's radius not above 0, GSL_ENOMEM. */
int area_shell_covered(size_t n, const double *x, const double *r,
                       const struct area_shell *shell, double *sum,
                       double *united);

#endif
