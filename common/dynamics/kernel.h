/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hot loop: contact forces of a list of contacts, added up by sphere. The
   same source, kernel.c, is compiled for several instruction sets;
   kernel_select gives the best that this machine has. Internal to
   dynamics.c.

   A state row is {x, y, z, vx, vy, vz[, wx, wy, wz]}, one row a sphere. A pair
   is evaluated once and added to both its spheres, in the order of the list:
   first what a sphere gets as second partner, then as first, then from walls.
   That order does not depend on who computes it, so a range of rows can be
   given to a thread together with every pair that touches it, and the sums
   have the same bits for any number of threads. */
#ifndef KERNEL_H
#define KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "model/scene.h"

/* What the contacts of a scene need. Each combination is a loop of its own. */
struct kernel_features {
  bool friction, rotation;
  bool elastic; /* e = 1: no rebound function */
  bool uniform; /* equal radii */
};

struct kernel_data {
  struct contact_law law;
  struct kernel_features has;
  double gravity[3];
  size_t stride; /* doubles in a state row: 6, or 9 with spin */
  const double *radius, *mass;
  const struct wall *walls;
  /* contacts: pairs i < j, then spheres wall_sphere against walls wall_id;
     first[i] and wall_first[i] begin sphere i's */
  size_t pairs, wall_contacts;
  const uint32_t *i, *j;
  const uint32_t *wall_sphere, *wall_id;
  const size_t *first, *wall_first;
};

/* Rows [from, to) that one thread computes, and its sums: KERNEL_SUM doubles a
   row (force, 0, sum of n x friction, 0), zero between evaluations. Row i's is
   number i & mask: only the rows from the one being finished to its furthest
   partner are in flight, and those stay in the cache. */
struct kernel_part {
  size_t from, to;
  double *sums;
  size_t mask; /* a power of two less one */
};

enum { KERNEL_SUM = 8 };

struct kernel {
  const char *name; /* of the instruction set */
  /* Adds count pairs to the sums of those partners that are in the part. */
  void (*add_pairs)(const struct kernel_data *k, const double *y,
                    const uint32_t *i, const uint32_t *j, size_t count,
                    const struct kernel_part *part);
  /* Adds the contacts of rows [from, to) with walls. */
  void (*add_walls)(const struct kernel_data *k, const double *y, size_t from,
                    size_t to, const struct kernel_part *part);
  /* Turns the sums of rows [from, to) into rates, the first at rates[0], and
     zeroes them; false if not all rates are finite. */
  bool (*finish)(const struct kernel_data *k, const double *y, double *rates,
                 size_t from, size_t to, const struct kernel_part *part);
};

const struct kernel *kernel_select(void);

#endif
