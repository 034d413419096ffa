/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta-Chebyshev with a step for each sphere. All spheres take a long
   step; those whose error is beyond the tolerance take it again in shorter
   ones, among partners that move as they were found to, and so on for those
   that need still shorter ones. The idea is V. Savcenco's, W. Hundsdorfer's and
   J. G. Verwer's (BIT 47 (2007) 137); docs/multirate.md has what is particular
   here. Not in the paper. One multirate per thread. Tested in
   tests/test_multirate.c. */
#ifndef MULTIRATE_H
#define MULTIRATE_H

#include "dynamics/dynamics.h"
#include "steppers/integrate.h"

enum { MULTIRATE_LEVELS = 3 }; /* lanes.h */

struct multirate;

/* Of a run so far, by level; level 0 is all spheres. */
struct multirate_report {
  size_t steps[MULTIRATE_LEVELS];    /* accepted */
  size_t rejected[MULTIRATE_LEVELS]; /* taken again as a whole */
  double rows[MULTIRATE_LEVELS];     /* spheres in an accepted step, mean */
  size_t evaluations[MULTIRATE_LEVELS];
  size_t contacts[MULTIRATE_LEVELS]; /* evaluated */
  size_t again; /* times that neighbours had to join the refined */
};
struct multirate_report multirate_report(const struct multirate *m);

/* In how many steps each of count spheres took the last step of all; 1: in that
   one. */
void multirate_steps(const struct multirate *m, size_t count, size_t steps[]);

/* The parameters of an engine. */
struct multirate_problem {
  struct dynamics *dynamics;
  double travel; /* furthest that a sphere may go in a step (m); 0: any */
};

/* The method behind steppers/integrate.h's "multirate". GSL_EINVAL for all
   pairs and for a relative tolerance. */
extern const struct integrate_engine multirate_engine;

#endif
