/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions that the scenes share: steps, events, counts, means over runs. */
#ifndef MEASURE_H
#define MEASURE_H

#include "dynamics/drop.h"
#include "dynamics/motion.h"
#include "scenes.h"

/* The word "ok" of these functions, to be compared by address. */
extern const char measure_ok[];

/* One accepted step. The word for precision_result.status: "ok", "gave_up"
   where the integrator fails, "too_long" after the given number of steps. */
const char *measure_step(struct integrator *it, size_t most);

/* Steps until t exactly; words as above. */
const char *measure_until(struct integrator *it, double t, size_t most);

/* Steps until an event and ends there by steps of the method itself, not by
   interpolation. ahead gives a lower bound of the time from a state with its
   derivative to the event, exact in the limit, at most 0 when it is reached
   and GSL_POSINF where nothing is known; the start is not asked. */
const char *measure_event(struct integrator *it,
                          double (*ahead)(const double y[], const double dydt[],
                                          void *params),
                          void *params, size_t most);

/* Chance decides where within a step a kink falls. Scenes with a kink take root
   mean squares over this number of runs, which start at different times and
   whose fixed steps differ, too, by up to a tenth. */
enum { MEASURE_STARTS = 8 };

/* The options of the k-th of these runs. */
struct integrate_options measure_variant(const struct integrate_options *o,
                                         size_t k);

/* Copies the counts of a run into r. */
void measure_counts(const struct motion *m, struct precision_result *r);

/* CPU time of this process (s). Between start and stop it is counted as the
   integration's. */
double measure_clock(void);
void measure_start(struct precision_result *r);
void measure_stop(struct precision_result *r);

/* Adds a run to r: its counts, and its errors squared. */
void measure_add(struct precision_result *r, const struct integrator *it,
                 size_t evaluations, const double error[], size_t errors);

/* Turns the sums over r->runs runs into means, root mean squares for errors. */
void measure_mean(struct precision_result *r);

#endif
