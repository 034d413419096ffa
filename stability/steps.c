/* SPDX-License-Identifier: GPL-3.0-or-later */
/* steps: in how many steps of its own each sphere of a bed went through a span
   of time with multirate, and where it was at its end: those that collided took
   many. The bed is that of settle, 200 spheres over the unit square. */
#include <stdio.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include "dynamics/motion.h"
#include "dynamics/multirate.h"
#include "model/fill.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "verbs.h"

struct span {
  double from, to; /* (s) */
  double tol;      /* (m/s) */
};

/* Steps m from the start to span's end and adds up each sphere's own in it. */
static int count_steps(struct motion *m, const struct span *span, size_t n,
                       size_t steps[]) {
  struct integrator *it = m->integrator;
  size_t *last = calloc(n, sizeof *last);
  if (!last)
    return GSL_ENOMEM;
  int status = integrate_stop(it, span->from);
  while (status == GSL_SUCCESS && integrate_time(it) < span->to) {
    if (integrate_time(it) == span->from)
      status = integrate_stop(it, span->to);
    const bool within = integrate_time(it) >= span->from;
    if (status == GSL_SUCCESS)
      status = integrate_step(it);
    if (status != GSL_SUCCESS || !within)
      continue;
    multirate_steps(motion_multirate(m), n, last);
    for (size_t i = 0; i < n; i++)
      steps[i] += last[i];
  }
  free(last);
  return status;
}

static int run(const struct span *span, struct bed *b, size_t steps[]) {
  const struct integrate_options o = {.method = "multirate",
                                      .control = "local",
                                      .tol = span->tol,
                                      .hinit = 0.1};
  struct scene scene = scene_default();
  int status = scene_add_box(&scene, 1, 1);
  struct motion *m = NULL;
  if (status == GSL_SUCCESS)
    status = motion_alloc(&m, &scene, b, &o,
                          &(struct dynamics_options){.threads = 1},
                          1 / scene.law.kappa);
  if (status == GSL_SUCCESS) {
    status = count_steps(m, span, b->n, steps);
    dynamics_unpack(m->dynamics, integrate_state(m->integrator), b);
    motion_free(m);
  }
  scene_free(&scene);
  return status;
}

int verb_steps(int argc, char **argv) {
  struct span span = {.from = 0.7, .to = 0.75, .tol = 2e-3};
  struct fill fill = {.count = 200,
                      .mass = 1,
                      .radius = 0.1,
                      .base = {1, 1},
                      .drop = 1.1,
                      .jitter = 0.25,
                      .seed = 1};
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "count", .type = OPTION_SIZE, .value = &fill.count, .least = 1,
       .most = 100000, .help = "number of spheres"},
      {.name = "seed", .type = OPTION_SIZE, .value = &fill.seed,
       .most = 4294967295,       .help = "of the start"},
      {.name = "from", .type = OPTION_DOUBLE, .value = &span.from, .unit = "s",
       .least = 0, .most = 1000, .help = "start of the span"},
      POSITIVE("to", &span.to, "s", "its end"),
      POSITIVE("tol", &span.tol, "m/s", "tolerance"),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary =
          "Where each sphere was at the end of a span of time, and in how "
          "many steps of its own it went through it.",
      .usage = "steps [OPTION...]",
      .example = "stability steps > steps.tsv",
      .options = options};
  verb_begin(&program, argc, argv);
  if (!(span.to > span.from))
    die(EXIT_USAGE, "--to %g: expected more than --from %g", span.to,
        span.from);
  struct bed bed;
  int status = fill_grid(&fill, &bed);
  if (status != GSL_SUCCESS)
    die_status(status, "steps");
  size_t *steps = calloc(bed.n, sizeof *steps);
  status = steps ? run(&span, &bed, steps) : GSL_ENOMEM;
  if (status != GSL_SUCCESS)
    die_status(status, "steps");
  printf("x\ty\tz\tr\tsteps\n");
  for (size_t i = 0; i < bed.n; i++)
    printf("%.6g\t%.6g\t%.6g\t%.6g\t%zu\n", bed.x[3 * i], bed.x[3 * i + 1],
           bed.x[3 * i + 2], bed.r[i], steps[i]);
  free(steps);
  bed_free(&bed);
  return EXIT_DONE;
}
