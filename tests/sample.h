/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests' random cases are made of. */
#ifndef SAMPLE_H
#define SAMPLE_H

#include <stdlib.h>
#include <gsl/gsl_rng.h>

/* n zeros, at least one of them in memory of its own; to be freed. */
static inline double *numbers(size_t n) {
  double *x = calloc(n ? n : 1, sizeof *x);
  if (!x)
    abort();
  return x;
}

/* Evenly distributed from a to b. */
static inline double uniform(gsl_rng *rng, double a, double b) {
  return a + (b - a) * gsl_rng_uniform(rng);
}

#endif
