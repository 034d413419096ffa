/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own format, and tables: a line of names, then a row for each sphere.
   What begins with "# key=value" is a bed, whose columns are known and whose
   end is marked. A table may have other columns besides and just ends. */
#include "files/readers.h"

#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"

static const double default_radius = 0.1; /* settle's */

struct bed_state {
  double t;
  bool may_be_table, table; /* no bed but names of columns and rows */
  bool walls_stale;         /* the next wall line begins a new set */
  bool complete;            /* the status line was read */
  bool named;               /* column names were read since the last frame, */
  bool timed;               /* or a time, so there must be rows; */
  bool apart;               /* a blank line came since that time */
};

static char *trim(char *text) {
  text += strspn(text, " \t");
  size_t length = strlen(text);
  while (length && strchr(" \t", text[length - 1]))
    text[--length] = 0;
  return text;
}

/* "key=value", blanks around each; other comments are passed over. */
static int read_key(struct bed_reader *r, char *text) {
  struct bed_state *s = r->state;
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
  if (!strcmp(name, "radius") && !number_parse(value, &r->default_radius))
    return reader_fail(r, "radius=%s: expected a number above 0", value);
  if (!strcmp(name, "t")) {
    if (!number_parse(value, &s->t))
      return reader_fail(r, "t=%s: expected a finite number", value);
    if (s->timed && s->apart)
      return reader_fail(r, "t=%s: no spheres since the t before", value);
    s->timed = true;
    s->apart = false;
  }
  if (!strcmp(name, "status"))
    s->complete = true;
  if (strcmp(name, "wall"))
    return bed_header_set(&r->header, name, value);
  if (s->walls_stale)
    bed_header_remove(&r->header, "wall");
  s->walls_stale = false;
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
  return has[COLUMN_X] && has[COLUMN_Y] && has[COLUMN_Z];
}

static int read_names(struct bed_reader *r, const char *line) {
  struct bed_state *s = r->state;
  if (s->may_be_table && !r->columns_count)
    s->table = !r->header.count || strpbrk(line, ",;");
  if (s->table && !has_names(r, line))
    return reader_fail(r, "expected a bed, a table with columns x, y and z, a "
                          "LAMMPS dump or an XYZ file");
  columns_clear(r, s->table ? separator_of(line) : BLANKS);
  r->decimal_comma = r->separator == ';' || r->separator == '\t';
  if (!s->table && r->default_radius == 0 &&
      !bed_header_get(&r->header, "radius"))
    r->default_radius = default_radius;
  size_t length = 0;
  int status = GSL_SUCCESS;
  for (const char *name;
       status == GSL_SUCCESS && (name = reader_field(r, &line, &length));) {
    const enum column c = column_named(name, length);
    if (!s->table && (c == COLUMN_OTHER || c == COLUMN_D || c == COLUMN_T ||
                      strlen(column_name(c)) != length ||
                      strncmp(name, column_name(c), length)))
      return reader_fail(r,
                         "unknown column '%.*s': expected id x y z r m vx vy "
                         "vz wx wy wz",
                         length > 40 ? 40 : (int)length, name);
    status = columns_add(r, c);
  }
  if (r->separator != BLANKS && !length && r->columns_count > 1)
    r->columns_count--; /* a separator at the end of the line */
  s->named = true;
  return status == GSL_SUCCESS ? columns_check(r) : status;
}

static int finish_frame(struct bed_reader *r, struct bed *b) {
  struct bed_state *s = r->state;
  if (r->has[COLUMN_T]) {
    const double t = r->rows[0][COLUMN_T];
    if (r->frames && t < s->t)
      return reader_fail(r, "time %g after %g: expected rows sorted by time", t,
                         s->t);
    s->t = t;
  }
  s->walls_stale = true;
  s->named = s->timed = false;
  return reader_frame(r, b, s->t);
}

/* A row of a table with a column of times; one of another time is the next
   frame's. */
static bool begins_frame(struct bed_reader *r) {
  const size_t n = r->rows_count;
  if (!r->has[COLUMN_T] || n < 2 ||
      r->rows[n - 1][COLUMN_T] == r->rows[n - 2][COLUMN_T])
    return false;
  r->rows_count--;
  r->held = true;
  return true;
}

/* What stands at the end of the file decides whether it is whole. */
static int finish_file(struct bed_reader *r, struct bed *b) {
  const struct bed_state *s = r->state;
  if (!r->options.allow_partial) {
    if (!s->complete && !s->table)
      return reader_fail(
          r, "the file ends without '# status=ok': it is cut short");
    if (s->complete && strcmp(bed_header_get(&r->header, "status"), "ok"))
      return reader_fail(r, "the file is marked status=%s",
                         bed_header_get(&r->header, "status"));
  }
  if (r->rows_count)
    return finish_frame(r, b);
  if (!r->frames)
    return reader_fail(r, "no spheres");
  if (!r->options.allow_partial && (s->named || s->timed))
    return reader_fail(r, "no spheres in the last frame");
  return GSL_EOF;
}

static bool begins_row(const struct bed_reader *r, const char *line) {
  const struct bed_state *s = r->state;
  if (s->table)
    return r->columns_count && (r->rows_count || !has_names(r, line));
  return strchr("0123456789+-.", *line) || !strncmp(line, "nan", 3) ||
         !strncmp(line, "inf", 3);
}

static int next_bed(struct bed_reader *r, struct bed *b) {
  struct bed_state *s = r->state;
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    char *line = r->line + strspn(r->line, "\t ");
    if (!*line || (s->table && !line[strspn(line, " \t,;")])) {
      if (r->rows_count)
        return finish_frame(r, b);
      if (s->named)
        return reader_fail(r, "no spheres in the frame that ends here");
      s->apart = true;
    } else if (s->complete) {
      return reader_fail(r, "more after the line of the status");
    } else if (*line == '#') {
      if (s->may_be_table && !r->columns_count && has_names(r, line + 1))
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

/* A table's column names may stand behind a #, as a bed's keys do. */
static int next_table(struct bed_reader *r, struct bed *b) {
  struct bed_state *s = r->state;
  if (!s->may_be_table)
    s->may_be_table = s->table = true;
  return next_bed(r, b);
}

static bool never(const char *line) {
  (void)line;
  return false;
}

static bool always(const char *line) {
  (void)line;
  return true;
}

const struct bed_format format_bed = {"bed", "our own", never,
                                      sizeof(struct bed_state), next_bed};
const struct bed_format format_table = {
    "table", "a line of column names, a row for each sphere", always,
    sizeof(struct bed_state), next_table};
