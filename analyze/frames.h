/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading the operands of a verb, frame by frame until the end. */
#ifndef FRAMES_H
#define FRAMES_H

#include <float.h>
#include "files/formats.h"
#include "geometry/observer.h"
#include "program/command_line.h"
#include "program/files.h"
#include "program/progress.h"

struct frames_options {
  bool allow_partial;  /* take what is complete of a file without a good end */
  double radius;       /* of spheres that come without one (m); 0: none */
  const char *columns; /* what a row's columns are; NULL: their names say so */
  bool quiet;          /* no progress */
  bool origin;         /* a table begins with what made it */
  bool may_be_empty;   /* a frame of no spheres is no error */
  bool many;           /* several files are no error */
  bool scene; /* walls and parameters count: say where there are none */
};

/* Rows of a verb's option table, into a struct frames_options s. */
/* clang-format off */
#define FRAMES_OPTIONS(s)                                                      \
  {.name = "radius", .type = OPTION_DOUBLE, .value = &(s).radius,              \
   .least = DBL_MIN, .most = OPTION_MANY, .unit = "m",                         \
   .help = "of spheres that come without one"},                                \
  {.name = "columns", .type = OPTION_TEXT, .value = &(s).columns,              \
   .unit = "- skips one",                                                      \
   .help = "of a table, such as x,y,z,r, instead of its names"},               \
  {.name = "allow-partial", .type = OPTION_FLAG, .value = &(s).allow_partial,  \
   .help = "take a file that is cut short or marked as failed"},               \
  {.name = "quiet", .type = OPTION_FLAG, .value = &(s).quiet,                  \
   .help = "no progress on a terminal", .silent = true}
/* clang-format on */

struct frames {
  const char *name; /* of the input, for messages */
  bool first;       /* the frame just read is the first one of its bed */

  struct frames_options options;
  struct columns columns;
  char **files; /* operands, and which one comes next */
  size_t count, next;
  struct input in;
  struct bed_reader *reader;
  size_t part; /* of the frame before, bed_reader_part */
  bool any;    /* a frame of this file has spheres */
  struct progress progress;
  double size;     /* of the file (bytes); 0: nobody knows */
  double from, to; /* the frame's share of all files */
  size_t read;     /* frames, for the line */
};

/* Opens the operands from argv[first], or standard input. Exits with one line
   on an error. */
void frames_open(struct frames *f, const struct frames_options *o, int argc,
                 char **argv, int first);

/* Is there more than one operand? */
bool frames_several(const struct frames *f);

/* Is the file at hand in our own format, with parameters and walls? */
bool frames_are_beds(const struct frames *f);

/* A line for each format that is read, for a help text. */
void frames_formats(char *text, size_t size);

/* The next frame, which takes the place of b's last one; those without spheres
   are passed over unless they may be empty. False at the end of the last file;
   exits with one line on bad input. Remarks that are no errors go to
   standard error. */
bool frames_next(struct frames *f, struct bed *b);

/* The keys read so far, "t" and "status" among them (bed_header_get); none in
   a format that has no scene. Valid until the next frame is read. */
const struct bed_header *frames_header(const struct frames *f);

/* A copy of the keys, which a bed of any format gets; exits without memory. */
struct bed_header frames_copy_header(const struct frames *f);

/* How the input ended, for a bed made from it: what was taken as it is with
   --allow-partial stays marked. */
const char *frames_status(const struct frames *f);

/* The file of the frame just read and the frame's checksum, by which one finds
   the bed that an export is of: "bed.tsv, checksum 0bee50ec"; quoted as
   command_words does. To be freed. */
char *frames_origin(const struct frames *f);

/* How much of the work on this frame is done, from 0 to 1 (program/progress.h).
   frames_next and frames_close tell by themselves. */
void frames_tell(struct frames *f, double done);
/* The same for a part of that work by a library's function: it takes it from
   one share to another. */
struct frames_part {
  struct frames *frames;
  double from, to;
};
struct observer frames_observer(struct frames_part *part);

void frames_close(struct frames *f);

#endif
