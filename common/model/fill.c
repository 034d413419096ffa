/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/fill.h"

#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>

int fill_grid(const struct fill *f, struct bed *b) {
  const double spacing = 2.5 * f->radius;
  size_t across[2];
  for (int k = 0; k < 2; k++) {
    /* 1 m / 0.25 m is 4 whatever the rounding */
    const double fit = floor(f->base[k] / spacing * (1 + 1e-12));
    if (fit < 1 || fit > 1e6)
      return GSL_EINVAL;
    across[k] = (size_t)fit;
  }
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng || bed_alloc(b, f->count) != GSL_SUCCESS) {
    gsl_rng_free(rng);
    return GSL_ENOMEM;
  }
  gsl_rng_set(rng, (unsigned long)f->seed);
  const size_t layer = across[0] * across[1];
  for (size_t i = 0; i < f->count; i++) {
    const size_t in_layer = i % layer;
    double *x = b->x + 3 * i;
    x[0] = ((double)(in_layer % across[0]) + 0.5) * spacing;
    x[1] = ((double)(in_layer / across[0]) + 0.5) * spacing;
    x[2] = f->drop + ((double)(i / layer) + 0.5) * spacing;
    for (int k = 0; k < 3; k++)
      x[k] += f->jitter * f->radius * gsl_rng_uniform(rng);
    b->r[i] = f->radius;
    b->m[i] = f->mass;
  }
  gsl_rng_free(rng);
  return GSL_SUCCESS;
}
