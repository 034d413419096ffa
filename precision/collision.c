/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere meets a wall, e = 1, no gravity. The run begins as far from the wall
   as it ends; the reference is the closed form sech^2. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

static const double radius = 0.1;

static void defaults(struct precision_case *c) {
  c->law.restitution = 1;
  c->law.friction = 0;
  c->law.lmax = 1; /* F0 exp(-150) there: no cut */
  c->gravity = 0;
  c->speed = 1;
}

static int run(const struct precision_case *c, const void *reference,
               struct precision_result *r) {
  (void)reference;
  const double tau = 20 / (c->law.kappa * c->speed);
  double gap, velocity;
  closed_collision(c->law.f0, c->law.kappa, c->speed, -tau, &gap, &velocity);
  const struct scene scene = {.model = SCENE_BASIC, .law = c->law};
  struct motion *m = NULL;
  const int status = motion_alloc_over_floor(
      &m, &scene, radius, (double[]){0, 0, radius + gap},
      (double[]){0, 0, velocity}, c->integrate, c->travel);
  if (status != GSL_SUCCESS)
    return status;
  measure_start(r);
  r->status = measure_until(m->integrator, 2 * tau, 10000000);
  measure_stop(r);
  const double *y = integrate_state(m->integrator);
  closed_collision(c->law.f0, c->law.kappa, c->speed, tau, &gap, &velocity);
  const double error[] = {fabs(y[ROW_X + 2] - radius - gap),
                          fabs(y[ROW_V + 2] - velocity)};
  measure_add(r, m->integrator, dynamics_counts(m->dynamics).evaluations, error,
              2);
  motion_free(m);
  measure_mean(r);
  return GSL_SUCCESS;
}

const struct precision_scene scene_collision = {
    .name = "collision",
    .summary = "a sphere meets a wall, e = 1, no gravity, against sech^2",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = defaults,
    .run = run};
