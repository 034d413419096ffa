/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of multirate.c: how long they are, which spheres take theirs again
   in shorter ones, and which thread does what. Not in the paper. Internal to
   multirate.c. Tested in tests/test_multirate.c and
   tests/test_lanes.c. */
#ifndef LANES_H
#define LANES_H

#include "dynamics/level.h"
#include "dynamics/trace.h"

enum { LANES_LEVELS = 3 };

/* Changes by the rows of an island in the rates of their partners: a row of the
   level above each, its change and the velocity that it missed since somebody
   came and went within the step, as long as a row each, and the largest error
   that its partners in the island had in the first try, 1: the tolerance. */
struct changes {
  size_t count, size;
  uint32_t *row;
  double *value, *missed, *error;
};

/* The outcome of an island, valid for as long as no other row joins it. */
struct result {
  size_t lane;
  size_t changes, changes_end, trace, trace_end;
  int status;
  bool narrow; /* has to be taken again with all contacts */
};

/* Results of a level's islands, by their first rows. */
struct results {
  struct result *of;
  bool *first;  /* rows that there is a result of */
  bool *solved; /* rows of islands with results */
  size_t size;
};

/* Workspace of one thread. Level 0 is the same for all. */
struct lane {
  struct lanes *all;
  size_t number;
  struct level_setting setting;
  struct level *level[LANES_LEVELS];
  struct results results[LANES_LEVELS];
  struct changes changes;
  struct trace *trace;
};

struct lanes {
  size_t count;
  struct lane *lane;
};

/* For the spheres of d, a lane for each of its threads. GSL_SUCCESS,
   GSL_ENOMEM. */
int lanes_alloc(struct lanes **out, struct dynamics *d, double tol,
                double travel);
void lanes_free(struct lanes *all);

/* The level of all spheres. */
static inline struct level *lanes_bed(const struct lanes *all) {
  return all->lane[0].level[0];
}

/* The step of all spheres, at most `most` long, that makes the work least. */
double lanes_choose(const struct lanes *all, double most);

/* One accepted step of all spheres from t, of at most *h, and how long it was.
   GSL_SUCCESS; GSL_FAILURE if none is short enough; GSL_ENOMEM. */
int lanes_step(struct lanes *all, double t, double *h);

/* The longest step after one of h, and the shortest in place of one that has to
   be taken again. */
double lanes_longest(double h);
double lanes_shortest(double h);

/* Their memory between steps (platform/store.h), for any number of threads. */
void lanes_store(struct lanes *all, struct store *s);

#endif
