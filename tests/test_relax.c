/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Starts that overlap: how deep contacts are afterwards, by all pairs and
   straight from the law; what moves and what stays; and that spheres which are
   let go then do not fly apart. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "dynamics/motion.h"
#include "geometry/periodic.h"
#include "model/relax.h"

static const struct relax_limits limits = {10, 1, 20000};
static const double g = 9.81, radius = 0.1;

static struct similarity units(void) {
  return similarity_of(radius, 1, g);
}

static struct bed new_bed(size_t n) {
  struct bed b;
  CHECK(bed_alloc(&b, n) == GSL_SUCCESS);
  for (size_t i = 0; i < n; i++)
    b.r[i] = radius;
  return b;
}

/* Energy of the contact of two spheres, the nearest images, or of one and a
   wall, by m g r of the lighter; 0 for none. */
static double stored(const struct scene *s, double gap, double mass) {
  return gap < 0 ? contact_energy(&s->law, gap) / (mass * g * radius) : 0;
}

/* The most that any contact stores, by all pairs; obstacles have none among
   each other. */
static double most_stored(const struct scene *s, const struct bed *b) {
  double most = 0;
  for (size_t i = 0; i < b->n; i++) {
    for (size_t j = 0; j < i; j++) {
      double u[3];
      const bool fixed[2] = {bed_is_fixed(b, i), bed_is_fixed(b, j)};
      if (fixed[0] && fixed[1])
        continue;
      vec3_sub(b->x + 3 * i, b->x + 3 * j, u);
      periodic_nearest(s->period, u);
      const double mass = fixed[0]   ? b->m[j]
                          : fixed[1] ? b->m[i]
                                     : fmin(b->m[i], b->m[j]);
      most = fmax(most, stored(s, vec3_norm(u) - b->r[i] - b->r[j], mass));
    }
    for (size_t w = 0; w < s->walls_count && !bed_is_fixed(b, i); w++)
      most = fmax(most,
                  stored(s, wall_distance(&s->walls[w], b->x + 3 * i) - b->r[i],
                         b->m[i]));
  }
  return most;
}

static struct relax_report push(const struct scene *s, struct bed *b) {
  const struct similarity u = units();
  struct relax_report r = {0};
  CHECK(relax_bed(s, &u, &limits, b, &r) == GSL_SUCCESS);
  /* rounding of places, by kappa */
  CHECK(most_stored(s, b) <=
        (r.pairs + r.walls ? limits.enough : limits.deep) * (1 + 1e-12));
  CHECK(r.left == 0);
  return r;
}

/* Two spheres, of any masses, along any direction: apart along it, the centre
   of mass stays, and one pass does. */
static void test_pairs(void) {
  const double n[3] = {2. / 7, -3. / 7, 6. / 7};
  for (int k = 0; k < 6; k++) {
    struct scene s = scene_default();
    struct bed b = new_bed(2);
    const double d = (double[]){0, 0.02, 0.1, 0.15, 0.17, 0.1}[k];
    b.m[1] = k == 5 ? 3 : 1;
    for (int c = 0; c < 3; c++)
      b.x[3 + c] = d * n[c];
    const bool deep = stored(&s, d - 2 * radius, 1) > limits.deep;
    CHECK(deep == (k != 4));
    const struct relax_report r = push(&s, &b);
    CHECK(r.pairs == deep && r.walls == 0 && r.moved == 2 * deep &&
          r.passes == 2 * deep); /* the second one finds nothing to do */
    double u[3], centre[3];
    vec3_sub(b.x + 3, b.x, u);
    for (int c = 0; c < 3; c++) {
      centre[c] = b.m[0] * b.x[c] + b.m[1] * (b.x[3 + c] - d * n[c]);
      CHECK_CLOSE(centre[c], 0, 1e-15);
    }
    if (d > 0) {
      double across[3];
      vec3_cross(u, n, across);
      CHECK_CLOSE(vec3_norm(across), 0, 1e-15);
      CHECK(vec3_dot(u, n) > 0);
    }
    if (deep) {
      /* the gap of 1 m g r and a fiftieth of the radius */
      const double gap = -log(150 * g * radius / 10) / 150 + 0.002;
      CHECK_CLOSE(vec3_norm(u), 2 * radius + gap, 1e-12);
      CHECK_CLOSE(r.depth, 2 * radius - d, 1e-15);
    }
    bed_free(&b);
  }
}

/* Two spheres in a box of 1 m. */
static struct bed two_in_box(struct scene *s, const double x[6]) {
  struct bed b = new_bed(2);
  *s = scene_default();
  CHECK(scene_add_box(s, 1, 1) == GSL_SUCCESS);
  memcpy(b.x, x, 6 * sizeof *b.x);
  return b;
}

/* In a corner of the box, and another one in the open that stays. */
static void test_walls(void) {
  struct scene s;
  struct bed b = two_in_box(&s, (double[]){0.01, 0.99, 0.001, 0.5, 0.5, 0.09});
  const struct relax_report r = push(&s, &b);
  CHECK(r.walls == 3 && r.pairs == 0 && r.moved == 1 && r.sphere == 0);
  CHECK_CLOSE(r.depth, 0.099, 1e-15);
  const double least = radius - log(150 * g * radius / 10) / 150;
  for (int c = 0; c < 3; c++) { /* three contacts push it, in several passes */
    const double in = c == 1 ? 1 - b.x[c] : b.x[c];
    CHECK(in >= least - 1e-15 && in < least + 0.002);
  }
  CHECK(b.x[5] == 0.09);
  scene_free(&s);
  bed_free(&b);
}

/* As many pairs as walls: a sphere half in the floor, and one half in it. */
static void test_pair_on_wall(void) {
  struct scene s;
  struct bed b = two_in_box(&s, (double[]){0.5, 0.5, 0.05, 0.5, 0.5, 0.2});
  const struct relax_report r = push(&s, &b);
  CHECK(r.walls == 1 && r.pairs == 1 && r.moved == 2 && r.passes > 1);
  scene_free(&s);
  bed_free(&b);
}

/* Spheres at random places, some of them in one place and some obstacles. */
static struct bed crowd(size_t n, const double side[3], unsigned long seed) {
  struct bed b = new_bed(n);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  CHECK(bed_fix_none(&b) == GSL_SUCCESS);
  for (size_t i = 0; i < n; i++) {
    for (int c = 0; c < 3; c++)
      b.x[3 * i + (size_t)c] = side[c] * (0.01 + 0.98 * gsl_rng_uniform(rng));
    b.r[i] = radius * (0.5 + gsl_rng_uniform(rng));
    b.m[i] = gsl_pow_3(b.r[i] / radius);
    if (i % 10 == 3)
      memcpy(b.x + 3 * i, b.x + 3 * (i - 1), 3 * sizeof *b.x);
    b.fixed[i] = i % 40 == 5;
  }
  gsl_rng_free(rng);
  return b;
}

/* In a box, between periodic sides, in a tube; obstacles stay, and so does
   whoever is not pushed. Lengths by 4 and masses by 2 keep the bits. */
static void test_crowds(void) {
  for (int k = 0; k < 3; k++) {
    struct scene s[2];
    struct bed b[2];
    for (int big = 0; big < 2; big++) {
      const double f = big ? 4 : 1;
      struct scene *q = &s[big];
      *q = scene_default();
      q->law.kappa /= f;
      q->law.f0 *= big ? 2 : 1; /* m g */
      if (k == 0)
        CHECK(scene_add_box(q, f, f) == GSL_SUCCESS);
      else
        CHECK(scene_add_wall(q, (double[]){0, 0, 0}, (double[]){0, 0, -1}) ==
              GSL_SUCCESS);
      if (k == 1)
        q->period[0] = q->period[1] = f;
      if (k == 2)
        CHECK(scene_add_cylinder(q, (double[]){0.5 * f, 0.5 * f, 0},
                                 (double[]){0, 0, 1}, 0.75 * f) == GSL_SUCCESS);
      b[big] = crowd(120, (double[]){1, 1, 0.6}, 7);
      for (size_t i = 0; i < b[big].n; i++) {
        for (size_t c = 0; c < 3; c++)
          b[big].x[3 * i + c] *= f;
        b[big].r[i] *= f;
        b[big].m[i] *= big ? 2 : 1;
      }
    }
    struct bed before;
    CHECK(bed_copy(&before, &b[0]) == GSL_SUCCESS);
    const struct relax_report r = push(&s[0], &b[0]);
    CHECK(r.pairs > 100 && r.walls > 10 && r.moved > 50);
    for (size_t i = 0; i < b[0].n; i++)
      if (bed_is_fixed(&b[0], i))
        CHECK(!memcmp(b[0].x + 3 * i, before.x + 3 * i, 3 * sizeof(double)));
    const struct similarity u = similarity_of(4 * radius, 2, g);
    struct relax_report large;
    CHECK(relax_bed(&s[1], &u, &limits, &b[1], &large) == GSL_SUCCESS);
    CHECK(large.passes == r.passes && large.furthest == 4 * r.furthest);
    for (size_t i = 0; i < 3 * b[0].n; i++)
      CHECK(b[1].x[i] == 4 * b[0].x[i]);
    bed_free(&before);
    for (int big = 0; big < 2; big++) {
      bed_free(&b[big]);
      scene_free(&s[big]);
    }
  }
}

/* Where nothing is too deep nothing moves, though contacts are deeper than is
   enough; where there is no room, or no place, the bed is as it was. */
static void test_stays(void) {
  const struct similarity u = units();
  struct scene s = scene_default();
  struct bed b = new_bed(3);
  for (size_t i = 0; i < 3; i++)
    b.x[3 * i] = 0.17 * (double)i;
  CHECK(stored(&s, -0.03, 1) > limits.enough);
  CHECK(stored(&s, -0.03, 1) < limits.deep);
  struct relax_report r = push(&s, &b);
  CHECK(r.pairs + r.walls + r.passes + r.moved == 0);
  CHECK(b.x[0] == 0 && b.x[3] == 0.17 && b.x[6] == 0.34);
  bed_free(&b);

  b = new_bed(40);
  CHECK(scene_add_box(&s, 0.5, 0.5) == GSL_SUCCESS);
  CHECK(scene_add_wall(&s, (double[]){0, 0, 0.5}, (double[]){0, 0, 1}) ==
        GSL_SUCCESS);
  for (size_t i = 0; i < 3 * b.n; i++)
    b.x[i] = 0.1 + 0.3 * fmod(0.618 * (double)i, 1);
  struct bed before;
  CHECK(bed_copy(&before, &b) == GSL_SUCCESS);
  CHECK(relax_bed(&s, &u, &(struct relax_limits){10, 1, 50}, &b, &r) ==
        GSL_EMAXITER);
  CHECK(r.passes == 50 && r.left > 0 && r.pairs > 0);
  CHECK(!memcmp(b.x, before.x, 3 * b.n * sizeof *b.x));
  b.x[7] = GSL_NAN;
  r.pairs = 99;
  CHECK(relax_bed(&s, &u, &limits, &b, &r) == GSL_EINVAL && r.pairs == 99);
  bed_free(&b);
  bed_free(&before);
  scene_free(&s);
}

/* What is let go: the kinetic energy of the whole never comes to more than the
   contacts store, which is at most 1 m g r each; without gravity and losses, so
   that all of it comes out. */
static void test_let_go(void) {
  struct scene s = scene_default();
  s.model = SCENE_BASIC;
  s.law.restitution = 1;
  s.gravity[2] = 0;
  struct bed b = new_bed(30);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (size_t i = 0; i < 3 * b.n; i++)
    b.x[i] = 0.3 * gsl_rng_uniform(rng);
  gsl_rng_free(rng);
  const struct relax_report r = push(&s, &b);
  CHECK(r.pairs > 100);
  struct motion *m = NULL;
  CHECK(motion_alloc(&m, &s, &b,
                     &(struct integrate_options){.method = "dopri5",
                                                 .control = "standard",
                                                 .tol = 1e-6,
                                                 .hinit = 1e-3},
                     &(struct dynamics_options){.threads = 1},
                     1 / s.law.kappa) == GSL_SUCCESS);
  const double held =
      dynamics_potential(m->dynamics, integrate_state(m->integrator));
  double most = 0;
  while (integrate_time(m->integrator) < 0.5) {
    CHECK(integrate_step(m->integrator) == GSL_SUCCESS);
    most = fmax(most,
                dynamics_kinetic(m->dynamics, integrate_state(m->integrator)));
  }
  CHECK(most > 0.5 * held && most <= held * (1 + 1e-3));
  CHECK(held <
        6 * 30 * limits.enough * g * radius); /* some 12/2 contacts each */
  motion_free(m);
  bed_free(&b);
}

/* A sphere that an obstacle pushes onto one that was far from it. */
static void test_pushed_far(void) {
  struct scene s = scene_default();
  s.model = SCENE_BASIC;
  s.gravity[2] = 0;
  for (int k = 0; k < 20; k++) {
    struct bed b = new_bed(3);
    CHECK(bed_fix_none(&b) == GSL_SUCCESS);
    b.fixed[0] = true;
    b.x[3] = 0.02;
    b.x[6] = 0.2 + 0.01 * k;
    push(&s, &b);
    bed_free(&b);
  }
}

int main(void) {
  gsl_set_error_handler_off();
  test_pairs();
  test_walls();
  test_pair_on_wall();
  test_crowds();
  test_stays();
  test_let_go();
  test_pushed_far();
  return check_done();
}
