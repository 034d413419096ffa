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
  for (size_t i = 0; i < b->n; i++) {
    const size_t in_layer = i % layer;
    double *x = b->x + 3 * i;
    x[0] = ((double)(in_layer % across[0]) + 0.5) * spacing;
    x[1] = ((double)(in_layer / across[0]) + 0.5) * spacing;
    x[2] = f->drop + ((double)(i / layer) + 0.5) * spacing;
    for (int k = 0; k < 3; k++)
      x[k] += f->jitter * radius * gsl_rng_uniform(rng);
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
