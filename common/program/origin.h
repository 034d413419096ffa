/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What made a file, in the file: the program, its version, build and command
   line. Every format has its own way of saying so, or none
   (docs/reliability.md, "What a file says of its origin"). Tested in
   tests/test_provenance.sh. */
#ifndef ORIGIN_H
#define ORIGIN_H

#include <stdio.h>

/* A name and its value, and what stands around them. */
struct origin_style {
  const char *before, *between, *after;
  int most; /* characters of a value; 0: all of them */
};

extern const struct origin_style origin_comment;   /* # name=value, lines */
extern const struct origin_style origin_short;     /* the same, lines < 256 */
extern const struct origin_style origin_slashes;   /* // name=value, lines */
extern const struct origin_style origin_statistic; /* name, tab, value, lines */
extern const struct origin_style origin_attribute; /* name="value", blanks */

void origin_put(FILE *out, const struct origin_style *s, const char *name,
                const char *value);

/* The same for program, version, build, command and bed, the file that it is of
   (NULL: no such line). These are printable ASCII without quotation marks ("),
   as command_words has them. */
void origin_write(FILE *out, const struct origin_style *s, const char *command,
                  const char *bed);

/* An instruction of XML with all that, which readers pass over; a comment could
   not have the -- of options. */
void origin_write_xml(FILE *out, const char *bed);

/* All that as lines name=value. To be freed. */
char *origin_text(const char *bed);

/* "PROGRAM VERB VERSION", for a format that has room for no more. */
void origin_name(char *text, size_t size);

#endif
