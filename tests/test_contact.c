/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact law, each equation by itself: against the paper's formula in long
   double, against values that follow by hand, and derivatives against
   differences. Whole beds are tests/test_dynamics.c's. */
#include <float.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "model/contact.h"
#include "sample.h"

enum { CASES = 2000 };

/* Rounding of a handful of operations, each relative to its result. */
static const double rounding = 8 * DBL_EPSILON;

static void vector(gsl_rng *rng, double length, double v[3]) {
  gsl_ran_dir_3d(rng, &v[0], &v[1], &v[2]);
  for (size_t k = 0; k < 3; k++)
    v[k] *= length;
}

static struct contact_law random_law(gsl_rng *rng) {
  return (struct contact_law){.f0 = uniform(rng, 0.1, 100),
                              .kappa = uniform(rng, 10, 500),
                              .psi = uniform(rng, 0.1, 30),
                              .restitution = uniform(rng, 0, 1),
                              .friction = uniform(rng, 0, 1),
                              .vmin = uniform(rng, 1e-3, 0.1),
                              .lmax = 0.1};
}

/* (2.1), and the energy that it is minus the derivative of. */
static void test_repulsion(gsl_rng *rng) {
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    const double l = uniform(rng, -0.05, 0.1);
    const double want = (double)(c.f0 * expl(-(long double)c.kappa * l));
    /* the exponent's rounding is that of the force */
    const double tol = rounding * (1 + c.kappa * fabs(l));
    CHECK_REL(contact_repulsion(&c, l), want, tol);
    /* central difference: h^2 kappa^2/6 of truncation, eps/(h kappa) of
       rounding */
    const double h = 1e-5 / c.kappa;
    const double slope =
        (contact_energy(&c, l + h) - contact_energy(&c, l - h)) / (2 * h);
    CHECK_REL(-slope, want, 1e-10 / 6 + 1e5 * tol);
  }
  const struct contact_law c = {.f0 = 10, .kappa = 150};
  CHECK(contact_repulsion(&c, 0) == 10);
  CHECK_REL(contact_repulsion(&c, M_LN2 / 150), 5., rounding);
  CHECK_REL(contact_energy(&c, 0), 10. / 150, rounding);
}

/* (2.4) */
static void test_rebound(gsl_rng *rng) {
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    const double v = uniform(rng, -1, 1) * pow(10, uniform(rng, -3, 1));
    const long double e2 = (long double)c.restitution * c.restitution;
    const long double want =
        e2 + 0.5L * (1 - e2) * (1 + tanhl((long double)c.psi * v));
    const double tol = rounding * (1 + fabs(c.psi * v));
    CHECK_CLOSE(contact_rebound(&c, v), (double)want, tol);
    /* and its slope: differences of 1e-5/psi are good to 1e-10 of psi, beside
       rounding over that width */
    const double h = 1e-5 / c.psi;
    const double slope =
        (contact_rebound(&c, v + h) - contact_rebound(&c, v - h)) / (2 * h);
    CHECK_CLOSE(contact_rebound_slope(&c, v), slope,
                c.psi * (1e-10 + 1e5 * tol));
  }
  struct contact_law c = {.psi = 10, .restitution = 0.4};
  CHECK_REL(contact_rebound(&c, 0), (1 + 0.16) / 2, rounding);
  CHECK_REL(contact_rebound(&c, 1e4), 1., rounding); /* approach: all of it */
  CHECK_REL(contact_rebound(&c, -1e4), 0.16, rounding); /* part: e^2 */
  CHECK(contact_rebound_slope(&c, 1e300) >= 0 &&
        contact_rebound_slope(&c, -1e300) < 1e-280);
  CHECK_REL(contact_rebound_slope(&c, 0), 0.5 * (1 - 0.16) * 10, rounding);
  c.restitution = 1;
  CHECK(contact_rebound(&c, -3) == 1 && contact_rebound(&c, 3) == 1);
}

/* (2.8), its value and slope at both ends, and Sigma/v without the division. */
static void test_limiter(gsl_rng *rng) {
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    const double v = c.vmin * uniform(rng, 0, 2), s = v / c.vmin;
    const double want = s < 1 ? 3 * s * s - 2 * s * s * s : 1;
    CHECK_CLOSE(contact_limiter(&c, v), want, rounding);
    CHECK_CLOSE(contact_slip(&c, v) * v, want, rounding);
  }
  const struct contact_law c = {.vmin = 0.01};
  CHECK(contact_slip(&c, 0) == 0 && contact_limiter(&c, 0) == 0);
  CHECK_REL(contact_limiter(&c, 0.005), 0.5, rounding);
  CHECK_REL(contact_limiter(&c, 0.01), 1., rounding);
  CHECK_REL(contact_limiter(&c, nextafter(0.01, 0)), 1., rounding);
  CHECK_REL(contact_limiter(&c, 7), 1., rounding);
  /* it is 3 s^2 from 0 on and leaves 1 by 3 (1 - s)^2: both slopes are 0 */
  for (double h = 1e-3; h > 1e-7; h /= 10) {
    CHECK_CLOSE(contact_limiter(&c, h * c.vmin), 3 * h * h, 3 * h * h * h);
    CHECK_CLOSE(1 - contact_limiter(&c, (1 - h) * c.vmin), 3 * h * h,
                3 * h * h * h + rounding);
  }
}

/* The unit vector of x and its length. */
static double normal_of(const double x[3], double n[3]) {
  const double d = vec3_norm(x);
  for (size_t k = 0; k < 3; k++)
    n[k] = x[k] / d;
  return d;
}

/* Two spheres of radius r: (2.2), (2.3), (2.6), (2.7) as the paper has them,
   in x_i - x_j, v_i - v_j and w_i + w_j. */
static void test_pair(gsl_rng *rng) {
  const double r = 0.1;
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    double x[3], v[3], w[3], rw[3], n[3], t[3], f[3], wxx[3];
    vector(rng, 2 * r + uniform(rng, -0.05, 0.05), x);
    vector(rng, pow(10, uniform(rng, -4, 1)), v);
    vector(rng, pow(10, uniform(rng, -4, 1)) / r, w);
    for (size_t k = 0; k < 3; k++)
      rw[k] = r * w[k];
    const double d = normal_of(x, n), size = vec3_norm(v) + vec3_norm(rw);
    const double rate = contact_tangent(n, v, rw, t);
    CHECK_CLOSE(rate, vec3_dot(x, v) / d, rounding * size); /* (2.2) */
    vec3_cross(w, x, wxx);
    double slip[3], largest = 0;
    for (size_t k = 0; k < 3; k++) { /* (2.7) */
      slip[k] = v[k] - rate / d * x[k] - r / d * wxx[k];
      largest = fmax(largest, fabs(slip[k] - t[k]));
    }
    CHECK_CLOSE(largest, 0, 4 * rounding * size);
    CHECK_CLOSE(vec3_dot(t, n), 0, 4 * rounding * size);
    /* (2.3): along x_i - x_j with the force of the gap, more on the approach */
    const double repulsion = contact_repulsion(&c, d - 2 * r);
    CHECK_REL(contact_normal(&c, d - 2 * r, rate),
              repulsion * contact_rebound(&c, -rate), rounding);
    CHECK(contact_normal(&c, d - 2 * r, -fabs(rate)) >=
          contact_normal(&c, d - 2 * r, fabs(rate)));
    /* (2.6): against the slip, phi F Sigma long; F without rho */
    contact_friction(&c, d - 2 * r, t, f);
    const double strength = c.friction * repulsion;
    CHECK_CLOSE(vec3_norm(f), strength * contact_limiter(&c, vec3_norm(t)),
                4 * rounding * strength);
    double cross[3];
    vec3_cross(f, t, cross);
    CHECK_CLOSE(vec3_norm(cross), 0, 4 * rounding * strength * vec3_norm(t));
    CHECK(vec3_dot(f, t) <= 0); /* it takes energy */
  }
}

/* A wall of outward normal N is a body at rest whose normal is -N: (2.5) and
   (2.10) from (2.3) and (2.7). */
static void test_wall(gsl_rng *rng) {
  const double r = 0.1;
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    double outward[3], n[3], v[3], w[3], rw[3], t[3], wxn[3];
    vector(rng, 1, outward);
    vector(rng, pow(10, uniform(rng, -4, 1)), v);
    vector(rng, pow(10, uniform(rng, -4, 1)) / r, w);
    for (size_t k = 0; k < 3; k++) {
      n[k] = -outward[k];
      rw[k] = r * w[k];
    }
    const double size = vec3_norm(v) + vec3_norm(rw);
    const double rate = contact_tangent(n, v, rw, t);
    const double vn = vec3_dot(v, outward);
    vec3_cross(w, outward, wxn);
    double largest = 0;
    for (size_t k = 0; k < 3; k++) /* (2.10) */
      largest = fmax(largest, fabs(v[k] - vn * outward[k] + r * wxn[k] - t[k]));
    CHECK_CLOSE(largest, 0, 4 * rounding * size);
    /* (2.5): F rho[v.N], along -N */
    const double l = uniform(rng, -0.05, 0.05);
    CHECK_REL(contact_normal(&c, l, rate),
              contact_repulsion(&c, l) * contact_rebound(&c, vn),
              rounding * (1 + c.psi * size));
  }
}

/* The friction force's derivative by the slip velocity, whose largest value
   sets the stiffness: phi F 1.5/vmin along it, at vmin/2. */
static void test_stiffness(gsl_rng *rng) {
  for (int q = 0; q < CASES; q++) {
    const struct contact_law c = random_law(rng);
    const double h = 1e-5 * c.vmin;
    double u[3], low[3], high[3], f_low[3], f_high[3];
    vector(rng, 1, u);
    for (size_t k = 0; k < 3; k++) {
      low[k] = (0.5 * c.vmin - h) * u[k];
      high[k] = (0.5 * c.vmin + h) * u[k];
    }
    contact_friction(&c, 0, low, f_low);
    contact_friction(&c, 0, high, f_high);
    const double slope = (vec3_dot(f_high, u) - vec3_dot(f_low, u)) / (2 * h);
    /* a cubic: the difference is wrong by 2 h^2/vmin^2 of 1.5 */
    CHECK_REL(slope, -1.5 * c.friction * c.f0 / c.vmin, 1e-9);
  }
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return 1;
  test_repulsion(rng);
  test_rebound(rng);
  test_limiter(rng);
  test_pair(rng);
  test_wall(rng);
  test_stiffness(rng);
  gsl_rng_free(rng);
  return check_done();
}
