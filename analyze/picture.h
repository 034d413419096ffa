/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of beds by gnuplot (plots/draw/bed.gp), for draw and movie.
   All exit with one line on an error; the scratch directory goes when the
   program does. */
#ifndef PICTURE_H
#define PICTURE_H

#include "frames.h"
#include "program/files.h"
#include "program/command_line.h"
#include "program/progress.h"

struct picture {
  const char *color;       /* the name of one of picture_colors */
  struct option_list view; /* turn around the vertical, angle to it (degrees) */
  size_t facets;           /* of all balls together, about */
  bool half_size;          /* 640 x 480 pixels */
  char *scratch;           /* directory */
  struct scratch_file *files;
  struct progress progress; /* of what is drawn */
  double done;              /* of it, as in progress_tell */
  struct output_file file;  /* what is made, or standard output */
  double box[6];    /* x0 x1 y0 y1 z0 z1 (m), grown by picture_measure */
  bool fixed[6];    /* a wall of the scene */
  double low, high; /* of what the colours show */
  size_t measured;
  char *origin; /* what it says of itself */
};

/* A quantity that colours can show. */
struct picture_color {
  const char *name, *label, *help;
  bool from_zero; /* the scale begins at 0 */
  bool whole;     /* whole numbers */
};

/* All of them; the last has no name. */
extern const struct picture_color picture_colors[];

/* clang-format off */
#define PICTURE_OPTIONS(p)                                                     \
  {.name = "color", .type = OPTION_TEXT, .value = &(p).color,                  \
   OPTION_TABLE(picture_colors), .help = "quantity that the colours show"},    \
  {.name = "view", .type = OPTION_LIST, .value = &(p).view, .least = 2,        \
   .most = 2, .unit = "degrees",                                               \
   .help = "turn around the vertical, angle to it"}
/* clang-format on */

/* Checks the options, makes the scratch directory and opens what is to be made:
   output, whole or not at all, or standard output for NULL. quiet: no
   progress. */
void picture_begin(struct picture *p, const char *output, bool quiet);

/* A path in the scratch directory, until picture_deliver. */
const char *picture_path(struct picture *p, const char *name);

/* Takes a frame into the ranges of box and colours, and writes it, as far as
   it can be seen, to a file of the scratch directory. Frames of one number are
   written over. */
void picture_measure(struct picture *p, const struct bed *b,
                     const struct bed_header *h);
void picture_write(struct picture *p, const struct bed *b, const char *name);

/* Has the picture say that it is of this bed, before frames_close. */
void picture_of(struct picture *p, const struct frames *f);

/* Draws what picture_write wrote; output ends in .png or .svg. */
void picture_draw(struct picture *p, const char *name, const char *output);

/* Runs a program of the search path and waits; a failure is an error with the
   first line of what it said. package is what Debian calls it. */
void picture_run(struct picture *p, const char *package,
                 const char *const argv[]);

/* The path of one of our gnuplot scripts: in $DEM_PLOTS, in ../share/dem/plots
   of the program's directory, or in plots of it, where it was built. */
char *picture_script(const char *name);

/* Whether a name has this ending. */
bool ends_in(const char *name, const char *ending);

/* Copies a finished file to where it is wanted, and ends the picture. */
void picture_deliver(struct picture *p, const char *path);

#endif
