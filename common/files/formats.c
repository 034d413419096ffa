/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files/formats.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/readers.h"

/* In the order in which a line is offered to them. */
static const struct bed_format *const formats[] = {
    &format_bed, &format_table, &format_lammps, &format_lammps_data,
    &format_xyz};
enum { FORMATS = sizeof formats / sizeof *formats };

/* A title and what else may stand before the first line that says what a file
   is. */
enum { MOST_LINES_AHEAD = 100 };

const struct bed_format *bed_format_named(const char *name) {
  for (int k = 0; k < FORMATS; k++)
    if (!strcmp(formats[k]->name, name))
      return formats[k];
  return NULL;
}

const char *bed_format_name(size_t k) {
  return k < FORMATS ? formats[k]->name : NULL;
}

const char *bed_format_help(size_t k) {
  return k < FORMATS ? formats[k]->help : NULL;
}

static int take_format(struct bed_reader *r, const struct bed_format *format) {
  r->state = calloc(1, format->state_size);
  if (!r->state)
    return GSL_ENOMEM;
  r->format = format;
  r->quotes = format->quotes;
  return GSL_SUCCESS;
}

int bed_reader_open(struct bed_reader **out, FILE *in, const char *name,
                    const struct bed_reader_options *o) {
  struct bed_reader *r = calloc(1, sizeof *r);
  if (!r)
    return GSL_ENOMEM;
  r->in = in;
  r->name = name;
  r->options = *o;
  r->default_radius = o->radius;
  r->quotes = true; /* they may, as long as the format is not known */
  if (o->format && take_format(r, o->format) != GSL_SUCCESS) {
    bed_reader_close(r);
    return GSL_ENOMEM;
  }
  *out = r;
  return GSL_SUCCESS;
}

/* The first line that is neither blank nor a comment, or else the first that is
   not blank. */
static size_t first_line(const struct bed_reader *r) {
  size_t first = r->kept_count;
  for (size_t k = r->kept_count; k-- > 0;)
    if (!line_is_blank(r->kept[k].text) &&
        (first == r->kept_count || !comment_sign(r->kept[k].text) ||
         comment_sign(r->kept[first].text)))
      first = k;
  return first;
}

static int none_begins(struct bed_reader *r) {
  const size_t first = first_line(r);
  if (first == r->kept_count)
    return reader_fail(r, "nothing is in the file: expected a bed, which ends "
                          "with '# status=ok', or another format");
  r->line_number = r->kept[first].number;
  if (r->options.columns)
    return reader_fail(r, "'%.40s': expected rows of numbers in %zu columns",
                       r->kept[first].text, r->options.columns->count);
  return reader_fail(r,
                     "'%.40s': expected a bed, a table with columns x, y and z "
                     "(or --columns), a LAMMPS dump or data file, or an XYZ "
                     "file",
                     r->kept[first].text);
}

static int find_format(struct bed_reader *r) {
  bool first = true;
  for (int line = 0; line < MOST_LINES_AHEAD; line++) {
    int status = reader_line(r);
    if (status == GSL_EOF)
      break;
    if (status == GSL_SUCCESS)
      status = reader_keep(r);
    if (status != GSL_SUCCESS)
      return status;
    if (line_is_blank(r->line))
      continue;
    for (int k = 0; k < FORMATS; k++)
      if (formats[k]->begins(r, r->line, first)) {
        reader_rewind(r);
        return take_format(r, formats[k]);
      }
    first = first && comment_sign(r->line);
  }
  return none_begins(r);
}

int bed_reader_next(struct bed_reader *r, struct bed *b) {
  r->note[0] = 0;
  const int status = r->format ? GSL_SUCCESS : find_format(r);
  return status == GSL_SUCCESS ? r->format->next(r, b) : status;
}

void bed_reader_close(struct bed_reader *r) {
  if (!r)
    return;
  bed_header_free(&r->header);
  for (size_t k = 0; k < r->kept_count; k++)
    free(r->kept[k].text);
  free(r->kept);
  free(r->line);
  free(r->rows);
  free(r->state);
  free(r);
}

const struct bed_header *bed_reader_header(const struct bed_reader *r) {
  return &r->header;
}

const char *bed_reader_error(const struct bed_reader *r) {
  return r->error;
}

const char *bed_reader_note(const struct bed_reader *r) {
  return *r->note ? r->note : NULL;
}

bool bed_reader_is_bed(const struct bed_reader *r) {
  return r->format == &format_bed;
}

bool bed_reader_is_cut(const struct bed_reader *r) {
  return r->cut || r->cut_noted;
}

const char *bed_reader_sum(const struct bed_reader *r) {
  return *r->sum ? r->sum : NULL;
}

size_t bed_reader_part(const struct bed_reader *r) {
  return r->part;
}
