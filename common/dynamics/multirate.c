/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/multirate.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/lanes.h"

/* A step goes through the whole list so often: to split it, for what is far and
   at its end. Its other evaluations do not depend on the list's skin. */
enum { WHOLE_EVALUATIONS = 3 };

struct multirate {
  struct dynamics *d;
  struct lanes *lanes;
  double t, last_step, hinit, hmax;
  bool started;
  size_t most_stages;
  size_t contacts; /* evaluated so far */
};

static const struct level_counts *counts_of(const struct multirate *m,
                                            size_t lane, size_t depth) {
  return &m->lanes->lane[lane].level[depth]->counts;
}

/* Tells the dynamics what was evaluated since the last time. */
static void count_contacts(struct multirate *m) {
  size_t all = counts_of(m, 0, 0)->contacts;
  for (size_t k = 0; k < m->lanes->count; k++)
    for (size_t q = 1; q < LANES_LEVELS; q++)
      all += counts_of(m, k, q)->contacts;
  const double more = (double)(all - m->contacts);
  const double listed = (double)contact_list_size(m->d->list);
  m->d->contacts += more;
  m->d->evaluations += more / GSL_MAX(listed, 1);
  m->contacts = all;
}

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
  const struct level *l = lanes_bed(m->lanes);
  const double most = contact_list_longest_way(list);
  double way = longest_way(l, *h);
  while (way > most) {
    *h = GSL_MAX(0.9 * most / way * *h, lanes_shortest(*h));
    way = longest_way(l, *h);
  }
  return contact_list_hold(list, l->y0, way);
}

static int start(struct multirate *m) {
  struct level *l = lanes_bed(m->lanes);
  int status = contact_list_update(m->d->list, l->y0);
  if (status == GSL_SUCCESS)
    status = level_rates(l, m->t, l->y0, l->f0);
  for (size_t i = 0; i < l->rows; i++)
    l->wanted[i] = m->hinit;
  m->last_step = m->hinit;
  m->started = status == GSL_SUCCESS;
  return status;
}

/* A step of all spheres, for which the list holds at its end too: a refined
   sphere may have been faster than it looked. */
static int take_step(struct multirate *m, double *h) {
  struct level *l = lanes_bed(m->lanes);
  for (;;) {
    int status = prepare_list(m, h);
    if (status == GSL_SUCCESS)
      status = lanes_step(m->lanes, m->t, h);
    if (status != GSL_SUCCESS || contact_list_holds(m->d->list, l->y0))
      return status;
    level_undo(l);
    *h /= 4;
  }
}

static int multirate_step(void *engine, double stop,
                          struct integrate_counts *counts) {
  struct multirate *m = engine;
  const struct level *l = lanes_bed(m->lanes);
  int status = m->started ? GSL_SUCCESS : start(m);
  const double left = stop - m->t;
  const double most =
      GSL_MIN(GSL_MIN(left, m->hmax), lanes_longest(m->last_step));
  double h = lanes_choose(m->lanes, most);
  if (status == GSL_SUCCESS)
    status = take_step(m, &h);
  count_contacts(m);
  counts->accepted = l->counts.steps;
  counts->rejected = l->counts.rejected;
  if (status != GSL_SUCCESS)
    return status == GSL_EBADFUNC ? GSL_FAILURE : status;
  m->d->list->age += WHOLE_EVALUATIONS;
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
  lanes_free(m->lanes);
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
  const int status =
      lanes_alloc(&m->lanes, d, o->abstol > 0 ? o->abstol : o->tol, p->travel);
  if (status != GSL_SUCCESS) {
    multirate_free(m);
    return status;
  }
  memcpy(lanes_bed(m->lanes)->y0, y, dynamics_dimension(d) * sizeof *y);
  *out = m;
  return GSL_SUCCESS;
}

static struct integrate_view multirate_view(const void *engine) {
  const struct multirate *m = engine;
  const struct level *l = lanes_bed(m->lanes);
  return (struct integrate_view){.t = m->t,
                                 .last_step = m->last_step,
                                 .y = l->y0,
                                 .rate = l->f0,
                                 .start = l->y1,
                                 .start_rate = l->f1};
}

static struct rkc_report multirate_found(const void *engine) {
  const struct multirate *m = engine;
  const struct level *l = lanes_bed(m->lanes);
  struct rkc_report r = {.spectral_radius = l->power.radius,
                         .stages = l->stages,
                         .most_stages = m->most_stages,
                         .power_evaluations = l->power.evaluations};
  for (size_t k = 0; k < m->lanes->count; k++)
    for (size_t q = 1; q < LANES_LEVELS; q++)
      r.power_evaluations += m->lanes->lane[k].level[q]->power.evaluations;
  return r;
}

static void multirate_at(const void *engine, double t, double y[]) {
  const struct multirate *m = engine;
  const struct level *l = lanes_bed(m->lanes);
  for (size_t k = 0; k < m->lanes->count; k++)
    trace_at(m->lanes->lane[k].trace, m->t - m->last_step, l->y1, l->f1, t, y);
}

static void multirate_store(void *engine, struct store *s) {
  struct multirate *m = engine;
  store_part(s, "multirate");
  store_double(s, &m->t);
  store_double(s, &m->last_step);
  store_flag(s, &m->started);
  store_size(s, &m->most_stages);
  store_size(s, &m->contacts);
  lanes_store(m->lanes, s);
}

const struct integrate_engine multirate_engine = {.alloc = multirate_alloc,
                                                  .free = multirate_free,
                                                  .step = multirate_step,
                                                  .view = multirate_view,
                                                  .report = multirate_found,
                                                  .at = multirate_at,
                                                  .store = multirate_store};

struct multirate_report multirate_report(const struct multirate *m) {
  struct multirate_report r = {0};
  for (size_t q = 0; q < MULTIRATE_LEVELS; q++) {
    double rows = 0;
    for (size_t k = 0; k < (q ? m->lanes->count : 1); k++) {
      const struct level_counts *c = counts_of(m, k, q);
      r.steps[q] += c->steps;
      r.rejected[q] += c->rejected;
      r.evaluations[q] += c->evaluations;
      r.contacts[q] += c->contacts;
      r.again += c->again;
      rows += (double)c->rows;
    }
    r.rows[q] = r.steps[q] ? rows / (double)r.steps[q] : 0;
  }
  return r;
}

void multirate_steps(const struct multirate *m, size_t count, size_t steps[]) {
  memset(steps, 0, count * sizeof *steps);
  for (size_t k = 0; k < m->lanes->count; k++)
    trace_steps(m->lanes->lane[k].trace, steps);
  for (size_t i = 0; i < count; i++)
    steps[i] = GSL_MAX(steps[i], 1);
}
