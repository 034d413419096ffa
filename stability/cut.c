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
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/drop.h"
#include "model/closed_forms.h"
#include "model/scene.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "verbs.h"

static const char *const tapers[] = {"none", "shift", "c1", "c2", NULL};

/* The last part of lmax, over which tapers act. */
static const double tapered_share = 0.2;

struct tapered_drop {
  struct drop drop; /* first, as its force finds the rest by it */
  size_t taper;     /* index into tapers */
};

/* f times the taper's factor at x, 0 at lmax and 1 where the taper begins, and
   by_x, f times the factor's derivative. */
static double tapered(size_t taper, double f, double x, double *by_x) {
  *by_x = 0;
  if (!(x < 1))
    return f;
  switch (taper) {
  case 2:
    *by_x = f * 6 * x * (1 - x);
    return f * x * x * (3 - 2 * x);
  case 3:
    *by_x = f * 30 * x * x * (1 - x) * (1 - x);
    return f * x * x * x * (10 + x * (6 * x - 15));
  default:
    return f;
  }
}

static double force(const struct drop *drop, double gap, double rate,
                    double slope[2]) {
  const struct contact_law *law = &drop->law;
  const size_t taper = ((const struct tapered_drop *)drop)->taper;
  const double width = tapered_share * law->lmax;
  double f = 0, by_gap = 0, by_x;
  (void)rate;
  if (gap <= law->lmax) {
    f = tapered(taper, contact_repulsion(law, gap), (law->lmax - gap) / width,
                &by_x);
    by_gap = -law->kappa * f - by_x / width;
    if (taper == 1)
      f -= contact_repulsion(law, law->lmax);
  }
  if (slope) {
    slope[0] = by_gap;
    slope[1] = 0;
  }
  return f;
}

static void print_run(struct tapered_drop *w, double v0,
                      const struct integrate_options *o) {
  const struct contact_law *law = &w->drop.law;
  const double tau = 45 / (law->kappa * v0);
  double start[2], end[2]; /* gap (m) and velocity (m/s), without a cut */
  closed_collision(law->f0, law->kappa, v0, -tau, &start[0], &start[1]);
  closed_collision(law->f0, law->kappa, v0, tau, &end[0], &end[1]);
  struct integrator *it;
  w->drop.evaluations = 0;
  int status = drop_alloc(&it, &w->drop, o, start[0], start[1]);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", o->method);
  status = integrate_stop(it, 2 * tau);
  while (status == GSL_SUCCESS && integrate_time(it) < 2 * tau)
    status = integrate_step(it);
  const double *y = integrate_state(it);
  printf("%s\t%s\t%g\t%.3g\t%.6g\t%.6g\t%zu\t%zu\t%zu\t%s\n", o->method,
         tapers[w->taper], law->lmax, o->tol, fabs(y[1] - end[1]) / v0,
         fabs(y[0] - end[0]) * law->kappa, w->drop.evaluations,
         integrate_counts(it).accepted, integrate_counts(it).rejected,
         status == GSL_SUCCESS ? "ok" : "gave_up");
  integrate_free(it);
}

int verb_cut(int argc, char **argv) {
  struct option_list gaps = {4, {0.05, 0.1, 0.15, 0.2}};
  const char *taper = tapers[0];
  struct tapered_drop w = {
      .drop = {.force = force, .law = scene_default().law}};
  struct contact_law *law = &w.drop.law;
  law->restitution = 1;
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
      LAW_OPTIONS(*law),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary = "A contact that ends at lmax: errors of the speed (share) and "
                 "of the gap (in 1/kappa,\nagainst no cut) by tolerance.",
      .usage = "cut [OPTION...]",
      .example = "stability cut --method merson --taper c1",
      .options = options};
  verb_begin(&program, argc, argv);
  integrate_defaults(&integrate);
  if (!(speed > 0 && travel > 0))
    die(EXIT_USAGE, "--travel: expected a limit here");
  while (tapers[w.taper] != taper)
    w.taper++;
  w.drop.travel = travel / law->kappa;
  for (size_t k = 0; k < gaps.count; k++) {
    printf("%smethod\ttaper\tlmax\ttol\terror_velocity\terror_gap\t"
           "evaluations\taccepted\trejected\tstatus\n",
           k ? "\n\n" : "");
    law->lmax = gaps.at[k];
    for (size_t rung = 0;; rung++) { /* two per decade */
      integrate.tol = pow(10, -3 - 0.5 * (double)rung);
      if (!(integrate.tol > 0.99 * tightest))
        break;
      print_run(&w, speed, &integrate);
    }
  }
  return EXIT_DONE;
}
