/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The radius of a bed's geometry. In the model F0 and r are one parameter (pair
   forces depend on F0 exp(2 kappa r) only) and spheres at rest overlap, so the
   radius at which a bed is measured or handed on is a decision; not in the
   paper. All spheres have the same radius. x: 3n centres (m); walls are those
   of a scene and may touch as spheres do, and so may images across its periodic
   sides. Safe in any thread. Tested in tests/test_radius.c. */
#ifndef RADIUS_H
#define RADIUS_H

#include <stdbool.h>
#include "geometry/observer.h"
#include "model/scene.h"

/* Overlaps at a radius, in diameters, of pairs of spheres and of spheres and
   walls. Touching counts. */
struct radius_overlaps {
  size_t count;
  double largest, mean; /* 0 without any */
};
/* GSL_SUCCESS, GSL_EINVAL for numbers that are not finite, GSL_ENOMEM. */
int radius_overlaps(const struct scene *s, size_t n, const double *x, double r,
                    struct radius_overlaps *o);

/* The largest radius at which nothing overlaps: half the least distance of two
   centres, or the least from a wall. Returns as above; GSL_EDOM if there is no
   such radius above 0 or nothing to touch. */
int radius_touching(const struct scene *s, size_t n, const double *x,
                    double *r);

/* The radius at which the mean gap is 0 over the contacts: the pairs and walls
   that overlap at `nominal`. Returns as radius_touching. */
int radius_contact_mean(const struct scene *s, size_t n, const double *x,
                        double nominal, double *r);

/* Volume of the box that the spheres and all their images fill, as a union or
   as a sum (m^3). GSL_SUCCESS, GSL_EINVAL for numbers that are not finite,
   GSL_ERANGE where images are too many (geometry/periodic.h), GSL_ENOMEM. */
int radius_volume(const struct scene *s, size_t n, const double *x,
                  const double box[6], double r, bool sum,
                  const struct observer *observer, double *volume);

/* The radius at which the spheres fill a fraction of the box, above 0: the
   union of them (fraction below 1), or their sum. Returns as radius_volume,
   GSL_EDOM if there is no such radius, or, for a union, none at which a sphere
   of a large bed overlaps at most 60 others on average. */
int radius_of_fraction(const struct scene *s, size_t n, const double *x,
                       const double box[6], double fraction, bool sum,
                       const struct observer *observer, double *r);

#endif
