/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/neighbors.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_sort_uint.h>
#include <gsl/gsl_statistics.h>
#include "platform/multiversion.h"

/* A sphere of size 2 r + reach has its partners of no larger size within that
   size. Spheres are put into levels by size, and each level has a grid of cells
   no smaller than any of its spheres: partners on the same level or on one of
   larger spheres are in the 27 cells around, and a pair is found from the
   smaller of the two. Spheres are held cell by cell in counting-sort order.
   Far-flung spheres must cost neither memory nor time: the number of cells is
   bounded by that of spheres, and where it would be more the grid spans the
   bulk of them only. */
struct grid {
  double low[3], cell[3];
  size_t dim[3];
};

/* A level holds spheres of one or several classes, which are powers of two of
   the size; the last class has all that are smaller still. */
enum { CLASSES = 64 };

struct level {
  size_t count; /* of spheres; a level without any has no grid */
  double edge;
  struct grid grid;
  size_t cells, *start; /* of a cell's members; cells + 2 */
  uint32_t *member;     /* count */
  double *place[4];     /* x, y, z and radius of each member */
};

/* The points that a search works on. */
struct cloud {
  size_t n, stride;
  const double *x, *radius;
  double reach;
};

static size_t cell_coordinate(const struct grid *g, int k, double x) {
  const double c = (x - g->low[k]) / g->cell[k];
  const size_t last = g->dim[k] - 1;
  /* an extent that overflowed makes c a NaN; any cell will do for it */
  return !(c > 0) ? 0 : c >= (double)last ? last : (size_t)c;
}

static size_t cell_index(const struct grid *g, size_t cx, size_t cy,
                         size_t cz) {
  return (cx * g->dim[1] + cy) * g->dim[2] + cz;
}

/* Numbers of cells no smaller than edge between low and high; returns their
   product. */
static double grid_dimensions(const struct grid *g, const double high[3],
                              double edge, double dim[3]) {
  for (int k = 0; k < 3; k++)
    dim[k] = fmin(fmax(1, floor((high[k] - g->low[k]) / edge)), 1e9);
  return dim[0] * dim[1] * dim[2];
}

/* The range of all but the outermost 2 % on either side. Spheres outside go
   into the cells at the border, which keeps neighbours in cells next to each
   other. */
static int trim(const struct cloud *c, size_t n, const uint32_t *member,
                struct grid *g, double high[3]) {
  double *sorted = malloc(n * sizeof *sorted);
  if (!sorted)
    return GSL_ENOMEM;
  for (int k = 0; k < 3; k++) {
    for (size_t q = 0; q < n; q++)
      sorted[q] = c->x[member[q] * c->stride + (size_t)k];
    gsl_sort(sorted, 1, n);
    g->low[k] = gsl_stats_quantile_from_sorted_data(sorted, 1, n, 0.02);
    high[k] = gsl_stats_quantile_from_sorted_data(sorted, 1, n, 0.98);
  }
  free(sorted);
  return GSL_SUCCESS;
}

static int grid_fit(struct grid *g, const struct cloud *c, size_t n,
                    const uint32_t *member, double edge) {
  double high[3], dim[3];
  for (int k = 0; k < 3; k++)
    g->low[k] = high[k] = c->x[member[0] * c->stride + (size_t)k];
  for (size_t q = 0; q < n; q++)
    for (int k = 0; k < 3; k++) {
      const double x = c->x[member[q] * c->stride + (size_t)k];
      g->low[k] = fmin(g->low[k], x);
      high[k] = fmax(high[k], x);
    }
  const double most = 2.0 * (double)n + 64;
  if (grid_dimensions(g, high, edge, dim) > most) {
    if (trim(c, n, member, g, high) != GSL_SUCCESS)
      return GSL_ENOMEM;
    grid_dimensions(g, high, edge, dim);
  }
  while (dim[0] * dim[1] * dim[2] > most) {
    int widest = 0;
    for (int k = 1; k < 3; k++)
      if (dim[k] > dim[widest])
        widest = k;
    dim[widest] = floor(dim[widest] / 2);
  }
  for (int k = 0; k < 3; k++) {
    g->dim[k] = (size_t)dim[k];
    g->cell[k] = fmax((high[k] - g->low[k]) / dim[k], edge);
  }
  return GSL_SUCCESS;
}

static int reserve_spheres(struct neighbors *nb, size_t n) {
  if (n < nb->spheres_size)
    return GSL_SUCCESS;
  size_t *first = realloc(nb->first, (n + 1) * sizeof *first);
  if (!first)
    return GSL_ENOMEM;
  nb->first = first;
  nb->spheres_size = n + 1;
  return GSL_SUCCESS;
}

static int reserve_pairs(struct neighbors *nb, size_t size) {
  if (size <= nb->size)
    return GSL_SUCCESS;
  size = size + size / 2 + 64;
  uint32_t *i = realloc(nb->i, size * sizeof *i);
  if (i)
    nb->i = i;
  uint32_t *j = realloc(nb->j, size * sizeof *j);
  if (j)
    nb->j = j;
  if (!i || !j)
    return GSL_ENOMEM;
  nb->size = size;
  return GSL_SUCCESS;
}

static int reserve_scratch(struct neighbors *nb, size_t bytes) {
  if (bytes <= nb->scratch_size)
    return GSL_SUCCESS;
  void *scratch = realloc(nb->scratch, bytes);
  if (!scratch)
    return GSL_ENOMEM;
  nb->scratch = scratch;
  nb->scratch_size = bytes;
  return GSL_SUCCESS;
}

static double size_of(const struct cloud *c, size_t i) {
  return 2 * c->radius[i] + c->reach;
}

/* Of a size, if the largest has class 0. */
static size_t class_of(double size, double largest) {
  const double ratio = largest / size;
  if (!(size > 0 && ratio < 0x1p63)) /* NaN too */
    return CLASSES - 1;
  return (size_t)ilogb(ratio);
}

/* Looking into one more level costs about as much as MANY distances. */
static const double many = 200;

/* Every class has a level of its own; or, if merge, a level takes in a class of
   smaller spheres as long as those in 27 cells would not be many, were they to
   fill space like a bed. Returns the number of levels; level[k] is class k's.
 */
static size_t choose_levels(const struct cloud *c, double largest, bool merge,
                            size_t level[CLASSES]) {
  double volume = 0, most[CLASSES] = {0};
  size_t count[CLASSES] = {0};
  for (size_t i = 0; i < c->n; i++) {
    const double size = size_of(c, i);
    const size_t k = class_of(size, largest);
    count[k]++;
    most[k] = fmax(most[k], size);
    volume += gsl_pow_3(fmax(size, 0) / largest);
  }
  size_t levels = 0, members = 0;
  double cell = 0;
  for (size_t k = 0; k < CLASSES; k++) {
    if (!count[k])
      continue;
    members += count[k];
    if (!merge || !levels || !(27 * (double)members * cell < many * volume)) {
      levels++;
      members = count[k];
      cell = gsl_pow_3(most[k] / largest);
    }
    level[k] = levels - 1;
  }
  return levels;
}

/* Sorts the spheres by level: their numbers, in ascending order on each. level:
   by class, NULL where there is but one. */
static void fill_levels(const struct cloud *c, double largest,
                        const size_t *level, struct level *levels,
                        uint32_t *sorted) {
  if (!level) {
    levels[0] =
        (struct level){.count = c->n, .edge = largest, .member = sorted};
    for (size_t i = 0; i < c->n; i++)
      sorted[i] = (uint32_t)i;
    return;
  }
  for (size_t i = 0; i < c->n; i++) {
    const double size = size_of(c, i);
    struct level *l = &levels[level[class_of(size, largest)]];
    l->count++;
    l->edge = fmax(l->edge, size);
  }
  size_t begin[CLASSES], total = 0;
  for (size_t m = 0; m < CLASSES; m++) {
    begin[m] = total;
    levels[m].member = sorted + total;
    total += levels[m].count;
  }
  for (size_t i = 0; i < c->n; i++)
    sorted[begin[level[class_of(size_of(c, i), largest)]]++] = (uint32_t)i;
}

/* Sorts a level's members by cell. cell, other: room for as many numbers. */
static void fill_cells(const struct cloud *c, struct level *l, uint32_t *cell,
                       uint32_t *other) {
  memset(l->start, 0, (l->cells + 2) * sizeof *l->start);
  for (size_t q = 0; q < l->count; q++) {
    const double *x = c->x + l->member[q] * c->stride;
    size_t at[3];
    for (int k = 0; k < 3; k++)
      at[k] = cell_coordinate(&l->grid, k, x[k]);
    cell[q] = (uint32_t)cell_index(&l->grid, at[0], at[1], at[2]);
    l->start[cell[q] + 2]++;
  }
  for (size_t k = 2; k < l->cells + 2; k++)
    l->start[k] += l->start[k - 1];
  memcpy(other, l->member, l->count * sizeof *other);
  for (size_t q = 0; q < l->count; q++)
    l->member[l->start[cell[q] + 1]++] = other[q];
  for (size_t q = 0; q < l->count; q++) {
    const size_t i = l->member[q];
    for (size_t k = 0; k < 3; k++)
      l->place[k][q] = c->x[i * c->stride + k];
    l->place[3][q] = c->radius[i];
  }
}

/* Spheres from which on threads share a search. */
enum { WORTH_SHARING = 4096 };

/* Into what is compiled for several instruction sets. */
#define INLINE static inline __attribute__((always_inline))

/* Distances are looked at in whole vectors of members, a few at a time; the
   places go on for one vector. */
enum { CHUNK = 64, VECTOR = 8 };

/* Of the members from q on, up to CHUNK: 1 for those within reach of sphere
   i. */
INLINE void test_members(const struct cloud *c, const struct level *l, size_t i,
                         size_t q, size_t count, size_t within[CHUNK]) {
  const double *x = c->x + i * c->stride, ri = c->radius[i], reach = c->reach;
  const double *px = l->place[0] + q, *py = l->place[1] + q;
  const double *pz = l->place[2] + q, *r = l->place[3] + q;
  const double x0 = x[0], x1 = x[1], x2 = x[2];
  const size_t whole = (count + VECTOR - 1) / VECTOR * VECTOR;
#pragma omp simd
  for (size_t k = 0; k < whole; k++) {
    const double dx = x0 - px[k], dy = x1 - py[k], dz = x2 - pz[k];
    const double most = ri + r[k] + reach;
    within[k] = (most >= 0) & (dx * dx + dy * dy + dz * dz <= most * most);
  }
}

/* Appends the pairs of sphere i with those of a level: of its own (own) with
   those after it, of another with all. */
INLINE int append_pairs(struct neighbors *nb, const struct cloud *c,
                        const struct level *l, size_t i, bool own) {
  const struct grid *g = &l->grid;
  const double *xi = c->x + i * c->stride;
  size_t low[3], high[3], count = nb->count;
  for (int k = 0; k < 3; k++) {
    const size_t at = cell_coordinate(g, k, xi[k]);
    low[k] = at ? at - 1 : 0;
    high[k] = at + 1 < g->dim[k] ? at + 1 : at;
  }
  for (size_t cx = low[0]; cx <= high[0]; cx++)
    for (size_t cy = low[1]; cy <= high[1]; cy++) {
      /* the cells of one column are neighbours in memory: one run of members */
      const size_t from = l->start[cell_index(g, cx, cy, low[2])];
      const size_t to = l->start[cell_index(g, cx, cy, high[2]) + 1];
      if (reserve_pairs(nb, count + (to - from)) != GSL_SUCCESS)
        return GSL_ENOMEM;
      nb->tested += to - from;
      uint32_t *restrict first = nb->i, *restrict second = nb->j;
      for (size_t q = from; q < to; q += CHUNK) {
        const size_t some = GSL_MIN(CHUNK, to - q);
        size_t within[CHUNK];
        test_members(c, l, i, q, some, within);
        /* no branch: which it is cannot be told ahead */
        for (size_t k = 0; k < some; k++) {
          const size_t j = l->member[q + k];
          if (!own)
            first[count] = (uint32_t)(i < j ? i : j);
          second[count] = (uint32_t)(own || i < j ? j : i);
          count += within[k] & (!own || j > i);
        }
      }
    }
  for (size_t p = nb->count; own && p < count; p++)
    nb->i[p] = (uint32_t)i;
  nb->count = count;
  return GSL_SUCCESS;
}

/* Sorts numbers, few as a rule. */
static void sort_few(uint32_t *at, size_t count) {
  if (count > 64) {
    gsl_sort_uint(at, 1, count);
    return;
  }
  for (size_t p = 0; p < count; p++) {
    const uint32_t moved = at[p];
    size_t q = p;
    for (; q > 0 && at[q - 1] > moved; q--)
      at[q] = at[q - 1];
    at[q] = moved;
  }
}

/* Where pairs with each sphere in `by` begin: start[k + 1], once the counts are
   summed up. start: n + 2. */
static void count_by(const uint32_t *by, size_t pairs, size_t n,
                     size_t *start) {
  memset(start, 0, (n + 2) * sizeof *start);
  for (size_t p = 0; p < pairs; p++)
    start[by[p] + 2]++;
  for (size_t k = 2; k < n + 2; k++)
    start[k] += start[k - 1];
}

/* Sorts all pairs by (i, j): by j, and then by i, which keeps the order of j.
 */
static int sort_pairs(struct neighbors *nb, size_t n) {
  const size_t count = nb->count;
  size_t *start = malloc((n + 2) * sizeof *start);
  uint32_t *i = malloc((2 * count + 1) * sizeof *i), *j = i + count;
  if (!start || !i) {
    free(start);
    free(i);
    return GSL_ENOMEM;
  }
  count_by(nb->j, count, n, start);
  for (size_t p = 0; p < count; p++) {
    const size_t to = start[nb->j[p] + 1]++;
    i[to] = nb->i[p];
    j[to] = nb->j[p];
  }
  count_by(i, count, n, start);
  memcpy(nb->first, start + 1, (n + 1) * sizeof *start);
  for (size_t p = 0; p < count; p++) {
    const size_t to = start[i[p] + 1]++;
    nb->i[to] = i[p];
    nb->j[to] = j[p];
  }
  free(start);
  free(i);
  return GSL_SUCCESS;
}

/* Appends the pairs of spheres [from, to), all spheres being of one level, and
   notes in first where those of each end. */
MULTIVERSION
static int search_some(struct neighbors *nb, const struct cloud *c,
                       const struct level *l, size_t from, size_t to,
                       size_t *first) {
  for (size_t i = from; i < to; i++) {
    const size_t begin = nb->count;
    if (append_pairs(nb, c, l, i, true) != GSL_SUCCESS)
      return GSL_ENOMEM;
    sort_few(nb->j + begin, nb->count - begin);
    first[i + 1] = nb->count;
  }
  return GSL_SUCCESS;
}

/* Appends what another thread found for spheres [from, to). */
static int append_found(struct neighbors *nb, const struct neighbors *found,
                        size_t from, size_t to) {
  const size_t count = nb->count;
  if (reserve_pairs(nb, count + found->count) != GSL_SUCCESS)
    return GSL_ENOMEM;
  memcpy(nb->i + count, found->i, found->count * sizeof *nb->i);
  memcpy(nb->j + count, found->j, found->count * sizeof *nb->j);
  for (size_t i = from; i < to; i++)
    nb->first[i + 1] += count;
  nb->count += found->count;
  nb->tested += found->tested;
  return GSL_SUCCESS;
}

static int reserve_helpers(struct neighbors *nb, size_t count) {
  if (!nb->helper)
    nb->helper = calloc(count, sizeof *nb->helper);
  nb->helpers = nb->helper ? count : 0;
  return nb->helper ? GSL_SUCCESS : GSL_ENOMEM;
}

/* All spheres of one level: pairs come in the order of i. The first thread
   writes into the list itself. */
static int search_level(struct neighbors *nb, const struct cloud *c,
                        const struct level *l) {
  const size_t n = c->n, threads = n >= WORTH_SHARING ? nb->threads : 1;
  if (threads <= 1)
    return search_some(nb, c, l, 0, n, nb->first);
  if (reserve_helpers(nb, nb->threads - 1) != GSL_SUCCESS)
    return GSL_ENOMEM;
  bool found = true;
#pragma omp parallel for num_threads((int)threads) schedule(static, 1)         \
    reduction(&& : found)
  for (size_t p = 0; p < threads; p++) {
    struct neighbors *own = p ? &nb->helper[p - 1] : nb;
    own->count = own->tested = 0;
    found = search_some(own, c, l, n * p / threads, n * (p + 1) / threads,
                        nb->first) == GSL_SUCCESS &&
            found;
  }
  for (size_t p = 1; p < threads && found; p++)
    found = append_found(nb, &nb->helper[p - 1], n * p / threads,
                         n * (p + 1) / threads) == GSL_SUCCESS;
  return found ? GSL_SUCCESS : GSL_ENOMEM;
}

static int search_levels(struct neighbors *nb, const struct cloud *c,
                         double largest, const size_t *level,
                         const struct level *levels) {
  for (size_t i = 0; i < c->n; i++) {
    const size_t own = level[class_of(size_of(c, i), largest)];
    for (size_t m = 0; m < own; m++)
      if (append_pairs(nb, c, &levels[m], i, false) != GSL_SUCCESS)
        return GSL_ENOMEM;
    if (append_pairs(nb, c, &levels[own], i, true) != GSL_SUCCESS)
      return GSL_ENOMEM;
  }
  return sort_pairs(nb, c->n);
}

/* Makes the grids of the levels. level: by class, NULL where there is but one.
   Scratch has the members of the levels, cells of spheres, their order before,
   places of the members and, once the grids are known, where the members of
   each cell start. */
static int make_grids(struct neighbors *nb, const struct cloud *c,
                      double largest, const size_t *level, size_t count,
                      struct level *levels) {
  const size_t numbers = (3 * c->n + 1) / 2 * 2 * sizeof(uint32_t);
  const size_t bytes = numbers + (4 * c->n + VECTOR) * sizeof(double);
  if (reserve_scratch(nb, bytes) != GSL_SUCCESS)
    return GSL_ENOMEM;
  fill_levels(c, largest, level, levels, nb->scratch);
  size_t starts = 0;
  for (struct level *l = levels; l < levels + count; l++) {
    /* without a size only what is in one place can touch: any cell will do */
    const double edge = l->edge > 0 ? l->edge : DBL_MIN;
    if (grid_fit(&l->grid, c, l->count, l->member, edge) != GSL_SUCCESS)
      return GSL_ENOMEM;
    l->cells = l->grid.dim[0] * l->grid.dim[1] * l->grid.dim[2];
    starts += l->cells + 2;
  }
  if (reserve_scratch(nb, bytes + starts * sizeof(size_t)) != GSL_SUCCESS)
    return GSL_ENOMEM;
  uint32_t *member = nb->scratch, *cell = member + c->n;
  double *place = (double *)((char *)nb->scratch + numbers);
  memset(place + 4 * c->n, 0, VECTOR * sizeof *place);
  size_t *start = (size_t *)((char *)nb->scratch + bytes);
  for (struct level *l = levels; l < levels + count; l++) {
    l->member = member;
    for (size_t k = 0; k < 4; k++)
      l->place[k] = place + k * l->count;
    l->start = start;
    fill_cells(c, l, cell, cell + c->n);
    member += l->count;
    place += 4 * l->count;
    start += l->cells + 2;
  }
  return GSL_SUCCESS;
}

/* Are there places where small spheres lie much more densely than in a bed, so
   that they should not share a level with larger ones? */
static bool crowded(const struct level *levels, size_t count) {
  double tests = 0, spheres = 0;
  for (const struct level *l = levels; l < levels + count; l++) {
    spheres += (double)l->count;
    for (size_t k = 0; k < l->cells; k++)
      tests += 27 * gsl_pow_2((double)(l->start[k + 1] - l->start[k]));
  }
  return tests > 4 * many * spheres;
}

static int search(struct neighbors *nb, const struct cloud *c) {
  double largest = GSL_NEGINF, smallest = GSL_POSINF;
  for (size_t i = 0; i < c->n; i++) {
    const double *x = c->x + i * c->stride;
    if (!isfinite(c->radius[i]) || !isfinite(x[0]) || !isfinite(x[1]) ||
        !isfinite(x[2]))
      return GSL_EINVAL;
    largest = fmax(largest, size_of(c, i));
    smallest = fmin(smallest, size_of(c, i));
  }
  const bool alike = largest <= 2 * smallest;
  size_t level[CLASSES] = {0}, count = 1;
  struct level levels[CLASSES];
  for (int merge = 1; merge >= 0; merge--) {
    memset(levels, 0, sizeof levels);
    if (!alike)
      count = choose_levels(c, largest, merge, level);
    const int status =
        make_grids(nb, c, largest, count > 1 ? level : NULL, count, levels);
    if (status != GSL_SUCCESS)
      return status;
    if (alike || !crowded(levels, count))
      break;
  }
  return count > 1 ? search_levels(nb, c, largest, level, levels)
                   : search_level(nb, c, levels);
}

int neighbors_find(struct neighbors *nb, size_t n, const double *x,
                   size_t stride, const double *radius, double reach) {
  nb->count = nb->tested = 0;
  if (n > UINT32_MAX - 1)
    return GSL_EINVAL;
  if (reserve_spheres(nb, n) != GSL_SUCCESS)
    return GSL_ENOMEM;
  nb->first[0] = 0;
  if (n == 0)
    return GSL_SUCCESS;
  const struct cloud c = {n, stride, x, radius, reach};
  const int status = search(nb, &c);
  if (status != GSL_SUCCESS)
    nb->count = 0;
  assert(status != GSL_SUCCESS || nb->first[n] == nb->count);
  return status;
}

size_t neighbors_partners(const struct neighbors *nb, size_t n, size_t *start,
                          uint32_t *partner) {
  size_t most = 0;
  for (size_t i = 0; i < n + 2; i++)
    start[i] = 0;
  for (size_t p = 0; p < nb->count; p++) {
    start[nb->i[p] + 2]++;
    start[nb->j[p] + 2]++;
  }
  for (size_t i = 2; i < n + 2; i++) {
    most = start[i] > most ? start[i] : most;
    start[i] += start[i - 1];
  }
  for (size_t p = 0; p < nb->count; p++) {
    partner[start[nb->i[p] + 1]++] = nb->j[p];
    partner[start[nb->j[p] + 1]++] = nb->i[p];
  }
  return most;
}

void neighbors_free(struct neighbors *nb) {
  free(nb->i);
  free(nb->j);
  free(nb->first);
  free(nb->scratch);
  for (size_t k = 0; k < nb->helpers; k++)
    neighbors_free(&nb->helper[k]);
  free(nb->helper);
  *nb = (struct neighbors){0};
}
