/* bounce: one sphere dropped on a plane, two unknowns: height of its lowest
   point above the plane, and velocity. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include "options.h"
#include "scene.h"
#include "shared_options.h"
#include "version.h"

struct drop {
  struct contact_law law;
  double gravity;
  double travel; /* longest way in a step (m), 0: any */
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
  const double v = fabs(y[1]), a = fabs(dydt[1]);
  return 2 * d->travel / (v + sqrt(v * v + 2 * a * d->travel));
}

static double energy(const struct drop *d, const double y[]) {
  return 0.5 * y[1] * y[1] + d->gravity * y[0] + contact_energy(&d->law, y[0]);
}

static void step_or_die(struct integrator *it) {
  const int status = integrate_step(it);
  if (status != GSL_SUCCESS) {
    fflush(stdout);
    die(EXIT_INTEGRATION, "t=%.6g: %s", integrate_time(it),
        status == GSL_FAILURE ? "no step is short enough for the tolerance"
                              : gsl_strerror(status));
  }
}

static void print_samples(struct integrator *it, const struct drop *d,
                          double time, size_t samples) {
  puts("t\tz\tv\tenergy");
  for (size_t k = 0; k < samples; k++) {
    const double t =
        samples > 1 ? time * (double)k / (double)(samples - 1) : time;
    double y[2];
    while (integrate_time(it) < t)
      step_or_die(it);
    if (integrate_at(it, t, y) != GSL_SUCCESS)
      die(EXIT_IO, "internal error: no state at t=%g", t);
    printf("%.17g\t%.17g\t%.17g\t%.17g\n", t, y[0], y[1], energy(d, y));
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
static int print_rebound(struct integrator *it, const struct drop *d,
                         double height, double time) {
  bool rising = false;
  while (integrate_time(it) < time) {
    const double before = integrate_time(it);
    step_or_die(it);
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
    die(status == GSL_EINVAL ? EXIT_USAGE : EXIT_IO, "--method %s: %s",
        integrate.method, gsl_strerror(status));
  print_header(options);
  int code = EXIT_DONE;
  if (rebound)
    code = print_rebound(it, &drop, height, time);
  else
    print_samples(it, &drop, time, samples);
  integrate_free(it);
  finish_output();
  return code;
}
