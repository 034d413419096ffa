/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The watch over every run, whatever moves in it, with the same words in all
   programs: a step at its stability limit, energy without a source, numbers
   that are none; and the statistics of the solver. Not in the paper. It looks
   at accepted steps and changes no bit of the trajectory. README.md lists the
   warnings and the keys of the statistics. Tested in tests/test_watch.sh. */
#ifndef RUN_WATCH_H
#define RUN_WATCH_H

#include <stdbool.h>
#include <stdio.h>
#include "steppers/integrate.h"

struct run_watch;

/* The clocks of the statistics: on the wall, and of this process (s). */
struct run_clock {
  double wall, cpu;
};
struct run_clock run_clock_now(void);

struct run_watch_options {
  struct run_clock begun;
  const struct integrate_options *integrate;
  const struct integrator *integrator;
  const char *stiff;  /* what makes the problem stiff: "friction" */
  const char *whose;  /* the energy: "the spheres'" */
  const char *result; /* of the run: "the bed" */
  const char *nobody; /* why no energy can be lost: "e = 1"; NULL if it can */
  bool quiet;         /* no line of progress */
};

/* Keeps the pointers of the options. GSL_SUCCESS, GSL_ENOMEM. */
int run_watch_alloc(struct run_watch **out, const struct run_watch_options *o);
void run_watch_free(struct run_watch *w);

/* Whether the method has a limit of stability. Then the watch is to be told the
   fastest mode of the problem before the first step and as it changes. */
bool run_watch_wants_mode(const struct run_watch *w);
void run_watch_mode(struct run_watch *w, struct stiffness_mode mode);

/* After every accepted step. */
void run_watch_step(struct run_watch *w);

/* The energy that the motion has left (J), which never grows: that of gravity,
   and the kinetic energy with that of contacts. rounding: error of the sum. The
   first call is for the start. GSL_SUCCESS, GSL_ERANGE where it is not
   finite. */
int run_watch_energy(struct run_watch *w, double gravity, double inner,
                     double rounding);
/* Warns, once, if energy was gained without a source, or lost where none can
   be. */
void run_watch_tell_energy(struct run_watch *w);
/* The share of the energy that has no source, as of the last call. */
double run_watch_energy_share(const struct run_watch *w);

/* Its memory (platform/store.h), and the time that the run has taken. */
void run_watch_store(struct run_watch *w, struct store *s);

/* A warning, counted. */
void run_watch_say(struct run_watch *w, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The end: no more progress; and the warnings that are possible only now, about
   a run that did not fail. */
void run_watch_end(struct run_watch *w, bool failed);

/* For --stats: the solver's keys, then those of the watch, then the program's
   exit status. evaluations: of the right-hand side, but for the watch's own. */
void run_watch_solver_stats(const struct run_watch *w, FILE *out,
                            size_t unknowns, size_t evaluations, double t_end);
void run_watch_stats(const struct run_watch *w, FILE *out, int exit_status);

/* The line of progress on a terminal, now and then: the share done, by time,
   and what is left. */
void run_watch_progress(struct run_watch *w, double end, size_t evaluations);

#endif
