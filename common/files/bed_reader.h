/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the readers of all formats share: lines with their numbers, messages
   that name them, columns, rows, frames. It knows of no format. For
   files/read_*.c and formats.c; others use formats.h. */
#ifndef BED_READER_H
#define BED_READER_H

#include <stdio.h>
#include "files/bed_io.h"
#include "files/columns.h"
#include "files/reader_options.h"

enum {
  MOST_FIELDS = 256,      /* of a row */
  MOST_KEYS = 4096,       /* of a header; each is looked for among all */
  LONGEST_LINE = 1 << 20, /* bytes; what is longer is not one of our formats */
  BLANKS = 0              /* separator: any number of spaces and tabs */
};

struct bed_reader;

/* A format: its name, what it is, whether a file that begins with this line is
   of it, the bytes of what its reader has to remember (zeros at first), and
   its reader, which is what bed_reader_next is. */
struct bed_format {
  const char *name, *help;
  bool (*begins)(const char *line);
  size_t state_size;
  int (*next)(struct bed_reader *, struct bed *);
};

struct bed_reader {
  FILE *in;
  const char *name;
  struct bed_reader_options options;
  const struct bed_format *format; /* NULL: not yet known */
  void *state;                     /* the format's */
  struct bed_header header;

  char *line; /* the last one read, without its end */
  size_t line_size, line_number;
  bool held; /* reader_line gives the same line again */

  char separator;
  bool decimal_comma;                 /* 0,5 is a number as well */
  bool more_fields;                   /* than there are columns are no error */
  unsigned char columns[MOST_FIELDS]; /* enum column, as they stand in a row */
  size_t columns_count;
  bool has[COLUMNS];
  double default_radius; /* of rows that have none */

  double (*rows)[COLUMNS]; /* of the frame being read */
  size_t rows_count, rows_size;
  size_t frames;
  char error[512];
};

/* Puts "name:line: ..." into the error and returns GSL_EINVAL. */
int reader_fail(struct bed_reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The next line into r->line: GSL_SUCCESS, GSL_EOF, GSL_EINVAL, GSL_ENOMEM. A
   last line without an end is an error; in a partial file it is dropped. */
int reader_line(struct bed_reader *r);
bool line_is_blank(const char *line);

/* The next field from *at on, which moves on and is NULL behind the last. NULL
   if there is none. Quotes around it are left out. */
const char *reader_field(const struct bed_reader *r, const char **at,
                         size_t *length);
/* A whole field as a finite number; 1.0d0 is one as well. */
bool reader_number(const struct bed_reader *r, const char *field, size_t length,
                   double *value);
/* Both for a line that is one number. A count is whole and not negative. */
int reader_line_number(struct bed_reader *r, const char *what, double *value);
int reader_line_count(struct bed_reader *r, const char *what, size_t *count);

/* Columns: clear, add one by one, check. A name may stand for one column only
   once. */
void columns_clear(struct bed_reader *r, char separator);
int columns_add(struct bed_reader *r, enum column c);
int columns_check(struct bed_reader *r);

/* Parses the line into r->rows[r->rows_count] and counts it. */
int reader_row(struct bed_reader *r);

/* Turns the rows into a frame. */
int reader_frame(struct bed_reader *r, struct bed *b, double t);

/* A file of frames with stated counts that ends where it must not. With
   allow_partial its rows are the last frame. */
int reader_cut(struct bed_reader *r, struct bed *b, double t, const char *want);

#endif
