/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/files.h"
#include "program/integration.h"
#include "model/rest.h"
#include "platform/system.h"
#include "dynamics/motion.h"
#include "watch.h"

struct run {
  const struct settings *set;
  const struct bed_header *header;
  struct bed *bed;
  struct motion *motion;
  struct watch *watch;
  double *y;    /* interpolated state */
  double start; /* time */
  struct rest_watch rest;
  size_t frames; /* written */
  FILE *log;
  double wall_start, cpu_start, shown;
  bool show;
};

static double seconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void write_frame(struct run *r, const double *y, double t) {
  static const struct bed_header none = {0};
  dynamics_unpack(r->motion->dynamics, y, r->bed);
  r->bed->t = t;
  if (r->frames)
    bed_write_gap(stdout);
  bed_write_frame(stdout, r->frames ? &none : r->header, r->bed,
                  dynamics_stride(r->motion->dynamics) == ROW_SPIN);
  r->frames++;
  if (ferror(stdout))
    finish_output(); /* does not return */
}

static double frame_time(const struct run *r, size_t k) {
  const struct settings *s = r->set;
  if (k == s->frames - 1) /* exactly, whatever the rounding below */
    return s->time;
  return r->start + (s->time - r->start) * (double)k / (double)(s->frames - 1);
}

/* Every frame that is due by now. */
static void write_due_frames(struct run *r) {
  const double t = integrate_time(r->motion->integrator);
  while (r->frames < r->set->frames && frame_time(r, r->frames) <= t) {
    const double at = frame_time(r, r->frames);
    if (integrate_at(r->motion->integrator, at, r->y) == GSL_SUCCESS)
      write_frame(r, r->y, at);
    else
      die(EXIT_IO, "internal error: frame at t=%g outside the last step", at);
  }
}

/* Of the method, without the watch's own. */
static size_t evaluations(const struct run *r) {
  return dynamics_counts(r->motion->dynamics).evaluations -
         watch_evaluations(r->watch);
}

static void write_log(struct run *r) {
  const double *y = integrate_state(r->motion->integrator);
  fprintf(r->log, "%.17g\t%.17g\t%zu\t%zu\t%.17g\t%.17g\n",
          integrate_time(r->motion->integrator),
          integrate_last_step(r->motion->integrator),
          integrate_counts(r->motion->integrator).accepted, evaluations(r),
          dynamics_kinetic(r->motion->dynamics, y),
          dynamics_potential(r->motion->dynamics, y));
}

static void show_progress(struct run *r) {
  const double elapsed = seconds(CLOCK_MONOTONIC) - r->wall_start;
  if (!r->show || elapsed < r->shown + 0.5)
    return;
  r->shown = elapsed;
  const double t = integrate_time(r->motion->integrator);
  const double done = (t - r->start) / (r->set->time - r->start);
  fprintf(stderr,
          "\rsettle: %3.0f %%  t=%.3f s  h=%.2e s  %zu evaluations  %.0f s "
          "left \033[K",
          100 * done, t, integrate_last_step(r->motion->integrator),
          evaluations(r), elapsed * (1 - done) / GSL_MAX(done, 1e-9));
}

static bool at_rest(struct run *r) {
  const struct motion *m = r->motion;
  return rest_watch_see(
      &r->rest, integrate_time(m->integrator),
      dynamics_fastest(m->dynamics, integrate_state(m->integrator)),
      r->set->scene.law.vmin);
}

static void write_stats(const struct run *r, FILE *out, double t_end,
                        int status) {
  const struct settings *s = r->set;
  const struct integrate_counts steps = integrate_counts(r->motion->integrator);
  const struct dynamics_counts counts = dynamics_counts(r->motion->dynamics);
  fprintf(out, "method\t%s\n", s->integrate.method);
  fprintf(out, "control\t%s\n",
          s->integrate.step > 0 ? "none" : s->integrate.control);
  fprintf(out, "spheres\t%zu\n", r->bed->n);
  fprintf(out, "unknowns\t%zu\n", dynamics_dimension(r->motion->dynamics));
  fprintf(out, "rhs_evaluations\t%zu\n", evaluations(r));
  fprintf(out, "steps_accepted\t%zu\n", steps.accepted);
  fprintf(out, "steps_rejected\t%zu\n", steps.rejected);
  fprintf(out, "cpu_seconds\t%.6f\n",
          seconds(CLOCK_PROCESS_CPUTIME_ID) - r->cpu_start);
  fprintf(out, "wall_seconds\t%.6f\n",
          seconds(CLOCK_MONOTONIC) - r->wall_start);
  fprintf(out, "threads\t%zu\n", s->threads);
  fprintf(out, "kernel\t%s\n", dynamics_kernel(r->motion->dynamics));
  fprintf(out, "t_end\t%.17g\n", t_end);
  fprintf(out, "pair_list_builds\t%zu\n", counts.builds);
  fprintf(out, "contacts_listed\t%zu\n", counts.contacts);
  const long memory = system_peak_memory();
  if (memory >= 0)
    fprintf(out, "peak_memory_kb\t%ld\n", memory);
  watch_stats(r->watch, out);
  fprintf(out, "exit_status\t%d\n", status);
}

/* page: of docs/stability.md */
static int failed(double t, const char *what, const char *page, char *reason,
                  size_t size) {
  snprintf(reason, size, "failed at t=%.6g: %s", t, what);
  warn("t=%.6g: %s; the bed is marked as failed (docs/stability.md, \"%s\")", t,
       what, page);
  return EXIT_INTEGRATION;
}

/* Steps until the end, rest or failure; the exit status and, in reason, what
   the bed is marked with. */
static int integrate_all(struct run *r, char *reason, size_t size) {
  const struct settings *s = r->set;
  snprintf(reason, size, "ok");
  write_due_frames(r);
  while (integrate_time(r->motion->integrator) < s->time) {
    const int status = integrate_step(r->motion->integrator);
    const double t = integrate_time(r->motion->integrator);
    if (status != GSL_SUCCESS)
      return failed(t, integration_error(&s->integrate, status),
                    "Missed collisions", reason, size);
    if (r->log)
      write_log(r);
    char found[80];
    if (!watch_step(r->watch, found, sizeof found))
      return failed(t, found, "Missed collisions", reason, size);
    write_due_frames(r);
    show_progress(r);
    if (s->until_rest && at_rest(r))
      return EXIT_DONE;
  }
  if (!s->until_rest)
    return EXIT_DONE;
  snprintf(reason, size, "limit: not at rest at t=%g", s->time);
  warn("not at rest at t=%g: surfaces still move at %.3g m/s, expected below "
       "vmin = %g m/s",
       s->time,
       dynamics_fastest(r->motion->dynamics,
                        integrate_state(r->motion->integrator)),
       s->scene.law.vmin);
  return EXIT_LIMIT;
}

int run(const struct settings *s, struct bed *b,
        const struct bed_header *header) {
  struct run r = {.set = s, .header = header, .bed = b, .start = b->t};
  r.rest = rest_watch_begin(b->t);
  r.wall_start = seconds(CLOCK_MONOTONIC);
  r.cpu_start = seconds(CLOCK_PROCESS_CPUTIME_ID);
  r.show = !s->quiet && isatty(STDERR_FILENO);
  const int status = motion_alloc(
      &r.motion, &s->scene, b, &s->integrate,
      &(struct dynamics_options){.all_pairs = !strcmp(s->pairs, "all"),
                                 .threads = (int)s->threads},
      s->travel / s->scene.law.kappa);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", s->integrate.method);
  r.y = malloc(dynamics_dimension(r.motion->dynamics) * sizeof *r.y);
  if (!r.y)
    die(EXIT_IO, "out of memory");
  struct output_file log, stats; /* opened before hours are spent */
  if (s->stats)
    output_open(&stats, s->stats);
  if (s->log) {
    output_open(&log, s->log);
    r.log = log.stream;
    fputs("t\th\tsteps\tevaluations\tkinetic\tpotential\n", r.log);
  }

  r.watch = watch_start(s, b, r.motion);
  if (!r.watch)
    die(EXIT_IO, "out of memory");
  char reason[160];
  const int code = integrate_all(&r, reason, sizeof reason);
  if (r.show)
    fputs("\r\033[K", stderr);
  if (code != EXIT_INTEGRATION)
    watch_end(r.watch);
  const double t_end = GSL_MIN(integrate_time(r.motion->integrator), s->time);
  /* ended before the last frame: the state reached is one more */
  if (r.frames < s->frames) {
    if (integrate_at(r.motion->integrator, t_end, r.y) != GSL_SUCCESS)
      die(EXIT_IO, "internal error: no state at t=%g", t_end);
    write_frame(&r, r.y, t_end);
  }
  bed_write_status(stdout, reason);
  finish_output();
  if (s->log)
    output_commit(&log);
  if (s->stats) {
    write_stats(&r, stats.stream, t_end, code);
    output_commit(&stats);
  }
  watch_free(r.watch);
  motion_free(r.motion);
  free(r.y);
  return code;
}
