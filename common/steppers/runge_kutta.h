/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The engine of explicit embedded Runge-Kutta methods as gsl_odeiv2 step types.
   Each method is a file with its tableau and one exported pointer. */
#ifndef RUNGE_KUTTA_H
#define RUNGE_KUTTA_H

#include <stdbool.h>
#include <gsl/gsl_odeiv2.h>

struct tableau {
  size_t stages;
  const double *a; /* rows of the stages after the first, 1 + 2 + 3 ... */
  const double *b; /* weights of the solution */
  const double *e; /* weights of the error estimate */
  const double *c; /* times of the stages */
  unsigned order;  /* exponent for the step control */
  bool fsal;       /* the last stage is f(t + h, y(t + h)) */
};

/* The fields of a step type. alloc returns NULL without memory. apply returns
   the right-hand side's error with y as it was. */
void *runge_kutta_alloc(const struct tableau *t, size_t dim);
int runge_kutta_apply(void *state, size_t dim, double t, double h, double y[],
                      double yerr[], const double dydt_in[], double dydt_out[],
                      const gsl_odeiv2_system *sys);
unsigned runge_kutta_order(void *state);
void runge_kutta_free(void *state);

#endif
