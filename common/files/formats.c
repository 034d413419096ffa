/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files/formats.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/readers.h"

/* In the order in which the first line is offered to them: the last one takes
   any. */
static const struct bed_format *const formats[] = {&format_lammps, &format_xyz,
                                                   &format_table, &format_bed};
enum { FORMATS = sizeof formats / sizeof *formats };

const struct bed_format *bed_format_named(const char *name) {
  for (int k = 0; k < FORMATS; k++)
    if (!strcmp(formats[k]->name, name))
      return formats[k];
  return NULL;
}

static int take_format(struct bed_reader *r, const struct bed_format *format) {
  r->state = calloc(1, format->state_size);
  if (!r->state)
    return GSL_ENOMEM;
  r->format = format;
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
  if (o->format && take_format(r, o->format) != GSL_SUCCESS) {
    bed_reader_close(r);
    return GSL_ENOMEM;
  }
  *out = r;
  return GSL_SUCCESS;
}

/* By the first line that is not blank; a file without one is a bed cut short.
 */
static int find_format(struct bed_reader *r) {
  int status;
  do
    status = reader_line(r);
  while (status == GSL_SUCCESS && line_is_blank(r->line));
  if (status == GSL_EOF)
    return take_format(r, &format_bed);
  if (status != GSL_SUCCESS)
    return status;
  r->held = true;
  int k = 0;
  while (!formats[k]->begins(r->line))
    k++;
  assert(k < FORMATS);
  return take_format(r, formats[k]);
}

int bed_reader_next(struct bed_reader *r, struct bed *b) {
  const int status = r->format ? GSL_SUCCESS : find_format(r);
  return status == GSL_SUCCESS ? r->format->next(r, b) : status;
}

void bed_reader_close(struct bed_reader *r) {
  if (!r)
    return;
  bed_header_free(&r->header);
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
