/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files/lammps_data.h"

#include <gsl/gsl_math.h>
#include "files/numbers.h"

/* Atom style sphere wants diameter and density instead of radius and mass; a
   sphere without size is given its mass as the density. */
static double density(double m, double r) {
  return r > 0 ? m / (4 * M_PI / 3 * r * r * r) : m;
}

void lammps_data_title(FILE *out, const char *by, const char *note, double t) {
  fprintf(out, "LAMMPS data file by %s, t = ", by);
  numbers_write(out, ' ', 1, &t);
  fprintf(out, " s%s%s\n", *note ? "; " : "", note);
}

void lammps_data_write(FILE *out, const struct bed *b, long id_offset,
                       const double box[6]) {
  static const char axes[] = "xyz";
  fprintf(out, "\n%zu atoms\n%d atom types\n\n", b->n, b->fixed ? 2 : 1);
  for (int k = 0; k < 3; k++) {
    numbers_write(out, ' ', 2, box + 2 * k);
    fprintf(out, " %clo %chi\n", axes[k], axes[k]);
  }
  fprintf(out, "\nAtoms # sphere\n\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    const double row[] = {2 * b->r[i], density(b->m[i], b->r[i]), x[0], x[1],
                          x[2]};
    fprintf(out, "%ld %d ", b->id[i] + id_offset, bed_is_fixed(b, i) ? 2 : 1);
    numbers_write(out, ' ', 5, row);
    fputc('\n', out);
  }
  fprintf(out, "\nVelocities\n\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *v = b->v + 3 * i, *w = b->w + 3 * i;
    const double row[] = {v[0], v[1], v[2], w[0], w[1], w[2]};
    fprintf(out, "%ld ", b->id[i] + id_offset);
    numbers_write(out, ' ', 6, row);
    fputc('\n', out);
  }
}
