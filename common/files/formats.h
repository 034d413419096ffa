/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads beds of any format, frame by frame: our own (bed_io.h) and what others
   write, tables with names or without, text dumps and data files of LAMMPS,
   XYZ plain and extended. Lengths are taken as metres, times as seconds, but
   where a column's name has a unit. A reader belongs to one thread. Tested in
   tests/test_bed_io.c, tests/test_columns.c and tests/test_formats.c, fuzzed by
   tests/fuzz_readers.c. */
#ifndef FORMATS_H
#define FORMATS_H

#include <stdbool.h>
#include <stdio.h>
#include "files/bed_io.h"
#include "files/columns.h"
#include "files/reader_options.h"

struct bed_reader;

/* The one with this name, NULL if there is none; that of bed_io.h is "bed". */
const struct bed_format *bed_format_named(const char *name);
/* Name and purpose of the one with this number, NULL behind the last. */
const char *bed_format_name(size_t k);
const char *bed_format_help(size_t k);

/* Reads from an open stream, which need not be a file and has to stay open as
   long as the reader; so have name, which is for messages, and columns.
   GSL_ENOMEM. */
int bed_reader_open(struct bed_reader **out, FILE *in, const char *name,
                    const struct bed_reader_options *o);

/* The next frame, allocated into b. GSL_SUCCESS; GSL_EOF after the last;
   GSL_EINVAL with bed_reader_error saying "name:line: ..."; GSL_ENOMEM. The
   header then holds every key of a bed seen so far, "t" and "status" among
   them; other formats have none, whatever their comments say. Without a time t
   is LAMMPS's step, the number of an XYZ frame, or 0. */
int bed_reader_next(struct bed_reader *r, struct bed *b);
const struct bed_header *bed_reader_header(const struct bed_reader *r);
const char *bed_reader_error(const struct bed_reader *r);

/* A remark on the frame just read, or on the end, that is no error but should
   reach the user: "name:line: ..."; NULL: none. */
const char *bed_reader_note(const struct bed_reader *r);

/* Is it a bed as bed_io.h has them, with parameters and walls? */
bool bed_reader_is_bed(const struct bed_reader *r);

/* The checksum of the frame just read, which fits: 8 digits; NULL in a file
   that has none. */
const char *bed_reader_sum(const struct bed_reader *r);

/* Did the file end too early, which allow_partial forgives? */
bool bed_reader_is_cut(const struct bed_reader *r);

/* The number of the bed that the frame just read is of, where several stand
   one behind the other, from 0. */
size_t bed_reader_part(const struct bed_reader *r);

void bed_reader_close(struct bed_reader *r); /* leaves the stream open */

#endif
