/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Initial states. Tested in tests/test_sizes.c and tests/test_rest.c. */
#ifndef FILL_H
#define FILL_H

#include <stdbool.h>
#include <stddef.h>
#include "model/bed.h"
#include "model/scene.h"

struct fill {
  size_t count;
  double radius;  /* m */
  double mass;    /* kg */
  double base[2]; /* sides of what is filled, from origin (m) */
  double origin[2];
  bool centred;  /* the grid in it, which begins at the origin else */
  double drop;   /* height of the first layer's lower edge (m) */
  double jitter; /* largest displacement, in radii */
  size_t seed;
};

/* The paper's start, Fig. 4.2a: layers of a square grid 2.5 radii apart, the
   k-th (k = 1, 2, ...) at height drop + (k - 1/2) 2.5 r, each coordinate moved
   by jitter r U[0,1). Returns GSL_EINVAL if the base is too small
   for one sphere, GSL_ENOMEM. */
int fill_grid(const struct fill *f, struct bed *b);

/* The same of spheres that have their radii and masses, where each is within
   all walls of the scene, which may be NULL: r is the largest radius. Of
   spheres that are k times smaller, k whole, k^3 share a place of the grid, in
   one of their own, and are moved by as much less; so the layers are not full
   of holes, and no two spheres overlap. Of the fill, count, radius and mass are
   not looked at. GSL_EINVAL also if there are not places enough. */
int fill_grid_of(const struct fill *f, const struct scene *s, struct bed *b);

#endif
