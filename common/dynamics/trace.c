/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/trace.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "steppers/hermite.h"

/* The end of a row's step; its state and rates are in values. */
struct moment {
  double t;
  uint32_t row;
};

/* In the place of a row. */
#define ERASED UINT32_MAX

struct trace {
  const struct contact_list *whole;
  size_t count, size;
  struct moment *at;
  double *values; /* 2 * stride each */
  size_t *last;   /* of each row, for trace_at: count where there is none */
};

int trace_alloc(struct trace **out, const struct contact_list *whole) {
  struct trace *r = calloc(1, sizeof *r);
  if (!r)
    return GSL_ENOMEM;
  r->whole = whole;
  r->last = calloc(whole->rows, sizeof *r->last);
  if (!r->last) {
    trace_free(r);
    return GSL_ENOMEM;
  }
  *out = r;
  return GSL_SUCCESS;
}

void trace_free(struct trace *r) {
  if (!r)
    return;
  free(r->at);
  free(r->values);
  free(r->last);
  free(r);
}

size_t trace_mark(const struct trace *r) {
  return r->count;
}

void trace_cut(struct trace *r, size_t mark) {
  r->count = mark;
}

void trace_erase(struct trace *r, size_t from, size_t to) {
  for (size_t k = from; k < to; k++)
    r->at[k].row = ERASED;
}

static int reserve(struct trace *r, size_t count) {
  if (count <= r->size)
    return GSL_SUCCESS;
  const size_t size = 2 * count;
  struct moment *at = realloc(r->at, size * sizeof *at);
  if (!at)
    return GSL_ENOMEM;
  r->at = at;
  double *values =
      realloc(r->values, 2 * r->whole->stride * size * sizeof *values);
  if (!values)
    return GSL_ENOMEM;
  r->values = values;
  r->size = size;
  return GSL_SUCCESS;
}

int trace_append(struct trace *r, const struct level *l, double t) {
  const size_t stride = l->stride, bytes = stride * sizeof(double);
  if (reserve(r, r->count + l->rows) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t i = 0; i < l->rows; i++) {
    if (l->refined[i])
      continue;
    const double *y = l->y0 + i * stride;
    double *value = r->values + 2 * stride * r->count;
    r->at[r->count++] = (struct moment){t, l->whole[i]};
    memcpy(value, y, bytes);
    memcpy(value + stride, l->f0 + i * stride, bytes);
  }
  return GSL_SUCCESS;
}

void trace_at(const struct trace *r, double t0, const double y0[],
              const double f0[], double t, double y[]) {
  const size_t stride = r->whole->stride;
  for (size_t i = 0; i < r->whole->rows; i++)
    r->last[i] = r->count;
  for (size_t k = 0; k < r->count; k++) { /* in order of time for each row */
    if (r->at[k].row == ERASED)
      continue;
    const size_t row = r->at[k].row, before = r->last[row];
    const bool first = before == r->count;
    const double begin = first ? t0 : r->at[before].t, end = r->at[k].t;
    r->last[row] = k;
    if (!(t >= begin && t <= end))
      continue;
    const double *a =
        first ? y0 + row * stride : r->values + 2 * stride * before;
    const double *fa = first ? f0 + row * stride : a + stride;
    const double *b = r->values + 2 * stride * k, *fb = b + stride;
    const struct hermite w =
        hermite_at((t - begin) / (end - begin), end - begin);
    for (size_t c = 0; c < stride; c++)
      y[row * stride + c] = hermite_value(&w, a[c], fa[c], b[c], fb[c]);
  }
}

void trace_steps(const struct trace *r, size_t steps[]) {
  for (size_t k = 0; k < r->count; k++)
    if (r->at[k].row != ERASED)
      steps[r->at[k].row]++;
}
