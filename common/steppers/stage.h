/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A stage of a Runge-Kutta method together with the right-hand side that it
   needs. A system that can do both in one pass keeps the derivative, a few rows
   at a time, in the cache instead of writing it to memory and reading it
   back. Not in the paper. Tested in tests/test_dynamics.c. */
#ifndef STAGE_H
#define STAGE_H

#include <stddef.h>

/* out <- of_start start + of_rate rate + of_y y + of_out out + of_f f(t, y) */
struct stage {
  const double *start, *rate;
  double of_start, of_rate, of_y, of_out, of_f;
};

/* Not over y. Returns what the right-hand side would; on an error out is
   undefined. */
typedef int stage_function(double t, const double y[], const struct stage *s,
                           double out[], void *params);

/* Components [at, at + count) of out, given those of the derivative in
   f[0..count). Safe in any thread. */
void stage_combine(const struct stage *s, size_t at, size_t count,
                   const double y[], const double f[], double out[]);

/* out = y + h f of n components. Safe in any thread. */
void stage_move(size_t n, double h, const double y[], const double f[],
                double out[]);

#endif
