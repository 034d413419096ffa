/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/contact_list.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Cost of building the list, in evaluations; measured, only the skin depends
   on it. */
static const double build_cost = 3;

/* The widest skin, in mean radii. */
static const double most_skin = 2;

/* From this number of spheres on, rows are put in the order of space, so that
   partners are near each other in memory. */
enum { REORDER = 1024 };

/* Zeroed; never NULL for want of size. */
static void *allocate(size_t count, size_t size) {
  return calloc(count ? count : 1, size);
}

void contact_list_free(struct contact_list *l) {
  if (!l)
    return;
  neighbors_free(&l->near);
  free(l->walls);
  free(l->order);
  free(l->radius);
  free(l->mass);
  free(l->push);
  free(l->turn);
  free(l->wall_first);
  free(l->wall_row);
  free(l->wall_id);
  free(l->part);
  free(l->sums);
  free(l->incoming);
  free(l->in_i);
  free(l->in_j);
  free(l->reference);
  free(l->partner_first);
  free(l->partner);
  free(l->place);
  free(l);
}

/* The last two only tell spheres of one height apart, however they are listed.
 */
struct place {
  double key[5]; /* cell, z, x, y */
  size_t sphere;
};

static int compare_places(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  for (int k = 0; k < 5; k++)
    if (p->key[k] != q->key[k])
      return p->key[k] < q->key[k] ? -1 : 1;
  return (p->sphere > q->sphere) - (p->sphere < q->sphere);
}

/* Columns of cells one after the other, from the floor up: spheres fall along
   their column, so the order stays good. */
static int find_order(struct contact_list *l, const struct bed *b,
                      double edge) {
  for (size_t i = 0; i < b->n; i++)
    l->order[i] = i;
  if (b->n < REORDER)
    return GSL_SUCCESS;
  struct place *places = malloc(b->n * sizeof *places);
  if (!places)
    return GSL_ENOMEM;
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    places[i] = (struct place){
        {floor(x[0] / edge), floor(x[1] / edge), x[2], x[0], x[1]}, i};
  }
  qsort(places, b->n, sizeof *places, compare_places);
  for (size_t i = 0; i < b->n; i++)
    l->order[i] = places[i].sphere;
  free(places);
  return GSL_SUCCESS;
}

/* Obstacles come last; how many spheres move. */
static size_t put_fixed_last(struct contact_list *l, const struct bed *b) {
  size_t moving = 0;
  if (!b->fixed)
    return b->n;
  for (size_t i = 0; i < b->n; i++)
    moving += !b->fixed[l->order[i]];
  size_t *order = malloc(b->n * sizeof *order);
  if (!order)
    return 0;
  size_t next[2] = {0, moving};
  for (size_t i = 0; i < b->n; i++)
    order[next[b->fixed[l->order[i]]]++] = l->order[i];
  memcpy(l->order, order, b->n * sizeof *order);
  free(order);
  return moving;
}

static bool bed_is_sound(const struct bed *b) {
  if (b->n == 0 || b->n > UINT32_MAX - 1)
    return false;
  size_t moving = 0;
  for (size_t i = 0; i < b->n; i++) {
    if (!(b->r[i] > 0) || !(b->m[i] > 0))
      return false;
    moving += !bed_is_fixed(b, i);
  }
  return moving > 0;
}

static int reserve_rows(struct contact_list *l, size_t walls, size_t threads) {
  const size_t n = l->rows;
  l->walls = allocate(walls, sizeof *l->walls);
  l->order = allocate(n, sizeof *l->order);
  l->radius = allocate(n, sizeof *l->radius);
  l->mass = allocate(n, sizeof *l->mass);
  l->push = allocate(n, sizeof *l->push);
  l->turn = allocate(n, sizeof *l->turn);
  l->wall_first = allocate(n + 1, sizeof *l->wall_first);
  l->wall_row = allocate(n * walls, sizeof *l->wall_row);
  l->wall_id = allocate(n * walls, sizeof *l->wall_id);
  l->part = allocate(threads, sizeof *l->part);
  l->incoming = allocate(threads + 1, sizeof *l->incoming);
  l->reference = allocate(3 * n, sizeof *l->reference);
  return l->walls && l->order && l->radius && l->mass && l->push && l->turn &&
                 l->wall_first && l->wall_row && l->wall_id && l->part &&
                 l->incoming && l->reference
             ? GSL_SUCCESS
             : GSL_ENOMEM;
}

int contact_list_alloc(struct contact_list **out, const struct scene *s,
                       const struct bed *b, size_t threads,
                       const size_t *order) {
  assert(threads > 0);
  if (!bed_is_sound(b))
    return GSL_EINVAL;
  struct contact_list *l = calloc(1, sizeof *l);
  if (!l)
    return GSL_ENOMEM;
  l->rows = b->n;
  l->threads = l->most_threads = l->near.threads = threads;
  l->walls_count = s->walls_count;
  int status = reserve_rows(l, s->walls_count, threads);
  if (status == GSL_SUCCESS && order)
    memcpy(l->order, order, b->n * sizeof *order);
  else if (status == GSL_SUCCESS)
    status = find_order(l, b, 2 * bed_mean(b, b->r) + s->law.lmax);
  if (status == GSL_SUCCESS) {
    l->moving = put_fixed_last(l, b);
    status = l->moving ? GSL_SUCCESS : GSL_ENOMEM;
  }
  if (status != GSL_SUCCESS) {
    contact_list_free(l);
    return status;
  }
  for (size_t k = 0; k < s->walls_count; k++)
    l->walls[k] = s->walls[k];
  for (int k = 0; k < 3; k++)
    l->period[k] = s->period[k];
  l->periodic = periodic_any(s->period);
  l->cylinders = s->walls_count && s->walls[s->walls_count - 1].radius > 0;
  bool uniform = true;
  double smallest = GSL_POSINF;
  for (size_t i = 0; i < l->rows; i++) {
    l->radius[i] = b->r[l->order[i]];
    l->mass[i] = b->m[l->order[i]];
    contact_list_mass(l, i);
    uniform = uniform && l->radius[i] == l->radius[0];
    smallest = GSL_MIN(smallest, l->radius[i]);
  }
  for (size_t i = l->moving; i < l->rows; i++)
    l->push[i] = l->turn[i] = 0;
  l->law = s->law;
  l->has = contact_features_of(s, uniform);
  l->stride = l->has.rotation ? ROW_SPIN : ROW_PLAIN;
  for (int c = 0; c < 3; c++)
    l->gravity[c] = s->gravity[c];
  l->typical = bed_mean(b, b->r);
  l->skin = 0.2 * smallest;
  l->age = SIZE_MAX;
  *out = l;
  return GSL_SUCCESS;
}

/* Wider skins are rebuilt less often but hold more idle pairs; both costs are
   equal at the best skin. overhead: idle pairs' share of an evaluation. */
static double skin_overhead(const struct contact_list *l) {
  return 3 * l->skin / (2 * l->typical + l->law.lmax + l->skin);
}

static void tune_skin(struct contact_list *l) {
  const double idle = skin_overhead(l) * (double)l->age;
  const double factor = sqrt(build_cost / GSL_MAX(idle, 1e-3));
  const double r = l->typical;
  l->skin *= GSL_MIN(GSL_MAX(factor, 0.7), 1.4);
  l->skin = GSL_MIN(GSL_MAX(l->skin, 0.02 * r), most_skin * r);
}

static void list_walls(struct contact_list *l, const double *y, size_t stride) {
  const double reach = l->law.lmax + l->skin;
  size_t count = 0;
  for (size_t i = 0; i < l->rows; i++) {
    l->wall_first[i] = count;
    if (i >= l->moving)
      continue;
    for (size_t m = 0; m < l->walls_count; m++) {
      const double gap =
          wall_distance(&l->walls[m], y + i * stride) - l->radius[i];
      if (gap <= reach) {
        l->wall_row[count] = (uint32_t)i;
        l->wall_id[count++] = (uint32_t)m;
      }
    }
  }
  l->wall_first[l->rows] = count;
  l->wall_contacts = count;
}

/* Parts of about equal work. They decide who computes what, never what comes
   out. */
static void split_rows(struct contact_list *l) {
  const size_t *first = l->near.first, *wall_first = l->wall_first;
  const double all = (double)(first[l->rows] + wall_first[l->rows] + l->rows);
  size_t row = 0;
  for (size_t p = 0; p < l->threads; p++) {
    const double until = all * (double)p / (double)l->threads;
    while (row < l->rows &&
           (double)(first[row] + wall_first[row] + row) < until)
      row++;
    l->part[p].from = row;
    if (p)
      l->part[p - 1].to = row;
  }
  l->part[l->threads - 1].to = l->rows;
}

/* Room for the sums in flight: a chunk of rows and their furthest partner. */
static int reserve_sums(struct contact_list *l) {
  size_t size = 1;
  while (size < l->span + 2 * CONTACT_CHUNK)
    size *= 2;
  if (size > l->sums_size) {
    free(l->sums);
    l->sums = allocate(l->most_threads * size, CONTACT_SUM * sizeof *l->sums);
    l->sums_size = l->sums ? size : 0;
    if (!l->sums)
      return GSL_ENOMEM;
  }
  for (size_t p = 0; p < l->threads; p++) {
    l->part[p].sums = l->sums + p * l->sums_size * CONTACT_SUM;
    l->part[p].mask = l->sums_size - 1;
  }
  return GSL_SUCCESS;
}

static size_t part_of(const struct contact_list *l, size_t row) {
  assert(row < l->rows);
  size_t p = 0;
  while (row >= l->part[p].to)
    p++;
  return p;
}

static int reserve_incoming(struct contact_list *l, size_t count) {
  if (count <= l->incoming_size)
    return GSL_SUCCESS;
  free(l->in_i);
  free(l->in_j);
  l->in_i = allocate(2 * count, sizeof *l->in_i);
  l->in_j = allocate(2 * count, sizeof *l->in_j);
  l->incoming_size = l->in_i && l->in_j ? 2 * count : 0;
  return l->incoming_size ? GSL_SUCCESS : GSL_ENOMEM;
}

/* Counts the pairs that come into each part from earlier ones, or notes them:
   next[p], one per part, is where part p's next one goes, and grows by what
   came. */
static void pass_incoming(struct contact_list *l, bool note, size_t *next) {
  size_t p = 0;
  for (size_t i = 0; i < l->rows; i++) {
    while (i >= l->part[p].to)
      p++;
    for (size_t q = l->near.first[i]; q < l->near.first[i + 1]; q++) {
      const uint32_t j = l->near.j[q];
      if (j < l->part[p].to || j >= l->rows)
        continue;
      size_t *at = &next[part_of(l, j)];
      if (note) {
        l->in_i[*at] = l->near.i[q];
        l->in_j[*at] = j;
      }
      ++*at;
    }
  }
}

static int list_incoming(struct contact_list *l) {
  size_t *incoming = l->incoming;
  memset(incoming, 0, (l->threads + 1) * sizeof *incoming);
  if (l->threads == 1)
    return GSL_SUCCESS;
  pass_incoming(l, false, incoming + 1);
  for (size_t p = 0; p < l->threads; p++)
    incoming[p + 1] += incoming[p];
  const int status = reserve_incoming(l, incoming[l->threads]);
  if (status != GSL_SUCCESS)
    return status;
  pass_incoming(l, true, incoming);
  for (size_t p = l->threads; p > 0; p--) /* ends are the next beginnings */
    incoming[p] = incoming[p - 1];
  incoming[0] = 0;
  return GSL_SUCCESS;
}

int contact_list_partners(struct contact_list *l) {
  const size_t rows = l->rows + l->ghosts, pairs = l->near.count;
  if (l->partners_known)
    return GSL_SUCCESS;
  if (rows > l->partner_rows || !l->partner_first) {
    free(l->partner_first);
    l->partner_first = allocate(2 * rows + 2, sizeof *l->partner_first);
    l->partner_rows = l->partner_first ? 2 * rows : 0;
  }
  if (pairs > l->partner_pairs || !l->partner) {
    free(l->partner);
    l->partner = allocate(4 * pairs, sizeof *l->partner);
    l->partner_pairs = l->partner ? 2 * pairs : 0;
  }
  if (!l->partner_first || !l->partner)
    return GSL_ENOMEM;
  neighbors_partners(&l->near, rows, l->partner_first, l->partner);
  l->partners_known = true;
  return GSL_SUCCESS;
}

int contact_list_share(struct contact_list *l) {
  split_rows(l);
  const int status = list_incoming(l);
  return status == GSL_SUCCESS ? reserve_sums(l) : status;
}

/* Pairs of two obstacles are the last ones. */
static void drop_fixed(struct contact_list *l) {
  struct neighbors *near = &l->near;
  near->count = near->first[l->moving];
  for (size_t i = l->moving + 1; i <= l->rows; i++)
    near->first[i] = near->count;
}

static size_t largest_span(const struct neighbors *near) {
  size_t span = 0;
  for (size_t p = 0; p < near->count; p++)
    span = GSL_MAX(span, (size_t)(near->j[p] - near->i[p]));
  return span;
}

/* The contacts of places within the skin; they begin the rows of y. */
static int find_contacts(struct contact_list *l, const double *y,
                         size_t stride) {
  l->partners_known = false;
  const int status = periodic_find(&l->near, l->rows, y, stride, l->radius,
                                   l->law.lmax + l->skin, l->period);
  if (status != GSL_SUCCESS)
    return status == GSL_EINVAL ? GSL_EBADFUNC : status;
  drop_fixed(l);
  list_walls(l, y, stride);
  l->span = largest_span(&l->near);
  return contact_list_share(l);
}

/* For states within the way of y. */
static int build(struct contact_list *l, const double *y, double way) {
  if (l->age != SIZE_MAX)
    tune_skin(l);
  l->skin = GSL_MAX(l->skin, 2 * way);
  l->age = SIZE_MAX; /* stays so if anything below fails */
  const int status = find_contacts(l, y, l->stride);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < l->rows; i++)
    memcpy(l->reference + 3 * i, y + i * l->stride, 3 * sizeof *y);
  l->builds++;
  l->age = 0;
  return GSL_SUCCESS;
}

/* Whether rows [from, to) of y are sound; raises the furthest that any sphere
   is from its reference, squared. */
static bool measure_some(const struct contact_list *l, const double *y,
                         size_t from, size_t to, double *furthest) {
  double most = *furthest;
  bool sound = true; /* a maximum keeps a NaN out */
  for (size_t i = from; i < to; i++) {
    const double *x = y + i * l->stride, *x0 = l->reference + 3 * i;
    const double dx = x[0] - x0[0], dy = x[1] - x0[1], dz = x[2] - x0[2];
    const double moved = dx * dx + dy * dy + dz * dz;
    most = most > moved ? most : moved;
    sound = sound && moved == moved;
  }
  *furthest = most;
  return sound;
}

/* The same of all rows. */
static bool measure_way(const struct contact_list *l, const double *y,
                        double *squared) {
  const size_t rows = l->rows, parts = l->threads;
  double furthest = 0;
  bool sound = true;
  if (rows < CONTACT_SHARED || parts == 1) /* a region of one thread costs */
    sound = measure_some(l, y, 0, rows, &furthest);
  else {
#pragma omp parallel for num_threads((int)parts) schedule(static, 1)           \
    reduction(max : furthest) reduction(&& : sound)
    for (size_t p = 0; p < parts; p++)
      sound = measure_some(l, y, rows * p / parts, rows * (p + 1) / parts,
                           &furthest) &&
              sound;
  }
  *squared = furthest;
  return sound;
}

int contact_list_update(struct contact_list *l, const double y[]) {
  return contact_list_hold(l, y, 0);
}

double contact_list_longest_way(const struct contact_list *l) {
  return most_skin * l->typical / 2;
}

int contact_list_hold(struct contact_list *l, const double y[], double way) {
  double moved;
  if (l->age == SIZE_MAX)
    return build(l, y, way);
  if (!measure_way(l, y, &moved))
    return GSL_EBADFUNC;
  const double most = 0.5 * l->skin - way;
  const bool too_wide = skin_overhead(l) * (double)l->age > 8 * build_cost &&
                        l->skin > 0.03 * l->typical;
  if (most < 0 || moved > most * most || too_wide)
    return build(l, y, way);
  return GSL_SUCCESS;
}

bool contact_list_holds(const struct contact_list *l, const double y[]) {
  double moved;
  return measure_way(l, y, &moved) && moved <= 0.25 * l->skin * l->skin;
}

double contact_list_speed(const struct contact_list *l, size_t row,
                          const double y[]) {
  const double v = vec3_norm(y + ROW_V);
  return l->has.rotation ? GSL_MAX(v, l->radius[row] * vec3_norm(y + ROW_W))
                         : v;
}

/* The contacts themselves follow from the places that they were found at. */
void contact_list_store(struct contact_list *l, struct store *s) {
  store_part(s, "contact list");
  store_double(s, &l->skin);
  store_size(s, &l->age);
  store_size(s, &l->builds);
  store_doubles(s, l->reference, 3 * l->rows);
  if (s->loads && store_status(s) == GSL_SUCCESS && l->age != SIZE_MAX) {
    const int status = find_contacts(l, l->reference, 3);
    if (status != GSL_SUCCESS)
      store_fail(s, status == GSL_ENOMEM ? status : GSL_EINVAL);
  }
}
