/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/motion.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

/* GSL takes a step again at half the length after most errors, this one too;
   GSL_EFAULT ends it (steppers/integrate.h). */
static int end_without_memory(int status) {
  return status == GSL_ENOMEM ? GSL_EFAULT : status;
}

static int rhs(double t, const double y[], double dydt[], void *params) {
  return end_without_memory(
      dynamics_rhs(t, y, dydt, ((struct motion *)params)->dynamics));
}

static int stage(double t, const double y[], const struct stage *s,
                 double out[], void *params) {
  return end_without_memory(
      dynamics_stage(t, y, s, out, ((struct motion *)params)->dynamics));
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[],
                    void *params) {
  return dynamics_jacobian(t, y, dfdy, dfdt,
                           ((struct motion *)params)->dynamics);
}

static double step_limit(const double y[], const double dydt[], void *params) {
  const struct motion *m = params;
  return dynamics_step_limit(m->dynamics, y, dydt, m->travel);
}

static int start_integrator(struct motion *m, const struct bed *b,
                            const struct integrate_options *o,
                            const struct dynamics_options *d) {
  const size_t dim = dynamics_dimension(m->dynamics);
  double *y = malloc(dim * sizeof *y), *scale = malloc(dim * sizeof *scale);
  int status = GSL_ENOMEM;
  if (y && scale) {
    dynamics_pack(m->dynamics, b, y);
    dynamics_scale(m->dynamics, scale);
    status = integrate_alloc(
        &m->integrator, o,
        &(struct integrate_problem){
            .system = {.function = rhs,
                       .jacobian = jacobian,
                       .dimension = dim,
                       .params = m},
            .scale = scale,
            .row = dynamics_stride(m->dynamics),
            .positions = ROW_V,
            .step_limit = m->travel > 0 ? step_limit : NULL,
            .stage = d->all_pairs ? NULL : stage,
            .threads = d->threads,
            .engine = &multirate_engine,
            .engine_params =
                &(struct multirate_problem){.dynamics = m->dynamics,
                                            .travel = m->travel}},
        b->t, y);
  }
  free(scale);
  free(y);
  return status;
}

int motion_alloc(struct motion **out, const struct scene *s,
                 const struct bed *b, const struct integrate_options *o,
                 const struct dynamics_options *d, double travel) {
  struct motion *m = calloc(1, sizeof *m);
  if (!m)
    return GSL_ENOMEM;
  m->travel = travel;
  int status = dynamics_alloc(&m->dynamics, s, b, d);
  if (status == GSL_SUCCESS)
    status = start_integrator(m, b, o, d);
  if (status != GSL_SUCCESS) {
    motion_free(m);
    return status;
  }
  *out = m;
  return GSL_SUCCESS;
}

int motion_alloc_over_floor(struct motion **out, const struct scene *s,
                            double radius, const double x[3], const double v[3],
                            const struct integrate_options *o, double travel) {
  if (s->walls_count > 0)
    return GSL_EINVAL;
  struct scene floored = *s;
  struct bed bed = {0};
  floored.walls = NULL;
  int status =
      scene_add_wall(&floored, (double[]){0, 0, 0}, (double[]){0, 0, -1});
  if (status == GSL_SUCCESS)
    status = bed_alloc(&bed, 1);
  if (status == GSL_SUCCESS) {
    bed.r[0] = radius;
    memcpy(bed.x, x, 3 * sizeof *x);
    memcpy(bed.v, v, 3 * sizeof *v);
    status = motion_alloc(out, &floored, &bed, o,
                          &(struct dynamics_options){.threads = 1}, travel);
  }
  bed_free(&bed);
  scene_free(&floored);
  return status;
}

const struct multirate *motion_multirate(const struct motion *m) {
  return integrate_engine(m->integrator);
}

void motion_store(struct motion *m, struct store *s) {
  dynamics_store(m->dynamics, s);
  integrate_store(m->integrator, s);
}

void motion_free(struct motion *m) {
  if (!m)
    return;
  integrate_free(m->integrator);
  dynamics_free(m->dynamics);
  free(m);
}
