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

/* "name:line: ..."; what a file says may be anything, a terminal's control
   codes too. */
static void message(const struct bed_reader *r, char *text, size_t size,
                    const char *format, va_list args) {
  int used = snprintf(text, size, "%s:%zu: ", r->name, r->line_number);
  if (used < 0 || (size_t)used >= size)
    used = 0;
  vsnprintf(text + used, size - (size_t)used, format, args);
  for (char *c = text; *c; c++)
    if (iscntrl((unsigned char)*c))
      *c = '?';
}

int reader_fail(struct bed_reader *r, const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(r, r->error, sizeof r->error, format, args);
  va_end(args);
  return GSL_EINVAL;
}

void reader_note(struct bed_reader *r, const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(r, r->note, sizeof r->note, format, args);
  va_end(args);
}

/* Lines */

/* Appends what stands up to the next end of a line. */
static int read_bytes(struct bed_reader *r, size_t begin, size_t *length) {
  size_t n = begin;
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
  return n > begin ? GSL_SUCCESS : GSL_EOF;
}

/* A file that is no text is known by its first bytes. */
static int check_first_bytes(struct bed_reader *r, size_t length) {
  static const struct {
    const char *bytes, *what;
  } known[] = {{"\x1F\x8B", "gzip, expected 'zcat FILE | ...'"},
               {"\xFD"
                "7zXZ",
                "xz, expected 'xzcat FILE | ...'"},
               {"\x28\xB5\x2F\xFD", "zstd, expected 'zstdcat FILE | ...'"},
               {"BZh", "bzip2, expected 'bzcat FILE | ...'"},
               {"PK\x03\x04", "zip or a spreadsheet, expected text"},
               {"\xFF\xFE", "UTF-16, expected UTF-8"},
               {"\xFE\xFF", "UTF-16, expected UTF-8"}};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    const size_t size = strlen(known[k].bytes);
    if (length >= size && !memcmp(r->line, known[k].bytes, size))
      return reader_fail(r, "this is %s", known[k].what);
  }
  return GSL_SUCCESS;
}

/* A line of the file, from r->line + begin on. */
static int read_line(struct bed_reader *r, size_t begin, size_t *length) {
  int status = read_bytes(r, begin, length);
  if (status != GSL_SUCCESS)
    return status;
  size_t n = *length;
  if (++r->lines_read == 1)
    status = check_first_bytes(r, n);
  if (status != GSL_SUCCESS)
    return status;
  char *line = r->line;
  if (!line[n - 1])
    return reader_fail(r, "a NUL byte: expected text");
  if (n > LONGEST_LINE)
    return reader_fail(r, "a line of more than %d bytes", LONGEST_LINE);
  if (line[n - 1] != '\n') {
    if (!r->options.allow_partial)
      return reader_fail(r, "the last line has no end: the file is cut "
                            "short, or lacks its last newline, which "
                            "'echo >> FILE' adds");
    reader_note(r, "the last line has no end and is left out");
    r->cut = true;
    return GSL_EOF;
  }
  line[--n] = 0;
  if (n > begin && line[n - 1] == '\r')
    line[--n] = 0;
  if (r->lines_read == 1 && !strncmp(line, "\xEF\xBB\xBF", 3)) {
    n -= 3;
    memmove(line, line + 3, n + 1); /* a byte order mark */
  }
  *length = n;
  return GSL_SUCCESS;
}

size_t comment_sign(const char *line) {
  const size_t blanks = strspn(line, " \t");
  const char *at = line + blanks;
  return *at == '#' || *at == '%'       ? blanks + 1
         : at[0] == '/' && at[1] == '/' ? blanks + 2
                                        : 0;
}

/* Behind the quote that ends this one, which is not doubled; NULL: none. */
static const char *behind_quote(const char *open) {
  const char *at = open + 1;
  while ((at = strchr(at, '"')) && at[1] == '"')
    at += 2;
  return at ? at + 1 : NULL;
}

/* Does a field begin with a quote that does not end in this line? */
static bool quote_is_open(const char *line) {
  if (!strchr(line, '"') || comment_sign(line))
    return false;
  for (const char *at = line; at; at = strpbrk(at, ",;\t")) {
    at += strspn(at, ",; \t");
    if (*at == '"' && !(at = behind_quote(at)))
      return true;
  }
  return false;
}

static int next_line(struct bed_reader *r) {
  size_t length;
  r->line_number = r->lines_read + 1;
  int status = read_line(r, 0, &length);
  if (status == GSL_EOF)
    r->line_number = r->lines_read;
  while (status == GSL_SUCCESS && r->quotes && quote_is_open(r->line)) {
    r->line[length++] = '\n';
    status = read_line(r, length, &length);
    if (status == GSL_EOF && !r->options.allow_partial)
      return reader_fail(r, "a quote is opened and not closed");
  }
  return status;
}

int reader_keep(struct bed_reader *r) {
  if (r->kept_count == r->kept_size) {
    const size_t size = 2 * r->kept_size + 16;
    struct kept_line *kept = realloc(r->kept, size * sizeof *kept);
    if (!kept)
      return GSL_ENOMEM;
    r->kept = kept;
    r->kept_size = size;
  }
  char *text = strdup(r->line);
  if (!text)
    return GSL_ENOMEM;
  r->kept[r->kept_count++] = (struct kept_line){text, r->line_number};
  r->kept_next = r->kept_count;
  return GSL_SUCCESS;
}

void reader_rewind(struct bed_reader *r) {
  r->kept_next = 0;
  r->held = false;
}

int reader_line(struct bed_reader *r) {
  if (r->held) {
    r->held = false;
    return GSL_SUCCESS;
  }
  if (r->kept_next == r->kept_count)
    return next_line(r);
  const struct kept_line *kept = &r->kept[r->kept_next++];
  strcpy(r->line, kept->text); /* it held every one of them */
  r->line_number = kept->number;
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
  const char blanks[] = " \t", separator[] = {r->separator, 0};
  const char *const ends = r->separator == BLANKS ? blanks : separator;
  const char *field = *at;
  field += strspn(field, r->separator == '\t' ? " " : blanks);
  const char *end = r->quotes && *field == '"' ? behind_quote(field) : NULL;
  if (r->separator == BLANKS && !*field)
    return NULL;
  if (end) {
    field++;
    *length = (size_t)(end - field) - 1;
    end += strcspn(end, ends);
  } else {
    *length = strcspn(field, ends);
    end = field + *length;
    while (*length && strchr(blanks, field[*length - 1]))
      --*length;
  }
  *at = !*end ? NULL : r->separator == BLANKS ? end : end + 1;
  return field;
}

size_t reader_fields(const struct bed_reader *r, const char *line,
                     struct text fields[MOST_FIELDS + 1]) {
  size_t count = 0, length = 0;
  for (const char *field;
       count <= MOST_FIELDS && (field = reader_field(r, &line, &length));)
    fields[count++] = (struct text){field, length};
  return count;
}

bool reader_number(const struct bed_reader *r, struct text field,
                   double *value) {
  char copy[128]; /* with C's exponent and point */
  if (field.length >= sizeof copy)
    return false;
  for (size_t k = 0; k < field.length; k++) {
    const char c = field.at[k];
    copy[k] = c == 'd' || c == 'D'           ? 'e'
              : r->decimal_comma && c == ',' ? '.'
                                             : c;
  }
  copy[field.length] = 0;
  return number_parse(copy, value);
}

/* For messages: what a line or field holds, not all of a long one. */
static int some(size_t length) {
  return length > 40 ? 40 : (int)length;
}

int reader_line_number(struct bed_reader *r, const char *what, double *value) {
  const char *at = r->line;
  size_t length = 0;
  const char *field = reader_field(r, &at, &length);
  if (!field || !reader_number(r, (struct text){field, length}, value) ||
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

void reader_clear_columns(struct bed_reader *r, char separator) {
  r->separator = separator;
  r->quotes = false;
  columns_clear(&r->columns);
}

int reader_add_column(struct bed_reader *r, enum column c, struct text name) {
  const int status = columns_add(&r->columns, c, name);
  return status == GSL_SUCCESS ? status
                               : reader_fail(r, "%s", r->columns.wrong);
}

int reader_settle_radius(struct bed_reader *r, size_t count,
                         const struct text *names, enum column *what) {
  const int status = columns_settle_radius(&r->columns, count, names, what);
  return status == GSL_SUCCESS ? status
                               : reader_fail(r, "%s", r->columns.wrong);
}

bool reader_takes_columns(struct bed_reader *r) {
  if (r->options.columns)
    r->columns = *r->options.columns;
  return r->options.columns != NULL;
}

int reader_check_columns(struct bed_reader *r) {
  const struct columns *c = &r->columns;
  if (!columns_place(c))
    return reader_fail(r, "columns x, y and z are expected");
  if (!c->has[COLUMN_R] && !c->has[COLUMN_D] && r->default_radius == 0)
    return reader_fail(r,
                       "the spheres have no radius: %sexpected a column radius "
                       "or diameter, or --radius",
                       c->dismissed);
  return GSL_SUCCESS;
}

/* Rows */

/* Both are rounded to three digits at least, half a unit of the last one. */
static const double rounding = 0.01;

static int check_size(struct bed_reader *r, double *row) {
  const struct columns *c = &r->columns;
  if (c->has[COLUMN_D] && !(row[COLUMN_D] > 0))
    return reader_fail(r, "diameter %g: expected a number above 0",
                       row[COLUMN_D]);
  if (c->has[COLUMN_D] && !c->has[COLUMN_R])
    row[COLUMN_R] = row[COLUMN_D] / 2;
  if (!(row[COLUMN_R] > 0))
    return reader_fail(r, "radius %g: expected a number above 0",
                       row[COLUMN_R]);
  if (c->has[COLUMN_D] &&
      !(fabs(row[COLUMN_D] / 2 - row[COLUMN_R]) <= rounding * row[COLUMN_R]))
    return reader_fail(r,
                       "column '%s' is %g and column '%s' is %g: not one "
                       "sphere's radius and diameter; --columns says which one "
                       "counts",
                       c->name[COLUMN_R], row[COLUMN_R], c->name[COLUMN_D],
                       row[COLUMN_D]);
  return GSL_SUCCESS;
}

static int check_row(struct bed_reader *r, double *row) {
  const int status = check_size(r, row);
  if (status != GSL_SUCCESS)
    return status;
  if (!(row[COLUMN_M] > 0))
    return reader_fail(r, "mass %g: expected a number above 0", row[COLUMN_M]);
  if (!number_is_whole(row[COLUMN_ID]))
    return reader_fail(r, "id %.17g: expected a whole number", row[COLUMN_ID]);
  if (row[COLUMN_FIXED] != 0 && row[COLUMN_FIXED] != 1)
    return reader_fail(r, "fixed %g: expected 0 or 1", row[COLUMN_FIXED]);
  const double most = r->options.largest;
  for (int c = COLUMN_X; most > 0 && c < COLUMN_T; c++)
    if (!(fabs(row[c]) <= most))
      return reader_fail(r, "%s is %g: expected at most %g",
                         column_name((enum column)c), row[c], most);
  return GSL_SUCCESS;
}

/* The fields of r->line into a row. */
static int read_row(struct bed_reader *r, double *row) {
  const struct columns *columns = &r->columns;
  const char *at = r->line;
  for (size_t k = 0; k < columns->count; k++) {
    size_t length = 0;
    const char *field = reader_field(r, &at, &length);
    const enum column c = columns->at[k];
    if (!field)
      return c == COLUMN_OTHER
                 ? reader_fail(r, "%zu fields: expected %zu", k, columns->count)
                 : reader_fail(r,
                               "column %s is missing: %zu fields, expected "
                               "%zu",
                               columns->name[c], k, columns->count);
    if (c == COLUMN_OTHER)
      continue;
    if (!reader_number(r, (struct text){field, length}, &row[c]))
      return reader_fail(r, "column %s is '%.*s': expected a decimal number",
                         columns->name[c], some(length), field);
    if (columns->unit[k] != 1)
      row[c] *= columns->unit[k];
  }
  if (!r->more_fields && at && !line_is_blank(at))
    return reader_fail(r, "more than the %zu columns named", columns->count);
  return check_row(r, row);
}

int reader_row(struct bed_reader *r) {
  assert(r->rows_count <= r->rows_size && r->columns.count);
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
  const int status = read_row(r, row);
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
    if (row[COLUMN_FIXED] == 0)
      continue;
    if (bed_fix_none(b) != GSL_SUCCESS) {
      bed_free(b);
      return GSL_ENOMEM;
    }
    b->fixed[i] = true;
  }
  r->rows_count = 0;
  r->frames++;
  const int status = check_ids(r, b);
  if (status != GSL_SUCCESS)
    bed_free(b);
  return status;
}

void reader_note_cut(struct bed_reader *r, double t, size_t count) {
  char of[32] = "";
  if (r->cut_noted)
    return;
  r->cut_noted = true;
  if (count)
    snprintf(of, sizeof of, " of %zu", count);
  if (!r->rows_count)
    reader_note(r, "cut short behind the frame of t=%g", t);
  else
    reader_note(r,
                "cut short: %zu%s spheres of the last frame, t=%g, were read",
                r->rows_count, of, t);
}

int reader_cut(struct bed_reader *r, struct bed *b, double t, const char *want,
               size_t count) {
  if (!r->options.allow_partial)
    return reader_fail(r, "the file ends where %s is expected: it is cut short",
                       want);
  if (!r->rows_count && !r->frames)
    return reader_fail(r, "no spheres");
  reader_note_cut(r, t, count);
  return r->rows_count ? reader_frame(r, b, t) : GSL_EOF;
}
