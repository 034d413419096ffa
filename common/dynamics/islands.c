/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/islands.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

void islands_free(struct islands *s) {
  free(s->begin);
  free(s->row);
  free(s->seen);
  *s = (struct islands){0};
}

static int reserve(struct islands *s, size_t rows) {
  if (rows <= s->room)
    return GSL_SUCCESS;
  islands_free(s);
  s->begin = calloc(rows + 1, sizeof *s->begin);
  s->row = calloc(rows, sizeof *s->row);
  s->seen = calloc(rows, sizeof *s->seen);
  if (!s->begin || !s->row || !s->seen) {
    islands_free(s);
    return GSL_ENOMEM;
  }
  s->room = rows;
  return GSL_SUCCESS;
}

static int ascending(const void *a, const void *b) {
  const uint32_t i = *(const uint32_t *)a, j = *(const uint32_t *)b;
  return (i > j) - (i < j);
}

/* Adds first and all that it is connected to, from row[at] on; returns the
   end. */
static size_t spread(struct islands *s, const struct contact_list *l,
                     const bool *marked, const struct contact_reach *reach,
                     uint32_t first, size_t at) {
  size_t end = at;
  s->row[end++] = first;
  s->seen[first] = true;
  for (size_t q = at; q < end; q++) {
    const uint32_t i = s->row[q];
    for (size_t p = l->partner_first[i]; p < l->partner_first[i + 1]; p++) {
      const uint32_t j = l->partner[p];
      if (j < l->rows && marked[j] && !s->seen[j] &&
          contact_subset_within(l, i, j, reach)) {
        s->row[end++] = j;
        s->seen[j] = true;
      }
    }
  }
  if (end - at > 1)
    qsort(s->row + at, end - at, sizeof *s->row, ascending);
  return end;
}

int islands_find(struct islands *s, struct contact_list *l, const bool marked[],
                 const struct contact_reach *reach) {
  if (reserve(s, l->rows) != GSL_SUCCESS ||
      contact_list_partners(l) != GSL_SUCCESS)
    return GSL_ENOMEM;
  size_t end = 0;
  s->count = 0;
  s->begin[0] = 0;
  for (size_t i = 0; i < l->rows; i++)
    if (marked[i] && !s->seen[i]) {
      end = spread(s, l, marked, reach, (uint32_t)i, end);
      s->begin[++s->count] = end;
    }
  for (size_t q = 0; q < end; q++)
    s->seen[s->row[q]] = false;
  return GSL_SUCCESS;
}
