/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The watch over a run of settle, so that a bed that went wrong does not pass
   for a good one: beside the watch over every run (program/run_watch.h),
   spheres that go too deep into each other or through a wall, and a tolerance
   that the cut at lmax does not allow. Not in the paper. It reads the state of
   accepted steps and changes no bit of the trajectory. README.md lists the
   warnings and the keys of the statistics. Tested in tests/test_watch.sh. */
#ifndef WATCH_H
#define WATCH_H

#include <stdio.h>
#include "dynamics/motion.h"
#include "model/bed.h"
#include "program/run_watch.h"
#include "settings.h"

struct watch;

/* The reason why a bed is a failed one, in words, and the title of a section of
   docs/stability.md. */
struct watch_finding {
  char what[120];
  const char *page;
};

/* Looks at the settings and the start; keeps the pointers. GSL_SUCCESS,
   GSL_EFAILED for a start without a finite energy, GSL_ENOMEM. */
int watch_alloc(struct watch **out, const struct settings *s,
                const struct bed *b, struct motion *m, struct run_clock begun);
void watch_free(struct watch *w);

/* After every accepted step. GSL_EFAILED if a sphere was pushed through a wall,
   or a number that is computed from the state is none; f then says which.
   GSL_ENOMEM. */
int watch_step(struct watch *w, struct watch_finding *f);

/* A frame as it was written, the last one or another. GSL_EFAILED if a centre
   is outside of a wall or, in the last one, two spheres are nearly in one
   place; f then says which. GSL_ENOMEM. */
int watch_frame(const struct watch *w, const struct bed *b, bool last,
                struct watch_finding *f);

/* Says what was found at t. */
void watch_fail(struct watch *w, double t, const struct watch_finding *f);

/* Evaluations of the right-hand side that were the run's own, without those of
   the watch. */
size_t watch_evaluations(const struct watch *w);

/* Its memory (platform/store.h), but for that of the motion. */
void watch_store(struct watch *w, struct store *s);

/* The line of progress, after a step. */
void watch_progress(struct watch *w);

/* The end: the warnings that are possible only now, about a run that did not
   fail, and the keys of --stats. */
void watch_end(struct watch *w, bool failed);
void watch_stats(const struct watch *w, FILE *out, double t_end,
                 int exit_status);

#endif
