/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the readers of all formats: lines with their numbers, messages
   that name them, fields, rows, frames. It knows of no format. For
   files/read_*.c and formats.c; others use formats.h. */
#ifndef BED_READER_H
#define BED_READER_H

#include <stdio.h>
#include "files/bed_io.h"
#include "files/columns.h"
#include "files/reader_options.h"

enum {
  MOST_KEYS = 4096,       /* of a header; each is looked for among all */
  LONGEST_LINE = 1 << 20, /* bytes; what is longer is not one of our formats */
  BLANKS = 0              /* separator: any number of spaces and tabs */
};

struct bed_reader;

/* A format and its reader. */
struct bed_format {
  const char *name, *help;
  /* Does this line say that the file has this format? first: only blank lines
     and comments came before it. */
  bool (*begins)(const struct bed_reader *r, const char *line, bool first);
  bool quotes;       /* fields may stand in quotes */
  size_t state_size; /* bytes of r->state, the reader's own; zeros at first */
  /* As bed_reader_next. */
  int (*next)(struct bed_reader *, struct bed *);
};

/* A line that was read before it was clear what it is. */
struct kept_line {
  char *text;
  size_t number;
};

struct bed_reader {
  FILE *in;
  const char *name;
  struct bed_reader_options options;
  const struct bed_format *format; /* NULL: not yet known */
  void *state;                     /* the format's */
  struct bed_header header;
  size_t part;

  char *line; /* the last one read, without its end */
  size_t line_size, line_number, lines_read;
  bool cut;               /* the last line had no end and was left out */
  bool cut_noted;         /* bed_reader_note has told */
  bool held;              /* reader_line gives the same line again */
  bool quotes;            /* "a, b" is one field, and may go over lines */
  struct kept_line *kept; /* of these the next one comes before the file's */
  size_t kept_count, kept_size, kept_next;

  char separator;
  bool decimal_comma; /* 0,5 is a number as well */
  bool more_fields;   /* than there are columns are no error */
  struct columns columns;
  double default_radius; /* of rows that have none */

  double (*rows)[COLUMNS]; /* of the frame being read */
  size_t rows_count, rows_size;
  size_t frames;
  char sum[9]; /* the frame's checksum, as the file has it; or empty */
  char error[512], note[256];
};

/* Puts "name:line: ..." into the error and returns GSL_EINVAL. */
int reader_fail(struct bed_reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Puts "name:line: ..." where bed_reader_note finds it. */
void reader_note(struct bed_reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The next line into r->line: GSL_SUCCESS, GSL_EOF, GSL_EINVAL, GSL_ENOMEM. A
   last line without an end is an error; in a partial file it is dropped. */
int reader_line(struct bed_reader *r);
/* Keeps the line for reader_rewind, after which reader_line gives those that
   were kept once more. GSL_ENOMEM. */
int reader_keep(struct bed_reader *r);
void reader_rewind(struct bed_reader *r);
bool line_is_blank(const char *line);
/* Behind the #, % or // of a comment; 0: it is none. */
size_t comment_sign(const char *line);

/* The next field from *at on, which moves on and is NULL behind the last. NULL
   if there is none. Quotes around it are left out. */
const char *reader_field(const struct bed_reader *r, const char **at,
                         size_t *length);
/* All of them, at most MOST_FIELDS + 1; how many. */
size_t reader_fields(const struct bed_reader *r, const char *line,
                     struct text fields[MOST_FIELDS + 1]);
/* A whole field as a finite number; 1.0d0 is one as well. */
bool reader_number(const struct bed_reader *r, struct text field,
                   double *value);
/* Both for a line that is one number. A count is whole and not negative. */
int reader_line_number(struct bed_reader *r, const char *what, double *value);
int reader_line_count(struct bed_reader *r, const char *what, size_t *count);

/* Removes all columns. From now on fields have this separator and no quotes. */
void reader_clear_columns(struct bed_reader *r, char separator);
/* As columns_add, with the error in r. */
int reader_add_column(struct bed_reader *r, enum column c, struct text name);
/* As columns_settle_radius, with the error in r. */
int reader_settle_radius(struct bed_reader *r, size_t count,
                         const struct text *names, enum column *what);
/* The columns that the user said, if there are any. */
bool reader_takes_columns(struct bed_reader *r);
/* Is there what makes a sphere? */
int reader_check_columns(struct bed_reader *r);

/* Parses the line into r->rows[r->rows_count] and counts it. */
int reader_row(struct bed_reader *r);

/* Turns the rows into a frame. */
int reader_frame(struct bed_reader *r, struct bed *b, double t);

/* A file of frames of count spheres each that ends where something else is
   wanted. With allow_partial its rows are the last frame. */
int reader_cut(struct bed_reader *r, struct bed *b, double t, const char *want,
               size_t count);
/* Notes that rows of the last frame are read, of count (0: not known), from a
   file that is cut short. */
void reader_note_cut(struct bed_reader *r, double t, size_t count);

#endif
