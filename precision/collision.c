/* A sphere meets a wall, e = 1, no gravity, from as far away as where the run
   ends: against sech^2. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "closed_forms.h"
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
  struct scene scene = {.model = SCENE_BASIC, .law = c->law};
  struct bed bed = {0};
  struct motion m;
  int status =
      scene_add_wall(&scene, (double[]){0, 0, 0}, (double[]){0, 0, -1});
  if (status == GSL_SUCCESS)
    status = bed_alloc(&bed, 1);
  if (status == GSL_SUCCESS) {
    bed.r[0] = radius;
    bed.x[2] = radius + gap;
    bed.v[2] = velocity;
    status = motion_start(&m, &scene, &bed, c->integrate,
                          &(struct dynamics_options){.threads = 1}, c->travel);
  }
  bed_free(&bed);
  scene_free(&scene);
  if (status != GSL_SUCCESS)
    return status;
  measure_start(r);
  r->status = measure_until(m.integrator, 2 * tau, 10000000);
  measure_stop(r);
  const double *y = integrate_state(m.integrator);
  closed_collision(c->law.f0, c->law.kappa, c->speed, tau, &gap, &velocity);
  const double error[] = {fabs(y[2] - radius - gap), fabs(y[5] - velocity)};
  measure_add(r, m.integrator, dynamics_counts(m.dynamics).evaluations, error,
              2);
  motion_free(&m);
  measure_mean(r);
  return GSL_SUCCESS;
}

const struct precision_scene scene_collision = {
    .name = "collision",
    .summary = "a sphere meets a wall, e = 1, no gravity, against sech^2",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = defaults,
    .run = run};
