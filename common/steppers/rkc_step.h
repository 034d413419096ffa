/* SPDX-License-Identifier: GPL-2.0-or-later */
/* One step of Runge-Kutta-Chebyshev (rkc.h) without the types of GSL, for a
   state that may be spread over several processes: each has some of the
   unknowns and steps them, all with the same h, and hands on what it has to a
   sum. Between steps unknowns may move from one process to another, and dim
   with them. Not in the paper. One step at a time. Tested in
   tests/test_rkc.c. */
#ifndef RKC_STEP_H
#define RKC_STEP_H

#include "steppers/chebyshev.h"
#include "steppers/power.h"
#include "steppers/stage.h"

/* Findings so far. */
struct rkc_report {
  double spectral_radius;   /* estimate in use (1/s) */
  size_t stages;            /* of the last step */
  size_t most_stages;       /* of any step */
  size_t power_evaluations; /* spent on the spectral radius */
};

struct rkc_problem {
  size_t dim;
  /* f(t, y) into dydt; GSL_SUCCESS or an error. */
  int (*rates)(double t, const double y[], double dydt[], void *params);
  stage_function *stage; /* in place of it within a step, or NULL */
  void *params;
  const double *weight; /* 1 by the unit of each unknown */
  /* The sum over all processes, or NULL where this one has all unknowns. */
  double (*total)(double part, void *params);
  int threads; /* that share the vectors of a large system */
};

/* State from step to step. power.direction belongs to the caller, dim
   numbers. */
struct rkc_step {
  struct power power;
  size_t steps; /* since the spectral radius was estimated */
  struct chebyshev *chebyshev;
  double least_reach; /* of two stages */
  double last_start;  /* of the last attempt, to know a second one by */
  struct rkc_report report;
};

/* GSL_SUCCESS, GSL_ENOMEM. */
int rkc_step_init(struct rkc_step *s, double *direction);
void rkc_step_free(struct rkc_step *s); /* not s itself */

/* Forgets the spectral radius. */
void rkc_step_reset(struct rkc_step *s);

/* A step of length h from y at t, whose rates are f0: y and its rates f1 at
   t + h, and the estimate of the error. work: 5 dim numbers. GSL_SUCCESS, an
   error of rates, GSL_FAILURE where the step is too stiff for any number of
   stages; then y is as it was. */
int rkc_step_try(struct rkc_step *s, const struct rkc_problem *p, double t,
                 double h, double y[], double yerr[], const double f0[],
                 double f1[], double work[]);

#endif
