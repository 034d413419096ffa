/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/rkc.h"

#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "steppers/power_store.h"
#include "steppers/step_type.h"

struct state {
  struct rkc_step step;
  stage_function *stage; /* of the system, or NULL */
  int threads;
  size_t dim;
  double numbers[]; /* direction, 1 by the unit of each unknown, rates at the
                       start and at the end where nobody else has them, work:
                       9 dim */
};

static void *alloc(size_t dim) {
  struct state *s = calloc(1, sizeof *s + 9 * dim * sizeof(double));
  if (!s || rkc_step_init(&s->step, s->numbers) != GSL_SUCCESS) {
    free(s);
    return NULL;
  }
  s->dim = dim;
  s->threads = 1;
  for (size_t i = 0; i < dim; i++)
    s->numbers[dim + i] = 1;
  return s;
}

static void release(void *state) {
  rkc_step_free(&((struct state *)state)->step);
  free(state);
}

static int apply(void *vstate, size_t dim, double t, double h, double y[],
                 double yerr[], const double dydt_in[], double dydt_out[],
                 const gsl_odeiv2_system *sys) {
  struct state *s = vstate;
  double *weight = s->numbers + dim, *start = weight + dim, *end = start + dim,
         *work = end + dim;
  const struct rkc_problem problem = {.dim = dim,
                                      .rates = sys->function,
                                      .stage = s->stage,
                                      .params = sys->params,
                                      .weight = weight,
                                      .threads = s->threads};
  if (!dydt_in) {
    const int status = GSL_ODEIV_FN_EVAL(sys, t, y, start);
    if (status != GSL_SUCCESS)
      return status;
  }
  const int status =
      rkc_step_try(&s->step, &problem, t, h, y, yerr, dydt_in ? dydt_in : start,
                   dydt_out ? dydt_out : end, work);
  /* else evolve would try again with another step, in silence */
  return status == GSL_ENOMEM ? GSL_EFAULT : status;
}

static int reset(void *state, size_t dim) {
  (void)dim;
  rkc_step_reset(&((struct state *)state)->step);
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
  return ((const struct state *)s->state)->step.report;
}

void rkc_set_system(gsl_odeiv2_step *s, stage_function *stage, int threads,
                    const double *scale) {
  struct state *state = s->state;
  state->stage = stage;
  state->threads = GSL_MAX(threads, 1);
  for (size_t i = 0; i < state->dim; i++)
    state->numbers[state->dim + i] = scale ? 1 / scale[i] : 1;
}

void rkc_store(gsl_odeiv2_step *stepper, struct store *s) {
  struct state *state = stepper->state;
  struct rkc_step *step = &state->step;
  store_part(s, "rkc");
  power_store(&step->power, state->dim, s);
  store_size(s, &step->steps);
  store_double(s, &step->last_start);
  store_plain(s, &step->report, sizeof step->report);
}
