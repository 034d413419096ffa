/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/multirate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/internal.h"
#include "dynamics/level.h"
#include "dynamics/trace.h"

/* More flagged rows than this share of a level's take their step again with
   all others, and a step is not chosen to flag more than that. */
static const double most_flagged = 0.4, most_planned = 0.2;

/* The work of a refined row by that of a row of the level above, since its
   partners are evaluated for it alone, and the rows that the overhead of a
   level's step is worth. */
static const double refined_row = 2.5, overhead_rows = 6;

/* What a step is shortened and lengthened by at most, and the share of the
   step that just meets the tolerance. */
static const double shorten = 0.1, lengthen = 5, careful = 0.8;

/* 0.4 h |change of f| that a partner may have, in tolerances. The change grows
   from nothing within the step, so that it is more than the velocity's. At 1
   half as many parts again have to grow, for beds that are no better. */
static const double partners_error = 2;

/* Times that a part may grow before its step is taken again in whole. */
enum { MOST_AGAIN = 3 };

struct multirate {
  struct dynamics *d;
  struct level_setting setting;
  struct level *level[MULTIRATE_LEVELS];
  struct trace *trace;
  double *change; /* of the rates of ghosts */
  size_t change_size;
  double t, last_step, hinit, hmax;
  bool started;
  size_t most_stages;
};

/* --- the step --------------------------------------------------------------*/

/* Where a row with this error wants its next step (s). */
static double wanted_step(double h, double error, double most) {
  const double factor = careful / cbrt(GSL_MAX(error, 1e-9));
  return h * GSL_MIN(GSL_MAX(factor, shorten), most);
}

static double stages_of(const struct level *l, double h) {
  return sqrt(1 + 1.54 * h * l->radius);
}

/* The step of at most so much that makes the work least, of the level and of
   the rows that want shorter ones. Rows are sorted into bins by the step they
   want; the step is the lower end of one of them. */
static double choose(const struct multirate *m, size_t depth, double most) {
  enum { BINS = 24 };
  static const double ratio = 1.5;
  const struct level *l = m->level[depth];
  const double rows = (double)l->rows;
  double shortest = GSL_POSINF;
  for (size_t i = 0; i < l->rows; i++)
    shortest = GSL_MIN(shortest, l->wanted[i]);
  if (depth + 1 == MULTIRATE_LEVELS || l->rows < 4 || shortest >= most)
    return GSL_MIN(shortest, most);
  double count[BINS] = {0}, work[BINS] = {0};
  const double scale = 1 / log(ratio);
  for (size_t i = 0; i < l->rows; i++) {
    const double x = log(l->wanted[i] / shortest) * scale;
    const size_t b = x < BINS - 1 ? (size_t)x : BINS - 1;
    count[b]++;
    work[b] += stages_of(l, l->wanted[i]) / l->wanted[i];
  }
  double best = GSL_POSINF, chosen = shortest, refined = 0, below = 0;
  double h = shortest;
  for (size_t b = 0; b < BINS && refined <= most_planned * rows; b++) {
    h = GSL_MIN(h, most);
    double cost = (rows + overhead_rows) * (stages_of(l, h) + 1) / h;
    if (refined > 0)
      cost += (rows + overhead_rows) / h +
              refined_row *
                  (below + overhead_rows * stages_of(l, shortest) / shortest);
    if (cost < best) {
      best = cost;
      chosen = h;
    }
    if (h >= most)
      break;
    refined += count[b];
    below += work[b];
    h *= ratio;
  }
  return chosen;
}

static size_t flag(struct level *l) {
  size_t count = 0;
  for (size_t i = 0; i < l->rows; i++) {
    l->flagged[i] = !(l->error[i] <= 1);
    count += l->flagged[i];
  }
  return count;
}

static int step(struct multirate *m, size_t depth, double t, double *h);

/* Takes the level from t to end. */
static int advance(struct multirate *m, size_t depth, double t, double end) {
  struct level *l = m->level[depth];
  double last = end - t;
  while (t < end) {
    const double left = end - t;
    double h = choose(m, depth, GSL_MIN(left, lengthen * last));
    if (h > 0.999999 * left)
      h = left;
    else if (h > 0.5 * left) /* no tiny last step */
      h = 0.5 * left;
    const int status = step(m, depth, t, &h);
    if (status != GSL_SUCCESS)
      return status;
    last = h;
    t = h == left ? end : t + h;
    if (trace_append(m->trace, l, t) != GSL_SUCCESS)
      return GSL_ENOMEM;
  }
  return GSL_SUCCESS;
}

static int reserve_change(struct multirate *m, size_t size) {
  if (size <= m->change_size)
    return GSL_SUCCESS;
  free(m->change);
  m->change = calloc(2 * size, sizeof *m->change);
  m->change_size = m->change ? 2 * size : 0;
  return m->change ? GSL_SUCCESS : GSL_ENOMEM;
}

/* Partners felt the rows of child where the first try had them. Flags those
   whose velocities that may have changed by more than the tolerance, and
   returns how many; m->change holds the changes of rates. */
static int flag_partners(struct multirate *m, size_t depth, double t, double h,
                         size_t *count) {
  struct level *l = m->level[depth], *child = m->level[depth + 1];
  const size_t stride = l->stride;
  *count = 0;
  if (child->ghosts == 0)
    return GSL_SUCCESS;
  int status = reserve_change(m, child->ghosts * stride);
  if (status == GSL_SUCCESS)
    status = level_feedback(child, l, t + h, m->change);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t q = 0; q < child->ghosts; q++) {
    const size_t i = child->list->order[child->rows + q];
    if (i < l->rows &&
        !(0.4 * h * level_row_error(l, i, m->change + q * stride) <=
          partners_error)) {
      l->flagged[i] = true;
      ++*count;
    }
  }
  return GSL_SUCCESS;
}

/* Puts what child found into the end of l's step. */
static void merge(const struct multirate *m, size_t depth) {
  struct level *l = m->level[depth], *child = m->level[depth + 1];
  const size_t stride = l->stride, bytes = stride * sizeof(double);
  for (size_t a = 0; a < child->rows; a++) {
    const size_t i = child->list->order[a];
    memcpy(l->y1 + i * stride, child->y0 + a * stride, bytes);
    memcpy(l->f1 + i * stride, child->f0 + a * stride, bytes);
    l->wanted[i] = child->wanted[a];
  }
  for (size_t q = 0; q < child->ghosts; q++) {
    const size_t i = child->list->order[child->rows + q];
    if (i < l->rows)
      for (size_t c = ROW_V; c < stride; c++)
        l->f1[i * stride + c] += m->change[q * stride + c];
  }
}

/* Takes the flagged rows' step again in shorter ones, with their partners too
   where those have to. GSL_FAILURE if that comes to too many. */
static int refine(struct multirate *m, size_t depth, double t, double h,
                  size_t flagged) {
  struct level *l = m->level[depth], *child = m->level[depth + 1];
  const size_t mark = trace_mark(m->trace);
  for (size_t k = 0; k < MOST_AGAIN; k++) {
    if ((double)flagged > most_flagged * (double)l->rows)
      break;
    trace_cut(m->trace, mark);
    size_t more = 0;
    int status = level_refine(child, l, t, h);
    if (status == GSL_SUCCESS)
      status = advance(m, depth + 1, t, t + h);
    if (status == GSL_SUCCESS)
      status = flag_partners(m, depth, t, h, &more);
    if (status != GSL_SUCCESS)
      return status;
    if (more == 0) {
      merge(m, depth);
      l->counts.refined++;
      return GSL_SUCCESS;
    }
    flagged += more;
    l->counts.again++;
  }
  return GSL_FAILURE;
}

/* The step to take after one that was rejected for its errors. */
static double shorter_step(const struct multirate *m, size_t depth, double h) {
  struct level *l = m->level[depth];
  for (size_t i = 0; i < l->rows; i++)
    l->wanted[i] = wanted_step(h, l->error[i], 2);
  return GSL_MAX(choose(m, depth, 0.5 * h), shorten * h);
}

static bool may_be_shorter(int status) {
  return status == GSL_EBADFUNC || status == GSL_FAILURE;
}

static void accept(struct level *l, double h) {
  for (size_t i = 0; i < l->rows; i++) {
    if (!l->flagged[i])
      l->wanted[i] = wanted_step(h, l->error[i], lengthen);
    l->refined[i] = l->flagged[i];
  }
  level_accept(l);
  for (size_t i = 0; i < l->rows; i++)
    l->wanted[i] = GSL_MIN(l->wanted[i], level_row_limit(l, i));
}

/* One accepted step of the level from t, of at most *h, and how long it was. */
static int step(struct multirate *m, size_t depth, double t, double *h) {
  struct level *l = m->level[depth];
  const double smallest = 4 * GSL_DBL_EPSILON * GSL_MAX(fabs(t), 1e-3);
  const size_t mark = trace_mark(m->trace);
  for (;; l->counts.rejected++) {
    if (!(*h > smallest))
      return GSL_FAILURE;
    trace_cut(m->trace, mark);
    int status = level_try(l, t, *h);
    if (status == GSL_SUCCESS) {
      const size_t flagged = flag(l);
      const bool few = depth + 1 < MULTIRATE_LEVELS &&
                       (double)flagged <= most_flagged * (double)l->rows;
      if (flagged > 0 && !few) {
        l->served = SIZE_MAX - 1; /* look at the spectral radius afresh */
        *h = shorter_step(m, depth, *h);
        continue;
      }
      if (flagged > 0)
        status = refine(m, depth, t, *h, flagged);
    }
    if (status == GSL_SUCCESS)
      break;
    if (!may_be_shorter(status))
      return status;
    l->known = l->known && status == GSL_FAILURE;
    *h /= status == GSL_FAILURE ? 2 : 4;
  }
  accept(l, *h);
  return GSL_SUCCESS;
}

/* --- all spheres -----------------------------------------------------------*/

/* Longest way of a sphere in a step of h (m). */
static double longest_way(const struct level *l, double h) {
  double most = 0;
  for (size_t i = 0; i < l->rows; i++) {
    const double v = vec3_norm(l->y0 + i * l->stride + ROW_V);
    const double a = vec3_norm(l->f0 + i * l->stride + ROW_V);
    most = GSL_MAX(most, h * (v + 0.5 * h * a));
  }
  return most;
}

/* Makes the list hold for a step of at most *h, which it may shorten. */
static int prepare_list(struct multirate *m, double *h) {
  struct contact_list *list = m->d->list;
  const double most = contact_list_longest_way(list);
  double way = longest_way(m->level[0], *h);
  while (way > most) {
    *h *= GSL_MAX(0.9 * most / way, shorten);
    way = longest_way(m->level[0], *h);
  }
  list->age++;
  return contact_list_hold(list, m->level[0]->y0, way);
}

static int start(struct multirate *m) {
  struct level *l = m->level[0];
  int status = contact_list_update(m->d->list, l->y0);
  if (status == GSL_SUCCESS)
    status = level_rates(l, m->t, l->y0, l->f0);
  for (size_t i = 0; i < l->rows; i++)
    l->wanted[i] = m->hinit;
  m->last_step = m->hinit;
  m->started = status == GSL_SUCCESS;
  return status;
}

/* A step of all spheres from m->t, for which the list holds at its end too:
   a refined sphere may have been faster than it looked. */
static int take_step(struct multirate *m, double *h) {
  for (;;) {
    int status = prepare_list(m, h);
    if (status == GSL_SUCCESS)
      status = step(m, 0, m->t, h);
    if (status != GSL_SUCCESS ||
        contact_list_holds(m->d->list, m->level[0]->y0))
      return status;
    level_undo(m->level[0]);
    *h /= 4;
  }
}

static int multirate_step(void *engine, double stop,
                          struct integrate_counts *counts) {
  struct multirate *m = engine;
  struct level *l = m->level[0];
  int status = m->started ? GSL_SUCCESS : start(m);
  trace_cut(m->trace, 0);
  const double left = stop - m->t;
  double h =
      choose(m, 0, GSL_MIN(GSL_MIN(left, m->hmax), lengthen * m->last_step));
  if (status == GSL_SUCCESS)
    status = take_step(m, &h);
  if (status != GSL_SUCCESS)
    return may_be_shorter(status) ? GSL_FAILURE : status;
  counts->accepted = l->counts.steps;
  counts->rejected = l->counts.rejected;
  m->last_step = h;
  m->t = h == left ? stop : m->t + h;
  m->most_stages = GSL_MAX(m->most_stages, l->stages);
  return GSL_SUCCESS;
}

/* --- the engine ------------------------------------------------------------*/

static void multirate_free(void *engine) {
  struct multirate *m = engine;
  if (!m)
    return;
  for (size_t k = 0; k < MULTIRATE_LEVELS; k++)
    level_free(m->level[k]);
  trace_free(m->trace);
  chebyshev_free(m->setting.chebyshev);
  free(m->change);
  free(m);
}

static int multirate_alloc(void **out, const struct integrate_options *o,
                           double t, const double y[], void *params) {
  const struct multirate_problem *p = params;
  struct dynamics *d = p->dynamics;
  if (d->options.all_pairs || o->reltol > 0)
    return GSL_EINVAL;
  struct multirate *m = calloc(1, sizeof *m);
  if (!m)
    return GSL_ENOMEM;
  m->d = d;
  m->t = t;
  m->hinit = o->hinit;
  m->hmax = o->hmax > 0 ? o->hmax : GSL_POSINF;
  m->setting = (struct level_setting){.dynamics = d,
                                      .tol = o->abstol > 0 ? o->abstol : o->tol,
                                      .travel = p->travel,
                                      .lightest = d->list->mass[0]};
  for (size_t i = 0; i < d->list->rows; i++)
    m->setting.lightest = GSL_MIN(m->setting.lightest, d->list->mass[i]);
  int status = chebyshev_alloc(&m->setting.chebyshev);
  if (status == GSL_SUCCESS)
    status = trace_alloc(&m->trace, d->list);
  for (size_t k = 0; k < MULTIRATE_LEVELS && status == GSL_SUCCESS; k++)
    status = level_alloc(&m->level[k], &m->setting, k == 0);
  if (status != GSL_SUCCESS) {
    multirate_free(m);
    return status;
  }
  memcpy(m->level[0]->y0, y, dynamics_dimension(d) * sizeof *y);
  *out = m;
  return GSL_SUCCESS;
}

static struct integrate_view multirate_view(const void *engine) {
  const struct multirate *m = engine;
  const struct level *l = m->level[0];
  return (struct integrate_view){.t = m->t,
                                 .last_step = m->last_step,
                                 .y = l->y0,
                                 .rate = l->f0,
                                 .start = l->y1,
                                 .start_rate = l->f1};
}

static struct rkc_report multirate_found(const void *engine) {
  const struct multirate *m = engine;
  struct rkc_report r = {.spectral_radius = m->level[0]->radius,
                         .stages = m->level[0]->stages,
                         .most_stages = m->most_stages};
  for (size_t k = 0; k < MULTIRATE_LEVELS; k++)
    r.power_evaluations += m->level[k]->counts.power_evaluations;
  return r;
}

static void multirate_at(const void *engine, double t, double y[]) {
  const struct multirate *m = engine;
  const struct level *l = m->level[0];
  trace_at(m->trace, m->t - m->last_step, l->y1, l->f1, t, y);
}

const struct integrate_engine multirate_engine = {.alloc = multirate_alloc,
                                                  .free = multirate_free,
                                                  .step = multirate_step,
                                                  .view = multirate_view,
                                                  .report = multirate_found,
                                                  .at = multirate_at};

double multirate_fastest(const struct multirate *m) {
  return trace_fastest(m->trace);
}

struct multirate_report multirate_report(const struct multirate *m) {
  struct multirate_report r = {0};
  for (size_t k = 0; k < MULTIRATE_LEVELS; k++) {
    const struct level_counts *c = &m->level[k]->counts;
    r.steps[k] = c->steps;
    r.rejected[k] = c->rejected;
    r.rows[k] = c->steps ? (double)c->rows / (double)c->steps : 0;
    r.evaluations[k] = c->evaluations;
    r.again += c->again;
  }
  return r;
}
