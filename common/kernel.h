/* The hot loop: contact forces of a list of contacts, then their sums by
   sphere. The same source, kernel.c, is compiled for several instruction sets;
   kernel_select gives the best that this machine has. Internal to
   dynamics.c.

   A state row is {x, y, z, vx, vy, vz[, wx, wy, wz]}, one row a sphere. Every
   contact is evaluated once and its result kept in a row of its own; each
   sphere then adds up its rows in a fixed order, so the sums have the same
   bits for any number of threads. */
#ifndef KERNEL_H
#define KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "scene.h"

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
  /* contacts: pairs (i, j), then spheres wall_sphere against walls wall_id */
  size_t pairs, wall_contacts;
  const uint32_t *i, *j;
  const uint32_t *wall_sphere, *wall_id;
  /* a sphere's contacts: as first partner, as second, with walls */
  const size_t *first, *second_first, *wall_first;
  const uint32_t *second;
  double *rows; /* contacts x width: force and, with spin, torque / -r */
  size_t width; /* doubles in a result row: 4, or 8 with spin */
};

struct kernel {
  const char *name; /* of the instruction set */
  /* Evaluates contacts [from, to) into their rows. */
  void (*contacts)(const struct kernel_data *k, const double *y, size_t from,
                   size_t to);
  /* Sums rows into dydt for spheres [from, to); false if not all finite. */
  bool (*gather)(const struct kernel_data *k, const double *y, double *dydt,
                 size_t from, size_t to);
};

const struct kernel *kernel_select(void);

#endif
