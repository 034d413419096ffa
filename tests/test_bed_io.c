/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bed format: what is written comes back bit for bit, and what is not a
   whole, well-formed file is refused with the line where it goes wrong. */
#define _POSIX_C_SOURCE 200809L /* fmemopen, open_memstream */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "files/formats.h"
#include "check.h"

/* --- a file in memory, read to its end -------------------------------------*/

enum { FRAMES = 8 };

struct reading {
  int status; /* GSL_EOF: all was read */
  size_t frames;
  struct bed bed[FRAMES];
  struct bed_reader *reader; /* for the header and the error */
  FILE *in;
};

static struct bed_reader *open_bed(FILE *in, const char *name,
                                   bool allow_partial) {
  const struct bed_reader_options o = {.allow_partial = allow_partial,
                                       .format = bed_format_named("bed")};
  struct bed_reader *r;
  if (bed_reader_open(&r, in, name, &o) != GSL_SUCCESS)
    abort();
  return r;
}

static struct reading read_bytes(const char *bytes, size_t size,
                                 bool allow_partial) {
  struct reading r = {.status = GSL_SUCCESS};
  /* fmemopen does not take an empty buffer */
  r.in = size ? fmemopen((void *)bytes, size, "r") : fopen("/dev/null", "r");
  r.reader = open_bed(r.in, "file", allow_partial);
  if (!r.in)
    abort();
  while (r.frames < FRAMES && r.status == GSL_SUCCESS) {
    r.status = bed_reader_next(r.reader, &r.bed[r.frames]);
    r.frames += r.status == GSL_SUCCESS;
  }
  return r;
}

static struct reading read_text(const char *text) {
  return read_bytes(text, strlen(text), false);
}

static void reading_free(struct reading *r) {
  for (size_t k = 0; k < r->frames; k++)
    bed_free(&r->bed[k]);
  bed_reader_close(r->reader);
  fclose(r->in);
}

static const char *key(const struct reading *r, const char *name) {
  const char *value = bed_header_get(bed_reader_header(r->reader), name);
  return value ? value : "(none)";
}

/* Writes frames of one header to memory; the caller frees the text. */
static char *write_text(const struct bed_header *h, size_t frames,
                        const struct bed *b, bool spin, const char *status) {
  static const struct bed_header none = {0};
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    abort();
  for (size_t k = 0; k < frames; k++) {
    if (k)
      bed_write_gap(out);
    bed_write_frame(out, k ? &none : h, &b[k], spin);
  }
  bed_write_status(out, status);
  CHECK(!ferror(out));
  fclose(out);
  return text;
}

static bool same_bits(const double *a, const double *b, size_t n) {
  return n == 0 || !memcmp(a, b, n * sizeof *a);
}

static bool same_bed(const struct bed *a, const struct bed *b, bool spin) {
  static const double zero[3] = {0};
  bool same = a->n == b->n && same_bits(&a->t, &b->t, 1) &&
              !memcmp(a->id, b->id, a->n * sizeof *a->id) &&
              same_bits(a->x, b->x, 3 * a->n) &&
              same_bits(a->v, b->v, 3 * a->n) && same_bits(a->r, b->r, a->n) &&
              same_bits(a->m, b->m, a->n);
  for (size_t i = 0; same && i < a->n; i++)
    same = same_bits(b->w + 3 * i, spin ? a->w + 3 * i : zero, 3);
  return same;
}

/* --- there and back --------------------------------------------------------*/

/* Any finite double, its bits drawn at random, now and then a special one. */
static double any_double(gsl_rng *rng) {
  static const double special[] = {
      0.0,     -0.0,    1e300,    -1e300,   5e-324,
      -5e-324, DBL_MIN, DBL_MAX,  -DBL_MAX, 1e-310,
      0.1,     1. / 3,  2.5e-308, 123456.0, 1 + DBL_EPSILON};
  if (gsl_rng_get(rng) % 4 == 0)
    return special[gsl_rng_uniform_int(rng, sizeof special / sizeof *special)];
  for (;;) {
    const uint64_t bits =
        (uint64_t)gsl_rng_get(rng) << 32 | (uint64_t)gsl_rng_get(rng);
    double x;
    memcpy(&x, &bits, sizeof x);
    if (isfinite(x))
      return x;
  }
}

static void random_bed(gsl_rng *rng, struct bed *b, size_t n) {
  CHECK(bed_alloc(b, n) == GSL_SUCCESS);
  b->t = any_double(rng);
  for (size_t u = 0; u < 3 * n; u++) {
    b->x[u] = any_double(rng);
    b->v[u] = any_double(rng);
    b->w[u] = any_double(rng);
  }
  /* whole numbers that a double holds, all different, in any order */
  static const long first[] = {-3, 9007199254740992L, -9007199254740992L, 0};
  for (size_t i = 0; i < n; i++) {
    b->id[i] = i < 4 ? first[i] : 7919 * ((long)(i * 31 % n) - 5) + 11;
    do
      b->r[i] = fabs(any_double(rng));
    while (b->r[i] == 0);
    do
      b->m[i] = fabs(any_double(rng));
    while (b->m[i] == 0);
  }
}

static void test_round_trip(gsl_rng *rng) {
  static const size_t sizes[] = {1, 2, 5, 64, 1000};
  for (unsigned long seed = 0; seed < 40; seed++) {
    gsl_rng_set(rng, seed);
    const bool spin = seed % 2;
    const size_t frames = 1 + seed % 4;
    struct bed b[4];
    struct bed_header h = {0};
    CHECK(bed_header_add(&h, "format", "bed-1") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "model", "rotation") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "my.own-key", "a = b, c; 1 2") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "wall", "0 0 0 0 0 -1") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "wall", "1 0 0 1 0 0") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "empty", "") == GSL_SUCCESS);
    CHECK(bed_header_add(&h, "t", "-5") == GSL_SUCCESS); /* the bed's counts */
    CHECK(bed_header_add(&h, "status", "old") == GSL_SUCCESS);
    for (size_t k = 0; k < frames; k++)
      random_bed(rng, &b[k], sizes[(seed + k) % 5]);
    char *text = write_text(&h, frames, b, spin, "ok");
    struct reading r = read_text(text);
    bool good = CHECK(r.status == GSL_EOF) && CHECK(r.frames == frames);
    for (size_t k = 0; good && k < frames; k++)
      good = CHECK(same_bed(&b[k], &r.bed[k], spin));
    CHECK(!strcmp(key(&r, "my.own-key"), "a = b, c; 1 2"));
    CHECK(!strcmp(key(&r, "empty"), ""));
    CHECK(!strcmp(key(&r, "status"), "ok"));
    CHECK(!strcmp(key(&r, "none"), "(none)"));
    const struct bed_header *got = bed_reader_header(r.reader);
    /* in order, both walls, t once, status last */
    static const char *const order[] = {"format", "model", "my.own-key",
                                        "wall",   "wall",  "empty",
                                        "t",      "status"};
    CHECK(got->count == 8);
    for (size_t k = 0; k < got->count && k < 8; k++)
      CHECK(!strcmp(got->at[k].name, order[k]));
    CHECK(!strcmp(got->at[3].value, "0 0 0 0 0 -1"));
    CHECK(!strcmp(got->at[4].value, "1 0 0 1 0 0"));
    /* what was read writes the same bytes */
    if (good) {
      char *again = write_text(got, frames, r.bed, spin, "ok");
      CHECK(!strcmp(text, again));
      free(again);
    }
    if (!good)
      fprintf(stderr, "  seed %lu: %s\n", seed, bed_reader_error(r.reader));
    reading_free(&r);
    free(text);
    bed_header_free(&h);
    for (size_t k = 0; k < frames; k++)
      bed_free(&b[k]);
  }
}

/* The bytes themselves, as README.md and the other programs know them; the
   checksums are those that gzip gives these lines. */
static void test_bytes(void) {
  struct bed b[2];
  struct bed_header h = {0};
  CHECK(bed_alloc(&b[0], 1) == GSL_SUCCESS);
  CHECK(bed_alloc(&b[1], 1) == GSL_SUCCESS);
  CHECK(bed_header_add(&h, "format", "bed-1") == GSL_SUCCESS);
  for (int k = 0; k < 2; k++) {
    b[k].id[0] = 4;
    b[k].t = 0.1 * k;
    b[k].r[0] = 0.25;
    memcpy(b[k].x, (double[]){1, -2, 0.5}, 3 * sizeof(double));
    memcpy(b[k].v, (double[]){1e-3, -0.0, 3}, 3 * sizeof(double));
    memcpy(b[k].w, (double[]){7, 8, 9e99}, 3 * sizeof(double));
  }
  char *text = write_text(&h, 2, b, true, "ok");
  CHECK(!strcmp(text, "# format=bed-1\n# checksum=e9897ee8\n# t=0\n"
                      "id\tx\ty\tz\tr\tm\tvx\tvy\tvz\twx\twy\twz\n"
                      "4\t1\t-2\t0.5\t0.25\t1\t0.001\t-0\t3\t7\t8\t"
                      "9e+99\n# checksum=897caa85\n"
                      "\n\n# t=0.1\n"
                      "id\tx\ty\tz\tr\tm\tvx\tvy\tvz\twx\twy\twz\n"
                      "4\t1\t-2\t0.5\t0.25\t1\t0.001\t-0\t3\t7\t8\t"
                      "9e+99\n# checksum=d6806963\n"
                      "# status=ok\n"));
  free(text);
  text = write_text(&h, 1, b, false, "limit: not at rest");
  CHECK(!strcmp(text, "# format=bed-1\n# checksum=e9897ee8\n# t=0\n"
                      "id\tx\ty\tz\tr\tm\tvx\tvy\tvz\n"
                      "4\t1\t-2\t0.5\t0.25\t1\t0.001\t-0\t3\n"
                      "# checksum=baf9d135\n"
                      "# status=limit: not at rest\n"));
  free(text);
  bed_header_free(&h);
  bed_free(&b[0]);
  bed_free(&b[1]);
}

/* --- what a reader puts up with --------------------------------------------*/

static void test_columns(void) {
  /* none but the centre: radius= of the header, unit mass, at rest */
  struct reading r = read_text("# t=2\n# radius=0.3\nx\ty\tz\n1\t2\t3\n"
                               "4\t5\t6\n# status=ok\n");
  CHECK(r.status == GSL_EOF && r.frames == 1);
  if (r.frames == 1) {
    const struct bed *b = &r.bed[0];
    CHECK(b->n == 2 && b->t == 2 && b->id[0] == 0 && b->id[1] == 1);
    CHECK(b->x[0] == 1 && b->x[4] == 5 && b->x[5] == 6);
    CHECK(b->r[0] == 0.3 && b->r[1] == 0.3 && b->m[0] == 1 && b->m[1] == 1);
    for (int u = 0; u < 6; u++)
      CHECK(b->v[u] == 0 && b->w[u] == 0);
  }
  reading_free(&r);

  /* no radius anywhere: the option's default; no t: 0 */
  r = read_text("x y z\n 1 2  3\n# status=ok\n");
  CHECK(r.status == GSL_EOF && r.frames == 1);
  if (r.frames == 1)
    CHECK(r.bed[0].r[0] == 0.1 && r.bed[0].t == 0 && r.bed[0].x[2] == 3);
  reading_free(&r);

  /* any order, some of them; spaces; a sign; comments */
  r = read_text("#made by hand\n#t=1\n# no key\n"
                "wz\tm\tz\tvy\tid\ty\tx\tr\n"
                "+9\t2\t.5\t-4e-1\t-8\t1e1\t-0\t.125\n# status=ok\n");
  CHECK(r.status == GSL_EOF && r.frames == 1);
  if (r.frames == 1) {
    const struct bed *b = &r.bed[0];
    CHECK(b->t == 1 && b->id[0] == -8 && b->m[0] == 2 && b->r[0] == 0.125);
    CHECK(b->x[0] == 0 && signbit(b->x[0]) && b->x[1] == 10 && b->x[2] == 0.5);
    CHECK(b->v[0] == 0 && b->v[1] == -0.4 && b->w[2] == 9 && b->w[0] == 0);
  }
  reading_free(&r);
}

static const char three_frames[] = "# format=bed-1\n"
                                   "# t=0\n"
                                   "# friction=0.2\n"
                                   "# wall=0 0 0 0 0 -1\n"
                                   "# other=1\n"
                                   "# wall=1 0 0 1 0 0\n"
                                   "id\tx\ty\tz\n"
                                   "0\t1\t2\t3\n"
                                   "1\t4\t5\t6\n"
                                   "\n"
                                   "\n"
                                   "# t=0.5\n"
                                   "0\t1.5\t2\t3\n"
                                   "\n"
                                   "\n"
                                   "# t=1\n"
                                   "# wall=7 0 0 1 0 0\n"
                                   "# other=2\n"
                                   "z\ty\tx\n"
                                   "3\t2\t1\n"
                                   "# status=ok\n";

/* Later frames name what changed: keys, columns; walls all at once. */
static void test_later_frames(void) {
  struct reading r = {.status = GSL_SUCCESS};
  r.in = fmemopen((void *)three_frames, strlen(three_frames), "r");
  r.reader = open_bed(r.in, "file", false);
  const struct bed_header *h = bed_reader_header(r.reader);
  struct bed b;
  for (int k = 0; k < 3; k++) {
    if (!CHECK(bed_reader_next(r.reader, &b) == GSL_SUCCESS))
      return;
    size_t walls = 0;
    for (size_t q = 0; q < h->count; q++)
      walls += !strcmp(h->at[q].name, "wall");
    CHECK(walls == (k < 2 ? 2 : 1));
    CHECK(!strcmp(key(&r, "wall"), k < 2 ? "0 0 0 0 0 -1" : "7 0 0 1 0 0"));
    CHECK(!strcmp(key(&r, "friction"), "0.2"));
    CHECK(!strcmp(key(&r, "other"), k < 2 ? "1" : "2"));
    CHECK(b.t == 0.5 * k && b.n == (k ? 1 : 2));
    CHECK(b.x[0] == (k == 1 ? 1.5 : 1) && b.x[2] == 3);
    bed_free(&b);
  }
  CHECK(bed_reader_next(r.reader, &b) == GSL_EOF);
  CHECK(bed_reader_next(r.reader, &b) == GSL_EOF); /* and again */
  CHECK(!strcmp(key(&r, "status"), "ok"));
  reading_free(&r);
}

static void test_line_ends(void) {
  char dos[2 * sizeof three_frames];
  size_t size = 0;
  for (const char *c = three_frames; *c; c++) {
    if (*c == '\n')
      dos[size++] = '\r';
    dos[size++] = *c;
  }
  struct reading unix_ = read_text(three_frames);
  struct reading r = read_bytes(dos, size, false);
  CHECK(r.status == GSL_EOF && r.frames == 3 && unix_.frames == 3);
  for (size_t k = 0; k < r.frames && k < unix_.frames; k++)
    CHECK(same_bed(&unix_.bed[k], &r.bed[k], true));
  CHECK(!strcmp(key(&r, "wall"), "7 0 0 1 0 0"));
  CHECK(!strcmp(key(&r, "status"), "ok"));
  reading_free(&r);
  reading_free(&unix_);

  /* one blank line separates frames as well, and some at the end do no harm */
  r = read_text("\n\nx\ty\tz\n1\t1\t1\n\n2\t2\t2\n\n\n\n\n# status=ok\n\n \n");
  CHECK(r.status == GSL_EOF && r.frames == 2);
  reading_free(&r);
}

/* --- what it refuses, and where --------------------------------------------*/

#define HEAD "# format=bed-1\n# t=1\n"         /* lines 1, 2 */
#define COLUMNS_LINE "id\tx\ty\tz\tr\tm\tvx\n" /* line 3 */
#define ROW "0\t1\t2\t3\t0.1\t1\t0\n"          /* line 4 */
#define END "# status=ok\n"

struct refused {
  const char *text;
  size_t from, to; /* lines that the message may name */
  const char *says;
};

static const struct refused refusals[] = {
    {HEAD "id\tx\ty\tz\tcolour\n" ROW END, 3, 3, "colour"},
    {HEAD "id\tx\ty\tz\tX\n" ROW END, 3, 3, "'X'"},
    {HEAD "id\tx\ty\tz\tx\n" ROW END, 3, 3, "columns 'x' and 'x'"},
    {HEAD "id\tx\ty\n0\t1\t2\n" END, 3, 3, "x, y and z"},
    {HEAD "id\tr\n" END, 3, 3, "x, y and z"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t1\n" END, 4, 4, "vx"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t1\t\n" END, 4, 4, "vx"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t\t1\t0\n" END, 4, 4, "vx is missing"},
    {HEAD COLUMNS_LINE ROW "1\n" END, 5, 5, "column x"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t1\t0\t0\n" END, 4, 4, "more"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t1\t0\tx\n" END, 4, 4, "more"},
    {HEAD COLUMNS_LINE ROW "1\tnan\t2\t3\t0.1\t1\t0\n" END, 5, 5, "column x"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t1\tNaN\n" END, 4, 4, "column vx"},
    {HEAD COLUMNS_LINE "0\t1\t-nan\t3\t0.1\t1\t0\n" END, 4, 4, "column y"},
    {HEAD COLUMNS_LINE "0\t1\t2\tinf\t0.1\t1\t0\n" END, 4, 4, "column z"},
    {HEAD COLUMNS_LINE "0\t1\t2\t-inf\t0.1\t1\t0\n" END, 4, 4, "column z"},
    {HEAD COLUMNS_LINE "0\t1\t2\tINFINITY\t0.1\t1\t0\n" END, 4, 4, "column z"},
    {HEAD COLUMNS_LINE "0\t1\t1e999\t3\t0.1\t1\t0\n" END, 4, 4, "column y"},
    {HEAD COLUMNS_LINE "0\t1\tabc\t3\t0.1\t1\t0\n" END, 4, 4, "abc"},
    {HEAD COLUMNS_LINE "0\t1\t2x\t3\t0.1\t1\t0\n" END, 4, 4, "2x"},
    {HEAD COLUMNS_LINE "0\t1,5\t2\t3\t0.1\t1\t0\n" END, 4, 4, "1,5"},
    {HEAD COLUMNS_LINE "0\t1e\t2\t3\t0.1\t1\t0\n" END, 4, 4, "1e"},
    {HEAD COLUMNS_LINE "nan\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "nan"},
    {HEAD COLUMNS_LINE "NaN\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "NaN"},
    {HEAD COLUMNS_LINE "inf\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "inf"},
    {HEAD COLUMNS_LINE "text\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "text"},
    {HEAD COLUMNS_LINE "0.5\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "id 0.5"},
    {HEAD COLUMNS_LINE "1e300\t1\t2\t3\t0.1\t1\t0\n" END, 4, 4, "id 1"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t-0.1\t1\t0\n" END, 4, 4, "radius -0.1"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0\t1\t0\n" END, 4, 4, "radius 0"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t-1\t0\n" END, 4, 4, "mass -1"},
    {HEAD COLUMNS_LINE "0\t1\t2\t3\t0.1\t-0\t0\n" END, 4, 4, "mass"},
    {HEAD COLUMNS_LINE ROW "7\t1\t2\t3\t0.1\t1\t0\n" ROW END, 4, 7, "id 0"},
    {HEAD COLUMNS_LINE ROW "\n\n" ROW ROW END, 7, 9, "id 0"},
    {"# format=bed-1\n# t=abc\n" COLUMNS_LINE ROW END, 2, 5, "t=abc"},
    {"# format=bed-1\n# t=1s\n" COLUMNS_LINE ROW END, 2, 5, "t=1s"},
    {"# format=bed-1\n# t=\n" COLUMNS_LINE ROW END, 2, 5, "t="},
    {"# format=bed-1\n# t=nan\n" COLUMNS_LINE ROW END, 2, 5, "t=nan"},
    {HEAD COLUMNS_LINE ROW "\n\n# t=inf\n" ROW END, 7, 9, "t=inf"},
    {"# format=bed-2\n# t=1\n" COLUMNS_LINE ROW END, 1, 1, "bed-2"},
    {"# radius=-1\nx\ty\tz\n1\t2\t3\n" END, 1, 3, "radius"},
    {"# radius=0\nx\ty\tz\n1\t2\t3\n" END, 1, 2, "radius"},
    {"# radius=0.1x\nx\ty\tz\n1\t2\t3\n" END, 1, 3, "radius"},
    {"# radius=big\nx\ty\tz\n1\t2\t3\n" END, 1, 3, "radius"},
    {HEAD ROW END, 3, 3, "column names"},
    {HEAD COLUMNS_LINE END, 4, 4, "no spheres"},
    {HEAD END, 3, 3, "no spheres"},
    {"", 0, 1, "status"},
    {"\n\n\n", 3, 3, "status"},
    {HEAD COLUMNS_LINE ROW, 4, 4, "status"},
    {HEAD COLUMNS_LINE ROW END ROW, 6, 6, "after"},
    {HEAD COLUMNS_LINE ROW END "# t=2\n", 6, 6, "after"},
    {HEAD COLUMNS_LINE ROW END "\n\n" COLUMNS_LINE, 8, 8, "after"},
    {HEAD COLUMNS_LINE ROW END END, 6, 6, "after"},
    {HEAD COLUMNS_LINE ROW "# status=failed at t=1: no step\n", 5, 5,
     "status=failed at t=1"},
    {HEAD COLUMNS_LINE ROW "# status=\n", 5, 5, "status="},
    {HEAD COLUMNS_LINE ROW "# status=ok ", 5, 5, "cut"},
};

static bool names_line(const char *error, size_t from, size_t to) {
  size_t line;
  int used = 0;
  return sscanf(error, "file:%zu: %n", &line, &used) == 1 && used > 0 &&
         error[used] && line >= from && line <= to;
}

static void test_refusals(void) {
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    const struct refused *c = &refusals[k];
    struct reading r = read_text(c->text);
    const char *error = bed_reader_error(r.reader);
    const bool good = CHECK(r.status == GSL_EINVAL) &&
                      CHECK(names_line(error, c->from, c->to)) &&
                      CHECK(strstr(error, c->says)) &&
                      CHECK(!strpbrk(error, "\n\r"));
    if (!good)
      fprintf(stderr, "  expected line %zu to %zu and '%s', got '%s' for\n%s\n",
              c->from, c->to, c->says, error, c->text);
    reading_free(&r);
  }

  /* a NUL byte anywhere, even behind the last line's end */
  static const char whole[] = HEAD COLUMNS_LINE ROW END;
  char bytes[sizeof whole];
  size_t line = 1;
  for (size_t k = 0; k + 1 < sizeof whole; k++) {
    memcpy(bytes, whole, sizeof whole);
    bytes[k] = 0;
    struct reading r = read_bytes(bytes, sizeof whole - 1, false);
    if (!CHECK(r.status == GSL_EINVAL &&
               names_line(bed_reader_error(r.reader), line, line)))
      fprintf(stderr, "  NUL as byte %zu: %s\n", k, bed_reader_error(r.reader));
    line += whole[k] == '\n';
    reading_free(&r);
  }
  struct reading r = read_bytes(whole, sizeof whole, false);
  CHECK(r.status == GSL_EINVAL);
  reading_free(&r);

  /* a message about an endless word stays a message */
  char *longer = malloc(200000);
  if (!longer)
    abort();
  memset(longer, 'q', 199999);
  longer[199998] = '\n';
  longer[199999] = 0;
  r = read_text(longer);
  CHECK(r.status == GSL_EINVAL);
  CHECK(names_line(bed_reader_error(r.reader), 1, 1));
  CHECK(strlen(bed_reader_error(r.reader)) < 512);
  reading_free(&r);
  free(longer);
}

/* --- files that are not whole ----------------------------------------------*/

/* Cut at every byte: refused each time. With allow_partial each frame that is
   given holds rows as they stand in the whole file, none of them changed. */
static void test_cuts(void) {
  static const char *const files[] = {HEAD COLUMNS_LINE ROW
                                      "12\t1.25\t2\t3\t0.125\t12\t1e-05\n" END,
                                      three_frames};
  for (size_t f = 0; f < 2; f++) {
    struct reading whole = read_text(files[f]);
    CHECK(whole.status == GSL_EOF);
    const size_t size = strlen(files[f]);
    size_t most = 0;
    for (size_t cut = 0; cut < size; cut++) {
      struct reading r = read_bytes(files[f], cut, false);
      if (!CHECK(r.status == GSL_EINVAL &&
                 names_line(bed_reader_error(r.reader), 0, 30)))
        fprintf(stderr, "  cut at byte %zu: status %d\n", cut, r.status);
      reading_free(&r);

      r = read_bytes(files[f], cut, true);
      bool good =
          r.status == GSL_EOF || (r.status == GSL_EINVAL && r.frames == 0);
      for (size_t k = 0; good && k < r.frames; k++) {
        const struct bed *b = &r.bed[k], *w = &whole.bed[k];
        good = b->n > 0 && b->n <= w->n && b->t == w->t &&
               (k + 1 == r.frames || b->n == w->n) &&
               !memcmp(b->id, w->id, b->n * sizeof *b->id) &&
               same_bits(b->x, w->x, 3 * b->n) &&
               same_bits(b->v, w->v, 3 * b->n) && same_bits(b->r, w->r, b->n) &&
               same_bits(b->m, w->m, b->n);
      }
      if (!CHECK(good && r.frames >= most))
        fprintf(stderr, "  partial, cut at byte %zu: status %d, %zu frames\n",
                cut, r.status, r.frames);
      most = r.frames;
      reading_free(&r);
    }
    CHECK(most == whole.frames);
    reading_free(&whole);
  }
}

/* allow_partial takes any status and none; a malformed row it does not. */
static void test_partial(void) {
  static const char *const ends[] = {"# status=failed at t=2: no step\n",
                                     "# status=limit: not at rest\n", "",
                                     "# sta", "1\t4\t5"};
  for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
    char text[300];
    snprintf(text, sizeof text, HEAD COLUMNS_LINE ROW "%s", ends[k]);
    struct reading r = read_text(text);
    CHECK(r.status == GSL_EINVAL);
    reading_free(&r);
    r = read_bytes(text, strlen(text), true);
    CHECK(r.status == GSL_EOF && r.frames == 1);
    if (r.frames == 1)
      CHECK(r.bed[0].n == 1 && r.bed[0].x[2] == 3 && r.bed[0].t == 1);
    reading_free(&r);
  }
  static const char *const bad[] = {HEAD COLUMNS_LINE "0\t1\t2\tnan\t1\t1\t0\n",
                                    HEAD COLUMNS_LINE "0\t1\n" ROW,
                                    HEAD "x\ty\n" ROW,
                                    HEAD ROW,
                                    HEAD COLUMNS_LINE ROW ROW,
                                    HEAD,
                                    ""};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    struct reading r = read_bytes(bad[k], strlen(bad[k]), true);
    CHECK(r.status == GSL_EINVAL && r.frames == 0);
    reading_free(&r);
  }
}

/* --- checksums -------------------------------------------------------------*/

#define SUM "# checksum=baf9d135\n"
#define HEAD_SUM "# checksum=e9897ee8\n"
#define SUMMED                                                                 \
  "# t=0\nid\tx\ty\tz\tr\tm\tvx\tvy\tvz\n"                                     \
  "4\t1\t-2\t0.5\t0.25\t1\t0.001\t-0\t3\n"
#define FORMAT "# format=bed-1\n"

/* What may be done to a bed, and what not. */
static void test_sums(void) {
  static const struct {
    const char *text;
    size_t frames;    /* 0: refused, */
    const char *says; /* with these words */
  } cases[] = {
      {FORMAT HEAD_SUM SUMMED SUM END, 1, ""},
      {FORMAT HEAD_SUM SUMMED SUM "\n\n" SUMMED SUM END, 2, ""},
      {FORMAT HEAD_SUM SUMMED SUM END FORMAT HEAD_SUM SUMMED SUM END, 2, ""},
      /* comments, also as keys in front; the line ends of DOS */
      {"# by me\n# a=b\n" FORMAT "# x\n" HEAD_SUM SUMMED "#\n" SUM END, 1, ""},
      {"# format=bed-1\r\n# checksum=e9897ee8\r\n" SUMMED SUM END, 1, ""},
      /* one or the other is left out; a header in front of a frame */
      {FORMAT SUMMED SUM END, 1, ""},
      {FORMAT "# other=1\n" SUMMED SUM END, 1, ""},
      {FORMAT HEAD_SUM SUMMED END, 1, ""},
      {FORMAT HEAD_SUM "# t=5\nx y z\n1 2 3\n\n\n" SUMMED SUM END, 2, ""},
      {FORMAT "# new=1\n" HEAD_SUM SUMMED SUM END, 0,
       "file:3: checksum=e9897ee8: the header has "},
      {FORMAT HEAD_SUM "# new=1\n" SUMMED SUM END, 0,
       "file:3: '# new=1' behind"},
      {FORMAT HEAD_SUM "x y z\n1 2 3\n" END, 0, "file:3: 'x y z' behind"},
      {FORMAT HEAD_SUM SUMMED "5 1 1 1 1 1 0 0 0\n" SUM END, 0,
       "file:7: checksum=baf9d135: the frame of t=0 has "},
      {FORMAT HEAD_SUM SUMMED SUM "5 1 1 1 1 1 0 0 0\n" END, 0,
       "file:7: '5 1 1"},
      {FORMAT HEAD_SUM SUMMED SUM "# t=7\n" END, 0, "file:7: '# t=7' behind"},
      {FORMAT HEAD_SUM SUMMED "# checksum=BAF9D135\n" END, 0, "grep -v"},
      {FORMAT HEAD_SUM SUMMED "# checksum=\n" END, 0, "grep -v"},
      {FORMAT HEAD_SUM SUMMED SUM SUM END, 0, "file:7: a checksum of no lines"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct reading r = read_text(cases[k].text);
    const int wanted = cases[k].frames ? GSL_EOF : GSL_EINVAL;
    if (!CHECK(r.status == wanted && r.frames == cases[k].frames &&
               !strcmp(key(&r, "checksum"), "(none)") &&
               (cases[k].frames ||
                strstr(bed_reader_error(r.reader), cases[k].says))))
      fprintf(stderr, "  %s: status %d, %zu frames: %s\n", cases[k].text,
              r.status, r.frames, bed_reader_error(r.reader));
    reading_free(&r);
  }
}

/* Any bit that turns within a line under a checksum is found. */
static void test_turned_bits(void) {
  const char whole[] = FORMAT HEAD_SUM SUMMED SUM "\n\n" SUMMED SUM END;
  char text[sizeof whole];
  for (size_t at = 0; at < sizeof whole - 1; at++) {
    const char *begin = whole + at;
    while (begin > whole && begin[-1] != '\n')
      begin--;
    const bool summed = *begin != '\n' && strncmp(begin, "# checksum", 10) &&
                        strncmp(begin, "# status", 8);
    for (int bit = 0; bit < 8 && summed; bit++) {
      memcpy(text, whole, sizeof whole);
      text[at] = (char)(text[at] ^ (1 << bit));
      struct reading r = read_text(text);
      if (!CHECK(r.status == GSL_EINVAL))
        fprintf(stderr, "  bit %d of byte %zu\n", bit, at);
      reading_free(&r);
    }
  }
}

/* --- headers ---------------------------------------------------------------*/

static void test_header(void) {
  struct bed_header h = {0};
  char name[16], value[16];
  CHECK(bed_header_get(&h, "a") == NULL);
  bed_header_remove(&h, "a");
  for (int k = 0; k < 100; k++) {
    snprintf(name, sizeof name, "key%d", k % 50);
    snprintf(value, sizeof value, "%d", k);
    CHECK(bed_header_add(&h, name, value) == GSL_SUCCESS);
  }
  name[0] = value[0] = 'X'; /* both were copied */
  CHECK(h.count == 100 && !strcmp(bed_header_get(&h, "key49"), "49"));
  CHECK(bed_header_set(&h, "key3", "new") == GSL_SUCCESS);
  CHECK(h.count == 100 && !strcmp(h.at[3].value, "new") &&
        !strcmp(h.at[53].value, "53"));
  CHECK(bed_header_set(&h, "other", "") == GSL_SUCCESS && h.count == 101);
  bed_header_remove(&h, "key0");
  bed_header_remove(&h, "key49");
  CHECK(h.count == 97 && !bed_header_get(&h, "key0") &&
        !bed_header_get(&h, "key49"));
  CHECK(!strcmp(h.at[0].name, "key1") && !strcmp(h.at[96].name, "other"));
  bed_header_free(&h);
  CHECK(h.count == 0 && !bed_header_get(&h, "key1"));
  bed_header_free(&h);
}

/* A stream that cannot be written says so; nothing else happens. */
static void test_write_error(void) {
  struct bed b;
  static const struct bed_header none = {0};
  CHECK(bed_alloc(&b, 2000) == GSL_SUCCESS);
  FILE *full = fopen("/dev/full", "w");
  if (CHECK(full)) {
    bed_write_frame(full, &none, &b, true);
    bed_write_gap(full);
    bed_write_status(full, "ok");
    fflush(full);
    CHECK(ferror(full));
    fclose(full);
  }
  bed_free(&b);
  CHECK(b.n == 0 && b.x == NULL);
  bed_free(&b);
}

/* A stream that cannot be read is an error, not an empty file. */
static void test_read_error(void) {
  FILE *directory = fopen("/", "r");
  if (!CHECK(directory))
    return;
  struct bed b;
  for (int partial = 0; partial < 2; partial++) {
    struct bed_reader *r = open_bed(directory, "/", partial);
    CHECK(bed_reader_next(r, &b) == GSL_EINVAL);
    CHECK(strstr(bed_reader_error(r), "read error"));
    bed_reader_close(r);
  }
  bed_reader_close(NULL);
  fclose(directory);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_round_trip(rng);
  test_bytes();
  test_columns();
  test_later_frames();
  test_line_ends();
  test_refusals();
  test_cuts();
  test_partial();
  test_sums();
  test_turned_bits();
  test_header();
  test_write_error();
  test_read_error();
  gsl_rng_free(rng);
  return check_done();
}
