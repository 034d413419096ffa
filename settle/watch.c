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
#include <gsl/gsl_rstat.h>
#include <gsl/gsl_statistics.h>
#include "steppers/stiffness.h"

/* Overlap that calls for a warning, in radii. */
static const double deep_overlap = 0.5;

/* Energy that may come from nowhere, as a share of what the spheres have in
   motion and contacts. */
static const double energy_share = 0.01;

/* Soft walls let a centre pass and push it back, as long as there is energy for
   that; with so large a share from nowhere there was none. */
static const double gross_share = 0.1;

/* A fixed step beyond the limit for more than this share of the time makes
   another bed: measured with verlet, six seeds, the union moves by 0.0004 at a
   share of 0.26 (2.5e-5 s), 0.0015 at 0.94 (5e-5 s), 0.003 at 7e-5 s. */
static const double beyond_share = 0.5;

/* So many power iterations, and a survey of the contacts, every so many
   evaluations: below 1 % of the run each. */
enum { ITERATIONS = 4, SAMPLE_EVERY = 600, SURVEY_EVERY = 300 };

struct stiff { /* of explicit methods */
  struct stiffness *follow;
  gsl_odeiv2_system system;
  double *rate;
  struct stiffness_limits limits;
  gsl_rstat_quantile_workspace *product, *ratio; /* medians */
  struct stiffness_mode mode;
  double limit; /* of h * radius for this mode */
  size_t next_sample, evaluations;
  size_t limited_steps;
  double limited_time, beyond_time;
};

struct energy { /* that cannot grow */
  bool conserved;
  double weight; /* of what contacts store */
  double first, last, lowest;
  double bottom; /* gravity's, lowest so far */
  double scale;  /* in motion and contacts and above the bottom, most */
  double share;  /* from nowhere now, of that now */
  double gain;   /* largest (J) */
  bool told;
};

struct watch {
  const struct settings *set;
  const struct bed *bed;
  struct motion *motion;
  bool terminal; /* with a line of progress, cleared before a warning */
  size_t warnings;
  double start, time; /* of the last step */
  size_t steps;
  struct stiff stiff;
  double radius, radius_largest; /* spectral (1/s) */
  size_t stages;                 /* of all steps, rkc */

  double *places; /* of the last survey, 3n */
  double margin;  /* how far spheres may go before the next (m) */
  size_t next_survey, surveys;
  double smallest; /* radius (m) */
  struct survey survey;
  double deepest;
  size_t deep_steps;
  bool told_overlap;
  struct energy energy;
};

static void say(struct watch *w, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void say(struct watch *w, const char *format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (w->terminal)
    fputs("\r\033[K", stderr);
  warn("%s", text);
  w->warnings++;
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
  say(w,
      "the cut at --lmax %g leaves errors of %.2g %s, more than the tolerance "
      "%.2g; --lmax %g would do (docs/stability.md, \"The cut at lmax\")",
      c->lmax, error, paper ? "m/s^2" : "m/s", tol,
      ceil(100 * (c->lmax + log(error / tol) / c->kappa)) / 100);
}

/* --- stiffness -------------------------------------------------------------*/

static bool start_stiff(struct watch *w) {
  struct stiff *s = &w->stiff;
  const int status = integrate_limits(w->set->integrate.method, &s->limits);
  if (status != GSL_SUCCESS)
    return status == GSL_EINVAL; /* the method adapts to it */
  const size_t dim = dynamics_dimension(w->motion->dynamics);
  s->system = (gsl_odeiv2_system){.function = dynamics_rhs,
                                  .dimension = dim,
                                  .params = w->motion->dynamics};
  s->rate = malloc(dim * sizeof *s->rate);
  s->product = gsl_rstat_quantile_alloc(0.5);
  s->ratio = gsl_rstat_quantile_alloc(0.5);
  s->limit = stiffness_limit_at(&s->limits, M_PI);
  return s->rate && s->product && s->ratio &&
         stiffness_alloc(&s->follow, dim) == GSL_SUCCESS;
}

static size_t own_evaluations(const struct watch *w) {
  return dynamics_counts(w->motion->dynamics).evaluations -
         w->stiff.evaluations;
}

/* A failure leaves the estimate as it was: the run itself will meet it. */
static void sample_stiffness(struct watch *w) {
  struct stiff *s = &w->stiff;
  const double *y = integrate_state(w->motion->integrator);
  const double *f = integrate_derivative(w->motion->integrator);
  const double t = integrate_time(w->motion->integrator);
  const size_t before = dynamics_counts(w->motion->dynamics).evaluations;
  int status = GSL_SUCCESS;
  if (integrate_method(w->set->integrate.method)->half) {
    status = GSL_ODEIV_FN_EVAL(&s->system, t, y, s->rate);
    f = s->rate;
  }
  struct stiffness_mode mode;
  if (status == GSL_SUCCESS)
    status =
        stiffness_estimate(s->follow, &s->system, t, y, f, ITERATIONS, &mode);
  s->evaluations += dynamics_counts(w->motion->dynamics).evaluations - before;
  if (status != GSL_SUCCESS)
    return;
  s->mode = mode;
  s->limit = stiffness_limit_at(&s->limits, mode.angle);
  w->radius = mode.radius;
}

static void step_stiff(struct watch *w, double h) {
  struct stiff *s = &w->stiff;
  if (own_evaluations(w) >= s->next_sample) {
    sample_stiffness(w);
    s->next_sample = own_evaluations(w) + SAMPLE_EVERY;
  }
  const double product = h * s->mode.radius, ratio = product / s->limit;
  gsl_rstat_quantile_add(product, s->product);
  gsl_rstat_quantile_add(ratio, s->ratio);
  if (stiffness_at_limit(product, s->limit)) {
    s->limited_steps++;
    s->limited_time += h;
  }
  if (ratio > 1)
    s->beyond_time += h;
}

/* --- contacts and energy ---------------------------------------------------*/

/* What the motion has left: kinetic energy, gravity's and rho(0) F/kappa of
   contacts. It never grows: a contact's force on the approach is more than
   rho(0) F and when the spheres part less, and friction takes. Without friction
   and at e = 1 it is constant. Forces end at lmax, so their energy begins
   there. */
static void measure_energy(struct watch *w) {
  struct energy *e = &w->energy;
  const struct contact_law *c = &w->set->scene.law;
  const struct survey *v = &w->survey;
  const double inner =
      e->weight *
          (v->stored - (double)v->contacts * contact_energy(c, c->lmax)) +
      dynamics_kinetic(w->motion->dynamics,
                       integrate_state(w->motion->integrator));
  e->last = v->gravity + inner;
  if (w->surveys == 0) {
    e->first = e->lowest = e->last;
    e->bottom = v->gravity;
  }
  e->bottom = GSL_MIN(e->bottom, v->gravity);
  const double scale = e->last - e->bottom;
  e->scale = GSL_MAX(e->scale, scale);
  e->lowest = GSL_MIN(e->lowest, e->last);
  const double gain = e->last - e->lowest;
  e->gain = GSL_MAX(e->gain, gain);
  const double rounding =
      (double)w->bed->n * GSL_DBL_EPSILON * fabs(v->gravity);
  e->share = gain > rounding ? gain / scale : 0;
}

static void tell_energy(struct watch *w) {
  struct energy *e = &w->energy;
  const double loss = (e->first - e->last) / e->scale;
  if (e->told)
    return;
  if (e->share > energy_share) {
    e->told = true;
    say(w,
        "t=%.6g: %.3g J came from nowhere, %.3g %% of the spheres' energy: "
        "a smaller --tol or --step is needed (docs/stability.md, \"Energy\")",
        w->time, e->last - e->lowest, 100 * e->share);
  } else if (e->conserved && loss > energy_share) {
    e->told = true;
    say(w,
        "t=%.6g: %.3g J are lost, %.3g %% of the spheres' energy, where none "
        "can be (e = 1, no friction): a smaller --tol or --step is "
        "needed (docs/stability.md, \"Energy\")",
        w->time, e->first - e->last, 100 * loss);
  }
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
static void survey(struct watch *w, const double *y) {
  const size_t stride = dynamics_stride(w->motion->dynamics);
  struct survey *v = &w->survey;
  if (dynamics_survey(w->motion->dynamics, y, v) != GSL_SUCCESS)
    return;
  for (size_t i = 0; i < w->bed->n; i++)
    memcpy(w->places + 3 * i, y + i * stride, 3 * sizeof *y);
  w->margin = GSL_MIN(0.5 * w->smallest * fabs(v->overlap - deep_overlap),
                      fabs(v->inside));
  w->deepest = GSL_MAX(w->deepest, v->overlap);
  measure_energy(w);
  w->surveys++;
  w->next_survey = own_evaluations(w) + SURVEY_EVERY;
}

static void tell_overlap(struct watch *w) {
  const struct survey *v = &w->survey;
  if (w->told_overlap || !(v->overlap > deep_overlap))
    return;
  w->told_overlap = true;
  say(w,
      "t=%.6g: sphere %ld overlaps by %.2f radii, more than %g: too soft for "
      "its load, or steps too long (docs/stability.md, \"Penetration\")",
      w->time, w->bed->id[v->sphere], v->overlap, deep_overlap);
}

static bool step_contacts(struct watch *w, char *reason, size_t size) {
  const double *y = integrate_state(w->motion->integrator);
  if (own_evaluations(w) >= w->next_survey ||
      !(furthest_moved(w, y) <= w->margin))
    survey(w, y);
  const struct survey *v = &w->survey;
  if (v->inside < 0 && w->energy.share > gross_share) {
    snprintf(reason, size, "sphere %ld is %.3g m outside wall %zu",
             w->bed->id[v->outsider], -v->inside, v->wall + 1);
    return false;
  }
  w->deep_steps += v->overlap > deep_overlap;
  tell_overlap(w);
  tell_energy(w);
  return true;
}

static const char *stiff_part(const struct watch *w) {
  return scene_has_friction(&w->set->scene) ? "friction"
                                            : "the contacts' damping";
}

/* --- the whole -------------------------------------------------------------*/

struct watch *watch_start(const struct settings *s, const struct bed *b,
                          struct motion *m) {
  struct watch *w = calloc(1, sizeof *w);
  if (!w)
    return NULL;
  w->set = s;
  w->bed = b;
  w->motion = m;
  w->terminal = !s->quiet && isatty(STDERR_FILENO);
  w->start = w->time = b->t;
  w->places = malloc(3 * b->n * sizeof *w->places);
  w->smallest = gsl_stats_min(b->r, 1, b->n);
  const double e = s->scene.law.restitution;
  w->energy.weight = 0.5 * (1 + e * e);
  w->energy.conserved = e == 1 && !scene_has_friction(&s->scene);
  if (!w->places || !start_stiff(w)) {
    watch_free(w);
    return NULL;
  }
  check_cut(w);
  survey(w, integrate_state(m->integrator));
  tell_overlap(w);
  return w;
}

bool watch_step(struct watch *w, char *reason, size_t size) {
  const double h = integrate_last_step(w->motion->integrator);
  const struct rkc_report r = integrate_rkc_report(w->motion->integrator);
  w->steps++;
  w->time = integrate_time(w->motion->integrator);
  w->stages += r.stages;
  if (w->stiff.follow)
    step_stiff(w, h);
  else
    w->radius = r.spectral_radius;
  w->radius_largest = GSL_MAX(w->radius_largest, w->radius);
  return step_contacts(w, reason, size);
}

size_t watch_evaluations(const struct watch *w) {
  return w->stiff.evaluations;
}

void watch_end(struct watch *w) {
  const struct stiff *s = &w->stiff;
  const double span = w->time - w->start, step = w->set->integrate.step;
  if (!s->follow)
    return;
  if (step > 0 && s->beyond_time > beyond_share * span) {
    const double product = gsl_rstat_quantile_get(s->product);
    say(w,
        "for %.0f %% of the time --step %g was beyond what %s allows (h times "
        "spectral radius: median %.2g, limit %.2g): the bed is another, "
        "without looking so; --step %.1g or --method rkc (docs/stability.md, "
        "\"Wrong beds\")",
        100 * s->beyond_time / span, step, stiff_part(w), product, s->limit,
        0.7 * step * s->limit / product);
  } else if (!(step > 0) && stiffness_sets_pace(s->limited_steps, w->steps))
    say(w,
        "stability, not the tolerance, set %.0f %% of the steps, since %s is "
        "stiff: --method rkc takes fewer evaluations (docs/stability.md, "
        "\"Stability limits\")",
        100 * (double)s->limited_steps / (double)w->steps, stiff_part(w));
}

void watch_stats(const struct watch *w, FILE *out) {
  const struct rkc_report r = integrate_rkc_report(w->motion->integrator);
  const double steps = GSL_MAX((double)w->steps, 1), span = w->time - w->start;
  const struct stiff *s = &w->stiff;
  if (s->follow) {
    fprintf(out, "stiffness_ratio\t%.3g\n", gsl_rstat_quantile_get(s->ratio));
    fprintf(out, "h_rho_median\t%.3g\n", gsl_rstat_quantile_get(s->product));
    fprintf(out, "h_rho_limit\t%.4g\n", s->limit);
    fprintf(out, "steps_at_limit\t%.4f\n", (double)s->limited_steps / steps);
    fprintf(out, "time_at_limit\t%.4f\n",
            span > 0 ? s->limited_time / span : 0);
    fprintf(out, "time_beyond_limit\t%.4f\n",
            span > 0 ? s->beyond_time / span : 0);
    fprintf(out, "watch_evaluations\t%zu\n", s->evaluations);
  }
  if (r.stages) {
    fprintf(out, "stages_mean\t%.2f\n", (double)w->stages / steps);
    fprintf(out, "stages_most\t%zu\n", r.most_stages);
    fprintf(out, "power_evaluations\t%zu\n", r.power_evaluations);
  }
  if (s->follow || r.stages) {
    fprintf(out, "spectral_radius\t%.4g\n", w->radius);
    fprintf(out, "spectral_radius_largest\t%.4g\n", w->radius_largest);
  }
  fprintf(out, "overlap_deepest\t%.4g\n", w->deepest);
  fprintf(out, "steps_with_deep_overlap\t%zu\n", w->deep_steps);
  fprintf(out, "energy_start\t%.9g\n", w->energy.first);
  fprintf(out, "energy_end\t%.9g\n", w->energy.last);
  fprintf(out, "energy_gain\t%.3g\n", w->energy.gain);
  fprintf(out, "cut_error\t%.3g\n", cut_error(w));
  fprintf(out, "surveys\t%zu\n", w->surveys);
  fprintf(out, "warnings\t%zu\n", w->warnings);
}

void watch_free(struct watch *w) {
  if (!w)
    return;
  stiffness_free(w->stiff.follow);
  if (w->stiff.product)
    gsl_rstat_quantile_free(w->stiff.product);
  if (w->stiff.ratio)
    gsl_rstat_quantile_free(w->stiff.ratio);
  free(w->stiff.rate);
  free(w->places);
  free(w);
}
