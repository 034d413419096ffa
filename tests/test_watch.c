/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What diagnoses stand on: how far methods reach, against their stability
   polynomials; the dominant eigenvalue, against known ones and those of a dense
   matrix; a survey of the contacts, against oracle.h; and that looking changes
   no bit of a trajectory. The warnings themselves: test_watch.sh. */
#include <complex.h>
#include <float.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "dynamics/motion.h"
#include "oracle.h"
#include "steppers/stiffness.h"
#include "model/travel.h"
#include "program/run_watch.h"
#include "sample.h"

/* --- how far a step reaches ------------------------------------------------*/

/* R(z) = sum of c[k] z^k: 1/k! up to the order, then the method's own. */
struct polynomial {
  const char *method;
  size_t degree;
  double last[2]; /* beyond 1/4! */
  double real;    /* where |R| = 1 on the negative axis, from the literature */
};
static const struct polynomial polynomials[] = {
    {"merson", 5, {1. / 144, 0}, 3.548},
    {"dopri5", 6, {1. / 120, 1. / 600}, 3.307},
    {"rkf45", 6, {1. / 120, 1. / 2080}, 3.678},
    {"rkck", 6, {1. / 120, 1. / 800}, 0}};

static double growth(const struct polynomial *p, double r, double angle) {
  const double complex z = r * cexp(I * angle);
  double complex sum = 0, power = 1;
  double c = 1;
  for (size_t k = 0; k <= p->degree; k++) {
    c = k == 0 ? 1 : k <= 4 ? c / (double)k : p->last[k - 5];
    sum += c * power;
    power *= z;
  }
  return cabs(sum);
}

static void test_limits(void) {
  for (size_t m = 0; m < sizeof polynomials / sizeof *polynomials; m++) {
    const struct polynomial *p = &polynomials[m];
    struct stiffness_limits l;
    if (!CHECK(integrate_limits(p->method, &l) == GSL_SUCCESS))
      continue;
    for (size_t k = 0; k < STIFFNESS_RAYS; k++) {
      const double share = (double)k / (STIFFNESS_RAYS - 1);
      const double angle = M_PI_2 * (1 + share), r = l.at[k];
      /* found to 1e-6, where |R| rises by less than 100 |dz| */
      bool ok = growth(p, r - 1e-6, angle) <= 1.01 + 1e-6 &&
                growth(p, r + 2e-6, angle) >= 1.01 - 1e-4;
      for (size_t k = 0; 0.01 * (double)k < r; k++)
        ok = ok && growth(p, 0.01 * (double)k, angle) <= 1.01 + 1e-6;
      if (!CHECK(ok))
        fprintf(stderr, "  %s at %.0f degrees: %g\n", p->method,
                angle / M_PI * 180, r);
      CHECK_CLOSE(stiffness_limit_at(&l, angle), r, 1e-12);
    }
    /* 1 % beyond |R| = 1, where |R'| is above 1 */
    if (p->real > 0)
      CHECK_CLOSE(l.at[STIFFNESS_RAYS - 1], p->real, 0.0105);
    /* linear between the rays */
    const double between = M_PI - 0.25 * M_PI_2 / (STIFFNESS_RAYS - 1);
    CHECK_CLOSE(stiffness_limit_at(&l, between),
                0.75 * l.at[STIFFNESS_RAYS - 1] +
                    0.25 * l.at[STIFFNESS_RAYS - 2],
                1e-12);
  }
  struct stiffness_limits l;
  struct {
    struct stiffness_limits all;
    double behind;
  } v = {.behind = 7};
  CHECK(integrate_limits("verlet", &v.all) == GSL_SUCCESS);
  CHECK(stiffness_limit_at(&v.all, 2) == 2);
  CHECK(v.behind == 7); /* as many rays as there are, and no more */
  CHECK(integrate_limits("rkc", &l) == GSL_EINVAL);
  CHECK(integrate_limits("msbdf", &l) == GSL_EINVAL);
  CHECK(integrate_limits("none", &l) == GSL_EINVAL);
}

/* By running: a mode within the limit stays, one beyond explodes. For verlet
   both of its limits. */
struct line {
  double stiffness, damping;
};

static int spring(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const struct line *l = params;
  dydt[0] = y[1];
  dydt[1] = -l->stiffness * y[0] - l->damping * y[1];
  return GSL_SUCCESS;
}

static double after_steps(const char *method, struct line l, double h) {
  const double scale[2] = {1, 1};
  const struct integrate_options o = {
      .method = method, .control = "standard", .tol = 1, .hinit = 1, .step = h};
  const struct integrate_problem p = {.system = {spring, NULL, 2, &l},
                                      .scale = scale,
                                      .row = 2,
                                      .positions = 1};
  struct integrator *it;
  if (!CHECK(integrate_alloc(&it, &o, &p, 0, (double[]){0, 1}) == GSL_SUCCESS))
    return GSL_NAN;
  for (size_t k = 0; k < 3000 && fabs(integrate_state(it)[1]) < 1e12; k++)
    if (!CHECK(integrate_step(it) == GSL_SUCCESS))
      break;
  const double v =
      hypot(integrate_state(it)[0] * sqrt(l.stiffness), integrate_state(it)[1]);
  integrate_free(it);
  return v;
}

static void test_reach(void) {
  const char *const methods[] = {"merson", "dopri5", "rkf45",
                                 "rkck",   "rk8pd",  "verlet"};
  for (size_t m = 0; m < 6; m++) {
    struct stiffness_limits l;
    CHECK(integrate_limits(methods[m], &l) == GSL_SUCCESS);
    const double real = l.at[STIFFNESS_RAYS - 1];
    /* 1 % of growth is within 1 % of the limit there */
    CHECK(after_steps(methods[m], (struct line){0, 1}, 0.98 * real) < 2);
    CHECK(after_steps(methods[m], (struct line){0, 1}, 1.02 * real) > 1e6);
    if (!strcmp(methods[m], "verlet") || !strcmp(methods[m], "merson"))
      CHECK(after_steps(methods[m], (struct line){1, 0}, 0.98 * l.at[0]) < 10);
    CHECK(after_steps(methods[m], (struct line){1, 0}, 1.05 * l.at[0]) > 1e6);
  }
}

/* --- the dominant eigenvalue -----------------------------------------------*/

static void test_oscillator(void) {
  for (int k = 0; k <= 32; k++) {
    const double damping = 125 * k;
    struct line l = {1e6, damping}; /* critical at 2000 */
    const gsl_odeiv2_system system = {spring, NULL, 2, &l};
    const double y[2] = {0.3, -2}, half = damping / 2;
    double f[2];
    spring(0, y, f, &l);
    struct stiffness *s;
    if (!CHECK(stiffness_alloc(&s, 2) == GSL_SUCCESS))
      return;
    struct stiffness_mode mode = {0};
    CHECK(stiffness_estimate(s, &system, 0, y, f, 8, &mode) == GSL_SUCCESS);
    const bool complex_pair = half * half < 1e6;
    const double radius = complex_pair ? 1e3 : half + sqrt(half * half - 1e6);
    const double angle = complex_pair ? M_PI - acos(half / 1e3) : M_PI;
    /* differences over 1.5e-8 |y| of f ~ 1e6 |y|; a double root splits by the
       square root of that */
    const double tol = fabs(half - 1e3) < 100 ? 0.2 : 1e-3;
    CHECK_REL(mode.radius, radius, tol);
    CHECK_CLOSE(mode.angle, angle, fabs(half - 1e3) < 100 ? 0.3 : 1e-2);
    stiffness_free(s);
  }
}

static int constant(double t, const double y[], double dydt[], void *params) {
  (void)t;
  (void)y;
  memset(dydt, 0, *(size_t *)params * sizeof *dydt);
  dydt[0] = 9.81;
  return GSL_SUCCESS;
}

static int failing(double t, const double y[], double dydt[], void *params) {
  (void)t;
  (void)y;
  (void)dydt;
  (void)params;
  return GSL_EBADFUNC;
}

static void test_estimate_edges(void) {
  size_t dim = 4;
  const double y[4] = {0}, f[4] = {9.81};
  struct stiffness *s;
  if (!CHECK(stiffness_alloc(&s, dim) == GSL_SUCCESS))
    return;
  struct stiffness_mode mode = {-1, -1};
  const gsl_odeiv2_system bad = {failing, NULL, dim, NULL};
  CHECK(stiffness_estimate(s, &bad, 0, y, f, 3, &mode) == GSL_EBADFUNC);
  CHECK(mode.radius == -1);
  const gsl_odeiv2_system flat = {constant, NULL, dim, &dim};
  CHECK(stiffness_estimate(s, &flat, 0, y, f, 3, &mode) == GSL_SUCCESS);
  CHECK(mode.radius == 0);
  /* growth, which no method damps, has the angle of what only just does not */
  double growth[2] = {3, 0}, first[4] = {3, 0, 0, 0};
  const double one[4] = {1, 0, 0, 0};
  dim = 2;
  stiffness_free(s);
  if (!CHECK(stiffness_alloc(&s, dim) == GSL_SUCCESS))
    return;
  const gsl_odeiv2_system grows = {stiffness_linear, NULL, dim, growth};
  CHECK(stiffness_estimate(s, &grows, 0, one, first, 20, &mode) == GSL_SUCCESS);
  CHECK_CLOSE(mode.radius, 3, 1e-6);
  CHECK(mode.angle == M_PI_2);
  stiffness_free(s);
}

/* --- beds ------------------------------------------------------------------*/

/* Spheres in a narrow box, dropped and let settle for a while. */
static bool settled(struct scene *s, struct bed *b, size_t n,
                    enum scene_model model, double time) {
  *s = scene_default();
  s->model = model;
  s->gravity[2] = -9.81;
  if (scene_add_box(s, 0.5, 0.5) != GSL_SUCCESS ||
      bed_alloc(b, n) != GSL_SUCCESS)
    return false;
  for (size_t i = 0; i < n; i++) {
    b->r[i] = 0.1;
    const double at[3] = {
        0.12 + 0.25 * (double)(i % 2) + 0.01 * sin(9. * (double)i),
        0.12 + 0.25 * (double)(i / 2 % 2) + 0.01 * cos(7. * (double)i),
        0.12 + 0.22 * (double)(i / 4)};
    memcpy(b->x + 3 * i, at, sizeof at);
  }
  struct motion *m = NULL;
  const struct integrate_options o = {
      .method = "rkc", .control = "predictive", .tol = 1e-4, .hinit = 1e-3};
  if (motion_alloc(&m, s, b, &o, &(struct dynamics_options){.threads = 1},
                   1 / s->law.kappa) != GSL_SUCCESS)
    return false;
  bool ok = true;
  while (ok && integrate_time(m->integrator) < time)
    ok = integrate_step(m->integrator) == GSL_SUCCESS;
  dynamics_unpack(m->dynamics, integrate_state(m->integrator), b);
  motion_free(m);
  return ok;
}

/* Largest |lambda| of the dense Jacobian. */
static double dense_radius(struct dynamics *d, const double *y) {
  const size_t dim = dynamics_dimension(d);
  double *a = numbers(dim * dim), *dfdt = numbers(dim), radius = 0;
  CHECK(dynamics_jacobian(0, y, a, dfdt, d) == GSL_SUCCESS);
  gsl_matrix_view view = gsl_matrix_view_array(a, dim, dim);
  gsl_vector_complex *lambda = gsl_vector_complex_alloc(dim);
  gsl_eigen_nonsymm_workspace *w = gsl_eigen_nonsymm_alloc(dim);
  gsl_eigen_nonsymm_params(0, 0, w); /* balanced: m, m/s and rad/s */
  CHECK(gsl_eigen_nonsymm(&view.matrix, lambda, w) == GSL_SUCCESS);
  for (size_t k = 0; k < dim; k++)
    radius =
        GSL_MAX(radius, gsl_complex_abs(gsl_vector_complex_get(lambda, k)));
  gsl_eigen_nonsymm_free(w);
  gsl_vector_complex_free(lambda);
  free(a);
  free(dfdt);
  return radius;
}

static void test_bed_radius(void) {
  const enum scene_model models[3] = {SCENE_BASIC, SCENE_FRICTION,
                                      SCENE_ROTATION};
  for (size_t k = 0; k < 3; k++) {
    struct scene scene;
    struct bed bed;
    if (!CHECK(settled(&scene, &bed, 16, models[k], 0.35)))
      continue;
    struct dynamics *d = NULL;
    CHECK(dynamics_alloc(&d, &scene, &bed,
                         &(struct dynamics_options){.threads = 1}) ==
          GSL_SUCCESS);
    const size_t dim = dynamics_dimension(d);
    double *y = numbers(dim), *f = numbers(dim);
    dynamics_pack(d, &bed, y);
    CHECK(dynamics_rhs(0, y, f, d) == GSL_SUCCESS);
    const double want = dense_radius(d, y);
    const gsl_odeiv2_system system = {dynamics_rhs, NULL, dim, d};
    struct stiffness *s;
    if (!CHECK(stiffness_alloc(&s, dim) == GSL_SUCCESS))
      return;
    struct stiffness_mode mode;
    /* four at a time, as along a run: near after three calls, there after 60
       (differences of f, 1e4, over 1e-8: 1e-4) */
    for (size_t call = 1; call <= 60; call++) {
      CHECK(stiffness_estimate(s, &system, 0, y, f, 4, &mode) == GSL_SUCCESS);
      if (call == 3)
        CHECK_REL(mode.radius, want, 0.1);
    }
    CHECK_REL(mode.radius, want, 1e-3);
    CHECK_CLOSE(mode.angle, M_PI, 1e-3); /* contacts are overdamped */
    stiffness_free(s);
    free(y);
    free(f);
    dynamics_free(d);
    bed_free(&bed);
    scene_free(&scene);
  }
}

/* --- a survey of the contacts ----------------------------------------------*/

static void test_survey(gsl_rng *rng) {
  for (unsigned long seed = 0; seed < 60; seed++) {
    gsl_rng_set(rng, seed);
    /* the last in an order of its own */
    const size_t n = seed < 59 ? 1 + seed % 40 : 1200;
    struct scene s = scene_default();
    struct bed b;
    s.gravity[2] = -9.81;
    CHECK(bed_alloc(&b, n) == GSL_SUCCESS);
    if (seed % 2) /* without, the deepest overlap is a pair's */
      CHECK(scene_add_box(&s, 1, 1) == GSL_SUCCESS &&
            scene_add_wall(&s, (double[]){0.2, 0.1, 0.9},
                           (double[]){1, 2, 2}) == GSL_SUCCESS);
    for (size_t i = 0; i < n; i++) {
      b.r[i] = 0.05 + 0.1 * gsl_rng_uniform(rng);
      b.m[i] = 0.5 + gsl_rng_uniform(rng);
      for (size_t k = 0; k < 3; k++)
        b.x[3 * i + k] = 1.2 * gsl_rng_uniform(rng) - 0.1;
    }
    double overlap = 0, inside = GSL_POSINF, gravity = 0, stored = 0;
    size_t contacts = 0, wall = 0, outsider = 0;
    for (size_t i = 0; i < n; i++) {
      gravity += 9.81 * b.m[i] * b.x[3 * i + 2];
      for (size_t j = 0; j < n + s.walls_count; j++) {
        if (j < n && j <= i)
          continue;
        const bool pair = j < n;
        const double gap = pair ? oracle_pair(&s, &b, i, j).gap
                                : oracle_wall(&s, &b, i, j - n).gap;
        const double r = pair ? GSL_MIN(b.r[i], b.r[j]) : b.r[i];
        contacts += gap <= s.law.lmax;
        stored += oracle_f(&s, gap) / s.law.kappa;
        overlap = GSL_MAX(overlap, -gap / r);
        if (!pair && gap + r < inside) {
          inside = gap + r;
          outsider = i;
          wall = j - n;
        }
      }
    }
    struct dynamics *d = NULL;
    CHECK(
        dynamics_alloc(&d, &s, &b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
    double *y = numbers(dynamics_dimension(d));
    dynamics_pack(d, &b, y);
    struct survey v;
    CHECK(dynamics_survey(d, y, &v) == GSL_SUCCESS);
    const double tol = 1e3 * DBL_EPSILON; /* of exponents up to 150 */
    bool ok = CHECK_CLOSE(v.gravity, gravity, tol * 30 * (double)n);
    ok = CHECK_REL(v.stored, stored, tol) && ok;
    ok = CHECK(v.contacts == contacts) && ok;
    ok = CHECK_CLOSE(v.overlap, overlap, 100 * tol) && ok;
    if (inside < s.law.lmax) /* else nobody may be listed */
      ok = CHECK_CLOSE(v.inside, inside, tol) &&
           CHECK(v.outsider == outsider && v.wall == wall) && ok;
    /* the sphere named has it */
    double own = 0;
    for (size_t j = 0; j < n + s.walls_count; j++) {
      const size_t i = v.sphere;
      if (j == i)
        continue;
      const double gap = j < n ? oracle_pair(&s, &b, i, j).gap
                               : oracle_wall(&s, &b, i, j - n).gap;
      own = GSL_MAX(own, -gap / (j < n ? GSL_MIN(b.r[i], b.r[j]) : b.r[i]));
    }
    ok = CHECK_CLOSE(own, overlap, 100 * tol) && ok;
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    y[0] = GSL_NAN;
    CHECK(dynamics_survey(d, y, &v) != GSL_SUCCESS);
    free(y);
    dynamics_free(d);
    bed_free(&b);
    scene_free(&s);
  }
}

/* Looking at a run, as often as can be, changes no bit of it. */
static void test_bits(const char *method, enum scene_model model) {
  struct scene scene;
  struct bed bed;
  if (!CHECK(settled(&scene, &bed, 24, model, 0.25)))
    return;
  const struct integrate_options o = {.method = method,
                                      .control = "standard",
                                      .tol = 1e-3,
                                      .hinit = 1e-3,
                                      .step =
                                          strcmp(method, "verlet") ? 0 : 1e-4};
  struct motion *m[2] = {NULL};
  double *y[2];
  for (int look = 0; look < 2; look++) {
    CHECK(motion_alloc(&m[look], &scene, &bed, &o,
                       &(struct dynamics_options){.threads = 1},
                       1 / scene.law.kappa) == GSL_SUCCESS);
    struct dynamics *d = m[look]->dynamics;
    const size_t dim = dynamics_dimension(d);
    const gsl_odeiv2_system system = {dynamics_rhs, NULL, dim, d};
    struct stiffness *s;
    if (!CHECK(stiffness_alloc(&s, dim) == GSL_SUCCESS))
      return;
    struct stiffness_mode mode;
    struct survey v;
    y[look] = numbers(dim);
    for (size_t k = 0; k < 300; k++) {
      CHECK(integrate_step(m[look]->integrator) == GSL_SUCCESS);
      const double *now = integrate_state(m[look]->integrator);
      if (!look)
        continue;
      CHECK(dynamics_survey(d, now, &v) == GSL_SUCCESS);
      CHECK(stiffness_estimate(s, &system, 0, now,
                               integrate_derivative(m[look]->integrator), 4,
                               &mode) == GSL_SUCCESS);
    }
    memcpy(y[look], integrate_state(m[look]->integrator), dim * sizeof(double));
    stiffness_free(s);
  }
  const size_t bytes = dynamics_dimension(m[0]->dynamics) * sizeof(double);
  CHECK(!memcmp(y[0], y[1], bytes));
  CHECK(integrate_time(m[0]->integrator) == integrate_time(m[1]->integrator));
  for (int look = 0; look < 2; look++) {
    motion_free(m[look]);
    free(y[look]);
  }
  bed_free(&bed);
  scene_free(&scene);
}

static void test_travel(void) {
  /* v t + a t^2/2 = way */
  const double cases[][3] = {
      {0, 9.81, 2}, {3, 0, 2}, {3, 9.81, 1e-3}, {1e-9, 50, 1}};
  for (size_t k = 0; k < 4; k++) {
    const double v = cases[k][0], a = cases[k][1], way = cases[k][2];
    const double t = travel_time(v, a, way);
    CHECK_REL(v * t + 0.5 * a * t * t, way, 8 * DBL_EPSILON);
  }
  CHECK(travel_time(0, 0, 1) == GSL_POSINF);
}

/* A line of its statistics; NaN where there is none. */
static double stat_of(const struct run_watch *w, const char *key) {
  char line[100], name[50];
  double value = GSL_NAN, got;
  FILE *f = tmpfile();
  if (!f)
    abort();
  run_watch_stats(w, f, 0);
  rewind(f);
  while (fgets(line, sizeof line, f))
    if (sscanf(line, "%49s %lf", name, &got) == 2 && !strcmp(name, key))
      value = got;
  fclose(f);
  return value;
}

/* A sphere by itself, whose energies are made up. */
struct lone {
  struct scene scene;
  struct bed bed;
  struct integrate_options options;
  struct motion *motion;
};

static struct lone lone_new(void) {
  struct lone l = {.scene = scene_default(),
                   .options = {.method = "rkc", .hinit = 1e-3}};
  CHECK(bed_alloc(&l.bed, 1) == GSL_SUCCESS);
  l.bed.r[0] = 0.1;
  integrate_defaults(&l.options);
  CHECK(motion_alloc(&l.motion, &l.scene, &l.bed, &l.options,
                     &(struct dynamics_options){.threads = 1},
                     0) == GSL_SUCCESS);
  return l;
}

static void lone_free(struct lone *l) {
  motion_free(l->motion);
  bed_free(&l->bed);
  scene_free(&l->scene);
}

/* Energy from nowhere, or into it where none can be lost: warned of beyond 1 %
   of what has become motion, once. */
static void test_energy(void) {
  const struct {
    double now; /* 1 at the start, all of it from gravity, and none left */
    bool kept;
    size_t warnings;
  } cases[] = {{1.0099, false, 0}, {1.0102, false, 1}, {0.9901, true, 0},
               {0.9899, true, 1},  {0.9, false, 0},    {1.0099, true, 0}};
  struct lone l = lone_new();
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct run_watch *w = NULL;
    CHECK(run_watch_alloc(&w, &(struct run_watch_options){
                                  .integrate = &l.options,
                                  .integrator = l.motion->integrator,
                                  .whose = "the test's",
                                  .nobody = cases[k].kept ? "e = 1" : NULL,
                                  .quiet = true}) == GSL_SUCCESS);
    CHECK(run_watch_energy(w, 1, 0, 0) == GSL_SUCCESS);
    CHECK(run_watch_energy(w, 0, 1, 0) == GSL_SUCCESS);
    run_watch_tell_energy(w);
    CHECK(stat_of(w, "warnings") == 0);
    for (int twice = 0; twice < 2; twice++) {
      CHECK(run_watch_energy(w, 0, cases[k].now, 0) == GSL_SUCCESS);
      run_watch_tell_energy(w);
      CHECK(stat_of(w, "warnings") == (double)cases[k].warnings);
    }
    const double gain = fmax(0, cases[k].now - 1) / cases[k].now;
    CHECK_CLOSE(run_watch_energy_share(w), gain, 4 * DBL_EPSILON);
    CHECK(run_watch_energy(w, GSL_NAN, 0, 0) == GSL_ERANGE);
    run_watch_free(w);
  }
  lone_free(&l);
}

/* A watch that takes over goes on with the energies of the first: what that one
   had seen as the least is what is gained from, what it had warned of is not
   said again, and its statistics are those of one watch all along. */
static void test_energy_goes_on(void) {
  struct lone l = lone_new();
  const struct run_watch_options set = {.integrate = &l.options,
                                        .integrator = l.motion->integrator,
                                        .whose = "the test's",
                                        .quiet = true};
  /* 1 J of gravity, of which 0.5 J are left as motion; 1.5 J later */
  for (int told = 0; told < 2; told++) {
    struct run_watch *w = NULL, *next = NULL;
    CHECK(run_watch_alloc(&w, &set) == GSL_SUCCESS);
    CHECK(run_watch_alloc(&next, &set) == GSL_SUCCESS);
    CHECK(run_watch_energy(w, 1, 0, 0) == GSL_SUCCESS);
    CHECK(run_watch_energy(w, 0, 0.5, 0) == GSL_SUCCESS);
    if (told) {
      CHECK(run_watch_energy(w, 0, 2, 0) == GSL_SUCCESS);
      run_watch_tell_energy(w);
      CHECK(stat_of(w, "warnings") == 1);
    }
    FILE *f = tmpfile();
    if (!f)
      abort();
    struct store out = store_saving(f);
    run_watch_store(w, &out);
    rewind(f);
    struct store in = store_loading(f);
    run_watch_store(next, &in);
    CHECK(store_status(&out) == GSL_SUCCESS &&
          store_status(&in) == GSL_SUCCESS && fgetc(f) == EOF);
    fclose(f);
    CHECK(run_watch_energy(next, 0, 1.5, 0) == GSL_SUCCESS);
    run_watch_tell_energy(next);
    CHECK_CLOSE(run_watch_energy_share(next), 1 / 1.5, 4 * DBL_EPSILON);
    CHECK(stat_of(next, "warnings") == 1);
    CHECK(stat_of(next, "energy_start") == 1);
    CHECK(stat_of(next, "energy_end") == 1.5);
    CHECK(stat_of(next, "energy_gain") == (told ? 1.5 : 1));
    run_watch_free(w);
    run_watch_free(next);
  }
  lone_free(&l);
}

int main(void) {
  gsl_set_error_handler_off();
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_limits();
  test_reach();
  test_oscillator();
  test_estimate_edges();
  test_bed_radius();
  test_survey(rng);
  test_bits("merson", SCENE_ROTATION);
  test_bits("rkc", SCENE_ROTATION);
  test_bits("verlet", SCENE_FRICTION);
  test_bits("rk8pd", SCENE_BASIC);
  test_travel();
  test_energy();
  test_energy_goes_on();
  gsl_rng_free(rng);
  return check_done();
}
