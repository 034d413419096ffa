/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LAMMPS: a text dump, which read_dump and rerun take, and a data file of atom
   style sphere, which read_data takes. */
#include <gsl/gsl_math.h>
#include "program/version.h"
#include "writers.h"

void write_lammps(FILE *out, const struct write_frame *f,
                  const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  fprintf(out,
          "ITEM: TIME\n%.17g\nITEM: TIMESTEP\n%zu\nITEM: NUMBER OF ATOMS\n%zu\n"
          "ITEM: BOX BOUNDS ff ff ff\n",
          b->t, f->number, b->n);
  for (int k = 0; k < 3; k++)
    fprintf(out, "%.17g %.17g\n", f->shape->lattice[2 * k],
            f->shape->lattice[2 * k + 1]);
  fprintf(out, "ITEM: ATOMS id type x y z vx vy vz radius mass omegax omegay "
               "omegaz\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    fprintf(out,
            "%ld 1 %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g "
            "%.17g\n",
            b->id[i] + f->id_offset, x[0], x[1], x[2], v[0], v[1], v[2],
            b->r[i], b->m[i], w[0], w[1], w[2]);
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
  fprintf(out,
          "LAMMPS data file by analyze export " DEM_VERSION
          ", t = %.17g s%s%s\n\n"
          "%zu atoms\n1 atom types\n\n",
          b->t, note ? "; " : "", note ? note : "", b->n);
  for (int k = 0; k < 3; k++)
    fprintf(out, "%.17g %.17g %clo %chi\n", f->shape->lattice[2 * k],
            f->shape->lattice[2 * k + 1], axes[k], axes[k]);
  fprintf(out, "\nAtoms # sphere\n\n");
  for (size_t i = 0; i < b->n; i++)
    fprintf(out, "%ld 1 %.17g %.17g %.17g %.17g %.17g\n",
            b->id[i] + f->id_offset, 2 * b->r[i], density(b->m[i], b->r[i]),
            b->x[3 * i], b->x[3 * i + 1], b->x[3 * i + 2]);
  fprintf(out, "\nVelocities\n\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *v = b->v + 3 * i, *w = b->w + 3 * i;
    fprintf(out, "%ld %.17g %.17g %.17g %.17g %.17g %.17g\n",
            b->id[i] + f->id_offset, v[0], v[1], v[2], w[0], w[1], w[2]);
  }
}
