/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/stiffness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_rng.h>

int stiffness_linear(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const double *lambda = params;
  dydt[0] = lambda[0] * y[0] - lambda[1] * y[1];
  dydt[1] = lambda[1] * y[0] + lambda[0] * y[1];
  return GSL_SUCCESS;
}

/* |R(z)| by a step of length 1. */
static double growth(gsl_odeiv2_step *step, double radius, double angle) {
  double lambda[2] = {radius * cos(angle), radius * sin(angle)};
  const gsl_odeiv2_system system = {stiffness_linear, NULL, 2, lambda};
  double y[2] = {1, 0}, error[2], rate[2];
  stiffness_linear(0, y, rate, lambda);
  gsl_odeiv2_step_reset(step);
  if (gsl_odeiv2_step_apply(step, 0, 1, y, error, rate, NULL, &system) !=
      GSL_SUCCESS)
    return GSL_POSINF;
  return hypot(y[0], y[1]);
}

int stiffness_limit(const gsl_odeiv2_step_type *type, double angle,
                    double *limit) {
  const double most = 1.01, stride = 0.05;
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(type, 2);
  if (!step)
    return GSL_ENOMEM;
  double low = 0, high = stride;
  while (high < 1e3 && growth(step, high, angle) <= most) {
    low = high;
    high += stride;
  }
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    if (growth(step, middle, angle) <= most)
      low = middle;
    else
      high = middle;
  }
  gsl_odeiv2_step_free(step);
  *limit = low;
  return GSL_SUCCESS;
}

int stiffness_limits(const gsl_odeiv2_step_type *type,
                     struct stiffness_limits *l) {
  struct stiffness_limits found;
  for (size_t k = 0; k < STIFFNESS_RAYS; k++) {
    const double share = (double)k / (STIFFNESS_RAYS - 1);
    const int status =
        stiffness_limit(type, M_PI_2 * (1 + share), &found.at[k]);
    if (status != GSL_SUCCESS)
      return status;
  }
  *l = found;
  return GSL_SUCCESS;
}

double stiffness_limit_at(const struct stiffness_limits *l, double angle) {
  const double at = (angle / M_PI_2 - 1) * (STIFFNESS_RAYS - 1);
  const size_t k = (size_t)GSL_MIN(GSL_MAX(at, 0), STIFFNESS_RAYS - 2);
  return l->at[k] + (at - (double)k) * (l->at[k + 1] - l->at[k]);
}

struct stiffness {
  size_t dim;
  gsl_rng *rng;
  double *before, *now; /* directions of unit length, now along J before */
  double *trial, *next;
  double work[];
};

static void scatter(struct stiffness *s) {
  gsl_rng_set(s->rng, 0); /* its own seed */
  for (size_t i = 0; i < s->dim; i++)
    s->now[i] = 2 * gsl_rng_uniform_pos(s->rng) - 1;
  cblas_dscal((int)s->dim, 1 / cblas_dnrm2((int)s->dim, s->now, 1), s->now, 1);
}

int stiffness_alloc(struct stiffness **out, size_t dim) {
  struct stiffness *s = calloc(1, sizeof *s + 4 * dim * sizeof(double));
  if (!s)
    return GSL_ENOMEM;
  s->dim = dim;
  s->before = s->work;
  s->now = s->before + dim;
  s->trial = s->now + dim;
  s->next = s->trial + dim;
  s->rng = gsl_rng_alloc(gsl_rng_taus2);
  if (!s->rng) {
    free(s);
    return GSL_ENOMEM;
  }
  scatter(s);
  *out = s;
  return GSL_SUCCESS;
}

void stiffness_free(struct stiffness *s) {
  if (!s)
    return;
  gsl_rng_free(s->rng);
  free(s);
}

static double dot(size_t dim, const double *a, const double *b) {
  return cblas_ddot((int)dim, a, 1, b, 1);
}

static struct stiffness_mode mode_of(gsl_complex lambda) {
  const double angle = fabs(gsl_complex_arg(lambda));
  return (struct stiffness_mode){gsl_complex_abs(lambda),
                                 GSL_MAX(angle, M_PI_2)};
}

/* The larger root of lambda^2 = alpha lambda + beta, where
   next = J now = alpha now + (beta / length) before, length = |J before|. */
static struct stiffness_mode fit(const struct stiffness *s, double length) {
  const double a = dot(s->dim, s->now, s->next);
  const double b = dot(s->dim, s->before, s->next);
  const double c = dot(s->dim, s->now, s->before), det = 1 - c * c;
  if (!(det > 1e-8)) /* one direction: converged */
    return mode_of(gsl_complex_rect(a, 0));
  const double alpha = (a - c * b) / det, beta = length * (b - c * a) / det;
  gsl_complex root[2];
  const int roots =
      gsl_poly_complex_solve_quadratic(1, -alpha, -beta, root, root + 1);
  return mode_of(roots == 2 &&
                         gsl_complex_abs(root[1]) > gsl_complex_abs(root[0])
                     ? root[1]
                     : root[0]);
}

int stiffness_estimate(struct stiffness *s, const gsl_odeiv2_system *sys,
                       double t, const double y[], const double f[],
                       size_t iterations, struct stiffness_mode *mode) {
  const size_t dim = s->dim;
  const double small =
      GSL_SQRT_DBL_EPSILON * GSL_MAX(cblas_dnrm2((int)dim, y, 1), 1e-3);
  struct stiffness_mode found = {0, M_PI};
  double last = 0;
  for (size_t k = 0; k < iterations; k++) {
    for (size_t i = 0; i < dim; i++)
      s->trial[i] = y[i] + small * s->now[i];
    const int status = GSL_ODEIV_FN_EVAL(sys, t, s->trial, s->next);
    if (status != GSL_SUCCESS)
      return status;
    for (size_t i = 0; i < dim; i++)
      s->next[i] = (s->next[i] - f[i]) / small;
    const double length = cblas_dnrm2((int)dim, s->next, 1);
    if (!(length > 0)) { /* f does not change along it: try another */
      scatter(s);
      last = 0;
      continue;
    }
    found = last > 0 ? fit(s, last) : (struct stiffness_mode){length, M_PI};
    last = length;
    double *free = s->before;
    s->before = s->now;
    s->now = s->next;
    s->next = free;
    cblas_dscal((int)dim, 1 / length, s->now, 1);
  }
  *mode = found;
  return GSL_SUCCESS;
}

void stiffness_store(struct stiffness *f, struct store *s) {
  store_part(s, "stiffness");
  store_doubles(s, f->before, f->dim);
  store_doubles(s, f->now, f->dim);
}
