/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads beds of any format, frame by frame: our own (bed_io.h) and what others
   write, tables with a line of column names, text dumps of LAMMPS, XYZ plain
   and extended. Lengths are taken as metres, times as seconds. A reader
   belongs to one thread. Tested in tests/test_bed_io.c and
   tests/test_formats.c, fuzzed by tests/fuzz_readers.c. */
#ifndef FORMATS_H
#define FORMATS_H

#include <stdbool.h>
#include <stdio.h>
#include "files/bed_io.h"
#include "files/reader_options.h"

struct bed_reader;

/* The one with this name, NULL if there is none; format_bed's is "bed". */
const struct bed_format *bed_format_named(const char *name);

/* Reads from an open stream, which need not be a file and has to stay open as
   long as the reader; so has name, which is for messages. GSL_ENOMEM. */
int bed_reader_open(struct bed_reader **out, FILE *in, const char *name,
                    const struct bed_reader_options *o);

/* The next frame, allocated into b. GSL_SUCCESS; GSL_EOF after the last;
   GSL_EINVAL with bed_reader_error saying "name:line: ..."; GSL_ENOMEM. The
   header then holds every key seen so far, "t" and "status" among them; none
   are in LAMMPS dumps and XYZ files. Without a time t is LAMMPS's step, or the
   number of an XYZ frame. */
int bed_reader_next(struct bed_reader *r, struct bed *b);
const struct bed_header *bed_reader_header(const struct bed_reader *r);
const char *bed_reader_error(const struct bed_reader *r);
void bed_reader_close(struct bed_reader *r); /* leaves the stream open */

#endif
