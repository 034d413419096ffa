/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "frames.h"

#include <unistd.h>
#include <gsl/gsl_errno.h>
#include "program/files.h"
#include "program/command_line.h"

void frames_open(struct frames *f, const struct frames_options *o, int argc,
                 char **argv, int first) {
  if (first + 1 < argc)
    die(EXIT_USAGE, "'%s' after '%s': expected one file", argv[first + 1],
        argv[first]);
  f->in = input_open(first < argc ? argv[first] : NULL, &f->name);
  if (f->in == stdin && isatty(STDIN_FILENO))
    die(EXIT_USAGE, "expected a bed on standard input or a file; see --help");
  f->may_be_empty = o->may_be_empty;
  f->any = false;
  if (o->columns && columns_of_list(&f->columns, o->columns) != GSL_SUCCESS)
    die(EXIT_USAGE, "--columns %s: %s", o->columns, f->columns.wrong);
  const struct bed_reader_options options = {.allow_partial = o->allow_partial,
                                             .may_be_empty = true,
                                             .radius = o->radius,
                                             .largest = 1e100,
                                             .columns = o->columns ? &f->columns
                                                                   : NULL};
  if (bed_reader_open(&f->reader, f->in, f->name, &options) != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
}

bool frames_next(struct frames *f, struct bed *b) {
  int status;
  do {
    bed_free(b);
    status = bed_reader_next(f->reader, b);
    if (status == GSL_ENOMEM)
      die(EXIT_IO, "out of memory");
    if (status == GSL_EINVAL || bed_reader_note(f->reader))
      fflush(stdout); /* rows of the frames before it, then the reason */
    if (status == GSL_EINVAL)
      die(EXIT_INPUT, "%s", bed_reader_error(f->reader));
    if (bed_reader_note(f->reader))
      warn("%s", bed_reader_note(f->reader));
  } while (status == GSL_SUCCESS && !b->n && !f->may_be_empty);
  f->any |= b->n > 0;
  if (status == GSL_EOF && !f->any && !f->may_be_empty)
    die(EXIT_INPUT, "%s: no frame has spheres", f->name);
  return status == GSL_SUCCESS;
}

const struct bed_header *frames_header(const struct frames *f) {
  return bed_reader_header(f->reader);
}

struct bed_header frames_copy_header(const struct frames *f) {
  const struct bed_header *from = frames_header(f);
  struct bed_header h = {0};
  int status = GSL_SUCCESS;
  if (!bed_header_get(from, "format"))
    status = bed_header_add(&h, "format", "bed-1");
  for (size_t k = 0; k < from->count && status == GSL_SUCCESS; k++)
    status = bed_header_add(&h, from->at[k].name, from->at[k].value);
  if (status != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
  return h;
}

const char *frames_status(const struct frames *f) {
  const struct bed_header *h = frames_header(f);
  const char *status = bed_header_get(h, "status");
  return status ? status : bed_header_get(h, "format") ? "cut" : "ok";
}

void frames_close(struct frames *f) {
  bed_reader_close(f->reader);
  if (f->in != stdin)
    fclose(f->in);
}
