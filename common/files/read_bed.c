/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own format: keys, a line of names, rows; its end is marked. Several may
   stand one behind the other, as cat makes them. */
#include "files/readers.h"

#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "files/sheet.h"

static const double default_radius = 0.1;                         /* settle's */
static const char *const repeated[] = {"wall", "cylinder", NULL}; /* keys */
static const char format_key[] = "format", own[] = "bed-1";

struct bed_state {
  double t;
  bool stale[2]; /* the next wall or cylinder line begins a new set */
  bool complete; /* the status line was read */
  bool ended;    /* the next bed begins, whether that was read or not */
  bool named;    /* column names were read since the last frame, */
  bool timed;    /* or a time, so there must be rows; */
  bool apart;    /* a blank line came since that time */
  bool sums;     /* there are lines in the sum */
  bool sealed;   /* their checksum was read */
  struct checksum sum;
};

static struct text trim(struct text t) {
  while (t.length && strchr(" \t", *t.at)) {
    t.at++;
    t.length--;
  }
  while (t.length && strchr(" \t", t.at[t.length - 1]))
    t.length--;
  return t;
}

/* "key=value" behind a #, blanks around each; what has no such form is a
   comment. */
static bool split_key(const char *line, struct text *name, struct text *value) {
  line += strspn(line, " \t");
  const char *equals = *line == '#' ? strchr(line, '=') : NULL;
  if (!equals)
    return false;
  *name = trim((struct text){line + 1, (size_t)(equals - line - 1)});
  *value = trim((struct text){equals + 1, strlen(equals + 1)});
  return name->length && !memchr(name->at, ' ', name->length) &&
         !memchr(name->at, '\t', name->length);
}

/* Lines count with the end that the writer gave them. */
static void add_line(struct bed_state *s, const char *line) {
  if (!s->sums)
    s->sum = checksum_begin();
  s->sums = true;
  checksum_add(&s->sum, line, strlen(line));
  checksum_add(&s->sum, "\n", 1);
}

static bool is_text(struct text t, const char *text) {
  return t.length == strlen(text) && !memcmp(t.at, text, t.length);
}

/* # format=bed-1; a later version is refused by read_key. */
static bool begins_bed(const struct bed_reader *r, const char *line,
                       bool first) {
  (void)r;
  (void)first;
  struct text name, value;
  return split_key(line, &name, &value) && is_text(name, format_key) &&
         value.length > 4 && !memcmp(value.at, own, 4);
}

static int read_key(struct bed_reader *r, const char *name, const char *value) {
  struct bed_state *s = r->state;
  if (r->header.count >= MOST_KEYS)
    return reader_fail(r, "more than %d keys", MOST_KEYS);
  if (!strcmp(name, format_key) && strcmp(value, own))
    return reader_fail(r, "format=%s: expected %s", value, own);
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
  size_t k = 0;
  while (repeated[k] && strcmp(name, repeated[k]))
    k++;
  if (!repeated[k])
    return bed_header_set(&r->header, name, value);
  if (s->stale[k])
    bed_header_remove(&r->header, name);
  s->stale[k] = false;
  return bed_header_add(&r->header, name, value);
}

#define AS_IT_IS                                                               \
  "to use it as it is, remove such lines by grep -v '^# " SHEET_CHECKSUM "='"

/* A checksum is of the lines before it: of the header's from the format on, of
   a frame's from its time on, so that a header may be put before any frame. */
static int check_sum(struct bed_reader *r, struct text value) {
  struct bed_state *s = r->state;
  char found[SHEET_SUM_SIZE], what[64] = "the header";
  if (!s->sums)
    return reader_fail(r, "a checksum of no lines; " AS_IT_IS);
  sheet_sum(&s->sum, found);
  if (r->rows_count)
    snprintf(what, sizeof what, "the frame of t=%g", s->t);
  if (!is_text(value, found))
    return reader_fail(r, "checksum=%.*s: %s has %s, it was changed; " AS_IT_IS,
                       value.length > 8 ? 8 : (int)value.length, value.at, what,
                       found);
  strcpy(r->sum, found);
  s->sums = false;
  s->sealed = true;
  return GSL_SUCCESS;
}

static int behind_sum(struct bed_reader *r) {
  return reader_fail(r, "'%.40s' behind a checksum; " AS_IT_IS, r->line);
}

/* A line that is no part of the bed is anybody's. */
static int read_comment(struct bed_reader *r) {
  struct bed_state *s = r->state;
  struct text name, value;
  if (!split_key(r->line, &name, &value))
    return GSL_SUCCESS;
  if (is_text(name, SHEET_CHECKSUM))
    return check_sum(r, value);
  const bool begins = is_text(name, format_key) || is_text(name, "t");
  if (s->sealed && !is_text(name, "status") && (r->rows_count || !begins))
    return behind_sum(r);
  if (!r->rows_count)
    s->sealed = false;
  s->sums = s->sums && !begins;
  add_line(s, r->line);
  char *const line = r->line; /* both are parts of it */
  line[name.at - line + (ptrdiff_t)name.length] = 0;
  line[value.at - line + (ptrdiff_t)value.length] = 0;
  return read_key(r, name.at, value.at);
}

static int read_names(struct bed_reader *r) {
  struct bed_state *s = r->state;
  struct text names[MOST_FIELDS + 1];
  reader_clear_columns(r, BLANKS);
  if (r->options.columns)
    return reader_fail(r, "--columns: a bed has names of its own");
  if (r->default_radius == 0 && !bed_header_get(&r->header, "radius"))
    r->default_radius = default_radius;
  const size_t count = reader_fields(r, r->line, names);
  for (size_t k = 0; k < count; k++) {
    const enum column c = column_named(names[k]);
    if (c == COLUMN_OTHER || c == COLUMN_D || c == COLUMN_T ||
        !is_text(names[k], column_name(c)))
      return reader_fail(r,
                         "unknown column '%.*s': expected id x y z r m vx vy "
                         "vz wx wy wz fixed",
                         names[k].length > 40 ? 40 : (int)names[k].length,
                         names[k].at);
    const int status = reader_add_column(r, c, names[k]);
    if (status != GSL_SUCCESS)
      return status;
  }
  s->named = true;
  return reader_check_columns(r);
}

static int finish_frame(struct bed_reader *r, struct bed *b) {
  struct bed_state *s = r->state;
  s->stale[0] = s->stale[1] = true;
  if (!s->sealed)
    *r->sum = 0;
  s->named = s->timed = s->sums = s->sealed = false;
  return reader_frame(r, b, s->t);
}

/* The last line of a bed decides whether it is whole. */
static int check_end(struct bed_reader *r) {
  const struct bed_state *s = r->state;
  const char *status = bed_header_get(&r->header, "status");
  if (s->complete && !strcmp(status, "ok"))
    return GSL_SUCCESS;
  if (!r->options.allow_partial)
    return s->complete ? reader_fail(r, "the file is marked status=%s", status)
                       : reader_fail(r, "the file ends without '# status=ok': "
                                        "it is cut short");
  if (s->complete && r->rows_count)
    reader_note(r, "the file is marked status=%.160s", status);
  else if (!s->complete)
    reader_note_cut(r, s->t, 0);
  return GSL_SUCCESS;
}

static int finish_bed(struct bed_reader *r, struct bed *b) {
  const struct bed_state *s = r->state;
  const int status = check_end(r);
  if (status != GSL_SUCCESS)
    return status;
  if (r->rows_count)
    return finish_frame(r, b);
  if (!r->frames)
    return reader_fail(r, "no spheres");
  if (!r->options.allow_partial && (s->named || s->timed))
    return reader_fail(r, "no spheres in the last frame");
  return GSL_EOF;
}

/* Behind one bed's last line another one begins, which has nothing of the
   first. */
static int begin_next(struct bed_reader *r) {
  struct bed_state *s = r->state;
  *s = (struct bed_state){0};
  bed_header_free(&r->header);
  reader_clear_columns(r, BLANKS);
  r->default_radius = r->options.radius;
  r->frames = 0;
  r->cut_noted = false;
  r->part++;
  return read_comment(r);
}

static bool begins_row(const char *line) {
  return strchr("0123456789+-.", *line) || !strncmp(line, "nan", 3) ||
         !strncmp(line, "inf", 3);
}

/* A line that is not blank. */
static int read_bed_line(struct bed_reader *r, const char *line) {
  struct bed_state *s = r->state;
  if (*line == '#')
    return read_comment(r);
  if (s->sealed)
    return behind_sum(r);
  add_line(s, r->line);
  if (!begins_row(line))
    return read_names(r);
  if (!r->columns.count)
    return reader_fail(
        r, "expected a line of column names before the first sphere");
  return reader_row(r);
}

static int next_bed(struct bed_reader *r, struct bed *b) {
  struct bed_state *s = r->state;
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    const char *line = r->line + strspn(r->line, "\t ");
    if (!*line && r->rows_count)
      return finish_frame(r, b);
    if (!*line && s->named)
      return reader_fail(r, "no spheres in the frame that ends here");
    if (!*line) {
      s->apart = true;
    } else if (r->rows_count && begins_bed(r, line, false)) {
      r->held = s->ended = true; /* the last bed's rows first */
      return finish_bed(r, b);
    } else if ((s->ended || s->complete) && begins_bed(r, line, false)) {
      status = s->ended ? GSL_EOF : finish_bed(r, b);
      if (status == GSL_EOF)
        status = begin_next(r);
    } else if (s->complete) {
      return reader_fail(r, "more after the line of the status");
    } else {
      status = read_bed_line(r, line);
    }
    if (status != GSL_SUCCESS)
      return status;
  }
  return status == GSL_EOF ? finish_bed(r, b) : status;
}

const struct bed_format format_bed = {
    .name = "bed",
    .help = "our own: '# format=bed-1', parameters, walls, spheres",
    .begins = begins_bed,
    .state_size = sizeof(struct bed_state),
    .next = next_bed};
