/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "platform/system.h"

/* More flagged rows than this share of a level's take their step again with
   all others, and a step is not chosen to flag more than that. */
static const double most_flagged = 0.4, most_planned = 0.2;

/* The work of a refined row by that of a row of the level above, since its
   partners are evaluated for it alone, and the rows that the overhead of a
   level's step is worth. */
static const double refined_row = 2.5, overhead_rows = 6;

/* Factors by which a step is shortened and lengthened at most, and the share of
   the step that just meets the tolerance. */
static const double shorten = 0.1, lengthen = 5, careful = 0.8;

/* 0.4 h |change of f| that a partner may have, in tolerances. The change grows
   from nothing within the step, so that it is more than the velocity's. At 1
   half as many parts again have to grow, for beds that are no better. */
static const double partners_error = 2;

/* What a partner may have missed of its velocity since somebody came and went
   within the step, in tolerances. A partner that rests among others gives most
   of it on to them: less would cost a fifth more for beds that are no better. */
static const double missed_error = 10;

/* Times that parts may grow before the step is taken again in whole. Of 100,000
   spheres there is nearly always a part that grows three times: it is one of
   many, and what it costs to take it again is nothing beside a step of all. */
enum { MOST_AGAIN = 12 };

/* --- the step --------------------------------------------------------------*/

/* Where a row with this error wants its next step (s). */
static double wanted_step(double h, double error, double most) {
  const double factor = careful / cbrt(GSL_MAX(error, 1e-9));
  return h * GSL_MIN(GSL_MAX(factor, shorten), most);
}

static double stages_of(const struct level *l, double h) {
  return sqrt(1 + 1.54 * h * l->power.radius);
}

/* The step, at most `most` long, that makes the work least, of the level and of
   the rows that want shorter ones. Rows are sorted into bins by the step they
   want; the step is the lower end of one of them. */
static double choose(const struct lane *lane, size_t depth, double most) {
  enum { BINS = 24 };
  static const double ratio = 1.5;
  const struct level *l = lane->level[depth];
  const double rows = (double)l->rows;
  double shortest = GSL_POSINF;
  for (size_t i = 0; i < l->rows; i++)
    shortest = GSL_MIN(shortest, l->wanted[i]);
  if (depth + 1 == LANES_LEVELS || l->rows < 4 || shortest >= most)
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

static int step(struct lane *lane, size_t depth, double t, double *h);

/* Takes the level from t to end. */
static int advance(struct lane *lane, size_t depth, double t, double end) {
  struct level *l = lane->level[depth];
  double last = end - t;
  while (t < end) {
    const double left = end - t;
    double h = choose(lane, depth, GSL_MIN(left, lengthen * last));
    if (h > 0.999999 * left)
      h = left;
    else if (h > 0.5 * left) /* no tiny last step */
      h = 0.5 * left;
    const int status = step(lane, depth, t, &h);
    if (status != GSL_SUCCESS)
      return status;
    last = h;
    t = h == left ? end : t + h;
    if (depth > 0 && t < end && level_watch_ghosts(l, t, h) != GSL_SUCCESS)
      return GSL_EBADFUNC;
    if (trace_append(lane->trace, l, t) != GSL_SUCCESS)
      return GSL_ENOMEM;
  }
  return GSL_SUCCESS;
}

/* --- islands ---------------------------------------------------------------*/

static bool resize(double **x, size_t n) {
  double *bigger = realloc(*x, n * sizeof **x);
  *x = bigger ? bigger : *x;
  return bigger != NULL;
}

static int reserve_changes(struct changes *c, size_t more, size_t stride) {
  if (c->count + more <= c->size)
    return GSL_SUCCESS;
  const size_t size = 2 * (c->count + more);
  uint32_t *row = realloc(c->row, size * sizeof *row);
  if (!row)
    return GSL_ENOMEM;
  c->row = row;
  if (!resize(&c->value, size * stride) || !resize(&c->missed, size * stride) ||
      !resize(&c->error, size))
    return GSL_ENOMEM;
  c->size = size;
  return GSL_SUCCESS;
}

/* The largest error in velocities that any of the rows of child that a ghost
   touches had in l's first try. */
static void note_errors(const struct level *l, const struct level *child,
                        double error[]) {
  const struct neighbors *near = &child->list->near;
  memset(error, 0, child->ghosts * sizeof *error);
  for (size_t q = 0; q < near->count; q++) {
    if (near->j[q] < child->rows)
      continue;
    const size_t a = near->i[q], i = child->list->order[a];
    double moved[ROW_SPIN];
    for (size_t c = 0; c < l->stride; c++)
      moved[c] = child->y0[a * l->stride + c] - l->y1[i * l->stride + c];
    double *most = &error[near->j[q] - child->rows];
    *most = GSL_MAX(*most, level_row_error(l, i, moved));
  }
}

/* Partners felt the rows of child where the first try had them: notes what that
   changes in their rates. */
static int note_changes(struct lane *lane, size_t depth, double end) {
  const struct level *l = lane->level[depth];
  struct level *child = lane->level[depth + 1];
  struct changes *c = &lane->changes;
  if (child->ghosts == 0)
    return GSL_SUCCESS;
  if (reserve_changes(c, child->ghosts, l->stride) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t q = 0; q < child->ghosts; q++)
    c->row[c->count + q] = (uint32_t)child->list->order[child->rows + q];
  note_errors(l, child, c->error + c->count);
  memcpy(c->missed + c->count * l->stride, child->missed,
         child->ghosts * l->stride * sizeof *c->missed);
  const int status =
      level_feedback(child, end, c->value + c->count * l->stride);
  c->count += child->ghosts;
  return status;
}

/* The island's own steps; how wrong it was to freeze what seemed far. */
static int take_island(struct lane *lane, size_t depth, size_t island, double t,
                       double h, double *error) {
  const struct level *l = lane->level[depth];
  struct level *child = lane->level[depth + 1];
  int status = level_refine(child, l, island, t, h);
  if (status == GSL_SUCCESS)
    status = advance(lane, depth + 1, t, t + h);
  if (status == GSL_SUCCESS)
    status = level_catch_up(child, l, h, error);
  return status;
}

/* Takes an island of the level from t to t + h in steps of its own. */
static void solve(struct lane *lane, size_t depth, size_t island, double t,
                  double h, struct result *r) {
  struct level *l = lane->level[depth], *child = lane->level[depth + 1];
  const size_t stride = l->stride, bytes = stride * sizeof(double);
  *r = (struct result){.lane = lane->number,
                       .changes = lane->changes.count,
                       .trace = trace_mark(lane->trace)};
  double error = 0;
  r->status = take_island(lane, depth, island, t, h, &error);
  r->narrow = !l->wide && !(error <= 1);
  if (r->status == GSL_SUCCESS)
    r->status = note_changes(lane, depth, t + h);
  r->changes_end = lane->changes.count;
  r->trace_end = trace_mark(lane->trace);
  if (r->status != GSL_SUCCESS)
    return;
  for (size_t a = 0; a < child->rows; a++) {
    const size_t i = child->list->order[a];
    memcpy(l->y2 + i * stride, child->y0 + a * stride, bytes);
    memcpy(l->f2 + i * stride, child->f0 + a * stride, bytes);
    l->wanted[i] = child->wanted[a];
  }
}

static void free_results(struct results *r) {
  free(r->of);
  free(r->first);
  free(r->solved);
  *r = (struct results){0};
}

static int reserve_results(struct results *r, size_t rows) {
  if (rows <= r->size)
    return GSL_SUCCESS;
  free_results(r);
  r->of = calloc(2 * rows, sizeof *r->of);
  r->first = calloc(2 * rows, sizeof *r->first);
  r->solved = calloc(2 * rows, sizeof *r->solved);
  r->size = r->of && r->first && r->solved ? 2 * rows : 0;
  return r->size ? GSL_SUCCESS : GSL_ENOMEM;
}

static bool all_solved(const struct islands *s, size_t island,
                       const bool *solved) {
  for (size_t q = s->begin[island]; q < s->begin[island + 1]; q++)
    if (!solved[s->row[q]])
      return false;
  return true;
}

/* Forgets what was found for the parts of an island that has grown. */
static void forget(const struct lane *lane, const struct islands *s,
                   size_t island, struct results *results) {
  for (size_t q = s->begin[island]; q < s->begin[island + 1]; q++)
    if (results->first[s->row[q]]) {
      const struct result *r = &results->of[s->row[q]];
      trace_erase(lane->all->lane[r->lane].trace, r->trace, r->trace_end);
      results->first[s->row[q]] = false;
    }
}

static void mark_solved(const struct islands *s, size_t island,
                        struct results *results) {
  results->first[s->row[s->begin[island]]] = true;
  for (size_t q = s->begin[island]; q < s->begin[island + 1]; q++)
    results->solved[s->row[q]] = true;
}

/* Solves an island of depth in a thread's own lane, unless it was found as it
   is. */
static void solve_new(struct lane *own, size_t depth, size_t island, double t,
                      double h, struct results *results) {
  const struct islands *s = &own->level[depth]->islands;
  struct result *r = &results->of[s->row[s->begin[island]]];
  if (!all_solved(s, island, results->solved))
    solve(own, depth, island, t, h, r);
}

/* Solves the islands that are new or have grown; those of all spheres are
   shared among threads. */
static int solve_islands(struct lane *lane, size_t depth, double t, double h) {
  struct lanes *all = lane->all;
  const struct islands *s = &lane->level[depth]->islands;
  struct results *results = &lane->results[depth];
  int status = GSL_SUCCESS;
  for (size_t k = 0; k < s->count; k++)
    if (!all_solved(s, k, results->solved))
      forget(lane, s, k, results);
  const int lanes = depth == 0 && s->count > 1 ? (int)all->count : 1;
  if (lanes == 1) { /* a region of one thread costs */
    for (size_t k = 0; k < s->count; k++)
      solve_new(lane, depth, k, t, h, results);
  } else {
#pragma omp parallel for num_threads(lanes) schedule(dynamic)
    for (size_t k = 0; k < s->count; k++)
      solve_new(&all->lane[system_thread()], depth, k, t, h, results);
  }
  for (size_t k = 0; k < s->count; k++) {
    const int found = results->of[s->row[s->begin[k]]].status;
    if (found != GSL_SUCCESS && status != GSL_ENOMEM)
      status = found;
    mark_solved(s, k, results);
  }
  return status;
}

static bool any_narrow(const struct islands *s, const struct results *results) {
  for (size_t k = 0; k < s->count; k++)
    if (results->of[s->row[s->begin[k]]].narrow)
      return true;
  return false;
}

/* Adds up the changes that the islands made in the rates of other rows, and
   flags the rows whose velocities that may have changed by more than the
   tolerance; returns how many. Rows that were hit and left again are felt by
   islands of all contacts alone. */
static size_t add_changes(struct lane *lane, size_t depth, double h) {
  struct level *l = lane->level[depth];
  const struct islands *s = &l->islands;
  const struct results *results = &lane->results[depth];
  const size_t stride = l->stride;
  size_t more = 0;
  memset(l->change, 0, l->rows * stride * sizeof *l->change);
  memset(l->partner_error, 0, l->rows * sizeof *l->partner_error);
  for (size_t k = 0; k < s->count; k++) {
    const struct result *r = &results->of[s->row[s->begin[k]]];
    const struct changes *c = &lane->all->lane[r->lane].changes;
    for (size_t q = r->changes; q < r->changes_end; q++) {
      const size_t i = c->row[q];
      if (i >= l->rows || l->flagged[i])
        continue;
      for (size_t u = ROW_V; u < stride; u++)
        l->change[i * stride + u] += c->value[q * stride + u];
      l->partner_error[i] = GSL_MAX(l->partner_error[i], c->error[q]);
      if (level_row_error(l, i, c->missed + q * stride) > missed_error) {
        l->flagged[i] = l->wide = true;
        more++;
      }
    }
  }
  for (size_t i = 0; i < l->rows; i++)
    if (!l->flagged[i] && l->partner_error[i] > partners_error &&
        !(0.4 * h * level_row_error(l, i, l->change + i * stride) <=
          partners_error)) {
      l->flagged[i] = true;
      more++;
    }
  return more;
}

/* Hands on what ghosts missed that are ghosts of the level too. */
static void hand_on_missed(const struct lane *lane, size_t depth) {
  struct level *l = lane->level[depth];
  const struct islands *s = &l->islands;
  const size_t stride = l->stride;
  for (size_t k = 0; k < s->count && l->ghosts > 0; k++) {
    const struct result *r = &lane->results[depth].of[s->row[s->begin[k]]];
    const struct changes *c = &lane->all->lane[r->lane].changes;
    for (size_t q = r->changes; q < r->changes_end; q++)
      for (size_t u = ROW_V; u < stride && c->row[q] >= l->rows; u++)
        l->missed[(c->row[q] - l->rows) * stride + u] +=
            c->missed[q * stride + u];
  }
}

/* Puts what the islands found into the end of the level's step. */
static void merge(struct level *l) {
  const size_t stride = l->stride, bytes = stride * sizeof(double);
  for (size_t i = 0; i < l->rows; i++)
    if (l->flagged[i]) {
      memcpy(l->y1 + i * stride, l->y2 + i * stride, bytes);
      memcpy(l->f1 + i * stride, l->f2 + i * stride, bytes);
    } else
      for (size_t c = ROW_V; c < stride; c++)
        l->f1[i * stride + c] += l->change[i * stride + c];
}

/* Takes the flagged rows' step again in shorter ones, with their partners too
   where those have to. GSL_FAILURE if that comes to too many. */
static int refine(struct lane *lane, size_t depth, double t, double h,
                  size_t flagged) {
  struct level *l = lane->level[depth];
  struct results *results = &lane->results[depth];
  const size_t mark = lane->changes.count;
  if (reserve_results(results, l->rows) != GSL_SUCCESS)
    return GSL_ENOMEM;
  memset(results->first, 0, l->rows * sizeof *results->first);
  memset(results->solved, 0, l->rows * sizeof *results->solved);
  l->wide = false;
  int status = GSL_FAILURE;
  for (size_t k = 0; k < MOST_AGAIN; k++) {
    if ((double)flagged > most_flagged * (double)l->rows)
      break;
    status = level_islands(l, t, h);
    if (status == GSL_SUCCESS)
      status = solve_islands(lane, depth, t, h);
    if (status != GSL_SUCCESS)
      break;
    const bool was_wide = l->wide;
    size_t more = 0;
    if (any_narrow(&l->islands, results))
      l->wide = true;
    else
      more = add_changes(lane, depth, h);
    if (more == 0 && l->wide == was_wide) {
      merge(l);
      hand_on_missed(lane, depth);
      l->counts.refined++;
      break;
    }
    if (l->wide != was_wide)
      memset(results->solved, 0, l->rows * sizeof *results->solved);
    flagged += more;
    l->counts.again++;
    status = GSL_FAILURE;
  }
  lane->changes.count = mark;
  return status;
}

/* The step to take after one that was rejected for its errors. */
static double shorter_step(const struct lane *lane, size_t depth, double h) {
  struct level *l = lane->level[depth];
  for (size_t i = 0; i < l->rows; i++)
    l->wanted[i] = wanted_step(h, l->error[i], 2);
  return GSL_MAX(choose(lane, depth, 0.5 * h), shorten * h);
}

static bool may_be_shorter(int status) {
  return status == GSL_EBADFUNC || status == GSL_FAILURE;
}

/* What rows want after a step of h. */
static void want(struct level *l, double h, size_t from, size_t to) {
  for (size_t i = from; i < to; i++) {
    if (!l->flagged[i])
      l->wanted[i] = wanted_step(h, l->error[i], lengthen);
    l->refined[i] = l->flagged[i];
    l->wanted[i] = GSL_MIN(l->wanted[i], level_row_limit(l, i));
  }
}

static void accept(struct level *l, double h) {
  level_accept(l);
  level_share(l, h, want);
}

/* Forgets all that was found within the step. */
static void clear_lanes(const struct lanes *all) {
  for (size_t k = 0; k < all->count; k++) {
    all->lane[k].changes.count = 0;
    trace_cut(all->lane[k].trace, 0);
  }
}

/* One accepted step of the level from t, of at most *h, and how long it was. */
static int step(struct lane *lane, size_t depth, double t, double *h) {
  struct level *l = lane->level[depth];
  const double smallest = 4 * GSL_DBL_EPSILON * GSL_MAX(fabs(t), 1e-3);
  const size_t mark = trace_mark(lane->trace);
  for (;; l->counts.rejected++) {
    if (!(*h > smallest))
      return GSL_FAILURE;
    if (depth == 0)
      clear_lanes(lane->all);
    else
      trace_cut(lane->trace, mark);
    int status = level_try(l, t, *h);
    if (status == GSL_SUCCESS) {
      const size_t flagged = flag(l);
      const bool few = depth + 1 < LANES_LEVELS &&
                       (double)flagged <= most_flagged * (double)l->rows;
      if (flagged > 0 && !few) {
        l->served = SIZE_MAX - 1; /* look at the spectral radius afresh */
        *h = shorter_step(lane, depth, *h);
        continue;
      }
      if (flagged > 0)
        status = refine(lane, depth, t, *h, flagged);
    }
    if (status == GSL_SUCCESS)
      break;
    if (!may_be_shorter(status))
      return status;
    l->power.known = l->power.known && status == GSL_FAILURE;
    *h /= status == GSL_FAILURE ? 2 : 4;
  }
  accept(l, *h);
  return GSL_SUCCESS;
}

/* --- all lanes -------------------------------------------------------------*/

double lanes_choose(const struct lanes *all, double most) {
  return choose(&all->lane[0], 0, most);
}

int lanes_step(struct lanes *all, double t, double *h) {
  const int status = step(&all->lane[0], 0, t, h);
  return status == GSL_EBADFUNC ? GSL_FAILURE : status;
}

double lanes_longest(double h) {
  return lengthen * h;
}

double lanes_shortest(double h) {
  return shorten * h;
}

void lanes_free(struct lanes *all) {
  if (!all)
    return;
  for (size_t k = 0; all->lane && k < all->count; k++) {
    struct lane *lane = &all->lane[k];
    for (size_t q = k ? 1 : 0; q < LANES_LEVELS; q++)
      level_free(lane->level[q]);
    for (size_t q = 0; q < LANES_LEVELS; q++)
      free_results(&lane->results[q]);
    free(lane->changes.row);
    free(lane->changes.value);
    free(lane->changes.error);
    free(lane->changes.missed);
    trace_free(lane->trace);
    chebyshev_free(lane->setting.chebyshev);
  }
  free(all->lane);
  free(all);
}

static int fill_lane(struct lanes *all, size_t number,
                     const struct level_setting *setting) {
  struct lane *lane = &all->lane[number];
  lane->all = all;
  lane->number = number;
  lane->setting = *setting;
  int status = chebyshev_alloc(&lane->setting.chebyshev);
  if (status == GSL_SUCCESS)
    status = trace_alloc(&lane->trace, setting->dynamics->list);
  lane->level[0] = number ? lanes_bed(all) : NULL;
  for (size_t q = number ? 1 : 0; q < LANES_LEVELS && status == GSL_SUCCESS;
       q++)
    status = level_alloc(&lane->level[q], &lane->setting, q == 0);
  return status;
}

int lanes_alloc(struct lanes **out, struct dynamics *d, double tol,
                double travel) {
  struct lanes *all = calloc(1, sizeof *all);
  if (!all)
    return GSL_ENOMEM;
  struct level_setting setting = {.dynamics = d,
                                  .tol = tol,
                                  .travel = travel,
                                  .least_reach = chebyshev_reach(2),
                                  .lightest = d->list->mass[0]};
  for (size_t i = 0; i < d->list->rows; i++)
    setting.lightest = GSL_MIN(setting.lightest, d->list->mass[i]);
  all->count = d->list->threads;
  all->lane = calloc(all->count, sizeof *all->lane);
  int status = all->lane ? GSL_SUCCESS : GSL_ENOMEM;
  for (size_t k = 0; k < all->count && status == GSL_SUCCESS; k++)
    status = fill_lane(all, k, &setting);
  if (status != GSL_SUCCESS) {
    lanes_free(all);
    return status;
  }
  *out = all;
  return GSL_SUCCESS;
}

/* Counts of a depth are added up, and taken out by the first lane. */
static void store_counts(struct lanes *all, size_t depth, struct store *s) {
  const struct level_counts none = {0};
  struct level_counts sum = none;
  size_t power = 0;
  for (size_t k = 0; k < all->count; k++) {
    const struct level *l = all->lane[k].level[depth];
    sum.contacts += l->counts.contacts;
    sum.steps += l->counts.steps;
    sum.rejected += l->counts.rejected;
    sum.rows += l->counts.rows;
    sum.evaluations += l->counts.evaluations;
    sum.refined += l->counts.refined;
    sum.again += l->counts.again;
    power += l->power.evaluations;
  }
  store_plain(s, &sum, sizeof sum);
  store_size(s, &power);
  if (!s->loads)
    return;
  for (size_t k = 0; k < all->count; k++) {
    struct level *l = all->lane[k].level[depth];
    l->counts = k ? none : sum;
    l->power.evaluations = k ? 0 : power;
  }
}

void lanes_store(struct lanes *all, struct store *s) {
  store_part(s, "lanes");
  level_store(lanes_bed(all), s);
  for (size_t q = 1; q < LANES_LEVELS; q++)
    store_counts(all, q, s);
}
