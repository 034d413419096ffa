/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Part of a bed on its way into a file, the header or a frame: lines of text,
   and behind them one with their checksum, by which a reader finds what was
   changed since. Tested in tests/test_bed_io.c. */
#ifndef SHEET_H
#define SHEET_H

#include <stdio.h>
#include "platform/checksum.h"

/* "# checksum=XXXXXXXX", hexadecimal, is the last line of a part. */
#define SHEET_CHECKSUM "checksum"

/* Errors stay in ferror(out). */
struct sheet {
  FILE *out;
  struct checksum sum; /* of all lines so far, with their ends */
};

struct sheet sheet_begin(FILE *out);
void sheet_text(struct sheet *s, const char *text);
/* Each with the separator before it. */
void sheet_numbers(struct sheet *s, char separator, size_t count,
                   const double *x);
void sheet_end(struct sheet *s);

/* The checksum in 8 digits. */
enum { SHEET_SUM_SIZE = 9 };
void sheet_sum(const struct checksum *sum, char text[SHEET_SUM_SIZE]);

#endif
