/* SPDX-License-Identifier: GPL-3.0-or-later */
/* creep: a sphere that cannot turn, on slopes around the friction angle. The
   limiter (2.8) has no threshold, so there is a friction T only while the
   sphere slips, at s vmin with 3 s^2 - 2 s^3 = T/(phi F). On steeper slopes it
   slides down. */
#include <math.h>
#include <stdio.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "dynamics/motion.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "verbs.h"

static const double radius = 0.1, gravity = 9.81;

/* 3 s^2 - 2 s^3 = q in [0, 1] */
static double slip_share(double q) {
  return 0.5 - sin(asin(1 - 2 * q) / 3);
}

struct slope {
  const struct contact_law *law;
  double share; /* of full slip's friction that the pull is */
  double angle; /* (rad) */
  double full;  /* deceleration by full slip (m/s^2) */
};

static struct slope make_slope(const struct contact_law *law, double share) {
  const double limit = law->friction / contact_rebound(law, 0);
  const double angle = atan(share * limit);
  return (struct slope){law, share, angle, limit * gravity * cos(angle)};
}

/* dt/ds on the way from rest to vmin */
static double start_time(double s, void *params) {
  const struct slope *a = params;
  return a->law->vmin / a->full / (a->share - s * s * (3 - 2 * s));
}

/* Speed at a time after rest, as a share of vmin; below the friction angle the
   one that is reached in the end. */
static double closed_form(struct slope *a, double time) {
  if (a->share <= 1)
    return slip_share(a->share);
  gsl_function f = {start_time, a};
  gsl_integration_cquad_workspace *w =
      gsl_integration_cquad_workspace_alloc(100);
  double start = GSL_NAN;
  if (!w || gsl_integration_cquad(&f, 0, 1, 0, 1e-10, w, &start, NULL, NULL) !=
                GSL_SUCCESS)
    start = GSL_NAN;
  gsl_integration_cquad_workspace_free(w);
  return 1 + (time - start) * a->full * (a->share - 1) / a->law->vmin;
}

struct speeds {
  double end, least, most; /* at the end and in the second half (m/s) */
  size_t evaluations;
};

/* Starts at rest; NaN where the method fails. */
static int creep(const struct slope *a, double time, double travel,
                 const struct integrate_options *o, struct speeds *v) {
  const struct contact_law *law = a->law;
  const double weight = gravity * cos(a->angle);
  const struct scene scene = {.model = SCENE_FRICTION,
                              .law = *law,
                              .gravity = {gravity * sin(a->angle), 0, -weight}};
  const double rest = closed_rest_gap(law, weight);
  struct motion *m = NULL;
  int status = motion_alloc_over_floor(&m, &scene, radius,
                                       (double[]){0, 0, radius + rest},
                                       (double[]){0, 0, 0}, o, travel);
  if (status != GSL_SUCCESS)
    return status;
  *v = (struct speeds){GSL_NAN, GSL_POSINF, GSL_NEGINF, 0};
  status = integrate_stop(m->integrator, time);
  while (status == GSL_SUCCESS && integrate_time(m->integrator) < time) {
    status = integrate_step(m->integrator);
    const double now = integrate_state(m->integrator)[ROW_V];
    if (integrate_time(m->integrator) > 0.5 * time) {
      v->least = GSL_MIN(v->least, now);
      v->most = GSL_MAX(v->most, now);
    }
  }
  if (status == GSL_SUCCESS)
    v->end = integrate_state(m->integrator)[ROW_V];
  v->evaluations = dynamics_counts(m->dynamics).evaluations;
  motion_free(m);
  return GSL_SUCCESS;
}

int verb_creep(int argc, char **argv) {
  struct option_list shares = {8,
                               {0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98, 1.02}};
  struct contact_law law = scene_default().law;
  struct integrate_options integrate = {.method = "merson", .hinit = 1e-4};
  double time = 1;
  double travel = 1;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "shares", .type = OPTION_LIST, .value = &shares, .least = 1,
       .most = 8, .help = "of the friction limit that the slopes ask for"},
      POSITIVE("time", &time, "s", "when the speed is read"),
      LAW_OPTIONS(law),
      NUMBER("friction", &law.friction, 0, OPTION_MANY, "",
             "friction coefficient phi"),
      POSITIVE("vmin", &law.vmin, "m/s", "slip speed of full friction"),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary = "Creep of a sphere on slopes around the friction angle beside "
                 "the closed form,\nspeeds as shares of vmin.",
      .usage = "creep [OPTION...]",
      .example = "stability creep --method rkc",
      .options = options};
  verb_begin(&program, argc, argv);
  integrate_defaults(&integrate);
  puts("method\tshare\tslope_degrees\tclosed\tmeasured\tleast\tmost\t"
       "evaluations");
  for (size_t k = 0; k < shares.count; k++) {
    struct slope slope = make_slope(&law, shares.at[k]);
    struct speeds v;
    const int status = creep(&slope, time, travel / law.kappa, &integrate, &v);
    if (status != GSL_SUCCESS)
      die_status(status, "method %s", integrate.method);
    printf("%s\t%.6g\t%.6g\t%.9g\t%.9g\t%.9g\t%.9g\t%zu\n", integrate.method,
           slope.share, slope.angle * 180 / M_PI, closed_form(&slope, time),
           v.end / law.vmin, v.least / law.vmin, v.most / law.vmin,
           v.evaluations);
  }
  return EXIT_DONE;
}
