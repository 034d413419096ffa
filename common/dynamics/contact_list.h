/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A bed, or a part of one, as the evaluation of its forces needs it: rows in an
   order that is good for memory, the pairs of rows and the walls near enough to
   matter, and which thread computes what. The kernels, the Jacobian and the
   survey read it. contact_subset.h makes lists of parts. Not in the paper. One
   integration at a time. Tested in tests/test_dynamics.c. */
#ifndef CONTACT_LIST_H
#define CONTACT_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "dynamics/row.h"
#include "geometry/periodic.h"
#include "model/bed.h"
#include "model/scene.h"
#include "platform/store.h"

/* Features of the contacts of a scene. */
struct contact_features {
  bool friction, rotation;
  bool elastic; /* e = 1: no rebound function */
  bool uniform; /* equal radii, and none of the following */
  bool lever;   /* arms of the contact point */
  bool rolling; /* resistance */
};

/* Doubles in the sum of a row: force, 0, sum of n x friction, 0; rows that a
   part finishes at a time; and rows from which on threads share loops of a few
   operations for each. */
enum { CONTACT_SUM = 8, CONTACT_CHUNK = 64, CONTACT_SHARED = 4096 };

/* Rows [from, to) that one thread computes, and their sums, zero between
   evaluations. Row i's sum is number i & mask: only the rows from the one being
   finished to its furthest partner are in flight, and those stay in the
   cache. */
struct contact_part {
  size_t from, to;
  double *sums;
  size_t mask;         /* a power of two less one */
  size_t pairs, walls; /* of contact_subset.c */
};

struct contact_list {
  /* of the scene */
  struct contact_law law;
  struct contact_features has;
  double gravity[3];
  size_t walls_count;
  struct wall *walls;
  bool cylinders;   /* not all of them are planes */
  double period[3]; /* geometry/periodic.h */
  bool periodic;    /* some axis is */

  /* Rows that have rates, doubles in each; after them a part of a bed has
     ghosts: rows that are partners only. */
  size_t rows, stride, ghosts;
  /* The rows from this one on are obstacles: their rates are zero, and they
     have no contacts with each other or with walls. */
  size_t moving;
  /* Sphere of the bed in each row; of a part, row of what it is part of. */
  size_t *order;
  double *radius, *mass; /* by row */
  double *push, *turn;   /* 1/m and -r/I: rates by force and n x friction */
  size_t rows_size, walls_size; /* room of a part's arrays */
  /* Rates that contacts beside this list give each row, its length each, the
     positions' unused; NULL: there are none. Not owned. */
  const double *frozen;

  /* Contacts: pairs of rows i < j in near, then rows against walls. Row i's
     begin at near.first[i] and wall_first[i], which have rows + 1 entries. */
  struct neighbors near;
  size_t wall_contacts, *wall_first;
  uint32_t *wall_row, *wall_id; /* room for rows * walls_count */

  /* The same pairs by row, ghosts too: row i's partners are partner[q],
     partner_first[i] <= q < partner_first[i + 1], ascending. Listed on
     demand. */
  bool partners_known;
  size_t *partner_first, partner_rows, partner_pairs; /* room */
  uint32_t *partner;

  /* One part per thread. A pair with its partners in two parts is computed in
     both: those that come into part p from earlier ones are in_i[q], in_j[q],
     incoming[p] <= q < incoming[p + 1], ascending. */
  size_t threads, most_threads; /* in use, there is room for */
  struct contact_part *part;
  double *sums; /* of all parts */
  size_t sums_size;
  size_t span; /* at least the largest difference of the rows of a pair */
  size_t *incoming, incoming_size;
  uint32_t *in_i, *in_j;

  /* The list holds for states with all spheres within skin/2 of their
     reference. */
  double *reference; /* 3 rows */
  double skin;       /* m */
  double typical; /* the mean radius, which the skin is kept in proportion to,
                     whichever sphere comes first (m) */
  size_t age;     /* evaluations since it was built; SIZE_MAX: there is none */
  size_t builds;

  uint32_t *place; /* of contact_subset.c */
  size_t places;
};

/* Features of the contacts of a scene; equal: all radii are. */
static inline struct contact_features contact_features_of(const struct scene *s,
                                                          bool equal) {
  const bool lever = scene_has_lever(s), rolling = scene_has_rolling(s);
  return (struct contact_features){.friction = scene_has_friction(s),
                                   .rotation = scene_has_rotation(s),
                                   .elastic = s->law.restitution == 1,
                                   .uniform = equal && !lever && !rolling,
                                   .lever = lever,
                                   .rolling = rolling};
}

/* Row i's rates by force and torque, from its mass and radius. */
static inline void contact_list_mass(struct contact_list *l, size_t i) {
  l->push[i] = 1 / l->mass[i];
  l->turn[i] = -2.5 * l->push[i] / l->radius[i]; /* I = 2 m r^2/5 */
}

/* Prepares the list of a scene and its spheres; keeps no pointer to either.
   order: the spheres in the rows, each once; NULL: in the order of space.
   GSL_EINVAL if there is no sphere, more than 2^32 - 2 of them, or a radius or
   mass is not positive; GSL_ENOMEM. */
int contact_list_alloc(struct contact_list **out, const struct scene *s,
                       const struct bed *b, size_t threads,
                       const size_t *order);
void contact_list_free(struct contact_list *l);

/* Makes the list hold for the state y. GSL_SUCCESS, GSL_EBADFUNC for a position
   that is not finite, GSL_ENOMEM. Sums do not depend on when the list was
   built, since contacts beyond lmax add zero and their order is that of the
   rows. */
int contact_list_update(struct contact_list *l, const double y[]);

/* Pairs and walls: what an evaluation over the list computes. */
static inline size_t contact_list_size(const struct contact_list *l) {
  return l->near.count + l->wall_contacts;
}

/* The longest way of a sphere (m) that the list can be made to hold for, and
   making it hold for every state within the way of y; then whether it holds for
   y. Errors as above. */
double contact_list_longest_way(const struct contact_list *l);
int contact_list_hold(struct contact_list *l, const double y[], double way);
bool contact_list_holds(const struct contact_list *l, const double y[]);

/* The larger of a row's own speed and that of its surface, |v| or r |w| (m/s),
   given its unknowns. */
double contact_list_speed(const struct contact_list *l, size_t row,
                          const double y[]);

/* Lists the partners, unless they are. GSL_SUCCESS, GSL_ENOMEM. */
int contact_list_partners(struct contact_list *l);

/* Parts, pairs that come into them and room for sums, of a list whose contacts
   and span are new. GSL_SUCCESS, GSL_ENOMEM. */
int contact_list_share(struct contact_list *l);

/* Its memory (platform/store.h), of a list of a whole bed. */
void contact_list_store(struct contact_list *l, struct store *s);

#endif
