/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stepper.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "steppers/integrate.h"
#include "steppers/chebyshev.h"
#include "steppers/rkc.h"
#include "steppers/stiffness.h"
#include "steppers/verlet.h"

int stepper_alloc(struct stepper *s, struct stepper_kind kind, size_t dim,
                  size_t row, size_t positions) {
  const struct integrate_method *m = integrate_method(kind.method);
  *s = (struct stepper){.kind = kind};
  if (!m || !m->fixed || (kind.stages && (*m->type != rkc || kind.stages < 2)))
    return GSL_EINVAL;
  s->step = gsl_odeiv2_step_alloc(*m->type, dim);
  s->rate = malloc(4 * dim * sizeof *s->rate);
  if (!s->step || !s->rate) {
    stepper_free(s);
    return GSL_ENOMEM;
  }
  s->rate_out = s->rate + dim;
  s->error = s->rate_out + dim;
  s->scratch = s->error + dim;
  if (m->layout)
    verlet_set_layout(s->step, row, positions);
  return GSL_SUCCESS;
}

void stepper_free(struct stepper *s) {
  if (s->step)
    gsl_odeiv2_step_free(s->step);
  free(s->rate);
  *s = (struct stepper){0};
}

struct decay {
  size_t dim;
  double rate;
};

static int decay_rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const struct decay *d = params;
  for (size_t i = 0; i < d->dim; i++)
    dydt[i] = -d->rate * y[i];
  return GSL_SUCCESS;
}

/* An estimate of the spectral radius serves rkc for several steps: one step of
   a system that calls for the stages wanted sets the number for the next. */
static int set_stages(struct stepper *s, double h) {
  const size_t dim = s->step->dimension;
  /* rkc takes 1.2 times its estimate */
  struct decay decay = {dim,
                        0.999 * chebyshev_reach(s->kind.stages) / (1.2 * h)};
  const gsl_odeiv2_system sys = {
      .function = decay_rhs, .dimension = dim, .params = &decay};
  for (size_t i = 0; i < dim; i++)
    s->scratch[i] = 1;
  int status = gsl_odeiv2_step_reset(s->step);
  if (status == GSL_SUCCESS)
    status = gsl_odeiv2_step_apply(s->step, -1, h, s->scratch, s->error, NULL,
                                   NULL, &sys);
  if (status == GSL_SUCCESS && rkc_report(s->step).stages != s->kind.stages)
    status = GSL_ESANITY;
  return status;
}

int stepper_apply(struct stepper *s, const gsl_odeiv2_system *sys, double t,
                  double h, double y[]) {
  int status = GSL_SUCCESS;
  if (s->kind.stages)
    status = set_stages(s, h);
  if (status == GSL_SUCCESS && !s->started)
    status = GSL_ODEIV_FN_EVAL(sys, t, y, s->rate);
  if (status == GSL_SUCCESS)
    status = gsl_odeiv2_step_apply(s->step, t, h, y, s->error, s->rate,
                                   s->rate_out, sys);
  if (status == GSL_SUCCESS && s->kind.stages &&
      rkc_report(s->step).stages != s->kind.stages)
    status = GSL_ESANITY;
  memcpy(s->rate, s->rate_out, s->step->dimension * sizeof *s->rate);
  s->started = status == GSL_SUCCESS;
  return status;
}

int stepper_factor(struct stepper_kind kind, double re, double im,
                   double factor[2]) {
  struct stepper s;
  double lambda[2] = {re, im};
  const gsl_odeiv2_system sys = {
      .function = stiffness_linear, .dimension = 2, .params = lambda};
  const struct integrate_method *m = integrate_method(kind.method);
  int status = m && !m->layout ? stepper_alloc(&s, kind, 2, 0, 0) : GSL_EINVAL;
  if (status != GSL_SUCCESS)
    return status;
  factor[0] = 1;
  factor[1] = 0;
  status = stepper_apply(&s, &sys, 0, 1, factor);
  stepper_free(&s);
  return status;
}

const char *stepper_name(struct stepper_kind kind, char *text) {
  if (kind.stages)
    snprintf(text, 32, "%s s=%zu", kind.method, kind.stages);
  else
    snprintf(text, 32, "%s", kind.method);
  return text;
}
