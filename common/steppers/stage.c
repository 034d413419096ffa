/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "steppers/stage.h"

#include "platform/multiversion.h"

MULTIVERSION
static void combine(const struct stage *s, size_t count,
                    const double *restrict start, const double *restrict rate,
                    const double *restrict y, const double *restrict f,
                    double *restrict out) {
  const double a = s->of_start, b = s->of_y, c = s->of_out, m = s->of_f,
               g = s->of_rate;
#pragma omp simd
  for (size_t i = 0; i < count; i++)
    out[i] = a * start[i] + b * y[i] + c * out[i] + m * f[i] + g * rate[i];
}

void stage_combine(const struct stage *s, size_t at, size_t count,
                   const double y[], const double f[], double out[]) {
  combine(s, count, s->start + at, s->rate + at, y + at, f, out + at);
}

MULTIVERSION
static void move(size_t n, double h, const double *restrict y,
                 const double *restrict f, double *restrict out) {
#pragma omp simd
  for (size_t i = 0; i < n; i++)
    out[i] = y[i] + h * f[i];
}

void stage_move(size_t n, double h, const double y[], const double f[],
                double out[]) {
  move(n, h, y, f, out);
}
