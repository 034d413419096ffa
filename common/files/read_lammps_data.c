/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Data files of LAMMPS, which read_data takes and write_data writes: a title,
   counts, the box, then sections. docs.lammps.org/read_data.html. */
#include "files/readers.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

enum { MOST_TYPES = 256 };

/* The fields that a row of the section Atoms begins with; up to three whole
   numbers, of periodic images, may follow. */
static const struct style {
  const char *name;
  size_t count, type; /* fields; which one is the atom's type, from 0 */
  enum column columns[7];
} styles[] = {
    /* clang-format off */
    {"sphere", 7, 1, {COLUMN_ID, COLUMN_OTHER, COLUMN_D, COLUMN_M, COLUMN_X,
                      COLUMN_Y, COLUMN_Z}}, /* its density becomes a mass */
    {"atomic", 5, 1, {COLUMN_ID, COLUMN_OTHER, COLUMN_X, COLUMN_Y, COLUMN_Z}},
    {"charge", 6, 1, {COLUMN_ID, COLUMN_OTHER, COLUMN_OTHER, COLUMN_X, COLUMN_Y,
                      COLUMN_Z}},
    {"bond", 6, 2, {COLUMN_ID, COLUMN_OTHER, COLUMN_OTHER, COLUMN_X, COLUMN_Y,
                    COLUMN_Z}},
    {"full", 7, 2, {COLUMN_ID, COLUMN_OTHER, COLUMN_OTHER, COLUMN_OTHER,
                    COLUMN_X, COLUMN_Y, COLUMN_Z}}
    /* clang-format on */
};
enum { STYLES = sizeof styles / sizeof *styles, IMAGES = 3 };

struct data_state {
  bool has_count, has_atoms, done;
  bool cut; /* a section other than Atoms is */
  size_t count;
  const struct style *style;
  double mass[MOST_TYPES + 1]; /* of the types; 0: not said */
};

/* "200 atoms" */
static bool is_count(const char *line) {
  line += strspn(line, " \t");
  const size_t digits = strspn(line, "0123456789");
  const char *word = line + digits + strspn(line + digits, " \t");
  return digits && word > line + digits && !strncmp(word, "atoms", 5) &&
         strchr(" \t#", word[5]);
}

static bool begins_data(const struct bed_reader *r, const char *line,
                        bool first) {
  (void)r;
  (void)first;
  return is_count(line);
}

/* Does the section of this name begin here? */
static bool begins_section(const char *line, const char *name) {
  line += strspn(line, " \t");
  const size_t length = strlen(name);
  return !strncmp(line, name, length) && strchr(" \t#", line[length]);
}

/* The next line that is not blank, without a comment at its end. */
static int next_line(struct bed_reader *r) {
  int status;
  do {
    status = reader_line(r);
    if (status == GSL_SUCCESS)
      r->line[strcspn(r->line, "#")] = 0;
  } while (status == GSL_SUCCESS && line_is_blank(r->line));
  return status;
}

static const struct style *style_named(struct text name) {
  static const char *const same[][2] = {
      {"granular", "sphere"}, {"molecular", "bond"}, {"angle", "bond"}};
  for (size_t k = 0; k < sizeof same / sizeof *same; k++)
    if (same_word(name, same[k][0]))
      name = (struct text){same[k][1], strlen(same[k][1])};
  for (int k = 0; k < STYLES; k++)
    if (same_word(name, styles[k].name))
      return &styles[k];
  return NULL;
}

/* By the numbers of a row, where that is enough: of sphere and full, which have
   as many, sphere has a diameter and a density, full two whole numbers. */
static const struct style *style_of_row(const struct bed_reader *r,
                                        const struct text *fields,
                                        size_t count) {
  double third = 0, fourth = 0;
  if (count == styles[1].count + IMAGES || count == styles[0].count + IMAGES)
    count -= IMAGES;
  if (count == styles[1].count)
    return &styles[1];
  if (count == styles[0].count && reader_number(r, fields[2], &third) &&
      reader_number(r, fields[3], &fourth) && third != floor(third))
    return &styles[0];
  return NULL;
}

/* "Atoms # sphere" */
static int read_style(struct bed_reader *r, struct data_state *s,
                      const char *hint) {
  struct text words[MOST_FIELDS + 1];
  s->style = NULL;
  const size_t count = hint ? reader_fields(r, hint + 1, words) : 0;
  if (!count)
    return GSL_SUCCESS;
  s->style = style_named(words[0]);
  return s->style
             ? GSL_SUCCESS
             : reader_fail(r,
                           "atom style '%.*s': expected sphere, atomic, "
                           "charge, bond, angle, molecular or full, or "
                           "--columns",
                           words[0].length > 40 ? 40 : (int)words[0].length,
                           words[0].at);
}

/* The columns, once the first row is there. */
static int set_columns(struct bed_reader *r, struct data_state *s) {
  struct text fields[MOST_FIELDS + 1];
  const size_t count = reader_fields(r, r->line, fields);
  reader_clear_columns(r, BLANKS);
  r->more_fields = true;
  if (reader_takes_columns(r)) {
    s->style = NULL;
    return reader_check_columns(r);
  }
  if (!s->style)
    s->style = style_of_row(r, fields, count);
  if (!s->style)
    return reader_fail(r,
                       "%zu fields, and no atom style: expected 'Atoms # "
                       "sphere' or another style, or --columns",
                       count);
  for (size_t k = 0; k < s->style->count; k++) {
    const char *name = column_name(s->style->columns[k]);
    const int status = reader_add_column(r, s->style->columns[k],
                                         (struct text){name, strlen(name)});
    if (status != GSL_SUCCESS)
      return status;
  }
  return reader_check_columns(r);
}

/* A row of Atoms: the mass follows from the density or from the type. */
static int read_atom(struct bed_reader *r, const struct data_state *s) {
  struct text fields[MOST_FIELDS + 1];
  const size_t count = reader_fields(r, r->line, fields);
  if (s->style && count != s->style->count && count != s->style->count + IMAGES)
    return reader_fail(r, "%zu fields: expected %zu or %zu of atom style %s",
                       count, s->style->count, s->style->count + IMAGES,
                       s->style->name);
  const int status = reader_row(r);
  if (status != GSL_SUCCESS || !s->style)
    return status;
  double *row = r->rows[r->rows_count - 1], type;
  if (s->style == &styles[0])
    row[COLUMN_M] *= 4 * M_PI / 3 * gsl_pow_3(row[COLUMN_R]);
  else if (reader_number(r, fields[s->style->type], &type) && type >= 1 &&
           type <= MOST_TYPES && s->mass[(size_t)type] > 0)
    row[COLUMN_M] = s->mass[(size_t)type];
  const double most = r->options.largest;
  if (!(row[COLUMN_M] > 0) || (most > 0 && row[COLUMN_M] > most))
    return reader_fail(r, "mass %g: expected a number above 0", row[COLUMN_M]);
  return GSL_SUCCESS;
}

static int read_atoms(struct bed_reader *r, struct data_state *s) {
  if (!s->has_count)
    return reader_fail(r, "no number of atoms before");
  if (s->has_atoms)
    return reader_fail(r, "a second section Atoms");
  s->has_atoms = true;
  while (r->rows_count < s->count) {
    int status = next_line(r);
    if (status == GSL_SUCCESS && !r->rows_count)
      status = set_columns(r, s);
    if (status == GSL_SUCCESS)
      status = read_atom(r, s);
    if (status != GSL_SUCCESS)
      return status;
  }
  return GSL_SUCCESS;
}

static int read_masses(struct bed_reader *r, struct data_state *s) {
  struct text fields[MOST_FIELDS + 1];
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    double type, mass;
    if (isalpha((unsigned char)r->line[strspn(r->line, " \t")])) {
      r->held = true; /* the next section, or types with names */
      return GSL_SUCCESS;
    }
    r->line[strcspn(r->line, "#")] = 0;
    if (line_is_blank(r->line))
      continue;
    const size_t count = reader_fields(r, r->line, fields);
    if (count != 2 || !reader_number(r, fields[0], &type) ||
        !reader_number(r, fields[1], &mass) || !(type >= 1) || !(mass > 0))
      return reader_fail(r, "'%.40s': expected a type and its mass", r->line);
    if (type <= MOST_TYPES)
      s->mass[(size_t)type] = mass;
  }
  return status;
}

struct place {
  double id;
  size_t row;
};

static int compare_places(const void *a, const void *b) {
  const double x = ((const struct place *)a)->id,
               y = ((const struct place *)b)->id;
  return (x > y) - (x < y);
}

/* A row of Velocities: id, velocity and, of spheres, the spin. */
static int read_velocity(struct bed_reader *r, const struct place *places) {
  struct text fields[MOST_FIELDS + 1];
  const size_t count = reader_fields(r, r->line, fields);
  struct place key = {0};
  double value[6] = {0};
  bool good =
      (count == 4 || count == 7) && reader_number(r, fields[0], &key.id);
  for (size_t k = 1; good && k < count; k++)
    good = reader_number(r, fields[k], &value[k - 1]);
  if (!good)
    return reader_fail(r, "'%.40s': expected an id and three or six numbers",
                       r->line);
  const struct place *at =
      bsearch(&key, places, r->rows_count, sizeof *places, compare_places);
  if (!at)
    return reader_fail(r, "a velocity of atom %g, which there is not", key.id);
  const double most = r->options.largest;
  for (int k = 0; k < 6; k++) {
    if (most > 0 && !(fabs(value[k]) <= most))
      return reader_fail(r, "a velocity of %g: expected at most %g", value[k],
                         most);
    r->rows[at->row][COLUMN_VX + k] = value[k];
  }
  return GSL_SUCCESS;
}

static int read_velocities(struct bed_reader *r, struct data_state *s) {
  if (!s->has_atoms)
    return reader_fail(r, "section Velocities before Atoms");
  if (!r->columns.has[COLUMN_ID])
    return GSL_SUCCESS; /* whose they are is not known */
  struct place *places = malloc((r->rows_count + 1) * sizeof *places);
  if (!places)
    return GSL_ENOMEM;
  for (size_t i = 0; i < r->rows_count; i++)
    places[i] = (struct place){r->rows[i][COLUMN_ID], i};
  qsort(places, r->rows_count, sizeof *places, compare_places);
  int status = GSL_SUCCESS;
  for (size_t k = 0; k < r->rows_count && status == GSL_SUCCESS; k++) {
    status = next_line(r);
    if (status == GSL_SUCCESS)
      status = read_velocity(r, places);
  }
  free(places);
  s->cut = status == GSL_EOF;
  return status;
}

static int read_section(struct bed_reader *r, struct data_state *s) {
  const char *comment = strchr(r->line, '#');
  if (begins_section(r->line, "Atoms")) {
    const int status =
        r->options.columns ? GSL_SUCCESS : read_style(r, s, comment);
    return status == GSL_SUCCESS ? read_atoms(r, s) : status;
  }
  if (begins_section(r->line, "Velocities"))
    return read_velocities(r, s);
  if (begins_section(r->line, "Masses"))
    return read_masses(r, s);
  if (is_count(r->line) && !s->has_atoms) {
    r->line[strcspn(r->line, "a")] = 0;
    s->has_count = true;
    return reader_line_count(r, "the number of atoms", &s->count);
  }
  return GSL_SUCCESS; /* of no use here */
}

static int next_data(struct bed_reader *r, struct bed *b) {
  struct data_state *s = r->state;
  if (s->done)
    return GSL_EOF;
  reader_clear_columns(r, BLANKS);
  int status = reader_line(r); /* the title */
  while (status == GSL_SUCCESS && (status = reader_line(r)) == GSL_SUCCESS)
    status = read_section(r, s);
  s->done = true;
  if (status != GSL_EOF)
    return status;
  if (r->rows_count < s->count || s->cut)
    return reader_cut(r, b, 0, s->cut ? "another velocity" : "another atom",
                      s->count);
  return reader_frame(r, b, 0);
}

const struct bed_format format_lammps_data = {
    .name = "lammps-data",
    .help = "data files of LAMMPS, atom style sphere and point-like ones",
    .begins = begins_data,
    .state_size = sizeof(struct data_state),
    .next = next_data};
