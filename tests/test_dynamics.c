/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of motion against their plain transcription in oracle.h, and
   against what any such system obeys: gradients, balances, symmetries. The
   random cases are numbered by their seeds; a failing one prints its own. */
#define _POSIX_C_SOURCE 200809L /* setenv */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "limit.h"
#include "dynamics/contact_list.h"
#include "dynamics/dynamics.h"
#include "oracle.h"
#include "sample.h"

static const enum scene_model models[3] = {SCENE_BASIC, SCENE_FRICTION,
                                           SCENE_ROTATION};
static const char *const model_names[3] = {"basic", "friction", "rotation"};
static const struct dynamics_options cells = {.threads = 1},
                                     all_pairs = {.all_pairs = true,
                                                  .threads = 1};

/* --- random scenes ---------------------------------------------------------*/

static void direction(gsl_rng *rng, double u[3]) {
  gsl_ran_dir_3d(rng, &u[0], &u[1], &u[2]);
}

/* What a random scene has. */
struct recipe {
  enum scene_model model;
  double e, phi;
  bool radii, masses; /* different ones */
  size_t n, walls;
  double spacing; /* (volume for each sphere)^(1/3) (m) */
  double speed;   /* of surfaces, at most (m/s) */
};

struct sample {
  struct scene scene;
  struct bed bed;
};

static void sample_free(struct sample *s) {
  scene_free(&s->scene);
  bed_free(&s->bed);
}

/* A wall in a random direction that leaves every centre inside, by gap plus
   the radius for the nearest one. */
static void add_wall_beside(gsl_rng *rng, struct sample *s, double gap) {
  double normal[3], point[3], furthest = GSL_NEGINF;
  direction(rng, normal);
  for (size_t i = 0; i < s->bed.n; i++)
    furthest = GSL_MAX(furthest,
                       vec3_dot(normal, s->bed.x + 3 * i) + s->bed.r[i] + gap);
  for (int k = 0; k < 3; k++)
    point[k] = uniform(rng, -1, 1);
  vec3_axpy(furthest - vec3_dot(normal, point), normal, point);
  const double length = uniform(rng, 0.1, 10);
  for (int k = 0; k < 3; k++)
    normal[k] *= length; /* a scene makes it 1 */
  CHECK(scene_add_wall(&s->scene, point, normal) == GSL_SUCCESS);
}

/* Speeds of four decades, so that slip is on both sides of vmin. */
static void random_velocity(gsl_rng *rng, double most, double v[3]) {
  direction(rng, v);
  const double speed = most * pow(10, uniform(rng, -4, 0));
  for (int k = 0; k < 3; k++)
    v[k] *= speed;
}

static struct sample random_sample(gsl_rng *rng, const struct recipe *p) {
  struct sample s = {.scene = scene_default()};
  s.scene.model = p->model;
  s.scene.law.restitution = p->e;
  s.scene.law.friction = p->phi;
  for (int k = 0; k < 3; k++)
    s.scene.gravity[k] = uniform(rng, -10, 10);
  CHECK(bed_alloc(&s.bed, p->n) == GSL_SUCCESS);
  const double side = p->spacing * cbrt((double)p->n);
  /* half of the beds are quiet as a whole */
  const double speed = p->speed * (gsl_rng_get(rng) % 2 ? 1 : 1e-3);
  for (size_t i = 0; i < p->n; i++) {
    s.bed.r[i] = p->radii ? uniform(rng, 0.05, 0.15) : 0.1;
    s.bed.m[i] = p->masses ? uniform(rng, 0.2, 5) : 1;
    for (size_t k = 0; k < 3; k++)
      s.bed.x[3 * i + k] = uniform(rng, -side / 2, side / 2);
    random_velocity(rng, speed, s.bed.v + 3 * i);
    random_velocity(rng, speed / s.bed.r[i], s.bed.w + 3 * i);
  }
  for (size_t k = 0; k < p->walls; k++)
    add_wall_beside(rng, &s, uniform(rng, -0.1, 0.05));
  return s;
}

/* The arms of the contact point, rolling resistance; only where spheres turn.
 */
static void set_sides(struct sample *s, bool lever, bool rolling) {
  s->scene.law.lever = lever ? LEVER_CONTACT : LEVER_PAPER;
  s->scene.law.rolling = rolling && s->scene.law.friction > 0 ? 0.15 : 0;
}

/* The right-hand side at a bed's state, split by kind: 3n each, 0 where spins
   are no unknowns. Rates have the order of states, which is not always the
   bed's, so they are unpacked like one. */
static int rates(struct dynamics *d, const struct bed *b, double *v, double *a,
                 double *alpha) {
  const size_t dim = dynamics_dimension(d);
  double *y = numbers(dim), *dydt = numbers(dim);
  struct bed unpacked = {.n = b->n, .x = v, .v = a, .w = alpha};
  dynamics_pack(d, b, y);
  const int status = dynamics_rhs(0, y, dydt, d);
  memset(alpha, 0, 3 * b->n * sizeof *alpha);
  dynamics_unpack(d, dydt, &unpacked);
  free(y);
  free(dydt);
  return status;
}

static struct dynamics *new_dynamics(const struct sample *s,
                                     const struct dynamics_options *o) {
  struct dynamics *d = NULL;
  if (!CHECK(dynamics_alloc(&d, &s->scene, &s->bed, o) == GSL_SUCCESS))
    abort();
  return d;
}

/* Rates of a scene on its own, by a struct that is used once. */
static void rates_once(const struct sample *s, double *a, double *alpha) {
  struct dynamics *d = new_dynamics(s, &cells);
  double *v = numbers(3 * s->bed.n);
  CHECK(rates(d, &s->bed, v, a, alpha) == GSL_SUCCESS);
  dynamics_free(d);
  free(v);
}

/* Relative error of a contact's force that rounding explains: that of the gap,
   eps times the lengths it comes from, is multiplied by kappa in the exponent;
   that of the velocities, eps times the largest, by the slopes of rho and
   Sigma, 2 psi and 1.5/vmin; and some for exp and the sums. */
static double rounding(const struct sample *s) {
  double length = 0, speed = 0;
  for (size_t i = 0; i < s->bed.n; i++) {
    length = GSL_MAX(length, 2 * vec3_norm(s->bed.x + 3 * i));
    const double v = vec3_norm(s->bed.v + 3 * i);
    const double w = s->bed.r[i] * vec3_norm(s->bed.w + 3 * i);
    speed = GSL_MAX(speed, 2 * (v + w));
  }
  double far = 0;
  for (size_t k = 0; k < s->scene.walls_count; k++)
    far = GSL_MAX(far, vec3_norm(s->scene.walls[k].point));
  const struct contact_law *c = &s->scene.law;
  return 8 * DBL_EPSILON *
         (1 + c->kappa * (length + far) +
          (2 * c->psi + 1.5 * c->friction / c->vmin) * speed);
}

/* Worst of |a - b| over what rounding explains for spheres that carry loads;
   torques have the arm r and I = 2/5 m r^2. NaN counts as infinite. */
static double worst_ratio(const struct sample *s, const double *load,
                          const double *a, const double *b, bool angular) {
  const double tol = rounding(s);
  double worst = 0;
  for (size_t i = 0; i < s->bed.n; i++) {
    double scale = load[i] / s->bed.m[i];
    scale = angular ? 2.5 * scale / s->bed.r[i]
                    : scale + vec3_norm(s->scene.gravity);
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
      const double ratio = a[k] == b[k] ? 0 : fabs(a[k] - b[k]) / (tol * scale);
      if (!(ratio <= worst)) /* NaN too */
        worst = isnan(ratio) ? GSL_POSINF : ratio;
    }
  }
  return worst;
}

/* --- against the oracle ----------------------------------------------------*/

/* Coverage, checked at the end: contacts of each sort that were compared. */
static size_t slow_slips, fast_slips, deep_overlaps, idle_contacts, wall_hits;

static void count_contacts(const struct sample *s) {
  for (size_t i = 0; i < s->bed.n; i++) {
    for (size_t j = 0; j < i; j++) {
      const struct oracle_contact c = oracle_pair(&s->scene, &s->bed, i, j);
      if (c.gap > s->scene.law.lmax)
        continue;
      const double slip = oracle_norm(c.t);
      slow_slips += slip > 0 && slip < s->scene.law.vmin;
      fast_slips += slip >= s->scene.law.vmin;
      deep_overlaps += c.gap < -0.05;
      idle_contacts += c.gap > 0.06;
    }
    for (size_t k = 0; k < s->scene.walls_count; k++)
      wall_hits +=
          oracle_wall(&s->scene, &s->bed, i, k).gap <= s->scene.law.lmax;
  }
}

static bool against_oracle(const struct sample *s, const char *what,
                           unsigned long seed) {
  const size_t n = s->bed.n;
  double *want = numbers(6 * n), *got = numbers(9 * n), *load = numbers(n);
  oracle_rates(&s->scene, &s->bed, want, want + 3 * n, load);
  if (n < 300)
    count_contacts(s);
  bool good = true;
  for (int all = 0; all < 2; all++) {
    struct dynamics *d = new_dynamics(s, all ? &all_pairs : &cells);
    double *v = got, *a = got + 3 * n, *alpha = got + 6 * n;
    const int status = rates(d, &s->bed, v, a, alpha);
    const bool same = !memcmp(v, s->bed.v, 3 * n * sizeof *v);
    const double force = worst_ratio(s, load, a, want, false);
    const double torque = worst_ratio(s, load, alpha, want + 3 * n, true);
    if (!CHECK(status == GSL_SUCCESS && same && force <= 1 && torque <= 1)) {
      fprintf(stderr,
              "  seed %lu, %s, %s: n=%zu %s e=%g phi=%g: status %d, "
              "%g and %g of the tolerance %g\n",
              seed, what, dynamics_kernel(d), n, model_names[s->scene.model],
              s->scene.law.restitution, s->scene.law.friction, status, force,
              torque, rounding(s));
      good = false;
    }
    const struct dynamics_counts counts = dynamics_counts(d);
    CHECK(counts.evaluations == 1 && counts.builds == (all ? 0 : 1));
    dynamics_free(d);
  }
  free(want);
  free(got);
  free(load);
  return good;
}

static void test_random_beds(gsl_rng *rng, unsigned long kernel) {
  static const double es[3] = {0, 0.4, 1};
  static const size_t sizes[4] = {1, 2, 23, 50};
  /* all combinations of four sizes; then some large beds, one of them with rows
     in another order than spheres */
  enum { CASES = 4 * 144, LARGE = 6 };
  for (unsigned long c = 0; c < CASES + LARGE; c++) {
    const unsigned long seed = 1000 * kernel + c;
    gsl_rng_set(rng, seed);
    struct recipe p = {.model = models[c % 3], .e = es[c / 3 % 3]};
    p.n = c < CASES ? sizes[c / 144] : c == CASES + kernel ? 1100 : 300;
    const unsigned long q = c < CASES ? c / 9 : gsl_rng_get(rng);
    p.phi = q % 2 ? 0.2 : 0;
    p.radii = q / 2 % 2 || p.n == 1100;
    p.masses = q / 4 % 2 || p.n == 1100;
    p.walls = q / 8 % 2 ? 2 : 0;
    /* from beds far denser than any settled one to loose ones */
    p.spacing = p.n == 2 ? uniform(rng, 0.1, 0.2) : uniform(rng, 0.12, 0.25);
    p.speed = uniform(rng, 0.1, 5);
    struct sample s = random_sample(rng, &p);
    against_oracle(&s, "random bed", seed);
    if (p.model == SCENE_ROTATION && p.phi > 0 && p.n > 1)
      for (int sides = 1; sides < 4; sides++) {
        set_sides(&s, sides % 2, sides / 2);
        against_oracle(&s, "lever and rolling", seed);
      }
    sample_free(&s);
  }
}

/* A cubic lattice whose planes are those of the cell grid: cells are 2 r +
   lmax + skin wide and the first skin is r/5. factor: spacing in cells. */
static void test_cell_borders(gsl_rng *rng) {
  static const double factors[] = {0.5, 1. / 3, 0.25 + 1e-16, 0.6};
  for (unsigned long c = 0; c < 12; c++) {
    struct recipe p = {models[c % 3], 0.4, 0.2, false, false, 216, c % 2, 1, 1};
    gsl_rng_set(rng, c);
    struct sample s = random_sample(rng, &p);
    const double spacing =
        factors[c / 3] * (2 * 0.1 + s.scene.law.lmax + 0.2 * 0.1);
    for (size_t i = 0; i < 216; i++) {
      const size_t at[3] = {i % 6, i / 6 % 6, i / 36};
      for (size_t k = 0; k < 3; k++)
        s.bed.x[3 * i + k] = -0.7 + spacing * (double)at[k];
    }
    against_oracle(&s, "cell borders", c);
    sample_free(&s);
  }
}

/* Spheres in a row and in a close packing that just touch, at rest and not,
   and a slip of exactly vmin. */
static void test_touching(gsl_rng *rng) {
  for (unsigned long c = 0; c < 12; c++) {
    struct recipe p = {models[c % 3], 0.4, 0.2,          false, false, 64,
                       c % 2,         1,   c < 6 ? 1 : 0};
    gsl_rng_set(rng, c);
    struct sample s = random_sample(rng, &p);
    for (size_t i = 0; i < 64; i++) {
      const double a = 0.2 * (double)(i % 4), b = 0.2 * (double)(i / 4 % 4),
                   f = 0.2 * (double)(i / 16);
      double *x = s.bed.x + 3 * i;
      x[0] = (b + f) / M_SQRT2;
      x[1] = (a + f) / M_SQRT2;
      x[2] = (a + b) / M_SQRT2;
    }
    against_oracle(&s, "touching", c);
    sample_free(&s);
  }
  struct recipe p = {SCENE_FRICTION, 0.4, 0.2, false, false, 2, 0, 1, 0};
  struct sample s = random_sample(rng, &p);
  memcpy(s.bed.x, (double[]){0, 0, 0, 0.2, 0, 0}, 6 * sizeof(double));
  for (int k = -1; k <= 1; k++) {
    s.bed.v[1] = s.scene.law.vmin * (1 + k * DBL_EPSILON);
    against_oracle(&s, "slip of vmin", 0);
  }
  /* radii that are the same but for a few bits are not: 1.5e-11 of the force */
  s.bed.r[1] = s.bed.r[0] * (1 + 1e-12);
  s.bed.x[3] = 0.05;
  against_oracle(&s, "almost the same radius", 0);
  sample_free(&s);
}

/* --- the same bits, whatever came before -----------------------------------*/

static void test_threads(gsl_rng *rng) {
  for (unsigned long c = 0; c < 15; c++) {
    gsl_rng_set(rng, c);
    struct recipe p = {
        models[c % 3], c / 3 % 2 ? 1 : 0.4, 0.2, c / 6, c / 6, 300, 25, 0.2, 1};
    p.n = c < 12 ? 300 : 1100;
    struct sample s = random_sample(rng, &p);
    for (int all = 0; all < 2; all++) {
      double *first = NULL;
      for (int threads = 1; threads <= 4; threads++) {
        struct dynamics *d =
            new_dynamics(&s, &(struct dynamics_options){.all_pairs = all,
                                                        .threads = threads});
        const size_t dim = dynamics_dimension(d);
        double *y = numbers(dim), *dydt = numbers(dim);
        dynamics_pack(d, &s.bed, y);
        CHECK(dynamics_rhs(0, y, dydt, d) == GSL_SUCCESS);
        if (first && !CHECK(!memcmp(first, dydt, dim * sizeof *dydt)))
          fprintf(stderr, "  seed %lu, %s, %d threads\n", c, dynamics_kernel(d),
                  threads);
        dynamics_free(d);
        free(y);
        if (!first) {
          first = dydt;
          continue;
        }
        free(dydt);
      }
      free(first);
    }
    sample_free(&s);
  }
}

/* A stage is the right-hand side and a sum of five terms, by as many roundings,
   whoever computes it; a state that is not finite is refused. */
static void test_stage(gsl_rng *rng) {
  for (unsigned long c = 0; c < 12; c++) {
    gsl_rng_set(rng, c);
    struct recipe p = {
        models[c % 3], c / 3 % 2 ? 1 : 0.4, 0.2, c / 6, c / 6, 300, 25, 0.2, 1};
    p.n = c % 2 ? 333 : 1100;
    struct sample s = random_sample(rng, &p);
    double *once = NULL;
    for (int threads = 1; threads <= 3; threads++) {
      struct dynamics *d =
          new_dynamics(&s, &(struct dynamics_options){.threads = threads});
      const size_t dim = dynamics_dimension(d);
      double *y = numbers(6 * dim), *f = y + dim, *start = f + dim,
             *rate = start + dim, *old = rate + dim, *out = old + dim;
      dynamics_pack(d, &s.bed, y);
      CHECK(dynamics_rhs(0, y, f, d) == GSL_SUCCESS);
      gsl_rng_set(rng, c);
      struct stage g = {start,
                        rate,
                        uniform(rng, -1, 1),
                        uniform(rng, -1, 1),
                        uniform(rng, -1, 1),
                        uniform(rng, -1, 1),
                        uniform(rng, -1, 1)};
      for (size_t i = 0; i < dim; i++) {
        start[i] = uniform(rng, -1, 1);
        rate[i] = uniform(rng, -1, 1);
        out[i] = old[i] = uniform(rng, -1, 1);
      }
      CHECK(dynamics_stage(0, y, &g, out, d) == GSL_SUCCESS);
      bool near = true;
      for (size_t i = 0; i < dim; i++) {
        const double term[5] = {g.of_start * start[i], g.of_rate * rate[i],
                                g.of_y * y[i], g.of_out * old[i],
                                g.of_f * f[i]};
        double sum = 0, size = 0;
        for (int k = 0; k < 5; k++) {
          sum += term[k];
          size += fabs(term[k]);
        }
        near = near && fabs(out[i] - sum) <= 10 * DBL_EPSILON * size;
      }
      if (!CHECK(near))
        fprintf(stderr, "  seed %lu, %d threads\n", c, threads);
      if (once)
        CHECK(!memcmp(once, out, dim * sizeof *out));
      else {
        once = numbers(dim);
        memcpy(once, out, dim * sizeof *out);
      }
      y[dim / 2] = GSL_NAN;
      CHECK(dynamics_stage(0, y, &g, out, d) == GSL_EBADFUNC);
      dynamics_free(d);
      free(y);
    }
    free(once);
    sample_free(&s);
  }
}

/* A random walk whose steps are often small against the skin of the list,
   sometimes larger, once in a while undone by a state that is not finite. */
static void test_history(gsl_rng *rng, enum scene_model model, size_t n,
                         int steps, bool potential) {
  const unsigned long seed = 10 + (unsigned long)model;
  gsl_rng_set(rng, seed);
  struct recipe p = {model, 0.4, 0.2, false, false, n, 3, 0.19, 1};
  struct sample s = random_sample(rng, &p);
  struct dynamics *old = new_dynamics(&s, &cells);
  const size_t dim = dynamics_dimension(old), stride = dynamics_stride(old);
  double *y = numbers(dim), *got = numbers(dim), *want = numbers(dim);
  dynamics_pack(old, &s.bed, y);
  size_t wrong = 0, wrong_potential = 0, evaluations = 0;
  for (int step = 0; step < steps; step++) {
    const double length = pow(10, uniform(rng, -5, -1.7));
    for (size_t u = 0; u < dim; u++)
      if (step % 50 == 49) /* far from where it was */
        y[u] += u % stride < 3 ? uniform(rng, -0.1, 0.1) : 0;
      else
        y[u] += (u % stride < 3 ? length : 0.01) * uniform(rng, -1, 1);
    if (step % 40 == 7) {
      const size_t u = gsl_rng_uniform_int(rng, dim);
      const double good = y[u];
      y[u] = GSL_NAN;
      CHECK(dynamics_rhs(0, y, got, old) == GSL_EBADFUNC);
      evaluations++;
      y[u] = good;
    }
    struct dynamics *fresh = new_dynamics(&s, &cells);
    CHECK(dynamics_rhs(0, y, got, old) == GSL_SUCCESS);
    CHECK(dynamics_rhs(0, y, want, fresh) == GSL_SUCCESS);
    evaluations++;
    if (memcmp(got, want, dim * sizeof *got) && wrong++ == 0)
      fprintf(stderr, "  seed %lu, step %d, %s: differs from a fresh one\n",
              seed, step, dynamics_kernel(old));
    if (potential && dynamics_potential(old, y) != dynamics_potential(fresh, y))
      wrong_potential++;
    dynamics_free(fresh);
  }
  CHECK(wrong == 0);
  CHECK(wrong_potential == 0);
  const struct dynamics_counts counts = dynamics_counts(old);
  CHECK(counts.evaluations == evaluations);
  /* both were met */
  CHECK(counts.builds > 1 && counts.builds < (size_t)steps);
  dynamics_free(old);
  free(y);
  free(got);
  free(want);
  sample_free(&s);
}

/* A pair at lmax to the last bit is a contact, in its slopes too: one beyond is
   none. Its force grows by kappa F for each metre that it is closer. */
static void test_last_contact(void) {
  struct sample s = {.scene = scene_default()};
  s.scene.model = SCENE_BASIC;
  s.scene.law.restitution = 1;
  s.scene.law.kappa = 10;
  CHECK(bed_alloc(&s.bed, 2) == GSL_SUCCESS);
  for (size_t i = 0; i < 2; i++) {
    s.bed.r[i] = 0.125;
    s.bed.m[i] = 1;
  }
  s.bed.x[3] = 0.375;
  for (int beyond = 0; beyond < 2; beyond++) {
    s.scene.law.lmax = 0.125 * (1 - beyond * DBL_EPSILON);
    struct dynamics *d = new_dynamics(&s, &cells);
    double y[12], rates_at[12], dfdt[12], slope[144];
    dynamics_pack(d, &s.bed, y);
    CHECK(dynamics_rhs(0, y, rates_at, d) == GSL_SUCCESS);
    CHECK(dynamics_jacobian(0, y, slope, dfdt, d) == GSL_SUCCESS);
    const double force = beyond ? 0 : s.scene.law.f0 * exp(-10 * 0.125);
    /* of the first one, x' ' by x, and that of the other's x */
    CHECK_CLOSE(slope[3 * 12 + 0], -10 * force, 1e-13 * force);
    CHECK_CLOSE(slope[3 * 12 + 6], 10 * force, 1e-13 * force);
    CHECK_CLOSE(rates_at[3] - s.scene.gravity[0], -force, 1e-14 * force);
    dynamics_free(d);
  }
  sample_free(&s);
}

/* A row of spheres that touch, and the first pair of the list reaches further
   than all others: from its first row to the last. The forces on all but those
   at the ends cancel, and no row's sum is taken for another's. */
static void test_span(void) {
  enum { N = 300 };
  struct sample s = {.scene = scene_default()};
  s.scene.model = SCENE_BASIC;
  s.scene.law.restitution = 1;
  memset(s.scene.gravity, 0, sizeof s.scene.gravity);
  size_t order[N];
  CHECK(bed_alloc(&s.bed, N) == GSL_SUCCESS);
  for (size_t i = 0; i < N; i++) {
    s.bed.r[i] = 0.125;
    s.bed.m[i] = 1;
    s.bed.x[3 * i] = i == N - 1 ? 0.25 : 0.25 * (double)i;
    s.bed.x[3 * i + 1] = i % (N - 1) ? 0 : 2;
    order[i] = i;
  }
  struct dynamics *d = new_dynamics(
      &s, &(struct dynamics_options){.threads = 1, .order = order});
  double v[3 * N], a[3 * N], alpha[3 * N];
  CHECK(rates(d, &s.bed, v, a, alpha) == GSL_SUCCESS);
  const double force = s.scene.law.f0;
  for (size_t i = 0; i < N; i++) {
    const bool left = i < 2, right = i >= N - 2;
    CHECK_CLOSE(a[3 * i],
                left    ? -force
                : right ? force
                        : 0,
                4 * DBL_EPSILON * force);
  }
  dynamics_free(d);
  sample_free(&s);
}

/* Spheres that are all apart, without walls: as many rows for each thread. */
static void test_shares(void) {
  enum { EACH = 100, THREADS = 4, N = EACH * THREADS };
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, N) == GSL_SUCCESS);
  double y[ROW_SPIN * N];
  for (size_t i = 0; i < N; i++) {
    s.bed.r[i] = 0.1;
    s.bed.m[i] = 1;
    s.bed.x[3 * i] = (double)i;
  }
  struct dynamics *d =
      new_dynamics(&s, &(struct dynamics_options){.threads = 1});
  struct contact_list *l = NULL;
  dynamics_pack(d, &s.bed, y);
  CHECK(contact_list_alloc(&l, &s.scene, &s.bed, THREADS, NULL) == GSL_SUCCESS);
  CHECK(contact_list_update(l, y) == GSL_SUCCESS && contact_list_size(l) == 0);
  for (size_t p = 0; p < THREADS; p++)
    CHECK(l->part[p].from == EACH * p && l->part[p].to == EACH * (p + 1));
  contact_list_free(l);
  dynamics_free(d);
  sample_free(&s);
}

/* A skin as wide as lets rebuilding and idle pairs cost the same, whatever the
   speed. All move by d in each evaluation: a skin s lasts for s/(2 d) of them,
   of which idle pairs take 3 s/(2 r + lmax + s), and a list costs four. */
static void test_skin(gsl_rng *rng) {
  enum { EVALUATIONS = 3000 };
  const double r = 0.1, cost = 4;
  gsl_rng_set(rng, 1);
  struct recipe p = {SCENE_BASIC, 1, 0, false, false, 100, 0, 0.19, 1};
  struct sample s = random_sample(rng, &p);
  const double ways[] = {3e-3, 1e-3, 1e-4};
  for (size_t k = 0; k < 3; k++) {
    const double d = ways[k], reach = 2 * r + s.scene.law.lmax;
    struct dynamics *list = new_dynamics(&s, &cells);
    const size_t dim = dynamics_dimension(list);
    double *y = numbers(dim), *dydt = numbers(dim);
    dynamics_pack(list, &s.bed, y);
    for (int step = 0; step < EVALUATIONS; step++) {
      CHECK(dynamics_rhs(0, y, dydt, list) == GSL_SUCCESS);
      for (size_t i = 0; i < dim; i += dynamics_stride(list))
        y[i] += d;
    }
    /* 3 s^2 = 2 d cost (reach + s) */
    const double b = 2 * d * cost / 3,
                 skin = b / 2 + sqrt(b * b / 4 + b * reach);
    const double want = EVALUATIONS * 2 * d / skin;
    CHECK_CLOSE((double)dynamics_counts(list).builds, want, 0.15 * want);
    dynamics_free(list);
    free(y);
    free(dydt);
  }
  sample_free(&s);
}

/* --- gradient, balances ----------------------------------------------------*/

/* e = 1, phi = 0: forces are minus the gradient of the potential. Central
   differences with step h: (kappa h)^2/6 of the load from truncation, eps V/h
   from rounding, with as many rounding errors in V as it has terms. lmax is so
   large that its jump of F is below rounding. */
static void test_gradient(gsl_rng *rng) {
  for (unsigned long seed = 0; seed < 6; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {
        models[seed % 3], 1, 0, seed % 2, seed % 2, 20, 3, 0.19, 1};
    struct sample s = random_sample(rng, &p);
    s.scene.law.lmax = 0.5;
    const size_t n = p.n;
    double *a = numbers(3 * n), *alpha = numbers(3 * n), *load = numbers(n);
    double *want = numbers(6 * n);
    oracle_rates(&s.scene, &s.bed, want, want + 3 * n, load);
    rates_once(&s, a, alpha);
    struct dynamics *d = new_dynamics(&s, &cells);
    const size_t stride = dynamics_stride(d);
    double *y = numbers(dynamics_dimension(d));
    dynamics_pack(d, &s.bed, y);
    const double energy = dynamics_potential(d, y);
    double terms = 0;
    for (size_t i = 0; i < n; i++)
      terms += load[i] / s.scene.law.kappa + s.bed.m[i] *
                                                 vec3_norm(s.scene.gravity) *
                                                 vec3_norm(s.bed.x + 3 * i);
    CHECK_CLOSE(energy, oracle_potential(&s.scene, &s.bed),
                rounding(&s) * terms);
    const double h = 1e-6, kh = s.scene.law.kappa * h;
    double worst = 0;
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < 3; k++) {
        double *x = &y[i * stride + k];
        const double middle = *x;
        *x = middle + h;
        const double above = dynamics_potential(d, y), high = *x;
        *x = middle - h;
        const double below = dynamics_potential(d, y);
        const double force = (below - above) / (high - *x);
        *x = middle;
        const double tol = load[i] * kh * kh / 6 + rounding(&s) * terms / h;
        const double ratio = fabs(force - s.bed.m[i] * a[3 * i + k]) / tol;
        worst = ratio <= worst ? worst : isnan(ratio) ? GSL_POSINF : ratio;
      }
    if (!CHECK(worst <= 1))
      fprintf(stderr, "  seed %lu: %g of the tolerance\n", seed, worst);
    dynamics_free(d);
    free(y);
    free(a);
    free(alpha);
    free(load);
    free(want);
    sample_free(&s);
  }
}

/* Kinetic energy with that of spin, and the fastest surface. */
static void test_kinetic(gsl_rng *rng) {
  for (unsigned long seed = 0; seed < 6; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {models[seed % 3], 0.4, 0.2, true, true, 30, 0, 0.2, 3};
    struct sample s = random_sample(rng, &p);
    struct dynamics *d = new_dynamics(&s, &cells);
    double *y = numbers(dynamics_dimension(d)), sum = 0, fastest = 0;
    dynamics_pack(d, &s.bed, y);
    for (size_t i = 0; i < p.n; i++) {
      const double v = oracle_norm(s.bed.v + 3 * i);
      const double w = p.model == SCENE_ROTATION
                           ? s.bed.r[i] * oracle_norm(s.bed.w + 3 * i)
                           : 0;
      sum += s.bed.m[i] * (v * v / 2 + w * w / 5);
      fastest = GSL_MAX(fastest, GSL_MAX(v, w));
    }
    /* a sum of positive terms, each with a few roundings */
    CHECK_REL(dynamics_kinetic(d, y), sum, (double)p.n * DBL_EPSILON);
    CHECK_REL(dynamics_fastest(d, y), fastest, 8 * DBL_EPSILON);
    dynamics_free(d);
    free(y);
    sample_free(&s);
  }
}

/* No walls: the momentum changes by gravity alone. So does the angular
   momentum of frictionless spheres. With friction the paper's torques have
   arms r_i and r_j, less than the distance d = r_i + r_j + l by the gap: a
   contact changes the angular momentum by l n x f, nothing where surfaces
   touch, l = 0. Angular momenta are taken about the origin; their rounding is
   that of forces with arms x and r. */
static void test_momentum(gsl_rng *rng) {
  for (unsigned long seed = 0; seed < 24; seed++) {
    gsl_rng_set(rng, seed);
    const bool touching = seed % 2;
    struct recipe p = {models[seed / 2 % 3],
                       seed % 5 ? 0.4 : 1,
                       0.2,
                       true,
                       true,
                       12,
                       0,
                       0.2,
                       2};
    struct sample s = random_sample(rng, &p);
    const bool lever = seed / 6 % 2;
    set_sides(&s, lever, seed / 12);
    const size_t n = p.n;
    if (touching) /* a chain */
      for (size_t i = 1; i < n; i++) {
        double u[3];
        direction(rng, u);
        u[2] = fabs(u[2]) + 2;
        const double d = (s.bed.r[i] + s.bed.r[i - 1]) / vec3_norm(u);
        for (size_t k = 0; k < 3; k++)
          s.bed.x[3 * i + k] = s.bed.x[3 * (i - 1) + k] + d * u[k];
      }
    if (touching)
      s.scene.law.lmax = 0.01; /* neighbours only */
    double a[36], alpha[36], load[12], oracle[72];
    oracle_rates(&s.scene, &s.bed, oracle, oracle + 36, load);
    rates_once(&s, a, alpha);
    double momentum[3] = {0}, spin[3] = {0}, loads = 0, arms = 0;
    for (size_t i = 0; i < n; i++) {
      const double *x = s.bed.x + 3 * i, m = s.bed.m[i], r = s.bed.r[i];
      double force[3], xxf[3];
      for (size_t k = 0; k < 3; k++)
        force[k] = m * (a[3 * i + k] - s.scene.gravity[k]);
      vec3_axpy(1, force, momentum);
      vec3_cross(x, force, xxf);
      vec3_axpy(1, xxf, spin);
      vec3_axpy(0.4 * m * r * r, alpha + 3 * i, spin);
      loads += load[i] + m * vec3_norm(s.scene.gravity);
      arms += (load[i] + m * vec3_norm(s.scene.gravity)) * (vec3_norm(x) + r);
    }
    double expected[3] = {0};
    /* the friction model holds the spins, by torques that nothing returns */
    const bool held = p.model == SCENE_FRICTION;
    if ((!touching && !lever) || held)
      for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) {
          const struct oracle_contact c = oracle_pair(&s.scene, &s.bed, i, j);
          double nxf[3];
          vec3_cross(c.n, c.fr, nxf);
          const double arm = c.gap + (held ? s.bed.r[i] + s.bed.r[j] : 0);
          vec3_axpy(arm, nxf, expected);
        }
    bool good = true;
    for (int k = 0; k < 3; k++) {
      good = CHECK_CLOSE(momentum[k], 0, rounding(&s) * loads) && good;
      good = CHECK_CLOSE(spin[k], expected[k], rounding(&s) * arms) && good;
    }
    if (!good)
      fprintf(stderr, "  seed %lu\n", seed);
    sample_free(&s);
  }
}

/* What friction and restitution do to the energy. Friction takes phi F Sigma
   |t| and never gives. For e < 1 a contact does rho F n.v of work, rho between
   e^2 and 1 and rho(0) = (1 + e^2)/2 at rest: kinetic energy, gravity's and
   rho(0) F/kappa together never grow, since rho - rho(0) has the sign of the
   approach. (With all of F/kappa they may, by the share 1 - rho of a slow
   approach.) */
static void test_power(gsl_rng *rng) {
  for (unsigned long seed = 0; seed < 60; seed++) {
    gsl_rng_set(rng, seed);
    const double es[3] = {0, 0.4, 1};
    struct recipe p = {
        models[seed / 3 % 3], es[seed % 3], 0.2, true, true, 30, 3, 0.19, 3};
    struct sample s = random_sample(rng, &p);
    set_sides(&s, seed / 9 % 2, seed / 18 % 2);
    double a[90], alpha[90], load[30], elastic[90], none[90], oracle[180];
    oracle_rates(&s.scene, &s.bed, oracle, oracle + 90, load);
    rates_once(&s, a, alpha);
    struct sample plain = s; /* forces of the contacts' potential */
    plain.scene.model = SCENE_BASIC;
    plain.scene.law.restitution = 1;
    rates_once(&plain, elastic, none);
    const double rest = (1 + p.e * p.e) / 2;
    double power = 0, scale = 0;
    for (size_t i = 0; i < p.n; i++) {
      const double m = s.bed.m[i], r = s.bed.r[i], *g = s.scene.gravity;
      const double *v = s.bed.v + 3 * i, *w = s.bed.w + 3 * i;
      for (size_t k = 0; k < 3; k++)
        power += m * v[k] * (a[3 * i + k] - g[k]) -
                 rest * m * v[k] * (elastic[3 * i + k] - g[k]) +
                 0.4 * m * r * r * w[k] * alpha[3 * i + k];
      scale += (load[i] + m * vec3_norm(g)) * (vec3_norm(v) + r * vec3_norm(w));
    }
    const bool lossless = p.e == 1 && p.model == SCENE_BASIC;
    const double tol = rounding(&s) * scale;
    if (!CHECK(power <= tol && power >= -2 * scale &&
               (lossless ? power >= -tol : power < -tol)))
      fprintf(stderr, "  seed %lu: power %g W, rounding %g W\n", seed, power,
              tol);
    sample_free(&s);
  }
}

/* --- symmetries ------------------------------------------------------------*/

struct motion {
  double turn[3][3]; /* orthogonal */
  double shift[3], boost[3];
};

static void turn(const struct motion *q, double scale, const double x[3],
                 double y[3]) {
  double z[3];
  for (int i = 0; i < 3; i++)
    z[i] = scale * vec3_dot(q->turn[i], x);
  memcpy(y, z, sizeof z);
}

static double handedness(const struct motion *q) {
  double c[3];
  vec3_cross(q->turn[0], q->turn[1], c);
  return vec3_dot(c, q->turn[2]) > 0 ? 1 : -1;
}

/* Orthogonal matrices, all alike: Gram-Schmidt of random directions. */
static void random_turn(gsl_rng *rng, struct motion *q) {
  for (int i = 0; i < 3; i++) {
    direction(rng, q->turn[i]);
    for (int round = 0; round < 2; round++)
      for (int j = 0; j < i; j++)
        vec3_axpy(-vec3_dot(q->turn[i], q->turn[j]), q->turn[j], q->turn[i]);
    const double length = vec3_norm(q->turn[i]);
    for (int k = 0; k < 3; k++)
      q->turn[i][k] /= length;
  }
}

static struct sample moved_sample(const struct sample *s,
                                  const struct motion *q) {
  struct sample m = {.scene = s->scene};
  m.scene.walls_count = 0;
  m.scene.walls = NULL;
  turn(q, 1, s->scene.gravity, m.scene.gravity);
  for (size_t k = 0; k < s->scene.walls_count; k++) {
    double point[3], normal[3];
    turn(q, 1, s->scene.walls[k].point, point);
    turn(q, 1, s->scene.walls[k].normal, normal);
    vec3_axpy(1, q->shift, point);
    CHECK(scene_add_wall(&m.scene, point, normal) == GSL_SUCCESS);
  }
  CHECK(bed_alloc(&m.bed, s->bed.n) == GSL_SUCCESS);
  for (size_t i = 0; i < s->bed.n; i++) {
    m.bed.r[i] = s->bed.r[i];
    m.bed.m[i] = s->bed.m[i];
    turn(q, 1, s->bed.x + 3 * i, m.bed.x + 3 * i);
    turn(q, 1, s->bed.v + 3 * i, m.bed.v + 3 * i);
    /* spins are axial */
    turn(q, handedness(q), s->bed.w + 3 * i, m.bed.w + 3 * i);
    vec3_axpy(1, q->shift, m.bed.x + 3 * i);
    vec3_axpy(1, q->boost, m.bed.v + 3 * i);
  }
  return m;
}

static void check_motion(const struct sample *s, const struct motion *q,
                         const char *what, unsigned long seed) {
  const size_t n = s->bed.n;
  struct sample m = moved_sample(s, q);
  double *want = numbers(6 * n), *got = numbers(6 * n), *load = numbers(n);
  double *unused = numbers(6 * n);
  oracle_rates(&m.scene, &m.bed, unused, unused + 3 * n, load);
  rates_once(s, want, want + 3 * n);
  rates_once(&m, got, got + 3 * n);
  for (size_t i = 0; i < n; i++) {
    turn(q, 1, want + 3 * i, want + 3 * i);
    turn(q, handedness(q), want + 3 * n + 3 * i, want + 3 * n + 3 * i);
  }
  const double force = worst_ratio(&m, load, got, want, false);
  const double torque = worst_ratio(&m, load, got + 3 * n, want + 3 * n, true);
  if (!CHECK(force <= 1 && torque <= 1))
    fprintf(stderr, "  seed %lu, %s, %s: %g and %g of the tolerance %g\n", seed,
            what, model_names[s->scene.model], force, torque, rounding(&m));
  sample_free(&m);
  free(want);
  free(got);
  free(load);
  free(unused);
}

static void test_symmetries(gsl_rng *rng) {
  static const struct motion same = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, {0, 0, 0}};
  for (unsigned long seed = 0; seed < 24; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {
        models[seed % 3], 0.4, 0.2, seed / 3 % 2, seed / 6 % 2, 40, 0, 0.19, 2};
    struct sample s = random_sample(rng, &p);
    struct motion q = same;
    for (int k = 0; k < 3; k++)
      q.boost[k] = uniform(rng, -5, 5);
    check_motion(&s, &q, "another velocity", seed);
    for (int k = 0; k < 3; k++)
      add_wall_beside(rng, &s, uniform(rng, -0.05, 0.05));
    q = same;
    for (int k = 0; k < 3; k++)
      q.shift[k] = uniform(rng, -5, 5);
    check_motion(&s, &q, "another place", seed);
    for (int k = 0; k < 3; k++) {
      q = same;
      q.turn[k][k] = -1;
      check_motion(&s, &q, "mirror", seed);
    }
    random_turn(rng, &q);
    for (int k = 0; k < 3; k++)
      q.shift[k] = uniform(rng, -1, 1);
    check_motion(&s, &q, "rotation and reflection", seed);
    if (handedness(&q) < 0)
      for (int k = 0; k < 3; k++)
        q.turn[0][k] *= -1;
    check_motion(&s, &q, "rotation", seed);
    sample_free(&s);
  }
}

/* Other numbers for the same spheres: the sums are taken in another order. */
static void test_relabel(gsl_rng *rng) {
  enum { N = 60 };
  for (unsigned long seed = 0; seed < 12; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {models[seed % 3], 0.4, 0.2, true, true, N, 3, 0.19, 2};
    struct sample s = random_sample(rng, &p), m = {.scene = s.scene};
    size_t order[N];
    for (size_t i = 0; i < N; i++)
      order[i] = i;
    gsl_ran_shuffle(rng, order, N, sizeof *order);
    CHECK(bed_alloc(&m.bed, N) == GSL_SUCCESS);
    for (size_t i = 0; i < N; i++) {
      m.bed.r[i] = s.bed.r[order[i]];
      m.bed.m[i] = s.bed.m[order[i]];
      memcpy(m.bed.x + 3 * i, s.bed.x + 3 * order[i], 3 * sizeof(double));
      memcpy(m.bed.v + 3 * i, s.bed.v + 3 * order[i], 3 * sizeof(double));
      memcpy(m.bed.w + 3 * i, s.bed.w + 3 * order[i], 3 * sizeof(double));
    }
    double a[3 * N], alpha[3 * N], b[3 * N], beta[3 * N], load[N];
    double want[3 * N], turned[3 * N], unused[6 * N];
    rates_once(&s, a, alpha);
    rates_once(&m, b, beta);
    oracle_rates(&m.scene, &m.bed, unused, unused + 3 * N, load);
    for (size_t i = 0; i < N; i++) {
      memcpy(want + 3 * i, a + 3 * order[i], 3 * sizeof *a);
      memcpy(turned + 3 * i, alpha + 3 * order[i], 3 * sizeof *a);
    }
    if (!CHECK(worst_ratio(&m, load, b, want, false) <= 1 &&
               worst_ratio(&m, load, beta, turned, true) <= 1))
      fprintf(stderr, "  seed %lu\n", seed);
    bed_free(&m.bed);
    sample_free(&s);
  }
}

/* --- Jacobian --------------------------------------------------------------*/

/* Far from what central differences cannot cross: the cut at lmax, a slip of 0
   and of vmin, where the second derivative of Sigma jumps. */
static bool is_smooth(const struct sample *s) {
  for (size_t i = 0; i < s->bed.n; i++)
    for (size_t j = 0; j < s->bed.n + s->scene.walls_count; j++) {
      if (j == i)
        continue;
      const struct oracle_contact c =
          j < s->bed.n ? oracle_pair(&s->scene, &s->bed, i, j)
                       : oracle_wall(&s->scene, &s->bed, i, j - s->bed.n);
      const double slip = oracle_norm(c.t) / s->scene.law.vmin;
      const double roll = c.roll / s->scene.law.vmin;
      if (c.gap < s->scene.law.lmax && scene_has_rolling(&s->scene) &&
          (roll < 0.2 || fabs(roll - 1) < 0.05))
        return false;
      if (fabs(c.gap - s->scene.law.lmax) < 1e-3 || c.gap < -0.1)
        return false;
      if (c.gap < s->scene.law.lmax && scene_has_friction(&s->scene) &&
          (slip < 0.2 || fabs(slip - 1) < 0.05))
        return false;
    }
  return true;
}

/* Central differences with step h have an error of f''' h^2/6 from truncation
   and of the rounding in f over h. A contact's force varies with each unknown
   at a rate q, kappa or the slopes of rho and of the slip direction by vmin,
   times what the unknown changes of them; f''' is taken as F (2 q)^3. */
static void check_jacobian(struct sample *s, const struct dynamics_options *o,
                           unsigned long seed) {
  struct dynamics *d = new_dynamics(s, o);
  const size_t n = s->bed.n, stride = dynamics_stride(d), dim = stride * n;
  double *y = numbers(dim), *dfdy = numbers(dim * dim), *dfdt = numbers(dim);
  double *above = numbers(dim), *below = numbers(dim);
  double *oracle = numbers(6 * n), *load = numbers(n);
  oracle_rates(&s->scene, &s->bed, oracle, oracle + 3 * n, load);
  dynamics_pack(d, &s->bed, y);
  for (size_t u = 0; u < dim * dim; u++)
    dfdy[u] = GSL_NAN; /* every entry must be written */
  for (size_t u = 0; u < dim; u++)
    dfdt[u] = GSL_NAN;
  CHECK(dynamics_jacobian(0, y, dfdy, dfdt, d) == GSL_SUCCESS);
  const struct contact_law *law = &s->scene.law;
  const double noise = rounding(s);
  double fastest = 0, worst = 0;
  for (size_t i = 0; i < n; i++)
    fastest =
        GSL_MAX(fastest, 2 * vec3_norm(s->bed.v + 3 * i) +
                             2 * s->bed.r[i] * vec3_norm(s->bed.w + 3 * i));
  const double steep =
      2 * law->psi + (scene_has_friction(&s->scene) ? 3 / law->vmin : 0);
  size_t at_row = 0, at_column = 0;
  for (size_t u = 0; u < dim; u++) {
    const size_t j = u / stride, kind = u % stride / 3;
    /* a position also turns the normal, by 1/d a metre, d >= r */
    const double q = kind == 0
                         ? law->kappa + (1 + steep * fastest) / s->bed.r[j]
                     : kind == 1 ? steep
                                 : steep * s->bed.r[j];
    const double h = cbrt(noise) / (2 * q);
    const double middle = y[u];
    y[u] = middle + h;
    const double high = y[u];
    CHECK(dynamics_rhs(0, y, above, d) == GSL_SUCCESS);
    y[u] = middle - h;
    CHECK(dynamics_rhs(0, y, below, d) == GSL_SUCCESS);
    const double width = high - y[u];
    y[u] = middle;
    for (size_t v = 0; v < dim; v++) {
      const size_t i = v / stride, row = v % stride / 3;
      const double want = (above[v] - below[v]) / width;
      /* velocities are copied, to the last bit: only the width is rounded */
      double tol = 2 * DBL_EPSILON * fabs(middle) / width;
      if (row > 0) {
        double scale = load[i] / s->bed.m[i];
        scale = row == 2 ? 2.5 * scale / s->bed.r[i]
                         : scale + vec3_norm(s->scene.gravity);
        tol = scale * (8 * q * q * q * h * h / 6 + noise / h);
      }
      const double error = fabs(dfdy[v * dim + u] - want);
      const double ratio = error == 0 ? 0 : error / tol;
      if (!(ratio <= worst)) {
        worst = isnan(ratio) ? GSL_POSINF : ratio;
        at_row = v;
        at_column = u;
      }
    }
  }
  if (!CHECK(worst <= 1))
    fprintf(stderr,
            "  seed %lu, %s e=%g: df%zu/dy%zu = %g is off by %g of the "
            "tolerance\n",
            seed, model_names[s->scene.model], law->restitution, at_row,
            at_column, dfdy[at_row * dim + at_column], worst);
  bool still = true;
  for (size_t u = 0; u < dim; u++)
    still = still && dfdt[u] == 0;
  CHECK(still);
  dynamics_free(d);
  free(y);
  free(dfdy);
  free(dfdt);
  free(above);
  free(below);
  free(oracle);
  free(load);
}

static void test_jacobian(gsl_rng *rng) {
  static const double es[3] = {0, 0.4, 1};
  for (unsigned long seed = 0; seed < 72; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {models[seed % 3],
                       es[seed / 3 % 3],
                       seed / 9 % 4 ? 0.2 : 0,
                       seed / 9 % 2,
                       seed / 18 % 2,
                       5,
                       2,
                       0.19,
                       seed < 36 ? 0.05 : 1};
    struct sample s;
    int trials = 0;
    for (s = random_sample(rng, &p);; trials++) {
      set_sides(&s, seed / 12 % 2, seed / 6 % 2);
      if (is_smooth(&s) || trials == 10000)
        break;
      sample_free(&s);
      s = random_sample(rng, &p);
    }
    CHECK(is_smooth(&s));
    check_jacobian(&s, seed % 2 ? &all_pairs : &cells, seed);
    sample_free(&s);
  }
}

/* A bed at rest: the slip is 0 and so is the derivative of Sigma(|t|) t/|t|,
   3 |t| t/vmin^2; nothing may be divided by |t|. */
static void test_jacobian_at_rest(void) {
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 2) == GSL_SUCCESS);
  s.bed.r[0] = s.bed.r[1] = 0.1;
  memcpy(s.bed.x, (double[]){2, 2, 0.1, 2, 2, 0.3}, 6 * sizeof(double));
  CHECK(scene_add_box(&s.scene, 5, 5) == GSL_SUCCESS);
  struct dynamics *d = new_dynamics(&s, &cells);
  double y[18], dfdy[18 * 18], dfdt[18];
  dynamics_pack(d, &s.bed, y);
  CHECK(dynamics_jacobian(0, y, dfdy, dfdt, d) == GSL_SUCCESS);
  const double f = s.scene.law.f0, rho = (1 + 0.4 * 0.4) / 2;
  /* both gaps are 0: stiffness kappa F rho and damping psi (1 - e^2) F/2, one
     for each contact, in z; none that is tangential */
  CHECK_REL(dfdy[5 * 18 + 2], -2 * 150 * f * rho, 32 * 150 * DBL_EPSILON);
  CHECK_REL(dfdy[5 * 18 + 5], -f * 10 * (1 - 0.4 * 0.4),
            32 * 150 * DBL_EPSILON);
  for (size_t u = 3; u < 18; u++) {
    const bool speed = u % 9 >= 3;
    if (speed && u % 9 != 5)
      for (size_t v = 3; v < 9; v++)
        CHECK(dfdy[v * 18 + u] == 0);
  }
  dynamics_free(d);
  sample_free(&s);
}

/* --- bad states, limits, bookkeeping ---------------------------------------*/

/* Infinite or not a number anywhere: GSL_EBADFUNC. Finite but far: what is
   written is finite, or GSL_EBADFUNC. After it all a good state is evaluated
   as ever. */
static void test_bad_states(gsl_rng *rng) {
  static const double bad[] = {NAN,   INFINITY, -INFINITY, 1e12,    -1e12,
                               1e160, -1e160,   1.7e308,   -1.7e308};
  enum { BAD = sizeof bad / sizeof *bad };
  for (unsigned long c = 0; c < 12; c++) {
    gsl_rng_set(rng, c);
    const size_t walls = c / 3 % 2 ? 2 : 0;
    struct recipe p = {models[c % 3], 0.4, 0.2, true, true, 3, walls, 0.18, 1};
    struct sample s = random_sample(rng, &p);
    struct dynamics *d = new_dynamics(&s, c < 6 ? &cells : &all_pairs);
    const size_t dim = dynamics_dimension(d);
    double *y = numbers(dim), *got = numbers(dim), *want = numbers(dim);
    double *dfdy = numbers(dim * dim), *dfdt = numbers(dim);
    dynamics_pack(d, &s.bed, y);
    CHECK(dynamics_rhs(0, y, want, d) == GSL_SUCCESS);
    for (size_t u = 0; u < dim; u++)
      for (size_t k = 0; k < BAD; k++) {
        const double good = y[u];
        y[u] = bad[k];
        const int status = dynamics_rhs(0, y, got, d);
        bool finite = true;
        for (size_t v = 0; v < dim; v++)
          finite = finite && isfinite(got[v]);
        const bool ok = status == GSL_EBADFUNC ||
                        (status == GSL_SUCCESS && finite && isfinite(bad[k]));
        if (!CHECK(ok))
          fprintf(stderr, "  case %lu: y[%zu] = %g: status %d\n", c, u, bad[k],
                  status);
        if (!isfinite(bad[k]) &&
            !CHECK(dynamics_jacobian(0, y, dfdy, dfdt, d) == GSL_EBADFUNC))
          fprintf(stderr, "  case %lu: Jacobian at y[%zu] = %g\n", c, u,
                  bad[k]);
        if (!isfinite(bad[k]) && u % dynamics_stride(d) < 3)
          CHECK(!isfinite(dynamics_potential(d, y)));
        y[u] = good;
      }
    CHECK(dynamics_rhs(0, y, got, d) == GSL_SUCCESS);
    CHECK(!memcmp(got, want, dim * sizeof *got));
    dynamics_free(d);
    free(y);
    free(got);
    free(want);
    free(dfdy);
    free(dfdt);
    sample_free(&s);
  }
}

/* One number of a bed at rest in a box is set; what the right-hand side and
   the Jacobian say. */
static void check_state(size_t at, double value, size_t at2, double value2,
                        int expected) {
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 2) == GSL_SUCCESS);
  CHECK(scene_add_box(&s.scene, 1, 1) == GSL_SUCCESS);
  s.bed.r[0] = s.bed.r[1] = 0.1;
  memcpy(s.bed.x, (double[]){0.3, 0.3, 0.1, 0.7, 0.7, 0.1}, 6 * sizeof(double));
  s.bed.x[at] = value;
  s.bed.x[at2] = value2;
  for (int all = 0; all < 2; all++) {
    struct dynamics *d = new_dynamics(&s, all ? &all_pairs : &cells);
    double y[18], dydt[18], dfdy[18 * 18], dfdt[18];
    dynamics_pack(d, &s.bed, y);
    CHECK(dynamics_rhs(0, y, dydt, d) == expected);
    CHECK(dynamics_jacobian(0, y, dfdy, dfdt, d) == expected);
    dynamics_free(d);
  }
  sample_free(&s);
}

static void test_far_states(void) {
  check_state(2, 0.1, 2, 0.1, GSL_SUCCESS);
  check_state(2, -6, 2, -6, GSL_EBADFUNC);   /* behind a wall: exp(900) */
  check_state(0, 1e9, 0, 1e9, GSL_EBADFUNC); /* the same */
  check_state(2, 1e9, 2, 1e9, GSL_SUCCESS);  /* there is no lid */
  check_state(2, 1e150, 5, 1e120, GSL_SUCCESS);
  /* their distance is more than a double holds */
  check_state(2, 1.7e308, 5, -1.7e308, GSL_EBADFUNC);

  /* a sphere without contacts that is nowhere, or whose spin nothing but
     itself has, before and after a list was built without it */
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 2) == GSL_SUCCESS);
  s.bed.r[0] = s.bed.r[1] = 0.1;
  s.bed.x[1] = 3;
  for (int c = 0; c < 8; c++) {
    struct dynamics *d = new_dynamics(&s, c % 2 ? &all_pairs : &cells);
    double y[18], dydt[18];
    dynamics_pack(d, &s.bed, y);
    if (c / 2 % 2)
      CHECK(dynamics_rhs(0, y, dydt, d) == GSL_SUCCESS);
    y[c < 4 ? 0 : 6] = NAN;
    CHECK(dynamics_rhs(0, y, dydt, d) == GSL_EBADFUNC);
    CHECK(dynamics_rhs(0, y, dydt, d) == GSL_EBADFUNC);
    dynamics_free(d);
  }
  sample_free(&s);

  /* two centres in one place have no normal */
  s = (struct sample){.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 2) == GSL_SUCCESS);
  s.bed.r[0] = s.bed.r[1] = 0.1;
  for (int all = 0; all < 2; all++) {
    struct dynamics *d = new_dynamics(&s, all ? &all_pairs : &cells);
    double y[18], dydt[18];
    dynamics_pack(d, &s.bed, y);
    CHECK(dynamics_rhs(0, y, dydt, d) == GSL_EBADFUNC);
    dynamics_free(d);
  }
  sample_free(&s);
}

/* One sphere: travel = v h + a h^2/2 where both point the same way, in closed
   form; in general no sphere goes further, and many have the least limit of
   each. */
static void test_step_limit(gsl_rng *rng) {
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 1) == GSL_SUCCESS);
  s.bed.r[0] = 0.1;
  struct dynamics *d = new_dynamics(&s, &cells);
  for (unsigned long seed = 0; seed < 30; seed++) {
    gsl_rng_set(rng, seed);
    const double v = seed % 3 ? pow(10, uniform(rng, -6, 3)) : 0;
    const double a = seed % 4 ? pow(10, uniform(rng, -6, 6)) : 0;
    const double travel = pow(10, uniform(rng, -6, 0));
    double u[3], y[9] = {0}, dydt[9] = {0};
    direction(rng, u);
    vec3_axpy(v, u, y + 3);
    vec3_axpy(v, u, dydt);
    vec3_axpy(a, u, dydt + 3);
    const double h = dynamics_step_limit(d, y, dydt, travel);
    if (v == 0 && a == 0)
      CHECK(h == GSL_POSINF);
    else if (!CHECK_REL(v * h + a * h * h / 2, travel, 16 * DBL_EPSILON))
      fprintf(stderr, "  seed %lu: v=%g a=%g travel=%g\n", seed, v, a, travel);
    if (v == 0 && a > 0)
      CHECK_REL(h, sqrt(2 * travel / a), 8 * DBL_EPSILON);
    if (v > 0 && a == 0)
      CHECK_REL(h, travel / v, 8 * DBL_EPSILON);
  }
  dynamics_free(d);
  sample_free(&s);

  for (unsigned long seed = 0; seed < 12; seed++) {
    gsl_rng_set(rng, seed);
    struct recipe p = {models[seed % 3], 0.4, 0.2, true, true, 9, 2, 0.2, 2};
    struct sample many = random_sample(rng, &p);
    d = new_dynamics(&many, &cells);
    const size_t stride = dynamics_stride(d);
    double y[81], dydt[81], least = GSL_POSINF;
    dynamics_pack(d, &many.bed, y);
    CHECK(dynamics_rhs(0, y, dydt, d) == GSL_SUCCESS);
    const double travel = 1 / many.scene.law.kappa;
    const double h = dynamics_step_limit(d, y, dydt, travel);
    for (size_t i = 0; i < 9; i++) {
      const double *v = y + i * stride + 3, *a = dydt + i * stride + 3;
      double way[3] = {0};
      vec3_axpy(h, v, way);
      vec3_axpy(h * h / 2, a, way);
      CHECK(vec3_norm(way) <= travel * (1 + 16 * DBL_EPSILON));
      const double speed = vec3_norm(v), rate = vec3_norm(a);
      least = GSL_MIN(least,
                      (sqrt(speed * speed + 2 * rate * travel) - speed) / rate);
    }
    /* the root above loses digits where speed^2 is much larger */
    if (!CHECK_REL(h, least, 1e-9))
      fprintf(stderr, "  seed %lu\n", seed);
    dynamics_free(d);
    sample_free(&many);
  }
}

/* Which unknowns a scene has, and nothing lost on the way there and back. */
static void test_unknowns(gsl_rng *rng) {
  for (unsigned long c = 0; c < 6; c++) {
    gsl_rng_set(rng, c);
    struct recipe p = {models[c % 3], 0.4, c / 3 ? 0.2 : 0, true, true, 7, 2,
                       0.2,           1};
    struct sample s = random_sample(rng, &p);
    struct dynamics *d = new_dynamics(&s, &cells);
    const size_t stride = p.model == SCENE_ROTATION && p.phi > 0 ? 9 : 6;
    CHECK(dynamics_stride(d) == stride);
    CHECK(dynamics_dimension(d) == 7 * stride);
    double y[64], again[64];
    y[7 * stride] = again[7 * stride] = -77; /* not beyond the end */
    dynamics_pack(d, &s.bed, y);
    for (size_t i = 0; i < 7; i++) {
      CHECK(!memcmp(y + i * stride, s.bed.x + 3 * i, 3 * sizeof *y));
      CHECK(!memcmp(y + i * stride + 3, s.bed.v + 3 * i, 3 * sizeof *y));
      if (stride == 9)
        CHECK(!memcmp(y + i * stride + 6, s.bed.w + 3 * i, 3 * sizeof *y));
    }
    struct bed b;
    CHECK(bed_alloc(&b, 7) == GSL_SUCCESS);
    for (size_t u = 0; u < 21; u++)
      b.w[u] = (double)u;
    dynamics_unpack(d, y, &b);
    for (size_t u = 0; u < 21; u++)
      CHECK(b.w[u] == (stride == 9 ? s.bed.w[u] : (double)u));
    dynamics_pack(d, &b, again);
    CHECK(!memcmp(y, again, 7 * stride * sizeof *y));
    CHECK(y[7 * stride] == -77 && again[7 * stride] == -77);
    for (size_t i = 0; i < 7; i++) /* radii and masses are no unknowns */
      CHECK(b.r[i] == 0 && b.m[i] == 1);
    bed_free(&b);
    dynamics_free(d);
    sample_free(&s);
  }
}

/* However many spheres, whatever the order of their rows: a state goes back
   into the bed that it came from, and each row is one sphere's. */
static void test_large_state(gsl_rng *rng) {
  static const size_t sizes[3] = {1023, 1024, 3000};
  for (unsigned long c = 0; c < 3; c++) {
    gsl_rng_set(rng, c);
    const size_t n = sizes[c];
    struct recipe p = {SCENE_ROTATION, 0.4, 0.2, true, true, n, 0, 0.2, 1};
    struct sample s = random_sample(rng, &p);
    struct dynamics *d = new_dynamics(&s, &cells);
    double *y = numbers(9 * n);
    for (size_t u = 0; u < 3 * n; u++) { /* who and which */
      s.bed.x[u] = (double)u;
      s.bed.v[u] = (double)u + 0.25;
      s.bed.w[u] = (double)u + 0.5;
    }
    dynamics_pack(d, &s.bed, y);
    struct bed b;
    CHECK(bed_alloc(&b, n) == GSL_SUCCESS);
    dynamics_unpack(d, y, &b);
    CHECK(!memcmp(b.x, s.bed.x, 3 * n * sizeof *y));
    CHECK(!memcmp(b.v, s.bed.v, 3 * n * sizeof *y));
    CHECK(!memcmp(b.w, s.bed.w, 3 * n * sizeof *y));
    bool whole = true;
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < 9; k++)
        whole = whole && y[9 * i + k] == y[9 * i] + (double)(k % 3) +
                                             0.25 * (double)(k / 3);
    CHECK(whole);
    bed_free(&b);
    dynamics_free(d);
    free(y);
    sample_free(&s);
  }
}

/* No pointer to the scene or the bed is kept; beds that make no sense are
   refused. */
static void test_alloc(gsl_rng *rng) {
  gsl_rng_set(rng, 1);
  struct recipe p = {SCENE_ROTATION, 0.4, 0.2, true, true, 5, 2, 0.18, 1};
  struct sample s = random_sample(rng, &p);
  struct dynamics *d = new_dynamics(&s, &cells), *e = new_dynamics(&s, &cells);
  double y[45], want[45], got[45];
  dynamics_pack(d, &s.bed, y);
  CHECK(dynamics_rhs(0, y, want, d) == GSL_SUCCESS);
  sample_free(&s);
  CHECK(dynamics_rhs(0, y, got, e) == GSL_SUCCESS);
  CHECK(!memcmp(want, got, sizeof got));
  dynamics_free(d);
  dynamics_free(e);
  dynamics_free(NULL);

  struct dynamics *none = NULL;
  static const double bad[] = {0, -0.1, NAN, -INFINITY};
  for (size_t k = 0; k < 8; k++) {
    struct sample wrong = random_sample(rng, &p);
    (k < 4 ? wrong.bed.r : wrong.bed.m)[k % 5] = bad[k % 4];
    CHECK(dynamics_alloc(&none, &wrong.scene, &wrong.bed, &cells) ==
          GSL_EINVAL);
    sample_free(&wrong);
  }
  struct sample empty = {.scene = scene_default()};
  CHECK(bed_alloc(&empty.bed, 0) == GSL_SUCCESS);
  CHECK(dynamics_alloc(&none, &empty.scene, &empty.bed, &cells) == GSL_EINVAL);
  CHECK(none == NULL); /* outputs are untouched */
  sample_free(&empty);
}

/* --- every kernel that this machine has ------------------------------------*/

static void test_kernel(gsl_rng *rng, unsigned long kernel) {
  test_random_beds(rng, kernel);
  test_cell_borders(rng);
  test_touching(rng);
  test_threads(rng);
  test_stage(rng);
  test_span();
  test_shares();
  test_skin(rng);
  test_last_contact();
  for (int m = 0; m < 3; m++) {
    test_history(rng, models[m], 70, 360, kernel == 0);
    test_history(rng, models[m], 1100, 24, kernel == 0);
  }
}

static void test_kernels(gsl_rng *rng) {
  static const char *const asked[3] = {NULL, "x86_64_v3", "x86_64"};
  const char *had[3] = {NULL};
  struct sample s = {.scene = scene_default()};
  CHECK(bed_alloc(&s.bed, 1) == GSL_SUCCESS);
  s.bed.r[0] = 0.1;
  for (unsigned long k = 0; k < 3; k++) {
    if (asked[k])
      setenv("DEM_ISA", asked[k], 1);
    else
      unsetenv("DEM_ISA");
    struct dynamics *d = new_dynamics(&s, &cells);
    const char *name = dynamics_kernel(d);
    dynamics_free(d);
    bool again = false;
    for (unsigned long q = 0; q < k; q++)
      again = again || (had[q] && !strcmp(had[q], name));
    printf("kernel %s: %s\n", name, again ? "as before" : "tested");
    if (!again)
      test_kernel(rng, k);
    had[k] = name;
  }
  unsetenv("DEM_ISA");
  sample_free(&s);
}

int main(void) {
  limit_cpu(600); /* a loop without end is a failure too */
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_kernels(rng);
  CHECK(slow_slips > 1000 && fast_slips > 1000 && deep_overlaps > 1000 &&
        idle_contacts > 1000 && wall_hits > 1000);
  test_gradient(rng);
  test_kinetic(rng);
  test_momentum(rng);
  test_power(rng);
  test_symmetries(rng);
  test_relabel(rng);
  test_jacobian(rng);
  test_jacobian_at_rest();
  test_step_limit(rng);
  test_unknowns(rng);
  test_large_state(rng);
  test_alloc(rng);
  test_bad_states(rng);
  test_far_states();
  gsl_rng_free(rng);
  return check_done();
}
