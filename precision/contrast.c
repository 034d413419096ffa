/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One collision by three laws, to show the value of the smoothness of the
   paper's law: its exponential repulsion, a linear spring, which begins with a
   kink at touch, and the law of Walton and Braun (J. Rheol. 30 (1986) 949),
   whose spring is stiffer while unloading and lets go at an overlap that is
   left. The springs have the exponential's largest force: k = (kappa v0/2)^2,
   so that all have the same pace a = kappa v0/2 of the closed form sech^2.

   Chance decides where within a step a kink lies, so errors are root mean
   squares over MEASURE_STARTS runs. */
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

static const size_t most = 20000000;

/* Times are in 1/a: half of a run is 20. */
static const double half = 20;

static double pace(const struct precision_case *c) {
  return c->law.kappa * c->speed / 2;
}

/* A drop onto a spring. */
struct loaded {
  struct drop drop;          /* first, as a law finds the rest by it */
  double loading, unloading; /* N/m */
  double deepest;            /* overlap at an accepted step so far (m) */
};

static double spring(const struct drop *drop, double gap, double rate,
                     double slope[2]) {
  const struct loaded *d = (const struct loaded *)drop;
  (void)rate;
  if (slope) {
    slope[0] = gap < 0 ? -d->loading : 0;
    slope[1] = 0;
  }
  return gap < 0 ? -d->loading * gap : 0;
}

/* The deepest overlap is a memory that is updated between steps, as programs
   for such laws do. */
static double walton_braun(const struct drop *drop, double gap, double rate,
                           double slope[2]) {
  const struct loaded *d = (const struct loaded *)drop;
  (void)rate;
  const double rest = d->deepest * (1 - d->loading / d->unloading);
  const bool loading = -gap >= d->deepest;
  const double stiffness = -gap <= (loading ? 0 : rest) ? 0
                           : loading                    ? d->loading
                                                        : d->unloading;
  if (slope) {
    slope[0] = -stiffness;
    slope[1] = 0;
  }
  return stiffness * (-gap - (loading ? 0 : rest));
}

/* At the end. */
struct course {
  double gap, velocity;
};

typedef double force(const struct drop *, double, double, double[2]);

static struct loaded make_drop(const struct precision_case *c, force *law) {
  const double k = gsl_pow_2(pace(c));
  return (struct loaded){
      .drop = {.force = law, .law = c->law, .travel = c->travel},
      .loading = k,
      .unloading = k / gsl_pow_2(c->law.restitution)};
}

/* Gap at the start, half a run and the time more before the middle: of the
   contact's loading and unloading for springs, of the turn for the
   exponential. */
static double start_gap(const struct precision_case *c, force *law, double more,
                        double *velocity) {
  const double a = pace(c);
  double gap;
  closed_collision(c->law.f0, c->law.kappa, c->speed, -half / a - more, &gap,
                   velocity);
  if (law == drop_contact)
    return gap;
  *velocity = -c->speed;
  return c->speed * ((half - M_PI_2) / a + more);
}

static int run_one(const struct precision_case *c, force *law,
                   const struct integrate_options *o, double more,
                   const struct course *exact, struct course *end,
                   struct precision_result *r) {
  struct loaded d = make_drop(c, law);
  double velocity;
  const double gap = start_gap(c, law, more, &velocity);
  const double time = 2 * half / pace(c) + more;
  struct integrator *it;
  const int status = drop_alloc(&it, &d.drop, o, gap, velocity);
  if (status != GSL_SUCCESS)
    return status;
  const double *y = integrate_state(it);
  measure_start(r);
  const char *word =
      integrate_stop(it, time) == GSL_SUCCESS ? measure_ok : "gave_up";
  while (integrate_time(it) < time && word == measure_ok) {
    word = measure_step(it, most);
    d.deepest = GSL_MAX(d.deepest, -y[0]);
  }
  measure_stop(r);
  if (word != measure_ok)
    r->status = word;
  *end = (struct course){.gap = y[0], .velocity = y[1]};
  const double error[] = {fabs(y[0] - exact->gap),
                          fabs(y[1] - exact->velocity)};
  measure_add(r, it, d.drop.evaluations, error, 2);
  integrate_free(it);
  return GSL_SUCCESS;
}

static int run(const struct precision_case *c, force *law,
               const struct course *exact, struct precision_result *r) {
  int status = GSL_SUCCESS;
  struct course end;
  for (size_t k = 0; k < MEASURE_STARTS && status == GSL_SUCCESS; k++) {
    const struct integrate_options o = measure_variant(c->integrate, k);
    const double more = (double)k / MEASURE_STARTS / pace(c);
    status = run_one(c, law, &o, more, exact, &end, r);
  }
  measure_mean(r);
  return status;
}

/* A reference that prepare found, as main wants it. */
static int hand_over(struct course exact, void **out) {
  struct course *copy = malloc(sizeof *copy);
  if (!copy)
    return GSL_ENOMEM;
  *copy = exact;
  *out = copy;
  return GSL_SUCCESS;
}

/* e = 1: sech^2. Else a tight run, whose error is its distance to another. */
static int prepare_exponential(const struct precision_case *c, void **out,
                               double reference_error[]) {
  struct course exact = {0}, other = {0};
  if (c->law.restitution == 1)
    closed_collision(c->law.f0, c->law.kappa, c->speed, half / pace(c),
                     &exact.gap, &exact.velocity);
  else {
    struct integrate_options o = {
        .method = "rk8pd", .control = "standard", .tol = 1e-14, .hinit = 1e-6};
    struct precision_result unused = {0};
    int status = run_one(c, drop_contact, &o, 0, &other, &exact, &unused);
    o.method = "dopri5";
    if (status == GSL_SUCCESS)
      status = run_one(c, drop_contact, &o, 0, &exact, &other, &unused);
    if (status != GSL_SUCCESS)
      return status;
    reference_error[0] = fabs(exact.gap - other.gap);
    reference_error[1] = fabs(exact.velocity - other.velocity);
  }
  return hand_over(exact, out);
}

/* Half a period, or a quarter of each spring's, and flight at v0 or e v0. */
static int prepare_springs(const struct precision_case *c, double e,
                           void **out) {
  const double a = pace(c);
  const double contact = M_PI_2 / a * (1 + e);
  const double overlap = c->speed / a * (1 - e * e);
  const double flight = (half + M_PI_2) / a - contact;
  return hand_over((struct course){.gap = e * c->speed * flight - overlap,
                                   .velocity = e * c->speed},
                   out);
}

static int prepare_spring(const struct precision_case *c, void **out,
                          double reference_error[]) {
  (void)reference_error;
  return prepare_springs(c, 1, out);
}

static int prepare_walton_braun(const struct precision_case *c, void **out,
                                double reference_error[]) {
  (void)reference_error;
  return prepare_springs(c, c->law.restitution, out);
}

static int run_exponential(const struct precision_case *c,
                           const void *reference, struct precision_result *r) {
  return run(c, drop_contact, reference, r);
}

static int run_spring(const struct precision_case *c, const void *reference,
                      struct precision_result *r) {
  return run(c, spring, reference, r);
}

static int run_walton_braun(const struct precision_case *c,
                            const void *reference, struct precision_result *r) {
  return run(c, walton_braun, reference, r);
}

static void defaults(struct precision_case *c) {
  c->gravity = 0;
  c->speed = 1;
}

static void elastic_defaults(struct precision_case *c) {
  defaults(c);
  c->law.restitution = 1;
}

const struct precision_scene scene_exponential = {
    .name = "exponential",
    .summary = "a collision by the paper's exponential repulsion",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = elastic_defaults,
    .prepare = prepare_exponential,
    .run = run_exponential};

const struct precision_scene scene_spring = {
    .name = "spring",
    .summary = "the same by a linear spring, e = 1",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = elastic_defaults,
    .prepare = prepare_spring,
    .run = run_spring};

const struct precision_scene scene_walton_braun = {
    .name = "walton-braun",
    .summary = "the same by Walton and Braun's two springs, e = 0.4",
    .errors = {"error_gap", "error_velocity", NULL},
    .defaults = defaults,
    .prepare = prepare_walton_braun,
    .run = run_walton_braun};
