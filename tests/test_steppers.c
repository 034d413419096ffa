/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta step types one step at a time, and the step controls.
   merson and dopri5 stand in one table with three of GSL's own methods: what
   holds for those as well is a test of the tests.

   An observed order is the slope of log error over log step in a window: the
   last octave of step sizes, in quarters, whose error is still a hundred times
   the rounding of the computation. There rounding tilts the line by some 0.02
   at most, and the next power of h, which tilts it too, is as small as it can
   be. */
#include <complex.h>
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_sf_elljac.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "steppers/control.h"
#include "steppers/dopri5.h"
#include "steppers/merson.h"
#include "steppers/verlet.h"

#define ULPS(n) ((n)*DBL_EPSILON)
#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { DIM = 17 }; /* the most of any problem here */

struct stepper {
  const char *name;
  const gsl_odeiv2_step_type *const *type;
  unsigned order;     /* of the solution */
  unsigned linear;    /* estimate = O(h^this), linear, constant coefficients */
  unsigned nonlinear; /* ... on any other problem */
  unsigned level;     /* order() */
  size_t evaluations; /* of an apply with both derivatives */
  bool fsal;          /* dydt_out costs nothing */
  bool ours;
  double slack; /* of an observed order */
};

/* With the error C h^p (1 + a h + ...) a window's slope is off by a h. Orders 4
   and 5 have their windows at steps well below 1/a; order 8 is at rounding
   before that, so that it only shows that it is above 5. */

static const struct stepper steppers[] = {
    {"merson", &merson, 4, 5, 4, 4, 5, false, true, 0.25},
    {"dopri5", &dopri5, 5, 5, 5, 5, 6, true, true, 0.25},
    {"rkf45", &gsl_odeiv2_step_rkf45, 5, 5, 5, 5, 6, false, false, 0.25},
    {"rkck", &gsl_odeiv2_step_rkck, 5, 5, 5, 5, 6, false, false, 0.25},
    {"rk8pd", &gsl_odeiv2_step_rk8pd, 8, 8, 8, 8, 13, false, false, 2}};

static double largest(size_t dim, const double x[]) {
  double most = 0;
  for (size_t i = 0; i < dim; i++)
    if (!(fabs(x[i]) <= most)) /* NaN stays */
      most = fabs(x[i]);
  return most;
}

static double distance(size_t dim, const double x[], const double y[]) {
  double d[DIM];
  for (size_t i = 0; i < dim; i++)
    d[i] = x[i] - y[i];
  return largest(dim, d);
}

static bool same(size_t dim, const double x[], const double y[]) {
  return !memcmp(x, y, dim * sizeof *x);
}

/* --- problems with exact solutions -----------------------------------------*/

/* No autonomous scalar ones but the logistic: on y' = y^2 or y' = exp(-y)
   dopri5's error constant all but vanishes and h^6 shows. */

struct problem {
  const char *name;
  size_t dim;
  bool linear; /* y' = A y: what Merson's estimate is made for */
  int (*f)(double t, const double y[], double dydt[], void *params);
  void (*exact)(double t, double y[]);
  double end;
};

static int decay_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = -y[0];
  return GSL_SUCCESS;
}

static void decay(double t, double y[]) {
  y[0] = exp(-t);
}

static int oscillator_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = 2 * y[1];
  dydt[1] = -2 * y[0];
  return GSL_SUCCESS;
}

static void oscillator(double t, double y[]) {
  y[0] = sin(2 * t);
  y[1] = cos(2 * t);
}

/* eigenvalues -1 +- 2i and -3 */
static int three_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = -y[0] + 2 * y[1];
  dydt[1] = -2 * y[0] - y[1];
  dydt[2] = y[0] + y[1] - 3 * y[2];
  return GSL_SUCCESS;
}

static void three(double t, double y[]) { /* from (1, 2, -1) */
  const double c = exp(-t) * cos(2 * t), s = exp(-t) * sin(2 * t);
  y[0] = c + 2 * s;
  y[1] = 2 * c - s;
  y[2] = 0.5 * c + s - 1.5 * exp(-3 * t);
}

static int logistic_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = y[0] * (1 - y[0]);
  return GSL_SUCCESS;
}

static void logistic(double t, double y[]) { /* from 1/5 */
  y[0] = 1 / (1 + 4 * exp(-t));
}

static int cube_f(double t, const double y[], double dydt[], void *p) {
  (void)p;
  dydt[0] = -t * y[0] * y[0] * y[0];
  return GSL_SUCCESS;
}

static void cube(double t, double y[]) {
  y[0] = 1 / sqrt(1 + t * t);
}

static const double modulus = 0.64; /* m = k^2 of the elliptic functions */

/* Euler's free rigid body */
static int rigid_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = y[1] * y[2];
  dydt[1] = -y[0] * y[2];
  dydt[2] = -modulus * y[0] * y[1];
  return GSL_SUCCESS;
}

static void rigid(double t, double y[]) {
  if (gsl_sf_elljac_e(t, modulus, &y[0], &y[1], &y[2]) != GSL_SUCCESS)
    y[0] = GSL_NAN;
}

static int pendulum_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = y[1];
  dydt[1] = -sin(y[0]);
  return GSL_SUCCESS;
}

static void pendulum(double t, double y[]) {
  double sn, cn, dn;
  if (gsl_sf_elljac_e(t, modulus, &sn, &cn, &dn) != GSL_SUCCESS)
    sn = GSL_NAN;
  y[0] = 2 * asin(sqrt(modulus) * sn);
  y[1] = 2 * sqrt(modulus) * cn;
}

static int driven_f(double t, const double y[], double dydt[], void *p) {
  (void)p;
  dydt[0] = -y[0] + cos(t);
  return GSL_SUCCESS;
}

static void driven(double t, double y[]) {
  y[0] = 0.5 * (cos(t) + sin(t) + exp(-t));
}

static int bell_f(double t, const double y[], double dydt[], void *p) {
  (void)p;
  dydt[0] = -2 * t * y[0] * y[0];
  return GSL_SUCCESS;
}

static void bell(double t, double y[]) {
  y[0] = 1 / (1 + t * t);
}

static int wave_f(double t, const double y[], double dydt[], void *p) {
  (void)p;
  dydt[0] = y[0] * cos(t);
  return GSL_SUCCESS;
}

static void wave(double t, double y[]) {
  y[0] = exp(sin(t));
}

static const struct problem problems[] = {
    {"y' = -y", 1, true, decay_f, decay, 6},
    {"oscillator", 2, true, oscillator_f, oscillator, 6},
    {"3x3", 3, true, three_f, three, 6},
    {"logistic", 1, false, logistic_f, logistic, 8},
    {"-t y^3", 1, false, cube_f, cube, 4},
    {"rigid body", 3, false, rigid_f, rigid, 8},
    {"pendulum", 2, false, pendulum_f, pendulum, 8},
    {"-y + cos t", 1, false, driven_f, driven, 8},
    {"-2 t y^2", 1, false, bell_f, bell, 4},
    {"y cos t", 1, false, wave_f, wave, 8}};

static const struct problem *const pendulum_problem = &problems[6];

static gsl_odeiv2_system system_of(const struct problem *p) {
  return (gsl_odeiv2_system){.function = p->f, .dimension = p->dim};
}

/* One step of a stepper of its own, derivatives as for evolve. */
static int one_step(const struct stepper *s, const gsl_odeiv2_system *sys,
                    double t, double h, double y[], double yerr[],
                    double dydt_out[]) {
  double dydt[DIM];
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, sys->dimension);
  int status = GSL_ODEIV_FN_EVAL(sys, t, y, dydt);
  if (status == GSL_SUCCESS)
    status = gsl_odeiv2_step_apply(step, t, h, y, yerr, dydt, dydt_out, sys);
  gsl_odeiv2_step_free(step);
  return status;
}

/* --- order of convergence --------------------------------------------------*/

/* The error at a step size of about h, which becomes the exact one, and the
   size of its rounding. */
typedef double measure(const void *what, double *h, double *rounding);

static double observed_order(measure *error, const void *what, double h0) {
  enum { MOST = 56, WINDOW = 5 }; /* h0 / 2^14 is none too small */
  double x[MOST], y[MOST];
  int n = 0;
  for (; n < MOST; n++) {
    double h = h0 * pow(2, -0.25 * n), rounding;
    const double e = error(what, &h, &rounding);
    if (e <= 100 * rounding)
      break;
    x[n] = log(h);
    y[n] = log(e);
  }
  double c, slope, cov00, cov01, cov11, sumsq;
  if (n < WINDOW || n == MOST)
    return GSL_NAN;
  gsl_fit_linear(x + n - WINDOW, 1, y + n - WINDOW, 1, WINDOW, &c, &slope,
                 &cov00, &cov01, &cov11, &sumsq);
  return slope;
}

struct run {
  const struct stepper *stepper;
  const struct problem *problem;
};

/* Largest error at any node of an integration with fixed steps. */
static double global_error(const void *what, double *h, double *rounding) {
  const struct run *r = what;
  const struct problem *p = r->problem;
  const gsl_odeiv2_system sys = system_of(p);
  const size_t n = (size_t)ceil(p->end / *h);
  *h = p->end / (double)n;
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*r->stepper->type, p->dim);
  double y[DIM], yerr[DIM], dydt[DIM], exact[DIM], worst = 0, size = 0;
  p->exact(0, y);
  p->f(0, y, dydt, NULL);
  for (size_t k = 0; k < n; k++) {
    if (gsl_odeiv2_step_apply(step, (double)k * *h, *h, y, yerr, dydt, dydt,
                              &sys) != GSL_SUCCESS)
      worst = GSL_NAN;
    p->exact((double)(k + 1) * *h, exact);
    const double e = distance(p->dim, y, exact);
    if (!(e <= worst))
      worst = e;
    size = GSL_MAX(size, largest(p->dim, exact));
  }
  gsl_odeiv2_step_free(step);
  /* a random walk of n roundings, and some of the exact solution's own */
  *rounding = DBL_EPSILON * size * (4 + sqrt((double)n));
  return worst;
}

/* Steps of h from points of the exact solution: the largest estimate, local
   error and difference of the two. Eight points, so that a zero of one does
   not matter. */
struct local {
  double estimate, error, difference, rounding;
};

static struct local local_error(const struct run *r, double h) {
  const struct problem *p = r->problem;
  const gsl_odeiv2_system sys = system_of(p);
  struct local worst = {0};
  for (int k = 0; k < 8; k++) {
    const double t = (p->end - h) * k / 8;
    double y[DIM], yerr[DIM], out[DIM], exact[DIM], error[DIM];
    p->exact(t, y);
    if (one_step(r->stepper, &sys, t, h, y, yerr, out) != GSL_SUCCESS)
      return (struct local){GSL_NAN, GSL_NAN, GSL_NAN, GSL_NAN};
    p->exact(t + h, exact);
    for (size_t i = 0; i < p->dim; i++)
      error[i] = y[i] - exact[i];
    worst.estimate = GSL_MAX(worst.estimate, largest(p->dim, yerr));
    worst.error = GSL_MAX(worst.error, largest(p->dim, error));
    worst.difference = GSL_MAX(worst.difference, distance(p->dim, error, yerr));
    worst.rounding =
        GSL_MAX(worst.rounding, 4 * DBL_EPSILON * largest(p->dim, exact));
  }
  return worst;
}

static double estimate(const void *what, double *h, double *rounding) {
  const struct local l = local_error(what, *h);
  *rounding = l.rounding * *h; /* the estimate is h times a sum of slopes */
  return l.estimate;
}

static double estimate_difference(const void *what, double *h,
                                  double *rounding) {
  const struct local l = local_error(what, *h);
  *rounding = l.rounding;
  return l.difference;
}

static void test_orders(void) {
  printf("%-14s", "order observed");
  for (size_t i = 0; i < COUNT(steppers); i++)
    printf("%16s", steppers[i].name);
  putchar('\n');
  for (size_t k = 0; k < COUNT(problems); k++) {
    printf("%-14s", problems[k].name);
    for (size_t i = 0; i < COUNT(steppers); i++) {
      const struct stepper *s = &steppers[i];
      const struct run r = {s, &problems[k]};
      const double h0 = problems[k].end / 8;
      const double p = observed_order(global_error, &r, h0);
      const double q = observed_order(estimate, &r, h0);
      printf("%8.2f (%4.2f)", p, q);
      const unsigned expected = problems[k].linear ? s->linear : s->nonlinear;
      CHECK_CLOSE(p, s->order, s->slack);
      CHECK_CLOSE(q, expected, s->slack);
    }
    putchar('\n');
  }
}

/* Lotka-Volterra: no exact solution, but an invariant, whose drift is of the
   method's order. */
static int predator_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  dydt[0] = y[0] * (1 - y[1]);
  dydt[1] = y[1] * (y[0] - 1);
  return GSL_SUCCESS;
}

static double predator_invariant(const double y[]) {
  return y[0] - log(y[0]) + y[1] - log(y[1]);
}

static double invariant_drift(const void *what, double *h, double *rounding) {
  const struct stepper *s = what;
  const gsl_odeiv2_system sys = {.function = predator_f, .dimension = 2};
  const double end = 6; /* about one revolution */
  const size_t n = (size_t)ceil(end / *h);
  *h = end / (double)n;
  double y[2] = {2, 1}, yerr[2], dydt[2], worst = 0;
  const double before = predator_invariant(y);
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, 2);
  predator_f(0, y, dydt, NULL);
  for (size_t k = 0; k < n; k++) {
    if (gsl_odeiv2_step_apply(step, (double)k * *h, *h, y, yerr, dydt, dydt,
                              &sys) != GSL_SUCCESS)
      worst = GSL_NAN;
    const double drift = fabs(predator_invariant(y) - before);
    if (!(drift <= worst))
      worst = drift;
  }
  gsl_odeiv2_step_free(step);
  *rounding = DBL_EPSILON * before * (4 + sqrt((double)n));
  return worst;
}

static void test_invariant(void) {
  printf("%-14s", "predator");
  for (size_t i = 0; i < COUNT(steppers); i++) {
    const double p = observed_order(invariant_drift, &steppers[i], 1);
    printf("%8.2f       ", p);
    CHECK_CLOSE(p, steppers[i].order, steppers[i].slack);
  }
  putchar('\n');
}

/* Merson's estimate against the true local error: equal to leading order, sign
   included, for y' = A y; too large for anything else. */
static void test_merson_estimate(void) {
  printf("%-14s", "E - error");
  for (size_t k = 0; k < COUNT(problems); k++) {
    const struct run r = {&steppers[0], &problems[k]};
    if (problems[k].linear) {
      /* both are -(hA)^5/720 y + O(h^6) */
      const double p = observed_order(estimate_difference, &r, 0.25);
      printf("%8.2f", p);
      CHECK_CLOSE(p, 6, r.stepper->slack);
    } else
      for (double h = problems[k].end / 16; h > 1e-2; h /= 2) {
        const struct local l = local_error(&r, h);
        CHECK(l.error > 0 && l.estimate > l.error);
      }
  }
  putchar('\n');
}

/* --- order conditions ------------------------------------------------------*/

/* Rooted trees by the roots of their branches. With y_tree' = product of the
   branches' y, all y = 0 at the start, one step of h = 1 gives the elementary
   weight of each tree, and the exact solution 1/density: every order condition
   is one component. */
struct tree {
  int order, branches;
  int branch[4];
};

static const struct tree trees[DIM] = {
    {1, 0, {0}},          {2, 1, {0}},       {3, 2, {0, 0}}, {3, 1, {1}},
    {4, 3, {0, 0, 0}},    {4, 2, {0, 1}},    {4, 1, {2}},    {4, 1, {3}},
    {5, 4, {0, 0, 0, 0}}, {5, 3, {0, 0, 1}}, {5, 2, {0, 2}}, {5, 2, {0, 3}},
    {5, 2, {1, 1}},       {5, 1, {4}},       {5, 1, {5}},    {5, 1, {6}},
    {5, 1, {7}}};
/* the trees without ramification: all that a linear problem knows */
static const size_t tall[] = {0, 1, 3, 7, 16};

static int trees_f(double t, const double y[], double dydt[], void *p) {
  (void)t, (void)p;
  for (size_t k = 0; k < DIM; k++) {
    dydt[k] = 1;
    for (int b = 0; b < trees[k].branches; b++)
      dydt[k] *= y[trees[k].branch[b]];
  }
  return GSL_SUCCESS;
}

static double density(size_t k) {
  double product = trees[k].order;
  for (int b = 0; b < trees[k].branches; b++)
    product *= density((size_t)trees[k].branch[b]);
  return product;
}

/* Coefficients are below 12, a stage has at most 12 of them and the weight of
   a tree at most 4 such sums in a row, each with its roundings; cancellation
   in one leaves a stage of size 1. */
static const double weight_tolerance = ULPS(4 * 12 * 12);

static void test_order_conditions(void) {
  const gsl_odeiv2_system sys = {.function = trees_f, .dimension = DIM};
  for (size_t i = 0; i < COUNT(steppers); i++) {
    const struct stepper *s = &steppers[i];
    double y[DIM] = {0}, yerr[DIM], out[DIM];
    if (!CHECK(one_step(s, &sys, 0, 1, y, yerr, out) == GSL_SUCCESS))
      continue;
    double worst = 0; /* of the conditions of the next order */
    size_t met = 0;
    for (size_t k = 0; k < DIM; k++)
      if (trees[k].order <= (int)s->order)
        met += (size_t)CHECK_CLOSE(y[k], 1 / density(k), weight_tolerance);
      else if (trees[k].order == (int)s->order + 1)
        worst = GSL_MAX(worst, fabs(y[k] - 1 / density(k)));
    CHECK(met == (s->order == 4 ? 8 : 17));
    /* the order is no higher: only to be seen below the last order here */
    CHECK(s->order >= 5 || worst > 1e-3);

    /* the estimate: zero below its order, and not zero there */
    double first = 0;
    for (size_t k = 0; k < DIM; k++)
      if (trees[k].order < (int)s->nonlinear)
        CHECK_CLOSE(yerr[k], 0, weight_tolerance);
      else if (trees[k].order == (int)s->nonlinear)
        first = GSL_MAX(first, fabs(yerr[k]));
    CHECK(s->nonlinear > 5 || first > 1e-4);
    for (size_t k = 0; k + 1 < s->linear && k < COUNT(tall); k++)
      CHECK_CLOSE(yerr[tall[k]], 0, weight_tolerance);
  }
}

/* What the right-hand side was asked for. */
struct calls {
  size_t count;
  double t[16], y[16];
};

static int clock_f(double t, const double y[], double dydt[], void *params) {
  struct calls *c = params;
  if (c->count < COUNT(c->t)) {
    c->t[c->count] = t;
    c->y[c->count] = y[0];
  }
  c->count++;
  dydt[0] = 1;
  return GSL_SUCCESS;
}

/* With y' = 1 from y = 0 at t = 0 a stage's argument is its row sum, to be
   the stage's time c. The row sums as printed by Christiansen and by Dormand
   and Prince. */
static void test_row_sums(void) {
  static const double published[2][7] = {
      {0, 1. / 3, 1. / 3, 1. / 2, 1, 1},
      {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1}};
  for (size_t i = 0; i < COUNT(steppers); i++) {
    struct calls c = {0};
    const gsl_odeiv2_system sys = {
        .function = clock_f, .dimension = 1, .params = &c};
    double y[1] = {0}, yerr[1], out[1];
    CHECK(one_step(&steppers[i], &sys, 0, 1, y, yerr, out) == GSL_SUCCESS);
    CHECK(c.count == steppers[i].evaluations + 1);
    for (size_t k = 0; k < c.count && k < COUNT(c.t); k++) {
      CHECK_CLOSE(c.y[k], c.t[k], weight_tolerance);
      if (steppers[i].ours)
        CHECK_CLOSE(c.t[k], published[i][k], ULPS(1));
    }
    CHECK_CLOSE(y[0], 1, weight_tolerance);
    CHECK_CLOSE(yerr[0], 0, weight_tolerance);
  }
}

/* --- linear stability ------------------------------------------------------*/

/* y' = z y as a real system */
static int complex_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const double complex z = *(const double complex *)params;
  dydt[0] = creal(z) * y[0] - cimag(z) * y[1];
  dydt[1] = cimag(z) * y[0] + creal(z) * y[1];
  return GSL_SUCCESS;
}

/* R(hz), and the estimate for y = 1 */
static double complex growth(const struct stepper *s, double complex z,
                             double h, double complex *error) {
  const gsl_odeiv2_system sys = {
      .function = complex_f, .dimension = 2, .params = &z};
  double y[2] = {1, 0}, yerr[2], out[2];
  if (one_step(s, &sys, 0, h, y, yerr, out) != GSL_SUCCESS)
    return *error = GSL_NAN;
  *error = yerr[0] + I * yerr[1];
  return y[0] + I * y[1];
}

static double complex polynomial(const double *c, size_t n, double complex z) {
  double complex sum = 0;
  while (n--)
    sum = sum * z + c[n];
  return sum;
}

/* Dormand and Prince's estimate is the fifth less the fourth order's R; the
   latter ends 1097/120000 z^5 + 161/120000 z^6 + z^7/24000. */
static void test_stability_polynomial(void) {
  static const struct {
    double r[8], e[8];
  } want[] = {
      {{1, 1, 1. / 2, 1. / 6, 1. / 24, 1. / 144}, {0, 0, 0, 0, 0, -1. / 720}},
      {{1, 1, 1. / 2, 1. / 6, 1. / 24, 1. / 120, 1. / 600},
       {0, 0, 0, 0, 0, -97. / 120000, 39. / 120000, -1. / 24000}}};
  for (size_t i = 0; i < COUNT(want); i++)
    for (int k = 0; k < 48; k++) {
      const double size = 0.25 * (1 + k % 16);
      const double complex z = size * cexp(I * (0.3 + 2.1 * k));
      double complex error, back_error;
      const double complex r = growth(&steppers[i], z, 1, &error);
      /* a stage is at most (1 + 25 |z|) of the one before, 25 being
         Dormand-Prince's largest row, but of the size of R itself where the
         order conditions hold: rounding as for the trees, times the sum of
         the terms */
      const double tol = weight_tolerance * exp(size) * (1 + size);
      CHECK_CLOSE(cabs(r - polynomial(want[i].r, 8, z)), 0, tol);
      CHECK_CLOSE(cabs(error - polynomial(want[i].e, 8, z)), 0, tol);
      /* backwards in time: only the product h z counts */
      const double complex back = growth(&steppers[i], -z, -1, &back_error);
      CHECK_CLOSE(cabs(back - r), 0, tol);
      CHECK_CLOSE(cabs(back_error - error), 0, tol);
    }
}

/* The first point along a direction where |R| exceeds 1. */
static double stability_limit(const struct stepper *s,
                              double complex direction) {
  /* |R|^2 - 1 on the imaginary axis starts as y^6/72 and less: rounding
     must not pass for growth */
  const double one = 1 + 1e-13;
  double complex error;
  double inside = 0, outside = 0.5;
  while (cabs(growth(s, outside * direction, 1, &error)) <= one) {
    inside = outside;
    outside += 1. / 64;
    if (outside > 20)
      return GSL_NAN;
  }
  while (outside - inside > 1e-12) {
    const double middle = 0.5 * (inside + outside);
    if (cabs(growth(s, middle * direction, 1, &error)) <= one)
      inside = middle;
    else
      outside = middle;
  }
  return inside;
}

static void test_stability_limits(void) {
  const struct stepper *m = &steppers[0], *d = &steppers[1];
  const double real[] = {stability_limit(m, -1), stability_limit(d, -1)};
  const double imaginary[] = {stability_limit(m, I), stability_limit(d, I)};
  printf("stable to -%.4f, %.4fi (merson), -%.4f, %.4fi (dopri5)\n", real[0],
         imaginary[0], real[1], imaginary[1]);
  /* figures in print have three decimals; |R(iy)| = 1 at 2 sqrt(3) exactly,
     with a slope of 2, so rounding and the margin move it by 1e-12 */
  CHECK_CLOSE(real[0], 3.548, 5e-4);
  CHECK_CLOSE(imaginary[0], 2 * sqrt(3), 1e-11);
  CHECK_CLOSE(real[1], 3.307, 1e-3);
  CHECK_CLOSE(imaginary[1], 0.997, 1e-3);
}

/* --- the contract of a step type -------------------------------------------*/

static void test_type(void) {
  for (size_t i = 0; i < COUNT(steppers); i++) {
    const struct stepper *s = &steppers[i];
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, 1);
    CHECK(!strcmp(gsl_odeiv2_step_name(step), s->name));
    CHECK(gsl_odeiv2_step_order(step) == s->level);
    CHECK((*s->type)->can_use_dydt_in == 1);
    CHECK(gsl_odeiv2_step_reset(step) == GSL_SUCCESS);
    const gsl_odeiv2_driver driver = {0};
    CHECK(gsl_odeiv2_step_set_driver(step, &driver) == GSL_SUCCESS);
    gsl_odeiv2_step_free(step);
  }
}

/* Right-hand side of a problem that counts its calls and fails at one, writing
   rubbish. */
struct failing {
  const struct problem *problem;
  size_t calls, fail_at; /* 0: never */
  int code;
};

static int failing_f(double t, const double y[], double dydt[], void *params) {
  struct failing *f = params;
  if (++f->calls != f->fail_at)
    return f->problem->f(t, y, dydt, NULL);
  for (size_t i = 0; i < f->problem->dim; i++)
    dydt[i] = GSL_NAN;
  return f->code;
}

/* dydt_in only saves a call, dydt_out is f at the new point, and neither moves
   a bit of the result; nor does what the stepper did before. */
static void test_derivatives(void) {
  for (size_t k = 0; k < COUNT(problems); k++)
    for (size_t i = 0; i < COUNT(steppers); i++) {
      const struct problem *p = &problems[k];
      const struct stepper *s = &steppers[i];
      struct failing f = {.problem = p};
      const gsl_odeiv2_system sys = {failing_f, NULL, p->dim, &f};
      gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, p->dim);
      const double t = 0.3, h = 0.1;
      double start[DIM], in[DIM], y[4][DIM], yerr[4][DIM], out[4][DIM], at[DIM];
      p->exact(t, start);
      p->f(t, start, in, NULL);
      for (int way = 0; way < 4; way++) {
        const bool with_in = way & 1, with_out = way & 2;
        memcpy(y[way], start, sizeof start);
        f.calls = 0;
        CHECK(gsl_odeiv2_step_apply(
                  step, t, h, y[way], yerr[way], with_in ? in : NULL,
                  with_out ? out[way] : NULL, &sys) == GSL_SUCCESS);
        CHECK(f.calls == s->evaluations + !with_in - (!with_out && !s->fsal));
        CHECK(same(p->dim, y[way], y[0]));
        CHECK(same(p->dim, yerr[way], yerr[0]));
        p->f(t + h, y[way], at, NULL);
        CHECK(!with_out || same(p->dim, out[way], at));
        if (way == 1)
          CHECK(gsl_odeiv2_step_reset(step) == GSL_SUCCESS);
      }
      gsl_odeiv2_step_free(step);
    }
}

/* FSAL: fed with its own dydt_out, dopri5 makes 6 n + 1 evaluations in n
   steps; any other derivative at the end would show in the next step. */
static void test_chain(void) {
  for (size_t i = 0; i < COUNT(steppers); i++) {
    const struct stepper *s = &steppers[i];
    const struct problem *p = pendulum_problem;
    struct failing f = {.problem = p};
    const gsl_odeiv2_system sys = {failing_f, NULL, p->dim, &f};
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, p->dim);
    double chained[DIM], fresh[DIM], yerr[DIM], dydt[DIM];
    p->exact(0, chained);
    p->exact(0, fresh);
    failing_f(0, chained, dydt, &f);
    enum { STEPS = 10 };
    for (int k = 0; k < STEPS; k++)
      CHECK(gsl_odeiv2_step_apply(step, 0.1 * k, 0.1, chained, yerr, dydt, dydt,
                                  &sys) == GSL_SUCCESS);
    CHECK(f.calls == 1 + STEPS * s->evaluations);
    for (int k = 0; k < STEPS; k++)
      CHECK(gsl_odeiv2_step_apply(step, 0.1 * k, 0.1, fresh, yerr, NULL, NULL,
                                  &sys) == GSL_SUCCESS);
    CHECK(same(p->dim, chained, fresh));
    gsl_odeiv2_step_free(step);
  }
}

/* At each call in turn: apply stops there, returns the code, has not touched y
   and is as good as new. */
static void test_failures(void) {
  const int codes[] = {GSL_EBADFUNC, GSL_EFAULT, GSL_ENOMEM, GSL_FAILURE};
  const struct problem *p = pendulum_problem;
  for (size_t i = 0; i < COUNT(steppers); i++)
    for (int way = 0; way < 4; way++) {
      const struct stepper *s = &steppers[i];
      const bool with_in = way & 1, with_out = way & 2;
      struct failing f = {.problem = p};
      const gsl_odeiv2_system sys = {failing_f, NULL, p->dim, &f};
      double start[DIM], in[DIM], good[DIM], y[DIM], yerr[DIM], out[DIM];
      p->exact(0.3, start);
      p->f(0.3, start, in, NULL);
      gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, p->dim);
      memcpy(good, start, sizeof good);
      CHECK(gsl_odeiv2_step_apply(step, 0.3, 0.1, good, yerr,
                                  with_in ? in : NULL, with_out ? out : NULL,
                                  &sys) == GSL_SUCCESS);
      const size_t calls = f.calls;
      for (size_t k = 1; k <= calls; k++) {
        f = (struct failing){p, 0, k, codes[k % COUNT(codes)]};
        memcpy(y, start, sizeof y);
        CHECK(gsl_odeiv2_step_apply(step, 0.3, 0.1, y, yerr,
                                    with_in ? in : NULL, with_out ? out : NULL,
                                    &sys) == codes[k % COUNT(codes)]);
        CHECK(f.calls == k);
        CHECK(same(p->dim, y, start));
        f.fail_at = 0;
        CHECK(gsl_odeiv2_step_apply(step, 0.3, 0.1, y, yerr,
                                    with_in ? in : NULL, with_out ? out : NULL,
                                    &sys) == GSL_SUCCESS);
        CHECK(same(p->dim, y, good));
      }
      gsl_odeiv2_step_free(step);
    }
}

/* y_i' = -rate_i y_i + y_i^2 */
static int many_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const size_t dim = *(const size_t *)params;
  for (size_t i = 0; i < dim; i++)
    dydt[i] = y[i] * (y[i] - (double)(i % 97) / 97);
  return GSL_SUCCESS;
}

/* Unknowns that know nothing of each other have the same bits in any company;
   dimensions on both sides of a vector's length. */
static void test_dimensions(void) {
  enum { MOST = 20011 };
  double *y = calloc(4 * MOST, sizeof *y), *yerr = y + MOST;
  double *out = y + 2 * MOST, *reference = y + 3 * MOST;
  for (size_t i = 0; i < 2; i++) {
    const size_t dims[] = {MOST, 1, 2, 3, 7, 8, 9, 97, 1023};
    for (size_t k = 0; k < COUNT(dims); k++) {
      size_t dim = dims[k];
      const gsl_odeiv2_system sys = {many_f, NULL, dim, &dim};
      gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*steppers[i].type, dim);
      for (size_t j = 0; j < dim; j++)
        y[j] = 0.5;
      CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, NULL, out, &sys) ==
            GSL_SUCCESS);
      if (k == 0)
        memcpy(reference, y, dim * sizeof *y);
      CHECK(same(dim, y, reference));
      for (size_t j = 97; j < dim; j++)
        if (y[j] != y[j - 97] || yerr[j] != yerr[j - 97]) {
          CHECK(!"equal unknowns, equal bits");
          break;
        }
      gsl_odeiv2_step_free(step);
    }
  }
  free(y);
}

/* --- velocity Verlet -------------------------------------------------------*/

/* Rows of two positions, two velocities and a spin, two bodies: a pendulum in
   each position, the last spin driven by position and time. */
enum { ROW = 5, BODIES = 2 };

struct bodies {
  double damping;
  size_t calls, fail_at;
};

static int bodies_f(double t, const double y[], double dydt[], void *params) {
  struct bodies *b = params;
  if (++b->calls == b->fail_at) {
    for (int i = 0; i < BODIES * ROW; i++)
      dydt[i] = GSL_NAN;
    return GSL_EBADFUNC;
  }
  for (int i = 0; i < BODIES * ROW; i += ROW) {
    for (int c = 0; c < 2; c++) {
      dydt[i + c] = y[i + 2 + c];
      dydt[i + 2 + c] = -sin(y[i + c]) - b->damping * y[i + 2 + c];
    }
    dydt[i + 4] = cos(t);
  }
  return GSL_SUCCESS;
}

/* the four pendulums, each from another time */
static const double phase[BODIES][2] = {{0, 0.5}, {1, 2}};

static void bodies_exact(double t, double y[]) {
  for (int i = 0; i < BODIES; i++) {
    for (int c = 0; c < 2; c++) {
      double one[2];
      pendulum(t + phase[i][c], one);
      y[i * ROW + c] = one[0];
      y[i * ROW + 2 + c] = one[1];
    }
    y[i * ROW + 4] = sin(t);
  }
}

/* n steps of h from the exact solution at 0; the largest error on the way, or
   NaN. Every step makes one evaluation. */
static double verlet_run(struct bodies *b, size_t n, double h, double y[]) {
  const gsl_odeiv2_system sys = {bodies_f, NULL, BODIES * ROW, b};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(verlet, sys.dimension);
  verlet_set_layout(step, ROW, 2);
  double yerr[DIM], dydt[DIM], exact[DIM], worst = 0;
  bodies_exact(0, y);
  bodies_f(0, y, dydt, b);
  for (size_t k = 0; k < n; k++) {
    if (gsl_odeiv2_step_apply(step, (double)k * h, h, y, yerr, dydt, dydt,
                              &sys) != GSL_SUCCESS ||
        largest(sys.dimension, yerr) != 0)
      worst = GSL_NAN;
    bodies_exact((double)(k + 1) * h, exact);
    const double e = distance(sys.dimension, y, exact);
    if (!(e <= worst))
      worst = e;
  }
  gsl_odeiv2_step_free(step);
  return worst;
}

static double verlet_error(const void *what, double *h, double *rounding) {
  (void)what;
  struct bodies b = {0};
  const size_t n = (size_t)ceil(4 / *h);
  *h = 4 / (double)n;
  double y[DIM];
  const double e = verlet_run(&b, n, *h, y);
  if (b.calls != n + 1)
    return GSL_NAN;
  /* down to some ten thousand steps, before rounding would end it */
  *rounding = fmax(DBL_EPSILON * (4 + sqrt((double)n)), 1e-10);
  return e;
}

/* with damping, against a reference of a tiny step */
static double verlet_damped(const void *what, double *h, double *rounding) {
  struct bodies b = {.damping = 0.5};
  const size_t n = (size_t)ceil(2 / *h);
  *h = 2 / (double)n;
  double y[DIM];
  verlet_run(&b, n, *h, y);
  *rounding = 1e-5;
  return distance(BODIES * ROW, y, what);
}

static void test_verlet(void) {
  const double order = observed_order(verlet_error, NULL, 0.25);
  CHECK_CLOSE(order, 2, 0.1); /* symmetric: the next power is h^4 */

  /* the force is that of the half step's velocity: order 1. The reference is
     good to 2^-16, the window ends at 1e-3. */
  struct bodies b = {.damping = 0.5};
  double reference[DIM];
  verlet_run(&b, 1 << 17, 2. / (1 << 17), reference);
  const double damped = observed_order(verlet_damped, reference, 0.1);
  CHECK_CLOSE(damped, 1, 0.1);
  printf("verlet: order %.3f, damped %.3f\n", order, damped);
}

static double pendulum_energy(const double y[], int i, int c) {
  const double v = y[i * ROW + 2 + c];
  return 0.5 * v * v - cos(y[i * ROW + c]);
}

/* Symplectic: the error of the energy is of the order of h^2 in the first
   revolutions and no larger hundreds of revolutions later. */
static void test_verlet_energy(void) {
  enum { STEPS = 20000, PART = 1000 };
  const double h = 0.1;
  struct bodies b = {0};
  const gsl_odeiv2_system sys = {bodies_f, NULL, BODIES * ROW, &b};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(verlet, sys.dimension);
  verlet_set_layout(step, ROW, 2);
  double y[DIM], begin[DIM], yerr[DIM], dydt[DIM], early = 0, late = 0;
  bool stepped = true;
  bodies_exact(0, begin);
  memcpy(y, begin, sizeof y);
  bodies_f(0, y, dydt, &b);
  for (int k = 0; k < STEPS; k++) {
    stepped = stepped && gsl_odeiv2_step_apply(step, k * h, h, y, yerr, dydt,
                                               dydt, &sys) == GSL_SUCCESS;
    for (int i = 0; i < BODIES; i++)
      for (int c = 0; c < 2; c++) {
        const double e =
            fabs(pendulum_energy(y, i, c) - pendulum_energy(begin, i, c));
        if (k < PART)
          early = GSL_MAX(early, e);
        if (k >= STEPS - PART && !(e <= late))
          late = e;
      }
  }
  CHECK(stepped);
  CHECK(early > 0 && early < h * h);
  CHECK(late < 1.05 * early);
  gsl_odeiv2_step_free(step);
}

/* Back with -h: every bit but the rounding. */
static void test_verlet_reversible(void) {
  struct bodies b = {0};
  const gsl_odeiv2_system sys = {bodies_f, NULL, BODIES * ROW, &b};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(verlet, sys.dimension);
  verlet_set_layout(step, ROW, 2);
  double y[DIM], yerr[DIM], dydt[DIM], begin[DIM];
  enum { STEPS = 100 };
  bodies_exact(0, y);
  memcpy(begin, y, sizeof y);
  bodies_f(0, y, dydt, &b);
  for (int k = 0; k < 2 * STEPS; k++) {
    const double h = k < STEPS ? 0.1 : -0.1;
    const double t = 0.1 * (k < STEPS ? k : 2 * STEPS - k);
    CHECK(gsl_odeiv2_step_apply(step, t, h, y, yerr, dydt, dydt, &sys) ==
          GSL_SUCCESS);
  }
  /* a rounding of one step moves the end by up to the time left */
  CHECK_CLOSE(distance(sys.dimension, y, begin), 0,
              ULPS(1) * 2 * STEPS * 0.1 * 2 * STEPS);
  gsl_odeiv2_step_free(step);
}

static void test_verlet_contract(void) {
  struct bodies b = {0};
  const gsl_odeiv2_system sys = {bodies_f, NULL, BODIES * ROW, &b};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(verlet, sys.dimension);
  CHECK(!strcmp(gsl_odeiv2_step_name(step), "verlet"));
  CHECK(gsl_odeiv2_step_order(step) == 2);
  double y[DIM], begin[DIM], good[DIM], yerr[DIM], in[DIM], out[DIM];
  bodies_exact(0, begin);
  memcpy(y, begin, sizeof y);
  bodies_f(0, y, in, &b);
  /* not without a layout, nor without either derivative */
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, in, out, &sys) ==
        GSL_EINVAL);
  verlet_set_layout(step, ROW, 2);
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, NULL, out, &sys) ==
        GSL_EINVAL);
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, in, NULL, &sys) ==
        GSL_EINVAL);
  CHECK(same(BODIES * ROW, y, begin));
  CHECK(gsl_odeiv2_step_reset(step) == GSL_SUCCESS); /* keeps the layout */
  memcpy(good, begin, sizeof good);
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, good, yerr, in, out, &sys) ==
        GSL_SUCCESS);
  /* positions know their velocities at the end of the step */
  for (int i = 0; i < BODIES * ROW; i += ROW)
    CHECK(same(2, out + i, good + i + 2));
  b = (struct bodies){.fail_at = 1};
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, in, out, &sys) ==
        GSL_EBADFUNC);
  CHECK(b.calls == 1);
  CHECK(same(BODIES * ROW, y, begin));
  CHECK(gsl_odeiv2_step_apply(step, 0, 0.1, y, yerr, in, out, &sys) ==
        GSL_SUCCESS);
  CHECK(same(BODIES * ROW, y, good));
  gsl_odeiv2_step_free(step);
}

/* --- the paper's control ---------------------------------------------------*/

enum { BIG = 1000 };

/* One answer to the estimate rest for all unknowns but e at place k. y and its
   slope are large: no error here is relative to them. */
static int adjust_with(gsl_odeiv2_control *control, size_t dim, size_t k,
                       double rest, double e, double *h) {
  double y[DIM], yerr[DIM], dydt[DIM];
  for (size_t i = 0; i < dim; i++) {
    y[i] = BIG;
    dydt[i] = -BIG;
    yerr[i] = i == k ? e : rest;
  }
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(merson, dim);
  const int status =
      gsl_odeiv2_control_hadjust(control, step, y, yerr, dydt, h);
  gsl_odeiv2_step_free(step);
  return status;
}

/* The paper's control, which remembers nothing. */
static int adjust(double delta, size_t dim, size_t k, double rest, double e,
                  double *h) {
  gsl_odeiv2_control *control;
  if (!CHECK(control_paper_alloc(&control, delta) == GSL_SUCCESS))
    return -100; /* none of the answers */
  const int status = adjust_with(control, dim, k, rest, e, h);
  gsl_odeiv2_control_free(control);
  return status;
}

static void test_control_formula(void) {
  const double deltas[] = {1e-6, 0.1, 7}, steps[] = {2e-9, 1e-4, 0.1, 3};
  /* error by delta */
  const double ratios[] = {1e-30,    1e-12,    0.01, 0.3, 0.33, 0.5,
                           0.999999, 1.000001, 2,    100, 1e12, 1e100};
  for (size_t a = 0; a < COUNT(deltas); a++)
    for (size_t b = 0; b < COUNT(steps); b++)
      for (size_t c = 0; c < COUNT(ratios); c++)
        for (size_t k = 0; k < 3; k++)
          for (int sign = -1; sign <= 1; sign += 2) {
            const double error = ratios[c] * deltas[a];
            double h = steps[b];
            const int status = adjust(deltas[a], 3, k, 0.01 * error * h / 3,
                                      sign * error * h / 3, &h);
            const double want = 0.8 * pow(1 / ratios[c], 0.2) * steps[b];
            /* pow, and the roundings of the ratio, a fifth of them */
            CHECK_REL(h, want, ULPS(8));
            if (ratios[c] > 1)
              CHECK(status == GSL_ODEIV_HADJ_DEC);
            else if (h > steps[b])
              CHECK(status == GSL_ODEIV_HADJ_INC);
            else
              CHECK(status == GSL_ODEIV_HADJ_NIL);
          }
}

static void test_control_limits(void) {
  /* accepted below delta, not at it; all numbers here are powers of two but
     the 3 of 3 E/h, so the comparison is exact */
  double h = 0.375;
  CHECK(adjust(0.5, 1, 0, 0, 0.0625, &h) == GSL_ODEIV_HADJ_DEC);
  h = 0.375;
  CHECK(adjust(0.5, 1, 0, 0, nextafter(0.0625, 0), &h) == GSL_ODEIV_HADJ_NIL);
  CHECK_CLOSE(h, 0.8 * 0.375, ULPS(1));

  /* no error: doubled */
  h = 0.1;
  CHECK(adjust(0.1, 4, 0, 0, 0, &h) == GSL_ODEIV_HADJ_INC && h == 0.2);
  h = 0.1;
  CHECK(adjust(0.1, 4, 2, -0.0, 0, &h) == GSL_ODEIV_HADJ_INC && h == 0.2);

  /* below 1e-9 s: accepted whatever the error, but shortened; not so from
     1e-9 s on */
  h = 0.999e-9;
  CHECK(adjust(0.1, 3, 1, 0, 1, &h) != GSL_ODEIV_HADJ_DEC);
  CHECK(h > 0 && h < 0.999e-9);
  h = 1.001e-9;
  CHECK(adjust(0.1, 3, 1, 0, 1, &h) == GSL_ODEIV_HADJ_DEC);
  CHECK(h > 0 && h < 1.001e-9);
}

static const double ones[] = {1, 1, 1, 1};

/* An estimate that is not finite: rejected, with a step that is shorter but
   still a step, wherever in the vector it is. evolve gives up if told of a
   decrease that is none. */
static void test_control_not_finite(void) {
  const double bad[] = {GSL_NAN, -GSL_NAN, GSL_POSINF, GSL_NEGINF};
  const double rest[] = {0, 1e-9, 1e9};
  for (size_t b = 0; b < COUNT(bad); b++)
    for (size_t r = 0; r < COUNT(rest); r++)
      for (size_t dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < dim; k++) {
          double h = 0.1;
          CHECK(adjust(0.1, dim, k, rest[r], bad[b], &h) == GSL_ODEIV_HADJ_DEC);
          CHECK(h > 0 && h < 0.1);
          gsl_odeiv2_control *c;
          CHECK(control_predictive_alloc(&c, 0.1, 0, ones, dim) == GSL_SUCCESS);
          h = 0.1;
          CHECK(adjust_with(c, dim, k, rest[r], bad[b], &h) ==
                GSL_ODEIV_HADJ_DEC);
          CHECK(h > 0 && h < 0.1);
          gsl_odeiv2_control_free(c);
        }
}

static void test_control_new(void) {
  const double bad[] = {0, -1, GSL_NAN};
  for (size_t i = 0; i < COUNT(bad); i++) {
    gsl_odeiv2_control *c = NULL;
    CHECK(control_paper_alloc(&c, bad[i]) == GSL_EINVAL && c == NULL);
  }
  gsl_odeiv2_control *c;
  CHECK(control_paper_alloc(&c, 0.1) == GSL_SUCCESS);
  double level = GSL_NAN;
  CHECK(!strcmp(gsl_odeiv2_control_name(c), "paper"));
  /* the level is the E at which a step is just not accepted */
  CHECK(gsl_odeiv2_control_errlevel(c, 5, 7, 0.3, 0, &level) == GSL_SUCCESS);
  CHECK_CLOSE(level, 0.1 * 0.3 / 3, ULPS(1));
  gsl_odeiv2_control_free(c);
}

/* --- predictive control ----------------------------------------------------*/

/* Gustafsson's prediction with Merson's order: the fifth root. */
static double predicted(double h, double error, double h_last, double last) {
  const double plain = 0.8 * pow(error, -0.2);
  const double factor =
      last > 0
          ? fmin(plain, 0.8 * h / h_last * pow(last / (error * error), 0.2))
          : plain;
  return h * fmin(5, fmax(0.2, factor));
}

static void test_predictive(void) {
  const double abstol = 1e-3;
  double scale[] = {2, 0.5, 1};
  gsl_odeiv2_control *c;
  if (!CHECK(control_predictive_alloc(&c, abstol, 0, scale, 3) == GSL_SUCCESS))
    return;
  scale[0] = scale[1] = scale[2] = GSL_NAN; /* it has a copy */
  static const double scales[] = {2, 0.5, 1};

  /* a plain step size first, a predicted one with every accepted step */
  const double errors[] = {0.3, 0.3, 0.1, 0.9, 0.02, 0.5};
  double h = 0.1, h_last = 0, last = 0;
  for (size_t i = 0; i < COUNT(errors); i++) {
    const double before = h, want = predicted(h, errors[i], h_last, last);
    const int status =
        adjust_with(c, 3, i % 3, 0, -errors[i] * abstol * scales[i % 3], &h);
    CHECK(status == (want > before ? GSL_ODEIV_HADJ_INC : GSL_ODEIV_HADJ_NIL));
    CHECK_REL(h, want, ULPS(8)); /* pow, and the roundings of the error */
    h_last = before, last = errors[i];
  }

  /* rejected: shorter, at most tenfold; the next accepted step does not grow */
  double from = h = 0.1;
  CHECK(adjust_with(c, 3, 2, 0, 2 * abstol, &h) == GSL_ODEIV_HADJ_DEC);
  CHECK_REL(h, from * 0.8 * pow(2, -0.2), ULPS(8));
  from = h;
  CHECK(adjust_with(c, 3, 2, 0, 1e30 * abstol, &h) == GSL_ODEIV_HADJ_DEC);
  CHECK_REL(h, from * 0.1, ULPS(2));
  from = h;
  CHECK(adjust_with(c, 3, 2, 0, 1e-5 * abstol, &h) == GSL_ODEIV_HADJ_NIL);
  CHECK(h <= from);
  /* no error at all: growth, but no more than fivefold */
  for (int k = 0; k < 3; k++) {
    from = h;
    CHECK(adjust_with(c, 3, 2, 0, 0, &h) == GSL_ODEIV_HADJ_INC);
    CHECK(h > from && h <= 5 * from * (1 + ULPS(1)));
  }
  gsl_odeiv2_control_free(c);

  /* reltol is of |y| */
  CHECK(control_predictive_alloc(&c, 0, 1e-6, scales, 3) == GSL_SUCCESS);
  h = 0.1;
  CHECK(adjust_with(c, 3, 1, 0, 0.99e-6 * BIG, &h) != GSL_ODEIV_HADJ_DEC);
  CHECK(adjust_with(c, 3, 1, 0, 1.01e-6 * BIG, &h) == GSL_ODEIV_HADJ_DEC);
  double level;
  CHECK(gsl_odeiv2_control_errlevel(c, -BIG, 7, 0.3, 1, &level) == GSL_SUCCESS);
  CHECK_REL(level, 1e-6 * BIG, ULPS(2));
  gsl_odeiv2_control_free(c);

  const double bad[][2] = {{0, 0}, {-1, 1}, {1, -1}, {GSL_NAN, 1}};
  for (size_t i = 0; i < COUNT(bad); i++) {
    c = NULL;
    CHECK(control_predictive_alloc(&c, bad[i][0], bad[i][1], scales, 3) ==
              GSL_EINVAL &&
          c == NULL);
  }
}

/* --- both together: the paper's integrator, written down again -------------*/

/* A drop on the paper's wall, which makes it shorten its steps. */
static int drop_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  ++*(size_t *)params;
  dydt[0] = y[1];
  dydt[1] = 10 * exp(-150 * y[0]) - 9.81;
  return gsl_finite(dydt[1]) ? GSL_SUCCESS : GSL_EBADFUNC;
}

struct paper {
  double t, h, y[2];
  size_t attempts;
};

/* One accepted step of the Runge-Kutta-Merson program that the paper used. */
static void paper_step(struct paper *s, double delta) {
  for (;;) {
    size_t calls = 0;
    const double h = s->h, *y = s->y;
    double k1[2], k2[2], k3[2], k4[2], k5[2], a[2], error = 0;
    drop_f(s->t, y, k1, &calls);
    for (int i = 0; i < 2; i++)
      a[i] = y[i] + h * k1[i] / 3;
    drop_f(s->t + h / 3, a, k2, &calls);
    for (int i = 0; i < 2; i++)
      a[i] = y[i] + h * (k1[i] + k2[i]) / 6;
    drop_f(s->t + h / 3, a, k3, &calls);
    for (int i = 0; i < 2; i++)
      a[i] = y[i] + h * (k1[i] + 3 * k3[i]) / 8;
    drop_f(s->t + h / 2, a, k4, &calls);
    for (int i = 0; i < 2; i++)
      a[i] = y[i] + h * (k1[i] - 3 * k3[i] + 4 * k4[i]) / 2;
    drop_f(s->t + h, a, k5, &calls);
    for (int i = 0; i < 2; i++)
      error = fmax(error,
                   fabs(0.2 * k1[i] - 0.9 * k3[i] + 0.8 * k4[i] - 0.1 * k5[i]));
    s->attempts++;
    s->h = error > 0 ? 0.8 * pow(delta / error, 0.2) * h : 2 * h;
    if (error < delta || h < 1e-9) {
      s->t += h;
      for (int i = 0; i < 2; i++)
        s->y[i] += h * (k1[i] + 4 * k4[i] + k5[i]) / 6;
      return;
    }
  }
}

static void test_paper_loop(void) {
  const double deltas[] = {1e-2, 1e-4, 1e-6};
  for (size_t i = 0; i < COUNT(deltas); i++) {
    struct paper want = {.h = 0.01, .y = {1, 0}};
    size_t calls = 0, accepted = 0;
    const gsl_odeiv2_system sys = {drop_f, NULL, 2, &calls};
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(merson, 2);
    gsl_odeiv2_control *control;
    CHECK(control_paper_alloc(&control, deltas[i]) == GSL_SUCCESS);
    gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(2);
    double t = 0, h = 0.01, y[2] = {1, 0};
    bool alike = true;
    for (; t < 0.8 && accepted < 10000;
         accepted++) { /* a fall, a bounce, part of the rise */
      /* free flight has an estimate of rounding alone: bring both back to
         a step that does not jump over the wall */
      h = want.h = GSL_MIN(GSL_MIN(h, want.h), 0.01);
      paper_step(&want, deltas[i]);
      if (!CHECK(gsl_odeiv2_evolve_apply(evolve, control, step, &sys, &t, 10,
                                         &h, y) == GSL_SUCCESS))
        break;
      /* the error, of size delta, is a difference of slopes of at most
         kappa v^2/2 = 1500 with their rounding; a fifth of that goes into
         each h, together at most the time; the speed is below 5 m/s */
      const double tol = 0.8 * ULPS(1500) / (5 * deltas[i]);
      alike =
          alike && fabs(t - want.t) <= tol && fabs(y[0] - want.y[0]) <= 5 * tol;
    }
    CHECK(alike);
    CHECK(evolve->count == want.attempts && want.attempts > accepted);
    CHECK(calls == 1 + 5 * want.attempts);
    gsl_odeiv2_evolve_free(evolve);
    gsl_odeiv2_control_free(control);
    gsl_odeiv2_step_free(step);
  }
}

/* The sum of local errors below delta h/3 is below delta T/3 for a problem
   that does not amplify them, and it is of that order: slope 1 over delta. */
static double control_error(const struct stepper *s, double delta) {
  const struct problem *p = &problems[1]; /* oscillator */
  const gsl_odeiv2_system sys = system_of(p);
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(*s->type, p->dim);
  gsl_odeiv2_control *control;
  CHECK(control_paper_alloc(&control, delta) == GSL_SUCCESS);
  gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(p->dim);
  double t = 0, h = 0.1, y[DIM], exact[DIM];
  p->exact(0, y);
  int status = GSL_SUCCESS;
  while (t < 10 && status == GSL_SUCCESS && evolve->count < 100000)
    status =
        gsl_odeiv2_evolve_apply(evolve, control, step, &sys, &t, 10, &h, y);
  p->exact(10, exact);
  gsl_odeiv2_evolve_free(evolve);
  gsl_odeiv2_control_free(control);
  gsl_odeiv2_step_free(step);
  return t == 10 ? distance(p->dim, y, exact) : GSL_NAN;
}

static void test_control_error(void) {
  double x[5], y[5], c, slope, cov00, cov01, cov11, sumsq;
  for (int k = 0; k < 5; k++) {
    const double delta = pow(10, -3 - k);
    const double e = control_error(&steppers[0], delta);
    CHECK(e < sqrt(2) * delta * 10 / 3); /* max norm of a rotation */
    x[k] = log(delta);
    y[k] = log(e);
  }
  gsl_fit_linear(x, 1, y, 1, 5, &c, &slope, &cov00, &cov01, &cov11, &sumsq);
  printf("error ~ delta^%.2f\n", slope);
  /* h moves by steps of the estimate of the step before: a tenth in the
     slope over four decades is a factor 2.5 in the error */
  CHECK_CLOSE(slope, 1, 0.1);
}

int main(void) {
  gsl_set_error_handler_off();
  test_type();
  test_row_sums();
  test_order_conditions();
  test_orders();
  test_invariant();
  test_merson_estimate();
  test_stability_polynomial();
  test_stability_limits();
  test_derivatives();
  test_chain();
  test_failures();
  test_dimensions();
  test_verlet();
  test_verlet_energy();
  test_verlet_reversible();
  test_verlet_contract();
  test_control_formula();
  test_control_limits();
  test_control_not_finite();
  test_control_new();
  test_predictive();
  test_paper_loop();
  test_control_error();
  return check_done();
}
