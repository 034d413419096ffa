/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "watch.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_statistics.h>
#include "model/bed_check.h"
#include "model/softness.h"
#include "program/origin.h"
#include "program/run_watch.h"
#include "steppers/stiffness.h"

/* Overlap that calls for a warning, in radii. */
static const double deep_overlap = 0.5;

/* Soft walls let a centre pass and push it back, as long as there is energy for
   that. If a larger share than this came from nowhere, the energy was false. */
static const double gross_share = 0.1;

/* An error of the union by softness and creep that a fine tolerance can go
   with: of the size of the error by the default tolerance. */
static const double largest_balanced = 0.003;

/* Power iterations, ITERATIONS every SAMPLE_EVERY evaluations, and a survey of
   the contacts every SURVEY_EVERY: below 1 % of the run each. */
enum { ITERATIONS = 4, SAMPLE_EVERY = 600, SURVEY_EVERY = 300 };

struct stiff { /* of methods with a limit of stability */
  struct stiffness *follow;
  gsl_odeiv2_system system;
  double *rate;
  size_t next_sample, evaluations;
};

struct watch {
  const struct settings *set;
  const struct bed *bed;
  struct motion *motion;
  struct run_watch *run;
  struct stiff stiff;
  double start;  /* time (s) */
  double weight; /* of what contacts store, in what cannot grow */

  double *places; /* of the last survey, 3n */
  double margin;  /* how far spheres may go before the next (m) */
  size_t next_survey, surveys;
  double smallest; /* radius (m) */
  struct survey survey;
  double deepest;
  size_t deep_steps;
  bool told_overlap;
};

static double now(const struct watch *w) {
  return integrate_time(w->motion->integrator);
}

static int find(struct watch_finding *f, const char *page, const char *format,
                ...) __attribute__((format(printf, 3, 4)));
static int find(struct watch_finding *f, const char *page, const char *format,
                ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(f->what, sizeof f->what, format, arguments);
  va_end(arguments);
  f->page = page;
  return GSL_EFAILED;
}

/* --- the cut at lmax -------------------------------------------------------*/

static bool paper_control(const struct watch *w) {
  const struct integrate_options *o = &w->set->integrate;
  return !(o->step > 0) && integrate_control(o->control)->per_time;
}

/* The speed that a contact stops at touch (m/s). */
static double touch_speed(const struct contact_law *c, double mass) {
  return sqrt(2 * c->f0 / (c->kappa * mass));
}

/* The force begins at lmax with a jump J = F(lmax), and what is beyond it is
   lost: for a sphere that approaches at v the impulse J/(kappa v). At the touch
   speed that is an error of sqrt(F0/(2 kappa m)) exp(-kappa lmax) in its
   velocity (m/s). The paper's control bounds 3E/h, which a jump between
   Merson's third stage and fourth makes 0.7 J/m (m/s^2), however short h. */
static double cut_error(const struct watch *w) {
  const struct contact_law *c = &w->set->scene.law;
  const double mass = gsl_stats_min(w->bed->m, 1, w->bed->n);
  const double jump = contact_repulsion(c, c->lmax) / mass;
  return paper_control(w) ? 0.7 * jump
                          : jump / (c->kappa * touch_speed(c, mass));
}

static void check_cut(struct watch *w) {
  const struct integrate_options *o = &w->set->integrate;
  const struct contact_law *c = &w->set->scene.law;
  if (o->step > 0)
    return;
  const bool paper = paper_control(w);
  const double mass = gsl_stats_min(w->bed->m, 1, w->bed->n);
  const double tol = paper ? o->tol
                           : (o->abstol > 0 ? o->abstol : o->tol) +
                                 o->reltol * touch_speed(c, mass);
  const double error = cut_error(w);
  if (!(error > tol))
    return;
  run_watch_say(
      w->run,
      "the cut at --lmax %g leaves errors of %.2g %s, more than the tolerance "
      "%.2g; --lmax %g would do (docs/stability.md, \"The cut at lmax\")",
      c->lmax, error, paper ? "m/s^2" : "m/s", tol,
      ceil(100 * (c->lmax + log(error / tol) / c->kappa)) / 100);
}

/* --- softness and creep ----------------------------------------------------*/

/* Spheres that make a bed, and how much finer than by default a tolerance is of
   somebody who asks for the last digit. */
enum { BED_LEAST = 50, FINE = 10 };

/* Excess of the union of the bed, as docs/softness.md has it. */
static double softness_of(const struct watch *w) {
  return softness_error(w->set->scene.law.kappa * bed_mean(w->bed, w->bed->r));
}

static double creep_of(const struct watch *w, double time) {
  const double creep = softness_creep(w->set->scene.law.vmin, time);
  return scene_has_friction(&w->set->scene)
             ? softness_creep_error(creep / bed_mean(w->bed, w->bed->r))
             : 0;
}

/* A finer tolerance than the default takes time and betters nothing that can be
   seen, as long as contacts are as soft, and creep as far, as by default. The
   default itself is balanced, so it goes without a word. */
static void check_balance(struct watch *w) {
  const struct integrate_options *o = &w->set->integrate;
  struct integrate_options usual = {.method = o->method, .control = o->control};
  integrate_defaults(&usual);
  usual.tol *= w->set->similarity.length /
               (paper_control(w) ? w->set->similarity.squared_time
                                 : w->set->similarity.time);
  const double soft = softness_of(w);
  const double creep = creep_of(w, w->set->time - w->bed->t);
  if (o->step > 0 || w->bed->n < BED_LEAST || o->tol * FINE > usual.tol ||
      vec3_norm(w->set->scene.gravity) == 0 || soft + creep < largest_balanced)
    return;
  run_watch_say(w->run,
                "--tol %g is finer than softness and creep allow to see: they "
                "make the union larger by some %.2g (kappa r = %.3g) and %.2g; "
                "--overlap and --creep better that (docs/softness.md)",
                o->tol, soft,
                w->set->scene.law.kappa * bed_mean(w->bed, w->bed->r), creep);
}

/* --- stiffness -------------------------------------------------------------*/

static int start_stiff(struct watch *w) {
  struct stiff *s = &w->stiff;
  if (!run_watch_wants_mode(w->run))
    return GSL_SUCCESS;
  const size_t dim = dynamics_dimension(w->motion->dynamics);
  s->system = (gsl_odeiv2_system){.function = dynamics_rhs,
                                  .dimension = dim,
                                  .params = w->motion->dynamics};
  s->rate = malloc(dim * sizeof *s->rate);
  return s->rate ? stiffness_alloc(&s->follow, dim) : GSL_ENOMEM;
}

size_t watch_evaluations(const struct watch *w) {
  return dynamics_counts(w->motion->dynamics).evaluations -
         w->stiff.evaluations;
}

/* A failure leaves the estimate as it was: the run itself will meet it. */
static int sample_stiffness(struct watch *w, struct watch_finding *found) {
  struct stiff *s = &w->stiff;
  const double *y = integrate_state(w->motion->integrator);
  const double *f = integrate_derivative(w->motion->integrator);
  const size_t before = dynamics_counts(w->motion->dynamics).evaluations;
  int status = GSL_SUCCESS;
  if (integrate_method(w->set->integrate.method)->half) {
    status = GSL_ODEIV_FN_EVAL(&s->system, now(w), y, s->rate);
    f = s->rate;
  }
  struct stiffness_mode mode;
  if (status == GSL_SUCCESS)
    status = stiffness_estimate(s->follow, &s->system, now(w), y, f, ITERATIONS,
                                &mode);
  s->evaluations += dynamics_counts(w->motion->dynamics).evaluations - before;
  if (status != GSL_SUCCESS)
    return GSL_SUCCESS;
  if (!isfinite(mode.radius) || !isfinite(mode.angle))
    return find(found, "Missed collisions", "the stiffness is not finite");
  run_watch_mode(w->run, mode);
  return GSL_SUCCESS;
}

static int step_stiff(struct watch *w, struct watch_finding *f) {
  struct stiff *s = &w->stiff;
  if (!s->follow || watch_evaluations(w) < s->next_sample)
    return GSL_SUCCESS;
  const int status = sample_stiffness(w, f);
  s->next_sample = watch_evaluations(w) + SAMPLE_EVERY;
  return status;
}

/* --- contacts and energy ---------------------------------------------------*/

/* Energy that is left: kinetic energy, gravity's and rho(0) F/kappa of
   contacts. It never grows: a contact's force on the approach is more than
   rho(0) F and when the spheres part less, and friction takes. Without friction
   and at e = 1 it is constant. Forces end at lmax, so their energy begins
   there. */
static int measure_energy(struct watch *w, struct watch_finding *f) {
  const struct contact_law *c = &w->set->scene.law;
  const struct survey *v = &w->survey;
  const double inner =
      w->weight *
          (v->stored - (double)v->contacts * contact_energy(c, c->lmax)) +
      dynamics_kinetic(w->motion->dynamics,
                       integrate_state(w->motion->integrator));
  const double rounding =
      (double)w->bed->n * GSL_DBL_EPSILON * fabs(v->gravity);
  if (run_watch_energy(w->run, v->gravity, inner, rounding) == GSL_SUCCESS)
    return GSL_SUCCESS;
  return find(f, "Energy", "the energy is not finite");
}

static double furthest_moved(const struct watch *w, const double *y) {
  const size_t stride = dynamics_stride(w->motion->dynamics);
  double most = 0;
  for (size_t i = 0; i < w->bed->n; i++) {
    const double *x = y + i * stride, *x0 = w->places + 3 * i;
    const double dx = x[0] - x0[0], dy = x[1] - x0[1], dz = x[2] - x0[2];
    const double moved = dx * dx + dy * dy + dz * dz;
    most = moved > most ? moved : most;
  }
  return sqrt(most);
}

/* Until a sphere has gone further than margin, no overlap can have become deep
   that was not, nor the other way round, and no centre can have crossed a
   wall. */
static int survey(struct watch *w, const double *y, struct watch_finding *f) {
  const size_t stride = dynamics_stride(w->motion->dynamics);
  struct survey *v = &w->survey;
  const int status = dynamics_survey(w->motion->dynamics, y, v);
  if (status == GSL_ENOMEM)
    return status;
  if (status != GSL_SUCCESS || !isfinite(v->overlap))
    return find(f, "Missed collisions", "places of spheres are not finite");
  for (size_t i = 0; i < w->bed->n; i++)
    memcpy(w->places + 3 * i, y + i * stride, 3 * sizeof *y);
  w->margin = GSL_MIN(0.5 * w->smallest * fabs(v->overlap - deep_overlap),
                      fabs(v->inside));
  w->deepest = GSL_MAX(w->deepest, v->overlap);
  w->surveys++;
  w->next_survey = watch_evaluations(w) + SURVEY_EVERY;
  return measure_energy(w, f);
}

static void tell_overlap(struct watch *w) {
  const struct survey *v = &w->survey;
  if (w->told_overlap || !(v->overlap > deep_overlap))
    return;
  w->told_overlap = true;
  run_watch_say(
      w->run,
      "t=%.6g: sphere %ld overlaps by %.2f radii, more than %g: too soft for "
      "its load, or steps too long (docs/stability.md, \"Penetration\")",
      now(w), w->bed->id[v->sphere], v->overlap, deep_overlap);
}

static int step_contacts(struct watch *w, struct watch_finding *f) {
  const double *y = integrate_state(w->motion->integrator);
  int status = GSL_SUCCESS;
  if (watch_evaluations(w) >= w->next_survey ||
      !(furthest_moved(w, y) <= w->margin))
    status = survey(w, y, f);
  const struct survey *v = &w->survey;
  if (status == GSL_SUCCESS && v->inside < 0 &&
      run_watch_energy_share(w->run) > gross_share)
    status =
        find(f, "Missed collisions", "sphere %ld is %.3g m outside wall %zu",
             w->bed->id[v->outsider], -v->inside, v->wall + 1);
  if (status != GSL_SUCCESS)
    return status;
  w->deep_steps += v->overlap > deep_overlap;
  tell_overlap(w);
  run_watch_tell_energy(w->run);
  return GSL_SUCCESS;
}

int watch_frame(const struct watch *w, const struct bed *b, bool last,
                struct watch_finding *f) {
  const struct bed_outsiders out = bed_find_outsiders(&w->set->scene, b);
  if (out.count)
    return find(f, "Penetration",
                "%zu of %zu centres are outside of walls, that of sphere %ld "
                "%.3g m outside wall %zu",
                out.count, b->n, b->id[out.sphere], -out.distance,
                out.wall + 1);
  if (!last)
    return GSL_SUCCESS;
  struct bed_crowd crowd;
  const int status = bed_find_crowd(w->set->scene.period, b, &crowd);
  if (status == GSL_ENOMEM)
    return status;
  if (status != GSL_SUCCESS)
    return find(f, "Missed collisions", "places of spheres are not finite");
  if (crowd.pairs)
    return find(f, "Penetration",
                "centres of spheres %ld and %ld are %.3g m apart, expected at "
                "least %.3g m",
                b->id[crowd.i], b->id[crowd.j], crowd.distance, crowd.expected);
  return GSL_SUCCESS;
}

/* --- the whole -------------------------------------------------------------*/

int watch_alloc(struct watch **out, const struct settings *s,
                const struct bed *b, struct motion *m, struct run_clock begun) {
  struct watch *w = calloc(1, sizeof *w);
  if (!w)
    return GSL_ENOMEM;
  w->set = s;
  w->bed = b;
  w->start = b->t;
  w->motion = m;
  w->smallest = gsl_stats_min(b->r, 1, b->n);
  const double e = s->scene.law.restitution;
  const bool friction = scene_has_friction(&s->scene);
  w->weight = 0.5 * (1 + e * e);
  w->places = malloc(3 * b->n * sizeof *w->places);
  int status = w->places ? GSL_SUCCESS : GSL_ENOMEM;
  if (status == GSL_SUCCESS)
    status = run_watch_alloc(
        &w->run,
        &(struct run_watch_options){
            .begun = begun,
            .quiet = s->quiet,
            .integrate = &s->integrate,
            .integrator = m->integrator,
            .stiff = friction ? "friction" : "the contacts' damping",
            .whose = "the spheres'",
            .result = "the bed",
            .nobody = e == 1 && !friction ? "e = 1, no friction" : NULL});
  if (status == GSL_SUCCESS)
    status = start_stiff(w);
  struct watch_finding f;
  if (status == GSL_SUCCESS) {
    if (!s->resume) { /* else it was said */
      check_cut(w);
      check_balance(w);
    }
    status = survey(w, integrate_state(m->integrator), &f);
  }
  if (status != GSL_SUCCESS) {
    watch_free(w);
    return status;
  }
  if (!s->resume)
    tell_overlap(w);
  *out = w;
  return GSL_SUCCESS;
}

void watch_free(struct watch *w) {
  if (!w)
    return;
  run_watch_free(w->run);
  stiffness_free(w->stiff.follow);
  free(w->stiff.rate);
  free(w->places);
  free(w);
}

int watch_step(struct watch *w, struct watch_finding *f) {
  int status = step_stiff(w, f);
  run_watch_step(w->run);
  if (status == GSL_SUCCESS)
    status = step_contacts(w, f);
  return status;
}

void watch_fail(struct watch *w, double t, const struct watch_finding *f) {
  run_watch_say(w->run,
                "t=%.6g: %s; the bed is marked as failed (docs/stability.md, "
                "\"%s\")",
                t, f->what, f->page);
}

void watch_progress(struct watch *w) {
  run_watch_progress(w->run, w->set->time, watch_evaluations(w));
}

void watch_end(struct watch *w, bool failed) {
  run_watch_end(w->run, failed);
}

static void write_levels(const struct multirate *m, FILE *out) {
  const struct multirate_report r = multirate_report(m);
  for (int k = 0; k < MULTIRATE_LEVELS; k++) {
    fprintf(out, "level%d_steps\t%zu\n", k, r.steps[k]);
    fprintf(out, "level%d_rejected\t%zu\n", k, r.rejected[k]);
    fprintf(out, "level%d_evaluations\t%zu\n", k, r.evaluations[k]);
    fprintf(out, "level%d_contacts\t%zu\n", k, r.contacts[k]);
    fprintf(out, "level%d_spheres\t%.4g\n", k, r.rows[k]);
  }
  fprintf(out, "partners_joined\t%zu\n", r.again);
}

void watch_stats(const struct watch *w, FILE *out, double t_end,
                 int exit_status) {
  const struct dynamics *d = w->motion->dynamics;
  const struct dynamics_counts counts = dynamics_counts(d);
  run_watch_solver_stats(w->run, out, dynamics_dimension(d),
                         watch_evaluations(w), t_end);
  fprintf(out, "spheres\t%zu\n", w->bed->n);
  fprintf(out, "threads\t%zu\n", w->set->threads);
  fprintf(out, "kernel\t%s\n", dynamics_kernel(d));
  origin_write(out, &origin_statistic, w->set->command, NULL);
  fprintf(out, "pair_list_builds\t%zu\n", counts.builds);
  fprintf(out, "contacts_listed\t%zu\n", counts.contacts);
  fprintf(out, "contact_evaluations\t%.0f\n", counts.contacts_evaluated);
  if (motion_multirate(w->motion))
    write_levels(motion_multirate(w->motion), out);
  if (w->stiff.follow)
    fprintf(out, "watch_evaluations\t%zu\n", w->stiff.evaluations);
  fprintf(out, "overlap_deepest\t%.4g\n", w->deepest);
  fprintf(out, "steps_with_deep_overlap\t%zu\n", w->deep_steps);
  fprintf(out, "cut_error\t%.3g\n", cut_error(w));
  fprintf(out, "softness_error\t%.2g\n", softness_of(w));
  fprintf(out, "creep_error\t%.2g\n", creep_of(w, t_end - w->start));
  fprintf(out, "surveys\t%zu\n", w->surveys);
  run_watch_stats(w->run, out, exit_status);
}

void watch_store(struct watch *w, struct store *s) {
  store_part(s, "watch");
  if (w->stiff.follow)
    stiffness_store(w->stiff.follow, s);
  store_size(s, &w->stiff.next_sample);
  store_size(s, &w->stiff.evaluations);
  store_double(s, &w->start);
  store_doubles(s, w->places, 3 * w->bed->n);
  store_double(s, &w->margin);
  store_size(s, &w->next_survey);
  store_size(s, &w->surveys);
  store_plain(s, &w->survey, sizeof w->survey);
  store_double(s, &w->deepest);
  store_size(s, &w->deep_steps);
  store_flag(s, &w->told_overlap);
  run_watch_store(w->run, s);
}
