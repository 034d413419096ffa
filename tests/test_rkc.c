/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta-Chebyshev: order with few stages and with many, the stability
   polynomial against its closed form, the spectral radius against eigenvalues
   of the Jacobian, and the contract of a step type. */
#include <complex.h>
#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "model/bed.h"
#include "check.h"
#include "steppers/control.h"
#include "dynamics/dynamics.h"
#include "steppers/integrate.h"
#include "steppers/chebyshev.h"
#include "steppers/rkc.h"
#include "model/scene.h"
#include "sample.h"

#define ULPS(n) ((n)*DBL_EPSILON)
#define COUNT(array) (sizeof(array) / sizeof *(array))

static bool same(size_t dim, const double x[], const double y[]) {
  return !memcmp(x, y, dim * sizeof *x);
}

static double distance(size_t dim, const double x[], const double y[]) {
  double most = 0;
  for (size_t i = 0; i < dim; i++)
    if (!(fabs(x[i] - y[i]) <= most)) /* NaN stays */
      most = fabs(x[i] - y[i]);
  return most;
}

/* --- problems with exact solutions -----------------------------------------*/

enum { DIM = 4 }; /* the most of any, with the companion */

struct problem {
  const char *name;
  size_t dim;
  void (*f)(double t, const double y[], double dydt[]);
  void (*exact)(double t, double y[]);
  double start, end;
};

/* eigenvalues -1 +- 2i and -3 */
static void three_f(double t, const double y[], double dydt[]) {
  (void)t;
  dydt[0] = -y[0] + 2 * y[1];
  dydt[1] = -2 * y[0] - y[1];
  dydt[2] = y[0] + y[1] - 3 * y[2];
}

static void three(double t, double y[]) {
  const double c = exp(-t) * cos(2 * t), s = exp(-t) * sin(2 * t);
  y[0] = c + 2 * s;
  y[1] = 2 * c - s;
  y[2] = 0.5 * c + s - 1.5 * exp(-3 * t);
}

static void driven_f(double t, const double y[], double dydt[]) {
  dydt[0] = -y[0] + cos(t);
}

static void driven(double t, double y[]) {
  y[0] = 0.5 * (cos(t) + sin(t) + exp(-t));
}

static void logistic_f(double t, const double y[], double dydt[]) {
  (void)t;
  dydt[0] = y[0] * (1 - y[0]);
}

static void logistic(double t, double y[]) {
  y[0] = 1 / (1 + 4 * exp(-t));
}

static void cube_f(double t, const double y[], double dydt[]) {
  dydt[0] = -t * y[0] * y[0] * y[0];
}

static void cube(double t, double y[]) {
  y[0] = 1 / sqrt(1 + t * t);
}

/* the circle with a speed that its own radius and the time change */
static void circle_f(double t, const double y[], double dydt[]) {
  const double r2 = y[0] * y[0] + y[1] * y[1], w = 1 + t;
  dydt[0] = -w * r2 * y[1] + (1 - r2) * y[0];
  dydt[1] = w * r2 * y[0] + (1 - r2) * y[1];
}

static void circle(double t, double y[]) {
  y[0] = cos(t + t * t / 2);
  y[1] = sin(t + t * t / 2);
}

static const struct problem problems[] = {
    {"3x3", 3, three_f, three, 0.5, 2},
    {"-y + cos t", 1, driven_f, driven, 0.5, 2},
    {"logistic", 1, logistic_f, logistic, 0.5, 3},
    {"-t y^3", 1, cube_f, cube, 0.5, 3},
    {"circle", 2, circle_f, circle, 0.5, 2}};

/* A problem and, where rate > 0, one unknown more, apart from the others,
   y' = -rate (y - cos t) - sin t with the solution cos t, which sets the
   stage number. */
struct companion {
  const struct problem *problem;
  double rate;
  size_t calls, fail_at; /* 0: never */
};

static int companion_f(double t, const double y[], double dydt[],
                       void *params) {
  struct companion *c = params;
  const size_t dim = c->problem ? c->problem->dim : 0;
  if (++c->calls == c->fail_at) {
    for (size_t i = 0; i < dim + (c->rate > 0); i++)
      dydt[i] = GSL_NAN;
    return GSL_EBADFUNC;
  }
  if (c->problem)
    c->problem->f(t, y, dydt);
  if (c->rate > 0)
    dydt[dim] = -c->rate * (y[dim] - cos(t)) - sin(t);
  for (size_t i = 0; i < dim + (c->rate > 0); i++)
    if (!gsl_finite(dydt[i]))
      return GSL_EBADFUNC;
  return GSL_SUCCESS;
}

static void companion_exact(const struct companion *c, double t, double y[]) {
  const size_t dim = c->problem ? c->problem->dim : 0;
  if (c->problem)
    c->problem->exact(t, y);
  if (c->rate > 0)
    y[dim] = cos(t);
}

static gsl_odeiv2_system companion_system(struct companion *c) {
  const size_t dim = (c->problem ? c->problem->dim : 0) + (c->rate > 0);
  return (gsl_odeiv2_system){companion_f, NULL, dim, c};
}

/* --- order -----------------------------------------------------------------*/

static double slope_of(int n, const double *x, const double *y) {
  double c, slope, cov00, cov01, cov11, sumsq;
  gsl_fit_linear(x, 1, y, 1, (size_t)n, &c, &slope, &cov00, &cov01, &cov11,
                 &sumsq);
  return slope;
}

/* Largest error of the first unknowns over n steps from start to end, and
   stages of the last. */
static double global_error(struct companion *c, size_t of, double start,
                           double end, size_t n, size_t *stages) {
  const gsl_odeiv2_system sys = companion_system(c);
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, sys.dimension);
  const double h = (end - start) / (double)n;
  double y[DIM], exact[DIM], yerr[DIM], dydt[DIM], worst = 0;
  companion_exact(c, start, y);
  companion_f(start, y, dydt, c);
  for (size_t k = 0; k < n; k++) {
    if (gsl_odeiv2_step_apply(step, start + (double)k * h, h, y, yerr, dydt,
                              dydt, &sys) != GSL_SUCCESS)
      worst = GSL_NAN;
    companion_exact(c, start + (double)(k + 1) * h, exact);
    const double e = distance(of, y, exact);
    if (!(e <= worst))
      worst = e;
  }
  *stages = rkc_report(step).stages;
  gsl_odeiv2_step_free(step);
  return worst;
}

enum { POINTS = 9 }; /* two octaves in quarters */

/* The slope of log error over log step at a fixed h * rate, thus a fixed
   number of stages. */
static double observed_order(const struct problem *p, double z, size_t n0,
                             size_t *stages) {
  double x[POINTS], y[POINTS];
  for (int k = 0; k < POINTS; k++) {
    const double n = floor((double)n0 * pow(2, 0.25 * k));
    struct companion c = {.problem = p, .rate = z * n / (p->end - p->start)};
    x[k] = -log(n);
    y[k] = log(global_error(&c, p->dim, p->start, p->end, (size_t)n, stages));
  }
  return slope_of(POINTS, x, y);
}

/* One step's estimate, the largest of eight starts. */
static double estimate_order(const struct problem *p, double z, size_t n0) {
  double x[POINTS], y[POINTS];
  for (int k = 0; k < POINTS; k++) {
    const double h = (p->end - p->start) / ((double)n0 * pow(2, 0.25 * k));
    struct companion c = {.problem = p, .rate = z / h};
    const gsl_odeiv2_system sys = companion_system(&c);
    double most = 0;
    for (int i = 0; i < 8; i++) {
      const double t = p->start + (p->end - p->start - h) * i / 8;
      double u[DIM], yerr[DIM];
      companion_exact(&c, t, u);
      gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, sys.dimension);
      if (gsl_odeiv2_step_apply(step, t, h, u, yerr, NULL, NULL, &sys) !=
          GSL_SUCCESS)
        most = GSL_NAN;
      gsl_odeiv2_step_free(step);
      for (size_t j = 0; j < p->dim; j++)
        if (!(fabs(yerr[j]) <= most))
          most = fabs(yerr[j]);
    }
    x[k] = log(h);
    y[k] = log(most);
  }
  return slope_of(POINTS, x, y);
}

static void test_orders(void) {
  static const double zs[] = {0, 60, 3000};
  for (size_t i = 0; i < COUNT(problems); i++) {
    printf("%-11s order (of estimate), stages:", problems[i].name);
    for (size_t k = 0; k < COUNT(zs); k++) {
      size_t stages;
      const double p = observed_order(&problems[i], zs[k], 128, &stages);
      const double q = estimate_order(&problems[i], zs[k], 128);
      printf("  %.3f (%.3f), %zu", p, q, stages);
      /* h is at most 1/40: with C h^p (1 + a h) a slope is off by a h */
      CHECK_CLOSE(p, 2, 0.1);
      CHECK_CLOSE(q, 3, 0.1);
      /* z times the safety of the estimate, by sqrt(z/0.65) */
      if (zs[k] > 0)
        CHECK((double)stages >= sqrt(zs[k] / 0.654) &&
              (double)stages <= 2 + sqrt(1.3 * zs[k] / 0.65));
      else
        CHECK(stages == 2);
    }
    putchar('\n');
  }
}

/* Prothero and Robinson: the error while h * rate is large. Steps damp what
   the ones before have added, so that less is left than of a problem that is
   not stiff, which has about h^2/15: h^2 g, with a g that grows towards that as
   h * rate falls and jumps with the number of stages. It takes up to a half
   from the slope. */
static void test_stiff_order(void) {
  enum { MANY = 25 };
  static const double rates[] = {1e3, 1e4, 1e5};
  static const double least[] = {4, 8, 16};
  for (size_t i = 0; i < COUNT(rates); i++) {
    double x[MANY], y[MANY], worst = 0;
    size_t first = 0, last = 0;
    for (int k = 0; k < MANY; k++) {
      const double n = floor(least[i] * pow(2, 0.125 * k)), h = 2 / n;
      struct companion c = {.rate = rates[i]};
      const double e =
          global_error(&c, 1, 0.3, 2.3, (size_t)n, k ? &last : &first);
      x[k] = log(h);
      y[k] = log(e);
      if (!(e / (h * h) <= worst))
        worst = e / (h * h);
    }
    const double p = slope_of(MANY, x, y);
    printf("rate %g: order %.3f with %zu to %zu stages, error %.2g h^2\n",
           rates[i], p, last, first, worst);
    CHECK(p > 1.5);
    CHECK(worst < 1. / 15);
  }
}

/* --- stability polynomial --------------------------------------------------*/

static const double damping = 2. / 13;

/* a + b T_s(w0 + w1 z) of Sommeijer, Shampine, Verwer, from cosh rather than by
   recurrence; w0 = cosh(theta). */
struct polynomial {
  double s, a, b, w0, w1;
};

static struct polynomial polynomial(size_t stages) {
  const long double s = (long double)stages, e = 2 / (13 * s * s), w0 = 1 + e;
  const long double theta = 2 * asinhl(sqrtl(e / 2));
  const long double t = coshl(s * theta),
                    d = s * sinhl(s * theta) / sinhl(theta);
  const long double dd = (s * s * t - w0 * d) / (e * (2 + e));
  const long double b = dd / (d * d);
  return (struct polynomial){(double)s, (double)(1 - b * t), (double)b,
                             (double)w0, (double)(d / dd)};
}

static double complex value(const struct polynomial *p, double complex z) {
  return p->a + p->b * ccos(p->s * cacos(p->w0 + p->w1 * z));
}

/* y' = lambda y in blocks of two, (re, -im; im, re); the first block is real
   and large and sets the number of stages. */
struct blocks {
  size_t n;
  const double complex *lambda;
};

static int blocks_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const struct blocks *b = params;
  for (size_t i = 0; i < b->n; i++) {
    const double re = creal(b->lambda[i]), im = cimag(b->lambda[i]);
    dydt[2 * i] = re * y[2 * i] - im * y[2 * i + 1];
    dydt[2 * i + 1] = im * y[2 * i] + re * y[2 * i + 1];
  }
  return GSL_SUCCESS;
}

/* The first unknown outweighs the others by this, so that the power iteration
   sees its rate alone. */
static const double weight = 1e9;

/* R(lambda[i]) of one step of size 1 and, where r_estimate isn't NULL, what the
   error estimate makes of 1. lambda[0] is the method's own. Returns stages. */
static size_t one_step(double rate, size_t n, double complex *lambda,
                       double complex *r, double complex *r_estimate) {
  lambda[0] = -rate;
  struct blocks b = {n, lambda};
  const gsl_odeiv2_system sys = {blocks_f, NULL, 2 * n, &b};
  double *y = numbers(2 * n), *yerr = numbers(2 * n);
  for (size_t i = 0; i < n; i++)
    y[2 * i] = i ? 1 : weight;
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 2 * n);
  CHECK(gsl_odeiv2_step_apply(step, 0, 1, y, yerr, NULL, NULL, &sys) ==
        GSL_SUCCESS);
  const size_t stages = rkc_report(step).stages;
  gsl_odeiv2_step_free(step);
  for (size_t i = 0; i < n; i++) {
    r[i] = y[2 * i] + I * y[2 * i + 1];
    if (r_estimate)
      r_estimate[i] = yerr[2 * i] + I * yerr[2 * i + 1];
  }
  free(y);
  free(yerr);
  return stages;
}

/* How much the spectral radius in use is above one that is found exactly. */
static double safety(void) {
  double complex lambda[] = {-1};
  struct blocks b = {1, lambda};
  const gsl_odeiv2_system sys = {blocks_f, NULL, 2, &b};
  double y[] = {1, 0}, yerr[2];
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 2);
  CHECK(gsl_odeiv2_step_apply(step, 0, 1, y, yerr, NULL, NULL, &sys) ==
        GSL_SUCCESS);
  const double radius = rkc_report(step).spectral_radius;
  gsl_odeiv2_step_free(step);
  return radius;
}

static void test_reach(void) {
  for (size_t s = 2; s <= 400; s++) {
    const struct polynomial p = polynomial(s);
    const double sd = (double)s;
    /* the closed form's differences lose a factor 10 or so */
    CHECK_REL(chebyshev_reach(s), (p.w0 + 1) / p.w1, ULPS(50 * sd));
    /* authors' expansion; its next term is of the order of damping^2 */
    CHECK_REL(chebyshev_reach(s),
              2. / 3 * (sd * sd - 1) * (1 - 2. / 15 * damping),
              0.1 * damping * damping);
    CHECK(chebyshev_reach(s) >= (s < 4 ? 0.49 : 0.6) * sd * sd);
  }
  printf("reach/s^2: %.4f (2) %.4f (3) %.4f (4) %.4f (10) %.4f (60)\n",
         chebyshev_reach(2) / 4, chebyshev_reach(3) / 9,
         chebyshev_reach(4) / 16, chebyshev_reach(10) / 100,
         chebyshev_reach(60) / 3600);
}

/* b_j = T_j''/(T_j')^2 and c_j = w1 T_j''/T_j' at w0, from cosh; b_0 = b_1 =
   b_2, c_0 = 0, c_1 = w1 b_1. */
struct term {
  double t, b, c;
};

static struct term term(const struct polynomial *p, size_t stages, size_t j) {
  const long double s = (long double)stages, e = 2 / (13 * s * s), w0 = 1 + e;
  const long double theta = 2 * asinhl(sqrtl(e / 2));
  if (j < 2) {
    const long double b = 1 / (4 * w0 * w0);
    return (struct term){j ? (double)w0 : 1, (double)b,
                         j ? (double)(p->w1 * b) : 0};
  }
  const long double k = (long double)j, t = coshl(k * theta),
                    d = k * sinhl(k * theta) / sinhl(theta),
                    dd = (k * k * t - w0 * d) / (e * (2 + e));
  return (struct term){(double)t, (double)(dd / (d * d)),
                       (double)(p->w1 * dd / d)};
}

static void check_scheme(const struct chebyshev_scheme *c, size_t s) {
  const struct polynomial p = polynomial(s);
  const double sd = (double)s, tol = ULPS(50 * sd);
  CHECK(c->stages == s);
  CHECK_REL(c->reach, (p.w0 + 1) / p.w1, tol);
  CHECK_REL(c->w1 * c->b1, p.w1 / (4 * p.w0 * p.w0), tol);
  /* y' = 1 and y' = 2 t from 0, what order 2 makes exact: Y_j-1 and Y_j-2 */
  const double start[2] = {0, 0}, f0[2] = {1, 0};
  double now[2] = {c->w1 * c->b1, 0}, before[2] = {0, 0};
  double off[5] = {0};
  for (size_t j = 2; j <= s; j++) {
    const struct chebyshev_stage *k = &c->stage[j - 2];
    const struct term this = term(&p, s, j), one = term(&p, s, j - 1),
                      two = term(&p, s, j - 2);
    const double ratio = this.b / one.b, f[2] = {1, 2 * k->time};
    const double difference[] = {
        k->mu / (2 * ratio * p.w0) - 1, k->nu / (-this.b / two.b) - 1,
        k->rate / (2 * ratio * p.w1) - 1,
        k->start / k->rate + (1 - one.b * one.t), k->time - one.c};
    for (size_t i = 0; i < COUNT(off); i++)
      if (!(fabs(difference[i]) <= off[i])) /* NaN stays */
        off[i] = fabs(difference[i]);
    const struct stage sum = chebyshev_stage(k, 1, start, f0);
    stage_combine(&sum, 0, 2, now, f, before);
    for (int i = 0; i < 2; i++) {
      const double next = before[i];
      before[i] = now[i];
      now[i] = next;
    }
  }
  for (size_t i = 0; i < COUNT(off); i++)
    CHECK_CLOSE(off[i], 0, i < 4 ? tol : ULPS(sd * sd));
  CHECK_CLOSE(now[0], 1, ULPS(sd * sd));
  CHECK_CLOSE(now[1], 1, ULPS(sd * sd));
}

static void test_schemes(void) {
  struct chebyshev *c;
  if (!CHECK(chebyshev_alloc(&c) == GSL_SUCCESS))
    return;
  /* in no order: what is remembered of one is not another's */
  for (size_t k = 0; k < CHEBYSHEV_MOST - 1; k++) {
    const size_t s = 2 + (k * 151) % (CHEBYSHEV_MOST - 1);
    const double reach = chebyshev_reach(s);
    CHECK(chebyshev_stages(c, reach) == s);
    CHECK(chebyshev_stages(c, reach * (1 + 1e-15)) ==
          (s < CHEBYSHEV_MOST ? s + 1 : 0));
    const struct chebyshev_scheme *scheme = chebyshev_scheme(c, s);
    if (!CHECK(scheme))
      continue;
    check_scheme(scheme, s);
    CHECK(chebyshev_scheme(c, s) == scheme);
  }
  CHECK(chebyshev_stages(c, 0) == 2);
  CHECK(chebyshev_stages(c, GSL_NAN) == 0);
  CHECK(chebyshev_stages(c, GSL_POSINF) == 0);
  chebyshev_free(c);
  chebyshev_free(NULL);
}

static void test_stability_polynomial(void) {
  enum { N = 4001 };
  static double complex lambda[N + 1], r[N + 1], e[N + 1];
  const double factor = safety();
  CHECK_CLOSE(factor, 1.2, 1e-6);
  double worst = 0;
  for (size_t s = 2; s <= 60; s++) {
    const double reach = chebyshev_reach(s);
    const struct polynomial p = polynomial(s);
    for (size_t i = 0; i < N; i++)
      lambda[i + 1] = -reach * (double)i / (N - 1);
    /* no more stages than it takes, and no fewer; the difference quotient is
       good to 1e-7 */
    CHECK(one_step(reach * (1 + 1e-5) / factor, 1, lambda, r, NULL) == s + 1);
    CHECK(one_step(reach * (1 - 1e-5) / factor, N + 1, lambda, r, e) == s);
    /* the recurrence amplifies roundings by s^2, which those of its
       coefficients, of s stages, add up to */
    const double tol = ULPS(4 * pow((double)s, 3));
    double most = 0, inside = 0, off = 0, off_estimate = 0;
    for (size_t i = 1; i <= N; i++) {
      const double z = creal(lambda[i]), got = creal(r[i]);
      const double want = creal(value(&p, z));
      CHECK(cimag(r[i]) == 0);
      if (!(fabs(got) <= most))
        most = fabs(got);
      if (p.w0 + p.w1 * z <= 1 && !(fabs(got) <= inside))
        inside = fabs(got);
      if (!(fabs(got - want) <= off))
        off = fabs(got - want);
      const double estimate = 0.8 * (1 - want) + 0.4 * z * (1 + want);
      const double d = fabs(creal(e[i]) - estimate) / (1 + fabs(z));
      if (!(d <= off_estimate))
        off_estimate = d;
    }
    worst = GSL_MAX(worst, off / tol);
    CHECK_CLOSE(off, 0, tol);
    CHECK_CLOSE(off_estimate, 0, tol);
    CHECK(most <= 1 + tol);
    /* damped: a + b from the first minimum on, 1 - damping/3 to first order */
    CHECK(inside <= p.a + p.b + tol);
    CHECK_CLOSE(inside, 1 - damping / 3, damping * damping);
  }
  printf("R(z): rounding at most %.2g of 4 s^3 ulps\n", worst);
}

/* Along z = (-q + i) y: the largest y up to which |R| <= 1 + 1e-9. */
static void test_oblique(void) {
  enum { N = 4000 };
  static double complex lambda[N + 1], r[N + 1];
  static const size_t stages[] = {2, 5, 10, 20};
  static const double ratios[] = {0, 0.05, 0.1, 0.3, 1, 3};
  const double factor = safety();
  printf("|Im z| that is stable, x/y:");
  for (size_t k = 0; k < COUNT(ratios); k++)
    printf("%9g", ratios[k]);
  putchar('\n');
  for (size_t i = 0; i < COUNT(stages); i++) {
    const size_t s = stages[i];
    const struct polynomial p = polynomial(s);
    printf("%18zu stages   ", s);
    for (size_t k = 0; k < COUNT(ratios); k++) {
      const double most =
          k ? 1.2 * chebyshev_reach(s) / hypot(1, ratios[k]) : 0.1;
      for (int j = 1; j <= N; j++)
        lambda[j] = (-ratios[k] + I) * most * j / N;
      CHECK(one_step(chebyshev_reach(s) * (1 - 1e-5) / factor, N + 1, lambda, r,
                     NULL) == s);
      int j = 1, want = 1;
      while (j <= N && cabs(r[j]) <= 1 + 1e-9)
        j++;
      while (want <= N && cabs(value(&p, lambda[want])) <= 1 + 1e-9)
        want++;
      printf("%9.4f", most * (j - 1) / N);
      CHECK(abs(j - want) <= 1);
      /* on the axis itself only the 1e-9; else short of it */
      CHECK(k ? most * j / N > 0.5 && j < N : most * j / N < 0.02);
    }
    putchar('\n');
  }
}

/* --- spectral radius -------------------------------------------------------*/

/* A box of width 0.5 m filled from near the floor, four spheres a layer, in
   contact with each other by overlap, moving at random. */
static void pressed_bed(struct bed *b, size_t n, double spacing, double speed,
                        unsigned long seed) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng || bed_alloc(b, n) != GSL_SUCCESS)
    exit(99);
  gsl_rng_set(rng, seed);
  const double r = 0.1;
  for (size_t i = 0; i < n; i++) {
    const size_t at[3] = {i % 2, i / 2 % 2, i / 4};
    for (size_t k = 0; k < 3; k++) {
      b->x[3 * i + k] =
          r + spacing * (double)at[k] + 0.1 * r * (gsl_rng_uniform(rng) - 0.5);
      b->v[3 * i + k] = speed * (2 * gsl_rng_uniform(rng) - 1);
      b->w[3 * i + k] = speed / r * (2 * gsl_rng_uniform(rng) - 1);
    }
    b->r[i] = r;
  }
  gsl_rng_free(rng);
}

static double true_radius(struct dynamics *d, double t, const double y[]) {
  const size_t dim = dynamics_dimension(d);
  double *jacobian = numbers(dim * dim), *dfdt = numbers(dim), most = 0;
  CHECK(dynamics_jacobian(t, y, jacobian, dfdt, d) == GSL_SUCCESS);
  gsl_matrix_view m = gsl_matrix_view_array(jacobian, dim, dim);
  gsl_vector_complex *eigenvalue = gsl_vector_complex_alloc(dim);
  gsl_eigen_nonsymm_workspace *w = gsl_eigen_nonsymm_alloc(dim);
  if (!eigenvalue || !w)
    exit(99);
  gsl_eigen_nonsymm_params(0, 1, w);
  CHECK(gsl_eigen_nonsymm(&m.matrix, eigenvalue, w) == GSL_SUCCESS);
  for (size_t i = 0; i < dim; i++)
    most = GSL_MAX(most,
                   hypot(eigenvalue->data[2 * i], eigenvalue->data[2 * i + 1]));
  gsl_eigen_nonsymm_free(w);
  gsl_vector_complex_free(eigenvalue);
  free(jacobian);
  free(dfdt);
  return most;
}

/* A gsl_odeiv2 integration of a bed, taken apart. */
struct bench {
  struct scene scene;
  struct bed bed;
  struct dynamics *d;
  size_t dim;
  double *y, *scale;
};

static void bench_open(struct bench *b, enum scene_model model, size_t n,
                       double spacing, double speed, unsigned long seed) {
  b->scene = scene_default();
  b->scene.model = model;
  pressed_bed(&b->bed, n, spacing, speed, seed);
  const struct dynamics_options one = {.threads = 1};
  if (scene_add_box(&b->scene, 0.4, 0.4) != GSL_SUCCESS ||
      dynamics_alloc(&b->d, &b->scene, &b->bed, &one) != GSL_SUCCESS)
    exit(99);
  b->dim = dynamics_dimension(b->d);
  b->y = numbers(b->dim);
  b->scale = numbers(b->dim);
  dynamics_pack(b->d, &b->bed, b->y);
  dynamics_scale(b->d, b->scale);
}

static void bench_close(struct bench *b) {
  dynamics_free(b->d);
  bed_free(&b->bed);
  scene_free(&b->scene);
  free(b->y);
  free(b->scale);
}

struct range {
  size_t all, within; /* 0.95 to 1.25, no more than 20 % below or above 1.2 */
  double least, most;
};

static void range_add(struct range *r, double q) {
  r->least = r->all ? GSL_MIN(r->least, q) : q;
  r->most = r->all ? GSL_MAX(r->most, q) : q;
  r->all++;
  r->within += q >= 0.95 && q <= 1.25;
}

/* Adds the estimate in use by the spectral radius at the start of the step, for
   the steps from begin, after the first contacts, to end: those that have
   estimated it and those that use one of a step before. */
static void follow(enum scene_model model, size_t n, unsigned long seed,
                   double begin, double end, struct range range[2]) {
  struct bench b;
  bench_open(&b, model, n, 0.2, 0.3, seed);
  const gsl_odeiv2_system sys = {dynamics_rhs, NULL, b.dim, b.d};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, b.dim);
  gsl_odeiv2_control *c;
  CHECK(control_predictive_alloc(&c, 1e-3, 0, b.scale, b.dim) == GSL_SUCCESS);
  gsl_odeiv2_evolve *e = gsl_odeiv2_evolve_alloc(b.dim);
  double t = 0, h = 1e-4;
  size_t spent = 0, k = 0;
  while (t < end && k < 1000) {
    if (!CHECK(gsl_odeiv2_evolve_apply(e, c, step, &sys, &t, end, &h, b.y) ==
               GSL_SUCCESS))
      break;
    const struct rkc_report r = rkc_report(step);
    const bool old = r.power_evaluations == spent;
    spent = r.power_evaluations;
    CHECK(r.stages >= 2 && r.stages <= r.most_stages);
    const double start = t - e->last_step;
    /* of the large beds not every step: their eigenvalues take long */
    if (start >= begin && k++ % (1 + b.dim / 40) == 0)
      range_add(&range[old],
                r.spectral_radius / true_radius(b.d, start, e->y0));
  }
  CHECK(t == end);
  /* the price of estimates that are too low */
  CHECK(e->failed_steps < e->count / 3);
  gsl_odeiv2_evolve_free(e);
  gsl_odeiv2_control_free(c);
  gsl_odeiv2_step_free(step);
  bench_close(&b);
}

/* With its factor 1.2 the estimate is meant to be 1 to 1.2 of the radius. It
   comes from below, and stops at two iterations that agree to a quarter, or at
   three in all: while another contact takes over as the stiffest it is too low,
   by more than a half at times, and the step control has to notice. It is never
   much above, unless the radius has fallen since. So: most are right, and none
   is far above. */
static void test_radius(void) {
  static const char *const names[] = {"basic", "full"};
  for (int full = 0; full < 2; full++) {
    const enum scene_model model = full ? SCENE_ROTATION : SCENE_BASIC;
    struct range range[2] = {0};
    for (unsigned long seed = 1; seed <= 4; seed++) {
      follow(model, 8, seed, full ? 0.01 : 0.2, full ? 0.3 : 4, range);
      follow(model, 18, seed, full ? 0.01 : 0.1, full ? 0.3 : 2, range);
    }
    follow(model, 30, 1, full ? 0.01 : 0.1, full ? 0.3 : 2, range);
    for (int i = 0; i < 2; i++) {
      printf("%s, estimate by radius, of %s: %.3f to %.3f, %zu of %zu in 0.95 "
             "to 1.25\n",
             names[full], i ? "a step before" : "this step", range[i].least,
             range[i].most, range[i].within, range[i].all);
      CHECK(range[i].all > 20);
      CHECK((double)range[i].within >= 0.6 * (double)range[i].all);
      CHECK(range[i].least >= 0.1);
      CHECK(range[i].most <= (i ? 2 : 1.3));
    }
  }
}

/* Undamped oscillators, y'' = -w^2 y, positions in m and velocities in m/s: the
   radius is the largest w, not w^2, which a norm over both sees every second
   time. */
struct oscillators {
  size_t n;
  const double *w;
  double damping; /* share of w */
};

static int oscillators_f(double t, const double y[], double dydt[],
                         void *params) {
  (void)t;
  const struct oscillators *o = params;
  for (size_t i = 0; i < o->n; i++) {
    dydt[2 * i] = y[2 * i + 1];
    dydt[2 * i + 1] =
        -o->w[i] * o->w[i] * y[2 * i] - 2 * o->damping * o->w[i] * y[2 * i + 1];
  }
  return GSL_SUCCESS;
}

static void test_undamped(void) {
  static const double single[] = {1e3},
                      many[] = {1e3, 900, 800, 500, 300, 100, 10, 1};
  const struct {
    struct oscillators o;
    double off; /* of the estimate, as a share */
    size_t most;
  } cases[] = {/* rounding of differences: 1e-8 by 1e-3 */
               {{1, single, 0}, 1e-4, 3},
               {{1, single, 0.02}, 0.1, 50},
               /* others take part in it before they are behind */
               {{COUNT(many), many, 0}, 0.25, 50}};
  for (size_t k = 0; k < COUNT(cases); k++) {
    struct oscillators o = cases[k].o;
    const size_t dim = 2 * o.n;
    const gsl_odeiv2_system sys = {oscillators_f, NULL, dim, &o};
    double y[2 * COUNT(many)], yerr[2 * COUNT(many)];
    for (size_t i = 0; i < o.n; i++) {
      y[2 * i] = 1 / o.w[i];
      y[2 * i + 1] = 0; /* the derivative has no part in a position */
    }
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, dim);
    CHECK(gsl_odeiv2_step_apply(step, 0, 1.8e-3, y, yerr, NULL, NULL, &sys) ==
          GSL_SUCCESS);
    const struct rkc_report r = rkc_report(step);
    CHECK_REL(r.spectral_radius, 1.2e3, cases[k].off);
    CHECK(r.power_evaluations <= cases[k].most);
    CHECK(r.stages <= 3);
    gsl_odeiv2_step_free(step);
  }
}

/* A stiff mode apart from all others which the first slope has nothing of: the
   power iteration never sees it. The steps are then short but none is wrong. */
static void test_hidden_mode(void) {
  const double end = 0.1, tol = 1e-4;
  struct companion c = {.problem = &problems[2], .rate = 1e4};
  const gsl_odeiv2_system sys = companion_system(&c);
  static const double ones[] = {1, 1};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 2);
  gsl_odeiv2_control *control;
  CHECK(control_predictive_alloc(&control, tol, 0, ones, 2) == GSL_SUCCESS);
  gsl_odeiv2_evolve *e = gsl_odeiv2_evolve_alloc(2);
  double t = 0, h = 0.1, y[2], exact[2];
  companion_exact(&c, 0, y);
  while (t < end && e->count < 5000)
    if (!CHECK(gsl_odeiv2_evolve_apply(e, control, step, &sys, &t, end, &h,
                                       y) == GSL_SUCCESS))
      break;
  CHECK(t == end);
  companion_exact(&c, end, exact);
  /* the stiff unknown forgets all but the last steps' errors, of which the
     estimate may be a half; the other has none to speak of */
  CHECK_CLOSE(distance(2, y, exact), 0, 10 * tol);
  printf("hidden mode: radius %.3g of 1e4, %lu of %lu steps rejected\n",
         rkc_report(step).spectral_radius, e->failed_steps, e->count);
  gsl_odeiv2_evolve_free(e);
  gsl_odeiv2_control_free(control);
  gsl_odeiv2_step_free(step);
}

/* --- contract --------------------------------------------------------------*/

/* One apply; the derivatives are given or not by bits of which. */
static int apply(gsl_odeiv2_step *step, struct companion *c, int which,
                 double t, double h, double y[], double yerr[], double out[]) {
  const gsl_odeiv2_system sys = companion_system(c);
  double in[DIM];
  struct companion quiet = *c;
  quiet.fail_at = 0;
  companion_f(t, y, in, &quiet);
  return gsl_odeiv2_step_apply(step, t, h, y, yerr, which & 1 ? in : NULL,
                               which & 2 ? out : NULL, &sys);
}

static void test_type(void) {
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 3);
  CHECK(!strcmp(gsl_odeiv2_step_name(step), "rkc"));
  CHECK(gsl_odeiv2_step_order(step) == 2);
  const struct rkc_report r = rkc_report(step);
  CHECK(r.spectral_radius == 0 && r.stages == 0 && r.most_stages == 0 &&
        r.power_evaluations == 0);
  gsl_odeiv2_step_free(step);
}

static void test_derivatives(void) {
  static const double rates[] = {0, 20, 1e4};
  for (size_t i = 0; i < COUNT(rates); i++) {
    double y[4][DIM], yerr[4][DIM], out[4][DIM], want[DIM];
    struct companion c = {.problem = &problems[4], .rate = rates[i]};
    const size_t dim = companion_system(&c).dimension;
    for (int which = 0; which < 4; which++) {
      gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, dim);
      companion_exact(&c, 0.5, y[which]);
      c.calls = 0;
      CHECK(apply(step, &c, which, 0.5, 0.1, y[which], yerr[which],
                  out[which]) == GSL_SUCCESS);
      const struct rkc_report r = rkc_report(step);
      /* a slope at the start, one at each later stage, one at the end */
      CHECK(c.calls == r.power_evaluations + r.stages + !(which & 1));
      gsl_odeiv2_step_free(step);
      CHECK(same(dim, y[which], y[0]) && same(dim, yerr[which], yerr[0]));
    }
    companion_f(0.6, y[0], want, &c);
    CHECK(same(dim, out[2], want) && same(dim, out[3], want));
    /* the estimate as the authors give it; both sides round sums of 4 terms */
    double start[DIM], slope[DIM];
    companion_exact(&c, 0.5, start);
    companion_f(0.5, start, slope, &c);
    for (size_t k = 0; k < dim; k++)
      CHECK_CLOSE(yerr[0][k],
                  0.8 * (start[k] - y[0][k]) + 0.4 * 0.1 * (slope[k] + want[k]),
                  ULPS(4) * (1 + 0.1 * fabs(slope[k])));
  }
}

/* The call that fails may be any of the first step's, or of a later one's, with
   or without power iterations. */
static void test_failures(void) {
  struct companion c = {.problem = &problems[4], .rate = 2000};
  const double h = 0.05;
  for (int which = 0; which < 4; which++)
    for (size_t before = 0; before < 6; before++) {
      size_t calls = SIZE_MAX - 1;
      double good[DIM] = {0};
      for (size_t fail = 0; fail <= calls; fail++) { /* 0: to count them */
        gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 3);
        double y[DIM], begin[DIM], yerr[DIM], out[DIM], t = 0.5;
        companion_exact(&c, t, y);
        c.fail_at = 0;
        for (size_t k = 0; k < before; k++, t += h)
          CHECK(apply(step, &c, which, t, h, y, yerr, out) == GSL_SUCCESS);
        memcpy(begin, y, sizeof y);
        c.calls = 0;
        c.fail_at = fail;
        const int status = apply(step, &c, which, t, h, y, yerr, out);
        if (!fail) {
          CHECK(status == GSL_SUCCESS);
          calls = c.calls;
          memcpy(good, y, sizeof y);
        } else {
          CHECK(status == GSL_EBADFUNC);
          CHECK(c.calls == fail);
          CHECK(same(3, y, begin));
          /* and goes on; with an estimate of another start the stages may
             differ: two results of order 2 */
          CHECK(apply(step, &c, which, t, h, y, yerr, out) == GSL_SUCCESS);
          if (before)
            CHECK(distance(3, y, good) <= pow(h, 3));
          else
            CHECK(same(3, y, good));
        }
        gsl_odeiv2_step_free(step);
      }
      CHECK(calls > 5);
    }
}

/* More stages than any step has: left to the caller to shorten. */
static void test_too_stiff(void) {
  struct companion c = {.problem = &problems[4], .rate = 1e9};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, 3);
  double y[DIM], begin[DIM], yerr[DIM], out[DIM];
  companion_exact(&c, 0.5, y);
  memcpy(begin, y, sizeof y);
  CHECK(apply(step, &c, 3, 0.5, 0.1, y, yerr, out) == GSL_FAILURE);
  CHECK(same(3, y, begin));
  CHECK(apply(step, &c, 3, 0.5, 5e-5, y, yerr, out) == GSL_SUCCESS);
  CHECK(rkc_report(step).stages > 250);
  gsl_odeiv2_step_free(step);
}

/* A stepper of its own and one that is reset give the same bits. */
static void test_repeated(void) {
  struct companion c = {.problem = &problems[0], .rate = 3e3};
  gsl_odeiv2_step *used = gsl_odeiv2_step_alloc(rkc, 4);
  double y[3][DIM], yerr[3][DIM], out[DIM];
  for (int run = 0; run < 3; run++) {
    gsl_odeiv2_step *step = run ? used : gsl_odeiv2_step_alloc(rkc, 4);
    CHECK(gsl_odeiv2_step_reset(step) == GSL_SUCCESS);
    companion_exact(&c, 0.5, y[run]);
    for (int k = 0; k < 20; k++)
      CHECK(apply(step, &c, 3, 0.5 + 0.05 * k, 0.05, y[run], yerr[run], out) ==
            GSL_SUCCESS);
    if (!run)
      gsl_odeiv2_step_free(step);
    CHECK(same(4, y[run], y[0]) && same(4, yerr[run], yerr[0]));
  }
  gsl_odeiv2_step_free(used);
}

struct constant {
  size_t dim, calls;
  double slope;
};

static int constant_f(double t, const double y[], double dydt[], void *params) {
  (void)t, (void)y;
  struct constant *c = params;
  c->calls++;
  for (size_t i = 0; i < c->dim; i++)
    dydt[i] = c->slope * (double)(i + 1);
  return GSL_SUCCESS;
}

static void test_constant(void) {
  static const double slopes[] = {0, 1, -1e6};
  for (size_t dim = 1; dim <= 5; dim += 2)
    for (size_t i = 0; i < COUNT(slopes); i++)
      for (int at_zero = 0; at_zero < 2; at_zero++) {
        struct constant c = {.dim = dim, .slope = slopes[i]};
        const gsl_odeiv2_system sys = {constant_f, NULL, dim, &c};
        gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, dim);
        double y[5], yerr[5], out[5];
        for (size_t k = 0; k < dim; k++)
          y[k] = at_zero ? 0 : 1;
        for (int n = 0; n < 3; n++)
          CHECK(gsl_odeiv2_step_apply(step, n, 1, y, yerr, NULL, out, &sys) ==
                GSL_SUCCESS);
        for (size_t k = 0; k < dim; k++) {
          const double rise = slopes[i] * (double)(k + 1);
          /* few stages, few roundings */
          const double tol = ULPS(20) * (1 + 3 * fabs(rise));
          CHECK_CLOSE(y[k], !at_zero + 3 * rise, tol);
          CHECK_CLOSE(yerr[k], 0, tol);
          CHECK(out[k] == rise);
        }
        CHECK(rkc_report(step).stages == 2);
        CHECK(rkc_report(step).spectral_radius == 0);
        if (dim == 5 && i == 1 && at_zero)
          printf("constant slope: %zu evaluations for 3 steps\n", c.calls);
        gsl_odeiv2_step_free(step);
      }
}

/* A process that has the slow half of a state, given sums over both halves,
   computes what the process that has all of it does. The sums come from a
   record of that one's. */
enum { HALF = 3, WHOLE = 2 * HALF, SUMS = 1000 };

struct decay {
  size_t n, sums;
  double sum[SUMS];
  const double *replay; /* NULL: all of the state is here */
};

static int decay_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const struct decay *d = params;
  for (size_t i = 0; i < d->n; i++)
    dydt[i] = -pow(10, 1 + 0.5 * (double)i) * (y[i] - 1);
  return GSL_SUCCESS;
}

static double decay_total(double part, void *params) {
  struct decay *d = params;
  const double all = d->replay ? d->replay[d->sums] : part;
  CHECK(d->sums < SUMS && part <= all);
  d->sum[d->sums++] = all;
  return all;
}

static void test_shared(void) {
  struct decay decay[2] = {{.n = WHOLE}, {.n = HALF, .replay = decay[0].sum}};
  double weight[WHOLE], y[2][WHOLE] = {{0}}, f[2][WHOLE], error[2][WHOLE];
  double direction[2][WHOLE], work[5 * WHOLE];
  struct rkc_step step[2];
  for (size_t i = 0; i < WHOLE; i++)
    weight[i] = 1 + (double)i;
  for (int k = 0; k < 2; k++) {
    const struct rkc_problem p = {.dim = decay[k].n,
                                  .rates = decay_f,
                                  .params = &decay[k],
                                  .total = decay_total,
                                  .weight = weight,
                                  .threads = 1};
    CHECK(rkc_step_init(&step[k], direction[k]) == GSL_SUCCESS);
    CHECK(decay_f(0, y[k], f[k], &decay[k]) == GSL_SUCCESS);
    for (int n = 0; n < 10; n++)
      CHECK(rkc_step_try(&step[k], &p, 0.05 * n, 0.05, y[k], error[k], f[k],
                         f[k], work) == GSL_SUCCESS);
  }
  CHECK(decay[0].sums == decay[1].sums && decay[0].sums > 6);
  CHECK(step[0].power.radius == step[1].power.radius);
  CHECK(step[0].report.stages == step[1].report.stages);
  CHECK(same(HALF, y[0], y[1]) && same(HALF, error[0], error[1]));
  for (int k = 0; k < 2; k++)
    rkc_step_free(&step[k]);
}

/* --- a bed, against merson -------------------------------------------------*/

static double travel_limit(const double y[], const double dydt[],
                           void *params) {
  const struct bench *b = params;
  return dynamics_step_limit(b->d, y, dydt, 1 / b->scene.law.kappa);
}

static int bench_rhs(double t, const double y[], double dydt[], void *params) {
  return dynamics_rhs(t, y, dydt, ((struct bench *)params)->d);
}

static int bench_stage(double t, const double y[], const struct stage *g,
                       double out[], void *params) {
  return dynamics_stage(t, y, g, out, ((struct bench *)params)->d);
}

/* 20 spheres let go into a box, at 0.6 s. */
static size_t settle(const char *method, const char *control, double tol,
                     struct bed *out) {
  struct bench b;
  bench_open(&b, SCENE_ROTATION, 20, 0.205, 0, 1);
  for (size_t i = 0; i < 20; i++)
    b.bed.x[3 * i + 2] += 0.1;
  dynamics_pack(b.d, &b.bed, b.y);
  const struct integrate_problem p = {.system = {bench_rhs, NULL, b.dim, &b},
                                      .scale = b.scale,
                                      .row = dynamics_stride(b.d),
                                      .positions = 3,
                                      .step_limit = travel_limit,
                                      .stage = bench_stage};
  const struct integrate_options o = {
      .method = method, .control = control, .tol = tol, .hinit = 1e-3};
  struct integrator *it = NULL;
  if (!CHECK(integrate_alloc(&it, &o, &p, 0, b.y) == GSL_SUCCESS))
    exit(check_done());
  while (integrate_time(it) < 0.6)
    if (!CHECK(integrate_step(it) == GSL_SUCCESS))
      break;
  CHECK(integrate_at(it, 0.6, b.y) == GSL_SUCCESS);
  if (bed_alloc(out, 20) != GSL_SUCCESS)
    exit(99);
  dynamics_unpack(b.d, b.y, out);
  printf("%s %g: %zu steps, %zu rejected, %zu evaluations\n", method, tol,
         integrate_counts(it).accepted, integrate_counts(it).rejected,
         dynamics_counts(b.d).evaluations);
  const size_t steps = integrate_counts(it).accepted;
  integrate_free(it);
  bench_close(&b);
  return steps;
}

static void test_bed(void) {
  struct bed want, tight, got[3];
  settle("merson", "standard", 1e-8, &want);
  settle("merson", "standard", 1e-9, &tight);
  const double floor_error = distance(60, want.x, tight.x);
  double off[3];
  for (int k = 0; k < 3; k++) {
    const double tol = pow(10, -4 - k);
    const size_t steps = settle("rkc", "predictive", tol, &got[k]);
    off[k] = distance(60, got[k].x, want.x);
    /* each step adds at most tol/kappa to a position; the bed is compared
       before chaos makes more of it */
    CHECK(off[k] <= (double)steps * tol / 150);
    /* order 2: local errors of h^3 = tol, in all tol^(2/3), a factor 4.6 */
    CHECK(!k || (off[k] > off[k - 1] / 10 && off[k] < off[k - 1] / 2));
    bed_free(&got[k]);
  }
  printf("20 spheres, 0.6 s: merson 1e-8 by 1e-9 %.2g m; rkc by merson %.2g, "
         "%.2g, %.2g m for 1e-4, 1e-5, 1e-6\n",
         floor_error, off[0], off[1], off[2]);
  CHECK(floor_error < 0.1 * off[2]); /* the reference is one */
  bed_free(&want);
  bed_free(&tight);
}

/* --- when the spectral radius is looked for --------------------------------*/

/* Heat in a rod with insulated ends, whose modes decay at
   2 - 2 cos(pi k/ROD): no mode at all where it is equally warm. */
enum { ROD = 20 };

static int heat(double t, const double y[], double dydt[], void *params) {
  (void)t;
  for (size_t i = 0; i < ROD; i++)
    dydt[i] = (i ? y[i - 1] - y[i] : 0) + (i + 1 < ROD ? y[i + 1] - y[i] : 0);
  return *(const bool *)params ? GSL_EBADFUNC : GSL_SUCCESS;
}

/* At the start, after a step that was rejected or failed, else not in each
   step; and where f is 0, so that it shows no direction. */
static void test_estimates(void) {
  bool fails = false;
  double direction[ROD], weight[ROD], y[ROD], error[ROD], f[ROD], next[ROD],
      work[5 * ROD];
  for (size_t i = 0; i < ROD; i++)
    weight[i] = y[i] = 1;
  const struct rkc_problem p = {.dim = ROD,
                                .rates = heat,
                                .params = &fails,
                                .weight = weight,
                                .threads = 1};
  const struct {
    double t;
    bool fails, looks;
  } tries[] = {{0, false, true},  {0, false, true},  {1, false, false},
               {2, true, false},  {3, false, true},  {4, false, false},
               {5, false, false}, {6, false, false}, {7, false, false},
               {8, false, true}};
  const double fastest = 2 + 2 * cos(M_PI / ROD);
  struct rkc_step step;
  CHECK(rkc_step_init(&step, direction) == GSL_SUCCESS);
  size_t spent = 0;
  for (size_t k = 0; k < COUNT(tries); k++) {
    CHECK(heat(0, y, f, &(bool){false}) == GSL_SUCCESS);
    fails = tries[k].fails;
    CHECK(rkc_step_try(&step, &p, tries[k].t, 1, y, error, f, next, work) ==
          (fails ? GSL_EBADFUNC : GSL_SUCCESS));
    CHECK((step.report.power_evaluations > spent) == tries[k].looks);
    spent = step.report.power_evaluations;
    /* too large by a fifth, for safety */
    CHECK(step.report.spectral_radius >= fastest &&
          step.report.spectral_radius <= 1.2 * fastest);
  }
  rkc_step_free(&step);
}

int main(void) {
  gsl_set_error_handler_off();
  test_type();
  test_orders();
  test_stiff_order();
  test_reach();
  test_schemes();
  test_stability_polynomial();
  test_oblique();
  test_radius();
  test_undamped();
  test_hidden_mode();
  test_derivatives();
  test_failures();
  test_too_stiff();
  test_repeated();
  test_constant();
  test_shared();
  test_estimates();
  test_bed();
  return check_done();
}
