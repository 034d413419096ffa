/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lattices of unit spacing for the tests: cubes of cells in bulk. */
#ifndef LATTICE_H
#define LATTICE_H

#include <math.h>
#include <stddef.h>
#include <string.h>
#include "model/bed.h"

struct lattice {
  const char *name;
  double edge[3]; /* of the cell, in distances of nearest neighbours */
  size_t atoms;
  double atom[4][3]; /* in edges */
};

/* sc, bcc, fcc and hcp (in its rectangular cell of four). */
static inline struct lattice lattice_named(const char *name) {
  const double bcc = 2 / sqrt(3), fcc = sqrt(2);
  if (!strcmp(name, "sc"))
    return (struct lattice){"sc", {1, 1, 1}, 1, {{0}}};
  if (!strcmp(name, "bcc"))
    return (struct lattice){"bcc", {bcc, bcc, bcc}, 2, {{0}, {0.5, 0.5, 0.5}}};
  if (!strcmp(name, "fcc"))
    return (struct lattice){"fcc",
                            {fcc, fcc, fcc},
                            4,
                            {{0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
  return (struct lattice){
      "hcp",
      {1, sqrt(3), sqrt(8. / 3)},
      4,
      {{0}, {0.5, 0.5, 0}, {0, 1. / 3, 0.5}, {0.5, 5. / 6, 0.5}}};
}

/* cells^3 cells about the origin, radius 1/2; b is allocated. centre: the
   sphere nearest the middle of it all, deep inside. */
static inline int lattice_bed(const struct lattice *l, size_t cells,
                              struct bed *b, size_t *centre) {
  *centre = 0;
  const int status = bed_alloc(b, cells * cells * cells * l->atoms);
  if (status)
    return status;
  size_t n = 0;
  double nearest = INFINITY;
  for (size_t c = 0; c < cells * cells * cells; c++)
    for (size_t a = 0; a < l->atoms; a++, n++) {
      const size_t at[3] = {c / cells / cells, c / cells % cells, c % cells};
      double d2 = 0;
      for (size_t k = 0; k < 3; k++) {
        const double middle = 0.5 * (double)(cells - 1);
        double *x = &b->x[3 * n + k];
        *x = l->edge[k] * ((double)at[k] + l->atom[a][k] - middle);
        d2 += *x * *x;
      }
      b->r[n] = 0.5;
      if (d2 < nearest - 1e-9) {
        nearest = d2;
        *centre = n;
      }
    }
  return 0;
}

#endif
