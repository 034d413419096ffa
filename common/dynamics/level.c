/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/level.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/contact_subset.h"
#include "dynamics/rates.h"
#include "model/travel.h"
#include "platform/multiversion.h"
#include "steppers/power_store.h"

/* Steps that an estimate of the spectral radius serves unless one is
   rejected. */
enum { ESTIMATE_SERVES = 4 };

/* The radius of the level above is too large for a level that is only a part of
   it; from this number of stages on an estimate of its own pays. */
enum { ESTIMATE_STAGES = 10 };

/* From this number of stages on a step evaluates far contacts once. */
enum { SPLIT_STAGES = 4 };

/* Share of the tolerance that freezing a far contact may cost, were its force to
   vanish. At 0.05 a tenth more contacts go through all stages, for beds that are
   no better; at 1 and more, with frozen_slip, steps get shorter. */
static const double frozen_share = 0.5;

/* The largest (h omega)^2 of a mode that only frozen springs hold, whose
   amplitude grows by a quarter of it in a step, and the largest h lambda of one
   that only frozen friction damps, which is stable up to 2. */
static const double frozen_spring = 0.05, frozen_slip = 0.5;

int level_alloc(struct level **out, struct level_setting *setting, bool all) {
  struct contact_list *list = all ? setting->dynamics->list : NULL;
  struct level *l = calloc(1, sizeof *l);
  if (!l)
    return GSL_ENOMEM;
  l->setting = setting;
  l->stride = setting->dynamics->list->stride;
  l->list = list;
  int status = GSL_SUCCESS;
  if (!list)
    status = contact_subset_alloc(&l->list, setting->dynamics->list);
  if (status == GSL_SUCCESS && !list)
    status = contact_subset_alloc(&l->apart, setting->dynamics->list);
  if (status == GSL_SUCCESS)
    status = contact_subset_alloc(&l->near, setting->dynamics->list);
  if (status == GSL_SUCCESS)
    status = contact_subset_alloc(&l->far, setting->dynamics->list);
  if (status == GSL_SUCCESS && list)
    status = level_reserve(l);
  if (status != GSL_SUCCESS) {
    level_free(l);
    return status;
  }
  l->near->frozen = l->frozen;
  memset(l->far->gravity, 0, sizeof l->far->gravity);
  if (l->apart)
    memset(l->apart->gravity, 0, sizeof l->apart->gravity);
  if (list) {
    dynamics_scale(setting->dynamics, l->weight);
    for (size_t i = 0; i < l->rows * l->stride; i++)
      l->weight[i] = 1 / l->weight[i];
    for (size_t i = 0; i < l->rows; i++)
      l->whole[i] = (uint32_t)i;
  }
  *out = l;
  return GSL_SUCCESS;
}

void level_free(struct level *l) {
  if (!l)
    return;
  if (l->list != l->setting->dynamics->list)
    contact_list_free(l->list);
  contact_list_free(l->near);
  contact_list_free(l->far);
  contact_list_free(l->apart);
  double *vectors[] = {l->y0,
                       l->f0,
                       l->y1,
                       l->f1,
                       l->y2,
                       l->f2,
                       l->a,
                       l->b,
                       l->change,
                       l->frozen,
                       l->away,
                       l->cubic,
                       l->tried,
                       l->brief_started,
                       l->brief_tried,
                       l->missed,
                       l->error,
                       l->wanted,
                       l->partner_error,
                       l->power.direction,
                       l->weight};
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
    free(vectors[k]);
  islands_free(&l->islands);
  free(l->brief.i);
  free(l->brief.j);
  free(l->flagged);
  free(l->refined);
  free(l->whole);
  free(l);
}

/* True if there is room for n doubles, which are new then. */
static bool renew(double **x, size_t n) {
  free(*x);
  *x = calloc(n, sizeof **x);
  return *x != NULL;
}

int level_reserve(struct level *l) {
  l->rows = l->list->rows;
  l->ghosts = l->list->ghosts;
  const size_t apart = l->apart ? l->apart->ghosts : 0;
  const size_t other = GSL_MAX(l->ghosts, apart);
  const size_t all = l->rows + other;
  if (all <= l->room && other <= l->ghost_room)
    return GSL_SUCCESS;
  l->room = l->ghost_room = 0;
  /* islands come and go; a whole bed stays as it is */
  const bool grows = l->list != l->setting->dynamics->list;
  const size_t room = grows ? all + all / 2 + 16 : all;
  const size_t ghosts = grows ? other + other / 2 + 16 : 0;
  /* rows are loaded four doubles at a time */
  const size_t vector = room * l->stride + 4;
  free(l->flagged);
  free(l->refined);
  free(l->whole);
  l->flagged = calloc(room, sizeof *l->flagged);
  l->refined = calloc(room, sizeof *l->refined);
  l->whole = calloc(room, sizeof *l->whole);
  if (!renew(&l->y0, vector) || !renew(&l->f0, vector) ||
      !renew(&l->y1, vector) || !renew(&l->f1, vector) ||
      !renew(&l->y2, vector) || !renew(&l->f2, vector) ||
      !renew(&l->change, vector) || !renew(&l->a, vector) ||
      !renew(&l->b, vector) || !renew(&l->weight, vector) ||
      !renew(&l->power.direction, vector) || !renew(&l->frozen, vector) ||
      (l->apart && !renew(&l->away, vector)) ||
      !renew(&l->cubic, 4 * ghosts * l->stride + 4) ||
      (l->apart &&
       (!renew(&l->tried, ghosts * l->stride) ||
        !renew(&l->brief_started, ghosts * l->stride) ||
        !renew(&l->brief_tried, ghosts * l->stride) ||
        !renew(&l->missed, ghosts * l->stride))) ||
      !renew(&l->error, room) || !renew(&l->wanted, room) ||
      !renew(&l->partner_error, room) || !l->flagged || !l->refined ||
      !l->whole)
    return GSL_ENOMEM;
  l->near->frozen = l->frozen;
  l->far->frozen = l->list->frozen = l->away;
  l->room = room;
  l->ghost_room = ghosts;
  return GSL_SUCCESS;
}

/* --- vectors ---------------------------------------------------------------*/

MULTIVERSION
static void evaluate_cubics(size_t n, double s, const double *restrict c,
                            double *restrict y) {
#pragma omp simd
  for (size_t i = 0; i < n; i++)
    y[i] = c[i] + s * (c[n + i] + s * (c[2 * n + i] + s * c[3 * n + i]));
}

/* The cubic through y0 and y1 with slopes f0 and f1, h apart. */
static void fit_cubic(size_t stride, size_t n, double h, const double *y0,
                      const double *f0, const double *y1, const double *f1,
                      double *c) {
  for (size_t k = 0; k < stride; k++) {
    const double slope = (y1[k] - y0[k]) / h;
    c[k] = y0[k];
    c[n + k] = f0[k];
    c[2 * n + k] = (3 * slope - 2 * f0[k] - f1[k]) / h;
    c[3 * n + k] = (f0[k] + f1[k] - 2 * slope) / (h * h);
  }
}

/* The cubic q of n values at a distance, with its origin moved by s. */
static void shift_cubic(size_t stride, size_t of, const double *q, double s,
                        size_t n, double *c) {
  for (size_t k = 0; k < stride; k++) {
    const double c1 = q[of + k], c2 = q[2 * of + k], c3 = q[3 * of + k];
    c[k] = q[k] + s * (c1 + s * (c2 + s * c3));
    c[n + k] = c1 + s * (2 * c2 + 3 * s * c3);
    c[2 * n + k] = c2 + 3 * s * c3;
    c[3 * n + k] = c3;
  }
}

/* --- rates -----------------------------------------------------------------*/

void level_ghosts(const struct level *l, double t, double y[]) {
  evaluate_cubics(l->ghosts * l->stride, t - l->start, l->cubic,
                  y + l->rows * l->stride);
}

static int evaluate(struct level *l, const struct contact_list *list, double t,
                    double *y, const struct rates_to *to) {
  l->counts.contacts += contact_list_size(list);
  if (l->ghosts)
    level_ghosts(l, t, y);
  return rates_evaluate(list, l->setting->dynamics->kernel, y, to);
}

int level_rates(struct level *l, double t, double y[], double f[]) {
  l->counts.evaluations++;
  return evaluate(l, l->list, t, y, &(struct rates_to){.dydt = f});
}

/* --- the spectral radius ---------------------------------------------------*/

/* Of the contacts that stages see. */
static int active_rates(double t, double y[], double f[], void *level) {
  struct level *l = level;
  l->counts.evaluations++;
  return evaluate(l, l->active, t, y, &(struct rates_to){.dydt = f});
}

static int estimate_radius(struct level *l, double t, double h) {
  const struct power_problem problem = {.dim = l->rows * l->stride,
                                        .t = t,
                                        .h = h,
                                        .y = l->y0,
                                        .f = l->f0,
                                        .weight = l->weight,
                                        .least = l->setting->least_reach,
                                        .rates = active_rates,
                                        .params = l,
                                        .trial = l->a,
                                        .slope = l->b};
  const int status = power_estimate(&l->power, &problem);
  if (status == GSL_SUCCESS) {
    l->served = 0;
    l->inherited = false;
  }
  return status;
}

/* --- near and far ----------------------------------------------------------*/

/* The gap beyond which contacts may be frozen for a step of length h: their
   force, were it to vanish, changes velocities by little of the tolerance, and
   what they hold alone is stable. */
static double far_gap(const struct level *l, double h) {
  const struct contact_law *c = &l->list->law;
  const double mass = l->setting->lightest;
  double force = frozen_share * l->setting->tol * mass / (0.4 * h);
  force = GSL_MIN(force, frozen_spring * mass / (c->kappa * h * h));
  if (l->list->has.friction) /* 1/m + r^2/I is 3.5/m, for both partners */
    force = GSL_MIN(force, frozen_slip * mass * c->vmin /
                               (1.5 * c->friction * 7 * h));
  return GSL_MIN(GSL_MAX(log(c->f0 / force), 1) / c->kappa, c->lmax);
}

static int split(struct level *l, double t, double h) {
  const struct contact_reach reach = {.y = l->y0, .h = h, .gap = far_gap(l, h)};
  if (l->ghosts)
    level_ghosts(l, t, l->y0);
  const int status = contact_subset_split(l->near, l->far, l->list, &reach);
  if (status != GSL_SUCCESS)
    return status;
  l->active = l->near;
  return evaluate(l, l->far, t, l->y0, &(struct rates_to){.dydt = l->frozen});
}

/* --- a step ----------------------------------------------------------------*/

static int take_stages(struct level *l, double t, double h,
                       const struct chebyshev_scheme *scheme) {
  const size_t dim = l->rows * l->stride;
  double *before = l->a, *now = l->b;
  memcpy(before, l->y0, dim * sizeof *before);
  stage_move(dim, h * scheme->w1 * scheme->b1, l->y0, l->f0, now);
  for (size_t j = 2; j <= scheme->stages; j++) {
    const struct chebyshev_stage *next = &scheme->stage[j - 2];
    const struct stage sum = chebyshev_stage(next, h, l->y0, l->f0);
    l->counts.evaluations++;
    const int status =
        evaluate(l, l->active, t + h * next->time, now,
                 &(struct rates_to){.stage = &sum, .out = before});
    if (status != GSL_SUCCESS)
      return status;
    double *swap = before;
    before = now;
    now = swap;
  }
  l->a = before;
  l->b = l->y1;
  l->y1 = now;
  return level_rates(l, t + h, l->y1, l->f1);
}

void level_share(struct level *l, double h,
                 void (*some)(struct level *l, double h, size_t from,
                              size_t to)) {
  const size_t rows = l->rows, parts = l->list->threads;
  if (rows < CONTACT_SHARED || parts == 1) { /* a region of one thread costs */
    some(l, h, 0, rows);
    return;
  }
#pragma omp parallel for num_threads((int)parts) schedule(static, 1)
  for (size_t p = 0; p < parts; p++)
    some(l, h, rows * p / parts, rows * (p + 1) / parts);
}

/* Largest of the unknowns [from, stride) of a row by their units. */
static double largest(const struct level *l, size_t row, size_t from,
                      const double *x) {
  const double *weight = l->weight + row * l->stride;
  double most = 0;
  for (size_t c = from; c < l->stride; c++)
    most = GSL_MAX(most, weight[c] * fabs(x[c]));
  return most;
}

double level_row_error(const struct level *l, size_t row, const double v[]) {
  return largest(l, row, ROW_V, v) / l->setting->tol;
}

double level_row_limit(const struct level *l, size_t row) {
  const double travel = l->setting->travel;
  const double *y = l->y0 + row * l->stride, *f = l->f0 + row * l->stride;
  return travel > 0
             ? travel_time(vec3_norm(y + ROW_V), vec3_norm(f + ROW_V), travel)
             : GSL_POSINF;
}

/* The error of a row that went further than it may: it wants the step that goes
   so far. */
static double travel_error(const struct level *l, size_t row, double h) {
  const double travel = l->setting->travel;
  const double *y = l->y0 + row * l->stride, *f = l->f0 + row * l->stride;
  /* (a + b)^2 <= 2 (a^2 + b^2) spares most rows the roots */
  const double way = vec3_dot(y + ROW_V, y + ROW_V) +
                     0.25 * h * h * vec3_dot(f + ROW_V, f + ROW_V);
  if (!(travel > 0) || 2 * h * h * way <= travel * travel)
    return 0;
  const double most = level_row_limit(l, row);
  return h > 1.000001 * most ? gsl_pow_3(1.25 * h / most) : 0;
}

/* The estimate 0.8 (y0 - y1) + 0.4 h (f0 + f1) of each row in units of the
   tolerance. */
static void estimate_some(struct level *l, double h, size_t from, size_t to) {
  const struct level_setting *s = l->setting;
  for (size_t i = from; i < to; i++) {
    const size_t at = i * l->stride;
    double e[ROW_SPIN];
    for (size_t c = 0; c < l->stride; c++)
      e[c] = 0.8 * (l->y0[at + c] - l->y1[at + c]) +
             0.4 * h * (l->f0[at + c] + l->f1[at + c]);
    const double error = largest(l, i, ROW_X, e) / s->tol;
    l->error[i] = GSL_MAX(error, travel_error(l, i, h));
  }
}

int level_try(struct level *l, double t, double h) {
  int status = GSL_SUCCESS;
  l->active = l->list;
  const size_t stages = l->power.known ? chebyshev_stages(l->setting->chebyshev,
                                                          h * l->power.radius)
                                       : 0;
  if (stages >= SPLIT_STAGES)
    status = split(l, t, h);

  if (status == GSL_SUCCESS &&
      (!l->power.known || l->served >= ESTIMATE_SERVES ||
       (l->inherited && stages >= ESTIMATE_STAGES)))
    status = estimate_radius(l, t, h);
  if (status != GSL_SUCCESS)
    return status;
  l->stages = chebyshev_stages(l->setting->chebyshev, h * l->power.radius);
  if (!l->stages)
    return GSL_FAILURE;
  const struct chebyshev_scheme *scheme =
      chebyshev_scheme(l->setting->chebyshev, l->stages);
  if (!scheme)
    return GSL_ENOMEM;
  status = take_stages(l, t, h, scheme);
  if (status == GSL_SUCCESS)
    level_share(l, h, estimate_some);
  return status;
}

static void swap_ends(struct level *l) {
  double *swap = l->y0;
  l->y0 = l->y1;
  l->y1 = swap;
  swap = l->f0;
  l->f0 = l->f1;
  l->f1 = swap;
}

void level_undo(struct level *l) {
  swap_ends(l);
  l->counts.steps--;
  l->counts.rows -= l->rows;
  l->counts.rejected++;
}

void level_accept(struct level *l) {
  swap_ends(l);
  l->served++;
  l->counts.steps++;
  l->counts.rows += l->rows;
}

/* --- levels of levels ------------------------------------------------------*/

static void copy_row(size_t stride, const double *from, size_t i, double *to,
                     size_t at) {
  memcpy(to + at * stride, from + i * stride, stride * sizeof *to);
}

/* The motion of each ghost of child during a step of l, as a cubic in time:
   that of a row of l, or of a ghost of l. */
static void make_ghosts(struct level *child, const struct level *l, double t,
                        double h) {
  const size_t stride = l->stride, n = child->ghosts * stride;
  child->start = t;
  for (size_t q = 0; q < child->ghosts; q++) {
    const size_t i = child->list->order[child->rows + q], at = i * stride;
    double *c = child->cubic + q * stride;
    if (i < l->rows)
      fit_cubic(stride, n, h, l->y0 + at, l->f0 + at, l->y1 + at, l->f1 + at,
                c);
    else
      shift_cubic(stride, l->ghosts * stride, l->cubic + (i - l->rows) * stride,
                  t - l->start, n, c);
  }
}

/* Which contacts islands have, among each other too. */
static double island_gap(const struct level *l, double h) {
  return l->wide ? GSL_POSINF : far_gap(l, h);
}

int level_islands(struct level *l, double t, double h) {
  if (l->ghosts)
    level_ghosts(l, t, l->y0);
  const struct contact_reach reach = {
      .y = l->y0, .h = h, .gap = island_gap(l, h)};
  return islands_find(&l->islands, l->list, l->flagged, &reach);
}

/* What contacts far apart give to the rates of child's rows at y, their ghosts
   being rows of l at whole, with all that is frozen for l; uses child->a. */
static int apart_rates(struct level *child, const struct level *l,
                       const double *y, const double *whole, double *rates) {
  const struct contact_list *apart = child->apart;
  const size_t stride = l->stride, n = child->rows * stride;
  memcpy(child->a, y, n * sizeof *y);
  for (size_t a = child->rows; a < child->rows + apart->ghosts; a++)
    copy_row(stride, whole, apart->order[a], child->a, a);
  child->counts.contacts += contact_list_size(apart);
  const int status =
      rates_evaluate(apart, l->setting->dynamics->kernel, child->a,
                     &(struct rates_to){.dydt = rates});
  for (size_t a = 0; a < child->rows && l->list->frozen; a++)
    for (size_t c = ROW_V; c < stride; c++)
      rates[a * stride + c] +=
          l->list->frozen[child->list->order[a] * stride + c];
  return status;
}

/* Rates of the ghosts by pairs of the list, into the ghosts' rows of b. */
static int ghost_rates(struct level *l, const struct neighbors *pairs, double t,
                       double *y) {
  struct contact_list *list = l->list;
  const struct kernel *kernel = l->setting->dynamics->kernel;
  const size_t all = l->rows + l->ghosts;
  const struct contact_part part = {
      .to = all, .sums = list->part[0].sums, .mask = list->part[0].mask};
  l->counts.contacts += pairs->count;
  level_ghosts(l, t, y);
  kernel->add_pairs(list, y, pairs->i, pairs->j, pairs->count, &part);
  list->frozen = NULL; /* that of rows */
  const bool finite = kernel->finish(list, y, l->b, 0, all, &part);
  list->frozen = l->away;
  return finite ? GSL_SUCCESS : GSL_EBADFUNC;
}

/* Finds the pairs of a row and a ghost that are apart in both states. */
static int find_brief(struct level *l, const double *one, const double *other) {
  const struct neighbors *near = &l->list->near;
  const struct contact_reach touch[2] = {{.y = one}, {.y = other}};
  struct neighbors *brief = &l->brief;
  if (near->count > brief->size) {
    free(brief->i);
    free(brief->j);
    brief->size = near->count + near->count / 2;
    brief->i = calloc(brief->size, sizeof *brief->i);
    brief->j = calloc(brief->size, sizeof *brief->j);
  }
  brief->count = 0;
  if (near->count && (!brief->i || !brief->j)) {
    brief->size = 0;
    return GSL_ENOMEM;
  }
  for (size_t q = 0; q < near->count; q++) {
    const uint32_t i = near->i[q], j = near->j[q];
    if (j < l->rows || contact_subset_within(l->list, i, j, &touch[0]) ||
        contact_subset_within(l->list, i, j, &touch[1]))
      continue;
    brief->i[brief->count] = i;
    brief->j[brief->count++] = j;
  }
  return GSL_SUCCESS;
}

/* Looks at what child does to its ghosts at the start of l's step and after its
   first try, whose end goes to child->a. */
static int begin_watch(struct level *child, const struct level *l, double t,
                       double h) {
  const size_t bytes = child->ghosts * child->stride * sizeof(double);
  const double *rates = child->b + child->rows * child->stride;
  if (child->ghosts == 0)
    return GSL_SUCCESS;
  memset(child->missed, 0, bytes);
  for (size_t a = 0; a < child->rows; a++)
    copy_row(l->stride, l->y1, child->list->order[a], child->a, a);
  int status = ghost_rates(child, &child->list->near, t + h, child->a);
  if (status != GSL_SUCCESS)
    return status;
  memcpy(child->tried, rates, bytes);
  level_ghosts(child, t, child->y0);
  status = find_brief(child, child->y0, child->a);
  if (status != GSL_SUCCESS || child->brief.count == 0)
    return status;
  status = ghost_rates(child, &child->brief, t + h, child->a);
  if (status != GSL_SUCCESS)
    return status;
  memcpy(child->brief_tried, rates, bytes);
  status = ghost_rates(child, &child->brief, t, child->y0);
  if (status == GSL_SUCCESS)
    memcpy(child->brief_started, rates, bytes);
  return status;
}

int level_watch_ghosts(struct level *l, double t, double h) {
  const size_t stride = l->stride;
  if (l->ghosts == 0 || l->brief.count == 0)
    return GSL_SUCCESS;
  const int status = ghost_rates(l, &l->brief, t, l->y0);
  if (status != GSL_SUCCESS)
    return status;
  const double *rates = l->b + l->rows * stride;
  for (size_t q = 0; q < l->ghosts; q++)
    for (size_t c = ROW_V; c < stride; c++) {
      const size_t k = q * stride + c;
      const double one = l->brief_started[k], other = l->brief_tried[k];
      l->missed[k] += h * (GSL_MAX(0, rates[k] - GSL_MAX(one, other)) +
                           GSL_MIN(0, rates[k] - GSL_MIN(one, other)));
    }
  return GSL_SUCCESS;
}

int level_refine(struct level *child, const struct level *l, size_t island,
                 double t, double h) {
  const struct contact_reach reach[2] = {
      {.y = l->y0, .h = h, .gap = island_gap(l, h)},
      {.y = l->y0, .h = h, .gap = GSL_POSINF}};
  struct contact_list *const parts[2] = {child->list, child->apart};
  const size_t begin = l->islands.begin[island];
  int status = contact_subset_rows(parts, 2, l->list, l->islands.row + begin,
                                   l->islands.begin[island + 1] - begin, reach);
  if (status == GSL_SUCCESS)
    status = level_reserve(child);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t a = 0; a < child->rows; a++) {
    const size_t i = child->list->order[a];
    copy_row(l->stride, l->y0, i, child->y0, a);
    copy_row(l->stride, l->f0, i, child->f0, a);
    copy_row(l->stride, l->power.direction, i, child->power.direction, a);
    const double wants = h * GSL_MAX(0.02, 0.8 / cbrt(l->error[i]));
    child->wanted[a] =
        GSL_MIN(l->refined[i] ? GSL_MAX(l->wanted[i], wants) : wants, h);
    child->refined[a] = false;
  }
  for (size_t a = 0; a < child->rows + child->ghosts; a++) {
    child->whole[a] = l->whole[child->list->order[a]];
    copy_row(l->stride, l->weight, child->list->order[a], child->weight, a);
  }
  make_ghosts(child, l, t, h);
  /* its own is at most that of all, as far as a spectral radius is one of a
     symmetric matrix */
  child->power.radius = l->power.radius;
  child->power.known = child->inherited = true;
  child->power.length = 0;
  child->served = 0;
  const int rates = apart_rates(child, l, child->y0, l->y0, child->away);
  return rates == GSL_SUCCESS ? begin_watch(child, l, t, h) : rates;
}

int level_catch_up(struct level *child, const struct level *l, double h,
                   double *error) {
  const size_t stride = l->stride;
  double *now = child->f1;
  const int status = apart_rates(child, l, child->y0, l->y1, now);
  if (status != GSL_SUCCESS)
    return status;
  *error = 0;
  for (size_t a = 0; a < child->rows; a++) {
    double *change = now + a * stride;
    for (size_t c = ROW_V; c < stride; c++) {
      const size_t k = a * stride + c;
      change[c] -= child->away[k];
      child->f0[k] += change[c];
    }
    *error = GSL_MAX(*error, 0.4 * h * level_row_error(child, a, change));
  }
  return GSL_SUCCESS;
}

int level_feedback(struct level *child, double t, double change[]) {
  const size_t ghosts = child->ghosts * child->stride;
  const double *rates = child->b + child->rows * child->stride;
  const int status = ghost_rates(child, &child->list->near, t, child->y0);
  for (size_t k = 0; k < ghosts && status == GSL_SUCCESS; k++)
    change[k] = rates[k] - child->tried[k];
  return status;
}

/* --- from one step to the next ---------------------------------------------*/

void level_store(struct level *l, struct store *s) {
  const size_t dim = l->rows * l->stride;
  store_part(s, "level");
  store_doubles(s, l->y0, dim);
  store_doubles(s, l->f0, dim);
  store_doubles(s, l->wanted, l->rows);
  store_flags(s, l->refined, l->rows);
  power_store(&l->power, dim, s);
  store_flag(s, &l->inherited);
  store_size(s, &l->served);
  store_size(s, &l->stages);
  store_plain(s, &l->counts, sizeof l->counts);
}
