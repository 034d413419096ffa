/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table that a verb prints: names, rows, what separates frames; a column
   `file` where there are several; mean and standard error over beds. Numbers
   are the shortest that read back the same. Tested in tests/test_tables.sh. */
#ifndef TABLE_H
#define TABLE_H

#include "frames.h"

/* Row of an option table, into a bool. */
/* clang-format off */
#define MEAN_OPTION(mean_)                                                     \
  {.name = "mean", .type = OPTION_FLAG, .value = &(mean_),                     \
   .help = "add mean and standard error over beds, or over one bed's frames"}
/* Row of an option table, into a struct frames_options s. */
#define ORIGIN_OPTION(s)                                                       \
  {.name = "origin", .type = OPTION_FLAG, .value = &(s).origin,                \
   .help = "begin with lines # that say what made the table"}
/* clang-format on */

enum table_layout {
  TABLE_ROWS,  /* a row for each frame, names once */
  TABLE_PARTS, /* several rows, an empty line between frames, names once */
  TABLE_BLOCKS /* several rows, two empty lines between frames, names each time
                */
};

struct table_cell;

/* Cells of a mean: row k is that of all k-th rows of a bed, or of a frame. */
struct table_mean {
  struct table_cell *cells;
  size_t rows, size;      /* of cells, of their memory */
  size_t row, first_rows; /* of the bed or frame at hand, of the first one */
  size_t count;           /* of beds or frames */
  bool uneven;            /* they differ in the number of rows */
};

struct table {
  const struct frames *frames;
  const char *names;
  const char *kernel; /* instruction set that it depends on, NULL: on none */
  enum table_layout layout;
  bool file, mean;
  size_t columns, column; /* how many, the next one */
  size_t frames_count;
  struct table_mean beds, each; /* over beds, over frames */
};

/* mean: of the frames that are to come, see MEAN_OPTION. */
void table_open(struct table *t, const struct frames *f, bool mean);

/* Begins the rows of the frame just read. names: of the columns, separated by
   tabs; always the same. */
void table_frame(struct table *t, enum table_layout layout, const char *names);

/* One field of a row, and its end. nan has no sign. */
void table_number(struct table *t, double x);
void table_count(struct table *t, size_t n);
void table_id(struct table *t, long id);
void table_text(struct table *t, const char *text);
void table_end_row(struct table *t);

/* Prints the rows of means, if these are wanted; exits with EXIT_INPUT if beds
   have different numbers of rows. */
void table_close(struct table *t);

#endif
