/* SPDX-License-Identifier: GPL-3.0-or-later */
/* limits: the largest stable step of each method, by bisection on a fixed
   step, on two contacts whose linear behaviour is known.

   real: a sphere that slides down a plane steadily, at the slip of vmin/2 where
   Sigma' is largest, 3/(2 vmin). By (2.9), (2.11) and (2.14) the slip u follows
     u' = g sin a - (1/m + r^2/I) phi F Sigma(u),
   and a change of it decays with (1/m + r^2/I) phi F 3/(2 vmin). The plane is
   as steep as makes the slip steady: Sigma = 1/2.
   imaginary: a sphere of e = 1 at rest on the floor, z'' = -kappa g z.

   Theory is where |R(z)| of the linear test equation leaves 1, R by the stepper
   itself (stepper.h); known values of the literature are in
   tests/figures_stability.sh. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "dynamics/dynamics.h"
#include "steppers/chebyshev.h"
#include "steppers/rkc.h"
#include "program/shared_options.h"
#include "steppers/integrate.h"
#include "stepper.h"
#include "verbs.h"

/* A perturbation grows when its largest size in the second half of the steps
   is this multiple of that in the first half: 1e-6 per step in 1000 steps. It
   grows at once when it has become a hundredfold. */
static const double growth = 1.001, runaway = 100;

enum axis { REAL, IMAGINARY };
static const char *const axis_names[] = {"real", "imaginary"};

/* A sphere on a plane at its steady state, and the mode that is perturbed. */
struct pressed {
  enum axis axis;
  struct scene scene;
  struct bed bed;
  struct dynamics *dynamics;
  double rate;  /* |eigenvalue| (1/s) */
  double slip;  /* steady (m/s) */
  double rest;  /* height of the centre (m) */
  double small; /* the perturbation, as mode_size has it */
  size_t steps; /* that a run takes */
};

static const double radius = 0.1, gravity = 9.81;

static int pressed_alloc(struct pressed *p, enum axis axis, double vmin,
                         double share) {
  *p = (struct pressed){.axis = axis, .scene = scene_default()};
  struct contact_law *law = &p->scene.law;
  const double inverse = 1 + 2.5; /* 1/m + r^2/I of unit mass (1/kg) */
  double pull = 0, weight = gravity;
  law->vmin = vmin;
  if (axis == REAL) {
    const double angle =
        atan(0.5 * inverse * law->friction / contact_rebound(law, 0));
    pull = gravity * sin(angle);
    weight = gravity * cos(angle);
    const double f = weight / contact_rebound(law, 0);
    p->rate = inverse * law->friction * f * 1.5 / vmin;
    p->slip = 0.5 * vmin;
    p->small = share * vmin;
    p->steps = 500;
  } else {
    p->scene.model = SCENE_BASIC;
    law->restitution = 1;
    p->rate = sqrt(law->kappa * gravity);
    p->small = share * p->rate / law->kappa;
    p->steps = 2000;
  }
  memcpy(p->scene.gravity, (double[]){pull, 0, -weight},
         sizeof p->scene.gravity);
  int status =
      scene_add_wall(&p->scene, (double[]){0, 0, 0}, (double[]){0, 0, -1});
  if (status == GSL_SUCCESS)
    status = bed_alloc(&p->bed, 1);
  if (status != GSL_SUCCESS)
    return status;
  p->rest = radius + closed_rest_gap(law, weight);
  p->bed.r[0] = radius;
  p->bed.x[2] = p->rest;
  if (axis == REAL) { /* along the mode: v by 1/m, w by r/I the other way */
    const double u = p->slip + p->small;
    p->bed.v[0] = u / inverse;
    p->bed.w[1] = -2.5 * u / inverse / radius;
  } else {
    p->bed.x[2] += p->small / p->rate;
  }
  return dynamics_alloc(&p->dynamics, &p->scene, &p->bed,
                        &(struct dynamics_options){.threads = 1});
}

static void pressed_free(struct pressed *p) {
  dynamics_free(p->dynamics);
  bed_free(&p->bed);
  scene_free(&p->scene);
}

/* Size of the perturbation (m/s). */
static double mode_size(const struct pressed *p, const double y[]) {
  if (p->axis == REAL)
    return fabs(y[ROW_V] - radius * y[ROW_W + 1] - p->slip);
  return hypot(p->rate * (y[ROW_X + 2] - p->rest), y[ROW_V + 2]);
}

/* Whether the method with h = z/rate lets the perturbation grow or fails. */
static bool grows(struct pressed *p, struct stepper_kind kind, double z) {
  double y[ROW_SPIN];
  const double h = z / p->rate;
  const gsl_odeiv2_system sys = {.function = dynamics_rhs,
                                 .dimension = dynamics_dimension(p->dynamics),
                                 .params = p->dynamics};
  struct stepper s;
  const int status = stepper_alloc(&s, kind, sys.dimension,
                                   dynamics_stride(p->dynamics), ROW_V);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", kind.method);
  dynamics_pack(p->dynamics, &p->bed, y);
  double most[2] = {p->small, 0};
  bool lost = false;
  for (size_t k = 0; k < p->steps && !lost; k++) {
    lost = stepper_apply(&s, &sys, h * (double)k, h, y) != GSL_SUCCESS;
    const double size = mode_size(p, y);
    double *half = &most[2 * k >= p->steps];
    *half = GSL_MAX(*half, size);
    lost = lost || !(size <= runaway * p->small);
  }
  stepper_free(&s);
  return lost || most[1] > growth * most[0];
}

static bool amplifies(struct pressed *p, struct stepper_kind kind, double z) {
  double r[2];
  const int status = p->axis == REAL ? stepper_factor(kind, -z, 0, r)
                                     : stepper_factor(kind, 0, z, r);
  return status != GSL_SUCCESS ||
         !(hypot(r[0], r[1]) <= pow(growth, 2. / (double)p->steps));
}

/* The first z at which a predicate turns true, from z on. */
static double first_z(bool (*test)(struct pressed *, struct stepper_kind,
                                   double),
                      struct pressed *p, struct stepper_kind kind, double z) {
  double low = 0, high = z;
  while (!test(p, kind, high) && high < 1e6) {
    low = high;
    high *= 1.1;
  }
  while (high - low > 1e-4 * high) {
    z = 0.5 * (low + high);
    *(test(p, kind, z) ? &high : &low) = z;
  }
  return 0.5 * (low + high);
}

static double theory(struct pressed *p, struct stepper_kind kind) {
  /* verlet: z'' = -w^2 z is stable for w h < 2. Where position does not enter,
     half' = (1 - h rate) half of the velocities at half steps: 2 as well. */
  const struct integrate_method *m = integrate_method(kind.method);
  if (m->layout)
    return 2;
  /* rkc left alone takes the stages it needs, up to 400, for 1.2 times its
     estimate of the spectral radius */
  if (m->adapts && !kind.stages)
    return chebyshev_reach(CHEBYSHEV_MOST) / 1.2;
  return first_z(amplifies, p, kind, 0.01);
}

static void print_limit(struct pressed *p, struct stepper_kind kind) {
  char name[32];
  const double expected = theory(p, kind);
  const double measured = first_z(grows, p, kind, expected / 8);
  /* what a step of nearly that size costs */
  const size_t steps = p->steps,
               before = dynamics_counts(p->dynamics).evaluations;
  p->steps = 8; /* two estimates of rkc's */
  grows(p, kind, 0.98 * measured);
  const double cost =
      (double)(dynamics_counts(p->dynamics).evaluations - before - 1) / 8;
  p->steps = steps;
  printf("%s\t%s\t%.6g\t%.6g\t%.4f\t%.4g\t%.4g\n", stepper_name(kind, name),
         axis_names[p->axis], expected, measured, measured / expected, cost,
         measured / cost);
  fflush(stdout);
}

int verb_limits(int argc, char **argv) {
  double vmin = 1e-5, share = 1e-6;
  /* clang-format off */
  struct option_spec options[] = {
      POSITIVE("vmin", &vmin, "m/s",
               "slip speed of full friction; so small that the slip is far"
               " faster than all else"),
      POSITIVE("perturbation", &share, "of vmin, and of 1/kappa",
               "what is to grow or not"),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary = "The largest stable h |lambda| of each method on the slip of "
                 "a pressed sphere\n(real axis) and on a contact's undamped "
                 "oscillation (imaginary axis).",
      .usage = "limits [OPTION...]",
      .example = "stability limits > limits.tsv",
      .options = options};
  verb_begin(&program, argc, argv);
  static const struct stepper_kind kinds[] = {
      {"merson", 0}, {"dopri5", 0}, {"rkf45", 0}, {"rkck", 0}, {"rk8pd", 0},
      {"verlet", 0}, {"rkc", 2},    {"rkc", 5},   {"rkc", 10}, {"rkc", 0}};
  puts("method\taxis\ttheory\tmeasured\tratio\tevaluations\tper_evaluation");
  for (enum axis axis = REAL; axis <= IMAGINARY; axis++) {
    struct pressed p;
    const int status = pressed_alloc(&p, axis, vmin, share);
    if (status != GSL_SUCCESS)
      die_status(status, "a pressed sphere");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
      const bool by_itself =
          !kinds[k].stages && integrate_method(kinds[k].method)->adapts;
      /* its choice of stages follows the real axis; and it refuses what is
         beyond, so few steps will do */
      if (by_itself && axis == IMAGINARY)
        continue;
      const size_t steps = p.steps;
      p.steps = by_itself ? 100 : steps;
      print_limit(&p, kinds[k]);
      p.steps = steps;
    }
    pressed_free(&p);
  }
  return EXIT_DONE;
}
