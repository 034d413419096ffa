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
#include <stdlib.h>
#include <string.h>
#include "bed.h"
#include "check.h"
#include "control.h"
#include "dynamics.h"
#include "integrate.h"
#include "rkc.h"
#include "scene.h"

#define ULPS(n) ((n)*DBL_EPSILON)
#define COUNT(array) (sizeof(array) / sizeof *(array))

static double *numbers(size_t n) {
  double *x = calloc(n, sizeof *x);
  if (!x)
    exit(99);
  return x;
}

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
    {"3x3", 3, three_f, three, 0, 2},
    {"-y + cos t", 1, driven_f, driven, 0, 2},
    {"logistic", 1, logistic_f, logistic, 0, 3},
    {"-t y^3", 1, cube_f, cube, 0.5, 3},
    {"circle", 2, circle_f, circle, 0, 2}};

/* A problem and, where rate > 0, one unknown more, apart from the others,
   y' = -rate (y - cos t) - sin t with the solution cos t, which makes the
   stage number what we like. */
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

/* Prothero and Robinson: the error while h * rate is large. */
static void test_stiff_order(void) {
  static const double rates[] = {1e4, 1e6};
  for (size_t i = 0; i < COUNT(rates); i++) {
    double x[POINTS], y[POINTS];
    size_t first = 0, last = 0;
    for (int k = 0; k < POINTS; k++) {
      const double n = floor((i ? 64 : 16) * pow(2, 0.25 * k));
      struct companion c = {.rate = rates[i]};
      x[k] = -log(n);
      y[k] = log(global_error(&c, 1, 0.3, 2.3, (size_t)n, k ? &last : &first));
    }
    printf("rate %g: order %.3f with %zu to %zu stages, error %.2g\n", rates[i],
           slope_of(POINTS, x, y), last, first, exp(y[POINTS - 1]));
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
  const double s = (double)stages, e = damping / (s * s);
  const double theta = 2 * asinh(sqrt(e / 2)), w0 = 1 + e;
  const double t = cosh(s * theta), d = s * sinh(s * theta) / sinh(theta);
  const double dd = (s * s * t - w0 * d) / (e * (2 + e));
  const double b = dd / (d * d);
  return (struct polynomial){s, 1 - b * t, b, w0, d / dd};
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
    CHECK_REL(rkc_reach(s), (p.w0 + 1) / p.w1, ULPS(50 * sd));
    /* authors' expansion; its next term is of the order of damping^2 */
    CHECK_REL(rkc_reach(s), 2. / 3 * (sd * sd - 1) * (1 - 2. / 15 * damping),
              0.1 * damping * damping);
    CHECK(rkc_reach(s) >= 0.6 * sd * sd || s < 4);
  }
  printf("reach/s^2: %.4f (2) %.4f (3) %.4f (4) %.4f (10) %.4f (60)\n",
         rkc_reach(2) / 4, rkc_reach(3) / 9, rkc_reach(4) / 16,
         rkc_reach(10) / 100, rkc_reach(60) / 3600);
}

static void test_stability_polynomial(void) {
  enum { N = 4001 };
  static double complex lambda[N + 1], r[N + 1], e[N + 1];
  const double factor = safety();
  CHECK_CLOSE(factor, 1.2, 1e-6);
  double worst = 0;
  for (size_t s = 2; s <= 60; s++) {
    const double reach = rkc_reach(s);
    const struct polynomial p = polynomial(s);
    for (size_t i = 0; i < N; i++)
      lambda[i + 1] = -reach * (double)i / (N - 1);
    /* no more stages than it takes, and no fewer; the difference quotient is
       good to 1e-7 */
    CHECK(one_step(reach * (1 + 1e-5) / factor, 1, lambda, r, NULL) == s + 1);
    CHECK(one_step(reach * (1 - 1e-5) / factor, N + 1, lambda, r, e) == s);
    /* rounding of s stages of which none amplifies more than linearly */
    const double tol = ULPS((double)(s * s));
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
  printf("R(z): rounding at most %.2g of s^2 ulps\n", worst);
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
      const double most = k ? 1.2 * rkc_reach(s) / hypot(1, ratios[k]) : 0.1;
      for (int j = 1; j <= N; j++)
        lambda[j] = (-ratios[k] + I) * most * j / N;
      CHECK(one_step(rkc_reach(s) * (1 - 1e-5) / factor, N + 1, lambda, r,
                     NULL) == s);
      int j = 1, want = 1;
      while (j <= N && cabs(r[j]) <= 1 + 1e-9)
        j++;
      while (want <= N && cabs(value(&p, lambda[want])) <= 1 + 1e-9)
        want++;
      printf("%9.4f", most * (j - 1) / N);
      CHECK(abs(j - want) <= 1);
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
    for (int k = 0; k < 3; k++) {
      b->x[3 * i + k] = r + spacing * (double)at[k] +
                        0.1 * r * (gsl_rng_uniform(rng) - 0.5);
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
    most = GSL_MAX(most, gsl_complex_abs(gsl_vector_complex_get(eigenvalue, i)));
  gsl_eigen_nonsymm_free(w);
  gsl_vector_complex_free(eigenvalue);
  free(jacobian);
  free(dfdt);
  return most;
}

static void follow(enum scene_model model, size_t n, double spacing,
                   double speed, size_t steps, size_t every) {
  struct scene s = scene_default();
  s.model = model;
  struct bed b;
  pressed_bed(&b, n, spacing, speed, 1);
  if (scene_add_box(&s, 0.4, 0.4) != GSL_SUCCESS)
    exit(99);
  const struct dynamics_options one = {.threads = 1};
  struct dynamics *d = dynamics_alloc(&s, &b, &one);
  const size_t dim = dynamics_dimension(d);
  double *y = numbers(dim), *scale = numbers(dim);
  dynamics_pack(d, &b, y);
  dynamics_scale(d, scale);
  const gsl_odeiv2_system sys = {dynamics_rhs, NULL, dim, d};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(rkc, dim);
  gsl_odeiv2_control *c = control_predictive_new(1e-3, 0, scale, dim);
  gsl_odeiv2_evolve *e = gsl_odeiv2_evolve_alloc(dim);
  double t = 0, h = 1e-4;
  size_t spent = 0;
  double lo[2] = {1e300, 1e300}, hi[2] = {0, 0}; /* fresh, stale */
  double big = 0;
  size_t out[2] = {0}, all[2] = {0};
  for (size_t k = 0; k < steps; k++) {
    if (!CHECK(gsl_odeiv2_evolve_apply(e, c, step, &sys, &t, 10, &h, y) ==
               GSL_SUCCESS))
      break;
    const struct rkc_report r = rkc_report(step);
    const int stale = r.power_evaluations == spent;
    spent = r.power_evaluations;
    if (k % every)
      continue;
    const double radius = true_radius(d, t - e->last_step, e->y0);
    const double q = r.spectral_radius / radius;
    big = GSL_MAX(big, radius);
    lo[stale] = GSL_MIN(lo[stale], q);
    hi[stale] = GSL_MAX(hi[stale], q);
    all[stale]++;
    out[stale] += !(q >= 0.95 && q <= 1.25);
    if (getenv("V"))
      printf("k %zu t %.4g h %.3g true %.4g est %.4g q %.3f %s s %zu hr %.3g rej %lu\n", k, t,
             e->last_step, radius, r.spectral_radius, q, stale ? "old" : "new",
             r.stages, e->last_step * radius, e->failed_steps);
  }
  printf("model %d n %zu t %.3g radius %.3g power %zu: fresh [%.3f %.3f] %zu/%zu out, old [%.3f "
         "%.3f] %zu/%zu out, rejected %lu of %lu, evals %zu\n",
         model, n, t, big, spent, lo[0], hi[0], out[0], all[0], lo[1], hi[1], out[1],
         all[1], e->failed_steps, e->count, dynamics_counts(d).evaluations);
  gsl_odeiv2_evolve_free(e);
  gsl_odeiv2_control_free(c);
  gsl_odeiv2_step_free(step);
  dynamics_free(d);
  bed_free(&b);
  scene_free(&s);
  free(y);
  free(scale);
}

static void test_radius(void) {
  follow(SCENE_ROTATION, 8, 0.2, 0.3, 400, 3);
  follow(SCENE_ROTATION, 18, 0.2, 0.3, 300, 7);
  follow(SCENE_ROTATION, 30, 0.2, 0.3, 300, 17);
  follow(SCENE_BASIC, 8, 0.2, 0.3, 400, 3);
  follow(SCENE_BASIC, 30, 0.2, 0.3, 300, 13);
}

int main(void) {
  gsl_set_error_handler_off();
  test_orders();
  test_stiff_order();
  test_reach();
  test_stability_polynomial();
  test_oblique();
  test_radius();
  return check_done();
}
