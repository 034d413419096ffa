/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "geometry/periodic.h"
#include "program/files.h"
#include "program/litter.h"
#include "program/integration.h"
#include "program/origin.h"
#include "program/progress.h"
#include "model/rest.h"
#include "platform/system.h"
#include "dynamics/motion.h"
#include "watch.h"

struct run {
  const struct settings *set;
  const struct setup *setup;
  const struct bed_header *header;
  struct bed *bed;
  struct motion *motion;
  struct watch *watch;
  double *y;    /* interpolated state */
  double start; /* time */
  struct rest_watch rest;
  size_t frames; /* written */
  struct output_file output, log, stats, checkpoint;
  /* at the last checkpoint */
  struct output_mark output_mark, log_mark, stats_mark;
  double last_checkpoint; /* on the wall's clock (s) */
  FILE *out;              /* for frames */
  char kernel[80];        /* and the machine */
  bool failed;
  char mark[160]; /* of the bed, at its end */
};

/* Has the frames so far on the disk, whatever becomes of the rest. */
static void flush_frames(struct run *r) {
  if (fflush(r->out) == 0 && !ferror(r->out))
    return;
  const char *checkpoint = r->output_mark.partial ? r->set->checkpoint : NULL;
  if (r->set->output)
    die(EXIT_IO, "%s: %s%s%s", r->set->output, strerror(errno),
        checkpoint ? "; settle goes on with --resume " : "",
        checkpoint ? checkpoint : "");
  finish_output(); /* does not return */
}

static void write_frame(struct run *r, const double *y, double t) {
  static const struct bed_header none = {0};
  dynamics_unpack(r->motion->dynamics, y, r->bed);
  r->bed->t = t;
  for (size_t i = 0; i < r->bed->n; i++) /* the run itself goes on outside */
    periodic_wrap(r->set->scene.period, r->bed->x + 3 * i);
  if (r->frames)
    bed_write_gap(r->out);
  bed_write_frame(r->out, r->frames ? &none : r->header, r->bed,
                  dynamics_stride(r->motion->dynamics) == ROW_SPIN);
  r->frames++;
  assert(r->frames <= r->set->frames);
  flush_frames(r);
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
  fprintf(log, "\t%zu\t%zu\t", integrate_counts(r->motion->integrator).accepted,
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
    warn("not at rest at t=%g: seen for %.2g s, expected %g s", t, t - w->start,
         w->settling);
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

/* --- checkpoints -----------------------------------------------------------*/

static void store_run(void *run, struct store *s) {
  struct run *r = run;
  motion_store(r->motion, s);
  watch_store(r->watch, s);
  store_part(s, "run");
  store_double(s, &r->start);
  store_size(s, &r->frames);
  store_plain(s, &r->rest, sizeof r->rest);
  store_flag(s, &r->failed);
  store_bytes(s, r->mark, sizeof r->mark);
}

/* Where the files are comes first: they are opened before the rest. */
static void store_marks(struct run *r, struct store *s) {
  output_mark_store(&r->output_mark, s);
  if (r->set->log)
    output_mark_store(&r->log_mark, s);
  if (r->set->stats)
    output_mark_store(&r->stats_mark, s);
}

static void store_all(void *run, struct store *s) {
  store_marks(run, s);
  store_run(run, s);
}

/* Writes the state as it is; false with errno. */
static bool write_checkpoint(struct run *r) {
  const struct settings *s = r->set;
  const bool done =
      output_mark(&r->output, &r->output_mark) &&
      (!s->log || output_mark(&r->log, &r->log_mark)) &&
      (!s->stats || output_mark(&r->stats, &r->stats_mark)) &&
      checkpoint_write(&r->checkpoint, integrate_time(r->motion->integrator),
                       r->kernel, r->setup, store_all, r);
  r->last_checkpoint = run_clock_now().wall;
  if (done) { /* it needs them */
    output_keep(&r->output);
    output_keep(&r->log);
    output_keep(&r->stats);
  }
  return done;
}

/* The first one fails before hours are spent; with a later one the last is
   still there. */
static void begin_checkpoints(struct run *r) {
  if (!output_is_regular(&r->output) ||
      (r->set->log && !output_is_regular(&r->log)) ||
      (r->set->stats && !output_is_regular(&r->stats)))
    die(EXIT_USAGE,
        "--checkpoint: expected files for --output, --log and --stats");
  output_reserve(&r->checkpoint, r->set->checkpoint);
  if (!write_checkpoint(r))
    die(EXIT_IO, "%s: %s", r->set->checkpoint, strerror(errno));
}

static void renew_checkpoint(struct run *r) {
  if (!write_checkpoint(r))
    warn("t=%.6g: %s: %s; the one before is still there",
         integrate_time(r->motion->integrator), r->set->checkpoint,
         strerror(errno));
}

static bool checkpoint_is_due(const struct run *r) {
  return r->set->checkpoint &&
         run_clock_now().wall - r->last_checkpoint >= r->set->every;
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
    if (goes_on && !rests && integrate_time(r->motion->integrator) < s->time &&
        checkpoint_is_due(r))
      renew_checkpoint(r);
  }
  if (s->checkpoint && goes_on && !rests && litter_asked())
    renew_checkpoint(r);
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
    if (s->checkpoint)
      warn("%s: the bed is marked so; --resume %s goes on", r->mark,
           s->checkpoint);
    else
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

/* Files are opened before hours are spent. */
static void open_files(struct run *r, struct checkpoint *from) {
  const struct settings *s = r->set;
  r->out = stdout;
  if (from->stream) {
    store_marks(r, &from->store);
    output_open_at(&r->output, s->output, &r->output_mark);
    if (s->log)
      output_open_at(&r->log, s->log, &r->log_mark);
    if (s->stats)
      output_open_at(&r->stats, s->stats, &r->stats_mark);
  } else {
    if (s->output)
      output_open(&r->output, s->output);
    if (s->log)
      output_open(&r->log, s->log);
    if (s->stats)
      output_open(&r->stats, s->stats);
  }
  if (s->output)
    r->out = r->output.stream;
}

static void commit_files(struct run *r, int code) {
  const struct settings *s = r->set;
  bed_write_status(r->out, r->mark);
  if (s->output)
    output_commit(&r->output);
  else
    finish_output();
  if (s->log)
    output_commit(&r->log);
  if (s->stats) {
    const double t_end = integrate_time(r->motion->integrator);
    watch_stats(r->watch, r->stats.stream, GSL_MIN(t_end, s->time), code);
    output_commit(&r->stats);
  }
  output_mark_free(&r->output_mark);
  output_mark_free(&r->log_mark);
  output_mark_free(&r->stats_mark);
}

/* The motion and its watch, as they begin or as the checkpoint has them. */
static void start_motion(struct run *r, struct checkpoint *from) {
  const struct settings *s = r->set;
  const struct run_clock begun = run_clock_now();
  r->rest = rest_watch_begin(r->bed->t, &s->similarity);
  int status =
      motion_alloc(&r->motion, &s->scene, r->bed, &s->integrate,
                   &(struct dynamics_options){.all_pairs = s->all_pairs,
                                              .threads = (int)s->threads,
                                              .order = r->setup->order,
                                              .kernel = s->kernel},
                   s->travel / s->scene.law.kappa);
  if (status == GSL_EUNSUP)
    die(EXIT_USAGE, "--kernel %s: this machine does not have it", s->kernel);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", s->integrate.method);
  snprintf(r->kernel, sizeof r->kernel, "%s on %s",
           dynamics_kernel(r->motion->dynamics), dynamics_machine());
  if (from->stream && strcmp(from->kernel, r->kernel))
    die(EXIT_INPUT,
        "%s: was made with the kernel %s, this is %s: expected the same, for "
        "the same bits",
        s->resume, from->kernel, r->kernel);
  r->y = malloc(dynamics_dimension(r->motion->dynamics) * sizeof *r->y);
  if (!r->y)
    die(EXIT_IO, "out of memory");
  status = watch_alloc(&r->watch, s, r->bed, r->motion, begun);
  if (status == GSL_EFAILED)
    die(EXIT_INPUT, "the start's energy is not finite");
  if (status != GSL_SUCCESS)
    die_status(status, "start");
  if (from->stream) {
    store_run(r, &from->store);
    checkpoint_close(from, s->resume);
  }
}

/* The same options give the same bits where these are the same. The command
   line is in the statistics: beds by any number of threads are equal. */
static void note_origin(const struct run *r, struct bed_header *h) {
  char build[SYSTEM_BUILD_SIZE];
  system_build(build);
  if (bed_header_set(h, "build", build) != GSL_SUCCESS ||
      bed_header_set(h, "kernel", r->kernel) != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
}

/* With --origin the log begins as the bed, with version, parameters, build and
   kernel. As the bed, it has no command line: it is the same if a run goes
   on. */
static void begin_log(struct run *r) {
  FILE *log = r->log.stream;
  const size_t keys = r->set->origin ? r->header->count : 0;
  for (size_t k = 0; k < keys; k++) {
    const struct bed_key *key = &r->header->at[k];
    if (strcmp(key->name, "format") && strcmp(key->name, "t"))
      origin_put(log, &origin_comment, key->name, key->value);
  }
  fputs("t\th\tsteps\tevaluations\tkinetic\tpotential\n", log);
}

int run(struct setup *setup, struct checkpoint *from) {
  const struct settings *s = setup->set;
  struct run r = {.set = s,
                  .setup = setup,
                  .header = setup->header,
                  .bed = setup->bed,
                  .start = setup->bed->t,
                  .mark = "ok"};
  progress_listen();
  open_files(&r, from);
  start_motion(&r, from);
  note_origin(&r, setup->header);
  if (s->log && !s->resume)
    begin_log(&r);
  if (!setup->order) {
    const size_t bytes = setup->bed->n * sizeof *setup->order;
    setup->order = malloc(bytes);
    if (!setup->order)
      die(EXIT_IO, "out of memory");
    memcpy(setup->order, dynamics_order(r.motion->dynamics), bytes);
  }
  if (s->checkpoint)
    begin_checkpoints(&r);
  litter_defer(); /* a signal ends the run after its step */
  const int code = integrate_all(&r);
  commit_files(&r, code);
  watch_free(r.watch);
  motion_free(r.motion);
  free(r.y);
  return code;
}
