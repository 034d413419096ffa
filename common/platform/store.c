/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "platform/store.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

enum { LONGEST_NAME = 63, LONGEST_TEXT = 1 << 20 };

struct store store_saving(FILE *stream) {
  return (struct store){
      .stream = stream, .part = "start", .sum = checksum_begin()};
}

struct store store_loading(FILE *stream) {
  struct store s = store_saving(stream);
  s.loads = true;
  return s;
}

int store_status(const struct store *s) {
  return s->status;
}

void store_fail(struct store *s, int status) {
  if (s->status == GSL_SUCCESS)
    s->status = status;
}

void store_bytes(struct store *s, void *bytes, size_t count) {
  if (s->status != GSL_SUCCESS || !count)
    return;
  const size_t done = s->loads ? fread(bytes, 1, count, s->stream)
                               : fwrite(bytes, 1, count, s->stream);
  if (done == count)
    checksum_add(&s->sum, bytes, count);
  else
    store_fail(s, GSL_EFAILED);
}

void store_double(struct store *s, double *x) {
  store_bytes(s, x, sizeof *x);
}

void store_size(struct store *s, size_t *n) {
  uint64_t wide = *n;
  store_bytes(s, &wide, sizeof wide);
  if (s->status != GSL_SUCCESS)
    return;
  if (wide > SIZE_MAX)
    store_fail(s, GSL_EINVAL);
  else
    *n = (size_t)wide;
}

void store_flag(struct store *s, bool *flag) {
  unsigned char byte = *flag;
  store_bytes(s, &byte, 1);
  if (s->status != GSL_SUCCESS)
    return;
  if (byte > 1)
    store_fail(s, GSL_EINVAL);
  else
    *flag = byte;
}

/* A number that has to be the same. */
static void store_same(struct store *s, size_t n) {
  size_t found = n;
  store_size(s, &found);
  if (found != n)
    store_fail(s, GSL_EINVAL);
}

void store_plain(struct store *s, void *plain, size_t size) {
  store_same(s, size);
  store_bytes(s, plain, size);
}

void store_part(struct store *s, const char *name) {
  char found[LONGEST_NAME + 1] = "";
  const size_t length = strlen(name);
  assert(length <= LONGEST_NAME);
  if (s->status == GSL_SUCCESS)
    s->part = name;
  strcpy(found, name);
  store_same(s, length);
  store_bytes(s, found, length);
  if (s->status == GSL_SUCCESS && strcmp(found, name))
    store_fail(s, GSL_EINVAL);
}

void store_doubles(struct store *s, double x[], size_t count) {
  store_same(s, count);
  store_bytes(s, x, count * sizeof *x);
}

void store_sizes(struct store *s, size_t n[], size_t count) {
  store_same(s, count);
  for (size_t k = 0; k < count; k++)
    store_size(s, &n[k]);
}

void store_flags(struct store *s, bool flag[], size_t count) {
  store_same(s, count);
  for (size_t k = 0; k < count; k++)
    store_flag(s, &flag[k]);
}

void store_text(struct store *s, char **text) {
  bool there = !s->loads && *text;
  size_t length = there ? strlen(*text) : 0;
  store_flag(s, &there);
  store_size(s, &length);
  if (length > LONGEST_TEXT)
    store_fail(s, GSL_EINVAL);
  if (s->status != GSL_SUCCESS)
    return;
  if (!s->loads) {
    store_bytes(s, *text, length);
    return;
  }
  char *found = NULL;
  if (there && !(found = calloc(length + 1, 1)))
    store_fail(s, GSL_ENOMEM);
  if (found)
    store_bytes(s, found, length);
  if (s->status == GSL_SUCCESS)
    *text = found;
  else
    free(found);
}
