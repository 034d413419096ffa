/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What export hands over of a frame: its spheres in the units and the place
   that the client wants, the box that is looked at, and the exact solid
   fraction of that. Tested in tests/test_export.sh. */
#ifndef SHAPE_H
#define SHAPE_H

#include "frames.h"
#include "geometry/solid.h"

struct shape_options {
  double scale, offset[3]; /* x becomes scale x + offset */
  bool box_given;
  double box[6]; /* of the fraction, of voxels and surfaces (m, of the bed) */
};

struct shape {
  struct bed bed; /* scaled and moved; its own memory */
  struct solid solid;
  double box[6];      /* scaled and moved */
  double lattice[6];  /* by walls and spheres, for formats with a cell */
  double fraction;    /* solid, of the box */
  char statement[512]; /* what it is, for standard error and headers */
};

/* Exits with one line where the frame cannot be handed over. */
void shape_make(struct shape *s, const struct shape_options *o,
                const struct frames *f, const struct bed *b);

/* Computes the fraction and says in s->statement what it is. */
void shape_measure(struct shape *s);

void shape_free(struct shape *s);

#endif
