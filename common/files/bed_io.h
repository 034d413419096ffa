/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bed format: start state, snapshot, restart and archive in one; text,
   tab-separated, numbers as short as they read back the same, frames separated
   by two blank lines, "# key=value" lines, a line of column names, and a last
   line "# status=ok". README.md describes it. Here: its header and the writer;
   formats.h reads it and what others write. Tested in tests/test_bed_io.c. */
#ifndef BED_IO_H
#define BED_IO_H

#include <stdbool.h>
#include <stdio.h>
#include "model/bed.h"
#include "platform/store.h"

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

/* All of it (platform/store.h), taken out into an empty header. */
void bed_header_store(struct bed_header *h, struct store *s);

/* Writes a frame: its header's keys with their checksum (files/sheet.h), then
   t, columns and rows with theirs; spin adds the columns of angular velocity.
   Separate frames with bed_write_gap and end the file with bed_write_status.
   Errors stay in ferror(out). */
void bed_write_frame(FILE *out, const struct bed_header *h, const struct bed *b,
                     bool spin);
void bed_write_gap(FILE *out);
void bed_write_status(FILE *out, const char *status);

#endif
