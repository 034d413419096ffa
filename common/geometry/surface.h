/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surface of a solid as triangles: one closed surface of the union of
   spheres, bridges and walls, whatever overlaps. Not in the paper.

   A grid of cubes is cut into tetrahedra, six to a cube along its diagonal, and
   each that has corners inside and outside is cut by one triangle or two. Their
   corners are on the edges, exactly where these enter the solid. Two tetrahedra
   share a face and the whole cut of it, so that every edge of the surface
   belongs to two triangles, in opposite directions, however the solid is shaped
   (marching tetrahedra; Payne, Toga, IEEE Computer Graphics & Applications
   10(6) (1990) 33). Parts thinner than a step may be missed.

   Corners are on the spheres, so that triangles cut off what is curved, and
   fill the wedges where spheres meet: the volume is off by some (step/r)^2 of
   itself. One surface per thread. Tested in tests/test_surface.c. */
#ifndef SURFACE_H
#define SURFACE_H

#include <stdbool.h>
#include "geometry/solid.h"

struct surface;

/* Prepares the surface of a solid, which has to stay. cells: steps along the
   longest side of the region, a box (m). clip: the surface is that of the
   solid's part within the region, closed by the region's faces; else the region
   must hold all of the solid, which then has no container. Returns GSL_SUCCESS,
   GSL_EINVAL for a region without volume, no cells or numbers that are not
   finite, GSL_ENOMEM. */
int surface_open(struct surface **out, const struct solid *s,
                 const double region[6], bool clip, size_t cells);

double surface_step(const struct surface *f);

/* Corners keep this share of a step away from the grid's nodes, so that two of
   them are never closer than about that. */
#define SURFACE_MARGIN (1. / 128)

/* A triangle, its corners counter-clockwise from outside (m). */
typedef void surface_triangle(const double corner[3][3], void *context);

/* Calls each for every triangle, or only counts them where that is NULL. The
   same ones in the same order every time. Returns GSL_SUCCESS, GSL_ENOMEM. */
int surface_walk(struct surface *f, surface_triangle *each, void *context,
                 size_t *count);

void surface_close(struct surface *f);

#endif
