/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LAMMPS: a text dump, which read_dump and rerun take, and a data file of atom
   style sphere, which read_data takes. */
#include "files/lammps_data.h"
#include "files/numbers.h"
#include "writers.h"

void write_lammps(FILE *out, const struct write_frame *f,
                  const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  fputs("ITEM: TIME\n", out);
  numbers_write(out, ' ', 1, &b->t);
  fprintf(out,
          "\nITEM: TIMESTEP\n%zu\nITEM: NUMBER OF ATOMS\n%zu\n"
          "ITEM: BOX BOUNDS",
          f->number, b->n);
  for (int k = 0; k < 3; k++)
    fputs(f->shape->wraps[k] ? " pp" : " ff", out);
  fputc('\n', out);
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

void write_lammps_data(FILE *out, const struct write_frame *f,
                       const struct write_options *o) {
  (void)o;
  const char *note = shape_note(f->shape);
  char by[80];
  origin_name(by, sizeof by);
  lammps_data_title(out, by, note ? note : "", f->bed->t);
  write_origin(out, &origin_short, f);
  lammps_data_write(out, f->bed, f->id_offset, f->shape->lattice);
}
