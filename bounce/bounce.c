/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bounce: one sphere dropped on a plane, two unknowns: height of its lowest
   point above the plane, and velocity. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include "program/command_line.h"
#include "dynamics/drop.h"
#include "files/numbers.h"
#include "model/scene.h"
#include "program/files.h"
#include "program/integration.h"
#include "program/origin.h"
#include "program/run_watch.h"
#include "program/shared_options.h"

struct bounce {
  struct drop drop;
  struct integrator *it;
  const struct integrate_options *integrate;
  double height, time; /* at the start (m), of the end (s) */
  struct run_watch *watch;
  double weight;  /* of the contact's energy in what cannot grow */
  double deepest; /* height that its energy lets it reach (m) */
};

/* Energy that is left, as settle's watch has it: the sphere's energy
   without gravity's, with rho(0) F/kappa for the contact's. */
static int watch_energy(struct bounce *b) {
  const double *y = integrate_state(b->it);
  const double gravity = b->drop.gravity * y[0];
  const double inner =
      0.5 * y[1] * y[1] + b->weight * contact_energy(&b->drop.law, y[0]);
  return run_watch_energy(b->watch, gravity, inner,
                          4 * GSL_DBL_EPSILON * b->drop.gravity * b->height);
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

static void start(struct bounce *b, struct run_clock begun, bool quiet) {
  const struct contact_law *law = &b->drop.law;
  const double e = law->restitution;
  int status = drop_alloc(&b->it, &b->drop, b->integrate, b->height, 0);
  if (status != GSL_SUCCESS)
    die_status(status, "--method %s", b->integrate->method);
  status = run_watch_alloc(&b->watch, &(struct run_watch_options){
                                          .begun = begun,
                                          .quiet = quiet,
                                          .integrate = b->integrate,
                                          .integrator = b->it,
                                          .stiff = "the contact",
                                          .whose = "the sphere's",
                                          .result = "the bounce",
                                          .nobody = e == 1 ? "e = 1" : NULL});
  if (status != GSL_SUCCESS)
    die_status(status, "start");
  b->weight = 0.5 * (1 + e * e);
  const double touch = b->weight * contact_energy(law, 0);
  b->deepest = deepest(&b->drop, touch,
                       b->drop.gravity * b->height +
                           b->weight * contact_energy(law, b->height));
  watch_energy(b);
}

/* A fault ends the run. */
static int fail(struct bounce *b, const char *what, const char *page) {
  fflush(stdout);
  run_watch_say(b->watch, "t=%.6g: %s (docs/stability.md, \"%s\")",
                integrate_time(b->it), what, page);
  return GSL_EFAILED;
}

/* One accepted step, looked at. GSL_SUCCESS or, after a line that says why,
   GSL_EFAILED. */
static int step(struct bounce *b) {
  const int status = integrate_step(b->it);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (status != GSL_SUCCESS)
    return fail(b, integration_error(b->integrate, status),
                "Missed collisions");
  const double *y = integrate_state(b->it);
  if (run_watch_wants_mode(b->watch))
    run_watch_mode(b->watch, drop_mode(&b->drop, y));
  run_watch_step(b->watch);
  /* 1/kappa deeper takes e times the energy there is */
  if (y[0] < b->deepest - 1 / b->drop.law.kappa) {
    char what[120];
    snprintf(what, sizeof what,
             "the sphere is %.3g m below the floor, expected at most %.3g m "
             "with its energy",
             -y[0], -b->deepest);
    return fail(b, what, "Missed collisions");
  }
  if (watch_energy(b) != GSL_SUCCESS)
    return fail(b, "the energy is not finite", "Energy");
  run_watch_tell_energy(b->watch);
  run_watch_progress(b->watch, b->time, b->drop.evaluations);
  return GSL_SUCCESS;
}

static int print_samples(struct bounce *b, size_t samples) {
  puts("t\tz\tv\tenergy");
  for (size_t k = 0; k < samples; k++) {
    const double t =
        samples > 1 ? b->time * (double)k / (double)(samples - 1) : b->time;
    double y[2];
    while (integrate_time(b->it) < t)
      if (step(b) != GSL_SUCCESS)
        return EXIT_INTEGRATION;
    if (integrate_at(b->it, t, y) != GSL_SUCCESS)
      die(EXIT_IO, "internal error: no state at t=%g", t);
    const double row[] = {t, y[0], y[1], drop_energy(&b->drop, y)};
    numbers_write(stdout, '\t', 4, row);
    putchar('\n');
  }
  return EXIT_DONE;
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
static int print_rebound(struct bounce *b) {
  const struct drop *d = &b->drop;
  bool rising = false;
  while (integrate_time(b->it) < b->time) {
    const double before = integrate_time(b->it);
    if (step(b) != GSL_SUCCESS)
      return EXIT_INTEGRATION;
    const double v = integrate_state(b->it)[1];
    if (rising && v <= 0) {
      const double t = find_apex(b->it, before, integrate_time(b->it));
      double y[2];
      if (integrate_at(b->it, t, y) != GSL_SUCCESS)
        die(EXIT_IO, "internal error: no state at t=%g", t);
      const double e = d->law.restitution;
      const double hard = (1 + e) * sqrt(2 * b->height / d->gravity);
      puts("restitution\tkappa\tt_hard\tt_rebound\terror_percent\tz_peak");
      const double row[] = {e, d->law.kappa,         hard,
                            t, 100 * (t / hard - 1), y[0]};
      numbers_write(stdout, '\t', 6, row);
      putchar('\n');
      return EXIT_DONE;
    }
    rising = rising || v > 0;
  }
  run_watch_say(b->watch,
                "t=%g: the sphere has not come back to rest at its apex; a "
                "longer --time is needed",
                b->time);
  return EXIT_LIMIT;
}

static void print_header(const struct option_spec *options) {
  char text[256];
  origin_write(stdout, &origin_comment, command_line(), NULL);
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
  struct bounce b = {.integrate = &integrate, .height = 16, .time = 10};
  double travel = 1, gravity = 9.81;
  size_t samples = 1000;
  const char *stats_file = NULL;
  bool rebound = false, quiet = false;
  /* clang-format off */
  struct option_spec options[] = {
      POSITIVE("height", &b.height, "m", "height it is dropped from"),
      LAW_OPTIONS(*law),
      POSITIVE("gravity", &gravity, "m/s^2", "gravity"),
      POSITIVE("time", &b.time, "s", "end"),
      {.name = "samples", .type = OPTION_SIZE, .value = &samples, .least = 1,
       .most = 1e9, .help = "rows, evenly in time"},
      {.name = "rebound", .type = OPTION_FLAG, .value = &rebound,
       .help = "one row instead: the first apex after the rebound"},
      INTEGRATION_OPTIONS(integrate, travel),
      STATS_OPTION(stats_file),
      QUIET_OPTION(quiet),
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

  const struct run_clock begun = run_clock_now();
  struct output_file stats;
  if (stats_file)
    output_open(&stats, stats_file);
  b.drop = (struct drop){.force = drop_contact,
                         .law = *law,
                         .gravity = gravity,
                         .travel = travel / law->kappa};
  start(&b, begun, quiet);
  print_header(options);
  const int code = rebound ? print_rebound(&b) : print_samples(&b, samples);
  run_watch_end(b.watch, code == EXIT_INTEGRATION);
  finish_output();
  if (stats_file) {
    origin_write(stats.stream, &origin_statistic, command_line(), NULL);
    run_watch_solver_stats(b.watch, stats.stream, 2, b.drop.evaluations,
                           GSL_MIN(integrate_time(b.it), b.time));
    run_watch_stats(b.watch, stats.stream, code);
    output_commit(&stats);
  }
  run_watch_free(b.watch);
  integrate_free(b.it);
  return code;
}
