/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where spheres were within a step that they took in several: the ends of their
   own steps, for the state at any time in it. Not in the paper. Internal to
   multirate.c. Tested in tests/test_multirate.c. */
#ifndef TRACE_H
#define TRACE_H

#include "dynamics/level.h"

struct trace;

/* For the rows of a bed. GSL_SUCCESS, GSL_ENOMEM. */
int trace_alloc(struct trace **out, const struct contact_list *whole);
void trace_free(struct trace *r);

/* How much is in it, and cutting it back to that; to 0 for a new step of the
   bed. */
size_t trace_mark(const struct trace *r);
void trace_cut(struct trace *r, size_t mark);

/* Takes what was added between two marks out again. */
void trace_erase(struct trace *r, size_t from, size_t to);

/* Adds the rows of an accepted step of l that ends at time t in its y0, f0, but
   for those that were refined and so are in it already. GSL_SUCCESS,
   GSL_ENOMEM. */
int trace_append(struct trace *r, const struct level *l, double t);

/* Puts the rows that are in it to where they were at time t, given their state
   y0 and rates f0 at the start, t0. */
void trace_at(const struct trace *r, double t0, const double y0[],
              const double f0[], double t, double y[]);

/* Adds how many steps are in it to those of each row. */
void trace_steps(const struct trace *r, size_t steps[]);

#endif
