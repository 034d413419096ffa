/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/run_watch.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <time.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rstat.h>
#include "files/numbers.h"
#include "platform/system.h"
#include "program/messages.h"
#include "program/progress.h"

/* Energy that may be gained without a source, as a share of the energy in
   motion and contacts. */
static const double energy_share = 0.01;

/* A fixed step beyond the limit for more than this share of the time makes
   another bed: measured with verlet, six seeds, the union moves by 0.0004 at a
   share of 0.26 (2.5e-5 s), 0.0015 at 0.94 (5e-5 s), 0.003 at 7e-5 s. */
static const double beyond_share = 0.5;

struct pace { /* of methods with a limit of stability */
  bool limited;
  struct stiffness_limits limits;
  gsl_rstat_quantile_workspace *product, *ratio; /* medians */
  struct stiffness_mode mode;
  double limit; /* of h * radius for this mode */
  size_t steps; /* at the limit */
  double limited_time, beyond_time;
};

struct energy { /* that cannot grow */
  size_t seen;
  double first, last, lowest;
  double bottom; /* gravity's, lowest so far */
  double scale;  /* in motion and contacts and above the bottom, most */
  double share;  /* without a source now, of that now */
  double gain;   /* largest (J) */
  bool told;
};

struct run_watch {
  struct run_watch_options set;
  struct progress progress;
  double start, time; /* of the last step */
  size_t steps, warnings;
  double radius, radius_largest; /* spectral (1/s) */
  size_t stages;                 /* of all steps, rkc */
  struct pace pace;
  struct energy energy;
};

static double seconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int pace_begin(struct pace *p, const char *method) {
  const int status = integrate_limits(method, &p->limits);
  if (status == GSL_EINVAL) /* the method adapts to stiffness */
    return GSL_SUCCESS;
  if (status != GSL_SUCCESS)
    return status;
  p->limited = true;
  p->limit = stiffness_limit_at(&p->limits, M_PI);
  p->product = gsl_rstat_quantile_alloc(0.5);
  p->ratio = gsl_rstat_quantile_alloc(0.5);
  return p->product && p->ratio ? GSL_SUCCESS : GSL_ENOMEM;
}

struct run_clock run_clock_now(void) {
  return (struct run_clock){seconds(CLOCK_MONOTONIC),
                            seconds(CLOCK_PROCESS_CPUTIME_ID)};
}

int run_watch_alloc(struct run_watch **out, const struct run_watch_options *o) {
  struct run_watch *w = calloc(1, sizeof *w);
  if (!w)
    return GSL_ENOMEM;
  w->set = *o;
  w->progress = progress_begin(o->quiet);
  w->start = w->time = integrate_time(o->integrator);
  const int status = pace_begin(&w->pace, o->integrate->method);
  if (status == GSL_SUCCESS)
    *out = w;
  else
    run_watch_free(w);
  return status;
}

void run_watch_free(struct run_watch *w) {
  if (!w)
    return;
  if (w->pace.product)
    gsl_rstat_quantile_free(w->pace.product);
  if (w->pace.ratio)
    gsl_rstat_quantile_free(w->pace.ratio);
  free(w);
}

void run_watch_say(struct run_watch *w, const char *format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  warn("%s", text);
  w->warnings++;
}

/* --- stability -------------------------------------------------------------*/

bool run_watch_wants_mode(const struct run_watch *w) {
  return w->pace.limited;
}

void run_watch_mode(struct run_watch *w, struct stiffness_mode mode) {
  w->pace.mode = mode;
  w->pace.limit = stiffness_limit_at(&w->pace.limits, mode.angle);
  w->radius = mode.radius;
}

static void pace_step(struct pace *p, double h) {
  const double product = h * p->mode.radius, ratio = product / p->limit;
  gsl_rstat_quantile_add(product, p->product);
  gsl_rstat_quantile_add(ratio, p->ratio);
  if (stiffness_at_limit(product, p->limit)) {
    p->steps++;
    p->limited_time += h;
  }
  if (ratio > 1)
    p->beyond_time += h;
}

void run_watch_step(struct run_watch *w) {
  const struct rkc_report r = integrate_rkc_report(w->set.integrator);
  assert(integrate_time(w->set.integrator) > w->time);
  w->steps++;
  w->time = integrate_time(w->set.integrator);
  w->stages += r.stages;
  if (w->pace.limited)
    pace_step(&w->pace, integrate_last_step(w->set.integrator));
  else
    w->radius = r.spectral_radius;
  w->radius_largest = GSL_MAX(w->radius_largest, w->radius);
}

void run_watch_end(struct run_watch *w, bool failed) {
  progress_end(&w->progress);
  if (failed)
    return;
  const struct pace *p = &w->pace;
  const double span = w->time - w->start, step = w->set.integrate->step;
  if (!p->limited)
    return;
  if (step > 0 && p->beyond_time > beyond_share * span) {
    const double product = gsl_rstat_quantile_get(p->product);
    run_watch_say(
        w,
        "for %.0f %% of the time --step %g was beyond what %s allows (h times "
        "spectral radius: median %.2g, limit %.2g): %s is another one, "
        "which it does not show; --step %.1g or --method rkc "
        "(docs/stability.md, \"Wrong beds\")",
        100 * p->beyond_time / span, step, w->set.stiff, product, p->limit,
        w->set.result, 0.7 * step * p->limit / product);
  } else if (!(step > 0) && stiffness_sets_pace(p->steps, w->steps))
    run_watch_say(
        w,
        "stability, not the tolerance, set %.0f %% of the steps, since %s is "
        "stiff: --method rkc takes fewer evaluations (docs/stability.md, "
        "\"Stability limits\")",
        100 * (double)p->steps / (double)w->steps, w->set.stiff);
}

/* --- energy ----------------------------------------------------------------*/

void run_watch_tell_energy(struct run_watch *w) {
  struct energy *e = &w->energy;
  /* at first there is nearly nothing in motion */
  const double least = GSL_SQRT_DBL_EPSILON * fabs(e->first);
  const double loss = (e->first - e->last) / GSL_MAX(e->scale, least);
  if (e->told || !e->seen)
    return;
  if (e->share > energy_share) {
    e->told = true;
    run_watch_say(
        w,
        "t=%.6g: %.3g J were gained without a source, %.3g %% of %s energy: "
        "a smaller --tol or --step is needed (docs/stability.md, \"Energy\")",
        w->time, e->last - e->lowest, 100 * e->share, w->set.whose);
  } else if (w->set.nobody && loss > energy_share) {
    e->told = true;
    run_watch_say(w,
                  "t=%.6g: %.3g J are lost, %.3g %% of %s energy, where none "
                  "can be lost (%s): a smaller --tol or --step is "
                  "needed (docs/stability.md, \"Energy\")",
                  w->time, e->first - e->last, 100 * loss, w->set.whose,
                  w->set.nobody);
  }
}

int run_watch_energy(struct run_watch *w, double gravity, double inner,
                     double rounding) {
  struct energy *e = &w->energy;
  const double now = gravity + inner;
  if (!isfinite(now))
    return GSL_ERANGE;
  e->last = now;
  if (e->seen++ == 0) {
    e->first = e->lowest = now;
    e->bottom = gravity;
  }
  e->bottom = GSL_MIN(e->bottom, gravity);
  const double scale = now - e->bottom;
  e->scale = GSL_MAX(e->scale, scale);
  e->lowest = GSL_MIN(e->lowest, now);
  const double gain = now - e->lowest;
  e->gain = GSL_MAX(e->gain, gain);
  e->share = gain > rounding ? gain / scale : 0;
  return GSL_SUCCESS;
}

double run_watch_energy_share(const struct run_watch *w) {
  return w->energy.share;
}

/* --- progress --------------------------------------------------------------*/

void run_watch_progress(struct run_watch *w, double end, size_t evaluations) {
  const double done = (w->time - w->start) / (end - w->start);
  if (progress_asked())
    warn("t=%.6g s, %.1f %%  h=%.2e s  %zu evaluations  %.0f s so far", w->time,
         100 * done, integrate_last_step(w->set.integrator), evaluations,
         run_clock_now().wall - w->set.begun.wall);
  if (!progress_due(&w->progress))
    return;
  progress_name(&w->progress, "t=%.3f s  h=%.2e s  %zu evaluations", w->time,
                integrate_last_step(w->set.integrator), evaluations);
  progress_tell(&w->progress, done);
}

/* --- statistics ------------------------------------------------------------*/

void run_watch_solver_stats(const struct run_watch *w, FILE *out,
                            size_t unknowns, size_t evaluations, double t_end) {
  const struct integrate_options *o = w->set.integrate;
  const struct integrate_counts steps = integrate_counts(w->set.integrator);
  fprintf(out, "method\t%s\n", o->method);
  fprintf(out, "control\t%s\n", o->step > 0 ? "none" : o->control);
  fprintf(out, "unknowns\t%zu\n", unknowns);
  fprintf(out, "rhs_evaluations\t%zu\n", evaluations);
  fprintf(out, "steps_accepted\t%zu\n", steps.accepted);
  fprintf(out, "steps_rejected\t%zu\n", steps.rejected);
  const struct run_clock now = run_clock_now();
  fprintf(out, "cpu_seconds\t%.6f\n", now.cpu - w->set.begun.cpu);
  fprintf(out, "wall_seconds\t%.6f\n", now.wall - w->set.begun.wall);
  fputs("t_end\t", out);
  numbers_write(out, '\t', 1, &t_end);
  fputc('\n', out);
  const long memory = system_peak_memory();
  if (memory >= 0)
    fprintf(out, "peak_memory_kb\t%ld\n", memory);
}

void run_watch_stats(const struct run_watch *w, FILE *out, int exit_status) {
  const struct rkc_report r = integrate_rkc_report(w->set.integrator);
  const double steps = GSL_MAX((double)w->steps, 1), span = w->time - w->start;
  const struct pace *p = &w->pace;
  if (p->limited) {
    fprintf(out, "stiffness_ratio\t%.3g\n", gsl_rstat_quantile_get(p->ratio));
    fprintf(out, "h_rho_median\t%.3g\n", gsl_rstat_quantile_get(p->product));
    fprintf(out, "h_rho_limit\t%.4g\n", p->limit);
    fprintf(out, "steps_at_limit\t%.4f\n", (double)p->steps / steps);
    fprintf(out, "time_at_limit\t%.4f\n",
            span > 0 ? p->limited_time / span : 0);
    fprintf(out, "time_beyond_limit\t%.4f\n",
            span > 0 ? p->beyond_time / span : 0);
  }
  if (r.stages) {
    fprintf(out, "stages_mean\t%.2f\n", (double)w->stages / steps);
    fprintf(out, "stages_most\t%zu\n", r.most_stages);
    fprintf(out, "power_evaluations\t%zu\n", r.power_evaluations);
  }
  if (p->limited || r.stages) {
    fprintf(out, "spectral_radius\t%.4g\n", w->radius);
    fprintf(out, "spectral_radius_largest\t%.4g\n", w->radius_largest);
  }
  fprintf(out, "energy_start\t%.9g\n", w->energy.first);
  fprintf(out, "energy_end\t%.9g\n", w->energy.last);
  fprintf(out, "energy_gain\t%.3g\n", w->energy.gain);
  fprintf(out, "warnings\t%zu\n", w->warnings);
  fprintf(out, "exit_status\t%d\n", exit_status);
}

/* --- from one run to the next ----------------------------------------------*/

static void store_median(gsl_rstat_quantile_workspace *m, struct store *s) {
  store_doubles(s, m->q, 5);
  store_doubles(s, m->np, 5);
  store_bytes(s, m->npos, sizeof m->npos);
  store_size(s, &m->n);
}

static void store_pace(struct pace *p, struct store *s) {
  store_part(s, "pace");
  store_median(p->product, s);
  store_median(p->ratio, s);
  store_double(s, &p->mode.radius);
  store_double(s, &p->mode.angle);
  store_double(s, &p->limit);
  store_size(s, &p->steps);
  store_double(s, &p->limited_time);
  store_double(s, &p->beyond_time);
}

static void store_clock(struct run_clock *begun, struct store *s) {
  const struct run_clock now = run_clock_now();
  double wall = now.wall - begun->wall, cpu = now.cpu - begun->cpu;
  store_double(s, &wall);
  store_double(s, &cpu);
  if (s->loads)
    *begun = (struct run_clock){now.wall - wall, now.cpu - cpu};
}

void run_watch_store(struct run_watch *w, struct store *s) {
  store_part(s, "run watch");
  store_clock(&w->set.begun, s);
  store_double(s, &w->start);
  store_double(s, &w->time);
  store_size(s, &w->steps);
  store_size(s, &w->warnings);
  store_double(s, &w->radius);
  store_double(s, &w->radius_largest);
  store_size(s, &w->stages);
  if (w->pace.limited)
    store_pace(&w->pace, s);
  store_plain(s, &w->energy, sizeof w->energy);
}
