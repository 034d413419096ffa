/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of a bed one by one, each with the force that the law gives it,
   and quantities that follow: coordination, rattlers, fabric, loads on the
   walls. For measuring; dynamics.h has the fast sums. Safe in any thread, one
   network at a time. Tested in tests/test_contacts.c. */
#ifndef NETWORK_H
#define NETWORK_H

#include <stdbool.h>
#include <stddef.h>
#include "model/bed.h"
#include "model/scene.h"

struct network_contact {
  size_t i, j;        /* sphere; sphere j > i, or wall j */
  bool wall;          /* which of the two */
  bool counts;        /* see network_mark */
  double gap;         /* l, between the surfaces (m) */
  double n[3];        /* unit vector from the other body to sphere i */
  double normal;      /* force on sphere i along n (N), (2.3) and (2.5) */
  double friction[3]; /* force on sphere i across n (N), (2.6) and (2.9) */
};

struct network {
  size_t spheres, walls;
  size_t count;
  struct network_contact *at; /* pairs by (i, j), then walls by (i, j) */
  double period[3];           /* of the scene */
};

/* Lists every pair, but of two obstacles, whose gap is at most reach (m), and
   every sphere and wall whose gap is at most reach or, if that is more, lmax,
   so that loads on walls are whole. Beyond lmax there is no force; with a reach
   of lmax and more all forces are listed. All of them count until network_mark.
   Returns GSL_SUCCESS; GSL_EDOM where two centres are one, GSL_EINVAL for a
   number that is not finite, GSL_ENOMEM, with an empty list. w begins as zeros,
   or holds what was found before, which is freed. */
int network_find(struct network *w, const struct scene *s, const struct bed *b,
                 double reach);
void network_free(struct network *w);

/* Defines which contacts count, since the model's repulsion has no end: those
   with a gap of at most gap (m) or, where force > 0, a normal force of at least
   force (N). Marks them. */
void network_mark(struct network *w, double gap, double force);

/* Point half-way between the surfaces, on the line of centres (m). */
void network_point(const struct network_contact *c, const struct bed *b,
                   double x[3]);

/* Contacts that count, by sphere: with spheres and walls, and with spheres
   alone. Contacts of spheres in without, which may be NULL, do not. */
void network_degrees(const struct network *w, const bool *without,
                     size_t *degree, size_t *with_spheres);

/* Spheres with fewer than least contacts that count, walls included, are
   rattlers; so are those that have fewer once the rattlers are taken out, and
   so on. fixed (NULL: none): those are no rattlers. One flag per sphere.
   Returns GSL_SUCCESS, GSL_ENOMEM. */
int network_rattlers(const struct network *w, size_t least, const bool *fixed,
                     bool *rattler);

/* Sum of all forces on each sphere, with its weight (N), 3 per sphere; m a. */
void network_net_force(const struct network *w, const struct scene *s,
                       const struct bed *b, double *force);

/* Force of the spheres on wall k (N). */
void network_wall_load(const struct network *w, size_t k, double load[3]);

/* Fabric tensor {xx, yy, zz, xy, xz, yz}: mean of n n over the pairs of
   spheres that count and whose point lies in the box, or anywhere for NULL;
   trace 1, zero if there are none. Returns their number. M. Satake, IUTAM
   Conf. Deformation and Failure of Granular Materials (1982) 63. */
size_t network_fabric(const struct network *w, const struct bed *b,
                      const double box[6], double fabric[6]);

/* sqrt(3/2 D:D) of its deviator D: 0 for isotropic contacts, 1 if all point
   one way. Not in the paper. */
double network_anisotropy(const double fabric[6]);

#endif
