/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed forms of friction in an impact and at rest against their integrals and
   equations, and how fast they come to Coulomb's: phi/e in an impact as psi
   grows, 2 phi/(1 + e^2) at rest as vmin falls. Runs against them are in
   tests/test_impacts.sh. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "model/closed_forms.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static double inverse(double u, void *law) {
  return 1 / contact_rebound(law, u);
}

static struct contact_law law_of(double e, double psi) {
  return (struct contact_law){.f0 = 10,
                              .kappa = 150,
                              .psi = psi,
                              .restitution = e,
                              .friction = 0.2,
                              .vmin = 0.01};
}

/* The impulse is the integral, whatever e and psi, and never overflows. */
static void test_impulse(void) {
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(1000);
  const double es[] = {0, 0.1, 0.4, 0.98, 1}, psis[] = {1e-3, 0.3, 10, 300};
  for (size_t i = 0; i < COUNT(es); i++)
    for (size_t k = 0; k < COUNT(psis); k++) {
      struct contact_law law = law_of(es[i], psis[k]);
      const double v0 = 0.5, v1 = es[i] > 0 ? 0.3 : 0.5 / psis[k];
      gsl_function f = {inverse, &law};
      double want, error;
      if (es[i] == 0 && psis[k] < 1)
        continue; /* such a sphere goes on for ever */
      CHECK(gsl_integration_qag(&f, -v1, v0, 0, 1e-12, 1000, GSL_INTEG_GAUSS61,
                                w, &want, &error) == GSL_SUCCESS);
      CHECK_REL(closed_impulse(&law, v0, v1), want, 1e-11);
    }
  gsl_integration_workspace_free(w);
  const struct contact_law law = law_of(0.4, 1e5);
  CHECK_REL(closed_impulse(&law, 10, 4), 10 * (1 + 1 / 0.4), 1e-5);
}

/* What friction takes in an impact, by phi (1 + e) v, comes to 1/e as 1/psi:
   the difference is (1 - e^2) ln(e^2)/(2 psi e^2 (1 + e) v), and a term of
   1/psi^2 that is a tenth when psi is ten times as large. */
static void test_impact(void) {
  const double es[] = {0.2, 0.4, 0.8};
  for (size_t i = 0; i < COUNT(es); i++) {
    const double e = es[i], v = 2;
    double rest = GSL_POSINF;
    for (double psi = 30; psi < 1e5; psi *= 10) {
      const struct contact_law law = law_of(e, psi);
      double v1, error;
      CHECK(closed_restitution(&law, v, &v1, &error) == GSL_SUCCESS);
      const double acts = closed_impulse(&law, v, v1) / ((1 + e) * v);
      const double first =
          (1 - e * e) * log(e * e) / (2 * psi * e * e * (1 + e) * v);
      CHECK(acts < 1 / e); /* it comes from below */
      const double second = fabs(acts - 1 / e - first) * psi;
      CHECK(second < 0.11 * rest);
      rest = second + 1e-10 * psi; /* and rounding */
    }
    CHECK(rest < 1e-4);
  }
}

/* Slip by a Runge-Kutta method of (2.8), in the unit of what is braked. */
static double slip_by_steps(const struct contact_law *law, double slip,
                            double braked) {
  enum { STEPS = 20000 };
  const double h = braked / STEPS;
  for (int k = 0; k < STEPS; k++) {
    const double a = -contact_limiter(law, slip);
    const double b = -contact_limiter(law, slip + 0.5 * h * a);
    const double c = -contact_limiter(law, slip + 0.5 * h * b);
    const double d = -contact_limiter(law, slip + h * c);
    slip += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return slip;
}

static void test_slip(void) {
  const struct contact_law law = law_of(0.4, 10);
  const double slips[] = {0, 0.002, 0.0099, 0.01, 0.05};
  const double braked[] = {0, 1e-3, 0.03, 0.049, 0.2};
  for (size_t i = 0; i < COUNT(slips); i++)
    for (size_t k = 0; k < COUNT(braked); k++) {
      double left = GSL_NAN;
      CHECK(closed_slip(slips[i], law.vmin, braked[k], &left) == GSL_SUCCESS);
      /* the step across the kink has an error of third order */
      CHECK_CLOSE(left, slip_by_steps(&law, slips[i], braked[k]), 1e-10);
    }
  double left = 42;
  CHECK(closed_slip(-1, law.vmin, 1, &left) == GSL_EDOM && left == 42);
  CHECK(closed_slip(1, law.vmin, -1, &left) == GSL_EDOM && left == 42);
}

/* The creep solves dv/dt = rate (1/2 - Sigma(v)) and begins with vmin. */
static void test_creep(void) {
  const struct contact_law law = law_of(0.4, 10);
  const double rate = 3, unit = law.vmin / rate;
  CHECK_REL(closed_creep(0, law.vmin, rate), law.vmin, 1e-15);
  for (double t = 0.1 * unit; t < 10 * unit; t *= 2) {
    const double v = closed_creep(t, law.vmin, rate), h = 1e-4 * unit;
    const double slope = (closed_creep(t + h, law.vmin, rate) -
                          closed_creep(t - h, law.vmin, rate)) /
                         (2 * h);
    /* h^2 of the third derivative, some 3^3/6 of vmin by unit^3 */
    CHECK_CLOSE(slope, rate * (0.5 - contact_limiter(&law, v)), 1e-7 * rate);
  }
  CHECK_REL(closed_creep(30 * unit, law.vmin, rate), law.vmin / 2, 1e-15);
}

int main(void) {
  gsl_set_error_handler_off();
  test_impulse();
  test_impact();
  test_slip();
  test_creep();
  return check_done();
}
