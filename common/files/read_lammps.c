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
  double origin[3], size[3], xy, xz, yz;
};

static bool begins_item(const char *line) {
  return !strncmp(line, item, strlen(item));
}

/* The line after an item's; it may not be missing. */
static int next_line(struct bed_reader *r) {
  const int status = reader_line(r);
  if (status == GSL_SUCCESS && begins_item(r->line))
    return reader_fail(r, "expected what belongs to the ITEM: before");
  return status;
}

/* The box as a dump has it: bounds of a tilted one, from which its edges
   follow. */
static int read_box(struct bed_reader *r, struct dump *d) {
  double low[3], high[3], tilt[3] = {0};
  columns_clear(r, BLANKS);
  for (int k = 0; k < 3; k++) {
    const int status = next_line(r);
    if (status != GSL_SUCCESS)
      return status;
    const char *at = r->line, *field;
    double value[3] = {0, 0, 0};
    int count = 0;
    size_t length;
    while ((field = reader_field(r, &at, &length))) {
      if (count == 3 || !reader_number(r, field, length, &value[count]))
        return reader_fail(r, "'%.40s': expected the bounds of the box",
                           r->line);
      count++;
    }
    if (count < 2)
      return reader_fail(r, "'%.40s': expected the bounds of the box", r->line);
    low[k] = value[0];
    high[k] = value[1];
    tilt[k] = value[2];
  }
  d->xy = tilt[0];
  d->xz = tilt[1];
  d->yz = tilt[2];
  const double sum = d->xy + d->xz;
  low[0] -= fmin(fmin(0, sum), fmin(d->xy, d->xz));
  high[0] -= fmax(fmax(0, sum), fmax(d->xy, d->xz));
  low[1] -= fmin(0, d->yz);
  high[1] -= fmax(0, d->yz);
  for (int k = 0; k < 3; k++) {
    d->origin[k] = low[k];
    d->size[k] = high[k] - low[k];
  }
  d->has_box = true;
  return GSL_SUCCESS;
}

/* Of the columns x.. y.. z.. with this ending, are there all? */
static bool has_places(const struct bed_reader *r, const char *names,
                       const char *ending) {
  bool has[3] = {false};
  size_t length;
  for (const char *name; (name = reader_field(r, &names, &length));)
    for (int k = 0; k < 3; k++)
      if (*name == "xyz"[k] && same_word(name + 1, length - 1, ending))
        has[k] = true;
  return has[0] && has[1] && has[2];
}

static int read_names(struct bed_reader *r, struct dump *d, const char *names) {
  static const char *const endings[] = {"", "u", "s", "su"};
  columns_clear(r, BLANKS);
  int e = 0;
  while (e < 4 && !has_places(r, names, endings[e]))
    e++;
  if (e == 4)
    return reader_fail(r, "expected columns x y z, xu yu zu, xs ys zs or xsu "
                          "ysu zsu after ITEM: ATOMS");
  d->scaled = e > 1;
  if (d->scaled && !d->has_box)
    return reader_fail(r, "scaled coordinates without ITEM: BOX BOUNDS");
  size_t length;
  int status = GSL_SUCCESS;
  for (const char *name;
       status == GSL_SUCCESS && (name = reader_field(r, &names, &length));) {
    enum column c = COLUMN_OTHER;
    if (length > 1 + strlen(endings[e]) || !strchr("xyz", *name))
      c = column_named(name, length);
    else if (same_word(name + 1, length - 1, endings[e]))
      c = *name == 'x' ? COLUMN_X : *name == 'y' ? COLUMN_Y : COLUMN_Z;
    status = columns_add(r, c == COLUMN_T ? COLUMN_OTHER : c);
  }
  return status == GSL_SUCCESS ? columns_check(r) : status;
}

static int unscale(struct bed_reader *r, const struct dump *d) {
  double *x = r->rows[r->rows_count - 1] + COLUMN_X;
  const double s[3] = {x[0], x[1], x[2]};
  x[0] = d->origin[0] + s[0] * d->size[0] + s[1] * d->xy + s[2] * d->xz;
  x[1] = d->origin[1] + s[1] * d->size[1] + s[2] * d->yz;
  x[2] = d->origin[2] + s[2] * d->size[2];
  const double most = r->options.largest;
  for (int k = 0; k < 3; k++)
    if (!isfinite(x[k]) || (most > 0 && fabs(x[k]) > most))
      return reader_fail(r, "column %cs times the box is %g: too large",
                         "xyz"[k], x[k]);
  return GSL_SUCCESS;
}

static int read_atoms(struct bed_reader *r, const struct dump *d) {
  while (r->rows_count < d->count) {
    int status = reader_line(r);
    if (status != GSL_SUCCESS)
      return status;
    if (begins_item(r->line))
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
  if (!strncmp(name, "BOX BOUNDS", 10)) {
    if (strstr(name, "abc"))
      return reader_fail(r, "a general triclinic box is not known");
    return read_box(r, d);
  }
  const bool units = !strncmp(name, "UNITS", 5);
  const bool time = !strncmp(name, "TIME", 4) && strncmp(name, "TIMESTEP", 8);
  const bool step = !strncmp(name, "TIMESTEP", 8);
  const bool count = !strncmp(name, "NUMBER OF ATOMS", 15);
  if (!units && !time && !step && !count)
    return reader_fail(r, "'ITEM: %.40s' is not known", name);
  int status = next_line(r);
  columns_clear(r, BLANKS);
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
    if (!begins_item(r->line))
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
  return d.begun || !r->frames ? reader_cut(r, b, d.t, "more of a frame")
                               : GSL_EOF;
}

const struct bed_format format_lammps = {
    "lammps", "text dump of LAMMPS and LIGGGHTS", begins_item, 1, next_dump};
