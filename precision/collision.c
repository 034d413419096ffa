/* A sphere meets a wall, e = 1, no gravity: closed form 1 of sech^2. In time it
   is symmetric about the turning point, where
     exp(-kappa l_min) = kappa v0^2 / (2 F0),
   and the run ends after as long a way out as in. */
#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "measure.h"

static void defaults(struct precision_case *c) {
  c->law.restitution = 1;
  c->law.friction = 0;
  c->law.lmax = 1; /* F0 exp(-150) there: no cut */
  c->gravity = 0;
  c->speed = 1;
}

/* Gap at time tau from the turning point, and the velocity. */
static void exact(const struct precision_case *c, double tau, double *gap,
                  double *velocity) {
  const double kappa = c->law.kappa, v0 = c->speed;
  const double x = kappa * v0 * tau / 2;
  *gap = -log(kappa * v0 * v0 / (2 * c->law.f0)) / kappa +
         2 / kappa * (fabs(x) + log1p(exp(-2 * fabs(x))) - M_LN2);
  *velocity = v0 * tanh(x);
}

static int run(const struct precision_case *c, const void *reference,
               struct precision_result *r) {
  (void)reference;
  const double radius = 0.1, tau = 20 / (c->law.kappa * c->speed);
  double gap, velocity;
  exact(c, -tau, &gap, &velocity);
  struct scene scene = {.model = SCENE_BASIC, .law = c->law};
  struct bed bed;
  struct motion m;
  int status =
      scene_add_wall(&scene, (double[]){0, 0, 0}, (double[]){0, 0, -1});
  if (status == GSL_SUCCESS)
    status = bed_alloc(&bed, 1);
  if (status != GSL_SUCCESS)
    return status;
  bed.r[0] = radius;
  bed.x[2] = radius + gap;
  bed.v[2] = velocity;
  status = motion_start(&m, &scene, &bed, c->integrate,
                        &(struct dynamics_options){.threads = 1}, c->travel);
  bed_free(&bed);
  scene_free(&scene);
  if (status != GSL_SUCCESS)
    return status;
  r->status = measure_until(m.integrator, 2 * tau, 10000000);
  const double *y = integrate_state(m.integrator);
  exact(c, tau, &gap, &velocity);
  r->error[0] = fabs(y[2] - radius - gap);
  r->error[1] = fabs(y[5] - velocity);
  measure_counts(&m, r);
  motion_free(&m);
  return GSL_SUCCESS;
}

const struct precision_scene scene_collision = {
    .name = "collision",
    .summary = "a sphere meets a wall, e = 1, no gravity, against sech^2",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = defaults,
    .run = run};
