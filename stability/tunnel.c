/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tunnel: a fast sphere comes out of free flight, where the error estimate is
   zero and the step grows without bound. The study counts how often the method
   misses the sphere or wall that is in the way.

   No gravity, e = 1: the sphere must leave as fast as it came. Each row is of
   runs that differ in the distance of flight. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/motion.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "verbs.h"

enum outcome { BOUNCED, MISSED, WRONG, FAILED, OUTCOMES };
static const char *const outcome_names[] = {"bounced", "missed", "wrong",
                                            "failed"};

/* A bounce counts as right when the relative error of its speed is below
   this. */
static const double right = 0.05;

static const double radius = 0.1;

struct shot {
  const char *target; /* "sphere" or "wall" */
  double speed;       /* of approach (m/s) */
  double distance;    /* between surfaces (m) */
  double travel;      /* m, 0: any */
  struct contact_law law;
};

/* The moving sphere comes down on a wall at z = 0, or two equal spheres meet
   halfway. */
static int shoot(const struct shot *s, const struct integrate_options *o,
                 enum outcome *outcome, size_t *evaluations) {
  const bool wall = !strcmp(s->target, "wall");
  struct scene scene = {.model = SCENE_BASIC, .law = s->law};
  struct bed bed = {0};
  struct motion *m = NULL;
  int status =
      wall ? scene_add_wall(&scene, (double[]){0, 0, 0}, (double[]){0, 0, -1})
           : GSL_SUCCESS;
  if (status == GSL_SUCCESS)
    status = bed_alloc(&bed, wall ? 1 : 2);
  if (status != GSL_SUCCESS) {
    scene_free(&scene);
    return status;
  }
  bed.r[0] = radius;
  bed.x[2] = radius + s->distance;
  bed.v[2] = -s->speed;
  if (!wall) {
    bed.r[1] = radius;
    bed.x[2] = radius + 0.5 * s->distance;
    bed.v[2] = -0.5 * s->speed;
    bed.x[5] = -bed.x[2];
    bed.v[5] = -bed.v[2];
  }
  status = motion_alloc(&m, &scene, &bed, o,
                        &(struct dynamics_options){.threads = 1}, s->travel);
  bed_free(&bed);
  scene_free(&scene);
  if (status != GSL_SUCCESS)
    return status;
  const double end = 3 * s->distance / s->speed;
  bool lost = false;
  /* after more steps it counts as stuck */
  for (size_t k = 0; k < 100000 && integrate_time(m->integrator) < end && !lost;
       k++)
    lost = integrate_step(m->integrator) != GSL_SUCCESS;
  const double *y = integrate_state(m->integrator);
  const double *other = y + ROW_PLAIN; /* the second sphere's row */
  const double height = y[ROW_X + 2] - (wall ? 0 : other[ROW_X + 2]);
  const double speed = y[ROW_V + 2] - (wall ? 0 : other[ROW_V + 2]);
  if (lost || integrate_time(m->integrator) < end)
    *outcome = FAILED;
  else if (speed < 0)
    *outcome = height < 0 ? MISSED : WRONG;
  else
    *outcome =
        fabs(speed / s->speed - 1) <= right && height > 0 ? BOUNCED : WRONG;
  *evaluations += dynamics_counts(m->dynamics).evaluations;
  motion_free(m);
  return GSL_SUCCESS;
}

int verb_tunnel(int argc, char **argv) {
  struct option_list speeds = {5, {1, 3, 10, 30, 100}};
  struct option_list tolerances = {6, {1, 0.1, 0.01, 1e-3, 1e-4, 1e-6}};
  struct integrate_options integrate = {.method = "merson", .hinit = 0.1};
  struct shot shot = {.law = scene_default().law};
  shot.law.restitution = 1;
  double travel = 0;
  size_t runs = 20;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "speeds", .type = OPTION_LIST, .value = &speeds, .least = 1,
       .most = 8, .unit = "m/s", .help = "of approach"},
      {.name = "tolerances", .type = OPTION_LIST, .value = &tolerances,
       .least = 1, .most = 8, .unit = "as --control has it", .help = "tried"},
      {.name = "runs", .type = OPTION_SIZE, .value = &runs, .least = 1,
       .most = 1e6, .help = "per row, at distances from 2 to 3 m"},
      LAW_OPTIONS(shot.law),
      POSITIVE("lmax", &shot.law.lmax, "m",
               "gap beyond which contacts are skipped"),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary = "Shots at a sphere and at a wall out of free flight: how many "
                 "bounce, are missed,\ncome out with a wrong speed, or fail.",
      .usage = "tunnel [OPTION...]",
      .example = "stability tunnel --method dopri5 --travel 1",
      .options = options};
  verb_begin(&program, argc, argv);
  integrate_defaults(&integrate);
  shot.travel = travel / shot.law.kappa;
  printf("method\ttarget\ttravel\tspeed\ttol\truns");
  for (size_t k = 0; k < OUTCOMES; k++)
    printf("\t%s", outcome_names[k]);
  puts("\tevaluations");
  static const char *const targets[] = {"sphere", "wall"};
  for (size_t g = 0; g < 2; g++)
    for (size_t i = 0; i < speeds.count; i++)
      for (size_t j = 0; j < tolerances.count; j++) {
        size_t counts[OUTCOMES] = {0}, evaluations = 0;
        shot.target = targets[g];
        shot.speed = speeds.at[i];
        integrate.tol = tolerances.at[j];
        for (size_t k = 0; k < runs; k++) {
          enum outcome outcome;
          shot.distance = 2 + (double)k / (double)runs;
          const int status = shoot(&shot, &integrate, &outcome, &evaluations);
          if (status != GSL_SUCCESS)
            die_status(status, "method %s", integrate.method);
          counts[outcome]++;
        }
        printf("%s\t%s\t%g\t%g\t%g\t%zu", integrate.method, shot.target, travel,
               shot.speed, integrate.tol, runs);
        for (size_t k = 0; k < OUTCOMES; k++)
          printf("\t%zu", counts[k]);
        printf("\t%.4g\n", (double)evaluations / (double)runs);
      }
  return EXIT_DONE;
}
