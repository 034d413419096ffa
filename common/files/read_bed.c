/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own format, and tables: a line of names, then a row for each sphere.
   What begins with "# key=value" is a bed, whose columns are known and whose
   end is marked. A table may have other columns besides and just ends. */
#include "files/bed_reader.h"

#include <string.h>
#include <gsl/gsl_errno.h>
#include "program/options.h"

static const double default_radius = 0.1; /* settle's */

static char *trim(char *text) {
  text += strspn(text, " \t");
  size_t length = strlen(text);
  while (length && strchr(" \t", text[length - 1]))
    text[--length] = 0;
  return text;
}

/* "key=value", blanks around each; other comments are passed over. */
static int read_key(struct bed_reader *r, char *text) {
  char *value = strchr(text, '=');
  if (!value)
    return GSL_SUCCESS;
  *value++ = 0;
  const char *name = trim(text);
  value = trim(value);
  if (!*name || strpbrk(name, " \t"))
    return GSL_SUCCESS;
  if (r->header.count >= MOST_KEYS)
    return reader_fail(r, "more than %d keys", MOST_KEYS);
  if (!strcmp(name, "format") && strcmp(value, "bed-1"))
    return reader_fail(r, "format=%s: expected bed-1", value);
  if (!strcmp(name, "radius") && !parse_double(value, &r->default_radius))
    return reader_fail(r, "radius=%s: expected a number above 0", value);
  if (!strcmp(name, "t")) {
    if (!parse_double(value, &r->t))
      return reader_fail(r, "t=%s: expected a finite number", value);
    if (r->timed && r->apart)
      return reader_fail(r, "t=%s: no spheres since the t before", value);
    r->timed = true;
    r->apart = false;
  }
  if (!strcmp(name, "status"))
    r->complete = true;
  if (strcmp(name, "wall"))
    return bed_header_set(&r->header, name, value);
  if (r->walls_stale)
    bed_header_remove(&r->header, "wall");
  r->walls_stale = false;
  return bed_header_add(&r->header, name, value);
}

/* What separates the names of a table, unless it is one of beds. */
static char separator_of(const char *names) {
  return strchr(names, ';')    ? ';'
         : strchr(names, ',')  ? ','
         : strchr(names, '\t') ? '\t'
                               : BLANKS;
}

static bool has_names(const struct bed_reader *r, const char *line) {
  struct bed_reader as = *r;
  as.separator = separator_of(line);
  bool has[COLUMNS] = {false};
  size_t length = 0;
  for (const char *name; (name = reader_field(&as, &line, &length));)
    has[column_named(name, length)] = true;
  return has[X] && has[Y] && has[Z];
}

static int read_names(struct bed_reader *r, const char *line) {
  if (r->may_be_table && !r->columns_count)
    r->table = !r->header.count || strpbrk(line, ",;");
  if (r->table && !has_names(r, line))
    return reader_fail(r, "expected a bed, a table with columns x, y and z, a "
                          "LAMMPS dump or an XYZ file");
  columns_clear(r, r->table ? separator_of(line) : BLANKS);
  r->decimal_comma = r->separator == ';' || r->separator == '\t';
  if (!r->table && r->default_radius == 0 &&
      !bed_header_get(&r->header, "radius"))
    r->default_radius = default_radius;
  size_t length = 0;
  int status = GSL_SUCCESS;
  for (const char *name;
       status == GSL_SUCCESS && (name = reader_field(r, &line, &length));) {
    const enum column c = column_named(name, length);
    if (!r->table &&
        (c == OTHER || c == D || c == T || strlen(column_name(c)) != length ||
         strncmp(name, column_name(c), length)))
      return reader_fail(r,
                         "unknown column '%.*s': expected id x y z r m vx vy "
                         "vz wx wy wz",
                         length > 40 ? 40 : (int)length, name);
    status = columns_add(r, c);
  }
  if (r->separator != BLANKS && !length && r->columns_count > 1)
    r->columns_count--; /* a separator at the end of the line */
  r->named = true;
  return status == GSL_SUCCESS ? columns_check(r) : status;
}

static int finish_frame(struct bed_reader *r, struct bed *b) {
  if (r->has[T]) {
    const double t = r->rows[0][T];
    if (r->frames && t < r->t)
      return reader_fail(r, "time %g after %g: expected rows sorted by time", t,
                         r->t);
    r->t = t;
  }
  r->walls_stale = true;
  r->named = r->timed = false;
  return reader_frame(r, b, r->t);
}

/* A row of a table with a column of times; one of another time is the next
   frame's. */
static bool begins_frame(struct bed_reader *r) {
  const size_t n = r->rows_count;
  if (!r->has[T] || n < 2 || r->rows[n - 1][T] == r->rows[n - 2][T])
    return false;
  r->rows_count--;
  r->held = true;
  return true;
}

/* What stands at the end of the file decides whether it is whole. */
static int finish_file(struct bed_reader *r, struct bed *b) {
  if (!r->options.allow_partial) {
    if (!r->complete && !r->table)
      return reader_fail(
          r, "the file ends without '# status=ok': it is cut short");
    if (r->complete && strcmp(bed_header_get(&r->header, "status"), "ok"))
      return reader_fail(r, "the file is marked status=%s",
                         bed_header_get(&r->header, "status"));
  }
  if (r->rows_count)
    return finish_frame(r, b);
  if (!r->frames)
    return reader_fail(r, "no spheres");
  if (!r->options.allow_partial && (r->named || r->timed))
    return reader_fail(r, "no spheres in the last frame");
  return GSL_EOF;
}

static bool begins_row(const struct bed_reader *r, const char *line) {
  if (r->table)
    return r->columns_count && (r->rows_count || !has_names(r, line));
  return strchr("0123456789+-.", *line) || !strncmp(line, "nan", 3) ||
         !strncmp(line, "inf", 3);
}

int read_bed(struct bed_reader *r, struct bed *b) {
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    char *line = r->line + strspn(r->line, "\t ");
    if (!*line || (r->table && !line[strspn(line, " \t,;")])) {
      if (r->rows_count)
        return finish_frame(r, b);
      if (r->named)
        return reader_fail(r, "no spheres in the frame that ends here");
      r->apart = true;
    } else if (r->complete) {
      return reader_fail(r, "more after the line of the status");
    } else if (*line == '#') {
      if (r->may_be_table && !r->columns_count && has_names(r, line + 1))
        status = read_names(r, line + 1);
      else
        status = read_key(r, line + 1);
    } else if (!begins_row(r, line)) {
      status = read_names(r, line);
    } else if (!r->columns_count) {
      status = reader_fail(
          r, "expected a line of column names before the first sphere");
    } else {
      status = reader_row(r);
      if (status == GSL_SUCCESS && begins_frame(r))
        return finish_frame(r, b);
    }
    if (status != GSL_SUCCESS)
      return status;
  }
  return status == GSL_EOF ? finish_file(r, b) : status;
}
