/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere that slides on the floor until it rolls, and a block on a slope.
   Friction is only C^1: at
   the slip speed vmin its second derivative jumps. The error that this causes
   depends on where within a step it happens, so errors are root mean squares
   over MEASURE_STARTS runs. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

static const double radius = 0.1, direction[2] = {0.6, 0.8};

static const size_t most = 20000000;

/* Deceleration of the slip under full friction: 1 + 5/2 times the sphere's. */
static double full_rate(const struct precision_case *c) {
  return 3.5 * c->law.friction * c->gravity / contact_rebound(&c->law, 0);
}

static double slip_of(const double y[]) {
  return hypot(y[ROW_V] - radius * y[ROW_W + 1],
               y[ROW_V + 1] + radius * y[ROW_W]);
}

/* The k-th run: slides with the given speed, at rest on the floor. */
static int start(const struct precision_case *c, double speed, size_t k,
                 struct motion **m) {
  const struct integrate_options o = measure_variant(c->integrate, k);
  const struct scene scene = {
      .model = SCENE_ROTATION, .law = c->law, .gravity = {0, 0, -c->gravity}};
  const double rest = closed_rest_gap(&c->law, c->gravity);
  return motion_alloc_over_floor(
      m, &scene, radius, (double[]){0, 0, radius + rest},
      (double[]){speed * direction[0], speed * direction[1], 0}, &o, c->travel);
}

/* The runs start earlier by shares of the time that friction takes to go
   through vmin. */
static double earlier(const struct precision_case *c, size_t k) {
  return c->law.vmin / full_rate(c) * (double)k / MEASURE_STARTS;
}

/* A run is over: adds its errors, of which there may be none yet. */
static void finish(struct precision_result *r, struct motion *m,
                   const char *word, const double error[], size_t errors) {
  if (errors)
    measure_add(r, m->integrator, dynamics_counts(m->dynamics).evaluations,
                error, errors);
  if (word != measure_ok)
    r->status = word;
  motion_free(m);
}

/* Error of the final velocity: 5/7 of the first, and the slip that is left. */
static int run_velocity(const struct precision_case *c, const void *reference,
                        struct precision_result *r) {
  (void)reference;
  const double rate = full_rate(c);
  const double full = (c->speed - c->law.vmin) / rate;
  double share;
  int status = closed_slip_share(c->time - full, c->law.vmin, rate, &share);
  for (size_t k = 0; k < MEASURE_STARTS && status == GSL_SUCCESS; k++) {
    struct motion *m = NULL;
    const double more = earlier(c, k), v0 = c->speed + rate * more;
    status = start(c, v0, k, &m);
    if (status != GSL_SUCCESS)
      return status;
    measure_start(r);
    const char *word = measure_until(m->integrator, c->time + more, most);
    measure_stop(r);
    const double *y = integrate_state(m->integrator);
    const double rolling = 5. / 7 * v0 + 2. / 7 * share * c->law.vmin;
    const double spin[2] = {radius * y[ROW_W + 1], -radius * y[ROW_W]};
    double off[2], kept[2];
    for (int i = 0; i < 2; i++) {
      off[i] = y[3 + i] - rolling * direction[i];
      kept[i] = y[3 + i] + 0.4 * spin[i] - v0 * direction[i];
    }
    const double error[] = {hypot(off[0], off[1]), hypot(kept[0], kept[1])};
    finish(r, m, word, error, 2);
  }
  measure_mean(r);
  return status;
}

struct slipping {
  double slip, rate;
  struct contact_law law;
};

/* Slip falls ever more slowly, so the tangent meets the target too early. */
static double to_slip(const double y[], const double dydt[], void *params) {
  (void)dydt;
  const struct slipping *s = params;
  const double slip = slip_of(y);
  return (slip - s->slip) / (s->rate * contact_limiter(&s->law, slip));
}

/* Time at which slip is half of vmin. */
static int run_transition(const struct precision_case *c, const void *reference,
                          struct precision_result *r) {
  (void)reference;
  const double rate = full_rate(c);
  const double exact = (c->speed - c->law.vmin) / rate +
                       closed_slip_time(0.5, c->law.vmin, rate);
  for (size_t k = 0; k < MEASURE_STARTS; k++) {
    struct motion *m = NULL;
    const double more = earlier(c, k);
    const int status = start(c, c->speed + rate * more, k, &m);
    if (status != GSL_SUCCESS)
      return status;
    struct slipping s = {0.5 * c->law.vmin, rate, c->law};
    measure_start(r);
    const char *word = measure_event(m->integrator, to_slip, &s, most);
    measure_stop(r);
    /* a step that passed it, by an interpolation of first order: never with
       the bound of to_slip but for errors of the method */
    const double *y = integrate_state(m->integrator);
    const double error = fabs(integrate_time(m->integrator) +
                              to_slip(y, NULL, &s) - exact - more);
    finish(r, m, word, &error, 1);
  }
  measure_mean(r);
  return GSL_SUCCESS;
}

/* A block, which does not turn, on two slopes: where half of the friction that
   it can have holds it, from vmin down to the creep at vmin/2; and where as
   much again as it can have is missing, so that it goes faster. At rest
   friction can hold 2 phi/(1 + e^2) of the load. */
static int run_slope(const struct precision_case *c, const void *reference,
                     struct precision_result *r) {
  (void)reference;
  const double hold = c->law.friction / contact_rebound(&c->law, 0);
  double error[2];
  for (size_t k = 0; k < 2 * MEASURE_STARTS; k++) {
    const bool steep = k % 2;
    const struct integrate_options o = measure_variant(c->integrate, k / 2);
    const double slope = atan((steep ? 2 : 0.5) * hold);
    const double load = c->gravity * cos(slope), rate = hold * load;
    const struct scene scene = {.model = SCENE_FRICTION,
                                .law = c->law,
                                .gravity = {c->gravity * sin(slope), 0, -load}};
    struct motion *m = NULL;
    const int status = motion_alloc_over_floor(
        &m, &scene, radius,
        (double[]){0, 0, radius + closed_rest_gap(&c->law, load)},
        (double[]){c->law.vmin, 0, 0}, &o, c->travel);
    if (status != GSL_SUCCESS)
      return status;
    measure_start(r);
    const char *word = measure_until(m->integrator, c->time, most);
    measure_stop(r);
    const double v = integrate_state(m->integrator)[ROW_V];
    error[steep] = fabs(v - (steep ? c->law.vmin + rate * c->time
                                   : closed_creep(c->time, c->law.vmin, rate)));
    finish(r, m, word, error, steep ? 2 : 0); /* both with the second */
  }
  measure_mean(r);
  return GSL_SUCCESS;
}

static void defaults_of_slope(struct precision_case *c) {
  c->law.lmax = 1;
  /* in which the speed has come half of the way to vmin/2 */
  c->time = 0.003;
}

static void defaults(struct precision_case *c) {
  c->law.lmax = 1;
  c->speed = 1;
  c->time = 0.1;
}

const struct precision_scene scene_rolling = {
    .name = "rolling",
    .summary = "sliding to rolling: velocity against 5/7 of the first and the "
               "slip that is left, and v + 2/5 r omega",
    .errors = {"error_velocity", "error_conserved", NULL},
    .defaults = defaults,
    .run = run_velocity};

const struct precision_scene scene_transition = {
    .name = "transition",
    .summary = "sliding to rolling: the time at which slip is vmin/2",
    .errors = {"error_time", NULL},
    .defaults = defaults,
    .run = run_transition};

const struct precision_scene scene_slope = {
    .name = "slope",
    .summary = "a block on a slope: creep where 2 phi/(1 + e^2) holds twice as "
               "much, and sliding at twice of it",
    .errors = {"error_creep", "error_sliding", NULL},
    .defaults = defaults_of_slope,
    .run = run_slope};
