/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/bed.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

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
  *b = (struct bed){0};
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
  return GSL_SUCCESS;
}
