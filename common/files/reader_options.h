/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a bed of any format is to be read; for formats.h, which says of what. */
#ifndef READER_OPTIONS_H
#define READER_OPTIONS_H

#include <stdbool.h>

struct bed_format;
struct columns;

struct bed_reader_options {
  bool allow_partial; /* take what is complete of a file without a good end */
  bool may_be_empty;  /* a stated count of no spheres is a frame */
  double radius;      /* of spheres that come without one (m); 0: none */
  double largest;     /* magnitude of any number but an id; 0: no limit */
  const struct columns *columns;   /* those of a row; NULL: by their names */
  const struct bed_format *format; /* NULL: the first lines say which */
};

#endif
