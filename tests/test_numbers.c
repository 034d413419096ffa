/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as text: what is one, and that it reads back the same. */
#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "files/numbers.h"

static void test_parse(void) {
  static const struct {
    const char *text;
    double value;
  } numbers[] = {{"0", 0},        {"-1.5", -1.5}, {"+.5", 0.5},
                 {"2.", 2},       {"1e3", 1000},  {"1E-3", 1e-3},
                 {"1e-400", 0},   {"007", 7},     {"4.9e-324", 5e-324},
                 {"1e+02", 100.0}};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
    double x = -7;
    if (!CHECK(number_parse(numbers[k].text, &x) && x == numbers[k].value))
      fprintf(stderr, "  %s\n", numbers[k].text);
  }
  static const char *const none[] = {
      "",       " 1",       "1 ",  "\t1",      "1 2",   "1,5",      "1e",
      ".",      "-",        "e5",  "1.5.2",    "nan",   "-nan",     "inf",
      "-inf",   "infinity", "1x",  "--1",      "1e999", "nan(123)", "0x10",
      "0x1p-3", "-0X1",     "NaN", "INFINITY", "1\n",   "1e5e",     "1d3"};
  for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
    double x = -7;
    if (!CHECK(!number_parse(none[k], &x) && x == -7))
      fprintf(stderr, "  '%s'\n", none[k]);
  }
}

static void test_whole(void) {
  CHECK(number_is_whole(0) && number_is_whole(-3) && number_is_whole(1e15));
  CHECK(number_is_whole(9007199254740992) && number_is_whole(-0x1p53));
  CHECK(!number_is_whole(9007199254740994) && !number_is_whole(0.5));
  CHECK(!number_is_whole(NAN) && !number_is_whole(INFINITY));
  CHECK(!number_is_whole(-1e300));
}

/* Reads back the same bits, with no digit to spare: one less would not. */
static void check_format(double x) {
  char text[NUMBER_SIZE], shorter[NUMBER_SIZE];
  number_format(x, text);
  const double back = strtod(text, NULL);
  bool good = !memcmp(&back, &x, sizeof x);
  for (int digits = 1; good && digits < 17; digits++) {
    snprintf(shorter, sizeof shorter, "%.*g", digits, x);
    good = strlen(shorter) >= strlen(text) || strtod(shorter, NULL) != x;
  }
  if (!CHECK(good))
    fprintf(stderr, "  %.17g gave '%s'\n", x, text);
}

static void test_format(void) {
  static const struct {
    double x;
    const char *text;
  } known[] = {{0.1, "0.1"},
               {0.4, "0.4"},
               {-0.0, "-0"},
               {1. / 3, "0.3333333333333333"},
               {1e300, "1e+300"},
               {0.1 + 0.2, "0.30000000000000004"},
               {123456, "123456"},
               {5e-7, "5e-07"},
               {0x1p53, "9007199254740992"},
               {5e-324, "5e-324"},
               {1e-310, "1e-310"},
               {123456789, "123456789"}};
  char text[NUMBER_SIZE];
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    number_format(known[k].x, text);
    if (!CHECK(!strcmp(text, known[k].text)))
      fprintf(stderr, "  %s gave '%s'\n", known[k].text, text);
  }
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (int k = 0; k < 3000; k++) {
    const uint64_t bits =
        (uint64_t)gsl_rng_get(rng) << 32 | (uint64_t)gsl_rng_get(rng);
    double x;
    memcpy(&x, &bits, sizeof x);
    if (isfinite(x))
      check_format(x);
    check_format((double)gsl_rng_uniform_int(rng, 100000) / 1000);
    check_format(gsl_rng_uniform(rng) - 0.5);
  }
  gsl_rng_free(rng);
}

int main(void) {
  test_parse();
  test_whole();
  test_format();
  return check_done();
}
