/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Initial states. Tested in tests/test_sizes.c, tests/test_rest.c and
   tests/test_fill.sh. */
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
  double rate;   /* of rain (1/s), 0: that with the slowest arrival */
  size_t seed;
};

/* Ways to fill by name: the enum fill_way. */
enum fill_way { FILL_GRID, FILL_RANDOM, FILL_RAIN };
struct fill_named {
  const char *name, *help;
};
extern const struct fill_named fill_ways[];

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

/* Spheres at random places that do not overlap, nearest images too, each within
   the base and all walls of the scene: random sequential addition, the largest
   first, evenly over the height over drop in which they fill 0.2 of the base's
   prism, or of the tube's where the fill is centred. Where tries are in vain
   the height grows. Jitter is not looked at. GSL_SUCCESS, GSL_ENOMEM,
   GSL_EINVAL if no place is found. */
int fill_random(const struct fill *f, const struct scene *s, struct bed *b);

/* Rain: sphere k = 1, 2, ... is where it will have fallen freely to the height
   drop, with its lower end, after k / rate, and it gets there with the same
   speed v as all: h = v t - g t^2 / 2 above it, with the speed v - g t
   downwards. So the stream thins as it falls, and no two overlap later if they
   do not at first. Across, places are random without overlaps. At the top the
   spheres follow each other in steps d of the height, so the speed there is
   rate d and v = g n / rate + rate d; d is that with which they fill 0.2 of the
   room, or more where that is too dense for the container, two of the largest
   radii at most. v is least, 2 sqrt(g n d), for rate^2 = g n / d, the default.
   Gravity is to be along -z, GSL_EDOM if not; else as above. */
int fill_rain(const struct fill *f, const struct scene *s, struct bed *b);

#endif
