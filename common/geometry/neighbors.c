/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/neighbors.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>

/* A grid of cells no smaller than the reach of a sphere, so that partners are
   in the 27 cells around. Spheres are held cell by cell in counting-sort
   order. Far-flung spheres must cost neither memory nor time: the number of
   cells is bounded by that of spheres, and where it would be more the grid
   spans the bulk of them only. */
struct grid {
  double low[3], cell[3];
  size_t dim[3];
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

/* Numbers of cells no smaller than edge between low and high; their product. */
static double grid_dimensions(const struct grid *g, const double high[3],
                              double edge, double dim[3]) {
  for (int k = 0; k < 3; k++)
    dim[k] = fmin(fmax(1, floor((high[k] - g->low[k]) / edge)), 1e9);
  return dim[0] * dim[1] * dim[2];
}

/* The range of all but the outermost 2 % on either side. Spheres outside go
   into the cells at the border, which keeps neighbours in cells next to each
   other. */
static int trim(size_t n, const double *x, size_t stride, struct grid *g,
                double high[3]) {
  double *sorted = malloc(n * sizeof *sorted);
  if (!sorted)
    return GSL_ENOMEM;
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < n; i++)
      sorted[i] = x[i * stride + k];
    gsl_sort(sorted, 1, n);
    g->low[k] = gsl_stats_quantile_from_sorted_data(sorted, 1, n, 0.02);
    high[k] = gsl_stats_quantile_from_sorted_data(sorted, 1, n, 0.98);
  }
  free(sorted);
  return GSL_SUCCESS;
}

static int grid_fit(struct grid *g, size_t n, const double *x, size_t stride,
                    double edge) {
  double high[3], dim[3];
  for (int k = 0; k < 3; k++)
    g->low[k] = high[k] = x[k];
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      const double c = x[i * stride + k];
      if (!isfinite(c))
        return GSL_EINVAL;
      g->low[k] = fmin(g->low[k], c);
      high[k] = fmax(high[k], c);
    }
  const double most = 2.0 * (double)n + 64;
  if (grid_dimensions(g, high, edge, dim) > most) {
    if (trim(n, x, stride, g, high) != GSL_SUCCESS)
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

/* Appends sphere i's partners j > i, in ascending order. */
static int append_partners(struct neighbors *nb, const struct grid *g,
                           const size_t *start, const uint32_t *member,
                           size_t i, const double *x, size_t stride,
                           const double *radius, double reach) {
  const double *xi = x + i * stride;
  size_t low[3], high[3];
  for (int k = 0; k < 3; k++) {
    const size_t c = cell_coordinate(g, k, xi[k]);
    low[k] = c ? c - 1 : 0;
    high[k] = c + 1 < g->dim[k] ? c + 1 : c;
  }
  const size_t begin = nb->count;
  for (size_t cx = low[0]; cx <= high[0]; cx++)
    for (size_t cy = low[1]; cy <= high[1]; cy++) {
      /* the cells of one column are neighbours in memory: one run of members */
      const size_t from = start[cell_index(g, cx, cy, low[2])];
      const size_t to = start[cell_index(g, cx, cy, high[2]) + 1];
      if (reserve_pairs(nb, nb->count + (to - from)) != GSL_SUCCESS)
        return GSL_ENOMEM;
      for (size_t q = from; q < to; q++) {
        const size_t j = member[q];
        if (j <= i)
          continue;
        const double *xj = x + j * stride;
        const double dx = xi[0] - xj[0], dy = xi[1] - xj[1], dz = xi[2] - xj[2];
        const double most = radius[i] + radius[j] + reach;
        if (most >= 0 && dx * dx + dy * dy + dz * dz <= most * most)
          nb->j[nb->count++] = (uint32_t)j;
      }
    }
  for (size_t p = begin; p < nb->count; p++) { /* insertion sort: a few */
    const uint32_t j = nb->j[p];
    size_t q = p;
    for (; q > begin && nb->j[q - 1] > j; q--)
      nb->j[q] = nb->j[q - 1];
    nb->j[q] = j;
    nb->i[p] = (uint32_t)i;
  }
  return GSL_SUCCESS;
}

int neighbors_find(struct neighbors *nb, size_t n, const double *x,
                   size_t stride, const double *radius, double reach) {
  nb->count = 0;
  if (n > UINT32_MAX - 1)
    return GSL_EINVAL;
  if (reserve_spheres(nb, n) != GSL_SUCCESS)
    return GSL_ENOMEM;
  nb->first[0] = 0;
  if (n == 0)
    return GSL_SUCCESS;
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(radius[i]))
      return GSL_EINVAL;
    largest = fmax(largest, radius[i]);
  }
  struct grid g;
  const double edge = 2 * largest + reach;
  const int status = grid_fit(&g, n, x, stride, edge > 0 ? edge : 1);
  if (status != GSL_SUCCESS)
    return status;

  /* scratch: start of each cell (cells + 1), members and cells of spheres */
  const size_t cells = g.dim[0] * g.dim[1] * g.dim[2];
  const size_t bytes = (cells + 2) * sizeof(size_t) + 2 * n * sizeof(uint32_t);
  if (bytes > nb->grid_size) {
    void *grid = realloc(nb->grid, bytes);
    if (!grid)
      return GSL_ENOMEM;
    nb->grid = grid;
    nb->grid_size = bytes;
  }
  size_t *start = nb->grid;
  uint32_t *member = (uint32_t *)(start + cells + 2);
  uint32_t *cell = member + n;
  for (size_t c = 0; c < cells + 2; c++)
    start[c] = 0;
  for (size_t i = 0; i < n; i++) {
    size_t c[3];
    for (int k = 0; k < 3; k++)
      c[k] = cell_coordinate(&g, k, x[i * stride + k]);
    cell[i] = (uint32_t)cell_index(&g, c[0], c[1], c[2]);
    start[cell[i] + 2]++;
  }
  for (size_t c = 2; c < cells + 2; c++)
    start[c] += start[c - 1];
  for (size_t i = 0; i < n; i++)
    member[start[cell[i] + 1]++] = (uint32_t)i;

  for (size_t i = 0; i < n; i++) {
    if (append_partners(nb, &g, start, member, i, x, stride, radius, reach) !=
        GSL_SUCCESS) {
      nb->count = 0;
      return GSL_ENOMEM;
    }
    nb->first[i + 1] = nb->count;
  }
  return GSL_SUCCESS;
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
  free(nb->grid);
  *nb = (struct neighbors){0};
}
