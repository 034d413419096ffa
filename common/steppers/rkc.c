/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/rkc.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "steppers/chebyshev.h"
#include "steppers/power.h"
#include "steppers/step_type.h"

/* Steps that an estimate of the spectral radius serves unless one is
   rejected. */
enum { ESTIMATE_SERVES = 4 };

struct state {
  struct power power;    /* the spectral radius */
  size_t steps;          /* since it was estimated */
  stage_function *stage; /* of the system, or NULL */
  int threads;
  struct chebyshev *chebyshev;
  double least_reach; /* of two stages */
  double last_start;  /* of the last attempt, to know a second one by */
  struct rkc_report report;
  size_t dim;
  double work[]; /* direction, y at the start, two stages, slopes, 6 dim; and
                    the unknowns by their units, dim */
};

static void *alloc(size_t dim) {
  struct state *s = calloc(1, sizeof *s + 7 * dim * sizeof(double));
  if (!s || chebyshev_alloc(&s->chebyshev) != GSL_SUCCESS) {
    free(s);
    return NULL;
  }
  s->dim = dim;
  s->power.direction = s->work;
  s->threads = 1;
  s->least_reach = chebyshev_reach(2);
  s->last_start = GSL_NAN;
  for (size_t i = 0; i < dim; i++)
    s->work[6 * dim + i] = 1;
  return s;
}

static void release(void *state) {
  chebyshev_free(((struct state *)state)->chebyshev);
  free(state);
}

/* Vectors of large systems are shared, a chunk at a time, among threads. */
enum { CHUNK = 8192, WORTH_SHARING = 8 * CHUNK };

/* As a system without a stage function does it; f is scratch. */
static int stage_by_parts(const struct state *s, double t, const double y[],
                          const struct stage *stage, double out[],
                          const gsl_odeiv2_system *sys, double *f) {
  (void)s; /* without OpenMP */
  const size_t dim = sys->dimension;
  const int status = GSL_ODEIV_FN_EVAL(sys, t, y, f);
  if (status != GSL_SUCCESS)
    return status;
#pragma omp parallel for num_threads(s->threads)                               \
    schedule(static) if (dim >= WORTH_SHARING)
  for (size_t c = 0; c < dim; c += CHUNK)
    stage_combine(stage, c, GSL_MIN(CHUNK, dim - c), y, f + c, out);
  return GSL_SUCCESS;
}

static int rates(double t, double y[], double f[], void *system) {
  return GSL_ODEIV_FN_EVAL((const gsl_odeiv2_system *)system, t, y, f);
}

static int estimate_radius(struct state *s, double t, double h, const double *y,
                           const double *f, const gsl_odeiv2_system *sys) {
  gsl_odeiv2_system system = *sys;
  const struct power_problem problem = {.dim = s->dim,
                                        .t = t,
                                        .h = h,
                                        .y = y,
                                        .f = f,
                                        .weight = s->work + 6 * s->dim,
                                        .least = s->least_reach,
                                        .rates = rates,
                                        .params = &system,
                                        .trial = s->work + s->dim,
                                        .slope = s->work + 2 * s->dim};
  const int status = power_estimate(&s->power, &problem);
  s->report.power_evaluations = s->power.evaluations;
  if (status != GSL_SUCCESS)
    return status;
  s->report.spectral_radius = s->power.radius;
  s->steps = 0;
  return GSL_SUCCESS;
}

static int apply(void *vstate, size_t dim, double t, double h, double y[],
                 double yerr[], const double dydt_in[], double dydt_out[],
                 const gsl_odeiv2_system *sys) {
  struct state *s = vstate;
  double *start = s->work + 3 * dim, *stage = start + dim,
         *f = s->work + 2 * dim, *f0 = stage + dim;
  int status = GSL_SUCCESS;
  memcpy(start, y, dim * sizeof *y);
  if (dydt_in)
    memcpy(f0, dydt_in, dim * sizeof *f0);
  else
    status = GSL_ODEIV_FN_EVAL(sys, t, y, f0);
  const bool rejected = t == s->last_start;
  if (status == GSL_SUCCESS &&
      (!s->power.known || rejected || ++s->steps > ESTIMATE_SERVES))
    status = estimate_radius(s, t, h, y, f0, sys);
  s->last_start = t;
  if (status != GSL_SUCCESS)
    return status;
  const size_t stages =
      chebyshev_stages(s->chebyshev, fabs(h) * s->power.radius);
  if (!stages)
    return GSL_FAILURE; /* evolve halves the step */
  const struct chebyshev_scheme *scheme =
      chebyshev_scheme(s->chebyshev, stages);
  if (!scheme)
    return GSL_ENOMEM;
  assert(scheme->stages == stages &&
         fabs(h) * s->power.radius <= scheme->reach);
  s->report.stages = stages;
  s->report.most_stages = GSL_MAX(s->report.most_stages, stages);

  double *before = stage, *now = y; /* swap at each stage */
  memcpy(before, start, dim * sizeof *start);
  stage_move(dim, h * scheme->w1 * scheme->b1, start, f0, now);
  for (size_t j = 2; j <= stages && status == GSL_SUCCESS; j++) {
    const struct chebyshev_stage *next = &scheme->stage[j - 2];
    const struct stage sum = chebyshev_stage(next, h, start, f0);
    const double time = t + h * next->time;
    status = s->stage ? s->stage(time, now, &sum, before, sys->params)
                      : stage_by_parts(s, time, now, &sum, before, sys, f);
    double *swap = before;
    before = now;
    now = swap;
  }
  if (status == GSL_SUCCESS && now != y)
    memcpy(y, now, dim * sizeof *y);
  double *end = dydt_out ? dydt_out : f;
  if (status == GSL_SUCCESS)
    status = GSL_ODEIV_FN_EVAL(sys, t + h, y, end);
  if (status != GSL_SUCCESS) {
    memcpy(y, start, dim * sizeof *y);
    s->power.known = false; /* the next attempt looks afresh */
    return status;
  }
#pragma omp parallel for num_threads(s->threads)                               \
    schedule(static) if (dim >= WORTH_SHARING)
  for (size_t i = 0; i < dim; i++)
    yerr[i] = 0.8 * (start[i] - y[i]) + 0.4 * h * (f0[i] + end[i]);
  return GSL_SUCCESS;
}

static int reset(void *state, size_t dim) {
  (void)dim;
  struct state *s = state;
  s->power.known = false;
  s->last_start = GSL_NAN;
  return GSL_SUCCESS;
}

static unsigned order(void *state) {
  (void)state;
  return 2;
}

static const gsl_odeiv2_step_type type = {.name = "rkc",
                                          .can_use_dydt_in = 1,
                                          .gives_exact_dydt_out = 1,
                                          .alloc = alloc,
                                          .apply = apply,
                                          .set_driver = step_no_driver,
                                          .reset = reset,
                                          .order = order,
                                          .free = release};

const gsl_odeiv2_step_type *const rkc = &type;

struct rkc_report rkc_report(const gsl_odeiv2_step *s) {
  return ((const struct state *)s->state)->report;
}

void rkc_set_system(gsl_odeiv2_step *s, stage_function *stage, int threads,
                    const double *scale) {
  struct state *state = s->state;
  state->stage = stage;
  state->threads = GSL_MAX(threads, 1);
  for (size_t i = 0; i < state->dim; i++)
    state->work[6 * state->dim + i] = scale ? 1 / scale[i] : 1;
}
