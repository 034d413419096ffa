/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/periodic.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

void periodic_images_free(struct periodic_images *m) {
  free(m->x);
  free(m->radius);
  free(m->of);
  *m = (struct periodic_images){0};
}

static int append(struct periodic_images *m, const double x[3], double radius,
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

static int append_moved(struct periodic_images *m, size_t n,
                        const double period[3], double margin,
                        const int move[3]) {
  for (size_t i = 0; i < n; i++) {
    double x[3];
    bool near = true;
    for (size_t k = 0; k < 3; k++) {
      x[k] = m->x[3 * i + k] + move[k] * period[k];
      near =
          near && (!move[k] || (x[k] >= -margin && x[k] <= period[k] + margin));
    }
    if (near && append(m, x, m->radius[i], (uint32_t)i) != GSL_SUCCESS)
      return GSL_ENOMEM;
  }
  return GSL_SUCCESS;
}

/* After the spheres, which are in the cell, those images of them that lie
   within `margin` of it on one side of each axis: of two spheres one has an
   image near the other. */
static int append_images(struct periodic_images *m, double margin,
                         const double period[3]) {
  const size_t n = m->count;
  int most[3] = {0}, move[3];
  double images = (double)n;
  for (int k = 0; k < 3; k++)
    if (period[k] > 0) {
      const double moves = ceil(margin / period[k]);
      images *= 2 * moves + 1;
      if (!(images < UINT32_MAX))
        return GSL_ENOMEM;
      most[k] = (int)moves;
    }
  for (move[0] = -most[0]; move[0] <= most[0]; move[0]++)
    for (move[1] = -most[1]; move[1] <= most[1]; move[1]++)
      for (move[2] = -most[2]; move[2] <= most[2]; move[2]++)
        if (is_half(move) &&
            append_moved(m, n, period, margin, move) != GSL_SUCCESS)
          return GSL_ENOMEM;
  return GSL_SUCCESS;
}

/* The spheres, in the cell. radius: NULL: points. */
static int append_spheres(struct periodic_images *m, size_t n, const double *x,
                          size_t stride, const double *radius,
                          const double period[3]) {
  if (n > UINT32_MAX - 1)
    return GSL_EINVAL;
  for (size_t i = 0; i < n; i++) {
    double at[3];
    memcpy(at, x + i * stride, sizeof at);
    periodic_wrap(period, at);
    if (append(m, at, radius ? radius[i] : 0, (uint32_t)i) != GSL_SUCCESS)
      return GSL_ENOMEM;
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
static int take_pairs(struct neighbors *nb, size_t n,
                      const struct periodic_images *m) {
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
  struct periodic_images m = {0};
  double largest = 0;
  for (size_t i = 0; i < n; i++)
    largest = GSL_MAX(largest, radius[i]);
  int status = append_spheres(&m, n, x, stride, radius, period);
  if (status == GSL_SUCCESS)
    status = append_images(&m, 2 * largest + reach, period);
  if (status == GSL_SUCCESS)
    status = neighbors_find(nb, m.count, m.x, 3, m.radius, reach);
  if (status == GSL_SUCCESS)
    status = take_pairs(nb, n, &m);
  if (status != GSL_SUCCESS)
    nb->count = 0;
  periodic_images_free(&m);
  return status;
}

/* Images of a box that a search or a volume can bear. */
static const double most_images = 1e7;

/* How often the ball may be moved by whole periods along an axis so that it
   still reaches into the box: from least to most. */
static void image_range(double x, double r, double period, const double side[2],
                        double *least, double *most) {
  *least = *most = 0;
  if (!(period > 0))
    return;
  *least = floor((side[0] - r - x) / period) + 1;
  *most = ceil((side[1] + r - x) / period) - 1;
}

/* Those of sphere i. */
static int append_in_box(struct periodic_images *m, size_t i, const double *x,
                         double radius, const double period[3],
                         const double box[6]) {
  double least[3], most[3], move[3], images = (double)m->count;
  double more = 1;
  for (int k = 0; k < 3; k++) {
    image_range(x[k], radius, period[k], box + 2 * k, &least[k], &most[k]);
    more *= GSL_MAX(0, most[k] - least[k] + 1);
  }
  if (!(images + more <= most_images))
    return GSL_ERANGE;
  for (move[0] = least[0]; move[0] <= most[0]; move[0]++)
    for (move[1] = least[1]; move[1] <= most[1]; move[1]++)
      for (move[2] = least[2]; move[2] <= most[2]; move[2]++) {
        const double at[3] = {x[0] + move[0] * period[0],
                              x[1] + move[1] * period[1],
                              x[2] + move[2] * period[2]};
        if (append(m, at, radius, (uint32_t)i) != GSL_SUCCESS)
          return GSL_ENOMEM;
      }
  return GSL_SUCCESS;
}

int periodic_images_in_box(struct periodic_images *m, size_t n, const double *x,
                           const double *radius, const double period[3],
                           const double box[6]) {
  m->count = 0;
  int status = GSL_SUCCESS;
  for (size_t i = 0; i < n && status == GSL_SUCCESS; i++)
    status = append_in_box(m, i, x + 3 * i, radius[i], period, box);
  return status;
}

int periodic_pairs_find(struct periodic_pairs *p, size_t n, const double *x,
                        double reach, const double period[3]) {
  p->n = n;
  p->images.count = 0;
  int status = append_spheres(&p->images, n, x, 3, NULL, period);
  if (status == GSL_SUCCESS)
    status = append_images(&p->images, reach, period);
  if (status == GSL_SUCCESS)
    status = neighbors_find(&p->near, p->images.count, p->images.x, 3,
                            p->images.radius, reach);
  return status;
}

void periodic_pairs_free(struct periodic_pairs *p) {
  periodic_images_free(&p->images);
  neighbors_free(&p->near);
}
