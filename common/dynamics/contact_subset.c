/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/contact_subset.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Contacts from which on threads share them. */
enum { WORTH_SHARING = 8192 };

/* Speeds within the time of a reach. */
static const double speed_grows = 1.3;

/* Of a row without a place in the part. */
#define NOWHERE UINT32_MAX

int contact_subset_alloc(struct contact_list **out,
                         const struct contact_list *whole) {
  struct contact_list *l = calloc(1, sizeof *l);
  if (!l)
    return GSL_ENOMEM;
  l->law = whole->law;
  l->has = whole->has;
  l->stride = whole->stride;
  memcpy(l->gravity, whole->gravity, sizeof l->gravity);
  l->walls_count = whole->walls_count;
  l->cylinders = whole->cylinders;
  l->periodic = whole->periodic;
  memcpy(l->period, whole->period, sizeof l->period);
  l->threads = 1;
  l->most_threads = whole->most_threads;
  l->age = SIZE_MAX;
  l->walls = calloc(GSL_MAX(whole->walls_count, 1), sizeof *l->walls);
  l->part = calloc(whole->most_threads, sizeof *l->part);
  l->incoming = calloc(whole->most_threads + 1, sizeof *l->incoming);
  if (!l->walls || !l->part || !l->incoming) {
    contact_list_free(l);
    return GSL_ENOMEM;
  }
  for (size_t k = 0; k < whole->walls_count; k++)
    l->walls[k] = whole->walls[k];
  *out = l;
  return GSL_SUCCESS;
}

/* Gives an array room for n items; true if it is there. Needs void *bigger. */
#define RESIZE(array, n)                                                       \
  ((bigger = realloc((array), (n) * sizeof *(array))) != NULL &&               \
   ((array) = bigger, true))

/* Arrays grow by half as much again as is asked for. */
static size_t roomy(size_t count) {
  return count + count / 2 + 16;
}

static bool reserve_rows(struct contact_list *l, size_t rows) {
  void *bigger;
  if (rows < l->rows_size)
    return true;
  const size_t size = roomy(rows);
  if (!RESIZE(l->order, size) || !RESIZE(l->radius, size) ||
      !RESIZE(l->mass, size) || !RESIZE(l->push, size) ||
      !RESIZE(l->turn, size) || !RESIZE(l->wall_first, size) ||
      !RESIZE(l->near.first, size))
    return false;
  l->rows_size = size;
  return true;
}

static bool reserve_contacts(struct contact_list *l, size_t pairs,
                             size_t walls) {
  void *bigger;
  if (pairs > l->near.size || !l->near.i) {
    const size_t size = roomy(pairs);
    if (!RESIZE(l->near.i, size) || !RESIZE(l->near.j, size))
      return false;
    l->near.size = size;
  }
  if (walls > l->walls_size || !l->wall_id) {
    const size_t size = roomy(walls);
    if (!RESIZE(l->wall_row, size) || !RESIZE(l->wall_id, size))
      return false;
    l->walls_size = size;
  }
  return true;
}

/* Whether rows p and q come nearer than most, where they approach for the time
   of a reach: the squared distance falls by 2 h u.v at least, to first order;
   the second is positive. period: NULL where no axis is periodic. */
static inline bool rows_within(const double *p, const double *q, double most,
                               double twice, const double *period) {
  double u[3], v[3];
  vec3_sub(p + ROW_X, q + ROW_X, u);
  if (period)
    periodic_nearest(period, u);
  vec3_sub(p + ROW_V, q + ROW_V, v);
  const double nearest = vec3_dot(u, u) + twice * GSL_MIN(vec3_dot(u, v), 0);
  return (nearest <= most * most) & (most > 0);
}

/* Twice the time that speeds as they are now would take to go as far. */
static double twice_of(const struct contact_reach *reach) {
  return 2 * speed_grows * reach->h;
}

bool contact_subset_within(const struct contact_list *l, size_t i, size_t j,
                           const struct contact_reach *reach) {
  return rows_within(reach->y + i * l->stride, reach->y + j * l->stride,
                     l->radius[i] + l->radius[j] + reach->gap, twice_of(reach),
                     l->periodic ? l->period : NULL);
}

static bool wall_within(const struct contact_list *l, size_t contact,
                        const struct contact_reach *reach) {
  const size_t i = l->wall_row[contact];
  const struct wall *w = &l->walls[l->wall_id[contact]];
  const double *p = reach->y + i * l->stride;
  double normal[3];
  const double gap = wall_nearest(w, p, normal) - l->radius[i];
  const double approach = GSL_MAX(vec3_dot(normal, p + ROW_V), 0);
  return gap - speed_grows * reach->h * approach <= reach->gap;
}

static void copy_row(struct contact_list *to, size_t at,
                     const struct contact_list *from, size_t row) {
  to->order[at] = row;
  to->radius[at] = from->radius[row];
  to->mass[at] = from->mass[row];
  to->push[at] = from->push[row];
  to->turn[at] = from->turn[row];
}

static void choose_threads(struct contact_list *l) {
  l->threads = contact_list_size(l) >= WORTH_SHARING ? l->most_threads : 1;
}

/* The place of each row of from in part, NOWHERE for all between calls; room
   for that and for the contacts of the rows. */
static uint32_t *reserve_part(struct contact_list *part,
                              const struct contact_list *from,
                              const uint32_t rows[], size_t count) {
  size_t pairs = 0, walls = 0;
  for (size_t a = 0; a < count; a++) {
    pairs += from->partner_first[rows[a] + 1] - from->partner_first[rows[a]];
    walls += from->wall_first[rows[a] + 1] - from->wall_first[rows[a]];
  }
  const size_t all = from->rows + from->ghosts;
  const size_t most = GSL_MIN(all, count + pairs);
  if (!reserve_rows(part, most) || !reserve_contacts(part, pairs, walls))
    return NULL;
  if (all > part->places || !part->place) {
    free(part->place);
    part->place = malloc((2 * all + 1) * sizeof *part->place);
    part->places = part->place ? 2 * all + 1 : 0;
    for (size_t i = 0; i < part->places; i++)
      part->place[i] = NOWHERE;
  }
  return part->place;
}

/* The row of part that is row j of from: a ghost has none before it is met. */
static uint32_t place_of(struct contact_list *part,
                         const struct contact_list *from, uint32_t j) {
  if (part->place[j] == NOWHERE) {
    const size_t at = part->rows + part->ghosts++;
    copy_row(part, at, from, j);
    part->place[j] = (uint32_t)at;
  }
  return part->place[j];
}

/* Of count lists, the first within whose reach rows i and j come; count if they
   do not. */
static size_t first_within(const struct contact_list *from, size_t i, size_t j,
                           size_t count, const struct contact_reach reach[]) {
  size_t k = 0;
  while (k < count && !contact_subset_within(from, i, j, &reach[k]))
    k++;
  return k;
}

/* Row a's pairs with rows after it and with ghosts. */
static void take_pairs(struct contact_list *const part[], size_t count,
                       const struct contact_list *from, size_t a,
                       const struct contact_reach reach[]) {
  const size_t i = part[0]->order[a];
  for (size_t q = from->partner_first[i]; q < from->partner_first[i + 1]; q++) {
    const uint32_t j = from->partner[q];
    if (part[0]->place[j] <= a)
      continue;
    const size_t k = first_within(from, i, j, count, reach);
    if (k == count)
      continue;
    struct neighbors *near = &part[k]->near;
    near->i[near->count] = (uint32_t)a;
    near->j[near->count++] = place_of(part[k], from, j);
  }
}

/* Walls are in the last list at the latest. */
static void take_walls(struct contact_list *const part[], size_t count,
                       const struct contact_list *from, size_t a,
                       const struct contact_reach reach[]) {
  const size_t i = part[0]->order[a];
  for (size_t q = from->wall_first[i]; q < from->wall_first[i + 1]; q++) {
    size_t k = 0;
    while (k + 1 < count && !wall_within(from, q, &reach[k]))
      k++;
    part[k]->wall_row[part[k]->wall_contacts] = (uint32_t)a;
    part[k]->wall_id[part[k]->wall_contacts++] = from->wall_id[q];
  }
}

static int begin_part(struct contact_list *part,
                      const struct contact_list *from, const uint32_t rows[],
                      size_t count) {
  part->moving = 0;
  part->rows = part->ghosts = part->near.count = part->wall_contacts = 0;
  part->partners_known = false;
  uint32_t *place = reserve_part(part, from, rows, count);
  if (!place)
    return GSL_ENOMEM;
  part->rows = count;
  for (size_t a = 0; a < count; a++) {
    assert(a == 0 || rows[a] > rows[a - 1]);
    copy_row(part, a, from, rows[a]);
    place[rows[a]] = (uint32_t)a;
    part->moving += rows[a] < from->moving;
  }
  return GSL_SUCCESS;
}

static int end_part(struct contact_list *part) {
  part->near.first[part->rows] = part->near.count;
  part->wall_first[part->rows] = part->wall_contacts;
  part->span = part->rows + part->ghosts;
  for (size_t a = 0; a < part->span; a++)
    part->place[part->order[a]] = NOWHERE;
  choose_threads(part);
  return contact_list_share(part);
}

int contact_subset_rows(struct contact_list *const part[], size_t parts,
                        const struct contact_list *from, const uint32_t rows[],
                        size_t count, const struct contact_reach reach[]) {
  assert(from->partners_known);
  for (size_t k = 0; k < parts; k++)
    if (begin_part(part[k], from, rows, count) != GSL_SUCCESS)
      return GSL_ENOMEM;
  for (size_t a = 0; a < count; a++) {
    for (size_t k = 0; k < parts; k++) {
      part[k]->near.first[a] = part[k]->near.count;
      part[k]->wall_first[a] = part[k]->wall_contacts;
    }
    take_pairs(part, parts, from, a, reach);
    take_walls(part, parts, from, a, reach);
  }
  int status = GSL_SUCCESS;
  for (size_t k = 0; k < parts; k++)
    if (end_part(part[k]) != GSL_SUCCESS)
      status = GSL_ENOMEM;
  return status;
}

static int copy_rows(struct contact_list *to, const struct contact_list *from) {
  const size_t all = from->rows + from->ghosts;
  to->near.count = to->wall_contacts = 0;
  to->partners_known = false;
  if (!reserve_rows(to, all) ||
      !reserve_contacts(to, from->near.count, from->wall_contacts))
    return GSL_ENOMEM;
  to->rows = from->rows;
  to->moving = from->moving;
  to->ghosts = from->ghosts;
  to->span = from->span;
  for (size_t i = 0; i < all; i++)
    to->order[i] = i;
  memcpy(to->radius, from->radius, all * sizeof *to->radius);
  memcpy(to->mass, from->mass, all * sizeof *to->mass);
  memcpy(to->push, from->push, all * sizeof *to->push);
  memcpy(to->turn, from->turn, all * sizeof *to->turn);
  return GSL_SUCCESS;
}

/* Where the next pair and wall of a part go, and where its first were. */
struct places {
  size_t pair, wall;
};

/* Deals row i's pairs out to both lists; no branch: which it is cannot be told
   ahead. */
static inline void deal_pairs(struct contact_list *const to[2],
                              const struct contact_list *from, size_t i,
                              const struct contact_reach *reach, bool periodic,
                              struct places at[2]) {
  const size_t stride = from->stride;
  const double *p = reach->y + i * stride, twice = twice_of(reach);
  const double most = from->radius[i] + reach->gap;
  uint32_t *restrict far_i = to[0]->near.i, *restrict far_j = to[0]->near.j;
  uint32_t *restrict near_i = to[1]->near.i, *restrict near_j = to[1]->near.j;
  size_t a = at[0].pair, b = at[1].pair;
  for (size_t q = from->near.first[i]; q < from->near.first[i + 1]; q++) {
    const uint32_t j = from->near.j[q];
    const bool within =
        rows_within(p, reach->y + j * stride, most + from->radius[j], twice,
                    periodic ? from->period : NULL);
    far_i[a] = near_i[b] = (uint32_t)i;
    far_j[a] = near_j[b] = j;
    a += !within;
    b += within;
  }
  at[0].pair = a;
  at[1].pair = b;
}

static void deal_walls(struct contact_list *const to[2],
                       const struct contact_list *from, size_t i,
                       const struct contact_reach *reach, struct places at[2]) {
  for (size_t q = from->wall_first[i]; q < from->wall_first[i + 1]; q++) {
    const bool within = wall_within(from, q, reach);
    struct places *place = &at[within];
    to[within]->wall_row[place->wall] = (uint32_t)i;
    to[within]->wall_id[place->wall++] = from->wall_id[q];
  }
}

/* Deals out the contacts of a part's rows, into the room of that part. */
static void deal_part(struct contact_list *const to[2],
                      const struct contact_list *from, size_t part,
                      const struct contact_reach *reach) {
  const struct contact_part *rows = &from->part[part];
  const struct places begin = {from->near.first[rows->from],
                               from->wall_first[rows->from]};
  struct places at[2] = {begin, begin};
  for (size_t i = rows->from; i < rows->to; i++) {
    for (int k = 0; k < 2; k++) {
      to[k]->near.first[i] = at[k].pair;
      to[k]->wall_first[i] = at[k].wall;
    }
    if (from->periodic)
      deal_pairs(to, from, i, reach, true, at);
    else
      deal_pairs(to, from, i, reach, false, at);
    deal_walls(to, from, i, reach, at);
  }
  for (int k = 0; k < 2; k++) {
    to[k]->part[part].pairs = at[k].pair - begin.pair;
    to[k]->part[part].walls = at[k].wall - begin.wall;
  }
}

/* Moves what was dealt to each part next to that of the part before it. */
static void close_gaps(struct contact_list *l,
                       const struct contact_list *from) {
  struct places end = {0};
  for (size_t p = 0; p < from->threads; p++) {
    const size_t first = from->part[p].from;
    const size_t pair = from->near.first[first], wall = from->wall_first[first];
    const size_t pairs = l->part[p].pairs, walls = l->part[p].walls;
    if (pair > end.pair || wall > end.wall) {
      memmove(l->near.i + end.pair, l->near.i + pair, pairs * sizeof(uint32_t));
      memmove(l->near.j + end.pair, l->near.j + pair, pairs * sizeof(uint32_t));
      memmove(l->wall_row + end.wall, l->wall_row + wall,
              walls * sizeof(uint32_t));
      memmove(l->wall_id + end.wall, l->wall_id + wall,
              walls * sizeof(uint32_t));
      for (size_t i = first; i < from->part[p].to; i++) {
        l->near.first[i] -= pair - end.pair;
        l->wall_first[i] -= wall - end.wall;
      }
    }
    end.pair += pairs;
    end.wall += walls;
  }
  l->near.first[l->rows] = l->near.count = end.pair;
  l->wall_first[l->rows] = l->wall_contacts = end.wall;
}

int contact_subset_split(struct contact_list *near, struct contact_list *far,
                         const struct contact_list *from,
                         const struct contact_reach *reach) {
  struct contact_list *const to[2] = {far, near};
  const int threads = (int)from->threads;
  if (copy_rows(near, from) != GSL_SUCCESS ||
      copy_rows(far, from) != GSL_SUCCESS)
    return GSL_ENOMEM;
  if (contact_list_size(from) < WORTH_SHARING || threads == 1)
    for (int p = 0; p < threads; p++)
      deal_part(to, from, (size_t)p, reach);
  else {
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int p = 0; p < threads; p++)
      deal_part(to, from, (size_t)p, reach);
  }
  for (int k = 0; k < 2; k++) {
    close_gaps(to[k], from);
    to[k]->threads = from->threads;
    const int status = contact_list_share(to[k]);
    if (status != GSL_SUCCESS)
      return status;
  }
  return GSL_SUCCESS;
}
