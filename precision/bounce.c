/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere dropped from 16 m: time of the first apex after the rebound, and
   the energy there. The reference is the energy integral for e = 1, else two
   methods at a tight tolerance, which integrate the contact only: before and
   after it the path is a parabola. */
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

static const double height = 16;

/* More steps than any run takes. */
static const size_t most = 5000000;

struct reference {
  double time, energy;
};

/* From where F is below 1e-18 F0 and back there. */
static int converge(const struct precision_case *c, const char *method,
                    struct reference *r) {
  struct drop d = {.force = drop_contact, .law = c->law, .gravity = c->gravity};
  const double far = 42 / c->law.kappa;
  const double fall = sqrt(2 * (height - far) / c->gravity);
  const struct integrate_options o = {
      .method = method, .control = "standard", .tol = 1e-14, .hinit = 1e-6};
  struct integrator *it;
  int status = drop_alloc(&it, &d, &o, far, -c->gravity * fall);
  if (status != GSL_SUCCESS)
    return status;
  const double *y = integrate_state(it);
  do
    status = integrate_step(it);
  while (status == GSL_SUCCESS && (y[1] <= 0 || y[0] < far));
  *r = (struct reference){fall + integrate_time(it) + y[1] / c->gravity,
                          drop_energy(&d, y)};
  integrate_free(it);
  return status;
}

static int prepare(const struct precision_case *c, void **out,
                   double reference_error[]) {
  struct reference r = {0}, other = {0};
  int status;
  if (c->law.restitution == 1) {
    status = closed_rebound_time(c->law.f0, c->law.kappa, c->gravity, height,
                                 &r.time, &reference_error[0]);
    r.energy = c->gravity * height;
  } else {
    status = converge(c, "rk8pd", &r);
    if (status == GSL_SUCCESS)
      status = converge(c, "dopri5", &other);
    reference_error[0] = fabs(r.time - other.time);
    reference_error[1] = fabs(r.energy / other.energy - 1);
  }
  struct reference *copy = malloc(sizeof *copy);
  if (!copy)
    return GSL_ENOMEM;
  *copy = r;
  *out = copy;
  return status;
}

struct ascent {
  double gravity;
  bool rising;
};

/* The remaining force of the contact adds to the way up, so the bound holds. A
   sphere that is thrown up extremely far has no apex worth waiting for. */
static double to_apex(const double y[], const double dydt[], void *params) {
  (void)dydt;
  struct ascent *a = params;
  if (y[0] > 100 * height)
    return 0;
  if (y[1] <= 0)
    return a->rising ? 0 : GSL_POSINF;
  a->rising = true;
  return y[0] > 0 ? y[1] / a->gravity : GSL_POSINF;
}

static int run(const struct precision_case *c, const void *reference,
               struct precision_result *r) {
  const struct reference *exact = reference;
  struct drop d = {.force = drop_contact,
                   .law = c->law,
                   .gravity = c->gravity,
                   .travel = c->travel};
  struct integrator *it;
  const int status = drop_alloc(&it, &d, c->integrate, height, 0);
  if (status != GSL_SUCCESS)
    return status;
  struct ascent a = {c->gravity, false};
  measure_start(r);
  r->status = measure_event(it, to_apex, &a, most);
  measure_stop(r);
  const double *y = integrate_state(it);
  /* the rounding of the landing, or a step that passed the apex */
  const double time = integrate_time(it) + y[1] / c->gravity;
  const double error[] = {fabs(time - exact->time),
                          fabs(drop_energy(&d, y) / exact->energy - 1)};
  measure_add(r, it, d.evaluations, error, 2);
  if (r->status == measure_ok && !(error[1] <= 1))
    r->status = "lost";
  integrate_free(it);
  measure_mean(r);
  return GSL_SUCCESS;
}

static void defaults(struct precision_case *c) {
  c->law.restitution = 1;
}

const struct precision_scene scene_bounce = {
    .name = "bounce",
    .summary = "a sphere dropped from 16 m, its first apex; --restitution 1 "
               "against the energy integral",
    .errors = {"error_time", "error_energy", NULL},
    .defaults = defaults,
    .prepare = prepare,
    .run = run};
