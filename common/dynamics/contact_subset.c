/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/contact_subset.h"

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
      !RESIZE(l->mass, size) || !RESIZE(l->wall_first, size) ||
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

static bool reserve_scratch(struct contact_list *l, size_t bytes) {
  if (bytes <= l->scratch_size)
    return true;
  void *bigger = realloc(l->scratch, roomy(bytes));
  if (!bigger)
    return false;
  l->scratch = bigger;
  l->scratch_size = roomy(bytes);
  return true;
}

/* The squared distance falls by 2 h u.v at least, to first order; the second is
   positive. */
static bool pair_within(const struct contact_list *l, size_t i, size_t j,
                        const struct contact_reach *reach) {
  const double *p = reach->y + i * l->stride, *q = reach->y + j * l->stride;
  double u[3], v[3];
  vec3_sub(p + ROW_X, q + ROW_X, u);
  vec3_sub(p + ROW_V, q + ROW_V, v);
  const double most = l->radius[i] + l->radius[j] + reach->gap;
  const double approach = GSL_MIN(vec3_dot(u, v), 0);
  return most > 0 &&
         vec3_dot(u, u) + 2 * speed_grows * reach->h * approach <= most * most;
}

static bool wall_within(const struct contact_list *l, size_t contact,
                        const struct contact_reach *reach) {
  const size_t i = l->wall_row[contact];
  const struct wall *w = &l->walls[l->wall_id[contact]];
  const double *p = reach->y + i * l->stride;
  const double gap = wall_distance(w, p) - l->radius[i];
  const double approach = GSL_MAX(vec3_dot(w->normal, p + ROW_V), 0);
  return gap - speed_grows * reach->h * approach <= reach->gap;
}

static void copy_row(struct contact_list *to, size_t at,
                     const struct contact_list *from, size_t row) {
  to->order[at] = row;
  to->radius[at] = from->radius[row];
  to->mass[at] = from->mass[row];
}

static void choose_threads(struct contact_list *l) {
  l->threads = contact_list_size(l) >= WORTH_SHARING ? l->most_threads : 1;
}

/* Marked rows get their places 0, 1, ...; returns how many. */
static size_t place_rows(struct contact_list *part,
                         const struct contact_list *from, const bool *marked,
                         uint32_t *place) {
  size_t rows = 0;
  for (size_t i = 0; i < from->rows; i++) {
    place[i] = NOWHERE;
    if (marked[i]) {
      copy_row(part, rows, from, i);
      place[i] = (uint32_t)rows++;
    }
  }
  for (size_t i = from->rows; i < from->rows + from->ghosts; i++)
    place[i] = NOWHERE;
  return rows;
}

/* A pair of places, the first of them a row. */
struct found {
  uint32_t i, j;
};

/* Lists the pairs of marked rows, in the order of from's, and places the
   ghosts. first[i + 1] counts row i's. */
static size_t find_pairs(struct contact_list *part,
                         const struct contact_list *from, const bool *marked,
                         const struct contact_reach *reach, uint32_t *place,
                         struct found *found) {
  size_t count = 0;
  for (size_t i = 0; i < from->rows; i++)
    for (size_t q = from->near.first[i]; q < from->near.first[i + 1]; q++) {
      const size_t j = from->near.j[q];
      const bool second = j < from->rows && marked[j];
      if ((!marked[i] && !second) || !pair_within(from, i, j, reach))
        continue;
      const size_t own = marked[i] ? i : j, other = marked[i] ? j : i;
      if (place[other] == NOWHERE) {
        const size_t at = part->rows + part->ghosts++;
        copy_row(part, at, from, other);
        place[other] = (uint32_t)at;
      }
      found[count++] = (struct found){place[own], place[other]};
      part->near.first[place[own] + 1]++;
    }
  return count;
}

/* Puts what was found in the order of the first partner. */
static void sort_pairs(struct contact_list *part, const struct found *found,
                       size_t count) {
  size_t *first = part->near.first;
  for (size_t i = 0; i < part->rows; i++)
    first[i + 1] += first[i];
  for (size_t q = 0; q < count; q++) {
    const size_t at = first[found[q].i]++;
    part->near.i[at] = found[q].i;
    part->near.j[at] = found[q].j;
  }
  for (size_t i = part->rows; i > 0; i--) /* ends are the next beginnings */
    first[i] = first[i - 1];
  first[0] = 0;
  part->near.count = count;
}

static void take_walls(struct contact_list *part,
                       const struct contact_list *from) {
  size_t count = 0;
  for (size_t a = 0; a < part->rows; a++) {
    const size_t i = part->order[a];
    part->wall_first[a] = count;
    for (size_t q = from->wall_first[i]; q < from->wall_first[i + 1]; q++) {
      part->wall_row[count] = (uint32_t)a;
      part->wall_id[count++] = from->wall_id[q];
    }
  }
  part->wall_first[part->rows] = count;
  part->wall_contacts = count;
}

int contact_subset_rows(struct contact_list *part,
                        const struct contact_list *from, const bool marked[],
                        const struct contact_reach *reach) {
  const size_t all = from->rows + from->ghosts;
  const size_t pairs = from->near.count;
  part->rows = part->ghosts = part->near.count = part->wall_contacts = 0;
  if (!reserve_rows(part, all) ||
      !reserve_scratch(part,
                       all * sizeof(uint32_t) + pairs * sizeof(struct found)))
    return GSL_ENOMEM;
  struct found *found = part->scratch;
  uint32_t *place = (uint32_t *)(found + pairs);
  part->rows = place_rows(part, from, marked, place);
  memset(part->near.first, 0, (part->rows + 1) * sizeof *part->near.first);
  const size_t count = find_pairs(part, from, marked, reach, place, found);
  if (!reserve_contacts(part, count, part->rows * part->walls_count))
    return GSL_ENOMEM;
  sort_pairs(part, found, count);
  take_walls(part, from);
  choose_threads(part);
  part->span = part->rows + part->ghosts;
  return contact_list_share(part);
}

static int copy_rows(struct contact_list *to, const struct contact_list *from) {
  const size_t all = from->rows + from->ghosts;
  to->near.count = to->wall_contacts = 0;
  if (!reserve_rows(to, all) ||
      !reserve_contacts(to, from->near.count, from->wall_contacts))
    return GSL_ENOMEM;
  to->rows = from->rows;
  to->ghosts = from->ghosts;
  to->span = from->span;
  for (size_t i = 0; i < all; i++)
    copy_row(to, i, from, i);
  return GSL_SUCCESS;
}

int contact_subset_split(struct contact_list *near, struct contact_list *far,
                         const struct contact_list *from,
                         const struct contact_reach *reach) {
  struct contact_list *to[2] = {far, near};
  size_t pairs[2] = {0, 0}, walls[2] = {0, 0};
  if (copy_rows(near, from) != GSL_SUCCESS ||
      copy_rows(far, from) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t i = 0; i < from->rows; i++) {
    for (int k = 0; k < 2; k++) {
      to[k]->near.first[i] = pairs[k];
      to[k]->wall_first[i] = walls[k];
    }
    for (size_t q = from->near.first[i]; q < from->near.first[i + 1]; q++) {
      const uint32_t j = from->near.j[q];
      const int k = pair_within(from, i, j, reach);
      to[k]->near.i[pairs[k]] = (uint32_t)i;
      to[k]->near.j[pairs[k]++] = j;
    }
    for (size_t q = from->wall_first[i]; q < from->wall_first[i + 1]; q++) {
      const int k = wall_within(from, q, reach);
      to[k]->wall_row[walls[k]] = (uint32_t)i;
      to[k]->wall_id[walls[k]++] = from->wall_id[q];
    }
  }
  for (int k = 0; k < 2; k++) {
    to[k]->near.first[from->rows] = to[k]->near.count = pairs[k];
    to[k]->wall_first[from->rows] = to[k]->wall_contacts = walls[k];
    to[k]->threads = from->threads;
    const int status = contact_list_share(to[k]);
    if (status != GSL_SUCCESS)
      return status;
  }
  return GSL_SUCCESS;
}
