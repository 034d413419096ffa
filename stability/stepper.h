/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stepper applied with a fixed step, without any control, and for rkc with a
   given number of stages. Not in the paper. */
#ifndef STEPPER_H
#define STEPPER_H

#include <stdbool.h>
#include <stddef.h>
#include <gsl/gsl_odeiv2.h>

/* A method, and for rkc its stages. */
struct stepper_kind {
  const char *method; /* as integrate_methods has it */
  size_t stages;      /* 0: rkc's own choice, or not rkc */
};

struct stepper {
  struct stepper_kind kind;
  gsl_odeiv2_step *step;
  bool started;
  double *rate, *rate_out, *error, *scratch; /* dim each, one block */
};

/* Rows of the state begin with this number of positions. GSL_EINVAL for an
   unknown method or one that takes no fixed step, GSL_ENOMEM. */
int stepper_alloc(struct stepper *s, struct stepper_kind kind, size_t dim,
                  size_t row, size_t positions);
void stepper_free(struct stepper *s);

/* One step of y from t to t + h; the first after alloc evaluates the start.
   The code of the stepper or the right-hand side; then y is not to be used. */
int stepper_apply(struct stepper *s, const gsl_odeiv2_system *sys, double t,
                  double h, double y[]);

/* R(z), the factor of a step of y' = lambda y, z = h lambda, in y's two real
   components. Not for verlet, which is no method for such a system. Codes as
   above. */
int stepper_factor(struct stepper_kind kind, double re, double im,
                   double factor[2]);

/* "rkc s=5"; text of at least 32 bytes. */
const char *stepper_name(struct stepper_kind kind, char *text);

#endif
