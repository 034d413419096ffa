/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Obstacles: spheres that feel and give forces and stay where they are, against
   spheres of a mass that nothing moves, and by the conservation of energy. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "dynamics/motion.h"
#include "sample.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const struct {
  const char *name, *control;
  double tol, step;
} methods[] = {
    {"merson", "paper", 1e-3, 0},      {"dopri5", "predictive", 1e-8, 0},
    {"rkc", "predictive", 1e-6, 0},    {"multirate", "local", 1e-6, 0},
    {"verlet", "predictive", 1, 2e-6}, {"msbdf", "standard", 1e-6, 0}};

struct world {
  struct scene scene;
  struct bed bed;
};

static void world_free(struct world *w) {
  scene_free(&w->scene);
  bed_free(&w->bed);
}

static struct world world_new(enum scene_model model, size_t n) {
  struct world w = {.scene = scene_default()};
  w.scene.model = model;
  if (bed_alloc(&w.bed, n) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++)
    w.bed.r[i] = 0.1;
  return w;
}

static void fix(struct bed *b, size_t i) {
  if (bed_fix_none(b) != GSL_SUCCESS)
    abort();
  b->fixed[i] = true;
  memset(b->v + 3 * i, 0, 3 * sizeof *b->v);
  memset(b->w + 3 * i, 0, 3 * sizeof *b->w);
}

static struct dynamics *dynamics_of(const struct world *w, bool all_pairs,
                                    int threads) {
  struct dynamics *d = NULL;
  if (dynamics_alloc(&d, &w->scene, &w->bed,
                     &(struct dynamics_options){all_pairs, threads}) !=
      GSL_SUCCESS)
    abort();
  return d;
}

/* Rates by sphere: those of positions and velocities in a bed's places. */
static struct bed rates_of(const struct world *w, bool all_pairs, int threads) {
  struct dynamics *d = dynamics_of(w, all_pairs, threads);
  double *y = numbers(dynamics_dimension(d)),
         *f = numbers(dynamics_dimension(d));
  struct world still = *w;
  struct bed rates;
  if (bed_copy(&rates, &w->bed) != GSL_SUCCESS)
    abort();
  free(rates.fixed); /* so that theirs are unpacked, too */
  rates.fixed = NULL;
  dynamics_pack(d, &still.bed, y);
  CHECK(dynamics_rhs(0, y, f, d) == GSL_SUCCESS);
  memset(rates.x, 0, 3 * rates.n * sizeof *rates.x);
  memset(rates.v, 0, 3 * rates.n * sizeof *rates.v);
  memset(rates.w, 0, 3 * rates.n * sizeof *rates.w);
  dynamics_unpack(d, f, &rates);
  free(y);
  free(f);
  dynamics_free(d);
  return rates;
}

/* Largest difference of the rates of velocity and spin of those that are not
   fixed in w, and their largest rate. */
static double difference(const struct world *w, const struct bed *a,
                         const struct bed *b, double *largest) {
  double most = 0;
  *largest = 0;
  for (size_t i = 0; i < 3 * w->bed.n; i++) {
    if (bed_is_fixed(&w->bed, i / 3))
      continue;
    most = GSL_MAX(most, fabs(a->v[i] - b->v[i]));
    most = GSL_MAX(most, fabs(a->w[i] - b->w[i]));
    *largest = GSL_MAX(*largest, GSL_MAX(fabs(a->v[i]), fabs(a->w[i])));
  }
  return most;
}

static struct world random_world(gsl_rng *rng, enum scene_model model, size_t n,
                                 double side) {
  struct world w = world_new(model, n);
  for (size_t i = 0; i < 3 * n; i++) {
    w.bed.x[i] = uniform(rng, 0, side);
    w.bed.v[i] = uniform(rng, -0.1, 0.1);
    w.bed.w[i] = uniform(rng, -1, 1);
  }
  return w;
}

/* --- obstacles -------------------------------------------------------------*/

/* A sphere that is heavy enough does not move either. Sums of up to n terms
   come in another order. */
static void test_obstacle_forces(gsl_rng *rng) {
  enum { N = 60 };
  for (int model = SCENE_BASIC; model <= SCENE_ROTATION; model++) {
    struct world w = random_world(rng, (enum scene_model)model, N, 0.8);
    struct world heavy = {.scene = w.scene};
    if (scene_add_box(&w.scene, 0.8, 0.8) != GSL_SUCCESS)
      abort();
    heavy.scene = w.scene;
    for (size_t i = 0; i < N; i += 3)
      fix(&w.bed, i);
    if (bed_copy(&heavy.bed, &w.bed) != GSL_SUCCESS)
      abort();
    free(heavy.bed.fixed);
    heavy.bed.fixed = NULL;
    for (size_t i = 0; i < N; i += 3)
      heavy.bed.m[i] = 1e30;
    struct bed want = rates_of(&heavy, true, 1);
    for (int k = 0; k < 3; k++) {
      struct bed got = rates_of(&w, k == 0, k == 2 ? 3 : 1);
      double largest;
      const double most = difference(&w, &got, &want, &largest);
      CHECK(largest > 100);
      CHECK_CLOSE(most / largest, 0, 1e-13 * N);
      for (size_t i = 0; i < 3 * N; i += 9)
        for (size_t c = 0; c < 3; c++)
          CHECK(got.x[i + c] == 0 && got.v[i + c] == 0 && got.w[i + c] == 0);
      bed_free(&got);
    }
    bed_free(&want);
    bed_free(&heavy.bed);
    world_free(&w);
  }
}

/* Spheres fall onto obstacles that overlap each other: by every method the same
   motion, and no bit of an obstacle's place changes. Two beds that differ by
   the local errors of all steps, at most some 1e4 of them, which grow by a few
   powers of e within the collisions. */
static void test_obstacle_methods(enum scene_model model) {
  struct bed first = {0};
  for (size_t m = 0; m < COUNT(methods); m++) {
    enum { N = 9, FIXED = 6 };
    struct world w = world_new(model, N);
    for (size_t i = 0; i < FIXED; i++) {
      w.bed.x[3 * i] = 0.1234567890123 * (double)i;
      w.bed.x[3 * i + 1] = 0.013 * (double)(i % 2);
      fix(&w.bed, i);
    }
    for (size_t i = FIXED; i < N; i++) {
      w.bed.x[3 * i] = 0.18 * (double)(i - FIXED) + 0.1;
      w.bed.x[3 * i + 2] = 0.25 + 0.03 * (double)(i - FIXED);
    }
    const struct integrate_options o = {.method = methods[m].name,
                                        .control = methods[m].control,
                                        .tol = methods[m].tol,
                                        .step = methods[m].step,
                                        .hinit = 1e-4};
    struct motion *motion = NULL;
    if (motion_alloc(&motion, &w.scene, &w.bed, &o,
                     &(struct dynamics_options){.threads = 1},
                     1 / w.scene.law.kappa) != GSL_SUCCESS)
      abort();
    struct bed end;
    if (bed_copy(&end, &w.bed) != GSL_SUCCESS)
      abort();
    CHECK(integrate_stop(motion->integrator, 0.25) == GSL_SUCCESS);
    int status = GSL_SUCCESS;
    while (status == GSL_SUCCESS && integrate_time(motion->integrator) < 0.25)
      status = integrate_step(motion->integrator);
    CHECK(status == GSL_SUCCESS);
    const double *y = integrate_state(motion->integrator);
    const size_t stride = dynamics_stride(motion->dynamics);
    for (size_t i = 0; i < FIXED; i++) /* the last rows, in their order */
      CHECK(!memcmp(y + (N - FIXED + i) * stride, w.bed.x + 3 * i,
                    3 * sizeof *y));
    dynamics_unpack(motion->dynamics, y, &end);
    if (m == 0 && bed_copy(&first, &end) != GSL_SUCCESS)
      abort();
    for (size_t i = 0; i < 3 * N; i++)
      if (!CHECK_CLOSE(end.x[i], first.x[i], 2e-5))
        fprintf(stderr, "  %s\n", methods[m].name);
    CHECK(fabs(end.v[3 * N - 1]) < 2.3); /* it has met one: 0.25 g is 2.45 */
    bed_free(&end);
    motion_free(motion);
    world_free(&w);
  }
  bed_free(&first);
}

/* Without damping and friction a sphere that falls on one has its energy. */
static void test_obstacle_energy(void) {
  struct world w = world_new(SCENE_BASIC, 2);
  w.scene.law.restitution = 1;
  w.scene.law.lmax = 1;
  w.bed.x[3] = 0.03;
  w.bed.x[5] = 0.6;
  fix(&w.bed, 0);
  const struct integrate_options o = {
      .method = "dopri5", .control = "standard", .tol = 1e-10, .hinit = 1e-4};
  struct motion *m = NULL;
  if (motion_alloc(&m, &w.scene, &w.bed, &o,
                   &(struct dynamics_options){.threads = 1},
                   1 / w.scene.law.kappa) != GSL_SUCCESS)
    abort();
  double first = 0, most = 0, down = 0;
  while (integrate_time(m->integrator) < 0.6 &&
         CHECK(integrate_step(m->integrator) == GSL_SUCCESS)) {
    const double *y = integrate_state(m->integrator);
    const double energy =
        dynamics_kinetic(m->dynamics, y) + dynamics_potential(m->dynamics, y);
    first = first > 0 ? first : energy;
    most = GSL_MAX(most, fabs(energy / first - 1));
    down = GSL_MAX(down, y[ROW_V + 2]); /* it is thrown up again */
  }
  CHECK(down > 1);
  CHECK_CLOSE(most, 0, 1e-8);
  motion_free(m);
  world_free(&w);
}

static void test_obstacles_alone(void) {
  struct world w = world_new(SCENE_BASIC, 1);
  struct dynamics *d = NULL;
  fix(&w.bed, 0);
  CHECK(dynamics_alloc(&d, &w.scene, &w.bed,
                       &(struct dynamics_options){.threads = 1}) == GSL_EINVAL);
  world_free(&w);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 12);
  test_obstacle_forces(rng);
  test_obstacle_methods(SCENE_BASIC);
  test_obstacle_methods(SCENE_ROTATION);
  test_obstacle_energy();
  test_obstacles_alone();
  gsl_rng_free(rng);
  return check_done();
}
