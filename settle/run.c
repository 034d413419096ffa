/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "program/files.h"
#include "program/litter.h"
#include "program/integration.h"
#include "model/rest.h"
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
  struct output_file log;
  bool failed;
  char mark[160]; /* of the bed, at its end */
};

static void write_frame(struct run *r, const double *y, double t) {
  static const struct bed_header none = {0};
  dynamics_unpack(r->motion->dynamics, y, r->bed);
  r->bed->t = t;
  if (r->frames)
    bed_write_gap(stdout);
  bed_write_frame(stdout, r->frames ? &none : r->header, r->bed,
                  dynamics_stride(r->motion->dynamics) == ROW_SPIN);
  r->frames++;
  assert(r->frames <= r->set->frames);
  /* what is done is not lost with what is still to be done */
  if (fflush(stdout) != 0 || ferror(stdout))
    finish_output(); /* does not return */
}

static double frame_time(const struct run *r, size_t k) {
  const struct settings *s = r->set;
  if (k == s->frames - 1) /* exactly, whatever the rounding below */
    return s->time;
  return r->start + (s->time - r->start) * (double)k / (double)(s->frames - 1);
}

/* Says what was found at t and marks the bed with it. */
static void fail(struct run *r, double t, const struct watch_finding *f) {
  snprintf(r->mark, sizeof r->mark, "failed at t=%.6g: %s", t, f->what);
  watch_fail(r->watch, t, f);
  r->failed = true;
}

/* The state at a time within the last step as a frame, checked. A fault of one
   frame does not end the run: later ones may be of interest. */
static void write_state(struct run *r, double t, bool last) {
  struct watch_finding f;
  if (integrate_at(r->motion->integrator, t, r->y) != GSL_SUCCESS)
    die(EXIT_IO, "internal error: no state at t=%g", t);
  write_frame(r, r->y, t);
  const int status = watch_frame(r->watch, r->bed, last, &f);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (status != GSL_SUCCESS && !r->failed)
    fail(r, t, &f);
}

/* Every frame that is due by now. */
static void write_due_frames(struct run *r) {
  const double t = integrate_time(r->motion->integrator);
  while (r->frames < r->set->frames && frame_time(r, r->frames) <= t)
    write_state(r, frame_time(r, r->frames), r->frames + 1 == r->set->frames);
}

static void write_log(struct run *r) {
  const double *y = integrate_state(r->motion->integrator);
  const double step[] = {integrate_time(r->motion->integrator),
                         integrate_last_step(r->motion->integrator)};
  const double energy[] = {dynamics_kinetic(r->motion->dynamics, y),
                           dynamics_potential(r->motion->dynamics, y)};
  FILE *log = r->log.stream;
  numbers_write(log, '\t', 2, step);
  fprintf(log, "\t%zu\t%zu\t",
          integrate_counts(r->motion->integrator).accepted,
          watch_evaluations(r->watch));
  numbers_write(log, '\t', 2, energy);
  fputc('\n', log);
  /* at once, although the bed is worth more and the run goes on */
  if (!r->log.error && output_failed(&r->log))
    warn("%s: %s; the run goes on without a log", r->set->log,
         strerror(r->log.error));
}

/* Whether the bed rests: looked at after every step, its energy now and then.
   The survey may rebuild the list of pairs, as a step does. */
static bool at_rest(struct run *r) {
  const struct motion *m = r->motion;
  const double t = integrate_time(m->integrator);
  const double *y = integrate_state(m->integrator);
  struct survey v;
  if (rest_watch_see(&r->rest, t,
                     dynamics_kinetic(m->dynamics, y) / (double)r->bed->n) &&
      dynamics_survey(m->dynamics, y, &v) == GSL_SUCCESS)
    rest_watch_sample(&r->rest, t, v.gravity + v.stored, v.height);
  return rest_watch_rests(&r->rest, t);
}

/* Why the bed is not at rest at the end t. */
static void say_not_at_rest(const struct run *r, double t) {
  const struct rest_watch *w = &r->rest;
  if (t - w->since < w->quiet)
    warn("not at rest at t=%g: until t=%.4g spheres moved with more than %.2g "
         "J on average, expected less for %g s",
         t, GSL_MIN(w->since, t), w->kinetic_limit, w->quiet);
  else if (t - w->start < w->settling)
    warn("not at rest at t=%g: seen for %.2g s, expected %g s", t,
         t - w->start, w->settling);
  else
    warn("not at rest at t=%g: in %g s the bed lost %.2g %% of the energy of "
         "its height, expected below %g %%",
         t, w->settling, 100 * w->loss, 100 * rest_watch_limit());
}

/* One step and what follows from it. False if the run cannot go on. */
static bool step(struct run *r) {
  struct watch_finding f = {.page = "Missed collisions"};
  int status = integrate_step(r->motion->integrator);
  if (status == GSL_SUCCESS) {
    if (r->set->log)
      write_log(r);
    status = watch_step(r->watch, &f);
  } else
    snprintf(f.what, sizeof f.what, "%s",
             integration_error(&r->set->integrate, status));
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (status != GSL_SUCCESS) {
    fail(r, integrate_time(r->motion->integrator), &f);
    return false;
  }
  write_due_frames(r);
  watch_progress(r->watch);
  return true;
}

/* Steps until the end, rest or failure; the exit status. */
static int integrate_all(struct run *r) {
  const struct settings *s = r->set;
  bool goes_on = true, rests = false;
  write_due_frames(r);
  while (goes_on && !rests && !litter_asked() &&
         integrate_time(r->motion->integrator) < s->time) {
    goes_on = step(r);
    rests = goes_on && s->until_rest && at_rest(r);
  }
  /* ended before the last frame: the state reached is one more */
  if (r->frames < s->frames)
    write_state(r, GSL_MIN(integrate_time(r->motion->integrator), s->time),
                true);
  watch_end(r->watch, !goes_on);
  if (r->failed)
    return EXIT_INTEGRATION;
  const double t = integrate_time(r->motion->integrator);
  if (litter_asked() && !rests && t < s->time) {
    snprintf(r->mark, sizeof r->mark, "interrupted at t=%.6g", t);
    warn("%s: the bed is marked so; --allow-partial --scene goes on from it",
         r->mark);
    return EXIT_LIMIT;
  }
  if (rests || !s->until_rest)
    return EXIT_DONE;
  snprintf(r->mark, sizeof r->mark, "limit: not at rest at t=%g", s->time);
  say_not_at_rest(r, s->time);
  return EXIT_LIMIT;
}

int run(const struct settings *s, struct bed *b,
        const struct bed_header *header) {
  struct run r = {
      .set = s, .header = header, .bed = b, .start = b->t, .mark = "ok"};
  const struct run_clock begun = run_clock_now();
  r.rest = rest_watch_begin(b->t, &s->similarity);
  int status =
      motion_alloc(&r.motion, &s->scene, b, &s->integrate,
                   &(struct dynamics_options){.all_pairs = s->all_pairs,
                                              .threads = (int)s->threads},
                   s->travel / s->scene.law.kappa);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", s->integrate.method);
  r.y = malloc(dynamics_dimension(r.motion->dynamics) * sizeof *r.y);
  if (!r.y)
    die(EXIT_IO, "out of memory");
  struct output_file stats; /* opened before hours are spent */
  if (s->stats)
    output_open(&stats, s->stats);
  if (s->log) {
    output_open(&r.log, s->log);
    fputs("t\th\tsteps\tevaluations\tkinetic\tpotential\n", r.log.stream);
  }
  status = watch_alloc(&r.watch, s, b, r.motion, begun);
  if (status == GSL_EFAILED)
    die(EXIT_INPUT, "the start's energy is not finite");
  if (status != GSL_SUCCESS)
    die_status(status, "start");
  litter_defer(); /* a signal ends the run after its step */
  const int code = integrate_all(&r);
  bed_write_status(stdout, r.mark);
  finish_output();
  if (s->log)
    output_commit(&r.log);
  if (s->stats) {
    const double t_end = integrate_time(r.motion->integrator);
    watch_stats(r.watch, stats.stream, GSL_MIN(t_end, s->time), code);
    output_commit(&stats);
  }
  watch_free(r.watch);
  motion_free(r.motion);
  free(r.y);
  return code;
}
