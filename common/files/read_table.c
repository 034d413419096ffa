/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables: a line of names, then a row for each sphere, as spreadsheets and
   programs of all kinds write them. Before the names there may be a title,
   behind them a line of units; lines that begin with #, % or // are comments,
   which mean nothing here. Without names three columns are x y z, and what more
   columns are --columns has to say. A blank line, other names or another time
   begin the next frame. */
#include "files/readers.h"

#include <string.h>
#include <gsl/gsl_errno.h>

struct table_state {
  double t;
  bool named;   /* it is known what the columns are, */
  bool bare;    /* though no names say so */
  bool fresh;   /* that was just read, and no row since */
  bool anew;    /* names were read since the last frame */
  bool titled;  /* there was a line that is no comment before */
  bool keyed;   /* a comment says radius=, as a bed's header does */
  size_t unfit; /* number of a comment that names three other columns */
};

static const char separators[] = {'\t', ';', ',', BLANKS};
enum { SEPARATORS = sizeof separators };

/* The names of a line by the separator that gives x, y and z; their number, 0
   if none does. */
static size_t find_names(const struct bed_reader *r, const char *line,
                         struct text names[MOST_FIELDS + 1], char *separator) {
  struct bed_reader as = *r;
  as.quotes = true;
  for (int k = 0; k < SEPARATORS; k++) {
    as.separator = *separator = separators[k];
    size_t count = reader_fields(&as, line + comment_sign(line), names);
    if (count > 1 && !names[count - 1].length)
      count--; /* a separator at the end of the line */
    if (count && count <= MOST_FIELDS && columns_named_place(count, names))
      return count;
  }
  return 0;
}

static bool has_names(const struct bed_reader *r, const char *line) {
  struct text names[MOST_FIELDS + 1];
  char separator;
  return find_names(r, line, names, &separator) > 0;
}

static bool takes_decimal_comma(char separator) {
  return separator == ';' || separator == '\t';
}

/* A row without names, or for the user's columns: the separator by which it is
   numbers in them. */
static bool find_row(const struct bed_reader *r, const char *line,
                     char *separator) {
  const struct columns *user = r->options.columns;
  struct text fields[MOST_FIELDS + 1];
  struct bed_reader as = *r;
  as.quotes = true;
  for (int k = 0; k < SEPARATORS; k++) {
    as.separator = *separator = separators[k];
    as.decimal_comma = takes_decimal_comma(*separator);
    const size_t count = reader_fields(&as, line, fields);
    bool numbers = user ? count >= user->count : count >= 3;
    for (size_t f = 0; numbers && f < (user ? user->count : count); f++) {
      double x;
      const enum column c = user ? user->at[f] : COLUMN_X;
      numbers = c == COLUMN_OTHER || c == COLUMN_ID ||
                reader_number(&as, fields[f], &x);
    }
    if (numbers)
      return true;
  }
  return false;
}

static bool begins_table(const struct bed_reader *r, const char *line,
                         bool first) {
  char separator;
  if (!r->options.columns && has_names(r, line))
    return true;
  return (first || r->options.columns) && !comment_sign(line) &&
         find_row(r, line, &separator);
}

static void set_separator(struct bed_reader *r, char separator) {
  struct table_state *s = r->state;
  r->separator = separator;
  r->decimal_comma = takes_decimal_comma(separator);
  s->named = s->fresh = s->anew = true;
}

static int read_names(struct bed_reader *r) {
  const struct table_state *s = r->state;
  struct text names[MOST_FIELDS + 1];
  char separator;
  const size_t count = find_names(r, r->line, names, &separator);
  struct columns *c = &r->columns;
  if (columns_of_names(c, count, names) != GSL_SUCCESS)
    return reader_fail(r, "%s", c->wrong);
  if (s->keyed)
    snprintf(c->dismissed, sizeof c->dismissed,
             "a key counts only under '# format=bed-1'; ");
  set_separator(r, separator);
  return reader_check_columns(r);
}

/* Rows without names. */
static int read_first_row(struct bed_reader *r, char separator) {
  static const enum column place[] = {COLUMN_X, COLUMN_Y, COLUMN_Z};
  struct text fields[MOST_FIELDS + 1];
  struct table_state *s = r->state;
  set_separator(r, separator);
  s->bare = true;
  if (!reader_takes_columns(r)) {
    const size_t count = reader_fields(r, r->line, fields);
    if (count == 3 && s->unfit) {
      r->line_number = s->unfit;
      return reader_fail(r, "three columns, but not x, y and z: expected "
                            "--columns, which says what each is");
    }
    if (count > 3)
      return reader_fail(r,
                         "%zu columns without names: expected --columns, such "
                         "as x,y,z,r, where - skips one",
                         count);
    columns_clear(&r->columns);
    for (int k = 0; k < 3; k++)
      columns_add(&r->columns, place[k],
                  (struct text){column_name(place[k]), 1});
  }
  return reader_check_columns(r);
}

/* Does the comment name three columns of which one, but not all, is ours? */
static bool names_others(const struct bed_reader *r) {
  struct text names[MOST_FIELDS + 1];
  struct bed_reader as = *r;
  for (int k = 0; k < SEPARATORS; k++) {
    as.separator = separators[k];
    if (reader_fields(&as, r->line + comment_sign(r->line), names) == 3 &&
        columns_named_any(3, names))
      return true;
  }
  return false;
}

/* Before the rows: names, or the first row of a table without any; all else is
   a title. */
static int read_start(struct bed_reader *r) {
  struct table_state *s = r->state;
  char separator;
  if (!r->options.columns && has_names(r, r->line))
    return read_names(r);
  if (comment_sign(r->line)) {
    const char *key = r->line + comment_sign(r->line);
    s->keyed |= !strncmp(key + strspn(key, " \t"), "radius=", 7);
    if (names_others(r))
      s->unfit = r->line_number;
    return GSL_SUCCESS;
  }
  if ((s->titled && !r->options.columns) || !find_row(r, r->line, &separator)) {
    s->titled = true;
    return GSL_SUCCESS;
  }
  r->held = true;
  return read_first_row(r, separator);
}

/* The line behind the names may hold units; and the first row shows whether
   rows have names, or the spheres, which then are no numbers. */
static int read_fresh(struct bed_reader *r) {
  struct table_state *s = r->state;
  struct columns *c = &r->columns;
  struct text fields[MOST_FIELDS + 1];
  size_t count = reader_fields(r, r->line, fields);
  double x;
  if (!fields[count - 1].length)
    count--; /* a separator at the end of the line */
  if (columns_of_units(c, count, fields))
    return GSL_SUCCESS;
  s->fresh = false;
  if (columns_check_units(c) != GSL_SUCCESS)
    return reader_fail(r, "%s", c->wrong);
  const bool quoted = fields[0].at > r->line && fields[0].at[-1] == '"';
  if (count == c->count + 1 && count <= MOST_FIELDS &&
      (quoted || !reader_number(r, fields[0], &x)))
    columns_skip_first(c);
  for (size_t k = 0; k < c->count && k < count; k++)
    if (c->at[k] == COLUMN_ID && !reader_number(r, fields[k], &x))
      columns_dismiss(c, k);
  r->held = true;
  return GSL_SUCCESS;
}

static int finish_frame(struct bed_reader *r, struct bed *b) {
  struct table_state *s = r->state;
  if (r->columns.has[COLUMN_T]) {
    const double t = r->rows[0][COLUMN_T];
    if (r->frames && t < s->t && !s->anew)
      return reader_fail(r, "time %g after %g: expected rows sorted by time", t,
                         s->t);
    r->part += r->frames && t < s->t; /* of another run */
    s->t = t;
  }
  s->anew = false;
  return reader_frame(r, b, s->t);
}

/* A row of another time is the next frame's. */
static bool begins_frame(struct bed_reader *r) {
  const size_t n = r->rows_count;
  if (!r->columns.has[COLUMN_T] || n < 2 ||
      r->rows[n - 1][COLUMN_T] == r->rows[n - 2][COLUMN_T])
    return false;
  r->rows_count--;
  return true;
}

static int finish_file(struct bed_reader *r, struct bed *b) {
  const struct table_state *s = r->state;
  if (r->cut)
    reader_note_cut(
        r,
        r->rows_count && r->columns.has[COLUMN_T] ? r->rows[0][COLUMN_T] : s->t,
        0);
  if (r->rows_count)
    return finish_frame(r, b);
  if (!r->frames || (s->fresh && !r->options.allow_partial))
    return reader_fail(r, "no spheres%s",
                       r->frames ? " in the last frame" : "");
  return GSL_EOF;
}

/* Nothing in any column. */
static bool is_empty(const struct bed_reader *r) {
  const char ends[] = {' ', '\t', r->separator, 0};
  return !r->line[strspn(r->line, ends)];
}

static int next_table(struct bed_reader *r, struct bed *b) {
  struct table_state *s = r->state;
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    const size_t before = r->rows_count;
    if (is_empty(r)) {
      if (r->rows_count)
        return finish_frame(r, b);
    } else if (!s->named) {
      status = read_start(r);
    } else if (comment_sign(r->line)) {
      continue;
    } else if (!before && !r->options.columns && has_names(r, r->line)) {
      if (s->bare || (s->fresh && r->frames))
        return reader_fail(r, "names behind %s",
                           s->bare ? "rows that have none"
                                   : "a frame of no spheres");
      status = read_names(r);
    } else if (s->fresh) {
      status = read_fresh(r);
    } else {
      status = reader_row(r);
      if (status == GSL_EINVAL && before && !r->options.columns && !s->bare &&
          has_names(r, r->line))
        r->held = true;
      else if (status == GSL_SUCCESS)
        r->held = begins_frame(r);
      if (r->held)
        return finish_frame(r, b);
    }
    if (status != GSL_SUCCESS)
      return status;
  }
  return status == GSL_EOF ? finish_file(r, b) : status;
}

const struct bed_format format_table = {
    .name = "table",
    .help = "names and rows, by tabs, semicolons, commas or blanks",
    .begins = begins_table,
    .quotes = true,
    .state_size = sizeof(struct table_state),
    .next = next_table};
