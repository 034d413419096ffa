/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "files/numbers.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

bool number_is_whole(double x) {
  return x == floor(x) && fabs(x) <= NUMBER_MOST_WHOLE;
}

static const char *skip_digits(const char *at) {
  while (isdigit((unsigned char)*at))
    at++;
  return at;
}

static const char *skip_sign(const char *at) {
  return *at == '+' || *at == '-' ? at + 1 : at;
}

/* Decimal digits with a point and an exponent, and nothing else: strtod takes
   0x10, nan and infinity as well, which are words or mistakes in files and
   options. */
static bool is_decimal(const char *text) {
  const char *at = skip_sign(text);
  const char *digits = at;
  at = skip_digits(at);
  bool any = at > digits;
  if (*at == '.') {
    digits = at + 1;
    at = skip_digits(digits);
    any |= at > digits;
  }
  if (any && (*at == 'e' || *at == 'E')) {
    digits = skip_sign(at + 1);
    at = skip_digits(digits);
    any = at > digits;
  }
  return any && !*at;
}

bool number_parse(const char *text, double *value) {
  if (!is_decimal(text))
    return false;
  const double x = strtod(text, NULL); /* an underflow is a tiny number */
  if (!isfinite(x))
    return false;
  *value = x;
  return true;
}

/* 15 digits always survive the way through a double and 17 always tell doubles
   apart. Below DBL_MIN doubles hold fewer. */
void number_format(double x, char text[NUMBER_SIZE]) {
  const double magnitude = fabs(x);
  int digits = magnitude > 0 && magnitude < DBL_MIN ? 1 : 15;
  do
    snprintf(text, NUMBER_SIZE, "%.*g", digits, x);
  while (digits++ < 17 && strtod(text, NULL) != x);
}

void numbers_write(FILE *out, char separator, size_t count, const double *x) {
  char text[NUMBER_SIZE];
  for (size_t k = 0; k < count; k++) {
    if (k)
      fputc(separator, out);
    number_format(x[k], text);
    fputs(text, out);
  }
}
