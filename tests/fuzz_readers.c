/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Feeds any bytes to the readers of all formats (make fuzz): they may refuse
   them, but not crash, hang, or give a frame that is none. What a frame holds,
   written as a bed, is read back bit for bit. */
#define _POSIX_C_SOURCE 200809L /* fmemopen, open_memstream */
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "files/formats.h"

#define REQUIRE(condition)                                                     \
  do {                                                                         \
    if (!(condition)) {                                                        \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);          \
      abort();                                                                 \
    }                                                                          \
  } while (0)

static const double fuzz_largest = 1e100;

static bool fuzz_same(const double *a, const double *b, size_t n) {
  return !n || !memcmp(a, b, n * sizeof *a);
}

static void fuzz_write_and_read(const struct bed *b) {
  static const struct bed_header none = {0};
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  REQUIRE(out);
  bed_write_frame(out, &none, b, true);
  bed_write_status(out, "ok");
  fclose(out);
  FILE *in = fmemopen(text, size, "r");
  REQUIRE(in);
  const struct bed_reader_options o = {.format = bed_format_named("bed")};
  struct bed_reader *r;
  struct bed c;
  REQUIRE(bed_reader_open(&r, in, "again", &o) == GSL_SUCCESS);
  REQUIRE(bed_reader_next(r, &c) == GSL_SUCCESS && c.n == b->n);
  REQUIRE(fuzz_same(&c.t, &b->t, 1) && fuzz_same(c.x, b->x, 3 * b->n));
  REQUIRE(fuzz_same(c.v, b->v, 3 * b->n) && fuzz_same(c.w, b->w, 3 * b->n));
  REQUIRE(fuzz_same(c.r, b->r, b->n) && fuzz_same(c.m, b->m, b->n));
  REQUIRE(!memcmp(c.id, b->id, b->n * sizeof *b->id));
  bed_free(&c);
  REQUIRE(bed_reader_next(r, &c) == GSL_EOF);
  bed_reader_close(r);
  fclose(in);
  free(text);
}

static void fuzz_check_frame(const struct bed *b, double largest) {
  REQUIRE(isfinite(b->t));
  for (size_t i = 0; i < b->n; i++) {
    REQUIRE(b->r[i] > 0 && b->r[i] <= largest);
    REQUIRE(b->m[i] > 0 && b->m[i] <= largest);
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
      REQUIRE(fabs(b->x[k]) <= largest);
      REQUIRE(fabs(b->v[k]) <= largest);
      REQUIRE(fabs(b->w[k]) <= largest);
    }
  }
  if (b->n && b->n < 200)
    fuzz_write_and_read(b);
}

/* Reads to the end; the status there, GSL_EOF or GSL_EINVAL. */
static int fuzz_read(const uint8_t *data, size_t size,
                     const struct bed_reader_options *o) {
  FILE *in = size ? fmemopen((void *)data, size, "r") : fopen("/dev/null", "r");
  REQUIRE(in);
  struct bed_reader *r;
  REQUIRE(bed_reader_open(&r, in, "file", o) == GSL_SUCCESS);
  struct bed b;
  int status;
  while ((status = bed_reader_next(r, &b)) == GSL_SUCCESS) {
    REQUIRE(b.n || o->may_be_empty);
    REQUIRE(b.n <= size); /* a row takes a byte and more */
    fuzz_check_frame(&b, o->largest > 0 ? o->largest : HUGE_VAL);
    bed_free(&b);
  }
  REQUIRE(status == GSL_EOF || status == GSL_EINVAL);
  if (bed_reader_note(r))
    REQUIRE(!strncmp(bed_reader_note(r), "file:", 5));
  if (status == GSL_EINVAL) {
    const char *error = bed_reader_error(r);
    REQUIRE(!strncmp(error, "file:", 5) && !strpbrk(error, "\n\r\033"));
  }
  bed_reader_close(r);
  fclose(in);
  return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const struct bed_reader_options plain = {.largest = fuzz_largest},
                                  lenient = {.allow_partial = true,
                                             .may_be_empty = true,
                                             .radius = 0.1,
                                             .largest = fuzz_largest},
                                  bed = {.format = bed_format_named("bed")};
  const int strict = fuzz_read(data, size, &plain);
  /* what is taken as it is, is taken when less is asked for */
  const int partial = fuzz_read(data, size, &lenient);
  REQUIRE(strict != GSL_EOF || partial == GSL_EOF);
  fuzz_read(data, size, &bed);
  static struct columns columns;
  if (!columns.count)
    REQUIRE(columns_of_list(&columns, "-,x,y,z,r") == GSL_SUCCESS);
  const struct bed_reader_options listed = {.largest = fuzz_largest,
                                            .columns = &columns};
  fuzz_read(data, size, &listed);
  return 0;
}
