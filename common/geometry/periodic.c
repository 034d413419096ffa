/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/periodic.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Spheres in the cell, then those images of them that lie within `margin` of it
   on one side of each axis: of two spheres one has an image near the other. */
struct images {
  size_t count, size;
  double *x, *radius;
  uint32_t *of;
};

static void images_free(struct images *m) {
  free(m->x);
  free(m->radius);
  free(m->of);
}

static int append(struct images *m, const double x[3], double radius,
                  uint32_t of) {
  if (m->count == m->size) {
    const size_t size = m->size + m->size / 2 + 64;
    double *places = realloc(m->x, 3 * size * sizeof *places);
    if (places)
      m->x = places;
    double *radii = realloc(m->radius, size * sizeof *radii);
    if (radii)
      m->radius = radii;
    uint32_t *numbers = realloc(m->of, size * sizeof *numbers);
    if (numbers)
      m->of = numbers;
    if (!places || !radii || !numbers)
      return GSL_ENOMEM;
    m->size = size;
  }
  memcpy(m->x + 3 * m->count, x, 3 * sizeof *x);
  m->radius[m->count] = radius;
  m->of[m->count++] = of;
  return GSL_SUCCESS;
}

/* Moves by whole periods that make each pair of neighbours of cells once. */
static bool is_half(const int move[3]) {
  for (int k = 0; k < 3; k++)
    if (move[k])
      return move[k] > 0;
  return false;
}

static int append_images(struct images *m, size_t n, const double period[3],
                         double margin) {
  int move[3];
  for (move[0] = -1; move[0] <= 1; move[0]++)
    for (move[1] = -1; move[1] <= 1; move[1]++)
      for (move[2] = -1; move[2] <= 1; move[2]++) {
        bool wanted = is_half(move);
        for (int k = 0; k < 3; k++)
          wanted = wanted && (!move[k] || period[k] > 0);
        for (size_t i = 0; i < n && wanted; i++) {
          double x[3];
          bool near = true;
          for (size_t k = 0; k < 3; k++) {
            x[k] = m->x[3 * i + k] + move[k] * period[k];
            near = near && (!move[k] ||
                            (x[k] >= -margin && x[k] <= period[k] + margin));
          }
          if (near && append(m, x, m->radius[i], (uint32_t)i) != GSL_SUCCESS)
            return GSL_ENOMEM;
        }
      }
  return GSL_SUCCESS;
}

struct pair {
  uint32_t i, j;
};

static int compare_pairs(const void *a, const void *b) {
  const struct pair *p = a, *q = b;
  if (p->i != q->i)
    return p->i < q->i ? -1 : 1;
  return (p->j > q->j) - (p->j < q->j);
}

/* The pairs of a sphere with a sphere or an image, sorted, each once. */
static int take_pairs(struct neighbors *nb, size_t n, const struct images *m) {
  struct pair *pairs = malloc((nb->count + 1) * sizeof *pairs);
  size_t count = 0, at = 0;
  if (!pairs)
    return GSL_ENOMEM;
  for (size_t p = 0; p < nb->count; p++) {
    const uint32_t i = nb->i[p], j = m->of[nb->j[p]];
    if (i < n && i != j)
      pairs[count++] = (struct pair){GSL_MIN(i, j), GSL_MAX(i, j)};
  }
  qsort(pairs, count, sizeof *pairs, compare_pairs);
  nb->count = 0;
  for (size_t i = 0; i <= n; i++) {
    nb->first[i] = nb->count;
    for (; i < n && at < count && pairs[at].i == i; at++) {
      if (at && !compare_pairs(&pairs[at], &pairs[at - 1]))
        continue;
      nb->i[nb->count] = pairs[at].i;
      nb->j[nb->count++] = pairs[at].j;
    }
  }
  free(pairs);
  return GSL_SUCCESS;
}

int periodic_find(struct neighbors *nb, size_t n, const double *x,
                  size_t stride, const double *radius, double reach,
                  const double period[3]) {
  if (!periodic_any(period))
    return neighbors_find(nb, n, x, stride, radius, reach);
  struct images m = {0};
  double largest = 0;
  int status = GSL_SUCCESS;
  for (size_t i = 0; i < n && status == GSL_SUCCESS; i++) {
    double at[3];
    memcpy(at, x + i * stride, sizeof at);
    periodic_wrap(period, at);
    largest = GSL_MAX(largest, radius[i]);
    status = append(&m, at, radius[i], (uint32_t)i);
  }
  if (status == GSL_SUCCESS)
    status = append_images(&m, n, period, 2 * largest + reach);
  if (status == GSL_SUCCESS)
    status = neighbors_find(nb, m.count, m.x, 3, m.radius, reach);
  if (status == GSL_SUCCESS)
    status = take_pairs(nb, n, &m);
  if (status != GSL_SUCCESS)
    nb->count = 0;
  images_free(&m);
  return status;
}
