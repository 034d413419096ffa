/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/fill.h"

#include <math.h>
#include <stdbool.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics.h>

/* Spheres across the base in each direction; false if there is none. */
static bool count_across(const struct fill *f, double spacing,
                         size_t across[2]) {
  for (int k = 0; k < 2; k++) {
    /* 1 m / 0.25 m is 4 whatever the rounding */
    const double fit = floor(f->base[k] / spacing * (1 + 1e-12));
    if (fit < 1 || fit > 1e6)
      return false;
    across[k] = (size_t)fit;
  }
  return true;
}

/* Parts of a place that a sphere needs one of, along each side. */
enum { MOST_PARTS = 100 };

static size_t parts_of(double largest, double radius) {
  const double fit = floor(largest / radius * (1 + 1e-12));
  return (size_t)fmin(fit, MOST_PARTS);
}

/* The place of the grid that spheres of one size are being put into. */
struct place {
  size_t number, used, room; /* parts used, and parts that fit */
};

/* The number of the place that has the next part, and which it is. */
static size_t take_part(struct place *p, size_t m, size_t *places,
                        size_t part[3]) {
  if (p->used == p->room)
    *p = (struct place){.number = (*places)++, .room = m * m * m};
  part[0] = p->used % m;
  part[1] = p->used / m % m;
  part[2] = p->used / (m * m);
  p->used++;
  return p->number;
}

int fill_grid_of(const struct fill *f, struct bed *b) {
  const double radius = gsl_stats_max(b->r, 1, b->n), spacing = 2.5 * radius;
  size_t across[2];
  if (!count_across(f, spacing, across))
    return GSL_EINVAL;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  gsl_rng_set(rng, (unsigned long)f->seed);
  const size_t layer = across[0] * across[1];
  struct place open[MOST_PARTS + 1] = {{0}};
  size_t places = 0;
  for (size_t i = 0; i < b->n; i++) {
    const size_t m = parts_of(radius, b->r[i]);
    size_t part[3];
    const size_t at = take_part(&open[m], m, &places, part);
    const size_t in_layer = at % layer;
    const double own = (double)m;
    double *x = b->x + 3 * i;
    x[0] = ((double)(in_layer % across[0]) + ((double)part[0] + 0.5) / own) *
           spacing;
    x[1] = ((double)(in_layer / across[0]) + ((double)part[1] + 0.5) / own) *
           spacing;
    x[2] = f->drop +
           ((double)(at / layer) + ((double)part[2] + 0.5) / own) * spacing;
    for (int k = 0; k < 3; k++)
      x[k] += f->jitter * radius / own * gsl_rng_uniform(rng);
  }
  gsl_rng_free(rng);
  return GSL_SUCCESS;
}

int fill_grid(const struct fill *f, struct bed *b) {
  struct bed full;
  int status = bed_alloc(&full, f->count);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < full.n; i++) {
    full.r[i] = f->radius;
    full.m[i] = f->mass;
  }
  status = fill_grid_of(f, &full);
  if (status != GSL_SUCCESS) {
    bed_free(&full);
    return status;
  }
  *b = full;
  return GSL_SUCCESS;
}
