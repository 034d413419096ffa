/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/size_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "program/files.h"
#include "program/messages.h"

const char *const size_shares[] = {
    [SHARES_NUMBER] = "number", [SHARES_VOLUME] = "volume", NULL};

/* The words that --sizes may begin with. */
static const struct form {
  const char *name, *rest;
  enum sizes_kind kind;
} forms[] = {{"uniform", "R1,R2", SIZES_UNIFORM},
             {"normal", "MEAN,SD", SIZES_NORMAL},
             {"lognormal", "MEDIAN,SIGMA", SIZES_LOGNORMAL},
             {"mix", "R1*SHARE,R2*SHARE,...", SIZES_MIX},
             {"sieve", "FILE", SIZES_TABLE}};

/* Sizes and their shares as they are read. */
struct columns {
  size_t count, room;
  double *size, *share;
};

static double *lengthened(double *x, size_t n) {
  double *more = realloc(x, n * sizeof *x);
  if (!more)
    die(EXIT_IO, "out of memory");
  return more;
}

static void append(struct columns *c, double size, double share) {
  if (c->count == c->room) {
    c->room = 2 * c->room + 16;
    c->size = lengthened(c->size, c->room);
    c->share = lengthened(c->share, c->room);
  }
  c->size[c->count] = size;
  c->share[c->count++] = share;
}

/* The number that text begins with, up to one of the ends; returns what comes
   after it, NULL if it is none. */
static const char *leading_number(const char *text, const char *ends,
                                  double *x) {
  char word[64];
  const size_t length = strcspn(text, ends);
  if (length >= sizeof word)
    return NULL;
  memcpy(word, text, length);
  word[length] = 0;
  return number_parse(word, x) ? text + length : NULL;
}

static bool parse_pair(const char *text, double *a, double *b) {
  const char *rest = leading_number(text, ",", a);
  return rest && *rest == ',' && number_parse(rest + 1, b);
}

static bool parse_mix(const char *text, struct columns *c) {
  for (;; text++) {
    double radius, share;
    text = leading_number(text, "*,", &radius);
    if (!text || *text != '*')
      return false;
    text = leading_number(text + 1, ",", &share);
    if (!text)
      return false;
    append(c, radius, share);
    if (!*text)
      return true;
  }
}

static void check_shares(const struct columns *c, const char *name) {
  double sum = 0;
  for (size_t k = 0; k < c->count; k++)
    sum += c->share[k];
  if (!sizes_adds_up(c->count, c->share))
    die(name ? EXIT_INPUT : EXIT_USAGE,
        "%s: shares add up to %g, expected 1 or 100", name ? name : "--sizes",
        sum);
}

static const char blanks[] = " \t\r\n,;";

/* A line's two numbers; false if it has not just these. */
static bool parse_line(const char *line, double *size, double *share) {
  const char *rest = leading_number(line, blanks, size);
  if (!rest)
    return false;
  rest = leading_number(rest + strspn(rest, blanks), blanks, share);
  return rest && !rest[strspn(rest, blanks)];
}

/* Appends a line of a sieve's file; first: it may be one of names. */
static void read_line(const char *line, const char *name, size_t number,
                      struct columns *c, bool *first) {
  double size, share;
  line += strspn(line, blanks);
  if (!*line || *line == '#')
    return;
  const bool numbers = parse_line(line, &size, &share);
  const bool names = *first && !numbers && !strpbrk(line, "0123456789");
  *first = false;
  if (names)
    return;
  if (!numbers)
    die(EXIT_INPUT, "%s:%zu: expected two numbers: mesh (m) and share", name,
        number);
  if (!(size > 0))
    die(EXIT_INPUT,
        "%s:%zu: mesh %g: sizes without an end, expected a mesh above 0", name,
        number, size);
  if (!(share >= 0))
    die(EXIT_INPUT, "%s:%zu: share %g: expected at least 0", name, number,
        share);
  const double *before = c->size + c->count;
  if (c->count && size == before[-1])
    die(EXIT_INPUT, "%s:%zu: mesh %g: expected another than the line before",
        name, number, size);
  if (c->count > 1 && (size > before[-1]) != (before[-1] > before[-2]))
    die(EXIT_INPUT, "%s:%zu: mesh %g: expected meshes in order", name, number,
        size);
  append(c, size, share);
}

static void turn_round(double *x, size_t count) {
  for (size_t k = 0; k < count / 2; k++) {
    const double kept = x[k];
    x[k] = x[count - 1 - k];
    x[count - 1 - k] = kept;
  }
}

/* Ascending edges, in radii. */
static void read_sieve(const char *path, struct columns *c) {
  char line[1024];
  struct input in;
  input_open(&in, path);
  bool first = true;
  for (size_t number = 1; fgets(line, sizeof line, in.stream); number++) {
    if (!strchr(line, '\n') && !feof(in.stream))
      die(EXIT_INPUT, "%s:%zu: expected two numbers: mesh (m) and share",
          in.name, number);
    read_line(line, in.name, number, c, &first);
  }
  if (ferror(in.stream))
    die(EXIT_IO, "%s: cannot be read", in.name);
  if (c->count < 2)
    die(EXIT_INPUT, "%s: %zu meshes, expected at least two", in.name, c->count);
  if (c->size[0] > c->size[1]) {
    turn_round(c->size, c->count);
    turn_round(c->share, c->count);
  }
  const size_t last = c->count - 1;
  if (c->share[last] > 0)
    die(EXIT_INPUT,
        "%s: %g stays on the largest mesh %g: sizes without an end, expected a "
        "larger mesh with 0",
        in.name, c->share[last], c->size[last]);
  check_shares(c, in.name);
  for (size_t k = 0; k < c->count; k++)
    c->size[k] *= 0.5;
  input_close(&in);
}

struct sizes *sizes_of_options(const char *text, const char *shares) {
  const size_t length = strcspn(text, ":");
  const struct form *form = NULL;
  for (size_t k = 0; k < sizeof forms / sizeof *forms; k++)
    if (text[length] && length == strlen(forms[k].name) &&
        !strncmp(text, forms[k].name, length))
      form = &forms[k];
  if (!form)
    die(EXIT_USAGE,
        "--sizes %s: expected uniform:R1,R2, normal:MEAN,SD, "
        "lognormal:MEDIAN,SIGMA, mix:R1*SHARE,... or sieve:FILE",
        text);
  const char *rest = text + length + 1;
  const bool sieve = form->kind == SIZES_TABLE;
  if (sieve && shares && strcmp(shares, size_shares[SHARES_VOLUME]) != 0)
    die(EXIT_USAGE, "--shares %s: a sieve's are by volume", shares);
  if (strpbrk(text, "\r\n"))
    die(EXIT_USAGE, "--sizes: expected one line");
  const bool by_volume =
      sieve || (shares && !strcmp(shares, size_shares[SHARES_VOLUME]));
  double a = 0, b = 0;
  struct columns c = {0};
  bool parsed = true;
  if (sieve)
    read_sieve(rest, &c);
  else
    parsed = form->kind == SIZES_MIX ? parse_mix(rest, &c)
                                     : parse_pair(rest, &a, &b);
  if (!parsed)
    die(EXIT_USAGE, "--sizes %s: expected %s:%s", text, form->name, form->rest);
  struct sizes *sizes = NULL;
  const int status = form->kind >= SIZES_MIX
                         ? sizes_alloc_table(&sizes, form->kind, by_volume,
                                             c.count, c.size, c.share)
                         : sizes_alloc(&sizes, form->kind, by_volume, a, b);
  if (status != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
  const char *wrong = sizes_check(sizes);
  if (wrong)
    die(sieve ? EXIT_INPUT : EXIT_USAGE, "%s%s: %s", sieve ? "" : "--sizes ",
        sieve ? rest : text, wrong);
  if (form->kind == SIZES_MIX)
    check_shares(&c, NULL);
  free(c.size);
  free(c.share);
  return sizes;
}
