/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The physics: trajectories of the equations (2.13)-(2.15) against their
   closed forms, for the paper's method and two others at a
   tight tolerance. lmax is so large that F[lmax] < 1e-60 N, but for the slow
   contacts of soft bodies, where it is as far as they start.

   A tolerance of the integration bounds the local error of a step: TOL / kappa
   in a position, TOL m/s in a velocity, TOL / r in a spin. Errors add up to at
   most the number of steps times that, times what a perturbation can grow by;
   the latter is derived where it is used. GSL's control lets 10 per cent
   more pass. */
#define _POSIX_C_SOURCE 200809L /* popen */
#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sort.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "model/closed_forms.h"
#include "dynamics/motion.h"

#define ULPS(n) ((n)*DBL_EPSILON)
#define COUNT(array) (sizeof(array) / sizeof *(array))
#define TOL 1e-12

static const char *const methods[] = {"merson", "dopri5", "rk8pd"};

static const double g = 9.81;

/* --- a scene in motion -----------------------------------------------------*/

struct world {
  struct scene scene;
  struct bed bed;
  struct motion *motion;
  double hmax; /* 0: none */
};

static struct world world_new(size_t n, double radius) {
  struct world w = {.scene = scene_default()};
  w.scene.law.lmax = 1;
  if (bed_alloc(&w.bed, n) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++)
    w.bed.r[i] = radius;
  return w;
}

static void world_floor(struct world *w) {
  if (scene_add_wall(&w->scene, (double[]){0, 0, 0}, (double[]){0, 0, -1}) !=
      GSL_SUCCESS)
    abort();
}

static void world_no_gravity(struct world *w) {
  memset(w->scene.gravity, 0, sizeof w->scene.gravity);
}

/* w stays where it is from now on. A step > 0 is a fixed one; no sphere passes
   the width of a contact in a step of another. */
static void world_start(struct world *w, const char *method, double step) {
  const struct integrate_options o = {.method = method,
                                      .control = "standard",
                                      .tol = TOL,
                                      .hinit = 1e-4,
                                      .hmax = w->hmax,
                                      .step = step};
  if (motion_alloc(&w->motion, &w->scene, &w->bed, &o,
                   &(struct dynamics_options){.threads = 1},
                   1 / w->scene.law.kappa) != GSL_SUCCESS)
    abort();
}

static void world_free(struct world *w) {
  motion_free(w->motion);
  scene_free(&w->scene);
  bed_free(&w->bed);
}

static const double *state(const struct world *w) {
  return integrate_state(w->motion->integrator);
}

static double now(const struct world *w) {
  return integrate_time(w->motion->integrator);
}

static size_t steps(const struct world *w) {
  return integrate_counts(w->motion->integrator).accepted;
}

/* The sum of all local errors so far, in units of an unknown's scale. */
static double errors(const struct world *w) {
  return 1.1 * TOL * (double)(steps(w) + 1);
}

/* No case takes half of these. */
static const size_t most_steps = 200000;

static bool step(struct world *w) {
  return (integrate_step(w->motion->integrator) == GSL_SUCCESS &&
          steps(w) < most_steps) ||
         CHECK(!"a step is taken");
}

/* Steps until t is within the last one. */
static bool reach(struct world *w, double t) {
  while (now(w) < t)
    if (!step(w))
      return false;
  return true;
}

static double component_at(const struct world *w, double t, size_t k) {
  double y[64];
  if (dynamics_dimension(w->motion->dynamics) > COUNT(y) ||
      integrate_at(w->motion->integrator, t, y) != GSL_SUCCESS)
    return GSL_NAN;
  return y[k];
}

/* The root of f in [a, b], to the last bit or two. */
static double find_root(double (*f)(double, void *), void *params, double a,
                        double b) {
  gsl_function function = {f, params};
  gsl_root_fsolver *s = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  double root = GSL_NAN;
  if (gsl_root_fsolver_set(s, &function, a, b) == GSL_SUCCESS)
    for (int k = 0; k < 200; k++) {
      if (gsl_root_fsolver_iterate(s) != GSL_SUCCESS)
        break;
      root = gsl_root_fsolver_root(s);
      if (gsl_root_test_interval(gsl_root_fsolver_x_lower(s),
                                 gsl_root_fsolver_x_upper(s), 0,
                                 ULPS(2)) == GSL_SUCCESS)
        break;
    }
  gsl_root_fsolver_free(s);
  return root;
}

/* --- 1: elastic contact without gravity ------------------------------------*/

/* The gap tau from the turning point; f is the force at touch between bodies
   of reduced mass 1/inverse. */
static double sech_gap(double f, double kappa, double inverse, double v0,
                       double tau) {
  double gap, velocity;
  closed_collision(f * inverse, kappa, v0, tau, &gap, &velocity);
  return gap;
}

/* A sphere and an oblique wall or two equal spheres on an oblique line, that
   pass the turning point at T = 20/a, when exp(-kappa l) is 4e-18 of its
   maximum; a velocity across or of both moves along. */
struct elastic {
  double f0, kappa, v0;
  bool two;
};

static const double line[3] = {2. / 3, -1. / 3, 2. / 3};
static const double drift[3] = {0.1, 0.6, 0.2}; /* across the line */

static double elastic_rate(double t, void *params) {
  const struct world *w = params;
  double rate = 0;
  for (size_t k = 0; k < 3; k++) {
    rate += line[k] * component_at(w, t, 3 + k);
    if (w->bed.n == 2)
      rate -= line[k] * component_at(w, t, 9 + k);
  }
  return rate;
}

static double elastic_gap(const struct world *w, double t) {
  double along = 0;
  for (size_t k = 0; k < 3; k++) {
    along += line[k] * component_at(w, t, k);
    if (w->bed.n == 2)
      along -= line[k] * component_at(w, t, 6 + k);
  }
  return along - (w->bed.n == 2 ? 2 : 1) * w->bed.r[0];
}

static void elastic_contact(const struct elastic *c, const char *method) {
  struct world w = world_new(c->two ? 2 : 1, 0.1);
  world_no_gravity(&w);
  w.scene.model = SCENE_BASIC;
  w.scene.law.restitution = 1;
  w.scene.law.f0 = c->f0;
  w.scene.law.kappa = c->kappa;
  w.scene.law.lmax = 5;
  const double inverse = c->two ? 2 : 1; /* of the reduced mass */
  const double a = c->kappa * c->v0 / 2, end = 20 / a;
  const double l = sech_gap(c->f0, c->kappa, inverse, c->v0, -end);
  if (c->two)
    for (int k = 0; k < 3; k++) {
      w.bed.x[k] = line[k] * (l + 0.2);
      w.bed.v[k] = drift[k] - line[k] * c->v0 * tanh(20);
      w.bed.v[3 + k] = drift[k];
    }
  else {
    const double outward[3] = {-line[0], -line[1], -line[2]};
    CHECK(scene_add_wall(&w.scene, (double[]){0, 0, 0}, outward) ==
          GSL_SUCCESS);
    for (int k = 0; k < 3; k++) {
      w.bed.x[k] = line[k] * (l + 0.1);
      w.bed.v[k] = drift[k] - line[k] * c->v0 * tanh(20);
    }
  }
  double momentum[3];
  for (int k = 0; k < 3; k++)
    momentum[k] = w.bed.v[k] + (c->two ? w.bed.v[3 + k] : 0);
  world_start(&w, method, 0);
  double worst = 0, lowest = GSL_POSINF, turn = GSL_NAN;
  while (now(&w) < 2 * end && step(&w)) {
    const double t = now(&w), tau = t - end;
    const double gap = elastic_gap(&w, t), rate = elastic_rate(t, &w);
    /* A local error d in the speed, of both bodies, changes what follows in
       two ways: the speed by d and the time of the turn by (distance d /
       v0)/v0, the distance being v0 times the time passed: together d (1 + a
       times that time) in the speed, as |l''| <= a v0, and v0/a times that in
       the gap. One in the gap is a speed's times 1/kappa = (v0/a)/2 and does
       no more. Three components of each. */
    const double tol = 6 * errors(&w) * (1 + a * t);
    const double e =
        GSL_MAX(fabs(rate - c->v0 * tanh(a * tau)),
                fabs(gap - sech_gap(c->f0, c->kappa, inverse, c->v0, tau)) * a /
                    GSL_MAX(c->v0, 1));
    worst = e / tol > worst || isnan(e) ? e / tol : worst;
    lowest = GSL_MIN(lowest, gap);
    const double before = t - integrate_last_step(w.motion->integrator);
    if (rate >= 0 && isnan(turn)) {
      turn = find_root(elastic_rate, &w, before, t);
      /* between the nodes: h^4/384 times the fourth derivative, for tanh
         below 4.1, for its integral 2; l'' is a v0 here */
      const double h4 = gsl_pow_4(a * (t - before)) / 384;
      CHECK_CLOSE(turn, end, tol / (a * c->v0) + 4.1 * h4 / a);
      CHECK_CLOSE(elastic_gap(&w, turn),
                  -log(c->kappa * c->v0 * c->v0 / (2 * c->f0 * inverse)) /
                      c->kappa,
                  tol / a + 2 * c->v0 * h4 / a);
    }
  }
  CHECK(worst <= 1);
  CHECK(turn > 0);
  CHECK(lowest < 0 || c->v0 < 1);
  /* across the line nothing happens, and the sum of momenta is kept: sums of
     slopes that cancel leave roundings only */
  for (size_t k = 0; k < 3; k++) {
    const double *y = state(&w);
    if (c->two)
      CHECK_CLOSE(y[3 + k] + y[9 + k], momentum[k],
                  ULPS(4) * (double)steps(&w) * (1 + c->v0));
    else {
      const double rate = elastic_rate(now(&w), &w);
      CHECK_CLOSE(y[3 + k] - rate * line[k], drift[k],
                  ULPS(4) * (double)steps(&w) * (1 + c->v0));
    }
  }
  world_free(&w);
}

static void test_elastic(void) {
  const struct elastic cases[] = {{10, 150, 1, false}, {10, 150, 0.1, false},
                                  {1, 500, 5, false},  {100, 30, 3, false},
                                  {10, 150, 1, true},  {10, 150, 0.1, true},
                                  {100, 500, 5, true}, {1, 30, 2, true}};
  for (size_t m = 0; m < COUNT(methods); m++)
    for (size_t k = 0; k < COUNT(cases); k++)
      elastic_contact(&cases[k], methods[m]);
}

/* --- 2: restitution at finite psi ------------------------------------------*/

/* Speed after a contact with the floor, and the sum of local errors. It starts
   where 1e-14 of the energy is left to come from further away. */
static double rebound_simulated(double f0, double kappa, double e, double psi,
                                double v0, const char *method, double *error) {
  struct world w = world_new(1, 0.1);
  world_no_gravity(&w);
  world_floor(&w);
  w.scene.model = SCENE_BASIC;
  w.scene.law.f0 = f0;
  w.scene.law.kappa = kappa;
  w.scene.law.restitution = e;
  w.scene.law.psi = psi;
  const double far = log(f0 / (kappa * 0.5 * v0 * v0 * 1e-14)) / kappa;
  w.scene.law.lmax = far + 1 / kappa;
  w.bed.x[2] = far + 0.1;
  w.bed.v[2] = -v0;
  world_start(&w, method, 0);
  while ((state(&w)[5] <= 0 || state(&w)[2] < far + 0.1) && step(&w))
    ;
  const double v1 = state(&w)[5];
  *error = errors(&w);
  world_free(&w);
  return v1;
}

/* A local error d in the speed is d u/rho(u) in the integral before the turn
   and d v/rho(-v) after, and the result's derivative by the integral is
   rho(-v1)/v1: growth by at most u/v1 rho(-v1)/rho(u) <= v0/v1, since what is
   before the turn is divided by more. One in the gap is as much energy as
   F/kappa of the force, at most v0^2, and so a speed of v0/v1 v0 at most. */
static double rebound_tolerance(double v0, double v1, double error) {
  return 2 * error * GSL_MAX(1, v0) * v0 / v1 + 1e-12 * v0;
}

static void test_restitution(void) {
  const double speeds[] = {0.003, 0.05, 0.5, 5};
  const double es[] = {0, 0.4, M_SQRT1_2, 0.95, 1};
  /* F0, kappa; the law of restitution knows neither */
  const double stiffness[][2] = {{10, 150}, {100, 150}, {10, 500}, {1, 30}};
  for (size_t i = 0; i < COUNT(speeds); i++)
    for (size_t k = 0; k < COUNT(es); k++) {
      struct contact_law law = scene_default().law;
      law.restitution = es[k];
      const double v0 = speeds[i];
      double v1 = GSL_NAN, off = GSL_NAN;
      CHECK(closed_restitution(&law, v0, &v1, &off) == GSL_SUCCESS &&
            off <= 1e-12 * v0);
      CHECK(v1 > 0 && v1 <= v0 * (1 + 1e-12));
      for (size_t s = 0; s < COUNT(stiffness); s++)
        for (size_t m = 0; m < (s ? 1 : COUNT(methods)); m++) {
          double error;
          const double v = rebound_simulated(
              stiffness[s][0], stiffness[s][1], es[k], law.psi, v0,
              methods[s ? 1 : m], &error); /* dopri5, the fastest */
          CHECK_CLOSE(v, v1, rebound_tolerance(v0, v1, error));
        }
    }
}

/* Fast: rho is 1 and e^2 but for speeds below some 1/psi. Both integrals differ
   from their limits by at most integral of u exp(-2 psi u) (1 - e^2)/e^4, that
   is (1 - e^2)/(2 psi e^2)^2: v1^2 = e^2 v0^2 up to 2 e^2 times twice that. */
static void test_restitution_fast(void) {
  const double es[] = {0.4, M_SQRT1_2, 0.95};
  for (size_t k = 0; k < COUNT(es); k++) {
    const double e = es[k], v0 = 50, psi = 10;
    double error, last = GSL_POSINF;
    for (double factor = 1; factor < 100; factor *= 3) {
      const double v1 =
          rebound_simulated(10, 150, e, psi * factor, v0, "dopri5", &error);
      const double tol =
          (1 - e * e) / gsl_pow_2(psi * factor * e) + 2 * v1 * error * v0 / v1;
      CHECK_CLOSE(v1 * v1, e * e * v0 * v0, tol);
      CHECK(fabs(v1 / v0 - e) < last);
      last = fabs(v1 / v0 - e);
    }
  }
}

/* Slow: rho = rho(0) (1 + c v) gives v1/v0 = 1 - 2/3 c v0 with
   c = psi (1 - e^2)/(1 + e^2); the next term is of order (c v0)^2, its factor
   4/9. */
static void test_restitution_slow(void) {
  const double es[] = {0, 0.4, M_SQRT1_2};
  for (size_t k = 0; k < COUNT(es); k++) {
    const double e2 = es[k] * es[k], psi = 10;
    const double c = psi * (1 - e2) / (1 + e2);
    for (double v0 = 1e-3; v0 > 1e-5; v0 /= 10) {
      double error;
      const double v1 =
          rebound_simulated(10, 150, es[k], psi, v0, "dopri5", &error);
      CHECK_CLOSE(v1 / v0, 1 - 2. / 3 * c * v0,
                  gsl_pow_2(c * v0) + 4 * error / v0);
    }
  }
}

/* --- 3: Toda lattice -------------------------------------------------------*/

enum { CHAIN = 6 };

/* r = 1 m and lmax = 1 m: next neighbours are never in reach */
static const double chain_radius = 1;

/* Eigenvalues of L, ascending; its largest off-diagonal element. */
static double chain_eigenvalues(const struct world *w, double value[CHAIN]) {
  const double *y = state(w);
  double matrix[CHAIN * CHAIN] = {0}, most = 0;
  for (size_t i = 0; i < CHAIN; i++) {
    matrix[i * CHAIN + i] = vec3_dot(y + 6 * i + 3, line);
    if (i + 1 == CHAIN)
      break;
    double u[3];
    vec3_sub(y + 6 * (i + 1), y + 6 * i, u);
    const double gap = vec3_norm(u) - 2 * chain_radius;
    const double off = sqrt(w->scene.law.f0 / w->scene.law.kappa) *
                       exp(-0.5 * w->scene.law.kappa * gap);
    matrix[i * CHAIN + i + 1] = matrix[(i + 1) * CHAIN + i] = off;
    most = GSL_MAX(most, off);
  }
  gsl_matrix_view m = gsl_matrix_view_array(matrix, CHAIN, CHAIN);
  gsl_vector_view v = gsl_vector_view_array(value, CHAIN);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(CHAIN);
  gsl_eigen_symm(&m.matrix, &v.vector, work);
  gsl_eigen_symm_free(work);
  gsl_sort(value, 1, CHAIN);
  return most;
}

static void toda(unsigned long seed, const char *method) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  struct world w = world_new(CHAIN, chain_radius);
  world_no_gravity(&w);
  w.scene.model = SCENE_BASIC;
  w.scene.law.restitution = 1;
  double at = 0;
  for (size_t i = 0; i < CHAIN; i++) {
    const double v = 4 * gsl_rng_uniform(rng) - 2;
    for (size_t k = 0; k < 3; k++) {
      w.bed.x[3 * i + k] = at * line[k];
      w.bed.v[3 * i + k] = v * line[k];
    }
    at += 2 * chain_radius - 0.02 + 0.12 * gsl_rng_uniform(rng);
  }
  world_start(&w, method, 0);
  double first[CHAIN], value[CHAIN];
  double most = chain_eigenvalues(&w, first), off = most, moved = 0;
  while (off > 1e-9 && steps(&w) < 100000 && step(&w)) {
    off = chain_eigenvalues(&w, value);
    most = GSL_MAX(most, off);
    for (int i = 0; i < CHAIN; i++)
      if (!(fabs(value[i] - first[i]) <= moved))
        moved = fabs(value[i] - first[i]);
  }
  /* An error in L moves an eigenvalue by at most its norm and the exact flow
     moves none, so the errors just add up: e in a velocity, kappa/2 times the
     element times 2 e/kappa in each of two off-diagonal ones; three components.
     And positions of up to 11 m know the gap to 1e-15 m. */
  const double grown = 1 + 2 * most;
  const double tol =
      sqrt(3) * errors(&w) * grown +
      ULPS(4 * 11) * w.scene.law.kappa * most * (double)(steps(&w) + 1);
  if (!(CHECK(moved <= tol) & CHECK(most > 0.5) & CHECK(off <= 1e-9)))
    fprintf(stderr, "  seed %lu, %s: moved %g > %g; %g, %g\n", seed, method,
            moved, tol, most, off);
  /* apart from each other the velocities are the eigenvalues, the fastest in
     front; what L still holds moves them by its norm at most */
  for (size_t i = 0; i < CHAIN; i++)
    CHECK_CLOSE(vec3_dot(state(&w) + 6 * i + 3, line), first[i], tol + 2 * off);
  world_free(&w);
  gsl_rng_free(rng);
}

static void test_toda(void) {
  for (unsigned long seed = 1; seed <= 10; seed++)
    for (size_t m = 0; m < COUNT(methods); m++)
      toda(seed, methods[m]);
}

/* --- 4: from sliding to rolling --------------------------------------------*/

/* Forces on the sphere change the slip of its surface by 1 + 5/2. */
static void test_rolling(void) {
  for (size_t m = 0; m < COUNT(methods); m++) {
    struct world w = world_new(1, 0.1);
    world_floor(&w);
    const struct contact_law *law = &w.scene.law;
    const double v0 = 1, direction[2] = {0.6, 0.8}, r = 0.1;
    w.bed.x[2] = r + closed_rest_gap(law, g);
    for (int k = 0; k < 2; k++)
      w.bed.v[k] = v0 * direction[k];
    world_start(&w, methods[m], 0);
    const double rate = 3.5 * law->friction * g / contact_rebound(law, 0);
    const double end = (v0 - law->vmin) / rate; /* of full friction */
    double moved = 0, wrong = 0, slip = 0;
    size_t sliding = 0, creeping = 0;
    while (now(&w) < 1 && step(&w)) {
      const double *y = state(&w);
      /* v + 2/5 r omega: along a direction k of the floor the spin about the
         axis across; omega = (-vy, vx)/r is rolling */
      const double spin[2] = {r * y[7], -r * y[6]};
      for (int k = 0; k < 2; k++)
        moved =
            GSL_MAX(moved, fabs(y[3 + k] + 0.4 * spin[k] - v0 * direction[k]));
      slip = hypot(y[3] - spin[0], y[4] - spin[1]);
      /* errors do not grow: slip falls. The height stays, as its slope is 0
         but for rounding. */
      const double tol = 8 * errors(&w);
      if (now(&w) < end) {
        sliding++;
        wrong = GSL_MAX(wrong, fabs(slip - (v0 - rate * now(&w))) / tol);
      } else {
        creeping++;
        const double s = slip / law->vmin, sigma = s * s * (3 - 2 * s);
        double share = GSL_NAN; /* and back */
        CHECK(closed_slip_share(now(&w) - end, law->vmin, rate, &share) ==
              GSL_SUCCESS);
        CHECK_CLOSE(share, s, tol / law->vmin);
        wrong = GSL_MAX(
            wrong, fabs(now(&w) - end - closed_slip_time(s, law->vmin, rate)) /
                       (tol / (rate * sigma)));
      }
      if (isnan(slip))
        wrong = GSL_NAN;
    }
    CHECK(sliding > 10 && creeping > 10);
    CHECK(wrong <= 1);
    /* linear in the unknowns: kept by every Runge-Kutta step but for rounding
     */
    CHECK(moved <= ULPS(4) * (double)steps(&w));
    const double left = 2. / 7 * slip;
    for (int k = 0; k < 2; k++)
      CHECK_CLOSE(state(&w)[3 + k], (5. / 7 * v0 + left) * direction[k],
                  8 * errors(&w));
    /* 1/t: rate t/vmin > 1/(3 s) - 1/3 */
    CHECK(slip < law->vmin / (3 * rate / law->vmin * (1 - end)));
    CHECK_CLOSE(vec3_norm(state(&w) + 3), 5. / 7 * v0, left + 8 * errors(&w));
    world_free(&w);
  }
}

/* On an incline: gravity tilted by angle about the y axis. */
static void incline(struct world *w, double angle) {
  world_floor(w);
  w->scene.gravity[0] = g * sin(angle);
  w->scene.gravity[2] = -g * cos(angle);
  w->bed.x[2] = w->bed.r[0] + closed_rest_gap(&w->scene.law, g * cos(angle));
}

/* 3 s^2 - 2 s^3 = q in [0, 1] */
static double slip_share(double q) {
  return 0.5 - sin(asin(1 - 2 * q) / 3);
}

/* Without rotation: below the friction angle the sphere creeps with
   Sigma = T/(phi F), above it slides with what friction leaves. */
static void test_incline(void) {
  for (size_t m = 0; m < COUNT(methods); m++) {
    const double shares[] = {0.05, 0.3, 0.5, 0.9, 1.5};
    for (size_t k = 0; k < COUNT(shares); k++) {
      struct world w = world_new(1, 0.1);
      w.scene.model = SCENE_FRICTION;
      const struct contact_law *law = &w.scene.law;
      const double limit =
          law->friction / contact_rebound(law, 0); /* T/N of full slip */
      const double angle = atan(shares[k] * limit);
      incline(&w, angle);
      world_start(&w, methods[m], 0);
      const double z = w.bed.x[2], start = 0.2;
      CHECK(reach(&w, start));
      if (shares[k] < 1) {
        const double s = slip_share(shares[k]);
        /* the way there dies out with exp(-rate t), rate > 190 /s here */
        const double rate =
            limit * g * cos(angle) * 6 * s * (1 - s) / law->vmin;
        CHECK(rate * start > 38);
        /* what one second holds of local errors is forgotten in 1/rate */
        CHECK_CLOSE(state(&w)[3], s * law->vmin,
                    errors(&w) + law->vmin * exp(-rate * start));
      } else {
        const double v = state(&w)[3], t = now(&w);
        CHECK(v > 10 * law->vmin);
        CHECK(reach(&w, 2 * start));
        CHECK_CLOSE(state(&w)[3] - v,
                    (now(&w) - t) * g * (sin(angle) - limit * cos(angle)),
                    2 * errors(&w));
      }
      CHECK_CLOSE(state(&w)[2], z, errors(&w) / law->kappa);
      CHECK(state(&w)[1] == 0 && state(&w)[4] == 0);
      world_free(&w);
    }
  }
}

/* With rotation it rolls: friction is 2/7 of the pull along, the slip what
   makes for that, and the rest accelerates. */
static void test_rolling_down(void) {
  for (size_t m = 0; m < COUNT(methods); m++) {
    struct world w = world_new(1, 0.1);
    const struct contact_law *law = &w.scene.law;
    const double limit = law->friction / contact_rebound(law, 0), angle = 0.5;
    incline(&w, angle);
    world_start(&w, methods[m], 0);
    CHECK(reach(&w, 0.5));
    const double share = 2. / 7 * tan(angle) / limit;
    const double s = slip_share(share);
    const double *y = state(&w);
    CHECK(share < 0.9 &&
          3.5 * limit * g * cos(angle) * 6 * s * (1 - s) / law->vmin * 0.5 >
              38);
    /* momentum of both kinds, from rest: v + 2/5 r omega = T t */
    CHECK_CLOSE(y[3] + 0.4 * 0.1 * y[7], g * sin(angle) * now(&w),
                ULPS(8) * (double)steps(&w));
    CHECK_CLOSE(y[3] - 0.1 * y[7], s * law->vmin, 8 * errors(&w));
    CHECK_CLOSE(y[3],
                5. / 7 * g * sin(angle) * now(&w) + 2. / 7 * s * law->vmin,
                8 * errors(&w));
    world_free(&w);
  }
}

/* --- 5: small oscillations at rest -----------------------------------------*/

/* Heights above that of rest at n times, interval apart, after a deflection. */
static void oscillate(const struct contact_law *law, const char *method,
                      double deflection, double interval, size_t n, double *z) {
  struct world w = world_new(1, 0.1);
  world_floor(&w);
  w.scene.model = SCENE_BASIC;
  w.scene.law = *law;
  w.hmax = interval / 16; /* interpolates to 4e-10 of the deflection */
  const double rest = 0.1 + closed_rest_gap(law, g);
  w.bed.x[2] = rest + deflection;
  world_start(&w, method, 0);
  for (size_t k = 0; k < n; k++) {
    const double t = interval * (double)k;
    CHECK(reach(&w, t));
    z[k] = component_at(&w, t, 2) - rest;
  }
  world_free(&w);
}

/* Half the difference of a deflection up and one down has no term of second
   order: what is left of the nonlinearity is (kappa A)^2. */
static void test_oscillation(void) {
  enum { SAMPLES = 60 };
  const double kappas[] = {30, 150, 500}, es[] = {0.4, 0.9, 1};
  for (size_t i = 0; i < COUNT(kappas); i++)
    for (size_t j = 0; j < COUNT(es); j++)
      for (size_t m = 0; m < COUNT(methods); m++) {
        struct contact_law law = scene_default().law;
        law.kappa = kappas[i];
        law.restitution = es[j];
        law.lmax = 150 / law.kappa;
        const double share = 1e-3, deflection = share / law.kappa;
        const double e2 = law.restitution * law.restitution;
        const double omega = sqrt(law.kappa * g);
        const double c = g * law.psi * (1 - e2) / (1 + e2);
        const double interval = 0.3 / omega;
        double up[SAMPLES], down[SAMPLES];
        oscillate(&law, methods[m], deflection, interval, SAMPLES, up);
        oscillate(&law, methods[m], -deflection, interval, SAMPLES, down);

        /* the solution: under- or overdamped */
        const double d = omega * omega - 0.25 * c * c, q = sqrt(fabs(d));
        double worst = 0, even = 0;
        gsl_matrix *x = gsl_matrix_alloc(SAMPLES - 2, 2);
        gsl_vector *z = gsl_vector_alloc(SAMPLES - 2);
        for (size_t k = 0; k < SAMPLES; k++) {
          const double t = interval * (double)k, odd = 0.5 * (up[k] - down[k]);
          const double linear =
              deflection * exp(-0.5 * c * t) *
              (d > 0 ? cos(q * t) + 0.5 * c / q * sin(q * t)
                     : cosh(q * t) + 0.5 * c / q * sinh(q * t));
          if (!(fabs(odd - linear) <= worst))
            worst = fabs(odd - linear);
          even = GSL_MAX(even, fabs(up[k] + down[k]) / 2);
          /* a linear oscillator's samples: z2 = p z1 + q z0 */
          if (k >= 1 && k + 1 < SAMPLES)
            gsl_matrix_set(x, k - 1, 0, odd);
          if (k + 2 < SAMPLES)
            gsl_matrix_set(x, k, 1, odd);
          if (k >= 2)
            gsl_vector_set(z, k - 2, odd);
        }
        /* Each power of the amplitude comes with factors of order 1, and the
           damping with c/omega times them, below 5; over 18 radians the
           frequency's change adds up: (kappa A)^2/24 of it without damping.
           Local errors as well: below 1e-9 of the amplitude a step, of which
           there are hundreds, so below the former. */
        const double second = gsl_pow_2(share) * (2 + c / omega);
        const double numerical = 1.1 * TOL / share * 1000;
        CHECK(worst <= deflection * (second + numerical));
        CHECK(even <= deflection * share * (2 + c / omega) &&
              even >= 0.01 * deflection * share);

        gsl_vector *fit = gsl_vector_alloc(2);
        gsl_matrix *cov = gsl_matrix_alloc(2, 2);
        gsl_multifit_linear_workspace *work =
            gsl_multifit_linear_alloc(SAMPLES - 2, 2);
        double residual;
        gsl_multifit_linear(x, z, fit, cov, &residual, work);
        const double a = gsl_vector_get(fit, 0), b = gsl_vector_get(fit, 1);
        const double fitted_c = -log(-b) / interval;
        /* 2 sqrt(-b) cos or cosh; the sum of both eigenvalues either way */
        const double half = 0.5 * a / sqrt(-b);
        const double phase =
            half < 1 ? gsl_pow_2(acos(half)) : -gsl_pow_2(acosh(half));
        const double fitted_omega =
            sqrt(phase / gsl_pow_2(interval) + 0.25 * fitted_c * fitted_c);
        /* from errors of the samples, second times the signal, to the two
           rates: divided by the angle between samples, twice */
        const double tol = (second + numerical) / gsl_pow_2(0.3);
        CHECK_CLOSE(fitted_c, c, tol * omega * (1 + c / omega));
        CHECK_REL(fitted_omega, omega, tol * (1 + c / omega));
        gsl_multifit_linear_free(work);
        gsl_matrix_free(cov);
        gsl_vector_free(fit);
        gsl_vector_free(z);
        gsl_matrix_free(x);
      }
}

/* --- 6: energy -------------------------------------------------------------*/

static void energy(unsigned long seed, const char *method) {
  enum { SPHERES = 10 };
  struct world w = world_new(SPHERES, 0.1);
  w.scene.model = SCENE_BASIC;
  w.scene.law.restitution = 1;
  CHECK(scene_add_box(&w.scene, 0.8, 0.8) == GSL_SUCCESS);
  CHECK(scene_add_wall(&w.scene, (double[]){0, 0, 0.8}, (double[]){0, 0, 1}) ==
        GSL_SUCCESS);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < SPHERES; i++) {
    const size_t at[3] = {i % 2, i / 2 % 2, i / 4};
    for (size_t k = 0; k < 3; k++) {
      w.bed.x[3 * i + k] =
          0.15 + 0.25 * (double)at[k] + 0.04 * gsl_rng_uniform(rng);
      w.bed.v[3 * i + k] = 4 * gsl_rng_uniform(rng) - 2;
    }
  }
  world_start(&w, method, 0);
  const double before = dynamics_kinetic(w.motion->dynamics, state(&w)) +
                        dynamics_potential(w.motion->dynamics, state(&w));
  double moved = 0, tol = ULPS(100) * before, contacts = 0;
  while (now(&w) < 1 && step(&w)) {
    const double *y = state(&w),
                 *dydt = integrate_derivative(w.motion->integrator);
    const double kinetic = dynamics_kinetic(w.motion->dynamics, y);
    const double e = kinetic + dynamics_potential(w.motion->dynamics, y);
    if (!(fabs(e - before) <= moved))
      moved = fabs(e - before);
    contacts = GSL_MAX(contacts, before - kinetic);
    /* the energy's gradient is velocity and minus acceleration: a local error
       of TOL in a velocity and TOL/kappa in a position changes it by that, and
       the rounding of a position of 1 m by its share */
    for (size_t i = 0; i < SPHERES; i++)
      for (size_t k = 0; k < 3; k++)
        tol += 1.1 * TOL * fabs(y[6 * i + 3 + k]) +
               (1.1 * TOL / w.scene.law.kappa + ULPS(1)) *
                   fabs(dydt[6 * i + 3 + k]);
  }
  if (!(CHECK(moved <= tol) & CHECK(tol < 1e-4 * before) &
        CHECK(contacts > 0.5 * before)))
    fprintf(stderr, "  seed %lu, %s: energy %g, moved %g > %g\n", seed, method,
            before, moved, tol);
  printf("energy: %-6s seed %lu, %zu steps, error %.1e of it\n", method, seed,
         steps(&w), moved / before);
  gsl_rng_free(rng);
  world_free(&w);
}

static void test_energy(void) {
  for (unsigned long seed = 1; seed <= 2; seed++)
    for (size_t m = 0; m < COUNT(methods); m++)
      energy(seed, methods[m]);
}

/* --- 7: rebound under gravity ----------------------------------------------*/

static const double height = 16;

/* From the drop to the next apex, e = 1. */
static double rebound_time(double f0, double kappa) {
  double time = GSL_NAN, error = GSL_NAN;
  CHECK(closed_rebound_time(f0, kappa, g, height, &time, &error) ==
            GSL_SUCCESS &&
        error < 1e-11);
  return time;
}

static double speed_at(double t, void *params) {
  return component_at(params, t, 5);
}

/* The same through the spheres' equations. */
static double rebound_apex(double f0, double kappa, double e,
                           const char *method) {
  struct world w = world_new(1, 0.1);
  world_floor(&w);
  w.scene.model = SCENE_BASIC;
  w.scene.law.f0 = f0;
  w.scene.law.kappa = kappa;
  w.scene.law.restitution = e;
  w.scene.law.lmax = height + 1;
  w.bed.x[2] = height + 0.1;
  world_start(&w, method, 0);
  bool rising = false;
  double apex = GSL_NAN;
  while (isnan(apex) && now(&w) < 10 && step(&w)) {
    const double v = state(&w)[5];
    if (rising && v <= 0)
      apex = find_root(speed_at, &w,
                       now(&w) - integrate_last_step(w.motion->integrator),
                       now(&w));
    rising = rising || v > 0;
  }
  world_free(&w);
  return apex;
}

/* And by the program. */
static double rebound_printed(double f0, double kappa, double e,
                              const char *method) {
  const char *build = getenv("B");
  char command[256], text[512];
  snprintf(command, sizeof command,
           "%s/bounce --rebound --method %s --control standard --tol %g"
           " --f0 %.17g --kappa %.17g --restitution %.17g",
           build ? build : "build", method, TOL, f0, kappa, e);
  FILE *f = popen(command, "r");
  double t = GSL_NAN;
  while (f && fgets(text, sizeof text, f)) {
    double row[4];
    if (sscanf(text, "%lf %lf %lf %lf", row, row + 1, row + 2, row + 3) == 4)
      t = row[3];
  }
  CHECK(f && pclose(f) == 0);
  return t;
}

/* The duration knows the speed v0 through 2 v0/g and the contact itself as
   little: an error d of the speed is 2 d/g in the time. The other way from
   there, the fall forgets nothing. The sum of local errors is below 1e4 steps
   times TOL, so 1e-8 s is on the safe side of 2e-9 and 1e-9 s between two
   methods is what they are found to keep. */
static void test_rebound(void) {
  const double kappas[] = {30, 150, 500};
  /* Tab. 4.1: up to 1.3e-3 s off, to either side */
  const double table[2][3] = {{3.6409, 3.6184, 3.6134},
                              {3.108, 3.0883, 3.0858}};
  for (size_t k = 0; k < COUNT(kappas); k++) {
    const double exact = rebound_time(10, kappas[k]);
    double apex[COUNT(methods)];
    for (size_t m = 0; m < COUNT(methods); m++) {
      apex[m] = rebound_apex(10, kappas[k], 1, methods[m]);
      CHECK_CLOSE(apex[m], exact, 1e-8);
      CHECK_CLOSE(apex[m], apex[0], 1e-9);
      CHECK_CLOSE(rebound_printed(10, kappas[k], 1, methods[m]), exact, 1e-8);
    }
    CHECK_CLOSE(exact, table[0][k], 1.5e-3);
    /* e < 1: no closed form, but the same from all */
    double damped[COUNT(methods)];
    for (size_t m = 0; m < COUNT(methods); m++) {
      damped[m] = rebound_apex(10, kappas[k], M_SQRT1_2, methods[m]);
      CHECK_CLOSE(damped[m], damped[0], 1e-9);
      CHECK_CLOSE(rebound_printed(10, kappas[k], M_SQRT1_2, methods[m]),
                  damped[0], 1e-8);
    }
    CHECK_CLOSE(damped[0], table[1][k], 1.5e-3);
    printf("rebound: kappa %3g  %.9f (%.4f)  e^2 = 1/2: %.9f (%.4f)\n",
           kappas[k], exact, table[0][k], damped[0], table[1][k]);
  }
}

/* Stiffer and stiffer: (1 + e) sqrt(2 h0/g), and the contact's delay. Far from
   the wall the sech^2 solution is l = v0 |tau| - ln(2 kappa v0^2/F0)/kappa, so
   the way there and back is longer by twice that last term over v0. Gravity
   changes the speed by g/(kappa v0) of it within the contact. */
static void test_hard_limit(void) {
  const double hard = 2 * sqrt(2 * height / g), v0 = sqrt(2 * g * height);
  double last = GSL_POSINF;
  for (double kappa = 30; kappa < 1e5; kappa *= 4) {
    const double delay = rebound_time(10, kappa) - hard;
    const double contact = 2 * log(2 * kappa * v0 * v0 / 10) / (kappa * v0);
    CHECK(delay > 0 && delay < last);
    CHECK_CLOSE(delay, contact, gsl_pow_2(contact) * g / v0 + 1e-12 * hard);
    last = delay;
  }
  CHECK(last < 1e-4);
}

/* --- free fall -------------------------------------------------------------*/

/* A parabola: no method here has an error but rounding. */
static void test_free_fall(void) {
  const char *all[] = {"merson", "dopri5", "rk8pd", "rkf45",
                       "rkck",   "rkc",    "verlet"};
  const enum scene_model models[] = {SCENE_BASIC, SCENE_FRICTION,
                                     SCENE_ROTATION};
  for (size_t m = 0; m < COUNT(all); m++)
    for (size_t k = 0; k < COUNT(models); k++)
      for (int fixed = !strcmp(all[m], "verlet"); fixed < 2; fixed++) {
        struct world w = world_new(2, 0.1);
        w.scene.model = models[k];
        const double a[3] = {0.5, -0.25, -9.81};
        memcpy(w.scene.gravity, a, sizeof a);
        const double x[6] = {0, 0, 20, 5, 3, 20}, v[6] = {1, 2, 3, 1.5, 2, 3};
        const double spin[6] = {1, -2, 3, 4, 5, -6};
        memcpy(w.bed.x, x, sizeof x);
        memcpy(w.bed.v, v, sizeof v);
        memcpy(w.bed.w, spin, sizeof spin);
        world_start(&w, all[m], fixed ? 0.01 : 0);
        CHECK(reach(&w, 1));
        const double t = now(&w), *y = state(&w);
        const size_t row = dynamics_stride(w.motion->dynamics);
        /* a step of s stages is a sum of s terms of size 20 */
        const double tol = ULPS(20) * 4 * (double)(steps(&w) + 1);
        for (size_t i = 0; i < 2; i++)
          for (size_t c = 0; c < 3; c++) {
            const size_t at = 3 * i + c;
            CHECK_CLOSE(y[row * i + c], x[at] + t * (v[at] + 0.5 * a[c] * t),
                        tol);
            CHECK_CLOSE(y[row * i + 3 + c], v[at] + a[c] * t, tol);
            CHECK(row == 6 || y[row * i + 6 + c] == spin[at]);
          }
        world_free(&w);
      }
}

/* What has no answer is refused, and nothing is written. */
static void test_domains(void) {
  const struct contact_law law = scene_default().law;
  const double bad_speeds[] = {0, -1, GSL_NAN};
  double result = 7, error = 8;
  for (size_t k = 0; k < COUNT(bad_speeds); k++)
    CHECK(closed_restitution(&law, bad_speeds[k], &result, &error) == GSL_EDOM);
  const double bad_heights[] = {40 / law.kappa, 0, GSL_NAN};
  for (size_t k = 0; k < COUNT(bad_heights); k++)
    CHECK(closed_rebound_time(law.f0, law.kappa, g, bad_heights[k], &result,
                              &error) == GSL_EDOM);
  CHECK(closed_rebound_time(law.f0, law.kappa, 0, 1, &result, &error) ==
        GSL_EDOM);
  CHECK(closed_slip_share(-1, 1, 1, &result) == GSL_EDOM);
  CHECK(result == 7 && error == 8);
}

/* --- a sphere over the floor -----------------------------------------------*/

/* The floor is added to a copy of the scene, and a scene with walls of its own
   is refused and stays as it is. */
static void test_over_floor(void) {
  const struct integrate_options o = {
      .method = "rkc", .control = "standard", .tol = TOL, .hinit = 1e-4};
  const double x[] = {0, 0, 0.5}, v[3] = {0};
  struct world w = world_new(1, 0.1);
  struct motion *m = NULL;
  CHECK(motion_alloc_over_floor(&m, &w.scene, 0.1, x, v, &o, 0) == GSL_SUCCESS);
  CHECK(w.scene.walls_count == 0 && w.scene.walls == NULL);
  CHECK(m && integrate_state(m->integrator)[2] == 0.5);
  struct motion *refused = NULL;
  CHECK(motion_alloc_over_floor(&refused, &w.scene, -0.1, x, v, &o, 0) ==
        GSL_EINVAL);
  world_floor(&w);
  CHECK(motion_alloc_over_floor(&refused, &w.scene, 0.1, x, v, &o, 0) ==
        GSL_EINVAL);
  CHECK(refused == NULL && w.scene.walls_count == 1 &&
        w.scene.walls[0].normal[2] == -1);
  motion_free(m);
  motion_free(refused);
  world_free(&w);
}

int main(void) {
  gsl_set_error_handler_off();
  test_over_floor();
  test_domains();
  test_free_fall();
  test_elastic();
  test_restitution();
  test_restitution_fast();
  test_restitution_slow();
  test_toda();
  test_rolling();
  test_incline();
  test_rolling_down();
  test_oscillation();
  test_energy();
  test_rebound();
  test_hard_limit();
  return check_done();
}
