/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meanings of the columns of a table: by the names that other programs give
   them, by their units and by the columns beside them. Two columns that may
   have the same meaning are an error, which names both. Safe in any thread.
   Tested in tests/test_columns.c. */
#ifndef COLUMNS_H
#define COLUMNS_H

#include <stdbool.h>
#include <stddef.h>

enum column {
  COLUMN_OTHER, /* none of ours */
  COLUMN_ID,
  COLUMN_X,
  COLUMN_Y,
  COLUMN_Z,
  COLUMN_R,
  COLUMN_D, /* a diameter */
  COLUMN_M,
  COLUMN_VX,
  COLUMN_VY,
  COLUMN_VZ,
  COLUMN_WX,
  COLUMN_WY,
  COLUMN_WZ,
  COLUMN_T,
  COLUMN_FIXED, /* 1: an obstacle, 0: it moves */
  COLUMNS
};

enum {
  MOST_FIELDS = 256, /* of a row */
  LONGEST_NAME = 32  /* bytes kept of a name, for messages */
};

/* Bytes of a line. */
struct text {
  const char *at;
  size_t length;
};

struct columns {
  size_t count;
  unsigned char at[MOST_FIELDS]; /* enum column, as they stand in a row */
  double unit[MOST_FIELDS];      /* a field times this is in SI */
  bool said[MOST_FIELDS];        /* its unit, by the table */
  bool has[COLUMNS];
  char name[COLUMNS][LONGEST_NAME]; /* what those it has are called */
  char dismissed[96]; /* why a column that has the name of a radius is none */
  char wrong[224];    /* the last error */
};

void columns_clear(struct columns *c);

/* Appends one. GSL_EINVAL, with c->wrong, if another has the same meaning or
   there are too many. */
int columns_add(struct columns *c, enum column what, struct text name);

/* All columns of a table with a line of names, whatever program wrote it. In
   place of what c was. GSL_EINVAL as above. */
int columns_of_names(struct columns *c, size_t count, const struct text *names);

/* Would these names give x, y and z? One of ours, or an angle? */
bool columns_named_place(size_t count, const struct text *names);
bool columns_named_any(size_t count, const struct text *names);

/* From the user's list: names separated by commas, "-" for a column that is to
   be skipped. GSL_EINVAL as above. */
int columns_of_list(struct columns *c, const char *list);

/* GSL_EINVAL, with c->wrong, if one length, or one speed, has a unit other than
   SI's and another one has none: r beside "x [mm]". */
int columns_check_units(struct columns *c);

/* Where a format names its columns itself: takes the radius from one that is
   just r, if by its neighbours it is a colour or a coordinate. what: those of
   names, changed. GSL_EINVAL as above. */
int columns_settle_radius(struct columns *c, size_t count,
                          const struct text *names, enum column *what);

/* Takes the units of a row of units. False, and all as it was, if it is none:
   each field of a column of ours is a unit, or says that there is none. */
bool columns_of_units(struct columns *c, size_t count,
                      const struct text *fields);

/* Rows have one field more, in front, which is none of ours. */
void columns_skip_first(struct columns *c);
/* Column k is none of ours after all. */
void columns_dismiss(struct columns *c, size_t k);

/* Are there x, y and z? */
bool columns_place(const struct columns *c);

/* By our own names and their few synonyms, any case, without units: where a
   format says what its columns are called. */
enum column column_named(struct text name);

/* Its name in our own format. */
const char *column_name(enum column c);

/* Are these bytes the word, in any case? */
bool same_word(struct text text, const char *word);

#endif
