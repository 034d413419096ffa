/* SPDX-License-Identifier: GPL-3.0-or-later */
/* XYZ: a count, a comment, and a row for each sphere; in the extended form the
   comment says what the columns are (Properties=species:S:1:pos:R:3:...), and
   the time. github.com/libAtoms/extxyz describes it. */
#include "files/readers.h"

#include <string.h>
#include <gsl/gsl_errno.h>

/* Properties by the names that OVITO, ASE and others give them. */
static const struct {
  const char *name;
  enum column first;
  size_t count;
} properties[] = {
    /* clang-format off */
    {"pos", COLUMN_X, 3}, {"position", COLUMN_X, 3}, {"positions", COLUMN_X, 3},
    {"radius", COLUMN_R, 1}, {"radii", COLUMN_R, 1}, {"diameter", COLUMN_D, 1}, {"diameters", COLUMN_D, 1},
    {"mass", COLUMN_M, 1}, {"masses", COLUMN_M, 1},
    {"velo", COLUMN_VX, 3}, {"vel", COLUMN_VX, 3}, {"velocity", COLUMN_VX, 3}, {"velocities", COLUMN_VX, 3},
    {"omega", COLUMN_WX, 3}, {"spin", COLUMN_WX, 3}, {"angular_velocity", COLUMN_WX, 3},
    {"angular_velocities", COLUMN_WX, 3}
    /* clang-format on */
};

static bool begins_count(const char *line) {
  line += strspn(line, " \t");
  const size_t digits = strspn(line, "0123456789");
  return digits && line_is_blank(line + digits);
}

/* The value of key=value in the comment; quotes and brackets are left out and
   blanks around = let pass. */
static const char *find_value(const char *at, const char *key, size_t *length) {
  for (;;) {
    at += strspn(at, " \t,");
    if (!*at)
      return NULL;
    const char quote = *at == '"' || *at == '\'' ? *at : 0;
    const char *name = at + (quote != 0);
    const size_t name_length =
        quote ? strcspn(name, quote == '"' ? "\"" : "'") : strcspn(at, " \t=");
    at = name + name_length;
    at += *at && *at == quote;
    const char *equals = at + strspn(at, " \t");
    if (*equals != '=')
      continue;
    at = equals + 1;
    at += strspn(at, " \t");
    static const char open[] = "\"'{[", close[] = "\"'}]";
    const char *bracket = *at ? strchr(open, *at) : NULL;
    const char *value = at + (bracket != NULL);
    const char ends[2] = {bracket ? close[bracket - open] : ' ', 0};
    *length = strcspn(value, bracket ? ends : " \t");
    at = value + *length;
    at += bracket && *at;
    if (same_word(name, name_length, key))
      return value;
  }
}

/* One of the three parts of a property. */
static const char *part(const char **at, const char *end, size_t *length) {
  const char *field = *at;
  *length = 0;
  while (field + *length < end && field[*length] != ':')
    ++*length;
  *at = field + *length < end ? field + *length + 1 : end;
  return field;
}

static int read_properties(struct bed_reader *r, const char *at,
                           size_t length) {
  const char *const end = at + length;
  while (at < end) {
    size_t name_length, type_length, count_length;
    const char *name = part(&at, end, &name_length);
    const char *type = part(&at, end, &type_length);
    const char *digits = part(&at, end, &count_length);
    double count;
    if (!name_length || type_length != 1 || !strchr("RISLrisl", *type) ||
        !reader_number(r, digits, count_length, &count) || !(count >= 1) ||
        !(count <= MOST_FIELDS) || count != (double)(size_t)count)
      return reader_fail(r, "Properties: expected name:type:count at '%.*s'",
                         end - name > 40 ? 40 : (int)(end - name), name);
    enum column first = COLUMN_OTHER;
    for (size_t k = 0; k < sizeof properties / sizeof *properties; k++)
      if (same_word(name, name_length, properties[k].name) &&
          (size_t)count == properties[k].count)
        first = properties[k].first;
    if (first == COLUMN_OTHER && count == 1)
      first = column_named(name, name_length);
    if (first == COLUMN_T)
      first = COLUMN_OTHER; /* a frame has one time */
    for (size_t k = 0; k < (size_t)count; k++) {
      const int status = columns_add(
          r, first == COLUMN_OTHER ? COLUMN_OTHER : (enum column)(first + k));
      if (status != GSL_SUCCESS)
        return status;
    }
  }
  return GSL_SUCCESS;
}

static int read_comment(struct bed_reader *r, double *t) {
  size_t length;
  int status = GSL_SUCCESS;
  columns_clear(r, BLANKS);
  const char *value = find_value(r->line, "Properties", &length);
  const bool extended = value != NULL;
  r->more_fields = !extended;
  if (extended) {
    status = read_properties(r, value, length);
  } else {
    static const enum column plain[] = {COLUMN_OTHER, COLUMN_X, COLUMN_Y,
                                        COLUMN_Z};
    for (int k = 0; k < 4; k++)
      status = columns_add(r, plain[k]);
  }
  if (status == GSL_SUCCESS)
    status = columns_check(r);
  if (status != GSL_SUCCESS)
    return status;
  value = find_value(r->line, "time", &length);
  if (!value)
    value = find_value(r->line, "t", &length);
  if (!value)
    return GSL_SUCCESS;
  while (length && value[length - 1] == ',')
    length--;
  double time;
  if (reader_number(r, value, length, &time))
    *t = time;
  else if (extended)
    return reader_fail(r, "time is '%.*s': expected a finite number",
                       length > 40 ? 40 : (int)length, value);
  return GSL_SUCCESS;
}

static int next_xyz(struct bed_reader *r, struct bed *b) {
  double t = (double)r->frames;
  size_t count;
  int status;
  do
    status = reader_line(r);
  while (status == GSL_SUCCESS && line_is_blank(r->line));
  if (status != GSL_SUCCESS) /* the end, but of what came before */
    return status;
  columns_clear(r, BLANKS);
  if (!begins_count(r->line))
    return reader_fail(r, "'%.40s': expected the number of atoms", r->line);
  status = reader_line_count(r, "the number of atoms", &count);
  if (status == GSL_SUCCESS)
    status = reader_line(r);
  if (status == GSL_EOF)
    return reader_cut(r, b, t, "a comment");
  if (status == GSL_SUCCESS)
    status = read_comment(r, &t);
  while (status == GSL_SUCCESS && r->rows_count < count) {
    status = reader_line(r);
    if (status == GSL_EOF)
      return reader_cut(r, b, t, "another atom");
    if (status == GSL_SUCCESS)
      status = reader_row(r);
  }
  return status == GSL_SUCCESS ? reader_frame(r, b, t) : status;
}

const struct bed_format format_xyz = {"xyz", "XYZ plain and extended",
                                      begins_count, 1, next_xyz};
