/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The spheres of a bed: ids, positions, sizes and velocities; vectors are rows
   of three doubles. */
#ifndef BED_H
#define BED_H

#include <stdbool.h>
#include <stddef.h>
#include "platform/store.h"

struct bed {
  double t; /* s */
  size_t n;
  long *id;
  double *x; /* centres, 3n (m) */
  double *v; /* velocities, 3n (m/s) */
  double *w; /* angular velocities, 3n (rad/s) */
  double *r; /* radii, n (m) */
  double *m; /* masses, n (kg) */
  /* Of n, those that are obstacles: they feel and give forces and stay where
     they are. NULL: none. */
  bool *fixed;
};

static inline bool bed_is_fixed(const struct bed *b, size_t i) {
  return b->fixed && b->fixed[i];
}

/* n spheres with ids 0..n-1, unit mass and all else zero. GSL_ENOMEM. */
int bed_alloc(struct bed *b, size_t n);
void bed_free(struct bed *b);

/* Room for b->fixed, all false, unless it is there. GSL_ENOMEM. */
int bed_fix_none(struct bed *b);

/* Mean of x, one number for each sphere, over those that move, or over all
   where none does; the number itself where all are equal. Not for an empty bed.
 */
double bed_mean(const struct bed *b, const double x[]);

/* The same again, in memory of its own. GSL_ENOMEM. */
int bed_copy(struct bed *to, const struct bed *from);

/* All of it (platform/store.h): what is added to struct bed is added there.
   Taken out into a bed that has no memory yet. */
void bed_store(struct bed *b, struct store *s);

#endif
