/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a field of a row may be, and what it is called. */
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
  COLUMNS
};

/* By name, any case, with the usual synonyms. */
enum column column_named(const char *name, size_t length);

/* Its name in our own format. */
const char *column_name(enum column c);

/* Are these bytes the word, in any case? */
bool same_word(const char *field, size_t length, const char *word);

#endif
