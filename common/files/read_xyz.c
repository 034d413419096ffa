/* SPDX-License-Identifier: GPL-3.0-or-later */
/* XYZ: a count, a comment, and a row for each sphere; in the extended form the
   comment says what the columns are (Properties=species:S:1:pos:R:3:...), and
   the time. github.com/libAtoms/extxyz describes it. In the plain form a row
   is a name or the number of a kind, then x y z; some writers leave the name
   out, and many put the radius behind z. */
#include "files/readers.h"

#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"

/* Properties by the names that OVITO, ASE and others give them. */
static const struct {
  const char *name;
  enum column first;
  size_t count;
} properties[] = {
    /* clang-format off */
    {"pos", COLUMN_X, 3}, {"position", COLUMN_X, 3}, {"positions", COLUMN_X, 3},
    {"radius", COLUMN_R, 1}, {"radii", COLUMN_R, 1},
    {"diameter", COLUMN_D, 1}, {"diameters", COLUMN_D, 1},
    {"mass", COLUMN_M, 1}, {"masses", COLUMN_M, 1},
    {"velo", COLUMN_VX, 3}, {"vel", COLUMN_VX, 3},
    {"velocity", COLUMN_VX, 3}, {"velocities", COLUMN_VX, 3},
    {"omega", COLUMN_WX, 3}, {"spin", COLUMN_WX, 3},
    {"angular_velocity", COLUMN_WX, 3}, {"angular_velocities", COLUMN_WX, 3}
    /* clang-format on */
};

struct xyz_state {
  bool plain; /* no Properties; then also: */
  bool named; /* a row begins with a name */
  bool noted; /* that a radius is guessed */
};

static bool is_count(const char *line) {
  line += strspn(line, " \t");
  const size_t digits = strspn(line, "0123456789");
  return digits && line_is_blank(line + digits);
}

static bool begins_xyz(const struct bed_reader *r, const char *line,
                       bool first) {
  (void)r;
  return first && is_count(line);
}

/* Behind the end of text in quotes, in which \ takes the meaning from what
   follows it, or in brackets, which may be nested; at: what opens it. Of *text
   what is inside. Text that has no end reaches to the line's. */
static const char *enclosed(const char *at, struct text *text) {
  static const char open[] = "\"'{[", close[] = "\"'}]";
  const char opening = *at, closing = close[strchr(open, opening) - open];
  const bool brackets = opening != closing;
  int depth = 1;
  text->at = ++at;
  for (; *at; at++) {
    if (!brackets && *at == '\\' && at[1])
      at++;
    else if (*at == closing && --depth == 0)
      break;
    else if (brackets && *at == opening)
      depth++;
  }
  text->length = (size_t)(at - text->at);
  return at + (*at != 0);
}

/* A bare word up to one of these, or enclosed text. */
static const char *word(const char *at, const char *ends, const char *openings,
                        struct text *text) {
  if (*at && strchr(openings, *at))
    return enclosed(at, text);
  *text = (struct text){at, strcspn(at, ends)};
  return at + text->length;
}

/* The value of key=value in the comment, by a function that knows the key;
   quotes and brackets are left out and blanks around = let pass. */
static bool find_value(const char *at, bool (*is_key)(struct text),
                       struct text *value) {
  while (*(at += strspn(at, " \t,"))) {
    struct text key;
    const char *end = word(at, " \t=", "\"'", &key);
    const char *equals = end + strspn(end, " \t");
    if (end == at)
      end++; /* a = without a key */
    at = end;
    if (*equals != '=')
      continue;
    equals++;
    at = word(equals + strspn(equals, " \t"), " \t", "\"'{[", value);
    if (is_key(key))
      return true;
  }
  return false;
}

static bool is_properties(struct text key) {
  return same_word(key, "Properties");
}

/* T is a temperature. */
static bool is_time(struct text key) {
  return same_word(key, "time") || (key.length == 1 && *key.at == 't');
}

/* One of the three parts of a property. */
static struct text part(const char **at, const char *end) {
  struct text field = {*at, 0};
  while (field.at + field.length < end && field.at[field.length] != ':')
    field.length++;
  *at = field.at + field.length < end ? field.at + field.length + 1 : end;
  return field;
}

static enum column property(struct text name, size_t count) {
  for (size_t k = 0; k < sizeof properties / sizeof *properties; k++)
    if (same_word(name, properties[k].name) && count == properties[k].count)
      return properties[k].first;
  const enum column c = count == 1 ? column_named(name) : COLUMN_OTHER;
  return c == COLUMN_T ? COLUMN_OTHER : c; /* a frame has one time */
}

static int add(struct bed_reader *r, enum column c) {
  const char *name = column_name(c);
  return reader_add_column(r, c, (struct text){name, strlen(name)});
}

/* The columns of one property: name:type:count. */
static int read_property(struct bed_reader *r, const char **at, const char *end,
                         size_t *columns, struct text *names,
                         enum column *what) {
  const char *const begin = *at;
  const struct text name = part(at, end), type = part(at, end),
                    digits = part(at, end);
  double count;
  if (!name.length || type.length != 1 || !strchr("RISLrisl", *type.at) ||
      !reader_number(r, digits, &count) || !(count >= 1) ||
      !(count <= MOST_FIELDS) || count != (double)(size_t)count)
    return reader_fail(r, "Properties: expected name:type:count at '%.*s'",
                       end - begin > 40 ? 40 : (int)(end - begin), begin);
  if (*columns + (size_t)count > MOST_FIELDS)
    return reader_fail(r, "Properties: more than %d columns", MOST_FIELDS);
  const enum column first = property(name, (size_t)count);
  for (size_t k = 0; k < (size_t)count; k++) {
    const enum column c =
        first == COLUMN_OTHER ? first : (enum column)(first + k);
    what[*columns] = c;
    names[(*columns)++] =
        count == 1 ? name
                   : (struct text){column_name(c), strlen(column_name(c))};
  }
  return GSL_SUCCESS;
}

static int read_properties(struct bed_reader *r, struct text list) {
  const char *at = list.at, *const end = at + list.length;
  struct text names[MOST_FIELDS] = {{NULL, 0}};
  enum column what[MOST_FIELDS] = {COLUMN_OTHER};
  size_t count = 0;
  int status = GSL_SUCCESS;
  while (at < end && status == GSL_SUCCESS)
    status = read_property(r, &at, end, &count, names, what);
  if (status == GSL_SUCCESS)
    status = reader_settle_radius(r, count, names, what);
  for (size_t k = 0; k < count && status == GSL_SUCCESS; k++)
    status = reader_add_column(r, what[k], names[k]);
  return status == GSL_SUCCESS ? reader_check_columns(r) : status;
}

static int read_comment(struct bed_reader *r, double *t) {
  struct xyz_state *s = r->state;
  struct text value;
  reader_clear_columns(r, BLANKS);
  s->plain = !find_value(r->line, is_properties, &value);
  r->more_fields = s->plain;
  if (!s->plain) {
    const int status = reader_takes_columns(r) ? reader_check_columns(r)
                                               : read_properties(r, value);
    if (status != GSL_SUCCESS)
      return status;
  }
  if (!find_value(r->line, is_time, &value))
    return GSL_SUCCESS;
  while (value.length && value.at[value.length - 1] == ',')
    value.length--;
  if (!reader_number(r, value, t) && !s->plain)
    return reader_fail(r, "time is '%.*s': expected a finite number",
                       value.length > 40 ? 40 : (int)value.length, value.at);
  return GSL_SUCCESS;
}

/* A name is a word or the number of a kind, which has no sign and no point. */
static bool is_name(const struct bed_reader *r, struct text field) {
  double x;
  return field.length && (!reader_number(r, field, &x) ||
                          strspn(field.at, "0123456789") >= field.length);
}

/* The columns of a plain frame, by its first row. */
static int set_columns(struct bed_reader *r) {
  struct xyz_state *s = r->state;
  struct text fields[MOST_FIELDS + 1];
  const size_t count = reader_fields(r, r->line, fields);
  s->named = count > 3 && is_name(r, fields[0]);
  if (reader_takes_columns(r)) {
    s->named = false;
    return reader_check_columns(r);
  }
  if (s->named)
    add(r, COLUMN_OTHER);
  for (int c = COLUMN_X; c <= COLUMN_Z; c++)
    add(r, (enum column)c);
  const size_t place = r->columns.count;
  double radius;
  if (r->default_radius == 0 && count == place + 1 &&
      reader_number(r, fields[place], &radius) && radius > 0) {
    add(r, COLUMN_R);
    r->more_fields = false;
    if (!s->noted)
      reader_note(r, "the column behind z is taken as the radius");
    s->noted = true;
  } else if (count > place) {
    snprintf(r->columns.dismissed, sizeof r->columns.dismissed,
             "--columns says what is behind z; ");
  }
  return reader_check_columns(r);
}

static int read_row(struct bed_reader *r) {
  const struct xyz_state *s = r->state;
  if (s->plain && !r->rows_count) {
    const int status = set_columns(r);
    if (status != GSL_SUCCESS)
      return status;
  }
  if (s->plain && s->named) {
    const char *at = r->line;
    size_t length = 0;
    const char *name = reader_field(r, &at, &length);
    if (!name || !is_name(r, (struct text){name, length}))
      return reader_fail(r,
                         "'%.40s': expected a name or a whole number, then x "
                         "y z, as in the rows before",
                         r->line);
  }
  return reader_row(r);
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
  reader_clear_columns(r, BLANKS);
  if (!is_count(r->line))
    return reader_fail(r, "'%.40s': expected the number of atoms", r->line);
  status = reader_line_count(r, "the number of atoms", &count);
  if (status == GSL_SUCCESS)
    status = reader_line(r);
  if (status == GSL_EOF)
    return reader_cut(r, b, t, "a comment", count);
  if (status == GSL_SUCCESS)
    status = read_comment(r, &t);
  while (status == GSL_SUCCESS && r->rows_count < count) {
    status = reader_line(r);
    if (status == GSL_EOF)
      return reader_cut(r, b, t, "another atom", count);
    if (status == GSL_SUCCESS)
      status = read_row(r);
  }
  return status == GSL_SUCCESS ? reader_frame(r, b, t) : status;
}

const struct bed_format format_xyz = {.name = "xyz",
                                      .help = "XYZ plain and extended",
                                      .begins = begins_xyz,
                                      .state_size = sizeof(struct xyz_state),
                                      .next = next_xyz};
