/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bounce: one sphere dropped on a plane, two unknowns: height of its lowest
   point above the plane, and velocity. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_roots.h>
#include "program/command_line.h"
#include "model/scene.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "model/travel.h"
#include "program/version.h"

struct drop {
  struct contact_law law;
  double gravity;
  double travel; /* longest way in a step (m), 0: any */
};

/* What goes wrong beside the motion; README.md lists the warnings. */
struct watch {
  struct integrator *it;
  const struct drop *drop;
  const struct integrate_options *options;
  bool adapts; /* the method to stiffness */
  struct stiffness_limits limits;
  double weight;        /* of the contact's energy in what cannot grow */
  double first, lowest; /* of that */
  double deepest;       /* height that its energy lets it reach */
  double bottom;        /* lowest height so far */
  size_t steps, limited_steps;
  bool told;
};

/* (2.13), (2.14) for one sphere and the floor */
static int rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  const struct drop *d = params;
  dydt[0] = y[1];
  dydt[1] = contact_normal(&d->law, y[0], y[1]) - d->gravity;
  return isfinite(dydt[0]) && isfinite(dydt[1]) ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[],
                    void *params) {
  (void)t;
  const struct contact_law *c = &((const struct drop *)params)->law;
  dfdy[0] = 0;
  dfdy[1] = 1;
  dfdy[2] = -c->kappa * contact_normal(c, y[0], y[1]);
  dfdy[3] = -contact_repulsion(c, y[0]) * contact_rebound_slope(c, -y[1]);
  dfdt[0] = dfdt[1] = 0;
  return GSL_SUCCESS;
}

static double step_limit(const double y[], const double dydt[], void *params) {
  const struct drop *d = params;
  return travel_time(fabs(y[1]), fabs(dydt[1]), d->travel);
}

static double energy(const struct drop *d, const double y[]) {
  return 0.5 * y[1] * y[1] + d->gravity * y[0] + contact_energy(&d->law, y[0]);
}

/* Kinetic energy, gravity's and rho(0) F/kappa: it never grows, and with e = 1
   it is constant. */
static double remaining(const struct watch *w, const double y[]) {
  const struct drop *d = w->drop;
  return 0.5 * y[1] * y[1] + d->gravity * y[0] +
         w->weight * contact_energy(&d->law, y[0]);
}

/* The lower root z of g z + touch exp(-kappa z) = energy, by Newton's method
   from below: the sum is convex, so it comes no further than the root. */
static double deepest(const struct drop *d, double touch, double energy) {
  const double kappa = d->law.kappa, g = d->gravity;
  const double rest = log(kappa * touch / g) / kappa;
  double below = 1 / kappa, z;
  do {
    z = rest - below;
    below *= 2;
  } while (g * z + touch * exp(-kappa * z) < energy);
  for (size_t k = 0; k < 100; k++) {
    const double stored = touch * exp(-kappa * z);
    if (!(kappa * stored > g)) /* it begins at rest */
      break;
    z += (g * z + stored - energy) / (kappa * stored - g);
  }
  return z;
}

static struct watch watch_start(struct integrator *it, const struct drop *d,
                                const struct integrate_options *o) {
  const double e = d->law.restitution;
  struct watch w = {
      .it = it, .drop = d, .options = o, .weight = 0.5 * (1 + e * e)};
  const int status = integrate_limits(o->method, &w.limits);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  w.adapts = status != GSL_SUCCESS;
  w.bottom = integrate_state(it)[0];
  w.first = w.lowest = remaining(&w, integrate_state(it));
  w.deepest = deepest(d, w.weight * contact_energy(&d->law, 0), w.first);
  return w;
}

/* The share of the steps that stability set. The mode is the
   Jacobian's own: lambda^2 = f_z + f_v lambda. */
static void watch_stiffness(struct watch *w, const double y[]) {
  double dfdy[4], dfdt[2];
  gsl_complex root[2];
  const double h = integrate_last_step(w->it);
  jacobian(0, y, dfdy, dfdt, (void *)w->drop);
  gsl_poly_complex_solve_quadratic(1, -dfdy[3], -dfdy[2], &root[0], &root[1]);
  const size_t k = gsl_complex_abs(root[1]) > gsl_complex_abs(root[0]);
  const double angle = fabs(gsl_complex_arg(root[k]));
  const double limit = stiffness_limit_at(&w->limits, GSL_MAX(angle, M_PI_2));
  if (stiffness_at_limit(h * gsl_complex_abs(root[k]), limit))
    w->limited_steps++;
}

/* After every accepted step. */
static void watch_step(struct watch *w) {
  const double *y = integrate_state(w->it), t = integrate_time(w->it);
  const double now = remaining(w, y), kappa = w->drop->law.kappa;
  w->steps++;
  w->bottom = GSL_MIN(w->bottom, y[0]);
  if (!w->adapts)
    watch_stiffness(w, y);
  /* so much deeper takes e times the energy there is */
  if (y[0] < w->deepest - 1 / kappa) {
    fflush(stdout);
    die(EXIT_INTEGRATION,
        "t=%.6g: the sphere is %.3g m below the floor, expected at most %.3g m "
        "with its energy (docs/stability.md, \"Missed collisions\")",
        t, -y[0], -w->deepest);
  }
  w->lowest = GSL_MIN(w->lowest, now);
  const double gain = now - w->lowest, loss = w->first - now;
  const bool lost = w->drop->law.restitution == 1 && loss > 0.01 * w->first;
  const double scale = now - w->drop->gravity * w->bottom;
  const double rounding = 4 * GSL_DBL_EPSILON * w->first;
  if (!w->told && (gain > 0.01 * scale + rounding || lost)) {
    w->told = true;
    warn("t=%.6g: %.3g J %s: a smaller --tol or --step is needed "
         "(docs/stability.md, \"Energy\")",
         t, lost ? loss : gain,
         lost ? "are lost where none can be (e = 1)" : "came from nowhere");
  }
}

static void watch_end(const struct watch *w) {
  if (stiffness_sets_pace(w->limited_steps, w->steps))
    warn("stability, not the tolerance, set %.0f %% of the steps: --method rkc "
         "takes fewer evaluations (docs/stability.md, \"Stability limits\")",
         100 * (double)w->limited_steps / (double)w->steps);
}

static void step_or_die(struct watch *w) {
  const int status = integrate_step(w->it);
  if (status != GSL_SUCCESS) {
    fflush(stdout);
    die(EXIT_INTEGRATION, "t=%.6g: %s", integrate_time(w->it),
        integration_error(w->options, status));
  }
  watch_step(w);
}

static void print_samples(struct watch *w, double time, size_t samples) {
  struct integrator *it = w->it;
  puts("t\tz\tv\tenergy");
  for (size_t k = 0; k < samples; k++) {
    const double t =
        samples > 1 ? time * (double)k / (double)(samples - 1) : time;
    double y[2];
    while (integrate_time(it) < t)
      step_or_die(w);
    if (integrate_at(it, t, y) != GSL_SUCCESS)
      die(EXIT_IO, "internal error: no state at t=%g", t);
    printf("%.17g\t%.17g\t%.17g\t%.17g\n", t, y[0], y[1], energy(w->drop, y));
  }
}

static double velocity_at(double t, void *it) {
  double y[2];
  return integrate_at(it, t, y) == GSL_SUCCESS ? y[1] : GSL_NAN;
}

/* The apex is where the velocity falls through zero within a step; free
   flight is a polynomial that the interpolation gives exactly. */
static double find_apex(struct integrator *it, double from, double to) {
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  gsl_function f = {velocity_at, it};
  if (!solver)
    die(EXIT_IO, "out of memory");
  double root = to;
  if (gsl_root_fsolver_set(solver, &f, from, to) == GSL_SUCCESS)
    do {
      if (gsl_root_fsolver_iterate(solver) != GSL_SUCCESS)
        break;
      root = gsl_root_fsolver_root(solver);
    } while (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver),
                                    gsl_root_fsolver_x_upper(solver), 0,
                                    4 * GSL_DBL_EPSILON) == GSL_CONTINUE);
  gsl_root_fsolver_free(solver);
  return root;
}

/* One row: time of the first apex after the rebound beside the hard-contact
   limit (1 + e) sqrt(2 h0/g). */
static int print_rebound(struct watch *w, double height, double time) {
  struct integrator *it = w->it;
  const struct drop *d = w->drop;
  bool rising = false;
  while (integrate_time(it) < time) {
    const double before = integrate_time(it);
    step_or_die(w);
    const double v = integrate_state(it)[1];
    if (rising && v <= 0) {
      const double t = find_apex(it, before, integrate_time(it));
      double y[2];
      if (integrate_at(it, t, y) != GSL_SUCCESS)
        die(EXIT_IO, "internal error: no state at t=%g", t);
      const double e = d->law.restitution;
      const double hard = (1 + e) * sqrt(2 * height / d->gravity);
      puts("restitution\tkappa\tt_hard\tt_rebound\terror_percent\tz_peak");
      printf("%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\n", e, d->law.kappa,
             hard, t, 100 * (t / hard - 1), y[0]);
      return EXIT_DONE;
    }
    rising = rising || v > 0;
  }
  warn("t=%g: the sphere has not come back to rest at its apex; a longer "
       "--time is needed",
       time);
  return EXIT_LIMIT;
}

static void print_header(const struct option_spec *options) {
  char text[256];
  printf("# program=bounce\n# version=%s\n", DEM_VERSION);
  for (const struct option_spec *o = options; o->name; o++)
    if (o->parameter) {
      option_text(o, text, sizeof text);
      printf("# %s=%s\n", o->name, text);
    }
}

int main(int argc, char **argv) {
  struct scene scene = scene_default();
  struct contact_law *law = &scene.law;
  law->restitution = 1;
  struct integrate_options integrate = {
      .method = "merson", .control = "standard", .tol = 1e-10, .hinit = 0.1};
  double travel = 1, height = 16, gravity = 9.81, time = 10;
  size_t samples = 1000;
  bool rebound = false;
  /* clang-format off */
  struct option_spec options[] = {
      POSITIVE("height", &height, "m", "height it is dropped from"),
      LAW_OPTIONS(*law),
      POSITIVE("gravity", &gravity, "m/s^2", "gravity"),
      POSITIVE("time", &time, "s", "end"),
      {.name = "samples", .type = OPTION_SIZE, .value = &samples, .least = 1,
       .most = 1e9, .help = "rows, evenly in time"},
      {.name = "rebound", .type = OPTION_FLAG, .value = &rebound,
       .help = "one row instead: the first apex after the rebound"},
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "bounce",
      .summary = "A sphere dropped on a plane: time (s), height (m), velocity "
                 "(m/s), energy (J).",
      .usage = "[OPTION...]",
      .example = "bounce --restitution 0.7 --rebound",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  if (operand < argc)
    die(EXIT_USAGE, "'%s': expected options only", argv[operand]);
  integrate_defaults(&integrate);
  integration_check(&integrate, 1);
  const char *wrong = scene_check(&scene);
  if (wrong)
    die(EXIT_USAGE, "%s", wrong);

  struct drop drop = {*law, gravity, travel / law->kappa};
  /* as for settle: gaps in 1/kappa, speeds in m/s */
  const double scale[2] = {1 / law->kappa, 1};
  const struct integrate_problem problem = {.system = {.function = rhs,
                                                       .jacobian = jacobian,
                                                       .dimension = 2,
                                                       .params = &drop},
                                            .scale = scale,
                                            .row = 2,
                                            .positions = 1,
                                            .step_limit =
                                                travel > 0 ? step_limit : NULL};
  struct integrator *it;
  const int status = integrate_alloc(&it, &integrate, &problem, 0,
                                     (const double[]){height, 0});
  if (status != GSL_SUCCESS)
    die_status(status, "--method %s", integrate.method);
  print_header(options);
  int code = EXIT_DONE;
  struct watch w = watch_start(it, &drop, &integrate);
  if (rebound)
    code = print_rebound(&w, height, time);
  else
    print_samples(&w, time, samples);
  watch_end(&w);
  integrate_free(it);
  finish_output();
  return code;
}
