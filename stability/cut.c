/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cut: a contact ends at the gap lmax, with a jump of F0 exp(-kappa lmax).
   The study measures the floor that this puts under the error, and whether a
   smooth taper lowers it. A sphere meets a wall, e = 1, no gravity, in two
   unknowns; the taper is an experiment of this study and not in the law.

   Two errors: the speed it leaves with is the one it came with in any such
   model, which tells of the method alone; its gap in the end is compared with
   closed form 1 of the force without a cut, which tells of the model too. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "model/scene.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "model/travel.h"
#include "verbs.h"

static const char *const tapers[] = {"none", "shift", "c1", "c2", NULL};

/* The last part of lmax, over which tapers act. */
static const double tapered = 0.2;

struct wall_contact {
  struct contact_law law;
  size_t taper;  /* index into tapers */
  double travel; /* m */
  size_t evaluations;
};

static double force(const struct wall_contact *w, double gap) {
  const struct contact_law *law = &w->law;
  if (gap > law->lmax)
    return 0;
  const double f = contact_repulsion(law, gap);
  const double x = (law->lmax - gap) / (tapered * law->lmax); /* 0 at lmax */
  switch (w->taper) {
  case 1:
    return f - contact_repulsion(law, law->lmax);
  case 2:
    return x < 1 ? f * x * x * (3 - 2 * x) : f;
  case 3:
    return x < 1 ? f * x * x * x * (10 + x * (6 * x - 15)) : f;
  default:
    return f;
  }
}

static int rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  struct wall_contact *w = params;
  w->evaluations++;
  dydt[0] = y[1];
  dydt[1] = force(w, y[0]);
  return isfinite(dydt[0] + dydt[1]) ? GSL_SUCCESS : GSL_EBADFUNC;
}

static double step_limit(const double y[], const double dydt[], void *params) {
  const struct wall_contact *w = params;
  return travel_time(fabs(y[1]), fabs(dydt[1]), w->travel);
}

static void print_run(struct wall_contact *w, double v0,
                      const struct integrate_options *o) {
  const double tau = 45 / (w->law.kappa * v0);
  const double scale[2] = {1 / w->law.kappa, 1};
  const double f0 = w->law.f0, kappa = w->law.kappa;
  double start[2], end[2]; /* gap (m) and velocity (m/s), without a cut */
  closed_collision(f0, kappa, v0, -tau, &start[0], &start[1]);
  closed_collision(f0, kappa, v0, tau, &end[0], &end[1]);
  const struct integrate_problem problem = {
      .system = {.function = rhs, .dimension = 2, .params = w},
      .scale = scale,
      .row = 2,
      .positions = 1,
      .step_limit = step_limit};
  struct integrator *it;
  w->evaluations = 0;
  int status = integrate_alloc(&it, o, &problem, 0, start);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", o->method);
  status = integrate_stop(it, 2 * tau);
  while (status == GSL_SUCCESS && integrate_time(it) < 2 * tau)
    status = integrate_step(it);
  const double *y = integrate_state(it);
  printf("%s\t%s\t%g\t%.3g\t%.6g\t%.6g\t%zu\t%zu\t%zu\t%s\n", o->method,
         tapers[w->taper], w->law.lmax, o->tol, fabs(y[1] - end[1]) / v0,
         fabs(y[0] - end[0]) * w->law.kappa, w->evaluations,
         integrate_counts(it).accepted, integrate_counts(it).rejected,
         status == GSL_SUCCESS ? "ok" : "gave_up");
  integrate_free(it);
}

int verb_cut(int argc, char **argv) {
  struct option_list gaps = {4, {0.05, 0.1, 0.15, 0.2}};
  const char *taper = tapers[0];
  struct wall_contact w = {.law = scene_default().law};
  w.law.restitution = 1;
  struct integrate_options integrate = {
      .method = "rk8pd", .control = "standard", .hinit = 1e-3};
  double travel = 1, speed = 1, tightest = 1e-14;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "gaps", .type = OPTION_LIST, .value = &gaps, .least = 1,
       .most = 8, .unit = "m", .help = "where contacts end, lmax"},
      {.name = "taper", .type = OPTION_TEXT, .value = &taper,
       .choices = tapers,
       .help = "over the last fifth; shift takes F(lmax) off everywhere"},
      POSITIVE("speed", &speed, "m/s", "of approach"),
      POSITIVE("tightest", &tightest, "m/s",
               "smallest tolerance, from 1e-3 on"),
      LAW_OPTIONS(w.law),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability cut",
      .summary = "A contact that ends at lmax: errors of the speed (share) and "
                 "of the gap (in 1/kappa,\nagainst no cut) by tolerance.",
      .usage = "[OPTION...]",
      .example = "stability cut --method merson --taper c1",
      .options = options};
  verb_begin(&program, argc, argv);
  integrate_defaults(&integrate);
  if (!(speed > 0 && travel > 0))
    die(EXIT_USAGE, "--travel: expected a limit here");
  while (strcmp(tapers[w.taper], taper))
    w.taper++;
  w.travel = travel / w.law.kappa;
  for (size_t k = 0; k < gaps.count; k++) {
    printf("%smethod\ttaper\tlmax\ttol\terror_velocity\terror_gap\t"
           "evaluations\taccepted\trejected\tstatus\n",
           k ? "\n\n" : "");
    w.law.lmax = gaps.at[k];
    for (double power = -3; pow(10, power) > 0.99 * tightest; power -= 0.5) {
      integrate.tol = pow(10, power);
      print_run(&w, speed, &integrate);
    }
  }
  return EXIT_DONE;
}
