/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of multirate from within: which pairs of an island are watched and
   what comes of it for its ghosts, how steps of an island fill the one of all
   spheres, and which spheres join it. What comes of it all: test_multirate.c.
 */
#define _POSIX_C_SOURCE 200809L /* setrlimit */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <string.h>
#include "check.h"
#include "dynamics/lanes.h"
#include "limit.h"
#include "oracle.h"
#include "sample.h"

/* Spheres of radius 0.1 m and mass 1 kg without friction, weight and loss. */
struct sample {
  struct scene scene;
  struct bed bed;
  struct dynamics *dynamics;
};

static struct sample sample_new(size_t n, const double x[]) {
  struct sample s = {.scene = scene_default()};
  s.scene.model = SCENE_BASIC;
  s.scene.law.restitution = 1;
  s.scene.law.lmax = 0.01; /* diagonal neighbours are none */
  memset(s.scene.gravity, 0, sizeof s.scene.gravity);
  if (bed_alloc(&s.bed, n) != GSL_SUCCESS)
    abort();
  memcpy(s.bed.x, x, 3 * n * sizeof *x);
  for (size_t i = 0; i < n; i++) {
    s.bed.r[i] = 0.1;
    s.bed.m[i] = 1;
  }
  if (dynamics_alloc(&s.dynamics, &s.scene, &s.bed,
                     &(struct dynamics_options){.threads = 1}) != GSL_SUCCESS)
    abort();
  return s;
}

static void sample_free(struct sample *s) {
  dynamics_free(s->dynamics);
  bed_free(&s->bed);
  scene_free(&s->scene);
}

/* --- an island and its ghosts ----------------------------------------------*/

/* Spheres 0 and 1 are the island. Along the axes from sphere 0: 2 touches it at
   the start of the step alone, 3 after the first try alone, 4 in both, 1 and 5
   in none; 6 does not touch sphere 1 in either. */
enum { SPHERES = 7 };
static const double started[SPHERES][3] = {
    {0, 0, 0},     {0.205, 0, 0},  {0, 0.199, 0},    {0, -0.21, 0},
    {0, 0, 0.198}, {0, 0, -0.205}, {0.205, 0.205, 0}};
static const double tried[SPHERES][3] = {
    {0, 0, 0},     {0.205, 0, 0},  {0, 0.21, 0},     {0, -0.199, 0},
    {0, 0, 0.198}, {0, 0, -0.207}, {0.205, 0.205, 0}};

struct island {
  struct sample sample;
  struct level_setting setting;
  struct level *all, *part;
  size_t sphere[SPHERES]; /* in each row of the part, ghosts included */
};

static bool island_make(struct island *it, double t, double h) {
  *it = (struct island){.sample = sample_new(SPHERES, started[0]),
                        .setting = {.tol = 1e-3, .lightest = 1}};
  struct dynamics *d = it->setting.dynamics = it->sample.dynamics;
  if (level_alloc(&it->all, &it->setting, true) != GSL_SUCCESS ||
      level_alloc(&it->part, &it->setting, false) != GSL_SUCCESS)
    abort();
  struct level *all = it->all;
  dynamics_pack(d, &it->sample.bed, all->y0);
  memcpy(it->sample.bed.x, tried, sizeof tried);
  dynamics_pack(d, &it->sample.bed, all->y1);
  all->wide = true; /* it has all its contacts */
  for (size_t i = 0; i < SPHERES; i++) {
    all->error[i] = 8;
    all->flagged[i] = d->list->order[i] < 2;
  }
  if (!CHECK(contact_list_update(d->list, all->y0) == GSL_SUCCESS) ||
      !CHECK(level_islands(all, t, h) == GSL_SUCCESS) ||
      !CHECK(all->islands.count == 1) ||
      !CHECK(level_refine(it->part, all, 0, t, h) == GSL_SUCCESS) ||
      !CHECK(it->part->rows == 2 && it->part->ghosts == SPHERES - 2))
    return false;
  for (size_t a = 0; a < SPHERES; a++)
    it->sphere[a] = d->list->order[it->part->list->order[a]];
  return true;
}

static void island_free(struct island *it) {
  level_free(it->all);
  level_free(it->part);
  sample_free(&it->sample);
}

/* Watched are the pairs of the island and a ghost that are apart in both
   states, and no others. */
static void test_brief(void) {
  struct island it;
  if (island_make(&it, 2, 0.5)) {
    size_t found[2] = {0};
    CHECK(it.part->brief.count == 2);
    for (size_t q = 0; q < it.part->brief.count; q++) {
      const size_t i = it.sphere[it.part->brief.i[q]],
                   j = it.sphere[it.part->brief.j[q]];
      found[0] += i == 0 && j == 5;
      found[1] += i == 1 && j == 6;
    }
    CHECK(found[0] == 1 && found[1] == 1);
  }
  island_free(&it);
}

/* Sphere 0 is pushed 0.01 m along -z for a time: what its force on sphere 5
   makes beyond the force in both states is missed by that one, and nothing by
   others, of which it touches some. Behind the last ghost's nothing is written.
 */
static void test_missed(void) {
  const double start = 2, h = 0.1, push = 0.01;
  struct island it;
  if (island_make(&it, start, 0.5)) {
    struct level *l = it.part;
    const size_t stride = l->stride;
    CHECK(l->ghost_room > l->ghosts && l->room > l->rows + l->ghosts);
    for (size_t c = 0; c < stride; c++) /* of no ghost */
      l->b[(l->rows + l->ghosts) * stride + c] = 7;
    for (size_t a = 0; a < l->rows; a++)
      if (it.sphere[a] == 0)
        l->y0[a * stride + ROW_X + 2] -= push;
    CHECK(level_watch_ghosts(l, start, h) == GSL_SUCCESS);
    /* at the start, where ghosts are, it was nearer than after the try */
    const double more = oracle_f(&it.sample.scene, 0.005 - push) -
                        oracle_f(&it.sample.scene, 0.005);
    for (size_t q = 0; q <= l->ghosts; q++)
      for (size_t c = ROW_V; c < stride; c++) {
        const bool hit =
            q < l->ghosts && it.sphere[l->rows + q] == 5 && c == ROW_V + 2;
        CHECK_CLOSE(l->missed[q * stride + c], hit ? -h * more : 0,
                    hit ? 1e-10 * h * more : 0);
      }
  }
  island_free(&it);
}

/* Where the island has all its contacts none is frozen far apart, and there is
   nothing to catch up with. */
static void test_catch_up(void) {
  struct island it;
  if (island_make(&it, 2, 0.5)) {
    double error = 5;
    CHECK(level_catch_up(it.part, it.all, 0.5, &error) == GSL_SUCCESS);
    CHECK(error == 0);
  }
  island_free(&it);
}

/* --- steps -----------------------------------------------------------------*/

/* A row of spheres, 0.01 m between them, of which some move along it. */
enum { ROW = 120 };

struct run {
  struct sample sample;
  struct lanes *lanes;
  double t, last_step;
};

static struct run run_new(double speed, size_t apart, double tol) {
  struct run r = {.last_step = 1e-4};
  double x[3 * ROW] = {0};
  for (size_t i = 0; i < ROW; i++)
    x[3 * i] = 0.21 * (double)i;
  r.sample = sample_new(ROW, x);
  for (size_t i = 2; i < ROW; i += apart)
    r.sample.bed.v[3 * i] = speed;
  struct dynamics *d = r.sample.dynamics;
  if (lanes_alloc(&r.lanes, d, tol, 0) != GSL_SUCCESS)
    abort();
  struct level *bed = lanes_bed(r.lanes);
  dynamics_pack(d, &r.sample.bed, bed->y0);
  CHECK(contact_list_update(d->list, bed->y0) == GSL_SUCCESS);
  CHECK(level_rates(bed, 0, bed->y0, bed->f0) == GSL_SUCCESS);
  for (size_t i = 0; i < ROW; i++)
    bed->wanted[i] = r.last_step;
  return r;
}

/* A step of all spheres. None is faster than those that begin, and none of them
   goes 0.01 m in it. */
static bool run_step(struct run *r) {
  struct level *bed = lanes_bed(r->lanes);
  double h = lanes_choose(r->lanes, GSL_MIN(lanes_longest(r->last_step), 2e-3));
  if (!CHECK(contact_list_hold(r->sample.dynamics->list, bed->y0, 0.02) ==
             GSL_SUCCESS) ||
      !CHECK(lanes_step(r->lanes, r->t, &h) == GSL_SUCCESS) ||
      !CHECK(contact_list_holds(r->sample.dynamics->list, bed->y0)))
    return false;
  r->last_step = h;
  r->t += h;
  return true;
}

static void run_free(struct run *r) {
  lanes_free(r->lanes);
  sample_free(&r->sample);
}

/* The end of the last step of a row that is in the trace, of a step of all that
   began at t: where the trace leaves what is beyond it as it is. */
static double end_of(const struct run *r, size_t row, double t) {
  enum { MOST = ROW_SPIN * ROW };
  const struct level *bed = lanes_bed(r->lanes);
  double y[MOST], low = t, high = r->t;
  for (int k = 0; k < 60; k++) {
    const double middle = k ? 0.5 * (low + high) : high;
    for (size_t c = 0; c < MOST; c++)
      y[c] = GSL_POSINF;
    trace_at(r->lanes->lane[0].trace, t, bed->y1, bed->f1, middle, y);
    if (isfinite(y[row * bed->stride]))
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* The last step of an island is never shorter than the one before it: what is
   left is halved before. */
static void test_last_step(void) {
  struct run r = run_new(1, 5, 1e-3);
  size_t several = 0;
  for (size_t k = 0; k < 300 && r.t < 0.1; k++) {
    const double t = r.t;
    if (!run_step(&r))
      break;
    struct trace *trace = r.lanes->lane[0].trace;
    const size_t count = trace_mark(trace);
    for (size_t row = 0; row < ROW; row++) {
      double end[3] = {r.t, r.t, t};
      size_t steps[ROW] = {0}, seen = 0;
      trace_steps(trace, steps);
      if (steps[row] < 2)
        continue;
      for (size_t mark = count; mark > 0 && seen < 2; mark--) {
        size_t left[ROW] = {0};
        trace_cut(trace, mark - 1);
        trace_steps(trace, left);
        if (left[row] < steps[row] - seen) {
          seen++;
          end[seen] = left[row] ? end_of(&r, row, t) : t;
        }
      }
      trace_cut(trace, count);
      several++;
      CHECK(end[0] - end[1] >= (1 - 1e-5) * (end[1] - end[2]));
    }
  }
  CHECK(several > 0);
  run_free(&r);
}

/* The spheres that take steps of their own are those that are flagged, and
   those take all of them, however often their islands grew. Spheres whose own
   error is within the tolerance join an island that changes their rates, and
   the step of all goes on to its end. */
static void test_flagged(void) {
  static const double speeds[] = {0.5, 2, 4}, tolerances[] = {1e-3, 1e-4};
  size_t joined = 0;
  for (size_t a = 0; a < 3 * 2 * 4; a++) {
    struct run r =
        run_new(speeds[a % 3], 7 + 4 * (a / 6), tolerances[a / 3 % 2]);
    const struct level *bed = lanes_bed(r.lanes);
    for (size_t k = 0; k < 300; k++) {
      const size_t again = bed->counts.again;
      size_t steps[ROW] = {0}, wrong = 0, more = 0;
      if (!run_step(&r))
        break;
      trace_steps(r.lanes->lane[0].trace, steps);
      for (size_t i = 0; i < ROW; i++) {
        wrong += bed->flagged[i] != (steps[i] > 0);
        more += bed->flagged[i] && bed->error[i] <= 1;
      }
      CHECK(wrong == 0);
      CHECK(more == 0 || bed->counts.again > again);
      if (!bed->wide) /* else those that were hit and left again */
        joined += more;
    }
    run_free(&r);
  }
  CHECK(joined > 0);
}

int main(void) {
  limit_cpu(100); /* a loop without end is a failure too */
  gsl_set_error_handler_off();
  test_brief();
  test_missed();
  test_catch_up();
  test_last_step();
  test_flagged();
  return check_done();
}
