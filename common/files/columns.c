/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A name is cut into words: "Center of Mass X [mm]", "posX", "Points:0". A
   unit at its end is taken off; what is left is a scalar by one word (radius),
   or a vector's component by words that say which vector and one that says
   which component. One word more that is not known here, and the column is
   none of ours: "mean radius" is not a sphere's. */
#define _POSIX_C_SOURCE 200809L
#include "files/columns.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <gsl/gsl_errno.h>

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
    {"t", COLUMN_T}, {"time", COLUMN_T},
    {"fixed", COLUMN_FIXED}
    /* clang-format on */
};
enum { NAMES = sizeof names / sizeof *names };

bool same_word(struct text text, const char *word) {
  return text.length == strlen(word) &&
         !strncasecmp(text.at, word, text.length);
}

enum column column_named(struct text name) {
  for (int k = 0; k < NAMES; k++)
    if (same_word(name, names[k].name))
      return names[k].column;
  return COLUMN_OTHER;
}

const char *column_name(enum column c) {
  for (int k = 0; k < NAMES; k++)
    if (names[k].column == c)
      return names[k].name;
  return "?";
}

/* Units */

enum dimension { PURE, LENGTH, MASS, TIME, SPEED, SPIN, ANGLE };

static const struct unit {
  const char *name;
  enum dimension dimension;
  double factor;
} units[] = {
    /* clang-format off */
    {"", PURE, 1}, {"-", PURE, 1}, {"--", PURE, 1},     {"none", PURE, 1},
    {"m", LENGTH, 1}, {"meter", LENGTH, 1}, {"metre", LENGTH, 1},
    {"meters", LENGTH, 1}, {"metres", LENGTH, 1}, {"dm", LENGTH, 1e-1},
    {"cm", LENGTH, 1e-2}, {"mm", LENGTH, 1e-3}, {"um", LENGTH, 1e-6},
    {"\xC2\xB5m", LENGTH, 1e-6}, {"\xCE\xBCm", LENGTH, 1e-6},
    {"\xB5m", LENGTH, 1e-6}, {"micron", LENGTH, 1e-6},
    {"microns", LENGTH, 1e-6}, {"nm", LENGTH, 1e-9}, {"km", LENGTH, 1e3},
    {"kg", MASS, 1}, {"g", MASS, 1e-3}, {"mg", MASS, 1e-6}, {"ug", MASS, 1e-9},
    {"s", TIME, 1}, {"sec", TIME, 1}, {"second", TIME, 1},
    {"seconds", TIME, 1}, {"ms", TIME, 1e-3}, {"us", TIME, 1e-6},
    {"min", TIME, 60}, {"h", TIME, 3600},
    {"m/s", SPEED, 1}, {"m s-1", SPEED, 1}, {"m s^-1", SPEED, 1},
    {"m.s-1", SPEED, 1}, {"m*s^-1", SPEED, 1}, {"mps", SPEED, 1},
    {"cm/s", SPEED, 1e-2}, {"mm/s", SPEED, 1e-3}, {"um/s", SPEED, 1e-6},
    {"rad/s", SPIN, 1}, {"1/s", SPIN, 1}, {"s-1", SPIN, 1}, {"s^-1", SPIN, 1},
    {"rad s-1", SPIN, 1}, {"rad s^-1", SPIN, 1},
    {"deg", ANGLE, 1}, {"rad", ANGLE, 1}, {"\xC2\xB0", ANGLE, 1},
    {"deg/s", SPIN, 0.017453292519943295}, {"rpm", SPIN, 0.10471975511965977}
    /* clang-format on */
};
enum { UNITS = sizeof units / sizeof *units };

static enum dimension dimension_of(enum column c) {
  return c == COLUMN_ID || c == COLUMN_OTHER || c == COLUMN_FIXED ? PURE
         : c <= COLUMN_D                                          ? LENGTH
         : c == COLUMN_M                                          ? MASS
         : c == COLUMN_T                                          ? TIME
         : c >= COLUMN_VX && c <= COLUMN_VZ                       ? SPEED
                                                                  : SPIN;
}

static struct text trimmed(struct text t) {
  while (t.length && isspace((unsigned char)*t.at)) {
    t.at++;
    t.length--;
  }
  while (t.length && isspace((unsigned char)t.at[t.length - 1]))
    t.length--;
  return t;
}

/* Case counts: mm is no Mm. NULL if it is no unit. */
static const struct unit *find_unit(struct text t) {
  t = trimmed(t);
  for (int k = 0; k < UNITS; k++)
    if (t.length == strlen(units[k].name) &&
        !memcmp(t.at, units[k].name, t.length))
      return &units[k];
  return NULL;
}

static bool is_unit_of(const struct unit *u, enum column c) {
  return u->dimension == PURE || u->dimension == dimension_of(c);
}

/* Takes "[mm]", "(mm)", "/ mm" or ", mm" off the end. NULL if none is there. */
static const struct unit *take_unit(struct text *name) {
  struct text t = trimmed(*name);
  if (!t.length)
    return NULL;
  const char last = t.at[t.length - 1];
  const char open = last == ')' ? '(' : last == ']' ? '[' : 0;
  size_t at = t.length - 1;
  while (at > 0 && (open ? t.at[at] != open : !strchr("/,", t.at[at])))
    at--;
  if (at == 0)
    return NULL;
  const struct text inside = {t.at + at + 1, t.length - at - 1 - (open != 0)};
  const struct unit *u = find_unit(inside);
  if (!u || (!open && u->dimension == PURE))
    return NULL;
  *name = trimmed((struct text){t.at, at});
  while (name->length && strchr("/_", name->at[name->length - 1]))
    name->length--;
  return u;
}

/* Words */

enum { MOST_WORDS = 10, LONGEST_WORD = 24 };

struct words {
  size_t count;
  char at[MOST_WORDS][LONGEST_WORD]; /* in small letters */
};

/* Between these bytes of a name, does a word begin? posX, XPos, Pos0. */
static bool word_begins(const char *at, size_t k, size_t length) {
  const unsigned char a = (unsigned char)at[k - 1], b = (unsigned char)at[k];
  if (isdigit(a) != 0 || isdigit(b) != 0)
    return (isdigit(a) != 0) != (isdigit(b) != 0);
  return isupper(b) && (islower(a) || (isupper(a) && k + 1 < length &&
                                       islower((unsigned char)at[k + 1])));
}

static bool is_letter(char c) {
  return isalnum((unsigned char)c) || (unsigned char)c >= 0x80;
}

/* No words at all if there are too many, or one is too long, to be ours. */
static struct words words_of(struct text name) {
  struct words w = {0};
  size_t used = 0; /* of the last word */
  for (size_t k = 0; k < name.length; k++) {
    if (!is_letter(name.at[k])) {
      used = 0;
      continue;
    }
    if (used == 0 || word_begins(name.at, k, name.length)) {
      if (w.count == MOST_WORDS)
        return (struct words){0};
      w.count++;
      used = 0;
    }
    if (used + 1 == LONGEST_WORD)
      return (struct words){0};
    w.at[w.count - 1][used++] = (char)tolower((unsigned char)name.at[k]);
  }
  return w;
}

/* list: words with a blank before and behind each. */
static bool in_list(const char *word, const char *list) {
  char key[LONGEST_WORD + 2];
  snprintf(key, sizeof key, " %s ", word);
  return strstr(list, key) != NULL;
}

static void remove_word(struct words *w, size_t k) {
  for (w->count--; k < w->count; k++)
    memcpy(w->at[k], w->at[k + 1], LONGEST_WORD);
}

/* Removes words that say whose the quantity is, not which one it is. */
static void remove_fillers(struct words *w) {
  for (size_t k = w->count; k-- > 0;)
    if (in_list(w->at[k], " of the particle particles sphere spheres grain "
                          "grains bead beads atom atoms ball balls "))
      remove_word(w, k);
}

/* Vectors */

struct vector {
  enum column first;
  const char *words, *besides; /* one of these there must be; these may be */
};

static const struct vector vectors[] = {
    {COLUMN_X,
     " pos position positions point points coord coords coordinate coordinates "
     "center centre centers centres centroid centroids location locations loc "
     "com c ",
     " mass "},
    {COLUMN_VX, " v vel velo velocity velocities ",
     " linear translational trans center centre mass com "},
    {COLUMN_WX, " w omega omegas spin angvel angvels ",
     " angular rotational ang rot velocity velocities vel "}};
enum { VECTORS = sizeof vectors / sizeof *vectors };

static const struct vector *vector_of(const struct words *w) {
  for (int v = 0; v < VECTORS; v++) {
    size_t said = 0, known = 0;
    for (size_t k = 0; k < w->count; k++) {
      said += in_list(w->at[k], vectors[v].words);
      known += in_list(w->at[k], vectors[v].words) ||
               in_list(w->at[k], vectors[v].besides);
    }
    if (said && known == w->count)
      return &vectors[v];
  }
  /* "angular velocity" */
  bool angular = false, velocity = false;
  size_t known = 0;
  for (size_t k = 0; k < w->count; k++) {
    const bool a = in_list(w->at[k], " angular rotational ang rot "),
               b = in_list(w->at[k], " velocity velocities vel velo v ");
    angular |= a;
    velocity |= b;
    known += a || b;
  }
  return angular && velocity && known == w->count ? &vectors[VECTORS - 1]
                                                  : NULL;
}

static int axis_of(const char *word) {
  return word[0] >= 'x' && word[0] <= 'z' && !word[1] ? word[0] - 'x' : -1;
}

/* Cuts "posx" and "xpos" in two; all other words stay one. */
static void cut_axis(struct words *w) {
  if (w->count != 1)
    return;
  char *word = w->at[0];
  const size_t length = strlen(word);
  const bool behind = length > 1 && strchr("xyz", word[length - 1]),
             before = length > 1 && strchr("xyz", word[0]);
  struct words cut = {.count = 2};
  if (behind) {
    memcpy(cut.at[0], word, length - 1);
    cut.at[1][0] = word[length - 1];
  } else if (before) {
    cut.at[0][0] = word[0];
    memcpy(cut.at[1], word + 1, length - 1);
  }
  struct words rest = cut;
  remove_word(&rest, behind ? 1 : 0);
  if ((behind || before) && vector_of(&rest))
    *w = cut;
}

/* A component by its number: which one that is depends on whether the file
   counts from 0 or from 1. digits: a bit for each number there is, by vector.
 */
static int number_of(const struct words *w, const struct vector **vector) {
  if (w->count < 2)
    return -1;
  const char *last = w->at[w->count - 1];
  if (last[0] < '0' || last[0] > '3' || last[1])
    return -1;
  struct words rest = *w;
  rest.count--;
  *vector = vector_of(&rest);
  /* c1 or v1 is too short a name to be sure of */
  return *vector && strlen(rest.at[rest.count - 1]) > 2 ? last[0] - '0' : -1;
}

static enum column component_of(const struct words *words,
                                const unsigned char digits[VECTORS]) {
  struct words w = *words;
  cut_axis(&w);
  if (w.count == 0)
    return COLUMN_OTHER;
  const struct vector *v = NULL;
  const int number = number_of(&w, &v);
  if (number >= 0) {
    const unsigned there = digits[v - vectors];
    const int first = there == 0x7 ? 0 : there == 0xE ? 1 : -1;
    return first < 0 ? COLUMN_OTHER
                     : (enum column)(v->first + (unsigned)(number - first));
  }
  const int end = axis_of(w.at[w.count - 1]), start = axis_of(w.at[0]);
  if (end < 0 && start < 0)
    return COLUMN_OTHER;
  struct words rest = w;
  remove_word(&rest, end >= 0 ? w.count - 1 : 0);
  const int axis = end >= 0 ? end : start;
  if (rest.count == 0)
    return (enum column)(COLUMN_X + axis);
  v = vector_of(&rest);
  return v ? (enum column)(v->first + (unsigned)axis) : COLUMN_OTHER;
}

/* Names of columns */

struct meaning {
  double unit;
  enum column column;
  bool step; /* a time only where there is no better one */
  bool said; /* the unit */
};

static enum column scalar_of(const struct words *w, bool *step) {
  static const struct {
    enum column column;
    const char *words;
  } scalars[] = {{COLUMN_ID, " id ids identifier "},
                 {COLUMN_R, " r radius radii "},
                 {COLUMN_D, " d diameter diameters diam dia "},
                 {COLUMN_M, " m mass masses "},
                 {COLUMN_T, " t time times "},
                 {COLUMN_FIXED, " fixed "}};
  *step =
      (w->count == 1 && in_list(w->at[0], " step timestep frame ")) ||
      (w->count == 2 && !strcmp(w->at[0], "time") && !strcmp(w->at[1], "step"));
  if (*step)
    return COLUMN_T;
  if (w->count != 1)
    return COLUMN_OTHER;
  for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
    if (in_list(w->at[0], scalars[k].words))
      return scalars[k].column;
  return COLUMN_OTHER;
}

static struct meaning meaning_of_words(const struct words *w,
                                       const unsigned char digits[VECTORS]) {
  struct meaning m = {.unit = 1};
  m.column = scalar_of(w, &m.step);
  if (m.column == COLUMN_OTHER)
    m.column = component_of(w, digits);
  return m;
}

static struct words bare_words(struct text name) {
  struct words w = words_of(name);
  remove_fillers(&w);
  return w;
}

static struct meaning meaning_of(struct text name,
                                 const unsigned char digits[VECTORS]) {
  const struct unit *u = take_unit(&name);
  struct words w = bare_words(name);
  struct meaning m = meaning_of_words(&w, digits);
  if (m.column == COLUMN_OTHER && !u && w.count > 1) { /* x_mm */
    const char *last = w.at[w.count - 1];
    u = find_unit((struct text){last, strlen(last)});
    if (u && u->dimension == PURE)
      u = NULL;
    w.count -= u != NULL;
    if (u && *name.at != 'T') /* T_s is no time */
      m = meaning_of_words(&w, digits);
  }
  if (u && !is_unit_of(u, m.column))
    m.column = COLUMN_OTHER; /* of another kind: r (deg) */
  m.said = u && u->dimension != PURE && m.column != COLUMN_OTHER;
  m.unit = m.said ? u->factor : 1;
  return m;
}

static void find_digits(size_t count, const struct text *name,
                        unsigned char digits[VECTORS]) {
  memset(digits, 0, VECTORS);
  for (size_t k = 0; k < count; k++) {
    struct text t = name[k];
    take_unit(&t);
    const struct words w = bare_words(t);
    const struct vector *v;
    const int number = number_of(&w, &v);
    if (number >= 0)
      digits[v - vectors] |= (unsigned char)(1 << number);
  }
}

/* All columns of a table */

void columns_clear(struct columns *c) {
  c->count = 0;
  memset(c->has, 0, sizeof c->has);
  c->dismissed[0] = c->wrong[0] = 0;
}

int columns_add(struct columns *c, enum column what, struct text name) {
  assert(what < COLUMNS && c->count <= MOST_FIELDS);
  const int shown = (int)(name.length < LONGEST_NAME ? name.length : //
                              LONGEST_NAME - 1);
  if (c->count == MOST_FIELDS) {
    snprintf(c->wrong, sizeof c->wrong, "more than %d columns", MOST_FIELDS);
    return GSL_EINVAL;
  }
  if (what != COLUMN_OTHER && c->has[what]) {
    snprintf(c->wrong, sizeof c->wrong,
             "columns '%s' and '%.*s' both may be %s: expected one, or "
             "--columns, which says what each is",
             c->name[what], shown, name.at, column_name(what));
    return GSL_EINVAL;
  }
  c->has[what] = true;
  snprintf(c->name[what], LONGEST_NAME, "%.*s", shown, name.at);
  c->unit[c->count] = 1;
  c->said[c->count] = false;
  c->at[c->count++] = (unsigned char)what;
  return GSL_SUCCESS;
}

bool columns_place(const struct columns *c) {
  return c->has[COLUMN_X] && c->has[COLUMN_Y] && c->has[COLUMN_Z];
}

/* Is a name, but for its unit, just this letter? */
static bool is_letter_word(struct text t, char letter) {
  take_unit(&t);
  t = trimmed(t);
  return t.length == 1 && t.at[0] == letter;
}

/* The column that is just this letter, count if there is none. */
static size_t find_letter(size_t count, const struct text *name, char letter) {
  size_t k = 0;
  while (k < count && !is_letter_word(name[k], letter))
    k++;
  return k;
}

static bool is_angle(struct text name) {
  take_unit(&name);
  const struct words w = words_of(name);
  return w.count == 1 &&
         in_list(w.at[0], " theta phi azimuth angle \xCE\xB8 \xCF\x86 "
                          "\xCF\x95 ");
}

/* R beside G and B is a colour; r beside an angle may be a coordinate. */
int columns_settle_radius(struct columns *c, size_t count,
                          const struct text *name, enum column *what) {
  bool other = false; /* another column is a size */
  size_t angle = count;
  for (size_t k = 0; k < count; k++) {
    other |= (what[k] == COLUMN_R || what[k] == COLUMN_D) &&
             !is_letter_word(name[k], 'r') && !is_letter_word(name[k], 'R');
    if (is_angle(name[k]))
      angle = k;
  }
  for (int upper = 0; upper < 2; upper++) {
    const size_t r = find_letter(count, name, upper ? 'R' : 'r'),
                 g = find_letter(count, name, upper ? 'G' : 'g'),
                 b = find_letter(count, name, upper ? 'B' : 'b');
    if (r < count && g < count && b < count) {
      what[r] = COLUMN_OTHER;
      snprintf(c->dismissed, sizeof c->dismissed,
               "'%c' beside '%c' and '%c' is a colour; ", *trimmed(name[r]).at,
               *trimmed(name[g]).at, *trimmed(name[b]).at);
    } else if (r < count && angle < count) {
      what[r] = COLUMN_OTHER;
      if (other)
        continue;
      snprintf(c->wrong, sizeof c->wrong,
               "column '%c' may be a radius or, as '%.*s' is there, a "
               "coordinate: expected --columns, which says what each is",
               *trimmed(name[r]).at,
               name[angle].length > 30 ? 30 : (int)name[angle].length,
               name[angle].at);
      return GSL_EINVAL;
    }
  }
  return GSL_SUCCESS;
}

/* T is a temperature, unless it has the unit of a time; t a time; in a table of
   capitals T may be either. Steps are times where nothing else is. */
static int settle_time(struct columns *c, size_t count, const struct text *name,
                       struct meaning *m) {
  bool time = false, small = false;
  size_t kelvin = find_letter(count, name, 'T');
  if (kelvin < count && trimmed(name[kelvin]).length > 1)
    kelvin = count; /* T (s) */
  for (size_t k = 0; k < count; k++) {
    time |= m[k].column == COLUMN_T && !m[k].step && k != kelvin;
    for (size_t l = 0; l < name[k].length; l++)
      small |= islower((unsigned char)name[k].at[l]) != 0;
  }
  if (kelvin < count && !time && !small) {
    snprintf(c->wrong, sizeof c->wrong,
             "column 'T' may be a time or a temperature: expected 'time', or "
             "--columns, which says what each is");
    return GSL_EINVAL;
  }
  if (kelvin < count)
    m[kelvin].column = COLUMN_OTHER;
  for (size_t k = 0; k < count; k++)
    if (time && m[k].step)
      m[k].column = COLUMN_OTHER;
  return GSL_SUCCESS;
}

static void set_unit(struct columns *c, const struct meaning *m) {
  c->unit[c->count - 1] = m->unit;
  c->said[c->count - 1] = m->said;
}

int columns_check_units(struct columns *c) {
  for (size_t k = 0; k < c->count; k++)
    for (size_t l = 0; l < c->count; l++)
      if (c->at[k] != COLUMN_OTHER && c->at[l] != COLUMN_OTHER &&
          dimension_of((enum column)c->at[k]) ==
              dimension_of((enum column)c->at[l]) &&
          c->said[k] && c->unit[k] != 1 && !c->said[l]) {
        snprintf(c->wrong, sizeof c->wrong,
                 "column '%s' has a unit and column '%s' has none: expected "
                 "one for each, in the names, in a row or by --columns",
                 c->name[c->at[k]], c->name[c->at[l]]);
        return GSL_EINVAL;
      }
  return GSL_SUCCESS;
}

int columns_of_names(struct columns *c, size_t count, const struct text *name) {
  struct meaning m[MOST_FIELDS];
  enum column what[MOST_FIELDS];
  unsigned char digits[VECTORS];
  columns_clear(c);
  if (count > MOST_FIELDS) {
    snprintf(c->wrong, sizeof c->wrong, "more than %d columns", MOST_FIELDS);
    return GSL_EINVAL;
  }
  find_digits(count, name, digits);
  for (size_t k = 0; k < count; k++)
    m[k] = meaning_of(name[k], digits);
  int status = settle_time(c, count, name, m);
  for (size_t k = 0; k < count; k++)
    what[k] = m[k].column;
  if (status == GSL_SUCCESS)
    status = columns_settle_radius(c, count, name, what);
  for (size_t k = 0; k < count && status == GSL_SUCCESS; k++) {
    status = columns_add(c, what[k], name[k]);
    if (status == GSL_SUCCESS)
      set_unit(c, &m[k]);
  }
  return status;
}

bool columns_named_place(size_t count, const struct text *name) {
  unsigned char digits[VECTORS];
  bool has[COLUMNS] = {false};
  find_digits(count, name, digits);
  for (size_t k = 0; k < count; k++)
    has[meaning_of(name[k], digits).column] = true;
  return has[COLUMN_X] && has[COLUMN_Y] && has[COLUMN_Z];
}

bool columns_named_any(size_t count, const struct text *name) {
  unsigned char digits[VECTORS];
  find_digits(count, name, digits);
  for (size_t k = 0; k < count; k++)
    if (meaning_of(name[k], digits).column != COLUMN_OTHER || is_angle(name[k]))
      return true;
  return false;
}

void columns_skip_first(struct columns *c) {
  assert(c->count < MOST_FIELDS);
  memmove(c->at + 1, c->at, c->count * sizeof *c->at);
  memmove(c->unit + 1, c->unit, c->count * sizeof *c->unit);
  memmove(c->said + 1, c->said, c->count * sizeof *c->said);
  c->at[0] = COLUMN_OTHER;
  c->unit[0] = 1;
  c->said[0] = false;
  c->count++;
}

void columns_dismiss(struct columns *c, size_t k) {
  c->has[c->at[k]] = false;
  c->at[k] = COLUMN_OTHER;
}

int columns_of_list(struct columns *c, const char *list) {
  static const unsigned char none[VECTORS];
  columns_clear(c);
  int status = GSL_SUCCESS;
  for (const char *end; list && status == GSL_SUCCESS;
       list = end ? end + 1 : NULL) {
    end = strchr(list, ',');
    const struct text name =
        trimmed((struct text){list, end ? (size_t)(end - list) : strlen(list)});
    const struct meaning m = meaning_of(name, none);
    if ((m.column == COLUMN_OTHER && !same_word(name, "-")) ||
        is_letter_word(name, 'T')) {
      snprintf(
          c->wrong, sizeof c->wrong,
          "'%.*s': expected id x y z r d m vx vy vz wx wy wz t fixed, or - "
          "for a column to skip",
          name.length > 40 ? 40 : (int)name.length, name.at);
      return GSL_EINVAL;
    }
    status = columns_add(c, m.column, name);
    if (status == GSL_SUCCESS)
      set_unit(c, &m);
  }
  if (status == GSL_SUCCESS && !columns_place(c)) {
    snprintf(c->wrong, sizeof c->wrong, "expected x, y and z among them");
    status = GSL_EINVAL;
  }
  return status == GSL_SUCCESS ? columns_check_units(c) : status;
}

bool columns_of_units(struct columns *c, size_t count,
                      const struct text *fields) {
  double unit[MOST_FIELDS];
  bool said[MOST_FIELDS];
  bool any = false;
  for (size_t k = 0; k < c->count; k++) {
    struct text t = k < count ? trimmed(fields[k]) : (struct text){"", 0};
    if (t.length > 1 && strchr("[(", *t.at) && strchr(")]", t.at[t.length - 1]))
      t = (struct text){t.at + 1, t.length - 2};
    const struct unit *u = find_unit(t);
    unit[k] = c->unit[k];
    said[k] = c->said[k];
    if (c->at[k] == COLUMN_OTHER)
      continue;
    if (!u || !is_unit_of(u, c->at[k]))
      return false;
    any |= u->dimension != PURE; /* a row of ones has none */
    if (u->dimension == PURE)
      continue;
    unit[k] = u->factor;
    said[k] = true;
  }
  if (!any)
    return false;
  memcpy(c->unit, unit, c->count * sizeof *unit);
  memcpy(c->said, said, c->count * sizeof *said);
  return true;
}
