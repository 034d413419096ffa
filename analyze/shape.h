/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A frame as export hands it over: its spheres, shrunk and bridged as the
   client's mesher wants them, its container, all in the client's units and
   place, and the exact solid fraction of that. Tested in tests/test_export.sh
   and tests/test_handover.sh. */
#ifndef SHAPE_H
#define SHAPE_H

#include "frames.h"
#include "geometry/solid.h"

/* Lengths are the bed's (m). */
struct shape_options {
  double scale, offset[3]; /* x becomes scale x + offset */
  double base; /* above 0: scale is such that the box is so wide along x */
  bool images; /* what is written has the copies across periodic sides */
  bool box_given;
  double box[6]; /* of fractions, voxels and surfaces; else the bed's base */
  bool gap_given;
  double gap;       /* between any two spheres, at least */
  double bridge;    /* radius of bridges; 0: none */
  double reach;     /* gap of spheres that are to be bridged, at most */
  bool walls;       /* the container is solid, */
  double thickness; /* so thick beyond the box; 0: the least radius */
};

struct shape {
  struct bed bed;    /* its own copy of what is written */
  struct bed images; /* the frame with the copies across periodic sides */
  struct bed filled; /* of a periodic bed: a copy of that, for the solid */
  const struct bed_header *header;
  const struct frames *frames; /* for messages */
  struct solid solid;
  const struct bed *source; /* the frame that is written, as it came */
  bool copies;              /* are those across periodic sides in it? */
  bool around[3];           /* axes along which the box is whole periods long */
  bool wraps[3];        /* axes along which the lattice is the periodic cell */
  double source_box[6]; /* the box as it came */
  double scale, offset[3];
  bool box_given;
  double box[6];     /* the one of the options, as it is handed over */
  double lattice[6]; /* by walls and spheres, for formats with a cell */
  struct container container; /* with --walls, of the solid */
  double (*planes)[4];        /* of it */
  uint32_t (*ends)[2];        /* of the bridges */
  double bare;   /* the spheres' fraction before --gap; NaN without it */
  double factor; /* of radii by it */
  /* what shape_measure finds */
  double fraction;     /* solid, of the box; NaN if that has no digits */
  char statement[560]; /* what is solid, for standard error and headers */
  bool changed;        /* by --gap or --bridge */
  char more[400];      /* what a format says of it besides; or empty */
};

/* Exits with one line where the frame cannot be handed over. */
void shape_make(struct shape *s, const struct shape_options *o,
                const struct frames *f, const struct bed *b);

/* Both are to be had from then on. */
void shape_measure(struct shape *s);

/* Adds a remark of the format. */
void shape_add(struct shape *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* All of that, on a line of standard error. */
void shape_say(struct shape *s);

/* The effect of --gap and --bridge, for headers; NULL if they were not given.
 */
const char *shape_note(struct shape *s);

/* The box that holds the solid, without walls; infinite without spheres. */
void shape_bounds(const struct shape *s, double box[6]);

/* The box within walls along the axes: what a mesher has to fill, or more than
   that. */
void shape_domain(const struct shape *s, double box[6]);

/* A piece of the tube's axis that reaches beyond the box on both sides, and a
   segment from a slanting wall outwards, so long and from such a foot that a
   cylinder about it as wide as it is long holds all of the box beyond. */
void shape_tube(const struct shape *s, double from[3], double to[3]);
void shape_plane(const struct shape *s, size_t k, double foot[3],
                 double outwards[3]);

/* Says of a format for meshers which spheres a wall of the container or a face
   of the domain cuts, at which angle, and how near the others come to it. */
void shape_say_ends(struct shape *s);

double shape_least_radius(const struct shape *s); /* infinite without any */

void shape_free(struct shape *s);

#endif
