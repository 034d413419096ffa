#define _POSIX_C_SOURCE 200809L
#include "bed_io.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "options.h"

/* Header */

int bed_header_add(struct bed_header *h, const char *name, const char *value) {
  if (h->count == h->size) {
    const size_t size = 2 * h->size + 16;
    struct bed_key *at = realloc(h->at, size * sizeof *at);
    if (!at)
      return GSL_ENOMEM;
    h->at = at;
    h->size = size;
  }
  struct bed_key key = {strdup(name), strdup(value)};
  if (!key.name || !key.value) {
    free(key.name);
    free(key.value);
    return GSL_ENOMEM;
  }
  h->at[h->count++] = key;
  return GSL_SUCCESS;
}

static struct bed_key *find_key(const struct bed_header *h, const char *name) {
  for (size_t k = 0; k < h->count; k++)
    if (!strcmp(h->at[k].name, name))
      return &h->at[k];
  return NULL;
}

int bed_header_set(struct bed_header *h, const char *name, const char *value) {
  struct bed_key *key = find_key(h, name);
  if (!key)
    return bed_header_add(h, name, value);
  char *copy = strdup(value);
  if (!copy)
    return GSL_ENOMEM;
  free(key->value);
  key->value = copy;
  return GSL_SUCCESS;
}

const char *bed_header_get(const struct bed_header *h, const char *name) {
  const struct bed_key *key = find_key(h, name);
  return key ? key->value : NULL;
}

void bed_header_remove(struct bed_header *h, const char *name) {
  size_t kept = 0;
  for (size_t k = 0; k < h->count; k++) {
    if (strcmp(h->at[k].name, name)) {
      h->at[kept++] = h->at[k];
      continue;
    }
    free(h->at[k].name);
    free(h->at[k].value);
  }
  h->count = kept;
}

void bed_header_free(struct bed_header *h) {
  for (size_t k = 0; k < h->count; k++) {
    free(h->at[k].name);
    free(h->at[k].value);
  }
  free(h->at);
  *h = (struct bed_header){0};
}

/* Reader */

enum column { ID, X, Y, Z, R, M, VX, VY, VZ, WX, WY, WZ, COLUMNS };

static const char *const column_names[COLUMNS] = {
    "id", "x", "y", "z", "r", "m", "vx", "vy", "vz", "wx", "wy", "wz"};

static const double default_radius = 0.1; /* settle's */

struct bed_reader {
  FILE *in;
  const char *name;
  bool allow_partial;
  struct bed_header header;
  char *line;
  size_t line_size, line_number;
  enum column columns[COLUMNS]; /* as they stand in the file */
  size_t columns_count;
  double (*rows)[COLUMNS];
  size_t rows_count, rows_size;
  size_t frames;
  bool walls_stale; /* the next wall line begins a new set */
  bool complete;    /* the status line was read */
  char error[512];
};

struct bed_reader *bed_reader_open(FILE *in, const char *name,
                                   bool allow_partial) {
  struct bed_reader *r = calloc(1, sizeof *r);
  if (r) {
    r->in = in;
    r->name = name;
    r->allow_partial = allow_partial;
  }
  return r;
}

void bed_reader_close(struct bed_reader *r) {
  if (!r)
    return;
  bed_header_free(&r->header);
  free(r->line);
  free(r->rows);
  free(r);
}

const struct bed_header *bed_reader_header(const struct bed_reader *r) {
  return &r->header;
}

const char *bed_reader_error(const struct bed_reader *r) {
  return r->error;
}

static int fail(struct bed_reader *r, const char *format, ...) {
  int used =
      snprintf(r->error, sizeof r->error, "%s:%zu: ", r->name, r->line_number);
  if (used < 0 || (size_t)used >= sizeof r->error)
    used = 0;
  va_list args;
  va_start(args, format);
  vsnprintf(r->error + used, sizeof r->error - (size_t)used, format, args);
  va_end(args);
  return GSL_EINVAL;
}

/* "# key=value"; other comments are passed over. */
static int read_key(struct bed_reader *r, char *line) {
  char *name = line + 1 + strspn(line + 1, " \t");
  char *value = strchr(name, '=');
  if (!value)
    return GSL_SUCCESS;
  *value++ = 0;
  if (strpbrk(name, " \t"))
    return GSL_SUCCESS;
  if (!strcmp(name, "format") && strcmp(value, "bed-1"))
    return fail(r, "format=%s: expected bed-1", value);
  if (strcmp(name, "wall"))
    return bed_header_set(&r->header, name, value);
  if (r->walls_stale)
    bed_header_remove(&r->header, "wall");
  r->walls_stale = false;
  return bed_header_add(&r->header, name, value);
}

static int read_column_names(struct bed_reader *r, char *line) {
  bool seen[COLUMNS] = {false};
  r->columns_count = 0;
  char *rest = line;
  for (char *name; (name = strtok_r(rest, "\t ", &rest));) {
    int c = 0;
    while (c < COLUMNS && strcmp(name, column_names[c]))
      c++;
    if (c == COLUMNS)
      return fail(r,
                  "unknown column '%.40s': expected id x y z r m vx vy vz wx "
                  "wy wz",
                  name);
    if (seen[c])
      return fail(r, "column '%s' stands twice", name);
    seen[c] = true;
    r->columns[r->columns_count++] = (enum column)c;
  }
  if (!seen[X] || !seen[Y] || !seen[Z])
    return fail(r, "columns x, y and z are expected");
  return GSL_SUCCESS;
}

static int read_row(struct bed_reader *r, char *line) {
  if (!r->columns_count)
    return fail(r, "expected a line of column names before the first sphere");
  if (r->rows_count == r->rows_size) {
    const size_t size = 2 * r->rows_size + 256;
    void *rows = realloc(r->rows, size * sizeof *r->rows);
    if (!rows)
      return GSL_ENOMEM;
    r->rows = rows;
    r->rows_size = size;
  }
  double *row = r->rows[r->rows_count];
  const char *radius = bed_header_get(&r->header, "radius");
  for (int c = 0; c < COLUMNS; c++)
    row[c] = 0;
  row[ID] = (double)r->rows_count;
  row[R] = default_radius;
  if (radius && !parse_double(radius, &row[R]))
    return fail(r, "radius=%.40s: expected a number above 0", radius);
  row[M] = 1;
  char *at = line;
  for (size_t k = 0; k < r->columns_count; k++) {
    char *end;
    const double value = strtod(at, &end);
    if (end == at || !strchr("\t ", *end) || !isfinite(value)) {
      const int length = (int)strcspn(at + strspn(at, "\t "), "\t ");
      return fail(r, "column %s is '%.*s': expected a finite number",
                  column_names[r->columns[k]], length > 40 ? 40 : length,
                  at + strspn(at, "\t "));
    }
    row[r->columns[k]] = value;
    at = end;
  }
  if (at[strspn(at, "\t ")])
    return fail(r, "more than the %zu columns named", r->columns_count);
  if (!(row[R] > 0) || !isfinite(row[R]))
    return fail(r, "radius %g: expected a number above 0", row[R]);
  if (!(row[M] > 0))
    return fail(r, "mass %g: expected a number above 0", row[M]);
  if (row[ID] != floor(row[ID]) || fabs(row[ID]) > 9007199254740992.0)
    return fail(r, "id %.17g: expected a whole number", row[ID]);
  r->rows_count++;
  return GSL_SUCCESS;
}

static int compare_ids(const void *a, const void *b) {
  const long x = *(const long *)a, y = *(const long *)b;
  return (x > y) - (x < y);
}

static int check_ids(struct bed_reader *r, const struct bed *b) {
  long *id = malloc(b->n * sizeof *id);
  if (!id)
    return GSL_ENOMEM;
  memcpy(id, b->id, b->n * sizeof *id);
  qsort(id, b->n, sizeof *id, compare_ids);
  int status = GSL_SUCCESS;
  for (size_t i = 1; i < b->n && status == GSL_SUCCESS; i++)
    if (id[i] == id[i - 1])
      status = fail(r, "the frame that ends here has id %ld twice", id[i]);
  free(id);
  return status;
}

static int finish_frame(struct bed_reader *r, struct bed *b) {
  if (bed_alloc(b, r->rows_count) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t i = 0; i < b->n; i++) {
    const double *row = r->rows[i];
    b->id[i] = (long)row[ID];
    memcpy(b->x + 3 * i, row + X, 3 * sizeof *row);
    memcpy(b->v + 3 * i, row + VX, 3 * sizeof *row);
    memcpy(b->w + 3 * i, row + WX, 3 * sizeof *row);
    b->r[i] = row[R];
    b->m[i] = row[M];
  }
  const char *t = bed_header_get(&r->header, "t");
  const bool good = !t || parse_double(t, &b->t);
  r->rows_count = 0;
  r->frames++;
  r->walls_stale = true;
  int status =
      good ? check_ids(r, b) : fail(r, "t=%.40s: expected a finite number", t);
  if (status != GSL_SUCCESS)
    bed_free(b);
  return status;
}

/* What stands at the end of the file decides whether it is whole. */
static int finish_file(struct bed_reader *r, struct bed *b) {
  const char *status = bed_header_get(&r->header, "status");
  if (!r->allow_partial) {
    if (!r->complete)
      return fail(r, "the file ends without '# status=ok': it is cut short");
    if (strcmp(status, "ok"))
      return fail(r, "the file is marked status=%s", status);
  }
  if (r->rows_count)
    return finish_frame(r, b);
  if (!r->frames)
    return fail(r, "no spheres");
  return GSL_EOF;
}

/* One line without its end; GSL_EOF at the end of the file. In a partial file
   a last line without its newline is dropped. */
static int read_line(struct bed_reader *r, size_t *length) {
  const ssize_t got = getline(&r->line, &r->line_size, r->in);
  if (got < 0)
    return ferror(r->in) ? fail(r, "read error") : GSL_EOF;
  r->line_number++;
  *length = (size_t)got;
  if (memchr(r->line, 0, *length))
    return fail(r, "a NUL byte: expected text");
  if (r->line[*length - 1] != '\n')
    return r->allow_partial
               ? GSL_EOF
               : fail(r, "the last line has no end: the file is cut short");
  r->line[--*length] = 0;
  if (*length && r->line[*length - 1] == '\r')
    r->line[--*length] = 0;
  return GSL_SUCCESS;
}

int bed_reader_next(struct bed_reader *r, struct bed *b) {
  size_t length;
  int status;
  while ((status = read_line(r, &length)) == GSL_SUCCESS) {
    char *line = r->line + strspn(r->line, "\t ");
    if (!*line) {
      if (r->rows_count)
        return finish_frame(r, b);
    } else if (r->complete) {
      return fail(r, "more after the line of the status");
    } else if (*line == '#') {
      status = read_key(r, line);
      r->complete = bed_header_get(&r->header, "status") != NULL;
    } else if (strchr("0123456789+-.", *line) || !strncmp(line, "nan", 3) ||
               !strncmp(line, "inf", 3)) {
      status = read_row(r, line);
    } else {
      status = read_column_names(r, line);
    }
    if (status != GSL_SUCCESS)
      return status;
  }
  return status == GSL_EOF ? finish_file(r, b) : status;
}

/* Writer */

void bed_write_frame(FILE *out, const struct bed_header *h, const struct bed *b,
                     bool spin) {
  for (size_t k = 0; k < h->count; k++)
    if (strcmp(h->at[k].name, "t") && strcmp(h->at[k].name, "status"))
      fprintf(out, "# %s=%s\n", h->at[k].name, h->at[k].value);
  fprintf(out, "# t=%.17g\n", b->t);
  const int columns = spin ? COLUMNS : WX;
  for (int c = 0; c < columns; c++)
    fprintf(out, c ? "\t%s" : "%s", column_names[c]);
  fputc('\n', out);
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    fprintf(out, "%ld\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g",
            b->id[i], x[0], x[1], x[2], b->r[i], b->m[i], v[0], v[1], v[2]);
    if (spin)
      fprintf(out, "\t%.17g\t%.17g\t%.17g", w[0], w[1], w[2]);
    fputc('\n', out);
  }
}

void bed_write_gap(FILE *out) {
  fputs("\n\n", out);
}

void bed_write_status(FILE *out, const char *status) {
  fprintf(out, "# status=%s\n", status);
}
