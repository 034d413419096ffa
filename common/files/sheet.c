/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "files/sheet.h"

#include <inttypes.h>
#include <string.h>
#include "files/numbers.h"

struct sheet sheet_begin(FILE *out) {
  return (struct sheet){out, checksum_begin()};
}

void sheet_text(struct sheet *s, const char *text) {
  fputs(text, s->out);
  checksum_add(&s->sum, text, strlen(text));
}

void sheet_numbers(struct sheet *s, char separator, size_t count,
                   const double *x) {
  char text[NUMBER_SIZE + 1] = {separator};
  for (size_t k = 0; k < count; k++) {
    number_format(x[k], text + 1);
    sheet_text(s, text);
  }
}

void sheet_sum(const struct checksum *sum, char text[SHEET_SUM_SIZE]) {
  snprintf(text, SHEET_SUM_SIZE, "%08" PRIx32, checksum_value(sum));
}

void sheet_end(struct sheet *s) {
  char text[SHEET_SUM_SIZE];
  sheet_sum(&s->sum, text);
  fprintf(s->out, "# " SHEET_CHECKSUM "=%s\n", text);
}
