/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The criterion of rest on motions whose rest is known: creep at a steady rate,
   lulls between avalanches, oscillation; in the units of other spheres; and
   beds by several methods. */
#include <float.h>
#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "dynamics/motion.h"
#include "model/fill.h"
#include "model/rest.h"

/* A bed as the criterion sees it: at(t) gives the kinetic energy of a sphere
   and the energy of its place, whose height's energy is 1 (J). */
struct seen {
  double kinetic, energy;
};

static const struct similarity paper = {1, 1, 1, 1};

/* When it is called at rest, in steps of dt until end; infinity if never. */
static double rests_at(struct seen (*at)(double t), const struct similarity *s,
                       double dt, double end) {
  struct rest_watch w = rest_watch_begin(0, s);
  for (size_t k = 0; (double)k * dt <= end; k++) {
    const double t = (double)k * dt;
    const struct seen v = at(t);
    if (rest_watch_see(&w, t, v.kinetic))
      rest_watch_sample(&w, t, v.energy, 1);
    if (rest_watch_rests(&w, t))
      return t;
  }
  return GSL_POSINF;
}

static struct seen still(double t) {
  (void)t;
  return (struct seen){0, 7};
}

/* 0.49 % and 0.51 % in 5 s. */
static struct seen slow(double t) {
  return (struct seen){1e-6, 7 - 0.0049 / 5 * t};
}
static struct seen quick(double t) {
  return (struct seen){1e-6, 7 - 0.0051 / 5 * t};
}

/* At a rate that falls to 0.5 % in 5 s at t = 20: 0.02 ln t, where
   0.02 ln(t/(t - 5)) = 0.005 at t = 5/(1 - exp(-1/4)). */
static struct seen slower_and_slower(double t) {
  return (struct seen){1e-6, 7 - 0.02 * log(1 + t)};
}

/* Lulls of 3.9 s without any loss between avalanches of 0.1 s. */
static struct seen avalanches(double t) {
  const double n = floor(t / 4), within = t - 4 * n;
  return (struct seen){within > 3.9 ? 1e-3 : 0,
                       7 - 0.01 * (n + fmax(0, within - 3.9) / 0.1)};
}

/* Up and down for good, the same after each 5 s. */
static struct seen swinging(double t) {
  const double c = cos(2 * M_PI * t / 5);
  return (struct seen){0.01 * c * c, 7 + 0.01 * sin(2 * M_PI * t / 5)};
}

/* Something moves for a moment every 0.97 s and 1.03 s. */
static struct seen moves_each(double t, double period) {
  const double n = floor(t / period);
  return (struct seen){t - n * period < 0.02 ? 1 : 0, 7};
}
static struct seen restless(double t) {
  return moves_each(t, 0.97);
}
static struct seen calm(double t) {
  return moves_each(t, 1.03);
}

static struct seen nothing(double t) {
  return (struct seen){t < 3 ? GSL_NAN : 0, 7};
}

static void test_motions(void) {
  const double dt = 0.01, sample = 0.5, end = 60;
  CHECK_CLOSE(rests_at(still, &paper, dt, end), 5, 2 * dt);
  CHECK_CLOSE(rests_at(slow, &paper, dt, end), 5, 2 * dt);
  CHECK(rests_at(quick, &paper, dt, end) == GSL_POSINF);
  CHECK(rests_at(avalanches, &paper, dt, end) == GSL_POSINF);
  CHECK(rests_at(swinging, &paper, dt, end) == GSL_POSINF);
  CHECK_CLOSE(rests_at(nothing, &paper, dt, end), 5, 2 * dt);
  CHECK(rests_at(restless, &paper, dt, end) == GSL_POSINF);
  /* the fifth lull has its second after 5 s */
  CHECK_CLOSE(rests_at(calm, &paper, dt, end), 4 * 1.03 + 0.02 + 1, 2 * dt);
  const double want = 5 / (1 - exp(-0.25)) - 1;
  CHECK_CLOSE(rests_at(slower_and_slower, &paper, dt, end), want,
              sample + 2 * dt);
  /* and by steps of any length, those of a stiff method too */
  for (double step = 1e-3; step < 3; step *= 3) {
    CHECK_CLOSE(rests_at(slower_and_slower, &paper, step, end), want,
                sample + 2 * step);
    CHECK(rests_at(quick, &paper, step, end) == GSL_POSINF);
  }
}

/* Spheres of 1/64 of the radius and 4 times the mass rest in an eighth of the
   time, as exactly as powers of two are. */
static struct seen small_slower(double t) {
  struct seen v = slower_and_slower(8 * t);
  v.kinetic *= 4. / 64;
  return v;
}
static struct seen small_fast(double t) {
  (void)t;
  return (struct seen){1.01 * 5e-5 * 4 / 64, 7};
}
static void test_similar(void) {
  const struct similarity small = similarity_of(0.1 / 64, 4, 9.81);
  CHECK(small.time == 0.125);
  CHECK(rests_at(small_slower, &small, 0.0078125 / 8, 8) ==
        rests_at(slower_and_slower, &paper, 0.0078125, 64) / 8);
  CHECK(rests_at(small_fast, &small, 0.01, 60) == GSL_POSINF);
}

/* Without gravity there is no energy of height to lose: speeds decide. */
static void test_weightless(void) {
  struct rest_watch w = rest_watch_begin(0, &paper);
  for (double t = 0; t < 6; t += 0.25)
    if (rest_watch_see(&w, t, 0))
      rest_watch_sample(&w, t, -t, 0);
  CHECK(rest_watch_rests(&w, 6));
}

/* The time at which a bed without friction rests, by a method (s). */
static double bed_rests_at(const char *method, double tol, double step,
                           double *overlap) {
  struct scene s = scene_default();
  s.model = SCENE_BASIC;
  CHECK(scene_add_box(&s, 0.5, 0.5) == GSL_SUCCESS);
  const struct fill f = {.count = 30,
                         .radius = 0.1,
                         .mass = 1,
                         .base = {0.5, 0.5},
                         .drop = 1.1,
                         .jitter = 0.25,
                         .seed = 1};
  struct bed b = {0};
  CHECK(fill_grid(&f, &b) == GSL_SUCCESS);
  struct integrate_options o = {
      .method = method, .tol = tol, .step = step, .hinit = 0.1};
  integrate_defaults(&o);
  struct motion *m = NULL;
  CHECK(motion_alloc(&m, &s, &b, &o, &(struct dynamics_options){.threads = 1},
                     1 / s.law.kappa) == GSL_SUCCESS);
  struct rest_watch w = rest_watch_begin(0, &paper);
  double t = 0;
  bool rests = false;
  struct survey v = {0};
  while (!rests && t < 30 && integrate_step(m->integrator) == GSL_SUCCESS) {
    const double *y = integrate_state(m->integrator);
    t = integrate_time(m->integrator);
    if (rest_watch_see(&w, t, dynamics_kinetic(m->dynamics, y) / (double)b.n)) {
      CHECK(dynamics_survey(m->dynamics, y, &v) == GSL_SUCCESS);
      /* the height's energy, from the lowest sphere's surface */
      CHECK(v.height > 0.5 * (double)b.n * 9.81 * f.radius &&
            v.height < v.gravity + (double)b.n * 9.81 * f.radius);
      rest_watch_sample(&w, t, v.gravity + v.stored, v.height);
    }
    rests = rest_watch_rests(&w, t);
  }
  *overlap = v.overlap;
  motion_free(m);
  bed_free(&b);
  scene_free(&s);
  return rests ? t : GSL_POSINF;
}

/* Every method says so at the same time: 5 s after the first quiet energy at
   about 1.5 s, give or take a long step of a stiff method. */
static void test_methods(void) {
  const struct {
    const char *name;
    double tol, step;
  } methods[] = {{"rkc", 0, 0},
                 {"multirate", 0, 0},
                 {"merson", 0, 0},
                 {"verlet", 0, 2e-4}};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    double overlap;
    const double t = bed_rests_at(methods[k].name, methods[k].tol,
                                  methods[k].step, &overlap);
    printf("%s: at rest at %.3g s, overlap %.3g r\n", methods[k].name, t,
           overlap);
    CHECK_CLOSE(t, 6.75, 0.75);
  }
}

int main(void) {
  test_motions();
  test_similar();
  test_weightless();
  test_methods();
  return check_done();
}
