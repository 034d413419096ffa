/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "files/bed_io.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/columns.h"
#include "files/numbers.h"
#include "files/sheet.h"

/* Header */

int bed_header_add(struct bed_header *h, const char *name, const char *value) {
  if (h->count == h->size) {
    const size_t size = 2 * h->size + 16;
    struct bed_key *at = realloc(h->at, size * sizeof *at);
    if (!at)
      return GSL_ENOMEM;
    h->at = at;
    h->size = size;
  }
  struct bed_key key = {strdup(name), strdup(value)};
  if (!key.name || !key.value) {
    free(key.name);
    free(key.value);
    return GSL_ENOMEM;
  }
  h->at[h->count++] = key;
  return GSL_SUCCESS;
}

static struct bed_key *find_key(const struct bed_header *h, const char *name) {
  for (size_t k = 0; k < h->count; k++)
    if (!strcmp(h->at[k].name, name))
      return &h->at[k];
  return NULL;
}

int bed_header_set(struct bed_header *h, const char *name, const char *value) {
  struct bed_key *key = find_key(h, name);
  if (!key)
    return bed_header_add(h, name, value);
  char *copy = strdup(value);
  if (!copy)
    return GSL_ENOMEM;
  free(key->value);
  key->value = copy;
  return GSL_SUCCESS;
}

const char *bed_header_get(const struct bed_header *h, const char *name) {
  const struct bed_key *key = find_key(h, name);
  return key ? key->value : NULL;
}

void bed_header_remove(struct bed_header *h, const char *name) {
  size_t kept = 0;
  for (size_t k = 0; k < h->count; k++) {
    if (strcmp(h->at[k].name, name)) {
      h->at[kept++] = h->at[k];
      continue;
    }
    free(h->at[k].name);
    free(h->at[k].value);
  }
  h->count = kept;
}

void bed_header_free(struct bed_header *h) {
  for (size_t k = 0; k < h->count; k++) {
    free(h->at[k].name);
    free(h->at[k].value);
  }
  free(h->at);
  *h = (struct bed_header){0};
}

void bed_header_store(struct bed_header *h, struct store *s) {
  size_t count = h->count;
  store_part(s, "header");
  store_size(s, &count);
  for (size_t k = 0; k < count && store_status(s) == GSL_SUCCESS; k++) {
    char *name = s->loads ? NULL : h->at[k].name;
    char *value = s->loads ? NULL : h->at[k].value;
    store_text(s, &name);
    store_text(s, &value);
    if (!s->loads)
      continue;
    if (name && value)
      store_fail(s, bed_header_add(h, name, value));
    free(name);
    free(value);
  }
}

/* Writer */

static void put_names(struct sheet *s, bool spin, bool fixed) {
  sheet_text(s, column_name(COLUMN_ID));
  for (int c = COLUMN_X; c <= (spin ? COLUMN_WZ : COLUMN_VZ); c++) {
    if (c == COLUMN_D)
      continue;
    sheet_text(s, "\t");
    sheet_text(s, column_name((enum column)c));
  }
  sheet_text(s, fixed ? "\tfixed\n" : "\n");
}

static void put_row(struct sheet *s, const struct bed *b, size_t i, bool spin) {
  const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
  const double row[] = {x[0], x[1], x[2], b->r[i], b->m[i], v[0],
                        v[1], v[2], w[0], w[1],    w[2]};
  char id[NUMBER_SIZE];
  snprintf(id, sizeof id, "%ld", b->id[i]);
  sheet_text(s, id);
  sheet_numbers(s, '\t', spin ? 11 : 8, row);
  sheet_text(s, !b->fixed ? "\n" : b->fixed[i] ? "\t1\n" : "\t0\n");
}

static void write_header(FILE *out, const struct bed_header *h) {
  struct sheet s = sheet_begin(out);
  for (size_t k = 0; k < h->count; k++) {
    const struct bed_key *key = &h->at[k];
    if (!strcmp(key->name, "t") || !strcmp(key->name, "status"))
      continue;
    sheet_text(&s, "# ");
    sheet_text(&s, key->name);
    sheet_text(&s, "=");
    sheet_text(&s, key->value);
    sheet_text(&s, "\n");
  }
  sheet_end(&s);
}

void bed_write_frame(FILE *out, const struct bed_header *h, const struct bed *b,
                     bool spin) {
  if (h->count)
    write_header(out, h);
  struct sheet s = sheet_begin(out);
  sheet_text(&s, "# t");
  sheet_numbers(&s, '=', 1, &b->t);
  sheet_text(&s, "\n");
  put_names(&s, spin, b->fixed != NULL);
  for (size_t i = 0; i < b->n; i++)
    put_row(&s, b, i, spin);
  sheet_end(&s);
}

void bed_write_gap(FILE *out) {
  fputs("\n\n", out);
}

void bed_write_status(FILE *out, const char *status) {
  fprintf(out, "# status=%s\n", status);
}
