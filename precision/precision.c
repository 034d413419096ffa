/* SPDX-License-Identifier: GPL-3.0-or-later */
/* precision: one scene, one method, a ladder of tolerances or fixed steps; one
   row per run with its error and its cost. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "dynamics/dynamics.h"
#include "measure.h"
#include "program/integration.h"
#include "program/origin.h"
#include "program/shared_options.h"

/* clang-format off */
static const struct precision_scene *const scenes[] = {
    &scene_bounce,
    &scene_collision,
    &scene_restitution,
    &scene_toda_open,
    &scene_toda_closed,
    &scene_rolling,
    &scene_transition,
    &scene_slope,
    &scene_impacts[0],
    &scene_impacts[1],
    &scene_impacts[2],
    &scene_impacts[3],
    &scene_impacts[4],
    &scene_impacts[5],
    &scene_impacts[6],
    &scene_impacts[7],
    &scene_exponential,
    &scene_spring,
    &scene_walton_braun,
    &scene_trajectory,
};
/* clang-format on */

enum { SCENES = sizeof scenes / sizeof *scenes, LADDER = 16 };

struct ladder {
  size_t count;
  double at[LADDER];
};

static int add_rung(const struct option_list *v, void *context) {
  struct ladder *l = context;
  if (l->count == LADDER)
    return GSL_EINVAL;
  l->at[l->count++] = v->at[0];
  return GSL_SUCCESS;
}

static const struct precision_scene *find_scene(const char *name) {
  for (size_t i = 0; i < SCENES; i++)
    if (name && !strcmp(name, scenes[i]->name))
      return scenes[i];
  return NULL;
}

static void print_header(const struct option_spec *options,
                         const struct precision_scene *s,
                         const double reference_error[]) {
  char text[256];
  origin_write(stdout, &origin_comment, command_line(), NULL);
  origin_put(stdout, &origin_comment, "kernel", dynamics_machine());
  printf("# scene=%s\n# about=%s\n", s->name, s->summary);
  for (const struct option_spec *o = options; o->name; o++)
    if (o->parameter && !o->each) {
      option_text(o, text, sizeof text);
      printf("# %s=%s\n", o->name, text);
    }
  for (size_t e = 0; s->errors[e]; e++)
    printf("# reference_%s=%.3g\n", s->errors[e], reference_error[e]);
  printf("method\ttol\tstep");
  for (size_t e = 0; s->errors[e]; e++)
    printf("\t%s", s->errors[e]);
  puts("\tevaluations\tcpu_seconds\taccepted\trejected\tstatus");
}

static void print_row(const struct precision_scene *s,
                      const struct precision_case *c, const void *reference,
                      double timed) {
  struct precision_result r;
  const double start = measure_clock();
  double best = INFINITY, end = start;
  do {
    const double before = end;
    r = (struct precision_result){.status = measure_ok};
    const int status = s->run(c, reference, &r);
    if (status != GSL_SUCCESS)
      die_status(status, "%s: method %s", s->name, c->integrate->method);
    end = measure_clock();
    best = fmin(best, r.cpu_seconds > 0 ? r.cpu_seconds : end - before);
  } while (end - start < timed);
  printf("%s\t%.6g\t%.6g", c->integrate->method, c->integrate->tol,
         c->integrate->step);
  for (size_t e = 0; s->errors[e]; e++) {
    printf("\t%.6g", r.error[e]);
    if (!isfinite(r.error[e]) && r.status == measure_ok)
      r.status = "nan";
  }
  printf("\t%zu\t%.6g\t%zu\t%zu\t%s\n", r.evaluations, best, r.accepted,
         r.rejected, r.status);
  fflush(stdout);
}

int main(int argc, char **argv) {
  const char *scene = argc > 1 ? argv[1] : NULL;
  const struct precision_scene *s = find_scene(scene);
  const struct scene standard = scene_default();
  struct integrate_options integrate = {
      .method = "merson", .control = "standard", .hinit = 1e-3};
  struct precision_case c = {.integrate = &integrate,
                             .law = standard.law,
                             .gravity = -standard.gravity[2],
                             .count = 1,
                             .seed = 1};
  if (s && s->defaults)
    s->defaults(&c);
  double travel = 0, timed = 0.02;
  struct ladder tolerances = {0}, steps = {0};
  /* clang-format off */
  struct option_spec options[] = {
      LAW_OPTIONS(c.law),
      NUMBER("friction", &c.law.friction, 0, OPTION_MANY, "",
             "friction coefficient phi"),
      POSITIVE("vmin", &c.law.vmin, "m/s", "slip speed of full friction"),
      POSITIVE("lmax", &c.law.lmax, "m",
               "gap beyond which contacts are skipped"),
      NUMBER("gravity", &c.gravity, 0, OPTION_MANY, "m/s^2", "gravity"),
      NUMBER("time", &c.time, 0, OPTION_MANY, "s; 0: by scene", "end"),
      NUMBER("speed", &c.speed, 0, OPTION_MANY, "m/s", "speed at the start"),
      {.name = "count", .type = OPTION_SIZE, .value = &c.count, .least = 1,
       .most = 1e6, .help = "spheres", .parameter = true},
      SEED_OPTION(&c.seed, "of the random start"),
      {.name = "rung", .type = OPTION_LIST, .least = 1, .most = 1,
       .unit = "up to 16 times", .help = "a tolerance to run with",
       .each = add_rung, .context = &tolerances},
      {.name = "step-rung", .type = OPTION_LIST, .least = 1, .most = 1,
       .unit = "s, up to 16 times", .help = "a fixed step to run with",
       .each = add_rung, .context = &steps},
      NUMBER("timed", &timed, 0, OPTION_MANY, "s",
             "repeat each run for this time; the shortest counts"),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "precision",
      .summary = "One scene and method over tolerances (--rung) or fixed steps "
                 "(--step-rung);\none row per run: error and cost.",
      .usage = "SCENE [OPTION...]",
      .example = "precision collision --method rk8pd --rung 1e-4 --rung 1e-8",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  /* first, since its defaults were set before the options were read */
  if (operand != argc - 1 || !s || argv[operand] != scene) {
    for (size_t i = 0; i < SCENES; i++)
      fprintf(stderr, "%-12s %s\n", scenes[i]->name, scenes[i]->summary);
    die(EXIT_USAGE, "expected one of these scenes, before the options");
  }
  c.travel = travel / c.law.kappa;
  integrate_defaults(&integrate);
  if (!tolerances.count && !steps.count)
    die(EXIT_USAGE, "expected --rung or --step-rung");

  void *reference = NULL;
  double reference_error[PRECISION_ERRORS] = {0};
  if (s->prepare) {
    const int status = s->prepare(&c, &reference, reference_error);
    if (status != GSL_SUCCESS)
      die_status(status, "%s: no reference", s->name);
  }
  print_header(options, s, reference_error);
  for (size_t k = 0; k < tolerances.count; k++) {
    integrate.tol = tolerances.at[k];
    integrate.step = 0;
    print_row(s, &c, reference, timed);
  }
  for (size_t k = 0; k < steps.count; k++) {
    integrate.step = steps.at[k];
    print_row(s, &c, reference, timed);
  }
  free(reference);
  finish_output();
  return EXIT_DONE;
}
