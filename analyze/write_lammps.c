/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LAMMPS: a text dump, which read_dump and rerun take, and a data file of atom
   style sphere, which read_data takes. */
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "program/version.h"
#include "writers.h"

void write_lammps(FILE *out, const struct write_frame *f,
                  const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  fputs("ITEM: TIME\n", out);
  numbers_write(out, ' ', 1, &b->t);
  fprintf(out,
          "\nITEM: TIMESTEP\n%zu\nITEM: NUMBER OF ATOMS\n%zu\n"
          "ITEM: BOX BOUNDS ff ff ff\n",
          f->number, b->n);
  for (int k = 0; k < 3; k++) {
    numbers_write(out, ' ', 2, f->shape->lattice + 2 * k);
    fputc('\n', out);
  }
  fprintf(out, "ITEM: ATOMS id type x y z vx vy vz radius mass omegax omegay "
               "omegaz\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    const double row[] = {x[0],    x[1],    x[2], v[0], v[1], v[2],
                          b->r[i], b->m[i], w[0], w[1], w[2]};
    fprintf(out, "%ld 1 ", b->id[i] + f->id_offset);
    numbers_write(out, ' ', 11, row);
    fputc('\n', out);
  }
}

/* Atom style sphere wants diameter and density instead of radius and mass; a
   sphere without size is given its mass as the density. */
static double density(double m, double r) {
  return r > 0 ? m / (4 * M_PI / 3 * r * r * r) : m;
}

void write_lammps_data(FILE *out, const struct write_frame *f,
                       const struct write_options *o) {
  (void)o;
  static const char axes[] = "xyz";
  const char *note = shape_note(f->shape);
  const struct bed *b = f->bed;
  fputs("LAMMPS data file by analyze export " DEM_VERSION ", t = ", out);
  numbers_write(out, ' ', 1, &b->t);
  fprintf(out, " s%s%s\n\n%zu atoms\n1 atom types\n\n", note ? "; " : "",
          note ? note : "", b->n);
  for (int k = 0; k < 3; k++) {
    numbers_write(out, ' ', 2, f->shape->lattice + 2 * k);
    fprintf(out, " %clo %chi\n", axes[k], axes[k]);
  }
  fprintf(out, "\nAtoms # sphere\n\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    const double row[] = {2 * b->r[i], density(b->m[i], b->r[i]), x[0], x[1],
                          x[2]};
    fprintf(out, "%ld 1 ", b->id[i] + f->id_offset);
    numbers_write(out, ' ', 5, row);
    fputc('\n', out);
  }
  fprintf(out, "\nVelocities\n\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *v = b->v + 3 * i, *w = b->w + 3 * i;
    const double row[] = {v[0], v[1], v[2], w[0], w[1], w[2]};
    fprintf(out, "%ld ", b->id[i] + f->id_offset);
    numbers_write(out, ' ', 6, row);
    fputc('\n', out);
  }
}
