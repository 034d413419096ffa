/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres that step together: all of a bed, or those of it that need shorter
   steps, with their partners as ghosts that move as is known already. A step is
   one of Runge-Kutta-Chebyshev (steppers/chebyshev.h), with an error for each
   sphere. Not in the paper. Internal to multirate.c. Tested in
   tests/test_multirate.c and tests/test_lanes.c. */
#ifndef LEVEL_H
#define LEVEL_H

#include "dynamics/internal.h"
#include "dynamics/islands.h"
#include "steppers/chebyshev.h"
#include "steppers/power.h"

/* Shared by the levels of a bed that one thread works on. */
struct level_setting {
  struct dynamics *dynamics;
  struct chebyshev *chebyshev;
  double least_reach; /* of two stages */
  double tol;         /* error of a sphere's velocity in a step (m/s) */
  double lightest;    /* sphere (kg) */
  double travel;      /* furthest that a sphere may go in a step (m), 0: any */
};

struct level_counts {
  size_t contacts;        /* evaluated */
  size_t steps, rejected; /* accepted ones and others */
  size_t rows;            /* of all accepted steps */
  size_t evaluations;
  size_t refined; /* steps of which a part was taken again in shorter ones */
  size_t again;   /* times that such a part had to grow */
};

struct level {
  struct level_setting *setting;
  struct contact_list *list;       /* the rows' contacts */
  struct contact_list *near, *far; /* parts of it, where the step is split */
  /* Of an island: contacts of its rows that seem far for the whole step of the
     level above. The list has the others; away, a row each, is what these and
     all that was frozen above give the rates at the step's start. */
  struct contact_list *apart;
  double *away;
  const struct contact_list *active; /* what stages see: list or near */
  size_t rows, ghosts, stride;
  size_t room, ghost_room; /* rows and ghosts that there is room for */

  /* State and rates at the start of a step and at its end, stages, what far
     contacts give, and 1 by what errors are measured in (dynamics_scale): a row
     of the list each, ghosts included. */
  double *y0, *f0, *y1, *f1, *a, *b, *frozen, *weight;
  /* Ghosts' unknowns are cubics of the time since start: four coefficients,
     each ghosts * stride. */
  double *cubic, start;
  /* Of an island, a row for each ghost: rates by its rows after the first try
     of the step above. */
  double *tried;
  /* Its pairs of a row and a ghost that were apart at the start of the step
     above and after its first try; the ghosts' rates by them at both times, and
     what going beyond these has made of the ghosts' velocities since. */
  struct neighbors brief;
  double *brief_started, *brief_tried, *missed;

  double *error;          /* of each row in the last try, 1: the tolerance */
  double *wanted;         /* the step that each row would take (s) */
  bool *flagged;          /* rows of the last try that need shorter steps */
  struct islands islands; /* of them */
  bool wide; /* islands have all contacts: in this step something went where it
                did not seem to go */
  /* Where shorter steps took the flagged rows by the end of the step, and what
     that changes in the rates of others; the largest error of the first try
     among the flagged partners of each, 1: the tolerance. */
  double *y2, *f2, *change, *partner_error;
  bool *refined;   /* rows of the last accepted step that took them */
  uint32_t *whole; /* row of the bed, ghosts included */

  struct power power; /* the spectral radius (1/s) */
  bool inherited;     /* from the level above */
  size_t served;      /* steps since it was estimated */
  size_t stages;      /* of the last try */
  struct level_counts counts;
};

/* A level of all rows of the bed, or without rows for now. GSL_SUCCESS,
   GSL_ENOMEM. */
int level_alloc(struct level **out, struct level_setting *setting, bool all);
void level_free(struct level *l);

/* Room for the rows and ghosts of the list. GSL_SUCCESS, GSL_ENOMEM. */
int level_reserve(struct level *l);

/* Puts the ghosts' rows of y to time t. */
void level_ghosts(const struct level *l, double t, double y[]);

/* The rates f of a state y at time t over all contacts; writes the ghosts' rows
   of y. GSL_SUCCESS, or GSL_EBADFUNC where they are not finite. */
int level_rates(struct level *l, double t, double y[], double f[]);

/* One step from y0, f0 at t to y1, f1 and its errors. GSL_SUCCESS; GSL_FAILURE
   for a step too long for any number of stages and GSL_EBADFUNC where something
   is not finite, after which shorter steps may do; GSL_ENOMEM. */
int level_try(struct level *l, double t, double h);

/* Makes y1, f1 the start of the next step; and takes that back. */
void level_accept(struct level *l);
void level_undo(struct level *l);

/* Calls some for all rows, of which threads share many; h is handed on. */
void level_share(struct level *l, double h,
                 void (*some)(struct level *l, double h, size_t from,
                              size_t to));

/* Finds the islands of the flagged rows for a step of h from t, which is to
   come before their levels are made. GSL_SUCCESS, GSL_ENOMEM. */
int level_islands(struct level *l, double t, double h);

/* Makes child the level of an island of l, whose step goes from t to t + h:
   state, ghosts and the steps that the rows want. GSL_SUCCESS, GSL_EBADFUNC,
   GSL_ENOMEM. */
int level_refine(struct level *child, const struct level *l, size_t island,
                 double t, double h);

/* Brings what contacts far apart give to the rates of child, now at the end of
   l's step of length h, up to date. error: by how much of the tolerance their
   change may have moved a velocity; beyond 1 they were not far: a sphere was
   hit and went where its velocity at the start did not lead. GSL_SUCCESS,
   GSL_EBADFUNC. */
int level_catch_up(struct level *child, const struct level *l, double h,
                   double *error);

/* Notes what l, an island now at t after a step of length h, does to its
   ghosts: a sphere that is hit and bounces off again leaves no change in their
   rates at the end of the step above. GSL_SUCCESS, GSL_EBADFUNC. */
int level_watch_ghosts(struct level *l, double t, double h);

/* Changes by the rows of child, now at t + h, in the rates at the end of l's
   step: change gets a row for each ghost of child. GSL_SUCCESS,
   GSL_EBADFUNC. */
int level_feedback(struct level *child, double t, double change[]);

/* Error of a row's change of velocities, 1: the tolerance. */
double level_row_error(const struct level *l, size_t row, const double v[]);

/* The longest step of a row from y0 by setting->travel (s). */
double level_row_limit(const struct level *l, size_t row);

/* The memory of the level of a bed between its steps (platform/store.h):
   levels below it are made afresh in each step, but for their counts. */
void level_store(struct level *l, struct store *s);

#endif
