/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files/numbers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool number_is_whole(double x) {
  return x == floor(x) && fabs(x) <= NUMBER_MOST_WHOLE;
}

bool number_parse(const char *text, double *value) {
  char *end;
  const double x = strtod(text, &end);
  /* an underflow is fine: it is a tiny number */
  if (end == text || *end || !isfinite(x) || strpbrk(text, " \t"))
    return false;
  *value = x;
  return true;
}

void number_format(double x, char text[NUMBER_SIZE]) {
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(text, NUMBER_SIZE, "%.*g", digits, x);
    if (strtod(text, NULL) == x)
      return;
  }
}
