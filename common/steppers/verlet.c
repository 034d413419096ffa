/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/verlet.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "steppers/step_type.h"

struct state {
  size_t row, positions;
  double work[]; /* state at the half step, dim */
};

static void *alloc(size_t dim) {
  return calloc(1, sizeof(struct state) + dim * sizeof(double));
}

void verlet_set_layout(gsl_odeiv2_step *s, size_t row, size_t positions) {
  struct state *state = s->state;
  state->row = row;
  state->positions = positions;
}

/* dydt_in holds the velocities and the accelerations found in the last step,
   so a step costs one evaluation. */
static int apply(void *vstate, size_t dim, double t, double h, double y[],
                 double yerr[], const double dydt_in[], double dydt_out[],
                 const gsl_odeiv2_system *sys) {
  const struct state *s = vstate;
  double *half = ((struct state *)vstate)->work;
  if (!s->row || !dydt_in || !dydt_out)
    return GSL_EINVAL;
  for (size_t i = 0; i < dim; i += s->row)
    for (size_t c = s->positions; c < s->row; c++)
      half[i + c] = y[i + c] + 0.5 * h * dydt_in[i + c];
  for (size_t i = 0; i < dim; i += s->row)
    for (size_t c = 0; c < s->positions; c++)
      half[i + c] = y[i + c] + h * half[i + s->positions + c];
  const int status = GSL_ODEIV_FN_EVAL(sys, t + h, half, dydt_out);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < dim; i += s->row) {
    for (size_t c = s->positions; c < s->row; c++)
      y[i + c] = half[i + c] + 0.5 * h * dydt_out[i + c];
    for (size_t c = 0; c < s->positions; c++) {
      y[i + c] = half[i + c];
      dydt_out[i + c] = y[i + s->positions + c];
    }
  }
  memset(yerr, 0, dim * sizeof *yerr);
  return GSL_SUCCESS;
}

static unsigned order(void *state) {
  (void)state;
  return 2;
}

static const gsl_odeiv2_step_type type = {.name = "verlet",
                                          .can_use_dydt_in = 1,
                                          .gives_exact_dydt_out = 0,
                                          .alloc = alloc,
                                          .apply = apply,
                                          .set_driver = step_no_driver,
                                          .reset = step_no_reset,
                                          .order = order,
                                          .free = free};

const gsl_odeiv2_step_type *const verlet = &type;
