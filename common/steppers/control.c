/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/control.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "steppers/predictive.h"
#include "steppers/step_type.h"

/* The paper's control */

static const double smallest_step = 1e-9; /* s, the author's program */

static void *alloc(void) {
  return calloc(1, sizeof(double)); /* delta */
}

static int init(void *state, double delta, double eps_rel, double a_y,
                double a_dydt) {
  (void)eps_rel;
  (void)a_y;
  (void)a_dydt;
  *(double *)state = delta;
  return delta > 0 ? GSL_SUCCESS : GSL_EINVAL;
}

static int adjust(void *state, size_t dim, unsigned order, const double y[],
                  const double yerr[], const double yp[], double *h) {
  (void)order;
  (void)y;
  (void)yp;
  const double delta = *(double *)state;
  double error = 0;
  for (size_t i = 0; i < dim; i++) {
    const double e = fabs(yerr[i]);
    if (!(e <= error) && !isnan(error)) /* a NaN comes in and stays */
      error = e;
  }
  error *= 3 / *h;
  const bool accepted = error < delta || *h < smallest_step;
  const double factor = error == 0 ? 2 : 0.8 * pow(delta / error, 0.2);
  *h *= isfinite(factor) && factor > 0 ? factor : 0.1;
  if (!accepted)
    return GSL_ODEIV_HADJ_DEC;
  return factor > 1 ? GSL_ODEIV_HADJ_INC : GSL_ODEIV_HADJ_NIL;
}

static int error_level(void *state, const double y, const double dydt,
                       const double h, const size_t i, double *level) {
  (void)y;
  (void)dydt;
  (void)i;
  *level = *(double *)state * fabs(h) / 3;
  return GSL_SUCCESS;
}

static const gsl_odeiv2_control_type paper = {.name = "paper",
                                              .alloc = alloc,
                                              .init = init,
                                              .hadjust = adjust,
                                              .errlevel = error_level,
                                              .set_driver = step_no_driver,
                                              .free = free};

int control_paper_alloc(gsl_odeiv2_control **out, double delta) {
  gsl_odeiv2_control *c = gsl_odeiv2_control_alloc(&paper);
  if (!c)
    return GSL_ENOMEM;
  const int status = gsl_odeiv2_control_init(c, delta, 0, 0, 0);
  if (status == GSL_SUCCESS)
    *out = c;
  else
    gsl_odeiv2_control_free(c);
  return status;
}

/* Predictive control */

struct predictive_state {
  double abstol, reltol;
  struct predictive steps;
  size_t dim;
  double *scale;
};

static void *predictive_alloc(void) {
  return calloc(1, sizeof(struct predictive_state));
}

static void predictive_free(void *state) {
  free(((struct predictive_state *)state)->scale);
  free(state);
}

static int predictive_init(void *state, double abstol, double reltol,
                           double a_y, double a_dydt) {
  (void)a_y;
  (void)a_dydt;
  struct predictive_state *p = state;
  p->abstol = abstol;
  p->reltol = reltol;
  return abstol >= 0 && reltol >= 0 && abstol + reltol > 0 ? GSL_SUCCESS
                                                           : GSL_EINVAL;
}

static int predictive_adjust(void *state, size_t dim, unsigned order,
                             const double y[], const double yerr[],
                             const double yp[], double *h) {
  (void)yp;
  struct predictive_state *p = state;
  double error = 0;
  for (size_t i = 0; i < dim; i++) {
    const double e =
        fabs(yerr[i]) / (p->abstol * p->scale[i] + p->reltol * fabs(y[i]));
    if (!(e <= error) && !isnan(error)) /* a NaN comes in and stays */
      error = e;
  }
  const double before = *h;
  if (!predictive_accepts(&p->steps, error, order, h))
    return GSL_ODEIV_HADJ_DEC;
  return *h > before ? GSL_ODEIV_HADJ_INC : GSL_ODEIV_HADJ_NIL;
}

static int predictive_error_level(void *state, const double y,
                                  const double dydt, const double h,
                                  const size_t i, double *level) {
  (void)dydt;
  (void)h;
  const struct predictive_state *p = state;
  *level = p->abstol * p->scale[i] + p->reltol * fabs(y);
  return GSL_SUCCESS;
}

static const gsl_odeiv2_control_type predictive = {.name = "predictive",
                                                   .alloc = predictive_alloc,
                                                   .init = predictive_init,
                                                   .hadjust = predictive_adjust,
                                                   .errlevel =
                                                       predictive_error_level,
                                                   .set_driver = step_no_driver,
                                                   .free = predictive_free};

int control_predictive_alloc(gsl_odeiv2_control **out, double abstol,
                             double reltol, const double *scale, size_t dim) {
  gsl_odeiv2_control *c = gsl_odeiv2_control_alloc(&predictive);
  if (!c)
    return GSL_ENOMEM;
  struct predictive_state *p = c->state;
  p->dim = dim;
  p->scale = malloc(dim * sizeof *scale);
  const int status =
      p->scale ? gsl_odeiv2_control_init(c, abstol, reltol, 0, 0) : GSL_ENOMEM;
  if (status != GSL_SUCCESS) {
    gsl_odeiv2_control_free(c);
    return status;
  }
  memcpy(p->scale, scale, dim * sizeof *scale);
  *out = c;
  return GSL_SUCCESS;
}

void control_predictive_store(gsl_odeiv2_control *c, struct store *s) {
  struct predictive_state *p = c->state;
  store_part(s, "predictive control");
  store_plain(s, &p->steps, sizeof p->steps);
}
