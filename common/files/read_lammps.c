/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text dumps of LAMMPS and LIGGGHTS: frames of items, each a line "ITEM: ..."
   and what belongs to it. docs.lammps.org/dump.html, Howto_triclinic.html. */
#include "files/readers.h"

#include <math.h>
#include <string.h>
#include <gsl/gsl_errno.h>

static const char item[] = "ITEM:";

struct dump {
  double t;
  size_t count;
  bool begun, has_t, has_count, has_box, scaled;
  double origin[3], edge[3][3]; /* of the box */
};

static bool is_item(const char *line) {
  return !strncmp(line, item, strlen(item));
}

static bool begins_dump(const struct bed_reader *r, const char *line,
                        bool first) {
  (void)r;
  return first && is_item(line);
}

/* The line after an item's; it may not be missing. */
static int next_line(struct bed_reader *r) {
  const int status = reader_line(r);
  if (status == GSL_SUCCESS && is_item(r->line))
    return reader_fail(r, "expected what belongs to the ITEM: before");
  return status;
}

/* Three lines of between least and most numbers; what is missing is 0. */
static int read_bounds(struct bed_reader *r, size_t least, size_t most,
                       double value[3][4]) {
  struct text fields[MOST_FIELDS + 1];
  reader_clear_columns(r, BLANKS);
  for (int k = 0; k < 3; k++) {
    const int status = next_line(r);
    if (status != GSL_SUCCESS)
      return status;
    const size_t count = reader_fields(r, r->line, fields);
    bool good = count >= least && count <= most;
    for (size_t f = 0; f < 4; f++) {
      value[k][f] = 0;
      good = good && (f >= count || reader_number(r, fields[f], &value[k][f]));
    }
    if (!good)
      return reader_fail(r, "'%.40s': expected the bounds of the box", r->line);
  }
  return GSL_SUCCESS;
}

/* A general triclinic box: its edges, and a coordinate of the origin behind
   each of them. */
static int read_general_box(struct bed_reader *r, struct dump *d) {
  double value[3][4];
  const int status = read_bounds(r, 4, 4, value);
  if (status != GSL_SUCCESS)
    return status;
  for (int k = 0; k < 3; k++) {
    memcpy(d->edge[k], value[k], sizeof d->edge[k]);
    d->origin[k] = value[k][3];
  }
  d->has_box = true;
  return GSL_SUCCESS;
}

/* Any other box: bounds and, of a tilted one, xy, xz and yz. The bounds then
   are those of the whole box, from which its edges follow. */
static int read_box(struct bed_reader *r, struct dump *d) {
  double value[3][4], low[3], high[3];
  const int status = read_bounds(r, 2, 3, value);
  if (status != GSL_SUCCESS)
    return status;
  const double xy = value[0][2], xz = value[1][2], yz = value[2][2];
  for (int k = 0; k < 3; k++) {
    low[k] = value[k][0];
    high[k] = value[k][1];
  }
  const double sum = xy + xz;
  low[0] -= fmin(fmin(0, sum), fmin(xy, xz));
  high[0] -= fmax(fmax(0, sum), fmax(xy, xz));
  low[1] -= fmin(0, yz);
  high[1] -= fmax(0, yz);
  const double edge[3][3] = {{high[0] - low[0], 0, 0},
                             {xy, high[1] - low[1], 0},
                             {xz, yz, high[2] - low[2]}};
  memcpy(d->edge, edge, sizeof edge);
  memcpy(d->origin, low, sizeof low);
  d->has_box = true;
  return GSL_SUCCESS;
}

/* Of a name x.. y.. z.. with this ending: which of them, or -1. */
static int place_of(struct text name, const char *ending) {
  const struct text rest = {name.at + 1, name.length - 1};
  return name.length && strchr("xyz", *name.at) && same_word(rest, ending)
             ? *name.at - 'x'
             : -1;
}

static bool has_places(size_t count, const struct text *names,
                       const char *ending) {
  bool has[3] = {false};
  for (size_t k = 0; k < count; k++) {
    const int axis = place_of(names[k], ending);
    if (axis >= 0)
      has[axis] = true;
  }
  return has[0] && has[1] && has[2];
}

static int read_names(struct bed_reader *r, struct dump *d, const char *line) {
  static const char *const endings[] = {"", "u", "s", "su"};
  struct text names[MOST_FIELDS + 1];
  enum column what[MOST_FIELDS + 1];
  reader_clear_columns(r, BLANKS);
  d->scaled = false;
  if (reader_takes_columns(r))
    return reader_check_columns(r);
  const size_t count = reader_fields(r, line, names);
  int e = 0;
  while (e < 4 && !has_places(count, names, endings[e]))
    e++;
  if (e == 4)
    return reader_fail(r, "expected columns x y z, xu yu zu, xs ys zs or xsu "
                          "ysu zsu after ITEM: ATOMS");
  d->scaled = e > 1;
  if (d->scaled && !d->has_box)
    return reader_fail(r, "scaled coordinates without ITEM: BOX BOUNDS");
  for (size_t k = 0; k < count; k++) {
    const int axis = place_of(names[k], endings[e]);
    what[k] = column_named(names[k]);
    if (axis >= 0)
      what[k] = (enum column)(COLUMN_X + axis);
    else if (what[k] == COLUMN_T ||
             (what[k] >= COLUMN_X && what[k] <= COLUMN_Z))
      what[k] = COLUMN_OTHER;
  }
  if (reader_settle_radius(r, count, names, what) != GSL_SUCCESS)
    return GSL_EINVAL;
  for (size_t k = 0; k < count; k++) {
    const int status = reader_add_column(r, what[k], names[k]);
    if (status != GSL_SUCCESS)
      return status;
  }
  return reader_check_columns(r);
}

static int unscale(struct bed_reader *r, const struct dump *d) {
  double *x = r->rows[r->rows_count - 1] + COLUMN_X;
  const double s[3] = {x[0], x[1], x[2]}, most = r->options.largest;
  for (int k = 0; k < 3; k++) {
    x[k] = d->origin[k] + s[0] * d->edge[0][k] + s[1] * d->edge[1][k] +
           s[2] * d->edge[2][k];
    if (!isfinite(x[k]) || (most > 0 && fabs(x[k]) > most))
      return reader_fail(r, "column %cs times the box is %g: too large",
                         "xyz"[k], x[k]);
  }
  return GSL_SUCCESS;
}

static int read_atoms(struct bed_reader *r, const struct dump *d) {
  while (r->rows_count < d->count) {
    int status = reader_line(r);
    if (status != GSL_SUCCESS)
      return status;
    if (is_item(r->line))
      return reader_fail(r, "expected sphere %zu of %zu", r->rows_count + 1,
                         d->count);
    status = reader_row(r);
    if (status == GSL_SUCCESS && d->scaled)
      status = unscale(r, d);
    if (status != GSL_SUCCESS)
      return status;
  }
  return GSL_SUCCESS;
}

static int read_item(struct bed_reader *r, struct dump *d, const char *name) {
  if (!strncmp(name, "BOX BOUNDS", 10))
    return strstr(name, "abc") ? read_general_box(r, d) : read_box(r, d);
  const bool units = !strncmp(name, "UNITS", 5);
  const bool time = !strncmp(name, "TIME", 4) && strncmp(name, "TIMESTEP", 8);
  const bool step = !strncmp(name, "TIMESTEP", 8);
  const bool count = !strncmp(name, "NUMBER OF ATOMS", 15);
  if (!units && !time && !step && !count)
    return reader_fail(r, "'ITEM: %.40s' is not known", name);
  int status = next_line(r);
  reader_clear_columns(r, BLANKS);
  if (status != GSL_SUCCESS || units)
    return status;
  if (count) {
    d->has_count = true;
    return reader_line_count(r, "the number of atoms", &d->count);
  }
  double value;
  status = reader_line_number(r, time ? "the time" : "the time step", &value);
  if (status == GSL_SUCCESS && (time || !d->has_t))
    d->t = value;
  d->has_t |= time;
  return status;
}

static int next_dump(struct bed_reader *r, struct bed *b) {
  struct dump d = {0};
  int status;
  while ((status = reader_line(r)) == GSL_SUCCESS) {
    if (line_is_blank(r->line))
      continue;
    if (!is_item(r->line))
      return reader_fail(r, "'%.40s': expected a line 'ITEM: ...'%s", r->line,
                         r->frames ? ", or more atoms announced" : "");
    d.begun = true;
    const char *name = r->line + strlen(item);
    name += strspn(name, " \t");
    if (strncmp(name, "ATOMS", 5)) {
      status = read_item(r, &d, name);
    } else if (!d.has_count) {
      return reader_fail(r, "no ITEM: NUMBER OF ATOMS before");
    } else {
      status = read_names(r, &d, name + 5);
      if (status == GSL_SUCCESS)
        status = read_atoms(r, &d);
      if (status == GSL_SUCCESS)
        return reader_frame(r, b, d.t);
    }
    if (status != GSL_SUCCESS)
      break;
  }
  if (status != GSL_EOF)
    return status;
  return d.begun || !r->frames
             ? reader_cut(r, b, d.t, "more of a frame", d.count)
             : GSL_EOF;
}

const struct bed_format format_lammps = {.name = "lammps",
                                         .help = "text dumps of LAMMPS and "
                                                 "LIGGGHTS",
                                         .begins = begins_dump,
                                         .state_size = 1,
                                         .next = next_dump};
