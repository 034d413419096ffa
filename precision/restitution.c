/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere meets a wall without gravity: its speed after the collision against
   the integral over the rebound function, at speeds where psi is finite. */
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

static const size_t most = 20000000;

static void defaults(struct precision_case *c) {
  c->gravity = 0;
  c->speed = 0.1;
}

static int prepare(const struct precision_case *c, void **out,
                   double reference_error[]) {
  double *speed = malloc(sizeof *speed);
  if (!speed)
    return GSL_ENOMEM;
  *out = speed;
  const int status =
      closed_restitution(&c->law, c->speed, speed, reference_error);
  reference_error[0] /= c->speed;
  return status;
}

/* Far: so that 1e-16 of the energy is stored further away. */
static int run(const struct precision_case *c, const void *reference,
               struct precision_result *r) {
  struct drop d = {.force = drop_contact, .law = c->law, .travel = c->travel};
  const double energy = 0.5 * c->speed * c->speed;
  const double far =
      log(c->law.f0 / (c->law.kappa * energy * 1e-16)) / c->law.kappa;
  struct integrator *it;
  const int status = drop_alloc(&it, &d, c->integrate, far, -c->speed);
  if (status != GSL_SUCCESS)
    return status;
  const double *y = integrate_state(it);
  measure_start(r);
  do
    r->status = measure_step(it, most);
  while (r->status == measure_ok && (y[1] <= 0 || y[0] < far));
  measure_stop(r);
  const double error = fabs(y[1] - *(const double *)reference) / c->speed;
  measure_add(r, it, d.evaluations, &error, 1);
  integrate_free(it);
  measure_mean(r);
  return GSL_SUCCESS;
}

const struct precision_scene scene_restitution = {
    .name = "restitution",
    .summary = "speed after a collision without gravity, against its integral",
    .errors = {"error_speed", NULL},
    .defaults = defaults,
    .prepare = prepare,
    .run = run};
