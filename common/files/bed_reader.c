/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "files/bed_reader.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"

int reader_fail(struct bed_reader *r, const char *format, ...) {
  int used =
      snprintf(r->error, sizeof r->error, "%s:%zu: ", r->name, r->line_number);
  if (used < 0 || (size_t)used >= sizeof r->error)
    used = 0;
  va_list args;
  va_start(args, format);
  vsnprintf(r->error + used, sizeof r->error - (size_t)used, format, args);
  va_end(args);
  /* what a file says may be anything, a terminal's control codes too */
  for (char *c = r->error; *c; c++)
    if (iscntrl((unsigned char)*c))
      *c = '?';
  return GSL_EINVAL;
}

/* Lines */

static int read_line(struct bed_reader *r, size_t *length) {
  size_t n = 0;
  int c;
  flockfile(r->in);
  do {
    if (n + 1 >= r->line_size) {
      const size_t size = 2 * r->line_size + 256;
      char *line = realloc(r->line, size);
      if (!line) {
        funlockfile(r->in);
        return GSL_ENOMEM;
      }
      r->line = line;
      r->line_size = size;
    }
    c = getc_unlocked(r->in);
    if (c != EOF)
      r->line[n++] = (char)c;
  } while (c > 0 && c != '\n' && n <= LONGEST_LINE);
  funlockfile(r->in);
  r->line[n] = 0;
  *length = n;
  if (c == EOF && ferror(r->in))
    return reader_fail(r, "read error");
  return n ? GSL_SUCCESS : GSL_EOF;
}

int reader_line(struct bed_reader *r) {
  if (r->held) {
    r->held = false;
    return GSL_SUCCESS;
  }
  size_t length;
  const int status = read_line(r, &length);
  if (status != GSL_SUCCESS)
    return status;
  char *line = r->line;
  r->line_number++;
  if (!line[length - 1])
    return reader_fail(r, "a NUL byte: expected text");
  if (length > LONGEST_LINE)
    return reader_fail(r, "a line of more than %d bytes", LONGEST_LINE);
  if (line[length - 1] != '\n')
    return r->options.allow_partial
               ? GSL_EOF
               : reader_fail(r, "the last line has no end: the file is cut "
                                "short, or lacks its last newline");
  line[--length] = 0;
  if (length && line[length - 1] == '\r')
    line[--length] = 0;
  if (r->line_number == 1 && !strncmp(line, "\xEF\xBB\xBF", 3))
    memmove(line, line + 3, length - 2); /* a byte order mark */
  return GSL_SUCCESS;
}

bool line_is_blank(const char *line) {
  return !line[strspn(line, " \t")];
}

/* Fields */

const char *reader_field(const struct bed_reader *r, const char **at,
                         size_t *length) {
  if (!*at)
    return NULL;
  const char *field = *at;
  field += strspn(field, r->separator == '\t' ? " " : " \t");
  if (r->separator == BLANKS) {
    *length = strcspn(field, " \t");
    *at = field[*length] ? field + *length : NULL;
    return *length ? field : NULL;
  }
  const char *end;
  if (*field == '"' && (end = strchr(field + 1, '"'))) {
    field++;
    *length = (size_t)(end - field);
    end = strchr(end, r->separator);
  } else {
    end = strchr(field, r->separator);
    *length = end ? (size_t)(end - field) : strlen(field);
    while (*length && strchr(" \t", field[*length - 1]))
      --*length;
  }
  *at = end ? end + 1 : NULL;
  return field;
}

bool reader_number(const struct bed_reader *r, const char *field, size_t length,
                   double *value) {
  if (!length || isspace((unsigned char)*field))
    return false;
  char *end;
  double x = strtod(field, &end);
  if (end != field + length) {
    char copy[128]; /* with C's exponent and point */
    if (length >= sizeof copy)
      return false;
    for (size_t k = 0; k < length; k++)
      copy[k] = strchr("dD", field[k])                ? 'e'
                : r->decimal_comma && field[k] == ',' ? '.'
                                                      : field[k];
    copy[length] = 0;
    x = strtod(copy, &end);
    if (end != copy + length)
      return false;
  }
  if (!isfinite(x))
    return false;
  *value = x;
  return true;
}

/* For messages: what a line or field holds, not all of a long one. */
static int some(size_t length) {
  return length > 40 ? 40 : (int)length;
}

int reader_line_number(struct bed_reader *r, const char *what, double *value) {
  const char *at = r->line;
  size_t length = 0;
  const char *field = reader_field(r, &at, &length);
  if (!field || !reader_number(r, field, length, value) ||
      !line_is_blank(field + length))
    return reader_fail(r, "%s is '%.40s': expected a finite number", what,
                       r->line);
  return GSL_SUCCESS;
}

int reader_line_count(struct bed_reader *r, const char *what, size_t *count) {
  double x;
  if (reader_line_number(r, what, &x) != GSL_SUCCESS || !(x >= 0) ||
      !number_is_whole(x))
    return reader_fail(r, "%s is '%.40s': expected a whole number", what,
                       r->line);
  *count = (size_t)x;
  return GSL_SUCCESS;
}

/* Columns */

void columns_clear(struct bed_reader *r, char separator) {
  r->separator = separator;
  r->columns_count = 0;
  memset(r->has, 0, sizeof r->has);
}

int columns_add(struct bed_reader *r, enum column c) {
  assert(c < COLUMNS && r->columns_count <= MOST_FIELDS);
  if (r->columns_count == MOST_FIELDS)
    return reader_fail(r, "more than %d columns", MOST_FIELDS);
  if (c != COLUMN_OTHER && r->has[c])
    return reader_fail(r, "column '%s' stands twice", column_name(c));
  r->has[c] = true;
  r->columns[r->columns_count++] = (unsigned char)c;
  return GSL_SUCCESS;
}

int columns_check(struct bed_reader *r) {
  if (!r->has[COLUMN_X] || !r->has[COLUMN_Y] || !r->has[COLUMN_Z])
    return reader_fail(r, "columns x, y and z are expected");
  if (!r->has[COLUMN_R] && !r->has[COLUMN_D] && r->default_radius == 0)
    return reader_fail(r, "the spheres have no radius: expected a column "
                          "radius or diameter, or --radius");
  return GSL_SUCCESS;
}

/* Rows */

static int check_row(struct bed_reader *r, double *row) {
  if (r->has[COLUMN_D] && !(row[COLUMN_D] > 0))
    return reader_fail(r, "diameter %g: expected a number above 0",
                       row[COLUMN_D]);
  if (r->has[COLUMN_D] && !r->has[COLUMN_R])
    row[COLUMN_R] = row[COLUMN_D] / 2;
  if (!(row[COLUMN_R] > 0))
    return reader_fail(r, "radius %g: expected a number above 0",
                       row[COLUMN_R]);
  if (!(row[COLUMN_M] > 0))
    return reader_fail(r, "mass %g: expected a number above 0", row[COLUMN_M]);
  if (!number_is_whole(row[COLUMN_ID]))
    return reader_fail(r, "id %.17g: expected a whole number", row[COLUMN_ID]);
  const double most = r->options.largest;
  for (int c = COLUMN_X; most > 0 && c < COLUMN_T; c++)
    if (!(fabs(row[c]) <= most))
      return reader_fail(r, "%s is %g: expected at most %g", column_name(c),
                         row[c], most);
  return GSL_SUCCESS;
}

int reader_row(struct bed_reader *r) {
  assert(r->rows_count <= r->rows_size && r->columns_count);
  if (r->rows_count == r->rows_size) {
    const size_t size = 2 * r->rows_size + 256;
    void *rows = realloc(r->rows, size * sizeof *r->rows);
    if (!rows)
      return GSL_ENOMEM;
    r->rows = rows;
    r->rows_size = size;
  }
  double *row = r->rows[r->rows_count];
  for (int c = 0; c < COLUMNS; c++)
    row[c] = 0;
  row[COLUMN_ID] = (double)r->rows_count;
  row[COLUMN_R] = r->default_radius;
  row[COLUMN_M] = 1;
  const char *at = r->line;
  for (size_t k = 0; k < r->columns_count; k++) {
    size_t length = 0;
    const char *field = reader_field(r, &at, &length);
    const enum column c = r->columns[k];
    if (c == COLUMN_OTHER && !field)
      return reader_fail(r, "%zu fields: expected %zu", k, r->columns_count);
    if (c == COLUMN_OTHER ||
        (field && reader_number(r, field, length, &row[c])))
      continue;
    return reader_fail(r, "column %s is '%.*s': expected a finite number",
                       column_name(c), some(length), field ? field : "");
  }
  if (!r->more_fields && at && !line_is_blank(at))
    return reader_fail(r, "more than the %zu columns named", r->columns_count);
  const int status = check_row(r, row);
  r->rows_count += status == GSL_SUCCESS;
  return status;
}

/* Frames */

static int compare_ids(const void *a, const void *b) {
  const long x = *(const long *)a, y = *(const long *)b;
  return (x > y) - (x < y);
}

static int check_ids(struct bed_reader *r, const struct bed *b) {
  if (!b->n)
    return GSL_SUCCESS;
  long *id = malloc(b->n * sizeof *id);
  if (!id)
    return GSL_ENOMEM;
  memcpy(id, b->id, b->n * sizeof *id);
  qsort(id, b->n, sizeof *id, compare_ids);
  int status = GSL_SUCCESS;
  for (size_t i = 1; i < b->n && status == GSL_SUCCESS; i++)
    if (id[i] == id[i - 1])
      status =
          reader_fail(r, "the frame that ends here has id %ld twice", id[i]);
  free(id);
  return status;
}

int reader_frame(struct bed_reader *r, struct bed *b, double t) {
  if (!r->rows_count && !r->options.may_be_empty)
    return reader_fail(r, "a frame of no spheres");
  if (bed_alloc(b, r->rows_count) != GSL_SUCCESS)
    return GSL_ENOMEM;
  b->t = t;
  for (size_t i = 0; i < b->n; i++) {
    const double *row = r->rows[i];
    b->id[i] = (long)row[COLUMN_ID];
    memcpy(b->x + 3 * i, row + COLUMN_X, 3 * sizeof *row);
    memcpy(b->v + 3 * i, row + COLUMN_VX, 3 * sizeof *row);
    memcpy(b->w + 3 * i, row + COLUMN_WX, 3 * sizeof *row);
    b->r[i] = row[COLUMN_R];
    b->m[i] = row[COLUMN_M];
  }
  r->rows_count = 0;
  r->frames++;
  const int status = check_ids(r, b);
  if (status != GSL_SUCCESS)
    bed_free(b);
  return status;
}

int reader_cut(struct bed_reader *r, struct bed *b, double t,
               const char *want) {
  if (!r->options.allow_partial)
    return reader_fail(r, "the file ends where %s is expected: it is cut short",
                       want);
  if (r->rows_count)
    return reader_frame(r, b, t);
  return r->frames ? GSL_EOF : reader_fail(r, "no spheres");
}
