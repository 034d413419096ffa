/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One sphere above a plane: the force's derivatives against differences, the
   fastest mode against closed form 5, energy along a bounce, the limit of
   travel, and steps of an implicit method at rest. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "dynamics/drop.h"
#include "model/closed_forms.h"

static struct drop standard(double restitution) {
  return (struct drop){.force = drop_contact,
                       .law = {.f0 = 10,
                               .kappa = 150,
                               .psi = 10,
                               .restitution = restitution,
                               .vmin = 0.01,
                               .lmax = 0.1},
                       .gravity = 9.81};
}

static void test_slopes(void) {
  const struct drop d = standard(0.4);
  for (int i = -3; i <= 3; i++)
    for (int k = -3; k <= 3; k++) {
      const double l = 0.01 * i, v = 0.1 * k, dl = 1e-6, dv = 1e-5;
      double slope[2];
      const double f = drop_contact(&d, l, v, slope);
      CHECK(f == contact_normal(&d.law, l, v));
      CHECK(f == drop_contact(&d, l, v, NULL));
      /* central differences: (kappa dl)^2/6 and rounding */
      CHECK_CLOSE(slope[0],
                  (drop_contact(&d, l + dl, v, NULL) -
                   drop_contact(&d, l - dl, v, NULL)) /
                      (2 * dl),
                  150 * f * (1e-8 + DBL_EPSILON / (150 * dl)));
      CHECK_CLOSE(slope[1],
                  (drop_contact(&d, l, v + dv, NULL) -
                   drop_contact(&d, l, v - dv, NULL)) /
                      (2 * dv),
                  f * (1e-7 + 2 * DBL_EPSILON / dv));
    }
}

/* At rest: lambda^2 + c lambda + omega^2 = 0. */
static void test_mode(void) {
  for (int k = 0; k <= 10; k++) {
    struct drop d = standard(0.1 * k);
    const double e2 = gsl_pow_2(d.law.restitution);
    const double omega2 = d.law.kappa * d.gravity;
    const double c = d.gravity * d.law.psi * (1 - e2) / (1 + e2);
    const double y[] = {closed_rest_gap(&d.law, d.gravity), 0};
    const struct stiffness_mode m = drop_mode(&d, y);
    const double half = 0.5 * c, squared = half * half - omega2;
    const double radius = squared < 0 ? sqrt(omega2) : half + sqrt(squared);
    const double angle = squared < 0 ? acos(-half / sqrt(omega2)) : M_PI;
    CHECK_REL(m.radius, radius, 1e-12);
    CHECK_CLOSE(m.angle, angle, 1e-12);
  }
}

/* Where no contact is, and where one gives back more than it takes: nothing
   that decays, so the angle of what only just does not. */
static void test_no_decay(void) {
  struct drop d = standard(1.2);
  const double far[] = {1e4, 0},
               rest[] = {closed_rest_gap(&d.law, d.gravity), 0};
  CHECK(drop_mode(&d, far).radius == 0);
  CHECK(drop_mode(&d, far).angle == M_PI_2);
  CHECK(drop_mode(&d, rest).radius > 0);
  CHECK(drop_mode(&d, rest).angle == M_PI_2);
}

static void test_bounce(void) {
  struct drop d = standard(1);
  d.travel = 1 / d.law.kappa;
  const struct integrate_options o = {
      .method = "rk8pd", .control = "standard", .tol = 1e-12, .hinit = 0.1};
  struct integrator *it;
  if (!CHECK(drop_alloc(&it, &d, &o, 1, 0) == GSL_SUCCESS))
    return;
  const double *y = integrate_state(it);
  const double first = drop_energy(&d, y);
  CHECK_REL(first, d.gravity, 1e-15); /* exp(-150) in the contact */
  double deepest = 0, off = 0, furthest = 0;
  size_t steps = 0;
  while (integrate_time(it) < 2 && steps++ < 100000) {
    const double before = y[0];
    if (!CHECK(integrate_step(it) == GSL_SUCCESS))
      break;
    deepest = GSL_MIN(deepest, y[0]);
    furthest = GSL_MAX(furthest, fabs(y[0] - before));
    off = GSL_MAX(off, fabs(drop_energy(&d, y) / first - 1));
  }
  CHECK(d.evaluations > 13 * steps);
  /* g z + F0/kappa exp(-kappa z) = g at the turn; a step's length before it */
  CHECK(deepest < -0.030 &&
        d.gravity * deepest +
                d.law.f0 / d.law.kappa * exp(-d.law.kappa * deepest) <=
            first * (1 + 1e-9));
  CHECK_CLOSE(off, 0, 1e-9);
  CHECK(furthest <= d.travel * (1 + 1e-12) && furthest > 0.1 * d.travel);
  integrate_free(it);
  d.law.kappa = GSL_NAN;
  CHECK(drop_alloc(&it, &d, &(struct integrate_options){.method = "none"}, 1,
                   0) == GSL_EINVAL);
}

/* A method with the right Jacobian needs no more steps where nothing happens:
   near rest it soon leaves out whole periods of the contact, and a wrong one
   would have it take several in each. */
static void test_implicit(void) {
  struct drop d = standard(0.4);
  const double end = 100, rest = closed_rest_gap(&d.law, d.gravity);
  const double periods = end * sqrt(d.law.kappa * d.gravity) / (2 * M_PI);
  const struct integrate_options o = {
      .method = "msbdf", .control = "standard", .tol = 1e-6, .hinit = 1e-3};
  struct integrator *it;
  if (!CHECK(drop_alloc(&it, &d, &o, rest + 1e-3 / d.law.kappa, 0) ==
             GSL_SUCCESS))
    return;
  size_t steps = 0;
  while (integrate_time(it) < end && steps < 10000 &&
         CHECK(integrate_step(it) == GSL_SUCCESS))
    steps++;
  CHECK((double)steps < 0.2 * periods);
  CHECK_CLOSE(integrate_state(it)[0], rest, 1e-6 / d.law.kappa);
  integrate_free(it);
}

int main(void) {
  gsl_set_error_handler_off();
  test_slopes();
  test_mode();
  test_no_decay();
  test_bounce();
  test_implicit();
  return check_done();
}
