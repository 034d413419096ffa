/* SPDX-License-Identifier: GPL-3.0-or-later */
/* drift: energy of an elastic scene without friction, e = 1 and phi = 0, over
   long times; nothing may be gained or lost (closed form 6). A sphere that
   bounces on the floor, or a closed box of spheres under gravity. --cost
   searches for the tolerance, or the step, that takes the given number of
   evaluations per bounce or per second, so that methods can be compared at
   equal cost. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "dynamics/motion.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "verbs.h"

static const double radius = 0.1, gravity = 9.81;

struct elastic {
  bool box;           /* else one sphere on the floor */
  size_t count, seed; /* of the box */
  double edge;        /* of the box (m) */
  double drop;        /* of the sphere (m) */
  double unit;        /* that time is counted in: a bounce or a second (s) */
  double travel;      /* m, 0: any */
  struct contact_law law;
};

/* Spheres on a grid with random offsets and velocities, so that none begins
   within a contact. */
static int fill_box(const struct elastic *e, struct scene *s, struct bed *b) {
  const size_t side = (size_t)ceil(cbrt((double)e->count));
  const double cell = e->edge / (double)side;
  int status = scene_add_box(s, e->edge, e->edge);
  if (status == GSL_SUCCESS)
    status = scene_add_wall(s, (double[]){0, 0, e->edge}, (double[]){0, 0, 1});
  if (status != GSL_SUCCESS)
    return status;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  gsl_rng_set(rng, e->seed);
  for (size_t i = 0; i < e->count; i++) {
    const size_t at[3] = {i % side, i / side % side, i / side / side};
    b->r[i] = radius;
    for (size_t k = 0; k < 3; k++) {
      const double room = cell - 2 * radius;
      b->x[3 * i + k] = cell * (double)at[k] + radius +
                        room * (0.4 + 0.2 * gsl_rng_uniform(rng));
      b->v[3 * i + k] = 2 * gsl_rng_uniform(rng) - 1;
    }
  }
  gsl_rng_free(rng);
  return GSL_SUCCESS;
}

static int start(struct motion **m, const struct elastic *e,
                 const struct integrate_options *o) {
  struct scene scene = {
      .model = SCENE_BASIC, .law = e->law, .gravity = {0, 0, -gravity}};
  if (!e->box)
    return motion_alloc_over_floor(m, &scene, radius,
                                   (double[]){0, 0, radius + e->drop},
                                   (double[]){0, 0, 0}, o, e->travel);
  struct bed bed = {0};
  int status = bed_alloc(&bed, e->count);
  if (status == GSL_SUCCESS)
    status = fill_box(e, &scene, &bed);
  if (status == GSL_SUCCESS)
    status = motion_alloc(m, &scene, &bed, o,
                          &(struct dynamics_options){.threads = 1}, e->travel);
  bed_free(&bed);
  scene_free(&scene);
  return status;
}

static double energy(const struct motion *m) {
  const double *y = integrate_state(m->integrator);
  return dynamics_kinetic(m->dynamics, y) + dynamics_potential(m->dynamics, y);
}

/* Evaluations per unit of time over the first ten units; positive infinity if
   the run fails or takes too many. */
static double cost_of(const struct elastic *e,
                      const struct integrate_options *o, double too_many) {
  struct motion *m = NULL;
  const double units = 10;
  const int status = start(&m, e, o);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", o->method);
  double cost = 0;
  while (integrate_time(m->integrator) < units * e->unit && cost < too_many) {
    if (integrate_step(m->integrator) != GSL_SUCCESS)
      cost = GSL_POSINF;
    else
      cost = (double)dynamics_counts(m->dynamics).evaluations / units;
  }
  motion_free(m);
  return cost;
}

/* Bisection in the logarithm of the tolerance. Costs fall with it except for
   noise: rkc's estimate of the spectral radius of undamped contacts, and so its
   stages, differ twofold from one run of the box to the next. So the nearest
   of all tried is taken; whether it is near enough for a chart of decades. */
static bool search_cost(const struct elastic *e, struct integrate_options *o,
                        double cost) {
  if (!integrate_method(o->method)->estimates) {
    o->step = e->unit / cost;
    return true;
  }
  double low = log(1e-15), high = log(0.1);
  double nearest = GSL_POSINF, best = 0;
  for (int k = 0; k < 30 && nearest > 0.02; k++) {
    const double middle = 0.5 * (low + high);
    o->tol = exp(middle);
    const double found = cost_of(e, o, 2 * cost);
    if (fabs(found / cost - 1) < nearest) {
      nearest = fabs(found / cost - 1);
      best = o->tol;
    }
    *(found > cost ? &low : &high) = middle;
  }
  o->tol = best;
  return nearest < 0.5;
}

int verb_drift(int argc, char **argv) {
  static const char *const scenes[] = {"bounce", "box", NULL};
  const char *name = "bounce";
  struct elastic e = {.count = 50,
                      .seed = 1,
                      .edge = 1.2,
                      .drop = 1,
                      .law = scene_default().law};
  e.law.restitution = 1;
  e.law.friction = 0;
  e.law.lmax = 0.2; /* F0 exp(-30) there: 6e-15 J of the energy */
  struct integrate_options integrate = {
      .method = "merson", .control = "standard", .hinit = 1e-3};
  double travel = 10, cost = 0, units = 1000;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "scene", .type = OPTION_TEXT, .value = &name,
       .choices = scenes, .help = "one sphere and the floor, or a closed box"},
      POSITIVE("drop", &e.drop, "m", "height that the one sphere falls from"),
      {.name = "count", .type = OPTION_SIZE, .value = &e.count, .least = 1,
       .most = 1e6, .help = "spheres in the box"},
      SEED_OPTION(&e.seed, "of the box"),
      POSITIVE("edge", &e.edge, "m", "of the box"),
      NUMBER("units", &units, 1, 1e9, "bounces, or seconds of the box",
             "how long"),
      NUMBER("cost", &cost, 0, OPTION_MANY, "per unit; 0: by --tol or --step",
             "evaluations aimed at"),
      LAW_OPTIONS(e.law),
      POSITIVE("lmax", &e.law.lmax, "m",
               "gap beyond which contacts are skipped"),
      INTEGRATION_OPTIONS(integrate, travel),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary = "Energy error of an elastic scene over time, as share of the "
                 "energy: at the row's\ntime (the one sphere: at its apex) and "
                 "the largest since the row before.",
      .usage = "drift [OPTION...]",
      .example = "stability drift --method dopri5 --cost 3000",
      .options = options};
  verb_begin(&program, argc, argv);
  e.box = !strcmp(name, "box");
  /* of a hard bounce; the soft one is a little longer */
  e.unit = e.box ? 1 : 2 * sqrt(2 * e.drop / gravity);
  e.travel = travel / e.law.kappa;
  integrate_defaults(&integrate);
  if (e.box && !(e.edge / ceil(cbrt((double)e.count)) > 2 * radius))
    die(EXIT_USAGE, "--edge: too small for %zu spheres", e.count);
  if (cost > 0 && !search_cost(&e, &integrate, cost))
    die(EXIT_LIMIT, "method %s: no tolerance costs %g evaluations a unit",
        integrate.method, cost);

  struct motion *m = NULL;
  const int status = start(&m, &e, &integrate);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", integrate.method);
  puts("method\ttol\tstep\tunits\terror\tlargest\tevaluations\tstatus");
  const double first = energy(m);
  double next = 1, largest = 0, rise = 0;
  bool going = true;
  while (going) {
    going = integrate_step(m->integrator) == GSL_SUCCESS;
    const double error = energy(m) / first - 1;
    if (!(fabs(error) <= largest))
      largest = fabs(error);
    /* the one sphere is looked at where it turns, far from the floor */
    const double last_rise = rise;
    rise = integrate_state(m->integrator)[ROW_V + 2];
    const bool turned = e.box || (last_rise > 0 && rise <= 0);
    if ((integrate_time(m->integrator) >= (next - 0.1) * e.unit && turned) ||
        !going) {
      printf("%s\t%.3g\t%.3g\t%.6g\t%.6g\t%.6g\t%zu\t%s\n", integrate.method,
             integrate.tol, integrate.step,
             integrate_time(m->integrator) / e.unit, error, largest,
             dynamics_counts(m->dynamics).evaluations,
             going ? "ok" : "gave_up");
      fflush(stdout);
      largest = 0;
      if (next >= units)
        break;
      next = GSL_MIN(GSL_MAX(next * pow(10, 0.1), next + 1), units);
    }
  }
  motion_free(m);
  return EXIT_DONE;
}
