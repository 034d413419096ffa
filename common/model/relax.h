/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A start whose spheres overlap more deeply than any that has come to rest or
   fallen would fly apart: a contact stores F[l]/kappa, exponential in its
   depth. Here such spheres are pushed apart, along their contacts and without
   inertia, until none stores more than a little. Not in the paper. Safe in any
   thread. Tested in tests/test_relax.c and tests/test_relax.sh.

   Energies are by m g r of a contact's lighter sphere, the radius that of
   similarity: a contact of x m g r throws that sphere x radii high. */
#ifndef RELAX_H
#define RELAX_H

#include "model/bed.h"
#include "model/scene.h"
#include "model/similarity.h"

struct relax_limits {
  double deep;   /* m g r, of contacts that a bed is pushed apart for */
  double enough; /* m g r, most that any stores afterwards */
  size_t passes; /* at most */
};

struct relax_report {
  size_t pairs, walls; /* contacts that were too deep */
  double depth;        /* the deepest of their overlaps (m) */
  size_t sphere;       /* that has it */
  size_t moved;        /* spheres */
  double furthest;     /* that one of them moved (m) */
  size_t passes;
  size_t left; /* contacts that are still too deep */
};

/* Pushes a bed's spheres apart if a contact is too deep: if it stores more than
   limits->deep or two centres are closer than bed_closest has it
   (model/bed_check.h). Spheres that do not overlap are not moved but by others;
   obstacles stay. Velocities are not looked at. GSL_SUCCESS also where nothing
   was to be done (then pairs and walls are 0); GSL_EMAXITER with the report
   after so many passes, GSL_EINVAL where a coordinate is not finite,
   GSL_ENOMEM: the bed is as it was. */
int relax_bed(const struct scene *s, const struct similarity *units,
              const struct relax_limits *limits, struct bed *b,
              struct relax_report *report);

#endif
