/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/rkc.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "platform/multiversion.h"
#include "steppers/chebyshev.h"
#include "steppers/step_type.h"

/* The estimate grows towards the spectral radius from below. */
static const double safety = 1.2;

/* Two iterations that differ by less end the search. Contacts that form can
   make the radius several times larger within a step; a step that was too long
   for it is rejected. */
static const double agreement = 0.1;

/* Lengths that swing by more than this are of complex eigenvalues. */
static const double swing = 3;

/* Power iterations at most when nothing is known and when something is, and
   how many steps an estimate serves unless one is rejected. */
enum { FIRST_ITERATIONS = 50, NEXT_ITERATIONS = 8, ESTIMATE_SERVES = 4 };

struct state {
  bool known;            /* there is an estimate and a direction */
  double radius;         /* spectral radius, with the safety */
  double length;         /* of the last power iteration */
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

MULTIVERSION
static void euler(size_t dim, double h, const double *restrict y,
                  const double *restrict f, double *restrict out) {
#pragma omp simd
  for (size_t i = 0; i < dim; i++)
    out[i] = y[i] + h * f[i];
}

MULTIVERSION
static double length_of(size_t dim, const double *restrict x,
                        const double *restrict weight) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (size_t i = 0; i < dim; i++)
    sum += weight[i] * x[i] * (weight[i] * x[i]);
  return sqrt(sum);
}

/* Of a vector of unknowns or rates, each in its unit. */
static double norm(const struct state *s, const double *x) {
  return length_of(s->dim, x, s->work + 6 * s->dim);
}

/* A direction along all unknowns. */
static void any_direction(struct state *s) {
  const double *weight = s->work + 6 * s->dim;
  for (size_t i = 0; i < s->dim; i++)
    s->work[i] = (i % 2 ? 1 : -1) / weight[i];
}

/* One iteration: direction <- (f(y + small direction) - f(y)) / small; its
   length is the estimate. */
static int power_iterate(struct state *s, double t, const double *y,
                         const double *f, const gsl_odeiv2_system *sys,
                         double *radius) {
  const size_t dim = s->dim;
  double *direction = s->work, *trial = direction + dim, *slope = trial + dim;
  const double length = norm(s, direction);
  const double small = sqrt(GSL_DBL_EPSILON) * GSL_MAX(norm(s, y), 1e-3);
  euler(dim, small / length, y, direction, trial);
  const int status = GSL_ODEIV_FN_EVAL(sys, t, trial, slope);
  s->report.power_evaluations++;
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < dim; i++)
    direction[i] = slope[i] - f[i];
  *radius = norm(s, direction) / small;
  if (!(*radius > 0)) /* f does not change along it: try another */
    any_direction(s);
  return GSL_SUCCESS;
}

/* Where a pair of complex eigenvalues is the fastest, as of contacts with
   little damping, positions and velocities take turns: the lengths swing about
   |lambda| by the ratio of their units, as w^2, 1, w^2, ... for +-i w, and the
   geometric mean of two in a row is |lambda|. length: the last three, the
   latest first. */
static bool turns(const double length[3]) {
  return (length[1] < length[0]) == (length[1] < length[2]);
}

static bool swings(const double length[3]) {
  const double up = GSL_MIN(length[0], length[2]) / length[1];
  const double down = length[1] / GSL_MAX(length[0], length[2]);
  const double now = sqrt(length[0] * length[1]),
               before = sqrt(length[1] * length[2]);
  return GSL_MAX(up, down) > swing && fabs(now - before) <= agreement * now;
}

static int estimate_radius(struct state *s, double t, double h, const double *y,
                           const double *f, const gsl_odeiv2_system *sys) {
  size_t most = NEXT_ITERATIONS;
  if (!s->known) {
    most = FIRST_ITERATIONS;
    memcpy(s->work, f, s->dim * sizeof *f);
    if (!(norm(s, f) > 0))
      any_direction(s);
    s->length = 0;
  }
  double length[3] = {s->length}, radius = 0;
  for (size_t k = 0; k < most; k++) {
    length[2] = length[1];
    length[1] = length[0];
    const int status = power_iterate(s, t, y, f, sys, &length[0]);
    if (status != GSL_SUCCESS)
      return status;
    radius = length[0];
    if ((length[1] > 0 || k) && fabs(radius - length[1]) <= agreement * radius)
      break;
    /* nothing to find out where the fewest stages do for either */
    if (k < 2 || !turns(length) ||
        fabs(h) * safety * GSL_MAX(length[0], length[1]) <= s->least_reach)
      continue;
    radius = sqrt(length[0] * length[1]);
    if (swings(length))
      break;
  }
  s->length = length[0];
  s->radius = s->report.spectral_radius = safety * radius;
  s->steps = 0;
  s->known = true;
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
      (!s->known || rejected || ++s->steps > ESTIMATE_SERVES))
    status = estimate_radius(s, t, h, y, f0, sys);
  s->last_start = t;
  if (status != GSL_SUCCESS)
    return status;
  const size_t stages = chebyshev_stages(s->chebyshev, fabs(h) * s->radius);
  if (!stages)
    return GSL_FAILURE; /* evolve halves the step */
  const struct chebyshev_scheme *scheme =
      chebyshev_scheme(s->chebyshev, stages);
  if (!scheme)
    return GSL_ENOMEM;
  assert(scheme->stages == stages && fabs(h) * s->radius <= scheme->reach);
  s->report.stages = stages;
  s->report.most_stages = GSL_MAX(s->report.most_stages, stages);

  double *before = stage, *now = y; /* swap at each stage */
  memcpy(before, start, dim * sizeof *start);
  euler(dim, h * scheme->w1 * scheme->b1, start, f0, now);
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
    s->known = false; /* the next attempt looks afresh */
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
  s->known = false;
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
