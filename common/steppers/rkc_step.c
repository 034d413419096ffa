/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "steppers/rkc_step.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Steps that an estimate of the spectral radius serves unless one is
   rejected. */
enum { ESTIMATE_SERVES = 4 };

int rkc_step_init(struct rkc_step *s, double *direction) {
  *s = (struct rkc_step){.power.direction = direction,
                         .least_reach = chebyshev_reach(2),
                         .last_start = GSL_NAN};
  return chebyshev_alloc(&s->chebyshev);
}

void rkc_step_free(struct rkc_step *s) {
  chebyshev_free(s->chebyshev);
}

void rkc_step_reset(struct rkc_step *s) {
  s->power.known = false;
  s->last_start = GSL_NAN;
}

/* Vectors of large systems are shared, a chunk at a time, among threads. */
enum { CHUNK = 8192, WORTH_SHARING = 8 * CHUNK };

/* As a system without a stage function does it; f is scratch. */
static int stage_by_parts(const struct rkc_problem *p, double t,
                          const double y[], const struct stage *stage,
                          double out[], double *f) {
  const int status = p->rates(t, y, f, p->params);
  if (status != GSL_SUCCESS)
    return status;
#pragma omp parallel for num_threads(p->threads)                               \
    schedule(static) if (p->dim >= WORTH_SHARING)
  for (size_t c = 0; c < p->dim; c += CHUNK)
    stage_combine(stage, c, GSL_MIN(CHUNK, p->dim - c), y, f + c, out);
  return GSL_SUCCESS;
}

static int rates(double t, double y[], double f[], void *problem) {
  const struct rkc_problem *p = problem;
  return p->rates(t, y, f, p->params);
}

static double total(double part, void *problem) {
  const struct rkc_problem *p = problem;
  return p->total(part, p->params);
}

static int estimate_radius(struct rkc_step *s, const struct rkc_problem *p,
                           double t, double h, const double *y, const double *f,
                           double *trial, double *slope) {
  struct rkc_problem problem = *p;
  const struct power_problem q = {.dim = p->dim,
                                  .t = t,
                                  .h = h,
                                  .y = y,
                                  .f = f,
                                  .weight = p->weight,
                                  .least = s->least_reach,
                                  .rates = rates,
                                  .total = p->total ? total : NULL,
                                  .params = &problem,
                                  .trial = trial,
                                  .slope = slope};
  const int status = power_estimate(&s->power, &q);
  s->report.power_evaluations = s->power.evaluations;
  if (status != GSL_SUCCESS)
    return status;
  s->report.spectral_radius = s->power.radius;
  s->steps = 0;
  return GSL_SUCCESS;
}

int rkc_step_try(struct rkc_step *s, const struct rkc_problem *p, double t,
                 double h, double y[], double yerr[], const double f0[],
                 double f1[], double work[]) {
  const size_t dim = p->dim;
  double *f = work + dim, *start = f + dim, *stage = start + dim,
         *slope = stage + dim;
  int status = GSL_SUCCESS;
  memcpy(start, y, dim * sizeof *y);
  memcpy(slope, f0, dim * sizeof *f0); /* f1 may be f0 */
  const bool rejected = t == s->last_start;
  if (!s->power.known || rejected || ++s->steps > ESTIMATE_SERVES)
    status = estimate_radius(s, p, t, h, y, slope, work, f);
  s->last_start = t;
  if (status != GSL_SUCCESS)
    return status;
  const size_t stages =
      chebyshev_stages(s->chebyshev, fabs(h) * s->power.radius);
  if (!stages)
    return GSL_FAILURE;
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
  stage_move(dim, h * scheme->w1 * scheme->b1, start, slope, now);
  for (size_t j = 2; j <= stages && status == GSL_SUCCESS; j++) {
    const struct chebyshev_stage *next = &scheme->stage[j - 2];
    const struct stage sum = chebyshev_stage(next, h, start, slope);
    const double time = t + h * next->time;
    status = p->stage ? p->stage(time, now, &sum, before, p->params)
                      : stage_by_parts(p, time, now, &sum, before, f);
    double *swap = before;
    before = now;
    now = swap;
  }
  if (status == GSL_SUCCESS && now != y)
    memcpy(y, now, dim * sizeof *y);
  if (status == GSL_SUCCESS)
    status = p->rates(t + h, y, f1, p->params);
  if (status != GSL_SUCCESS) {
    memcpy(y, start, dim * sizeof *y);
    s->power.known = false; /* the next attempt looks afresh */
    return status;
  }
#pragma omp parallel for num_threads(p->threads)                               \
    schedule(static) if (dim >= WORTH_SHARING)
  for (size_t i = 0; i < dim; i++)
    yerr[i] = 0.8 * (start[i] - y[i]) + 0.4 * h * (slope[i] + f1[i]);
  return GSL_SUCCESS;
}
