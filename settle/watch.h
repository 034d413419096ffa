/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run looks at beside its results, so that a bed that went wrong does
   not pass for a good one: a step at its stability limit, spheres that go too
   deep into each other or through a wall, energy from nowhere, a tolerance that
   the cut at lmax does not allow. Not in the paper. It reads the state of
   accepted steps and changes no bit of the trajectory. README.md lists the
   warnings and the keys of the statistics. Tested in tests/test_watch.sh. */
#ifndef WATCH_H
#define WATCH_H

#include <stdio.h>
#include "model/bed.h"
#include "dynamics/motion.h"
#include "settings.h"

struct watch;

/* Looks at the settings and the start; keeps the pointers. NULL without
   memory. */
struct watch *watch_start(const struct settings *s, const struct bed *b,
                          struct motion *m);

/* After every accepted step. False if a sphere was pushed through a wall;
   reason then says which, in at most size bytes. */
bool watch_step(struct watch *w, char *reason, size_t size);

/* Evaluations of the right-hand side that were the watch's own. */
size_t watch_evaluations(const struct watch *w);

/* What can be said at the end only, of a run that did not fail, and what goes
   to --stats. */
void watch_end(struct watch *w);
void watch_stats(const struct watch *w, FILE *out);
void watch_free(struct watch *w);

#endif
