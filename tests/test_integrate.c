/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The free-running integrator: accuracy, bookkeeping, interpolation, limits of
   the step, and what remains after a failure. Two oscillators of the form that
   the dynamics has, rows of a position and a velocity, serve throughout. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "steppers/dopri5.h"
#include "steppers/integrate.h"
#include "steppers/merson.h"

#define ULPS(n) ((n)*DBL_EPSILON)
#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { DIM = 4 };

/* Those with an error estimate, for a control to choose the step by; the rest
   is verlet, and multirate, which needs spheres: loops over controls end before
   its own, which is the last. */
static const char *const adaptive_methods[] = {
    "merson", "dopri5", "rkf45", "rkck", "rk8pd", "rkc", "msbdf", NULL};

static const double ones[DIM] = {1, 1, 1, 1};

/* Counts its calls; from call fail_from to fail_to it writes rubbish and
   returns code. */
struct oscillators {
  size_t calls, fail_from, fail_to;
  int code;
  size_t limits; /* calls of the step limit */
};

static const double frequency[2] = {1, 2};

static int oscillators_f(double t, const double y[], double dydt[],
                         void *params) {
  (void)t;
  struct oscillators *o = params;
  o->calls++;
  if (o->calls >= o->fail_from && o->calls <= o->fail_to) {
    for (int i = 0; i < DIM; i++)
      dydt[i] = GSL_NAN;
    return o->code;
  }
  for (int k = 0; k < 2; k++) {
    dydt[2 * k] = y[2 * k + 1];
    dydt[2 * k + 1] = -frequency[k] * frequency[k] * y[2 * k];
  }
  return GSL_SUCCESS;
}

static int oscillators_jacobian(double t, const double y[], double *dfdy,
                                double dfdt[], void *params) {
  (void)t, (void)y, (void)params;
  memset(dfdy, 0, DIM * DIM * sizeof *dfdy);
  memset(dfdt, 0, DIM * sizeof *dfdt);
  for (int k = 0; k < 2; k++) {
    dfdy[2 * k * DIM + 2 * k + 1] = 1;
    dfdy[(2 * k + 1) * DIM + 2 * k] = -frequency[k] * frequency[k];
  }
  return GSL_SUCCESS;
}

static void oscillators_exact(double t, double y[]) {
  for (int k = 0; k < 2; k++) {
    y[2 * k] = cos(frequency[k] * t);
    y[2 * k + 1] = -frequency[k] * sin(frequency[k] * t);
  }
}

static struct integrate_problem oscillators(struct oscillators *o) {
  return (struct integrate_problem){
      .system = {oscillators_f, oscillators_jacobian, DIM, o},
      .scale = ones,
      .row = 2,
      .positions = 1};
}

static struct integrate_options options(const char *method) {
  return (struct integrate_options){
      .method = method, .control = "standard", .tol = 1e-8, .hinit = 0.1};
}

static struct integrator *start(const struct integrate_options *o,
                                const struct integrate_problem *p, double t,
                                const double y[]) {
  struct integrator *it = NULL;
  if (!CHECK(integrate_alloc(&it, o, p, t, y) == GSL_SUCCESS)) {
    fprintf(stderr, "  method %s, control %s\n", o->method, o->control);
    exit(check_done());
  }
  return it;
}

static struct integrator *start_oscillators(const struct integrate_options *o,
                                            const struct integrate_problem *p) {
  double y[DIM];
  oscillators_exact(0, y);
  return start(o, p, 0, y);
}

static double distance(const double x[], const double y[]) {
  double most = 0;
  for (int i = 0; i < DIM; i++)
    if (!(fabs(x[i] - y[i]) <= most)) /* NaN stays */
      most = fabs(x[i] - y[i]);
  return most;
}

static double error_now(const struct integrator *it) {
  double exact[DIM];
  oscillators_exact(integrate_time(it), exact);
  return distance(integrate_state(it), exact);
}

static bool same(const double x[], const double y[]) {
  return !memcmp(x, y, DIM * sizeof *x);
}

/* One step that moves the time, of not too many: no test here needs half. */
static bool step(struct integrator *it) {
  const double from = integrate_time(it);
  return integrate_step(it) == GSL_SUCCESS && integrate_time(it) > from &&
         integrate_counts(it).accepted < 100000;
}

static bool run(struct integrator *it, double end) {
  while (integrate_time(it) < end)
    if (!step(it))
      return false;
  return true;
}

/* --- accuracy --------------------------------------------------------------*/

/* A local error of at most tol (1.1 tol by GSL's controls, delta h/3 by the
   paper's) in an unknown grows at most by the ratio of an oscillator's axes, 2;
   the local error itself may be twice its estimate, which is right to leading
   order only. */
static void test_tolerance(void) {
  const double end = 5;
  for (size_t m = 0; adaptive_methods[m]; m++) {
    double most = 0;
    for (size_t c = 0; integrate_controls[c].alloc; c++)
      for (int k = 0; k < 2; k++) {
        struct oscillators o = {0};
        const struct integrate_problem p = oscillators(&o);
        struct integrate_options opt = options(adaptive_methods[m]);
        opt.control = integrate_controls[c].name;
        opt.tol = k ? 1e-7 : 1e-4;
        struct integrator *it = start_oscillators(&opt, &p);
        CHECK(run(it, end));
        const size_t steps = integrate_counts(it).accepted;
        const bool paper = !strcmp(opt.control, "paper");
        const double sum = paper ? integrate_time(it) * opt.tol / 3
                                 : 1.1 * (double)steps * opt.tol;

        if (!(CHECK(error_now(it) <= 4 * sum) &
              CHECK(integrate_time(it) >= end) & CHECK(steps > 0)))
          fprintf(stderr, "  %s, %s, %g: error %g in %zu steps\n", opt.method,
                  opt.control, opt.tol, error_now(it), steps);
        most = GSL_MAX(most, error_now(it) / sum);
        integrate_free(it);
      }
    printf("%s: error at most %.2g of the tolerances' sum\n",
           adaptive_methods[m], most);
  }
}

/* GSL's stiff standard: eigenvalues -1 and -1000. */
static int stiff_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  ++*(size_t *)params;
  dydt[0] = 998 * y[0] + 1998 * y[1];
  dydt[1] = -999 * y[0] - 1999 * y[1];
  return GSL_SUCCESS;
}

static int stiff_jacobian(double t, const double y[], double *dfdy,
                          double dfdt[], void *params) {
  (void)t, (void)y, (void)params;
  const double j[] = {998, 1998, -999, -1999};
  memcpy(dfdy, j, sizeof j);
  dfdt[0] = dfdt[1] = 0;
  return GSL_SUCCESS;
}

static size_t stiff_evaluations(const char *method, double tol, double *error) {
  size_t calls = 0;
  const struct integrate_problem p = {
      .system = {stiff_f, stiff_jacobian, 2, &calls}, .scale = ones};
  struct integrate_options opt = options(method);
  opt.tol = tol;
  opt.hinit = 1e-4;
  struct integrator *it = start(&opt, &p, 0, (const double[]){1, 0});
  CHECK(run(it, 10));
  const double t = integrate_time(it), *y = integrate_state(it);
  *error = hypot(y[0] - (2 * exp(-t) - exp(-1000 * t)),
                 y[1] - (-exp(-t) + exp(-1000 * t)));
  CHECK(*error <= 4 * 1.1 * tol * (double)integrate_counts(it).accepted);
  integrate_free(it);
  return calls;
}

/* Stability lets merson take steps of 3.548/1000 s at five evaluations. */
static void test_stiff(void) {
  const double merson_least = 10 / 3.548e-3 * 5;
  double loose, tight, other;
  const size_t calls = stiff_evaluations("msbdf", 1e-5, &loose);
  CHECK((double)calls < 0.1 * merson_least);
  stiff_evaluations("msbdf", 1e-8, &tight);
  CHECK(tight < loose);
  CHECK((double)stiff_evaluations("merson", 1e-5, &other) > 0.9 * merson_least);
  CHECK((double)stiff_evaluations("rkc", 1e-5, &other) < merson_least);
}

/* abstol stands for tol, scale multiplies it: powers of two, equal bits.
   reltol adds to it. */
static void test_scale(void) {
  static const double small[DIM] = {1. / 1024, 1. / 1024, 1. / 1024, 1. / 1024};
  struct oscillators o = {0};
  struct integrate_problem p = oscillators(&o);
  struct integrate_options opt = options("merson");
  for (size_t c = 0; integrate_controls[c].alloc; c++) {
    opt = options("merson");
    opt.control = integrate_controls[c].name;
    if (!strcmp(opt.control, "paper"))
      continue; /* has one tolerance for all */
    struct integrator *a = start_oscillators(&opt, &p);
    opt.abstol = 1024 * opt.tol;
    opt.tol = 1;
    p.scale = small;
    struct integrator *b = start_oscillators(&opt, &p);
    CHECK(run(a, 5) && run(b, 5));
    CHECK(same(integrate_state(a), integrate_state(b)));
    CHECK(integrate_time(a) == integrate_time(b));
    const size_t steps = integrate_counts(b).accepted;
    integrate_free(a);
    integrate_free(b);
    opt.reltol = 1e-4;
    b = start_oscillators(&opt, &p);
    CHECK(run(b, 5));
    CHECK(integrate_counts(b).accepted < steps);
    integrate_free(b);
    /* each unknown by its own: that of one alone made small */
    const double mixed[DIM] = {1, 1, 1, 1e-4};
    p.scale = mixed;
    opt = options("merson");
    opt.control = integrate_controls[c].name;
    b = start_oscillators(&opt, &p);
    CHECK(run(b, 5));
    /* fourth order, and 1e4 in the tolerance: 1e2 with Merson's linear
       estimate O(h^5), times 6 in the number of steps */
    CHECK(integrate_counts(b).accepted > 3 * steps);
    integrate_free(b);
    p.scale = ones;
  }
}

/* --- options ---------------------------------------------------------------*/

static bool refused(const struct integrate_options *o,
                    const struct integrate_problem *p) {
  double y[DIM];
  oscillators_exact(0, y);
  struct integrator *it = NULL;
  const int status = integrate_alloc(&it, o, p, 0, y);
  if (status == GSL_SUCCESS)
    integrate_free(it);
  return status == GSL_EINVAL && !it;
}

static void test_options(void) {
  struct oscillators o = {0};
  const struct integrate_problem p = oscillators(&o);
  const char *unknown[] = {"", "Merson", "merson ", "mers", "rk4", "standard"};
  for (size_t k = 0; k < COUNT(unknown); k++) {
    struct integrate_options opt = options(unknown[k]);
    CHECK(refused(&opt, &p));
    opt.step = 0.1;
    CHECK(refused(&opt, &p));
  }
  const char *no_control[] = {"", "Paper", "pap", "merson"};
  for (size_t k = 0; k < COUNT(no_control); k++) {
    struct integrate_options opt = options("merson");
    opt.control = no_control[k];
    CHECK(refused(&opt, &p));
  }
  const double no_step[] = {0, -0.1, GSL_NAN, GSL_POSINF};
  for (size_t k = 0; k < COUNT(no_step); k++) {
    struct integrate_options opt = options("merson");
    opt.hinit = no_step[k];
    CHECK(refused(&opt, &p));
  }
  for (size_t c = 0; integrate_controls[c].alloc; c++) {
    struct integrate_options opt = options("merson");
    opt.control = integrate_controls[c].name;
    opt.tol = -1;
    CHECK(refused(&opt, &p));
    opt.tol = 0;
    CHECK(refused(&opt, &p));
    opt.tol = GSL_NAN;
    CHECK(refused(&opt, &p));
  }
  CHECK(o.calls == 0);
  integrate_free(NULL);

  /* every method is known to these tests, and the other way round */
  size_t methods = 0, listed = 0;
  for (; integrate_methods[methods].name; methods++)
    for (size_t m = 0; adaptive_methods[m]; m++)
      listed += !strcmp(integrate_methods[methods].name, adaptive_methods[m]);
  CHECK(listed == COUNT(adaptive_methods) - 1);
  CHECK(methods == listed + 2); /* verlet; multirate: test_multirate.c */

  /* no control is looked at where steps are fixed */
  struct integrate_options opt = options("merson");
  opt.control = NULL;
  opt.step = 0.01;
  struct integrator *it = start_oscillators(&opt, &p);
  CHECK(integrate_step(it) == GSL_SUCCESS);
  integrate_free(it);

  /* verlet: without a fixed step, without positions, with rows that do not
     add up to the unknowns or have no room for the velocities */
  for (size_t c = 0; integrate_controls[c].alloc; c++) {
    opt = options("verlet");
    opt.control = integrate_controls[c].name;
    CHECK(refused(&opt, &p));
  }
  const size_t layouts[][2] = {{2, 0}, {0, 0}, {3, 1}, {8, 1}, {2, 2}, {4, 3}};
  for (size_t k = 0; k < COUNT(layouts); k++) {
    struct integrate_problem other = oscillators(&o);
    other.row = layouts[k][0];
    other.positions = layouts[k][1];
    opt = options("verlet");
    opt.step = 0.1;
    if (!CHECK(refused(&opt, &other)))
      fprintf(stderr, "  row %zu, positions %zu\n", other.row, other.positions);
  }

  /* msbdf: GSL's needs a tolerance and a Jacobian, or follows a null pointer */
  opt = options("msbdf");
  opt.step = 0.01;
  CHECK(refused(&opt, &p));
  struct integrate_problem without = oscillators(&o);
  without.system.jacobian = NULL;
  opt = options("msbdf");
  CHECK(refused(&opt, &without));
}

/* With damping, so that the rates at a half step differ from those at its
   end. */
static int damped_f(double t, const double y[], double dydt[], void *params) {
  oscillators_f(t, y, dydt, params);
  for (int k = 0; k < 2; k++)
    dydt[2 * k + 1] -= 0.5 * y[2 * k + 1];
  return GSL_SUCCESS;
}

/* What the tables say of each method and control is what it does. */
static void test_tables(void) {
  struct oscillators o = {0};
  CHECK(!integrate_method(NULL) && !integrate_method("none"));
  CHECK(!integrate_control(NULL) && !integrate_control("none"));
  for (const struct integrate_control *c = integrate_controls; c->name; c++) {
    CHECK(integrate_control(c->name) == c && c->help && c->tol > 0);
    struct integrate_options opt = {.method = "merson", .control = c->name};
    integrate_defaults(&opt);
    CHECK(opt.tol == c->tol && !strcmp(opt.control, c->name));
    /* abstol counts where tol is not a bound per unit step */
    opt = options("merson");
    opt.control = c->name;
    opt.tol = 0;
    opt.abstol = 1e-6;
    const struct integrate_problem p = oscillators(&o);
    double y[DIM] = {0};
    struct integrator *it = NULL;
    CHECK((integrate_alloc(&it, &opt, &p, 0, y) == GSL_EINVAL) ==
          (c->per_time || !c->alloc));
    integrate_free(it);
  }
  /* the paper's own, and those that its figures were drawn with */
  static const struct {
    const char *name;
    double tol;
  } usual[] = {{"paper", 0.1}, {"standard", 5e-4}, {"predictive", 5e-4}};
  for (size_t k = 0; k < sizeof usual / sizeof *usual; k++) {
    struct integrate_options opt = {.method = "merson",
                                    .control = usual[k].name};
    integrate_defaults(&opt);
    CHECK(opt.tol == usual[k].tol);
  }
  for (const struct integrate_method *m = integrate_methods; m->name; m++) {
    struct integrate_options opt = {.method = m->name};
    integrate_defaults(&opt);
    CHECK(integrate_method(m->name) == m && m->help);
    CHECK(!strcmp(opt.control, m->control->name) && opt.tol == m->control->tol);
    for (int k = 0; k < 8; k++) { /* with or without step, Jacobian, layout */
      struct integrate_problem p = oscillators(&o);
      opt = options(m->name);
      opt.step = k & 1 ? 0.01 : 0;
      p.system.function = damped_f;
      if (!(k & 2))
        p.system.jacobian = NULL;
      if (!(k & 4))
        p.positions = 0;
      /* these have no method of their own */
      const bool fits = m->type && (k & 1 ? m->fixed : m->estimates) &&
                        (k & 2 || !m->jacobian) && (k & 4 || !m->layout);
      double y[DIM];
      oscillators_exact(0, y);
      struct integrator *it = NULL;
      CHECK(integrate_alloc(&it, &opt, &p, 0, y) ==
            (fits ? GSL_SUCCESS : GSL_EINVAL));
      if (fits && CHECK(integrate_step(it) == GSL_SUCCESS)) {
        double f[DIM];
        damped_f(0, integrate_state(it), f, &o);
        CHECK(same(f, integrate_derivative(it)) == !m->half ||
              /* msbdf's own, to its tolerance */
              (m->jacobian && distance(f, integrate_derivative(it)) < 1e-3));
      }
      integrate_free(it);
    }
    struct stiffness_limits l;
    CHECK(integrate_limits(m->name, &l) ==
          (m->adapts ? GSL_EINVAL : GSL_SUCCESS));
  }
}

/* --- bookkeeping -----------------------------------------------------------*/

/* Every attempt costs what the method costs, the first derivative one more:
   so the counts can be told from the number of evaluations. */
static void test_counts(void) {
  const struct {
    const char *method;
    size_t evaluations;
  } costs[] = {
      {"merson", 5}, {"dopri5", 6}, {"rkf45", 6}, {"rkck", 6}, {"rk8pd", 13}};
  for (size_t m = 0; m < COUNT(costs); m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++) {
      struct oscillators o = {0};
      const struct integrate_problem p = oscillators(&o);
      struct integrate_options opt = options(costs[m].method);
      opt.control = integrate_controls[c].name;
      opt.hinit = 3; /* to be rejected */
      struct integrator *it = start_oscillators(&opt, &p);
      CHECK(integrate_counts(it).accepted == 0);
      CHECK(integrate_counts(it).rejected == 0);
      CHECK(integrate_time(it) == 0);
      size_t steps = 0;
      double t = 0;
      bool tells = true;
      while (t < 5 && (step(it) || CHECK(!"a step"))) {
        steps++;
        const struct integrate_counts n = integrate_counts(it);
        double dydt[DIM];
        tells = tells && n.accepted == steps &&
                o.calls == 1 + costs[m].evaluations * (n.accepted + n.rejected);
        /* one step forward from where it was, and its derivative */
        tells = tells && integrate_last_step(it) > 0 &&
                integrate_time(it) == t + integrate_last_step(it);
        t = integrate_time(it);
        struct oscillators quiet = {0};
        oscillators_f(t, integrate_state(it), dydt, &quiet);
        tells = tells && same(integrate_derivative(it), dydt);
      }
      CHECK(tells);
      CHECK(integrate_counts(it).rejected > 0);
      integrate_free(it);
    }
}

static int clock_f(double t, const double y[], double dydt[], void *params) {
  (void)y, (void)params;
  dydt[0] = cos(t);
  return GSL_SUCCESS;
}

static int clock_jacobian(double t, const double y[], double *dfdy,
                          double dfdt[], void *params) {
  (void)y, (void)params;
  dfdy[0] = 0;
  dfdt[0] = -sin(t);
  return GSL_SUCCESS;
}

/* The start is a time and a copy. */
static void test_start(void) {
  const struct integrate_problem p = {
      .system = {clock_f, clock_jacobian, 1, NULL}, .scale = ones};
  for (size_t m = 0; adaptive_methods[m]; m++) {
    const double from[] = {-3, 0, 100};
    for (size_t k = 0; k < COUNT(from); k++) {
      const struct integrate_options opt = options(adaptive_methods[m]);
      double y[1] = {sin(from[k])};
      struct integrator *it = start(&opt, &p, from[k], y);
      y[0] = GSL_NAN;
      CHECK(integrate_time(it) == from[k]);
      CHECK(integrate_state(it)[0] == sin(from[k]));
      CHECK(run(it, from[k] + 2));
      const double tol =
          4 * 1.1 * opt.tol * (double)integrate_counts(it).accepted;
      CHECK_CLOSE(integrate_state(it)[0], sin(integrate_time(it)), tol);
      integrate_free(it);
    }
  }
}

/* --- interpolation ---------------------------------------------------------*/

/* Largest error between the nodes of fixed steps of h; rk8pd's own is below
   1e-13 there. */
static double interpolation_error(double h) {
  struct oscillators o = {0};
  const struct integrate_problem p = oscillators(&o);
  struct integrate_options opt = options("rk8pd");
  opt.step = h;
  struct integrator *it = start_oscillators(&opt, &p);
  double worst = 0;
  while (integrate_time(it) < 3) {
    const double from = integrate_time(it);
    if (!step(it) && !CHECK(!"a step"))
      break;
    for (int k = 0; k <= 16; k++) {
      const double t = from + (integrate_time(it) - from) * k / 16;
      double y[DIM], exact[DIM];
      oscillators_exact(t, exact);
      CHECK(integrate_at(it, t, y) == GSL_SUCCESS);
      const double e = distance(y, exact);
      if (!(e <= worst))
        worst = e;
    }
  }
  integrate_free(it);
  return worst;
}

static void test_interpolation_order(void) {
  double x[5], y[5], c, slope, cov00, cov01, cov11, sumsq;
  for (int k = 0; k < 5; k++) {
    const double h = 0.1 * pow(2, -k);
    const double e = interpolation_error(h);
    /* |y''''| h^4/384 with 32 for the faster one's velocity; then rk8pd's
       own error and rounding */
    CHECK(e <= 32 * pow(h, 4) / 384 + 1e-10 * pow(h / 0.1, 8) + ULPS(16));
    x[k] = log(h);
    y[k] = log(e);
  }
  gsl_fit_linear(x, 1, y, 1, 5, &c, &slope, &cov00, &cov01, &cov11, &sumsq);
  printf("interpolation: order %.3f\n", slope);
  /* the next term is (2 h)^2 smaller and h is at most 0.1 */
  CHECK_CLOSE(slope, 4, 0.04);
}

/* Equal to the nodes; nothing outside the last step. */
static void test_interpolation_ends(void) {
  for (size_t m = 0; adaptive_methods[m]; m++) {
    struct oscillators o = {0};
    const struct integrate_problem p = oscillators(&o);
    const struct integrate_options opt = options(adaptive_methods[m]);
    struct integrator *it = start_oscillators(&opt, &p);
    double before[DIM], y[DIM];
    oscillators_exact(0, before);
    CHECK(integrate_at(it, 0, y) == GSL_SUCCESS && same(y, before));
    CHECK(integrate_at(it, 1e-3, y) == GSL_EDOM);
    CHECK(integrate_at(it, -1e-3, y) == GSL_EDOM);
    CHECK(integrate_at(it, GSL_NAN, y) == GSL_EDOM);
    for (int k = 0; k < 20; k++) {
      const double from = integrate_time(it);
      memcpy(before, integrate_state(it), sizeof before);
      CHECK(integrate_step(it) == GSL_SUCCESS);
      const double to = integrate_time(it), h = to - from;
      CHECK(integrate_at(it, to, y) == GSL_SUCCESS &&
            same(y, integrate_state(it)));
      /* the step's start is known to a rounding of t; slopes are below 4 */
      CHECK(integrate_at(it, from, y) == GSL_SUCCESS);
      CHECK_CLOSE(distance(y, before), 0, ULPS(4) * (1 + to));
      /* continuous at the end */
      CHECK(integrate_at(it, nextafter(to, from), y) == GSL_SUCCESS);
      CHECK_CLOSE(distance(y, integrate_state(it)), 0, ULPS(4) * (1 + to));
      const double outside[] = {from - 1e-3 * h, to + 1e-3 * h, from - 1e6,
                                to + 1e6,        GSL_NAN,       GSL_POSINF,
                                GSL_NEGINF};
      for (size_t n = 0; n < COUNT(outside); n++) {
        memset(y, 0x5a, sizeof y);
        double untouched[DIM];
        memcpy(untouched, y, sizeof y);
        CHECK(integrate_at(it, outside[n], y) == GSL_EDOM);
        CHECK(same(y, untouched));
      }
    }
    integrate_free(it);
  }
}

/* Asking changes nothing. */
static void test_interpolation_free(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++) {
      struct oscillators o[2] = {{0}, {0}};
      const struct integrate_problem p[2] = {oscillators(&o[0]),
                                             oscillators(&o[1])};
      struct integrate_options opt = options(adaptive_methods[m]);
      opt.control = integrate_controls[c].name;
      struct integrator *asked = start_oscillators(&opt, &p[0]);
      struct integrator *left = start_oscillators(&opt, &p[1]);
      bool alike = true;
      for (int k = 0; k < 50 && alike; k++) {
        const double from = integrate_time(asked);
        CHECK(integrate_step(asked) == GSL_SUCCESS);
        CHECK(integrate_step(left) == GSL_SUCCESS);
        for (int i = 0; i < 10; i++) {
          double y[DIM];
          integrate_at(asked,
                       from + (integrate_time(asked) - from) * (i - 1) / 8., y);
        }
        alike = integrate_time(asked) == integrate_time(left) &&
                same(integrate_state(asked), integrate_state(left));
      }
      CHECK(alike);
      CHECK(o[0].calls == o[1].calls);
      integrate_free(asked);
      integrate_free(left);
    }
}

/* --- limits of the step ----------------------------------------------------*/

/* Depends on state and slope, to see that it gets the right ones. */
static double limit(const double y[], const double dydt[], void *params) {
  ((struct oscillators *)params)->limits++;
  return 0.01 + 0.02 * fabs(y[0]) + 0.01 * fabs(dydt[1] + y[0]) +
         0.01 * fabs(dydt[2] - y[3]);
}

static void test_limits(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++)
      for (int way = 1; way < 4; way++) {
        struct oscillators o = {0};
        struct integrate_problem p = oscillators(&o);
        struct integrate_options opt = options(adaptive_methods[m]);
        opt.control = integrate_controls[c].name;
        opt.tol = 1; /* would take any step */
        opt.hinit = 5;
        const double hmax = way & 1 ? 0.017 : GSL_POSINF;
        opt.hmax = way & 1 ? hmax : 0;
        p.step_limit = way & 2 ? limit : NULL;
        struct integrator *it = start_oscillators(&opt, &p);
        bool within = true, used = false;
        while (integrate_time(it) < 3) {
          const double most =
              way & 2 ? fmin(hmax, 0.01 + 0.02 * fabs(integrate_state(it)[0]))
                      : hmax;
          if (!step(it) && !CHECK(!"a step"))
            break;
          /* both are known to a rounding of t */
          const double tol = ULPS(1) * integrate_time(it);
          within = within && integrate_last_step(it) <= most + tol;
          used = used || integrate_last_step(it) >= most - tol;
        }
        CHECK(within);
        /* for msbdf the estimate sets the first steps */
        CHECK(used);
        CHECK((way & 2 ? o.limits > 0 : o.limits == 0));
        integrate_free(it);
      }
}

/* A step that leaves the time where it was is not a step: a program that waits
   for the time to come would wait for ever. */
static double no_way(const double y[], const double dydt[], void *params) {
  (void)y, (void)dydt, (void)params;
  return 1e-30;
}

static void test_no_progress(void) {
  for (int way = 0; way < 3; way++) {
    struct oscillators o = {0};
    struct integrate_problem p = oscillators(&o);
    struct integrate_options opt = options("merson");
    opt.hmax = way == 0 ? 1e-30 : 0;
    opt.step = way == 1 ? 1e-30 : 0;
    p.step_limit = way == 2 ? no_way : NULL;
    double y[DIM];
    oscillators_exact(1, y);
    struct integrator *it = start(&opt, &p, 1, y);
    CHECK(integrate_step(it) != GSL_SUCCESS || integrate_time(it) > 1);
    integrate_free(it);
  }
}

/* The paper's control accepts any step below 1e-9 s and shortens it when its
   error per second is above delta. Where rounding alone is that large, at
   slopes of 4 as here above 1e-15, or sooner with an estimate that is a
   difference of states, steps fall to nothing. */
static void test_collapse(void) {
  const struct {
    const char *method;
    double delta;
  } cases[] = {{"merson", 1e-17}, {"dopri5", 1e-17}, {"rkc", 1e-12}};
  for (size_t k = 0; k < COUNT(cases); k++) {
    struct oscillators o = {0};
    const struct integrate_problem p = oscillators(&o);
    struct integrate_options opt = options(cases[k].method);
    opt.control = "paper";
    opt.tol = cases[k].delta;
    opt.hinit = 1e-9;
    struct integrator *it = start_oscillators(&opt, &p);
    int status = GSL_SUCCESS;
    double t = -1;
    for (int n = 0; n < 1000 && status == GSL_SUCCESS && integrate_time(it) > t;
         n++) {
      t = integrate_time(it);
      status = integrate_step(it);
    }
    CHECK(status != GSL_SUCCESS || integrate_time(it) > t);
    integrate_free(it);
  }
}

/* --- fixed steps -----------------------------------------------------------*/

static void test_fixed(void) {
  for (size_t m = 0; integrate_methods[m].name; m++) {
    if (!integrate_methods[m].fixed)
      continue; /* has no fixed steps, see test_options */
    struct oscillators o = {0};
    struct integrate_problem p = oscillators(&o);
    p.step_limit = limit; /* not for fixed steps */
    struct integrate_options opt = options(integrate_methods[m].name);
    opt.step = 1. / 16;
    opt.tol = 1e-300; /* nor is this */
    struct integrator *it = start_oscillators(&opt, &p);
    bool exact = true, nodes = true;
    for (int k = 1; k <= 64; k++) {
      double before[DIM], y[DIM];
      memcpy(before, integrate_state(it), sizeof before);
      CHECK(integrate_step(it) == GSL_SUCCESS);
      exact = exact && integrate_time(it) == k / 16. &&
              integrate_last_step(it) == 1. / 16;
      nodes = nodes && integrate_at(it, (k - 1) / 16., y) == GSL_SUCCESS &&
              distance(y, before) == 0 &&
              integrate_at(it, k / 16., y) == GSL_SUCCESS &&
              same(y, integrate_state(it));
    }
    CHECK(exact);
    CHECK(nodes);
    CHECK(integrate_counts(it).accepted == 64);
    CHECK(integrate_counts(it).rejected == 0);
    /* order 2 is the least here: (2 h)^3 a step */
    CHECK(error_now(it) < 64 * pow(2. / 16, 3));
    integrate_free(it);
  }
}

/* It is the stepper's step and nothing else. */
static void test_fixed_bits(void) {
  const struct {
    const char *method;
    const gsl_odeiv2_step_type *type;
  } types[] = {{"merson", merson}, {"dopri5", dopri5}};
  for (size_t m = 0; m < COUNT(types); m++) {
    struct oscillators o = {0};
    const struct integrate_problem p = oscillators(&o);
    struct integrate_options opt = options(types[m].method);
    opt.step = 0.1;
    struct integrator *it = start_oscillators(&opt, &p);
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(types[m].type, DIM);
    double y[DIM], yerr[DIM], t = 0;
    oscillators_exact(0, y);
    for (int k = 0; k < 20; k++, t += 0.1) {
      CHECK(integrate_step(it) == GSL_SUCCESS);
      CHECK(gsl_odeiv2_step_apply(step, t, 0.1, y, yerr, NULL, NULL,
                                  &p.system) == GSL_SUCCESS);
      CHECK(same(integrate_state(it), y));
    }
    gsl_odeiv2_step_free(step);
    integrate_free(it);
  }
}

/* --- failures --------------------------------------------------------------*/

/* One unknown, y' = rate (target - y), not finite outside [low, high]. */
struct bounded {
  double rate, target, low, high;
  size_t calls;
};

static int bounded_f(double t, const double y[], double dydt[], void *params) {
  (void)t;
  struct bounded *b = params;
  b->calls++;
  const bool inside = y[0] >= b->low && y[0] <= b->high;
  dydt[0] = inside ? b->rate * (b->target - y[0]) : GSL_NAN;
  return inside ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int bounded_jacobian(double t, const double y[], double *dfdy,
                            double dfdt[], void *params) {
  (void)t, (void)y;
  dfdy[0] = -((const struct bounded *)params)->rate;
  dfdt[0] = 0;
  return GSL_SUCCESS;
}

static double far(const double y[], const double dydt[], void *params) {
  (void)y, (void)dydt, (void)params;
  return GSL_POSINF;
}

/* A first step that ends far outside is shortened, and the solution that stays
   inside is found. */
static void test_region_avoided(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++) {
      struct bounded b = {100, 1, -2, 3, 0};
      const struct integrate_problem p = {
          .system = {bounded_f, bounded_jacobian, 1, &b}, .scale = ones};
      struct integrate_options opt = options(adaptive_methods[m]);
      opt.control = integrate_controls[c].name;
      opt.tol = 1e-6;
      opt.hinit = 10;
      struct integrator *it = start(&opt, &p, 0, (const double[]){0});
      CHECK(run(it, 0.1));
      const double t = integrate_time(it);
      const struct integrate_counts n = integrate_counts(it);
      /* paper: 100 for the rate, as the error is per second */
      CHECK_CLOSE(integrate_state(it)[0], 1 - exp(-100 * t),
                  4 * 1.1 * opt.tol * (double)n.accepted);
      CHECK(n.rejected > 0 || !strcmp(opt.method, "msbdf"));
      integrate_free(it);
    }
}

/* A solution that runs into the boundary, at t = 1: the integrator comes close,
   gives up in good time and stays where it is. A step covers at least a quarter
   of the way left, so ln(2^52)/ln(4/3) = 125 steps lead to the last bit; twenty
   attempts shrink a step by 4^20 = 1e12, more than any control lets it grow; a
   fixed 100 evaluations is more than any attempt of these takes. */
static void test_region_entered(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++)
      for (int limited = 0; limited < 2; limited++) {
        /* y = 2 (1 - exp(-t ln 2)) reaches 1 at t = 1 */
        struct bounded b = {M_LN2, 2, -1, 1, 0};
        struct integrate_problem p = {
            .system = {bounded_f, bounded_jacobian, 1, &b}, .scale = ones};
        struct integrate_options opt = options(adaptive_methods[m]);
        opt.control = integrate_controls[c].name;
        opt.tol = 1e-6;
        p.step_limit = limited ? far : NULL;
        struct integrator *it = start(&opt, &p, 0, (const double[]){0});
        int status;
        double t, y;
        size_t steps = 0;
        do {
          t = integrate_time(it);
          y = integrate_state(it)[0];
          status = integrate_step(it);
        } while (status == GSL_SUCCESS && ++steps < 5000);
        CHECK(status == GSL_FAILURE);
        CHECK(integrate_time(it) == t && integrate_state(it)[0] == y);
        CHECK_CLOSE(y, 2 * (1 - exp(-M_LN2 * t)),
                    4 * 1.1 * opt.tol * (double)steps);
        /* as close as the integration is good */
        CHECK(y <= 1 && y > 1 - 1e-6);
        if (!CHECK(b.calls < 125 * 20 * 100))
          fprintf(stderr, "  %s, %s: %zu calls\n", opt.method, opt.control,
                  b.calls);
        CHECK(integrate_counts(it).accepted == steps);
        /* and again, and no worse for it */
        CHECK(integrate_step(it) == GSL_FAILURE);
        CHECK(integrate_time(it) == t && integrate_state(it)[0] == y);
        integrate_free(it);
      }
}

/* Finite at the start alone, or not even there. */
static void test_nowhere(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (int finite = 0; finite < 2; finite++)
      for (int limited = 0; limited < 2; limited++)
        for (int fixed = 0; fixed < 2; fixed++) {
          if (fixed && !strcmp(adaptive_methods[m], "msbdf"))
            continue; /* has no fixed steps */
          struct bounded b = {1, 2, 0, finite ? 0 : -1, 0};
          struct integrate_problem p = {
              .system = {bounded_f, bounded_jacobian, 1, &b}, .scale = ones};
          struct integrate_options opt = options(adaptive_methods[m]);
          p.step_limit = limited ? far : NULL;
          opt.step = fixed ? 0.1 : 0;
          struct integrator *it = start(&opt, &p, 5, (const double[]){0});
          for (int k = 0; k < 2; k++)
            if (!(CHECK(integrate_step(it) == GSL_FAILURE) &
                  CHECK(integrate_time(it) == 5) &
                  CHECK(integrate_state(it)[0] == 0)))
              fprintf(stderr, "  %s finite %d limited %d fixed %d\n",
                      opt.method, finite, limited, fixed);
          CHECK(integrate_counts(it).accepted == 0);
          /* 4^26 = 2^52: that many attempts, of few evaluations */
          CHECK(b.calls < (fixed ? 2 * 100 : 2 * 30 * 100));
          integrate_free(it);
        }
}

/* Each attempt is a quarter of the one before, until a step of it would be lost
   in the rounding of t, or of 1 ms at the start. */
static void test_attempts(void) {
  const double starts[] = {0, 5};
  for (size_t k = 0; k < 2; k++) {
    struct bounded b = {1, 2, 0, 0, 0};
    const struct integrate_problem p = {
        .system = {bounded_f, bounded_jacobian, 1, &b}, .scale = ones};
    struct integrate_options opt = options("merson");
    opt.hinit = opt.hmax = 1;
    struct integrator *it = start(&opt, &p, starts[k], (const double[]){0});
    CHECK(integrate_step(it) == GSL_FAILURE);
    const double least = 4 * DBL_EPSILON * fmax(starts[k], 1e-3);
    CHECK((double)integrate_counts(it).rejected == ceil(-log2(least) / 2));
    integrate_free(it);
  }
}

/* A fixed step that ends outside is not shortened. */
static void test_fixed_failure(void) {
  struct bounded b = {100, 1, -2, 3, 0};
  const struct integrate_problem p = {
      .system = {bounded_f, bounded_jacobian, 1, &b}, .scale = ones};
  struct integrate_options opt = options("merson");
  opt.step = 10;
  struct integrator *it = start(&opt, &p, 0, (const double[]){0});
  CHECK(integrate_step(it) == GSL_FAILURE);
  CHECK(integrate_time(it) == 0 && integrate_state(it)[0] == 0);
  CHECK(b.calls <= 1 + 5);
  integrate_free(it);
}

/* Where the stepper cannot do the step, as rkc with too many stages, or the
   right-hand side fails with any code: no other step instead. */
static void test_fixed_refused(void) {
  const int codes[] = {GSL_EBADFUNC, GSL_EFAULT, GSL_ENOMEM, GSL_FAILURE};
  for (size_t m = 0; integrate_methods[m].name; m++) {
    if (!integrate_methods[m].fixed)
      continue; /* has no fixed steps, see test_options */
    for (size_t k = 0; k <= COUNT(codes); k++) {
      const bool stiff = k == COUNT(codes);
      struct oscillators o = {0};
      struct bounded b = {1e7, 1, GSL_NEGINF, GSL_POSINF, 0};
      struct integrate_problem p = oscillators(&o);
      if (stiff)
        p.system = (gsl_odeiv2_system){bounded_f, bounded_jacobian, 1, &b};
      if (stiff && !strcmp(integrate_methods[m].name, "verlet"))
        continue; /* has no positions */
      struct integrate_options opt = options(integrate_methods[m].name);
      opt.step = 1;
      double y[DIM];
      oscillators_exact(0, y);
      struct integrator *it = start(&opt, &p, 0, y);
      if (!stiff)
        o = (struct oscillators){
            .fail_from = 2, .fail_to = 2, .code = codes[k]};
      const int status = integrate_step(it);
      if (!CHECK(status == GSL_SUCCESS ? integrate_time(it) == 1
                                       : integrate_time(it) == 0))
        fprintf(stderr, "  %s %s: t=%g\n", opt.method,
                stiff ? "stiff" : gsl_strerror(codes[k]), integrate_time(it));
      integrate_free(it);
    }
  }
}

/* Slopes that change from call to call: no step is good enough. */
static int noise_f(double t, const double y[], double dydt[], void *params) {
  (void)t, (void)y;
  size_t *calls = params;
  /* not periodic with the number of stages of any method */
  dydt[0] = sin((double)(*calls * *calls));
  ++*calls;
  return GSL_SUCCESS;
}

static int noise_jacobian(double t, const double y[], double *dfdy,
                          double dfdt[], void *params) {
  (void)t, (void)y, (void)params;
  dfdy[0] = dfdt[0] = 0;
  return GSL_SUCCESS;
}

/* GSL leaves the rejected trial behind: time and state must be restored. Each
   rejection shortens by a factor of 0.9 at least, and 1e16 is the most there is
   to shorten. */
static void test_control_gives_up(void) {
  const double most = log(1e17) / -log(0.9) * 100;
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t c = 0; integrate_controls[c].alloc; c++) {
      if (integrate_controls[c].per_time)
        continue; /* takes any step below 1e-9 */
      size_t calls = 0;
      const struct integrate_problem p = {
          .system = {noise_f, noise_jacobian, 1, &calls}, .scale = ones};
      struct integrate_options opt = options(adaptive_methods[m]);
      opt.control = integrate_controls[c].name;
      opt.tol = 1e-300;
      struct integrator *it = start(&opt, &p, 1, (const double[]){0.7});
      for (int k = 0; k < 2; k++) {
        CHECK(integrate_step(it) == GSL_FAILURE);
        CHECK(integrate_time(it) == 1 && integrate_state(it)[0] == 0.7);
      }
      CHECK(integrate_counts(it).accepted == 0);
      CHECK(integrate_counts(it).rejected > 0);
      CHECK((double)calls < 2 * most);
      integrate_free(it);
    }
}

/* Failure at any single call, for good from there, with any code: an error,
   everything as it was, and once the right-hand side is well again the
   integration goes on as if nothing had happened. */
static void test_recovery(void) {
  const int codes[] = {GSL_EBADFUNC, GSL_EFAULT, GSL_ENOMEM, GSL_FAILURE};
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t k = 1; k <= 16; k++)
      for (size_t c = 0; c < COUNT(codes); c++) {
        struct oscillators o = {0};
        const struct integrate_problem p = oscillators(&o);
        const struct integrate_options opt = options(adaptive_methods[m]);
        struct integrator *it = start_oscillators(&opt, &p);
        CHECK(run(it, 1));
        const double t = integrate_time(it), h = integrate_last_step(it);
        double y[DIM], between[DIM], after[DIM], dydt[DIM];
        memcpy(y, integrate_state(it), sizeof y);
        memcpy(dydt, integrate_derivative(it), sizeof dydt);
        CHECK(integrate_at(it, t - 0.5 * h, between) == GSL_SUCCESS);
        const size_t steps = integrate_counts(it).accepted;

        o = (struct oscillators){
            .fail_from = k, .fail_to = SIZE_MAX, .code = codes[c]};
        int status = integrate_step(it);
        if (status == GSL_SUCCESS) { /* made fewer calls */
          integrate_free(it);
          continue;
        }
        CHECK(codes[c] == GSL_EFAULT
                  ? status == GSL_ENOMEM
                  : status == GSL_FAILURE ||
                        (codes[c] != GSL_EBADFUNC && status == codes[c]));
        CHECK(integrate_counts(it).accepted == steps);
        CHECK(integrate_time(it) == t);
        CHECK(same(integrate_state(it), y));
        CHECK(same(integrate_derivative(it), dydt));
        CHECK(integrate_last_step(it) == h);
        CHECK(integrate_at(it, t - 0.5 * h, after) == GSL_SUCCESS &&
              same(after, between));
        /* halved to one ulp at the most: 53 and 1 attempts */
        CHECK(o.calls < 54 * 100);

        o.fail_from = SIZE_MAX;
        CHECK(run(it, 3));
        CHECK(error_now(it) <=
              4 * 1.1 * opt.tol * (double)integrate_counts(it).accepted);
        integrate_free(it);
      }
}

/* A single failure costs one attempt and leaves no trace in the accuracy. */
static void test_single_failure(void) {
  for (size_t m = 0; adaptive_methods[m]; m++)
    for (size_t k = 1; k <= 40; k++) {
      struct oscillators o = {
          .fail_from = k, .fail_to = k, .code = GSL_EBADFUNC};
      const struct integrate_problem p = oscillators(&o);
      const struct integrate_options opt = options(adaptive_methods[m]);
      struct integrator *it = start_oscillators(&opt, &p);
      CHECK(run(it, 2));
      CHECK(integrate_counts(it).rejected > 0);
      CHECK(error_now(it) <=
            4 * 1.1 * opt.tol * (double)integrate_counts(it).accepted);
      integrate_free(it);
    }
}

/* --- a stop ----------------------------------------------------------------*/

/* Steps before the one that would pass the stop are those of a free run; that
   one ends there exactly, and none follows until there is a new stop. */
static void test_stop(void) {
  const double stops[] = {1.7, 1.7 + 1. / 3};
  for (size_t m = 0; integrate_methods[m].name; m++) {
    if (!integrate_methods[m].type)
      continue; /* a problem's own: tests/test_multirate.c */
    const bool fixed = !strcmp(integrate_methods[m].name, "verlet");
    struct oscillators o = {0}, q = {0};
    struct integrate_problem p = oscillators(&o), free_run = oscillators(&q);
    struct integrate_options opt = options(integrate_methods[m].name);
    opt.step = fixed ? 1. / 1024 : 0;
    struct integrator *it = start_oscillators(&opt, &p),
                      *other = start_oscillators(&opt, &free_run);
    CHECK(integrate_stop(it, 0) == GSL_EINVAL);
    CHECK(integrate_stop(it, GSL_NAN) == GSL_EINVAL);
    CHECK(integrate_stop(it, stops[0]) == GSL_SUCCESS);
    bool equal = true;
    while (integrate_time(it) < stops[0]) {
      CHECK(integrate_step(it) == GSL_SUCCESS);
      CHECK(integrate_step(other) == GSL_SUCCESS);
      if (integrate_time(it) < stops[0])
        equal = equal && same(integrate_state(it), integrate_state(other));
      else
        CHECK(integrate_time(other) >= stops[0]);
    }
    CHECK(equal);
    for (size_t k = 0; k < COUNT(stops); k++) {
      CHECK(run(it, stops[k]));
      CHECK(integrate_time(it) == stops[k]);
      /* verlet: (h w)^2/24 w t at the faster frequency, 2 */
      CHECK(error_now(it) <
            (fixed
                 ? 4 * pow(opt.step, 2)
                 : 4 * 1.1 * opt.tol * (double)integrate_counts(it).accepted));
      CHECK(integrate_step(it) == GSL_EDOM);
      if (k == 0)
        CHECK(integrate_stop(it, stops[1]) == GSL_SUCCESS);
    }
    integrate_free(it);
    integrate_free(other);
  }
}

int main(void) {
  gsl_set_error_handler_off();
  test_stop();
  test_tolerance();
  test_stiff();
  test_scale();
  test_options();
  test_tables();
  test_counts();
  test_start();
  test_interpolation_order();
  test_interpolation_ends();
  test_interpolation_free();
  test_limits();
  test_no_progress();
  test_collapse();
  test_fixed();
  test_fixed_bits();
  test_region_avoided();
  test_region_entered();
  test_nowhere();
  test_attempts();
  test_fixed_failure();
  test_fixed_refused();
  test_control_gives_up();
  test_recovery();
  test_single_failure();
  return check_done();
}
