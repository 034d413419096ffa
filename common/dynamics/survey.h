/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities of a state from one pass over its contacts: energies, the deepest
   overlap and the spheres' places before the walls. Not in the paper. Safe in
   any thread. Tested in tests/test_watch.c. */
#ifndef SURVEY_H
#define SURVEY_H

#include <stddef.h>

struct contact_list;

struct survey {
  double gravity;  /* J, from the origin */
  double height;   /* J, gravity's from the lowest surface of a sphere */
  double stored;   /* J in contacts, each F/kappa */
  size_t contacts; /* within lmax */
  /* Deepest overlap of any contact, in radii of the smaller sphere (a wall has
     none), and a sphere that has it; 0 where none overlap. */
  double overlap;
  size_t sphere;
  /* Least distance of a listed centre from its wall, negative outside (m), the
     sphere and the wall; GSL_POSINF where no sphere is near a wall. */
  double inside;
  size_t outsider, wall;
};

/* Of a state y that the list holds for; spheres are those of the bed. */
void survey_take(const struct contact_list *list, const double y[],
                 struct survey *s);

#endif
