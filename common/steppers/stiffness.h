/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How stiff a problem is for a method: the fastest mode of a right-hand side,
   and how far an explicit step reaches. Not in the paper. Tested in
   tests/test_watch.c. */
#ifndef STIFFNESS_H
#define STIFFNESS_H

#include <stdbool.h>
#include <stddef.h>
#include <gsl/gsl_odeiv2.h>
#include "platform/store.h"

/* y' = lambda y, on which stability is tested, as a right-hand side of two real
   unknowns; params: two doubles, the parts of lambda. */
int stiffness_linear(double t, const double y[], double dydt[], void *params);

/* Largest |z| on the ray arg z = angle (pi/2 to pi) up to which no step of the
   method on y' = lambda y, z = h lambda, grows y by more than 1 %: the edge of
   its stability region, but for the slow growth along the imaginary axis that
   methods of order 5 have from 0 on and that step control sees. Measured by
   taking steps, so that no table of methods is needed; the method must be a
   one-step method whose stages are fixed. GSL_SUCCESS, GSL_ENOMEM. */
int stiffness_limit(const gsl_odeiv2_step_type *type, double angle,
                    double *limit);

/* The same for every angle, from a table. */
enum { STIFFNESS_RAYS = 19 };
struct stiffness_limits {
  double at[STIFFNESS_RAYS]; /* from pi/2 to pi */
};
/* GSL_SUCCESS, GSL_ENOMEM. */
int stiffness_limits(const gsl_odeiv2_step_type *type,
                     struct stiffness_limits *l);
double stiffness_limit_at(const struct stiffness_limits *l, double angle);

/* A step is at its limit from 0.8 of it: step control hunts for it from below.
   Stability, not the tolerance, sets the pace of a run where half of the
   accepted steps are; fewer than 1000 cause no warning. */
static inline bool stiffness_at_limit(double product, double limit) {
  return product >= 0.8 * limit;
}
static inline bool stiffness_sets_pace(size_t at_limit, size_t steps) {
  return steps >= 1000 && 2 * at_limit > steps;
}

struct stiffness;

/* The dominant eigenvalue of df/dy, followed along a trajectory. GSL_SUCCESS,
   GSL_ENOMEM. One at a time per thread. */
int stiffness_alloc(struct stiffness **out, size_t dim);
/* The directions that it goes on from (platform/store.h). */
void stiffness_store(struct stiffness *f, struct store *s);
void stiffness_free(struct stiffness *s);

struct stiffness_mode {
  double radius; /* |lambda| (1/s) */
  double angle;  /* of lambda or its conjugate, pi/2 to pi; growth is pi/2 */
};

/* Makes a number of power iterations (>= 2), each one evaluation, at a state
   with derivative f, from the direction of the last call on. The eigenvalue is
   that of the last two by least squares in the plane that they span, so that a
   complex pair is found as well as a real one: J. H. Wilkinson, The Algebraic
   Eigenvalue Problem, Oxford (1965), ch. 9. Before it has converged it is an
   estimate from below as a rule. Returns the right-hand side's error. */
int stiffness_estimate(struct stiffness *s, const gsl_odeiv2_system *sys,
                       double t, const double y[], const double f[],
                       size_t iterations, struct stiffness_mode *mode);

#endif
