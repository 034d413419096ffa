/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bed format: start state, snapshot, restart and archive in one; text,
   tab-separated, %.17g, frames separated by two blank lines, "# key=value"
   lines, a line of column names, and a last line "# status=ok". README.md
   describes it. And what others write: tables with
   a line of column names, text dumps of LAMMPS, XYZ plain and extended. Tested
   in tests/test_bed_io.c and tests/test_formats.c, fuzzed by
   tests/fuzz_readers.c. */
#ifndef BED_IO_H
#define BED_IO_H

#include <stdbool.h>
#include <stdio.h>
#include "model/bed.h"

/* Keys of a header in order. A key may be repeated (wall). */
struct bed_header {
  size_t count, size;
  struct bed_key {
    char *name, *value;
  } * at;
};

/* Appends, or replaces the first key of that name. GSL_ENOMEM. */
int bed_header_add(struct bed_header *h, const char *name, const char *value);
int bed_header_set(struct bed_header *h, const char *name, const char *value);
/* NULL if there is no such key. */
const char *bed_header_get(const struct bed_header *h, const char *name);
void bed_header_remove(struct bed_header *h, const char *name);
void bed_header_free(struct bed_header *h);

struct bed_reader;

struct bed_reader_options {
  bool allow_partial; /* take what is complete of a file without a good end */
  bool may_be_empty;  /* a stated count of no spheres is a frame */
  double radius;      /* of spheres that come without one (m); 0: none */
  double largest;     /* magnitude of any number but an id; 0: no limit */
};

/* Reads a bed's frames from an open stream, which need not be a file; name is
   for messages. allow_partial takes what is complete of a file without a good
   last line. NULL without memory. */
struct bed_reader *bed_reader_open(FILE *in, const char *name,
                                   bool allow_partial);
/* The same for any of the formats: which one, the first line says. */
struct bed_reader *bed_reader_open_any(FILE *in, const char *name,
                                       const struct bed_reader_options *o);
/* The next frame, allocated into b. GSL_SUCCESS; GSL_EOF after the last;
   GSL_EINVAL with bed_reader_error saying "name:line: ..."; GSL_ENOMEM. The
   header then holds every key seen so far, "t" and "status" among them; none
   are in LAMMPS dumps and XYZ files. Lengths are taken as metres, times as
   seconds. Without a time t is LAMMPS's step, or the number of an XYZ frame. */
int bed_reader_next(struct bed_reader *r, struct bed *b);
const struct bed_header *bed_reader_header(const struct bed_reader *r);
const char *bed_reader_error(const struct bed_reader *r);
void bed_reader_close(struct bed_reader *r); /* leaves the stream open */

/* Writes a frame: its header's keys, t, columns and rows; spin adds the
   columns of angular velocity. Separate frames with bed_write_gap and end the
   file with bed_write_status. Errors stay in ferror(out). */
void bed_write_frame(FILE *out, const struct bed_header *h, const struct bed *b,
                     bool spin);
void bed_write_gap(FILE *out);
void bed_write_status(FILE *out, const char *status);

#endif
