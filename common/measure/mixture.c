/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/mixture.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_sort.h>

struct mixture mixture_of_edges(size_t edges, const double edge[]) {
  assert(edges < MIXTURE_MOST);
  struct mixture m = {.count = edges + 1};
  for (size_t k = 0; k <= edges; k++) {
    m.at[k].low = k ? edge[k - 1] : 0;
    m.at[k].high = k < edges ? edge[k] : GSL_POSINF;
  }
  return m;
}

/* Edges between different radii; MIXTURE_MOST if there are too many. */
static size_t edges_between(size_t n, const double sorted[],
                            double edge[MIXTURE_MOST]) {
  size_t edges = 0;
  for (size_t i = 1; i < n && edges < MIXTURE_MOST; i++)
    if (sorted[i] > sorted[i - 1])
      edge[edges++] = 0.5 * (sorted[i - 1] + sorted[i]);
  return edges;
}

/* Edges between parts of equal volume. */
static size_t edges_of_parts(size_t n, const double sorted[],
                             double edge[MIXTURE_MOST]) {
  double all = 0, below = 0;
  size_t edges = 0;
  for (size_t i = 0; i < n; i++)
    all += gsl_pow_3(sorted[i]);
  for (size_t i = 0; i < n && edges + 1 < MIXTURE_PARTS; i++) {
    below += gsl_pow_3(sorted[i]);
    if (below * MIXTURE_PARTS > all * ((double)edges + 1) &&
        (edges == 0 || sorted[i] > edge[edges - 1]))
      edge[edges++] = sorted[i];
  }
  return edges;
}

int mixture_of_radii(const struct bed *b, struct mixture *m) {
  double edge[MIXTURE_MOST], *sorted = malloc((b->n + 1) * sizeof *sorted);
  if (!sorted)
    return GSL_ENOMEM;
  memcpy(sorted, b->r, b->n * sizeof *sorted);
  gsl_sort(sorted, 1, b->n);
  size_t edges = edges_between(b->n, sorted, edge);
  if (edges >= MIXTURE_MOST)
    edges = edges_of_parts(b->n, sorted, edge);
  free(sorted);
  *m = mixture_of_edges(edges, edge);
  return GSL_SUCCESS;
}

size_t mixture_find(const struct mixture *m, double radius) {
  size_t k = 0;
  while (k + 1 < m->count && !(radius < m->at[k].high))
    k++;
  return k;
}

static void add_contacts(struct mixture *m, const struct bed *b,
                         const bool *inside, const struct network *w) {
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    if (!c->counts)
      continue;
    const size_t i = mixture_find(m, b->r[c->i]);
    const size_t j = c->wall ? MIXTURE_MOST : mixture_find(m, b->r[c->j]);
    if (!inside || inside[c->i]) {
      m->at[i].z++;
      m->at[i].z_own += i == j;
      m->at[i].z_walls += c->wall;
    }
    if (!c->wall && (!inside || inside[c->j])) {
      m->at[j].z++;
      m->at[j].z_own += i == j;
    }
  }
  for (size_t k = 0; k < m->count; k++) {
    const double spheres = (double)m->at[k].spheres; /* 0/0 is NaN */
    m->at[k].z /= spheres;
    m->at[k].z_own /= spheres;
    m->at[k].z_walls /= spheres;
  }
}

void mixture_measure(struct mixture *m, const struct bed *b, const bool *inside,
                     const struct network *w) {
  double all = 0, height = 0, squares = 0, first[MIXTURE_MOST] = {0};
  for (size_t k = 0; k < m->count; k++)
    m->at[k] =
        (struct mixture_class){.low = m->at[k].low, .high = m->at[k].high};
  for (size_t i = 0; i < b->n; i++) {
    if (inside && !inside[i])
      continue;
    struct mixture_class *c = &m->at[mixture_find(m, b->r[i])];
    const double volume = gsl_pow_3(b->r[i]), z = b->x[3 * i + 2];
    if (c->spheres++ == 0)
      first[c - m->at] = b->r[i];
    c->radius += b->r[i] - first[c - m->at]; /* equal ones stay as they are */
    c->share += volume;
    c->height += volume * z;
    all += volume;
    height += volume * z;
  }
  height /= all;
  for (size_t i = 0; i < b->n; i++)
    if (!inside || inside[i])
      squares += gsl_pow_3(b->r[i]) * gsl_pow_2(b->x[3 * i + 2] - height);
  const double spread = sqrt(3 * squares / all);
  for (size_t k = 0; k < m->count; k++) {
    struct mixture_class *c = &m->at[k];
    c->radius =
        c->spheres ? first[k] + c->radius / (double)c->spheres : GSL_NAN;
    c->height /= c->share;
    c->share /= all;
    c->segregation = c->share < 1
                         ? (c->height - height) / ((1 - c->share) * spread)
                         : GSL_NAN;
  }
  if (w)
    add_contacts(m, b, inside, w);
}
