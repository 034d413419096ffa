/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres in motion: a scene's right-hand side and an integrator put together.
   Not in the paper. One motion per thread. Tested in
   tests/test_closed_forms.c. */
#ifndef MOTION_H
#define MOTION_H

#include "dynamics/dynamics.h"
#include "dynamics/multirate.h"
#include "steppers/integrate.h"

struct motion {
  struct dynamics *dynamics;
  struct integrator *integrator;
  double travel; /* m, the furthest that a sphere may go in a step; 0: any */
};

/* Starts at b->t with b's state; keeps no pointer to the arguments. travel: as
   in struct motion. GSL_SUCCESS, GSL_EINVAL for options that do not fit
   together or a bed that dynamics_alloc refuses, GSL_ENOMEM. */
int motion_alloc(struct motion **out, const struct scene *s,
                 const struct bed *b, const struct integrate_options *o,
                 const struct dynamics_options *d, double travel);
/* The same for one sphere of unit mass over the floor z = 0, at time 0 and in
   one thread. GSL_EINVAL also for a scene that has walls of its own. */
int motion_alloc_over_floor(struct motion **out, const struct scene *s,
                            double radius, const double x[3], const double v[3],
                            const struct integrate_options *o, double travel);
/* The state of method multirate (multirate.h), or NULL. */
const struct multirate *motion_multirate(const struct motion *m);

/* Its memory (platform/store.h), for a motion of the same scene, spheres,
   options and order. */
void motion_store(struct motion *m, struct store *s);

void motion_free(struct motion *m);

#endif
