/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/bed.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_statistics.h>

int bed_alloc(struct bed *b, size_t n) {
  const size_t room = n ? n : 1; /* calloc(0) may be NULL */
  *b = (struct bed){.n = n,
                    .id = calloc(room, sizeof *b->id),
                    .x = calloc(room, 3 * sizeof(double)),
                    .v = calloc(room, 3 * sizeof(double)),
                    .w = calloc(room, 3 * sizeof(double)),
                    .r = calloc(room, sizeof(double)),
                    .m = calloc(room, sizeof(double))};
  if (!b->id || !b->x || !b->v || !b->w || !b->r || !b->m) {
    bed_free(b);
    return GSL_ENOMEM;
  }
  for (size_t i = 0; i < n; i++) {
    b->id[i] = (long)i;
    b->m[i] = 1;
  }
  return GSL_SUCCESS;
}

void bed_free(struct bed *b) {
  free(b->id);
  free(b->x);
  free(b->v);
  free(b->w);
  free(b->r);
  free(b->m);
  free(b->fixed);
  *b = (struct bed){0};
}

int bed_fix_none(struct bed *b) {
  if (!b->fixed)
    b->fixed = calloc(b->n ? b->n : 1, sizeof *b->fixed);
  return b->fixed ? GSL_SUCCESS : GSL_ENOMEM;
}

double bed_mean(const struct bed *b, const double x[]) {
  double mean = 0, least = GSL_POSINF, most = GSL_NEGINF;
  size_t count = 0;
  for (size_t i = 0; i < b->n; i++)
    if (!bed_is_fixed(b, i)) {
      least = GSL_MIN(least, x[i]);
      most = GSL_MAX(most, x[i]);
      mean += (x[i] - mean) / (double)++count;
    }
  if (count > 0 && least == most)
    return least;
  /* more precise, and so the same for the same spheres in another order */
  return b->fixed && count > 0 ? mean : gsl_stats_mean(x, 1, b->n);
}

int bed_copy(struct bed *to, const struct bed *from) {
  const size_t n = from->n;
  if (bed_alloc(to, n) != GSL_SUCCESS)
    return GSL_ENOMEM;
  to->t = from->t;
  memcpy(to->id, from->id, n * sizeof *to->id);
  memcpy(to->x, from->x, 3 * n * sizeof *to->x);
  memcpy(to->v, from->v, 3 * n * sizeof *to->v);
  memcpy(to->w, from->w, 3 * n * sizeof *to->w);
  memcpy(to->r, from->r, n * sizeof *to->r);
  memcpy(to->m, from->m, n * sizeof *to->m);
  if (from->fixed) {
    if (bed_fix_none(to) != GSL_SUCCESS) {
      bed_free(to);
      return GSL_ENOMEM;
    }
    memcpy(to->fixed, from->fixed, n * sizeof *to->fixed);
  }
  return GSL_SUCCESS;
}

void bed_store(struct bed *b, struct store *s) {
  struct stored {
    double t;
    size_t n;
    void *columns[7];
  };
  _Static_assert(sizeof(struct bed) == sizeof(struct stored),
                 "what is new in a bed is to be stored");
  size_t n = b->n;
  store_part(s, "bed");
  store_size(s, &n);
  if (store_status(s) == GSL_SUCCESS && s->loads)
    store_fail(s, bed_alloc(b, n));
  store_double(s, &b->t);
  for (size_t i = 0; i < n && store_status(s) == GSL_SUCCESS; i++) {
    int64_t id = b->id[i];
    store_bytes(s, &id, sizeof id);
    b->id[i] = (long)id;
  }
  double *const vectors[] = {b->x, b->v, b->w};
  for (size_t k = 0; k < 3; k++)
    store_doubles(s, vectors[k], 3 * n);
  store_doubles(s, b->r, n);
  store_doubles(s, b->m, n);
  bool has_fixed = b->fixed != NULL;
  store_flag(s, &has_fixed);
  if (has_fixed && s->loads && store_status(s) == GSL_SUCCESS)
    store_fail(s, bed_fix_none(b));
  if (has_fixed)
    store_flags(s, b->fixed, n);
}
