/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step for each sphere: what must be conserved, agreement with sharp runs of
   rkc and order against the tolerance, scenes whose levels border everywhere,
   costs that are local, states within a step, bits for any number of threads,
   and the contract of an integrator. Random scenes are numbered by their
   seeds. */
#define _POSIX_C_SOURCE 200809L /* setrlimit */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "limit.h"
#include "dynamics/level.h"
#include "dynamics/motion.h"
#include "dynamics/trace.h"
#include "sample.h"
#include "steppers/hermite.h"

/* --- scenes ----------------------------------------------------------------*/

struct sample {
  struct scene scene;
  struct bed bed;
};

static void sample_free(struct sample *s) {
  bed_free(&s->bed);
  scene_free(&s->scene);
}

static struct sample sample_new(enum scene_model model, size_t n) {
  struct sample s = {.scene = scene_default()};
  s.scene.model = model;
  if (bed_alloc(&s.bed, n) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++)
    s.bed.r[i] = 0.1;
  return s;
}

static void weightless(struct sample *s) {
  memset(s->scene.gravity, 0, sizeof s->scene.gravity);
}

/* A cube of side^3 spheres, spacing apart, around the centre, that move
   inwards: a collision of all with all. */
static struct sample cluster(enum scene_model model, size_t side,
                             double spacing, double speed,
                             const double centre[3], unsigned long seed) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  struct sample s = sample_new(model, side * side * side);
  weightless(&s);
  for (size_t i = 0; i < s.bed.n; i++) {
    const size_t at[3] = {i % side, i / side % side, i / side / side};
    for (size_t k = 0; k < 3; k++) {
      const double x = spacing * ((double)at[k] - 0.5 * (double)(side - 1)) +
                       uniform(rng, -0.01, 0.01);
      s.bed.x[3 * i + k] = centre[k] + x;
      s.bed.v[3 * i + k] = -speed * x + uniform(rng, -0.1, 0.1);
      s.bed.w[3 * i + k] = uniform(rng, -5, 5);
    }
  }
  gsl_rng_free(rng);
  return s;
}

static const double origin[3] = {0, 0, 0};

enum { TOLERANCES = 3 };
static const double tolerances[TOLERANCES] = {1e-2, 1e-3, 1e-4};

/* Spheres dropped into a narrow box. */
static struct sample rain(enum scene_model model, size_t n, bool mixed,
                          unsigned long seed) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  struct sample s = sample_new(model, n);
  if (scene_add_box(&s.scene, 0.6, 0.6) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++) {
    s.bed.x[3 * i] = 0.15 + 0.3 * (double)(i % 2) + uniform(rng, 0, 0.02);
    s.bed.x[3 * i + 1] =
        0.15 + 0.3 * (double)(i / 2 % 2) + uniform(rng, 0, 0.02);
    s.bed.x[3 * i + 2] = 0.15 + 0.25 * (double)(i / 4);
    if (mixed) {
      s.bed.r[i] = uniform(rng, 0.08, 0.12);
      s.bed.m[i] = uniform(rng, 0.5, 2);
    }
  }
  gsl_rng_free(rng);
  return s;
}

/* --- runs ------------------------------------------------------------------*/

static struct motion *start(const struct sample *s, const char *method,
                            double tol, int threads) {
  const bool local = !strcmp(method, "multirate");
  const struct integrate_options o = {.method = method,
                                      .control = local ? "local" : "predictive",
                                      .tol = tol,
                                      .hinit = 1e-4};
  struct motion *m = NULL;
  if (motion_alloc(&m, &s->scene, &s->bed, &o,
                   &(struct dynamics_options){.threads = threads},
                   1 / s->scene.law.kappa) != GSL_SUCCESS)
    abort();
  return m;
}

static bool run_to(struct motion *m, double end) {
  if (integrate_stop(m->integrator, end) != GSL_SUCCESS)
    return CHECK(!"a later end");
  while (integrate_time(m->integrator) < end)
    if (integrate_step(m->integrator) != GSL_SUCCESS)
      return CHECK(!"a step is taken");
  return CHECK(integrate_time(m->integrator) == end);
}

/* Runs a sample to its end; the sample's bed is the state there. */
static struct dynamics_counts run(struct sample *s, const char *method,
                                  double tol, double end) {
  struct motion *m = start(s, method, tol, 1);
  run_to(m, end);
  dynamics_unpack(m->dynamics, integrate_state(m->integrator), &s->bed);
  const struct dynamics_counts counts = dynamics_counts(m->dynamics);
  motion_free(m);
  return counts;
}

/* Largest difference of two beds in any position by 1/kappa or velocity. */
static double distance(const struct sample *a, const struct sample *b) {
  double most = 0;
  for (size_t i = 0; i < 3 * a->bed.n; i++) {
    const double x = fabs(a->bed.x[i] - b->bed.x[i]) * a->scene.law.kappa,
                 v = fabs(a->bed.v[i] - b->bed.v[i]);
    if (!(x <= most))
      most = x;
    if (!(v <= most))
      most = v;
  }
  return most;
}

static void momentum(const struct bed *b, double p[3]) {
  for (size_t k = 0; k < 3; k++) {
    p[k] = 0;
    for (size_t i = 0; i < b->n; i++)
      p[k] += b->m[i] * b->v[3 * i + k];
  }
}

/* --- exact and conserved ---------------------------------------------------*/

/* Free fall is a polynomial of degree 2, which the method has without error. */
static void test_free_fall(void) {
  struct sample s = sample_new(SCENE_ROTATION, 2);
  s.bed.x[2] = 5;
  s.bed.x[3] = 3; /* the other one apart */
  s.bed.v[0] = 1;
  s.bed.v[5] = 2;
  run(&s, "multirate", 1e-3, 0.5);
  const double fall = 0.5 * 9.81 * 0.25;
  CHECK_CLOSE(s.bed.x[0], 0.5, 1e-13);
  CHECK_CLOSE(s.bed.x[2], 5 - fall, 1e-13);
  CHECK_CLOSE(s.bed.x[5], 1 - fall, 1e-13);
  CHECK_CLOSE(s.bed.v[2], -9.81 * 0.5, 1e-13);
  sample_free(&s);
}

/* Forces on partners in two levels balance up to the tolerance only; what is
   lost of the momentum in a run is far less than the tolerance for each sphere,
   since the errors of steps have no common direction. */
static void test_momentum(enum scene_model model) {
  for (size_t q = 0; q < TOLERANCES; q++) {
    const double tol = tolerances[q];
    struct sample s = cluster(model, 4, 0.24, 2, origin, 1);
    double before[3], after[3], lost = 0;
    momentum(&s.bed, before);
    run(&s, "multirate", tol, 0.4);
    momentum(&s.bed, after);
    for (size_t k = 0; k < 3; k++)
      lost = GSL_MAX(lost, fabs(after[k] - before[k]));
    printf("momentum: model %d, tol %g: %.3g lost\n", model, tol, lost);
    CHECK_CLOSE(lost, 0, tol * (double)s.bed.n);
    sample_free(&s);
  }
}

/* Kinetic energy and what contacts store: its largest gain and loss in a run,
   as shares of the first. */
static void energy_changes(const char *method, bool elastic, double tol,
                           double *gain, double *loss) {
  struct sample s =
      cluster(elastic ? SCENE_BASIC : SCENE_ROTATION, 3, 0.24, 2, origin, 2);
  if (elastic)
    s.scene.law.restitution = 1;
  const double e = s.scene.law.restitution;
  struct motion *m = start(&s, method, tol, 1);
  struct survey v;
  double first = 0, least = GSL_POSINF;
  *gain = *loss = 0;
  for (size_t k = 0; integrate_time(m->integrator) < 0.4; k++) {
    const double *y = integrate_state(m->integrator);
    CHECK(dynamics_survey(m->dynamics, y, &v) == GSL_SUCCESS);
    const double now =
        dynamics_kinetic(m->dynamics, y) + 0.5 * (1 + e * e) * v.stored;
    if (k == 0)
      first = now;
    least = GSL_MIN(least, now);
    *gain = GSL_MAX(*gain, (now - least) / first);
    *loss = GSL_MAX(*loss, (first - now) / first);
    if (!CHECK(integrate_step(m->integrator) == GSL_SUCCESS))
      break;
  }
  motion_free(m);
  sample_free(&s);
}

/* It never grows with friction and dissipation. For e = 1 and no friction it is
   constant up to the method's errors, which are rkc's. */
static void test_energy(void) {
  for (size_t k = 0; k < TOLERANCES; k++) {
    const double tol = tolerances[k];
    double gain, loss, plain_gain, plain_loss;
    energy_changes("multirate", false, tol, &gain, &loss);
    CHECK_CLOSE(gain, 0, 0.1 * tol);
    CHECK(loss > 0.5);
    energy_changes("multirate", true, tol, &gain, &loss);
    energy_changes("rkc", true, tol, &plain_gain, &plain_loss);
    printf("energy, e = 1, tol %g: gain %.3g, loss %.3g, rkc's %.3g, %.3g\n",
           tol, gain, loss, plain_gain, plain_loss);
    CHECK_CLOSE(gain + loss, 0, 2 * (plain_gain + plain_loss) + tol);
  }
}

/* --- against sharp runs ----------------------------------------------------*/

/* Each step of each run against a sharp one from the same start: no sphere's
   error is more than the estimate lets through, whichever level took it. */
static void test_local(enum scene_model model, bool mixed, double tol) {
  struct sample s = rain(model, 12, mixed, 3);
  struct motion *m = start(&s, "multirate", tol, 1);
  double worst = 0;
  while (integrate_time(m->integrator) < 0.25 &&
         CHECK(integrate_step(m->integrator) == GSL_SUCCESS)) {
    const struct integrate_view v = integrate_view(m->integrator);
    struct sample c = rain(model, 12, mixed, 3),
                  got = rain(model, 12, mixed, 3);
    dynamics_unpack(m->dynamics, v.start, &c.bed);
    dynamics_unpack(m->dynamics, v.y, &got.bed);
    run(&c, "rkc", 1e-8, v.last_step);
    worst = GSL_MAX(worst, distance(&c, &got) / tol);
    sample_free(&c);
    sample_free(&got);
  }
  printf("steps: model %d, tol %g: error at most %.2g of it\n", model, tol,
         worst);
  CHECK_CLOSE(worst, 0, 1.5);
  motion_free(m);
  sample_free(&s);
}

/* The error of a run is of the size of rkc's at the same tolerance, but for the
   spheres that rkc's common steps are far too short for, and falls with the
   tolerance as a method's of order 2: with its power 2/3, where each step has
   the same error, to 1. */
static void test_order(enum scene_model model, bool mixed) {
  const double end = 0.25;
  struct sample sharp = rain(model, 12, mixed, 3);
  run(&sharp, "rkc", 1e-8, end);
  double error[4];
  for (int k = 0; k < 4; k++) {
    struct sample s = rain(model, 12, mixed, 3), r = rain(model, 12, mixed, 3);
    const double tol = 1e-2 * pow(10, -k);
    run(&s, "multirate", tol, end);
    run(&r, "rkc", tol, end);
    error[k] = distance(&s, &sharp);
    const double plain = distance(&r, &sharp);
    printf("order: model %d, tol %g: error %.3g, rkc's %.3g\n", model, tol,
           error[k], plain);
    CHECK(error[k] <= 3 * plain + 25 * tol);
    sample_free(&s);
    sample_free(&r);
  }
  const double order = log10(error[0] / error[3]) / 3;
  CHECK_CLOSE(order, 0.85, 0.35);
  sample_free(&sharp);
}

/* --- levels that border everywhere -----------------------------------------*/

/* A chain of spheres in contact of which every fifth one is fast, and a layer
   of them in the pattern of a knight's moves: each fast sphere has four
   partners that are not, and each of those one that is. */
static struct sample board(size_t columns, size_t lines, double speed) {
  struct sample s = sample_new(SCENE_ROTATION, columns * lines);
  weightless(&s);
  for (size_t i = 0; i < s.bed.n; i++) {
    const size_t a = i % columns, b = i / columns;
    s.bed.x[3 * i] = 0.21 * (double)a;
    s.bed.x[3 * i + 1] = 0.21 * (double)b;
    if ((a + 2 * b) % 5 == 2) {
      s.bed.v[3 * i + (b % 2 ? 1 : 0)] = speed;
      s.bed.w[3 * i + 2] = 100 * speed;
    }
  }
  return s;
}

static void test_board(size_t columns, size_t lines, double speed) {
  const double tol = 1e-3, end = 0.1;
  struct sample s = board(columns, lines, speed),
                sharp = board(columns, lines, speed);
  double before[3], after[3];
  momentum(&s.bed, before);
  struct motion *m = start(&s, "multirate", tol, 1);
  run_to(m, end);
  dynamics_unpack(m->dynamics, integrate_state(m->integrator), &s.bed);
  const struct multirate_report r = multirate_report(motion_multirate(m));
  motion_free(m);
  momentum(&s.bed, after);
  run(&sharp, "rkc", 1e-8, end);
  const double steps = (double)r.steps[0];
  printf("board of %zu x %zu at %g m/s: %zu steps, %zu and %zu below, error "
         "%.3g, momentum %.3g\n",
         columns, lines, speed, r.steps[0], r.steps[1], r.steps[2],
         distance(&s, &sharp), fabs(after[0] - before[0]));
  CHECK(r.steps[1] > 0); /* levels there are */
  for (size_t k = 0; k < 3; k++)
    CHECK_CLOSE(after[k], before[k], tol * sqrt(steps * (double)s.bed.n));
  CHECK_CLOSE(distance(&s, &sharp), 0, 10 * tol * sqrt(steps));
  sample_free(&s);
  sample_free(&sharp);
}

/* --- costs that are local --------------------------------------------------*/

static struct sample join(const struct sample *a, const struct sample *b) {
  struct sample s = sample_new(a->scene.model, a->bed.n + b->bed.n);
  memcpy(s.scene.gravity, a->scene.gravity, sizeof s.scene.gravity);
  const struct bed *from[2] = {&a->bed, &b->bed};
  for (size_t k = 0, at = 0; k < 2; at += from[k++]->n) {
    const size_t bytes = 3 * from[k]->n * sizeof(double);
    memcpy(s.bed.x + 3 * at, from[k]->x, bytes);
    memcpy(s.bed.v + 3 * at, from[k]->v, bytes);
    memcpy(s.bed.w + 3 * at, from[k]->w, bytes);
  }
  return s;
}

/* Two clusters that collide at different times cost what each costs alone. */
static void test_apart(void) {
  const double tol = 1e-3, end = 0.3;
  double alone = 0;
  for (int k = 0; k < 2; k++) {
    struct sample s = cluster(SCENE_ROTATION, 3, k ? 0.3 : 0.22, k ? 1 : 3,
                              origin, 4 + (unsigned long)k);
    alone += run(&s, "multirate", tol, end).contacts_evaluated;
    sample_free(&s);
  }
  struct sample a = cluster(SCENE_ROTATION, 3, 0.22, 3, origin, 4);
  struct sample b = cluster(SCENE_ROTATION, 3, 0.3, 1, (double[]){5, 0, 0}, 5);
  struct sample both = join(&a, &b);
  const double together = run(&both, "multirate", tol, end).contacts_evaluated;
  printf("two clusters: %.3g contacts together, %.3g alone\n", together, alone);
  CHECK(together <= 1.3 * alone);
  sample_free(&a);
  sample_free(&b);
  sample_free(&both);
}

/* A fast sphere that flies into a bed at rest costs its neighbourhood: far less
   than steps of its own length for the whole bed. */
static void test_bullet(void) {
  struct sample bed = rain(SCENE_ROTATION, 120, false, 6);
  run(&bed, "multirate", 1e-3, 4);
  struct sample shot = sample_new(SCENE_ROTATION, bed.bed.n + 1);
  if (scene_add_box(&shot.scene, 0.6, 0.6) != GSL_SUCCESS)
    abort();
  const size_t bytes = 3 * bed.bed.n * sizeof(double);
  double top = 0;
  for (size_t i = 0; i < bed.bed.n; i++)
    top = GSL_MAX(top, bed.bed.x[3 * i + 2]);
  memcpy(shot.bed.x, bed.bed.x, bytes);
  memcpy(shot.bed.v, bed.bed.v, bytes);
  memcpy(shot.bed.w, bed.bed.w, bytes);
  const size_t last = 3 * bed.bed.n;
  shot.bed.x[last] = shot.bed.x[last + 1] = 0.3;
  shot.bed.x[last + 2] = top + 1;
  shot.bed.v[last + 2] = -10;
  struct sample same = sample_new(SCENE_ROTATION, shot.bed.n);
  if (scene_add_box(&same.scene, 0.6, 0.6) != GSL_SUCCESS)
    abort();
  memcpy(same.bed.x, shot.bed.x, bytes + 3 * sizeof(double));
  memcpy(same.bed.v, shot.bed.v, bytes + 3 * sizeof(double));
  memcpy(same.bed.w, shot.bed.w, bytes + 3 * sizeof(double));
  const double end = 0.12;
  const double local = run(&shot, "multirate", 1e-3, end).contacts_evaluated;
  const double all = run(&same, "rkc", 1e-3, end).contacts_evaluated;
  const double quiet = run(&bed, "multirate", 1e-3, end).contacts_evaluated;
  printf(
      "a fast sphere: %.3g contacts, %.3g without it, %.3g by common steps\n",
      local, quiet, all);
  CHECK(local - quiet <= 0.4 * all);
  sample_free(&bed);
  sample_free(&shot);
  sample_free(&same);
}

/* Steps of single spheres: in a row whose first two collide the last, out of
   reach and at rest, takes those of all; the two take more, for any number of
   threads the same. */
static void test_steps(void) {
  enum { N = 12, LAST = N - 1 };
  size_t first[N] = {0};
  for (int threads = 1; threads <= 2; threads++) {
    struct sample s = sample_new(SCENE_ROTATION, N);
    weightless(&s);
    for (size_t i = 0; i < N; i++)
      s.bed.x[3 * i] = 0.35 * (double)i;
    s.bed.v[0] = 5;
    struct motion *m = start(&s, "multirate", 1e-4, threads);
    struct integrator *it = m->integrator;
    size_t own[N] = {0}, last[N];
    CHECK(integrate_stop(it, 0.05) == GSL_SUCCESS);
    while (integrate_time(it) < 0.05 && integrate_step(it) == GSL_SUCCESS) {
      multirate_steps(motion_multirate(m), N, last);
      for (size_t i = 0; i < N; i++)
        own[i] += last[i];
    }
    CHECK(integrate_time(it) == 0.05);
    CHECK(own[LAST] == integrate_counts(it).accepted);
    CHECK(own[0] > own[LAST] && own[1] > own[LAST]);
    /* a step of the bed has all of them, with the one that was taken back as
       the list of contacts did not hold at its end */
    const struct multirate_report r = multirate_report(motion_multirate(m));
    CHECK(r.rejected[0] > 0 && r.rows[0] == N);
    if (threads == 1)
      memcpy(first, own, sizeof own);
    CHECK(!memcmp(first, own, sizeof own));
    motion_free(m);
    sample_free(&s);
  }
}

/* --- within a step ---------------------------------------------------------*/

/* The state at any time is that of the steps that each sphere took: near a
   sharp run's from the start of the step, where one cubic over the whole step
   is not. */
static void test_within(void) {
  const double tol = 1e-2;
  struct sample s = rain(SCENE_ROTATION, 16, false, 8);
  struct motion *m = start(&s, "multirate", tol, 1);
  const size_t dim = dynamics_dimension(m->dynamics),
               stride = dynamics_stride(m->dynamics);
  double *y = numbers(dim), *want = numbers(dim), *before = numbers(dim);
  double worst = 0, sum = 0, coarse = 0;
  for (size_t steps = 0, refined = 0; refined < 25 && steps < 5000; steps++) {
    const double t = integrate_time(m->integrator);
    const size_t below = multirate_report(motion_multirate(m)).steps[1];
    memcpy(before, integrate_state(m->integrator), dim * sizeof *before);
    if (!CHECK(integrate_step(m->integrator) == GSL_SUCCESS))
      break;
    if (multirate_report(motion_multirate(m)).steps[1] == below)
      continue;
    refined++;
    const double h = integrate_last_step(m->integrator);
    const struct integrate_view v = integrate_view(m->integrator);
    CHECK(!memcmp(before, v.start, dim * sizeof *before));
    for (int k = 0; k <= 4; k++) {
      const double x = 0.25 * k;
      const struct hermite w = hermite_at(x, h);
      struct sample c = rain(SCENE_ROTATION, 16, false, 8);
      dynamics_unpack(m->dynamics, before, &c.bed);
      if (k > 0)
        run(&c, "rkc", 1e-6, x * h);
      dynamics_pack(m->dynamics, &c.bed, want);
      CHECK(integrate_at(m->integrator, t + x * h, y) == GSL_SUCCESS);
      for (size_t i = 0; i < dim; i++) {
        if (i % stride < ROW_V || i % stride >= ROW_W)
          continue;
        const double plain =
            hermite_value(&w, v.start[i], v.start_rate[i], v.y[i], v.rate[i]);
        if (fabs(y[i] - plain) < 1e-9) /* not refined, this is its cubic */
          continue;
        worst = GSL_MAX(worst, fabs(y[i] - want[i]));
        sum += gsl_pow_2(y[i] - want[i]);
        coarse += gsl_pow_2(plain - want[i]);
      }
      sample_free(&c);
    }
  }
  printf("within steps: error %.3g m/s, by one cubic %.3g times that\n", worst,
         sqrt(coarse / sum));
  CHECK_CLOSE(worst, 0, 10 * tol);
  CHECK(coarse > 2 * sum);
  CHECK(integrate_at(m->integrator, integrate_time(m->integrator) + 1, y) ==
        GSL_EDOM);
  motion_free(m);
  free(y);
  free(want);
  free(before);
  sample_free(&s);
}

/* --- bits ------------------------------------------------------------------*/

/* Enough rows for threads to share vectors, and contacts for parts. */
static void test_threads(void) {
  const double end = 0.02;
  double *first = NULL;
  for (int threads = 1; threads <= 4; threads *= 2) {
    struct sample s = cluster(SCENE_ROTATION, 17, 0.2, 1, origin, 10);
    struct motion *m = start(&s, "multirate", 1e-3, threads);
    run_to(m, end);
    const size_t dim = dynamics_dimension(m->dynamics);
    const double *y = integrate_state(m->integrator);
    CHECK(multirate_report(motion_multirate(m)).steps[2] > 0);
    if (!first) {
      first = numbers(dim);
      memcpy(first, y, dim * sizeof *y);
    } else
      CHECK(!memcmp(first, y, dim * sizeof *y));
    motion_free(m);
    sample_free(&s);
  }
  free(first);
}

/* --- ghosts ----------------------------------------------------------------*/

static void fill(gsl_rng *rng, const struct level *l, double *x, double size) {
  for (size_t i = 0; i < l->rows * l->stride; i++)
    x[i] = uniform(rng, -size, size);
}

/* A ghost is on the cubic of its own last step, at any depth. */
static void test_ghosts(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  struct sample s = cluster(SCENE_ROTATION, 4, 0.21, 0, origin, 12);
  struct dynamics *d = NULL;
  struct level_setting setting = {.tol = 1e-3, .lightest = 1};
  CHECK(dynamics_alloc(&d, &s.scene, &s.bed,
                       &(struct dynamics_options){.threads = 1}) ==
            GSL_SUCCESS &&
        chebyshev_alloc(&setting.chebyshev) == GSL_SUCCESS);
  setting.dynamics = d;
  struct level *l[3] = {NULL};
  for (size_t k = 0; k < 3; k++)
    CHECK(level_alloc(&l[k], &setting, k == 0) == GSL_SUCCESS);
  const size_t stride = l[0]->stride;
  dynamics_pack(d, &s.bed, l[0]->y0);
  CHECK(contact_list_update(d->list, l[0]->y0) == GSL_SUCCESS);
  /* steps of 0.5 from t = 2 and of 0.1 from t = 2.2; ends and rates of any
     size, where rows that meet stay where they are */
  const double t[3] = {2, 2.2, 2.2}, h[2] = {0.5, 0.1};
  size_t deep = 0;
  for (int k = 0; k < 2; k++) {
    fill(rng, l[k], l[k]->f0, 1);
    fill(rng, l[k], l[k]->f1, 1);
    fill(rng, l[k], l[k]->y1, 1);
    for (size_t i = 0; i < l[k]->rows; i++) {
      l[k]->error[i] = 8;
      l[k]->flagged[i] = i % 4 < (k ? 2 : 3);
    }
    /* the largest of what would be islands, and all others are ghosts */
    size_t largest = 0;
    CHECK(level_islands(l[k], t[k], h[k]) == GSL_SUCCESS);
    const struct islands *s = &l[k]->islands;
    for (size_t q = 0; q < s->count; q++)
      if (s->begin[q + 1] - s->begin[q] >
          s->begin[largest + 1] - s->begin[largest])
        largest = q;
    CHECK(level_refine(l[k + 1], l[k], largest, t[k], h[k]) == GSL_SUCCESS);
    CHECK(l[k + 1]->rows > 0 && l[k + 1]->ghosts > 0);
    for (size_t eighth = 0; eighth <= 8; eighth++) {
      const double x = (double)eighth / 8;
      const double at = t[k] + x * h[k];
      const struct hermite w = hermite_at(x, h[k]);
      double *y = l[k + 1]->a, *above = l[k]->a;
      level_ghosts(l[k + 1], at, y);
      level_ghosts(l[k], at, above);
      for (size_t q = 0; q < l[k + 1]->ghosts; q++) {
        const size_t i = l[k + 1]->list->order[l[k + 1]->rows + q];
        deep += i >= l[k]->rows;
        for (size_t c = 0; c < stride; c++) {
          const size_t from = i * stride + c;
          const double want =
              i >= l[k]->rows
                  ? above[from]
                  : hermite_value(&w, l[k]->y0[from], l[k]->f0[from],
                                  l[k]->y1[from], l[k]->f1[from]);
          CHECK_CLOSE(y[(l[k + 1]->rows + q) * stride + c], want, 1e-13);
        }
      }
    }
    level_ghosts(l[k + 1], t[k + 1], l[k + 1]->y0);
  }
  CHECK(deep > 0);
  for (size_t k = 0; k < 3; k++)
    level_free(l[k]);
  chebyshev_free(setting.chebyshev);
  dynamics_free(d);
  sample_free(&s);
  gsl_rng_free(rng);
}

/* The rates that the next step begins with are those of the state: a level
   knows what is far from its spheres by the step's end too. In between what the
   change of a rate would make of a velocity in the step is far below the
   tolerance. */
static void test_rates(void) {
  const double tol = 1e-3;
  struct sample s = rain(SCENE_ROTATION, 60, false, 3);
  struct motion *m = start(&s, "multirate", tol, 1);
  const size_t stride = dynamics_stride(m->dynamics);
  double *f = numbers(dynamics_dimension(m->dynamics)), worst = 0;
  while (integrate_time(m->integrator) < 0.4 &&
         CHECK(integrate_step(m->integrator) == GSL_SUCCESS)) {
    const double h = integrate_last_step(m->integrator);
    const double *rates = integrate_derivative(m->integrator);
    CHECK(dynamics_rhs(0, integrate_state(m->integrator), f, m->dynamics) ==
          GSL_SUCCESS);
    for (size_t k = 0; k < dynamics_dimension(m->dynamics); k++)
      if (k % stride >= ROW_V && k % stride < ROW_W)
        worst = GSL_MAX(worst, h * fabs(f[k] - rates[k]) / tol);
  }
  printf("rates: off by %.3g of the tolerance in a step\n", worst);
  CHECK(worst < 0.02); /* 0.09 with what it was at the step's start */
  free(f);
  motion_free(m);
  sample_free(&s);
}

/* --- the contract ----------------------------------------------------------*/

static void test_contract(void) {
  struct sample s = rain(SCENE_ROTATION, 8, false, 11);
  struct integrate_options o = {
      .method = "multirate", .control = "local", .tol = 1e-3, .hinit = 1e-4};
  const struct dynamics_options one = {.threads = 1},
                                all = {.all_pairs = true, .threads = 1};
  struct motion *m = NULL;
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &all, 0) == GSL_EINVAL);
  o.reltol = 1e-3;
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &one, 0) == GSL_EINVAL);
  o.reltol = 0;
  o.control = "predictive";
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &one, 0) == GSL_EINVAL);
  o.control = "local";
  o.step = 1e-4;
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &one, 0) == GSL_EINVAL);
  o.step = 0;
  CHECK(m == NULL);

  /* no limit of travel, and a longest step */
  o.hmax = 1e-3;
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &one, 0) == GSL_SUCCESS);
  double longest = 0;
  while (integrate_time(m->integrator) < 0.3 &&
         CHECK(integrate_step(m->integrator) == GSL_SUCCESS))
    longest = GSL_MAX(longest, integrate_last_step(m->integrator));
  CHECK(longest <= 1e-3);
  /* a stop is met exactly, once */
  const double stop = integrate_time(m->integrator) + 0.0123;
  CHECK(integrate_stop(m->integrator, 0) == GSL_EINVAL);
  run_to(m, stop);
  CHECK(integrate_step(m->integrator) == GSL_EDOM);
  CHECK(integrate_time(m->integrator) == stop);
  const struct dynamics_counts c = dynamics_counts(m->dynamics);
  CHECK(c.evaluations > 0 && c.contacts_evaluated > 0 && c.builds > 0);
  motion_free(m);

  /* a state that is not finite ends in an error, not in a loop */
  s.bed.v[4] = GSL_NAN;
  CHECK(motion_alloc(&m, &s.scene, &s.bed, &o, &one, 0) == GSL_SUCCESS);
  CHECK(integrate_step(m->integrator) == GSL_FAILURE);
  motion_free(m);
  sample_free(&s);
}

/* The trace of one row: cubics between the ends of its steps, without what was
   erased or cut. Rates are 0, so each cubic is even about its middle. */
static void test_trace(void) {
  struct sample s = sample_new(SCENE_BASIC, 1);
  s.bed.m[0] = 1;
  struct contact_list *list = NULL;
  struct trace *r = NULL;
  CHECK(contact_list_alloc(&list, &s.scene, &s.bed, 1, NULL) == GSL_SUCCESS);
  CHECK(trace_alloc(&r, list) == GSL_SUCCESS);
  double start[6] = {0}, still[6] = {0}, end[6] = {0}, y[6] = {0};
  struct level l = {.stride = 6,
                    .rows = 1,
                    .y0 = end,
                    .f0 = still,
                    .refined = (bool[]){false},
                    .whole = (uint32_t[]){0}};
  const struct {
    double t, x;
    bool erased;
  } ends[] = {{1, 1, false}, {1.5, 99, true}, {2, 4, false}, {3, 5, false}};
  size_t steps = 0;
  for (size_t k = 0; k < 4; k++) {
    const size_t mark = trace_mark(r);
    end[0] = ends[k].x;
    CHECK(trace_append(r, &l, ends[k].t) == GSL_SUCCESS);
    CHECK(trace_mark(r) == mark + 1);
    if (ends[k].erased)
      trace_erase(r, mark, mark + 1);
  }
  trace_steps(r, &steps);
  CHECK(steps == 3);
  const double times[] = {0.5, 1, 1.5, 2, 2.5, 3},
               want[] = {0.5, 1, 2.5, 4, 4.5, 5};
  for (size_t k = 0; k < 6; k++) {
    trace_at(r, 0, start, still, times[k], y);
    CHECK_CLOSE(y[0], want[k], 8 * DBL_EPSILON);
  }
  trace_cut(r, 3); /* what is beyond the last end stays as it is */
  trace_at(r, 0, start, still, 2.5, y);
  CHECK_CLOSE(y[0], 5, 8 * DBL_EPSILON);
  l.refined = (bool[]){true};
  CHECK(trace_append(r, &l, 4) == GSL_SUCCESS && trace_mark(r) == 3);
  trace_free(r);
  contact_list_free(list);
  sample_free(&s);
}

int main(void) {
  limit_cpu(1000); /* a loop without end is a failure too */
  gsl_set_error_handler_off();
  test_trace();
  test_free_fall();
  test_momentum(SCENE_BASIC);
  test_momentum(SCENE_FRICTION);
  test_momentum(SCENE_ROTATION);
  test_energy();
  for (size_t k = 0; k < 2; k++) {
    test_local(SCENE_BASIC, false, tolerances[k]);
    test_local(SCENE_FRICTION, true, tolerances[k]);
    test_local(SCENE_ROTATION, false, tolerances[k]);
    test_local(SCENE_ROTATION, true, tolerances[k]);
  }
  test_order(SCENE_BASIC, false);
  test_order(SCENE_FRICTION, false);
  test_order(SCENE_ROTATION, false);
  test_order(SCENE_ROTATION, true);
  test_board(40, 1, 1);
  test_board(40, 1, 5);
  test_board(10, 10, 1);
  test_board(10, 10, 5);
  test_apart();
  test_bullet();
  test_steps();
  test_within();
  test_threads();
  test_ghosts();
  test_rates();
  test_contract();
  return check_done();
}
