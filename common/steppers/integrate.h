/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A free-running integration: stepper and step control by name, one accepted
   step at a time, outputs interpolated between steps so that asking for more
   of them changes no trajectory. Tested in tests/test_integrate.c. */
#ifndef INTEGRATE_H
#define INTEGRATE_H

#include <stdbool.h>
#include <stddef.h>
#include <gsl/gsl_odeiv2.h>
#include "platform/store.h"
#include "steppers/rkc.h"
#include "steppers/stage.h"
#include "steppers/stiffness.h"

struct integrate_options {
  const char *method;
  const char *control;   /* NULL: by method; unused where step > 0 */
  double tol;            /* per_time control: delta; else abstol where that is
                            0; 0: by control */
  double abstol, reltol; /* unless per_time, per unknown's scale */
  double hinit;          /* first trial step (s) */
  double hmax;           /* longest step (s), 0: none */
  double step;           /* fixed step (s), 0: adaptive */
};

/* A step control and what tells it from the others. */
struct integrate_control {
  const char *name, *help;
  double tol;    /* by default */
  bool per_time; /* tol bounds the error per unit step (m/s^2), and abstol and
                    reltol mean nothing; else the error (m/s) */
  /* NULL: what a problem's own method does by itself */
  int (*alloc)(gsl_odeiv2_control **out, const struct integrate_options *o,
               const double *scale, size_t dim);
  /* Its memory (platform/store.h); NULL: it has none. */
  void (*store)(gsl_odeiv2_control *c, struct store *s);
};

struct integrate_problem;

/* A method and what tells it from the others. */
struct integrate_method {
  const char *name, *help;
  const gsl_odeiv2_step_type *const *type; /* NULL: the problem's own method */
  const struct integrate_control *control; /* by default */
  bool estimates; /* its error; else it needs a fixed step */
  bool fixed;     /* takes a fixed step */
  bool jacobian;  /* needs the system's, dense */
  bool layout;    /* needs to know the rows' positions */
  bool adapts;    /* to stiffness: it has no limit of stability */
  bool half;      /* the derivative it hands on is that of the half step */
  bool opaque;    /* its memory cannot be stored */
  size_t vectors; /* of the unknowns that a run has in memory, as measured for
                     20,000 and more spheres; 0: not so many */
  /* Tells a new step of the problem, or NULL. */
  void (*prepare)(gsl_odeiv2_step *s, const struct integrate_problem *p);
  /* Its memory (platform/store.h); NULL: it has none, or it is opaque. */
  void (*store)(gsl_odeiv2_step *step, struct store *s);
};

/* All of them; the last has no name. */
extern const struct integrate_method integrate_methods[];
extern const struct integrate_control integrate_controls[];

/* The one of that name, or NULL; name may be NULL. */
const struct integrate_method *integrate_method(const char *name);
const struct integrate_control *integrate_control(const char *name);

/* Sets what is left open: the control by the method, the tolerance by the
   control. */
void integrate_defaults(struct integrate_options *o);

/* Where an integration is: the state and its rates now and at the start of the
   last step. */
struct integrate_view {
  double t, last_step;
  const double *y, *rate, *start, *start_rate;
};

struct integrate_counts {
  size_t accepted, rejected;
};

/* A method that belongs to a problem and uses more than its right-hand side;
   engine is the method's state. */
struct integrate_engine {
  /* As integrate_alloc; params are the problem's. */
  int (*alloc)(void **engine, const struct integrate_options *o, double t,
               const double y[], void *params);
  void (*free)(void *engine);
  /* As integrate_step, not beyond stop; puts all steps so far into counts. */
  int (*step)(void *engine, double stop, struct integrate_counts *counts);
  struct integrate_view (*view)(const void *engine);
  struct rkc_report (*report)(const void *engine);
  /* y is an interpolation over the last step; puts in what the method knows
     more precisely. */
  void (*at)(const void *engine, double t, double y[]);
  /* Its memory (platform/store.h). */
  void (*store)(void *engine, struct store *s);
};

struct integrate_problem {
  gsl_odeiv2_system system;
  /* Unit of each unknown's error in standard control: dimension doubles. */
  const double *scale;
  /* Unknowns of a row, and the number of positions that it begins with, for
     methods that tell positions from velocities. */
  size_t row, positions;
  /* Longest step allowed at a state with the given derivative, or NULL. */
  double (*step_limit)(const double y[], const double dydt[], void *params);
  /* The right-hand side within a stage, for methods that make use of it, or
     NULL. */
  stage_function *stage;
  int threads; /* that may share vectors of the system's size; 0: one */
  /* The problem's own method, or NULL. */
  const struct integrate_engine *engine;
  void *engine_params;
};

struct integrator;

/* A copy of y at time t is the start. Returns GSL_SUCCESS, GSL_EINVAL for an
   unknown name or options that do not fit together (a method without error
   estimate needs a fixed step), GSL_ENOMEM. problem->system must outlive the
   integrator. */
int integrate_alloc(struct integrator **it, const struct integrate_options *o,
                    const struct integrate_problem *problem, double t,
                    const double y[]);
void integrate_free(struct integrator *it);

/* One accepted step. GSL_SUCCESS, or an error after which time and state are
   those before the step: GSL_FAILURE when no step is short enough for the
   control or a right-hand side that is not finite; GSL_ENOMEM, which a
   right-hand side says by GSL_EFAULT: after GSL_ENOMEM GSL would go on with
   another step. */
int integrate_step(struct integrator *it);

/* Makes the step that would pass t > integrate_time end there instead, so that
   the state at t is the method's own and not an interpolation; steps after it
   give GSL_EDOM until there is a new stop. GSL_EINVAL for an earlier t. */
int integrate_stop(struct integrator *it, double t);

double integrate_time(const struct integrator *it);
const double *integrate_state(const struct integrator *it);
double integrate_last_step(const struct integrator *it);
struct integrate_counts integrate_counts(const struct integrator *it);
/* Derivative at the end of the last step. */
const double *integrate_derivative(const struct integrator *it);

/* Largest h |lambda| that a method takes without growth, by the angle of lambda
   (stiffness.h); verlet's is 2, for undamped oscillation and for friction.
   GSL_SUCCESS, GSL_EINVAL for an unknown method or one that adapts to
   stiffness, GSL_ENOMEM. */
int integrate_limits(const char *method, struct stiffness_limits *l);

/* Time, state and rates at once. */
struct integrate_view integrate_view(const struct integrator *it);

/* The state of the problem's own method, or NULL. */
const void *integrate_engine(const struct integrator *it);

/* Findings of rkc or of the problem's own method so far, all 0 for others. */
struct rkc_report integrate_rkc_report(const struct integrator *it);

/* State at a time within the last step, by a cubic Hermite polynomial, or by
   several where the problem's own method divided the step. Before the first
   step only the start is known. GSL_EDOM outside. */
int integrate_at(const struct integrator *it, double t, double y[]);

/* All that the next steps follow from (platform/store.h): taken out by an
   integrator of the same problem and options, whatever its start, the steps are
   the same to the last bit. States within the last step are not kept. GSL's
   own right-hand side is the caller's to store. Not for a method that is opaque
   (GSL_EINVAL). Tested in tests/test_store.c. */
void integrate_store(struct integrator *it, struct store *s);

#endif
