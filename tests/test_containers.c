/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Containers: obstacles against spheres of a mass that nothing moves, cylinders
   against planes and closed forms, periodic sides against all images, copies
   and conservation. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "dynamics/motion.h"
#include "geometry/periodic.h"
#include "measure/network.h"
#include "sample.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const struct {
  const char *name, *control;
  double tol, step;
} methods[] = {
    {"merson", "paper", 1e-3, 0},      {"dopri5", "predictive", 1e-8, 0},
    {"rkc", "predictive", 1e-6, 0},    {"multirate", "local", 1e-6, 0},
    {"verlet", "predictive", 1, 2e-6}, {"msbdf", "standard", 1e-6, 0}};

/* A tolerance that is far below all that is tested by it. */
static const struct integrate_options precise = {
    .method = "dopri5", .control = "standard", .tol = 1e-11, .hinit = 1e-4};

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
                     &(struct dynamics_options){.all_pairs = all_pairs,
                                                .threads = threads}) !=
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

/* Spheres fall onto obstacles that overlap each other. */
static struct world over_obstacles(enum scene_model model) {
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
  return w;
}

/* No bit of an obstacle's place changes; obstacles have the last rows. */
static void check_obstacles(const struct world *w, const struct dynamics *d,
                            const double *y) {
  size_t moving = 0, row;
  for (size_t i = 0; i < w->bed.n; i++)
    moving += !bed_is_fixed(&w->bed, i);
  row = moving;
  for (size_t i = 0; i < w->bed.n; i++)
    if (bed_is_fixed(&w->bed, i))
      CHECK(!memcmp(y + dynamics_stride(d) * row++, w->bed.x + 3 * i,
                    3 * sizeof *y));
}

static struct motion *start(const struct world *w,
                            const struct integrate_options *o) {
  struct motion *m = NULL;
  if (motion_alloc(&m, &w->scene, &w->bed, o,
                   &(struct dynamics_options){.threads = 1},
                   1 / w->scene.law.kappa) != GSL_SUCCESS)
    abort();
  return m;
}

static bool run_to(struct motion *m, double end) {
  int status = integrate_stop(m->integrator, end);
  while (status == GSL_SUCCESS && integrate_time(m->integrator) < end)
    status = integrate_step(m->integrator);
  return CHECK(status == GSL_SUCCESS);
}

/* The same motion by every method. Two beds differ by the local errors of all
   steps, at most some 1e4 of them, which grow by a few powers of e within the
   collisions. Something has met something: the fastest has not fallen freely.
 */
static void test_methods(struct world (*make)(enum scene_model),
                         enum scene_model model) {
  const double end = 0.25;
  struct bed first = {0};
  for (size_t m = 0; m < COUNT(methods); m++) {
    struct world w = make(model);
    struct motion *motion =
        start(&w, &(struct integrate_options){.method = methods[m].name,
                                              .control = methods[m].control,
                                              .tol = methods[m].tol,
                                              .step = methods[m].step,
                                              .hinit = 1e-4});
    struct bed last;
    double slowest = GSL_POSINF;
    if (bed_copy(&last, &w.bed) != GSL_SUCCESS)
      abort();
    run_to(motion, end);
    const double *y = integrate_state(motion->integrator);
    check_obstacles(&w, motion->dynamics, y);
    dynamics_unpack(motion->dynamics, y, &last);
    if (m == 0 && bed_copy(&first, &last) != GSL_SUCCESS)
      abort();
    for (size_t i = 0; i < 3 * w.bed.n; i++)
      if (!CHECK_CLOSE(last.x[i], first.x[i], 2e-5))
        fprintf(stderr, "  %s\n", methods[m].name);
    for (size_t i = 0; i < w.bed.n; i++)
      if (!bed_is_fixed(&w.bed, i))
        slowest = GSL_MIN(slowest, fabs(last.v[3 * i + 2]));
    CHECK(slowest < 0.94 * 9.81 * end);
    bed_free(&last);
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
  struct motion *m = start(&w, &precise);
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

/* --- cylinders -------------------------------------------------------------*/

static void add_cylinder(struct world *w, const double point[3],
                         const double axis[3], double radius) {
  if (scene_add_cylinder(&w->scene, point, axis, radius) != GSL_SUCCESS)
    abort();
}

/* A short inclined tube with spheres in it, ended by planes across its axis. */
static struct world in_tubes(enum scene_model model) {
  enum { N = 7 };
  const double axis[3] = {0.3, 0, 1}, low[3] = {0, 0, 0};
  const double down[3] = {-0.3, 0, -1};
  struct world w = world_new(model, N);
  add_cylinder(&w, low, axis, 0.25);
  if (scene_add_wall(&w.scene, low, down) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < N; i++) {
    const double up = 0.22 * (double)i + 0.14;
    w.bed.x[3 * i] = 0.3 * up + (i % 2 ? 0.05 : -0.06);
    w.bed.x[3 * i + 1] = i % 3 ? 0.04 : -0.05;
    w.bed.x[3 * i + 2] = up;
  }
  return w;
}

/* What a cylinder does to a sphere is what the plane does that touches it
   there. */
static void test_cylinder_forces(gsl_rng *rng) {
  for (int k = 0; k < 60; k++) {
    struct world round = random_world(rng, (enum scene_model)(k % 3), 1, 0.2);
    struct world flat = {.scene = round.scene};
    double axis[3], point[3], away[3], touch[3];
    for (int c = 0; c < 3; c++) {
      axis[c] = uniform(rng, -1, 1);
      point[c] = uniform(rng, -1, 1);
    }
    /* the centre's distance from the axis by a cross product, not as scene.h
       has it */
    const double *x = round.bed.x;
    double u[3], cross[3];
    vec3_sub(x, point, u);
    vec3_cross(axis, u, cross);
    vec3_cross(cross, axis, away);
    const double distance = vec3_norm(cross) / vec3_norm(axis);
    const double radius = distance + 0.1 + uniform(rng, -0.05, 0.05);
    memcpy(touch, x, sizeof touch);
    vec3_axpy((radius - distance) / vec3_norm(away), away, touch);
    add_cylinder(&round, point, axis, radius);
    if (scene_add_wall(&flat.scene, touch, away) != GSL_SUCCESS ||
        bed_copy(&flat.bed, &round.bed) != GSL_SUCCESS)
      abort();
    struct bed want = rates_of(&flat, false, 1);
    for (int all = 0; all < 2; all++) {
      struct bed got = rates_of(&round, all, 1);
      double largest;
      const double most = difference(&round, &got, &want, &largest);
      /* a gap that is off by some ulps of a metre, times kappa */
      CHECK_CLOSE(most / largest, 0, 100 * 150 * GSL_DBL_EPSILON);
      bed_free(&got);
    }
    bed_free(&want);
    world_free(&round);
    world_free(&flat);
  }
}

/* Against differences of the rates; their error is a third derivative, some
   kappa^3, times step^2 / 6, and the rounding of rates by the step. */
static void check_jacobian(const struct world *w) {
  struct dynamics *d = dynamics_of(w, false, 1);
  const size_t dim = dynamics_dimension(d);
  double *y = numbers(dim), *a = numbers(dim), *b = numbers(dim);
  double *dfdy = numbers(dim * dim), *dfdt = numbers(dim);
  const double step = 1e-6;
  double largest = 0, most = 0;
  dynamics_pack(d, &w->bed, y);
  CHECK(dynamics_jacobian(0, y, dfdy, dfdt, d) == GSL_SUCCESS);
  for (size_t k = 0; k < dim; k++) {
    const double keep = y[k];
    y[k] = keep + step;
    dynamics_rhs(0, y, a, d);
    y[k] = keep - step;
    dynamics_rhs(0, y, b, d);
    y[k] = keep;
    for (size_t i = 0; i < dim; i++) {
      const double slope = (a[i] - b[i]) / (2 * step);
      most = GSL_MAX(most, fabs(slope - dfdy[i * dim + k]));
      largest = GSL_MAX(largest, fabs(slope));
    }
  }
  CHECK(largest > 1);
  CHECK_CLOSE(most / largest, 0, 1e-6);
  free(y);
  free(a);
  free(b);
  free(dfdy);
  free(dfdt);
  dynamics_free(d);
}

static void test_cylinder_jacobian(gsl_rng *rng) {
  for (int k = 0; k < 12; k++) {
    struct world w = random_world(rng, (enum scene_model)(k % 3), 2, 0.1);
    w.scene.law.lmax = 1;
    w.bed.x[0] += 0.2;
    w.bed.x[5] += 0.1;
    add_cylinder(&w, (double[]){0.1, 0.05, 0}, (double[]){0.4, 0.2, -1}, 0.28);
    if (k % 2)
      fix(&w.bed, 0);
    check_jacobian(&w);
    world_free(&w);
  }
}

/* In a horizontal tube: a gap l with F(l) (1 + e^2)/2 = m g above its bottom.
   At the start it is at rest there: the rates are those of rounding. */
static void test_rest_in_tube(void) {
  const double kappa = 150, force = 0.5 * (1 + 0.4 * 0.4) * 10;
  const double gap = log(force / 9.81) / kappa;
  struct world w = world_new(SCENE_ROTATION, 1);
  add_cylinder(&w, (double[]){-3, 2, 5}, (double[]){1, 0, 0}, 0.6);
  w.bed.x[0] = 7;
  w.bed.x[1] = 2;
  w.bed.x[2] = 5 - (0.6 - 0.1 - gap);
  struct bed rates = rates_of(&w, false, 1);
  for (size_t k = 0; k < 3; k++)
    CHECK_CLOSE(rates.v[k], 0, 9.81 * 150 * 20 * GSL_DBL_EPSILON);
  bed_free(&rates);
  world_free(&w);
}

/* Without friction a sphere swings in a tube like a pendulum of the length of
   its distance from the axis; a soft wall gives way to the centrifugal force,
   and the whole energy is constant. A swing of 1e-3: the period grows by
   theta^2/16, and the gap changes by theta^2/kappa. */
static void test_pendulum(void) {
  const double theta = 1e-3, force = 0.5 * (1 + 1) * 10;
  const double length = 0.6 - 0.1 - log(force / 9.81) / 150;
  struct world w = world_new(SCENE_BASIC, 1);
  w.scene.law.restitution = 1;
  w.scene.law.lmax = 1;
  add_cylinder(&w, (double[]){0, 0, 0}, (double[]){0, 1, 0}, 0.6);
  w.bed.x[0] = length * sin(theta);
  w.bed.x[2] = -length * cos(theta);
  struct motion *m = start(&w, &precise);
  const double quarter = 0.5 * M_PI * sqrt(length / 9.81);
  run_to(m, quarter);
  CHECK_CLOSE(integrate_state(m->integrator)[0], 0, 1e-5 * theta);
  run_to(m, 2 * quarter);
  CHECK_CLOSE(integrate_state(m->integrator)[0], -length * sin(theta),
              1e-5 * theta);
  motion_free(m);
  w.bed.x[0] = length; /* from the height of the axis */
  w.bed.x[2] = 0;
  m = start(&w, &precise);
  double first = 0, most = 0;
  while (integrate_time(m->integrator) < 2 &&
         CHECK(integrate_step(m->integrator) == GSL_SUCCESS)) {
    const double *y = integrate_state(m->integrator);
    const double energy = 10 + dynamics_kinetic(m->dynamics, y) +
                          dynamics_potential(m->dynamics, y);
    first = first > 0 ? first : energy;
    most = GSL_MAX(most, fabs(energy / first - 1));
  }
  CHECK_CLOSE(most, 0, 1e-8);
  motion_free(m);
  world_free(&w);
}

/* From sliding along a horizontal tube to rolling, v + (2/5) r w is conserved,
   since the normal stays upright: 5/7 of the speed. */
static void test_rolling_along(void) {
  struct world w = world_new(SCENE_ROTATION, 1);
  const double gap = log(0.58 * 10 / 9.81) / 150;
  add_cylinder(&w, (double[]){0, 0, 0}, (double[]){1, 0, 0}, 0.6);
  w.bed.x[2] = -(0.6 - 0.1 - gap);
  w.bed.v[0] = 1;
  struct motion *m = start(&w, &precise);
  run_to(m, 4);
  const double *y = integrate_state(m->integrator);
  CHECK_CLOSE(y[ROW_V] + 0.4 * 0.1 * y[ROW_W + 1], 1, 1e-8);
  CHECK_CLOSE(y[ROW_V], 5. / 7, 1e-3); /* slip fades as 1/t */
  CHECK_CLOSE(y[1], 0, 1e-9);
  motion_free(m);
  world_free(&w);
}

/* Without weight a sphere goes round in a tube: friction takes momentum of the
   orbit, distance times m v, by the distance, and gives spin by r. What the two
   share out is constant but for the change of the distance from the axis as the
   centrifugal force goes down to (5/7)^2: 2 ln(7/5)/kappa of 0.9 m, by which
   either share may be off. */
static void test_rolling_round(void) {
  const double kappa = 2000, radius = 1;
  struct world w = world_new(SCENE_ROTATION, 1);
  memset(w.scene.gravity, 0, sizeof w.scene.gravity);
  w.scene.law.kappa = kappa;
  add_cylinder(&w, (double[]){0, 0, 0}, (double[]){0, 0, 1}, radius);
  const double v = 2, pull = v * v / 0.9;
  const double away = radius - 0.1 + log(pull / (0.58 * 10)) / kappa;
  w.bed.x[0] = away;
  w.bed.v[1] = v;
  struct motion *m = start(&w, &precise);
  run_to(m, 6);
  const double *y = integrate_state(m->integrator);
  const double orbit =
      (y[0] * y[ROW_V + 1] - y[1] * y[ROW_V]) / hypot(y[0], y[1]);
  const double share = 2 * log(1.4) / kappa / 0.9;
  CHECK_CLOSE((orbit - 0.4 * 0.1 * y[ROW_W + 2]) / v, 1, share);
  CHECK_CLOSE(orbit / v, 5. / 7, share + 2e-3); /* slip fades as 1/t */
  motion_free(m);
  world_free(&w);
}

static void test_refused_cylinders(void) {
  struct scene s = {0};
  const double o[3] = {0}, up[3] = {0, 0, 2}, bad[3] = {0, GSL_NAN, 1};
  CHECK(scene_add_cylinder(&s, o, o, 1) == GSL_EINVAL);
  CHECK(scene_add_cylinder(&s, o, up, 0) == GSL_EINVAL);
  CHECK(scene_add_cylinder(&s, o, up, GSL_POSINF) == GSL_EINVAL);
  CHECK(scene_add_cylinder(&s, o, bad, 1) == GSL_EINVAL);
  CHECK(scene_add_cylinder(&s, bad, up, 1) == GSL_EINVAL);
  CHECK(s.walls_count == 0);
  CHECK(scene_add_cylinder(&s, o, up, 3) == GSL_SUCCESS);
  CHECK(scene_add_wall(&s, o, up) == GSL_SUCCESS);
  CHECK(s.walls_count == 2 && s.walls[0].radius == 0 && s.walls[1].radius == 3);
  CHECK(s.walls[1].normal[2] == 1);
  scene_free(&s);
}

/* --- periodic sides --------------------------------------------------------*/

/* Pairs by all images, one axis, two or three periodic. */
static void test_periodic_pairs(gsl_rng *rng) {
  for (int k = 0; k < 40; k++) {
    enum { N = 50 };
    const double reach = uniform(rng, 0, 0.1);
    double x[3 * N], r[N], period[3];
    struct neighbors nb = {0};
    for (int c = 0; c < 3; c++)
      period[c] = (k >> c & 1) || k % 8 == 0 ? uniform(rng, 0.6, 1) : 0;
    for (size_t i = 0; i < N; i++) {
      r[i] = uniform(rng, 0.02, 0.1);
      for (size_t c = 0; c < 3; c++)
        x[3 * i + c] = uniform(rng, -1.4, 1.4);
    }
    CHECK(periodic_find(&nb, N, x, 3, r, reach, period) == GSL_SUCCESS);
    size_t at = 0;
    bool same = true;
    for (uint32_t i = 0; i < N; i++) {
      same = same && nb.first[i] == at;
      for (uint32_t j = i + 1; j < N; j++) {
        double least = GSL_POSINF;
        for (int image = 0; image < 11 * 11 * 11; image++) {
          const int move[3] = {image % 11 - 5, image / 11 % 11 - 5,
                               image / 121 - 5};
          double d2 = 0;
          for (size_t c = 0; c < 3; c++)
            d2 += gsl_pow_2(x[3 * i + c] - x[3 * j + c] + move[c] * period[c]);
          least = GSL_MIN(least, d2);
        }
        if (sqrt(least) > r[i] + r[j] + reach)
          continue;
        same = same && at < nb.count && nb.i[at] == i && nb.j[at] == j;
        at++;
      }
    }
    CHECK(same && at == nb.count && nb.first[N] == at);
    neighbors_free(&nb);
  }
}

/* As many images as there may be, and one period more along an axis. */
static void test_most_images(void) {
  struct periodic_images m = {0};
  const double x[3] = {0}, r = 0.25, period[3] = {1, 1, 0};
  double box[6] = {0, 1e4 - 1, 0, 1e3 - 1, 0, 1};
  CHECK(periodic_images_in_box(&m, 1, x, &r, period, box) == GSL_SUCCESS);
  CHECK(m.count == 10000000);
  box[3]++;
  CHECK(periodic_images_in_box(&m, 1, x, &r, period, box) == GSL_ERANGE);
  periodic_images_free(&m);
}

/* Images by trying all moves: those that reach into a box, and whether one of
   them is in it. */
static void test_periodic_images(gsl_rng *rng) {
  for (int k = 0; k < 40; k++) {
    enum { N = 20, MOST = 8, SPAN = 2 * MOST + 1 };
    double x[3 * N], r[N], period[3], box[6];
    struct periodic_images m = {0};
    for (int c = 0; c < 3; c++) {
      period[c] = k >> c & 1 ? uniform(rng, 0.6, 1) : 0;
      box[2 * c] = uniform(rng, -1, 1);
      box[2 * c + 1] = box[2 * c] + uniform(rng, 0.1, 2);
    }
    for (size_t i = 0; i < N; i++) {
      r[i] = uniform(rng, 0.02, 0.3);
      for (size_t c = 0; c < 3; c++)
        x[3 * i + c] = uniform(rng, -1.4, 1.4);
    }
    CHECK(periodic_images_in_box(&m, N, x, r, period, box) == GSL_SUCCESS);
    size_t at = 0;
    bool same = true;
    for (uint32_t i = 0; i < N; i++) {
      bool held = false;
      for (int image = 0; image < SPAN * SPAN * SPAN; image++) {
        const int move[3] = {image / SPAN / SPAN - MOST,
                             image / SPAN % SPAN - MOST, image % SPAN - MOST};
        bool there = true, inside = true;
        double place[3];
        for (size_t c = 0; c < 3; c++) {
          place[c] = x[3 * i + c] + move[c] * period[c];
          there = there && (period[c] > 0 || !move[c]) &&
                  (!(period[c] > 0) || (place[c] + r[i] > box[2 * c] &&
                                        place[c] - r[i] < box[2 * c + 1]));
          inside =
              inside && place[c] >= box[2 * c] && place[c] <= box[2 * c + 1];
        }
        held = held || inside;
        if (!there)
          continue;
        same = same && at < m.count && m.of[at] == i && m.radius[at] == r[i] &&
               !memcmp(m.x + 3 * at, place, sizeof place);
        at++;
      }
      CHECK(periodic_in_box(period, box, x + 3 * i) == held);
    }
    CHECK(same && at == m.count);
    periodic_images_free(&m);
  }
  struct periodic_images m = {0};
  const double x[3] = {0}, r = 0.1, period[3] = {1, 1, 0};
  const double box[6] = {0, 1e4, 0, 1e4, 0, 1};
  CHECK(periodic_images_in_box(&m, 1, x, &r, period, box) == GSL_ERANGE);
  periodic_images_free(&m);
  test_most_images();
}

static struct world periodic_world(gsl_rng *rng, enum scene_model model,
                                   size_t n) {
  struct world w = random_world(rng, model, n, 1);
  w.scene.period[0] = 0.7;
  w.scene.period[1] = 0.8;
  if (scene_add_wall(&w.scene, (double[]){0, 0, 0}, (double[]){0, 0, -1}) !=
      GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++) {
    w.bed.x[3 * i] *= 0.7;
    w.bed.x[3 * i + 1] *= 0.8;
  }
  return w;
}

/* Forces are those of a bed with all its neighbours as copies. */
static void test_periodic_forces(gsl_rng *rng) {
  enum { N = 40 };
  for (int model = SCENE_BASIC; model <= SCENE_ROTATION; model++) {
    struct world w = periodic_world(rng, (enum scene_model)model, N);
    struct world copies = {.scene = w.scene};
    memset(copies.scene.period, 0, sizeof copies.scene.period);
    if (bed_alloc(&copies.bed, 9 * N) != GSL_SUCCESS)
      abort();
    for (size_t i = 0; i < 9 * N; i++) {
      const size_t of = i % N, image = (i / N + 4) % 9; /* its own first */
      const double move[3] = {((double)(image % 3) - 1) * 0.7,
                              ((double)(image / 3) - 1) * 0.8, 0};
      for (size_t c = 0; c < 3; c++) {
        copies.bed.x[3 * i + c] = w.bed.x[3 * of + c] + move[c];
        copies.bed.v[3 * i + c] = w.bed.v[3 * of + c];
        copies.bed.w[3 * i + c] = w.bed.w[3 * of + c];
      }
      copies.bed.r[i] = 0.1;
    }
    struct bed want = rates_of(&copies, true, 1);
    for (int k = 0; k < 4; k++) {
      struct bed got = rates_of(&w, k == 0, k == 2 ? 3 : 1);
      double largest;
      const double most = difference(&w, &got, &want, &largest);
      CHECK(largest > 100);
      CHECK_CLOSE(most / largest, 0, 1e-13 * 9 * N);
      bed_free(&got);
      for (size_t i = 0; i < N && k == 2; i++) { /* each somewhere else */
        w.bed.x[3 * i] += 0.7 * ((double)(i % 5) - 2);
        w.bed.x[3 * i + 1] -= 0.8 * (double)(i % 3);
      }
    }
    bed_free(&want);
    bed_free(&copies.bed);
    world_free(&w);
  }
}

static void test_periodic_jacobian(gsl_rng *rng) {
  for (int k = 0; k < 6; k++) {
    struct world w = periodic_world(rng, (enum scene_model)(k % 3), 2);
    const double x[6] = {0.02, 0.78, 0.12, 0.65, 0.05, 0.2};
    memcpy(w.bed.x, x, sizeof x);
    w.scene.law.lmax = 0.15;
    check_jacobian(&w);
    world_free(&w);
  }
}

/* Spheres fall onto a floor and onto each other across both sides. */
static struct world over_sides(enum scene_model model) {
  enum { N = 8 };
  struct world w = world_new(model, N);
  w.scene.period[0] = w.scene.period[1] = 0.6;
  if (scene_add_wall(&w.scene, (double[]){0, 0, 0}, (double[]){0, 0, -1}) !=
      GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < N; i++) {
    w.bed.x[3 * i] = 0.3 * (double)(i % 2) + (i < 4 ? 0.02 : 0.17);
    w.bed.x[3 * i + 1] = 0.3 * (double)(i / 2 % 2) + (i < 4 ? 0.01 : 0.16);
    w.bed.x[3 * i + 2] = i < 4 ? 0.12 : 0.28 + 0.01 * (double)i;
    w.bed.v[3 * i] = i < 4 ? -1 : 1;
  }
  return w;
}

/* A bed that is moved by any vector along the sides is the same bed: to
   rounding where steps are fixed, times some powers of e by the collisions;
   else within the tolerance, since the number of stages and of spheres in a
   level jump. */
static void test_translation(const char *method, const char *control,
                             double step, double most) {
  const double move[2] = {0.37, -1.93};
  struct bed end[2];
  for (size_t k = 0; k < 2; k++) {
    struct world w = over_sides(SCENE_ROTATION);
    for (size_t i = 0; i < w.bed.n && k; i++)
      for (size_t c = 0; c < 2; c++)
        w.bed.x[3 * i + c] += move[c];
    struct motion *m = start(&w, &(struct integrate_options){.method = method,
                                                             .control = control,
                                                             .tol = 1e-4,
                                                             .step = step,
                                                             .hinit = 1e-4});
    run_to(m, 0.3);
    if (bed_copy(&end[k], &w.bed) != GSL_SUCCESS)
      abort();
    dynamics_unpack(m->dynamics, integrate_state(m->integrator), &end[k]);
    motion_free(m);
    world_free(&w);
  }
  for (size_t i = 0; i < 3 * end[0].n; i++)
    CHECK_CLOSE(end[1].x[i] - end[0].x[i], i % 3 < 2 ? move[i % 3] : 0, most);
  bed_free(&end[0]);
  bed_free(&end[1]);
}

/* Without walls and weight nothing takes momentum. Steps of rkc conserve it to
   rounding, since forces of each stage balance. */
static void test_periodic_momentum(gsl_rng *rng) {
  enum { N = 30 };
  struct world w = periodic_world(rng, SCENE_ROTATION, N);
  w.scene.walls_count = 0;
  memset(w.scene.gravity, 0, sizeof w.scene.gravity);
  w.scene.law.f0 = 1;
  double before[3] = {0}, after[3] = {0};
  for (size_t i = 0; i < N; i++)
    vec3_axpy(1, w.bed.v + 3 * i, before);
  struct motion *m =
      start(&w, &(struct integrate_options){.method = "rkc",
                                            .control = "predictive",
                                            .tol = 1e-3,
                                            .hinit = 1e-5});
  run_to(m, 0.2);
  dynamics_unpack(m->dynamics, integrate_state(m->integrator), &w.bed);
  double fastest = 0;
  for (size_t i = 0; i < N; i++) {
    vec3_axpy(1, w.bed.v + 3 * i, after);
    fastest = GSL_MAX(fastest, vec3_norm(w.bed.v + 3 * i));
  }
  CHECK(fastest > 1); /* what overlapped has flown apart */
  for (size_t k = 0; k < 3; k++)
    CHECK_CLOSE(after[k], before[k], 1e-9);
  motion_free(m);
  world_free(&w);
}

/* A hexagonal layer on the floor, 4 by 4: each sphere has six neighbours, and
   is at rest. */
static void test_layer(void) {
  enum { N = 16 };
  const double apart = 0.2, row = apart * sqrt(0.75);
  const double gap = log(0.58 * 10 / 9.81) / 150;
  struct world w = world_new(SCENE_ROTATION, N);
  w.scene.period[0] = 4 * apart;
  w.scene.period[1] = 4 * row;
  if (scene_add_wall(&w.scene, (double[]){0, 0, 0}, (double[]){0, 0, -1}) !=
      GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < N; i++) {
    w.bed.x[3 * i] = apart * ((double)(i % 4) + 0.5 * (double)(i / 4 % 2));
    w.bed.x[3 * i + 1] = row * (double)(i / 4);
    w.bed.x[3 * i + 2] = 0.1 + gap;
  }
  struct bed rates = rates_of(&w, false, 1);
  for (size_t i = 0; i < 3 * N; i++)
    CHECK_CLOSE(rates.v[i], 0, 1e-11);
  struct network net = {0};
  size_t degree[N], spheres[N];
  CHECK(network_find(&net, &w.scene, &w.bed, 1e-9) == GSL_SUCCESS);
  network_mark(&net, 1e-9, 0);
  network_degrees(&net, NULL, degree, spheres);
  for (size_t i = 0; i < N; i++)
    CHECK(degree[i] == 7 && spheres[i] == 6);
  network_free(&net);
  bed_free(&rates);
  world_free(&w);
}

/* Pairs of points across sides: whose they are, the way from one to the other,
   and that there are all of them. */
static void test_points(gsl_rng *rng) {
  enum { N = 40 };
  static const double period[3] = {1, 0.8, 0};
  const double reach = 0.3; /* nearest images alone */
  double x[3 * N];
  for (int k = 0; k < 3 * N; k++)
    x[k] = 0.8 * gsl_rng_uniform(rng);
  size_t all = 0, found = 0, across = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < i; j++) {
      double u[3];
      vec3_sub(x + 3 * i, x + 3 * j, u);
      periodic_nearest(period, u);
      all += vec3_norm(u) <= reach;
    }
  struct periodic_pairs p = {0};
  CHECK(periodic_pairs_find(&p, N, x, reach, period) == GSL_SUCCESS);
  for (size_t k = 0; k < p.near.count; k++) {
    size_t i = N, j = N;
    double u[3], way[3];
    if (!periodic_pair(&p, k, &i, &j, u) || !CHECK(i < N && j < N && i != j))
      continue;
    vec3_sub(x + 3 * i, x + 3 * j, way);
    across += fabs(way[0]) > 0.5 || fabs(way[1]) > 0.4;
    periodic_nearest(period, way);
    vec3_sub(u, way, way);
    CHECK_CLOSE(vec3_norm(way), 0, 1e-15);
    found += vec3_norm(u) <= reach;
  }
  CHECK(found == all && across > 5);
  periodic_pairs_free(&p);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 12);
  test_obstacle_forces(rng);
  for (int model = SCENE_BASIC; model <= SCENE_ROTATION; model++) {
    test_methods(over_obstacles, (enum scene_model)model);
    test_methods(in_tubes, (enum scene_model)model);
    test_methods(over_sides, (enum scene_model)model);
  }
  test_obstacle_energy();
  test_obstacles_alone();
  test_cylinder_forces(rng);
  test_cylinder_jacobian(rng);
  test_rest_in_tube();
  test_pendulum();
  test_rolling_along();
  test_rolling_round();
  test_refused_cylinders();
  test_periodic_pairs(rng);
  test_periodic_forces(rng);
  test_periodic_jacobian(rng);
  test_translation("merson", "standard", 1e-5, 1e-11);
  test_translation("verlet", NULL, 1e-5, 1e-11);
  test_translation("rkc", "predictive", 0, 1e-5);
  test_translation("multirate", "local", 0, 1e-5);
  test_periodic_momentum(rng);
  test_layer();
  test_periodic_images(rng);
  test_points(rng);
  gsl_rng_free(rng);
  return check_done();
}
