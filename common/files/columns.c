/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "files/columns.h"

#include <string.h>
#include <strings.h>

static const struct {
  const char *name; /* a column's first one is that of our own format */
  enum column column;
} names[] = {
    /* clang-format off */
    {"id", COLUMN_ID},
    {"x", COLUMN_X}, {"y", COLUMN_Y}, {"z", COLUMN_Z},
    {"r", COLUMN_R}, {"radius", COLUMN_R},
    {"d", COLUMN_D}, {"diameter", COLUMN_D},
    {"m", COLUMN_M}, {"mass", COLUMN_M},
    {"vx", COLUMN_VX}, {"vy", COLUMN_VY}, {"vz", COLUMN_VZ},
    {"wx", COLUMN_WX}, {"wy", COLUMN_WY}, {"wz", COLUMN_WZ},
    {"omegax", COLUMN_WX}, {"omegay", COLUMN_WY}, {"omegaz", COLUMN_WZ},
    {"t", COLUMN_T}, {"time", COLUMN_T}
    /* clang-format on */
};
enum { NAMES = sizeof names / sizeof *names };

bool same_word(const char *field, size_t length, const char *word) {
  return length == strlen(word) && !strncasecmp(field, word, length);
}

enum column column_named(const char *name, size_t length) {
  for (int k = 0; k < NAMES; k++)
    if (same_word(name, length, names[k].name))
      return names[k].column;
  return COLUMN_OTHER;
}

const char *column_name(enum column c) {
  for (int k = 0; k < NAMES; k++)
    if (names[k].column == c)
      return names[k].name;
  return "?";
}
