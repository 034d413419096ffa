/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Extended XYZ, as OVITO and ASE read it. */
#include "files/numbers.h"
#include "writers.h"

void write_xyz(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  const double *box = f->shape->lattice;
  const char *note = shape_note(f->shape);
  fprintf(out, "%zu\nLattice=\"", b->n);
  const double sides[3] = {box[1] - box[0], box[3] - box[2], box[5] - box[4]};
  const double lattice[9] = {sides[0], 0, 0, 0, sides[1], 0, 0, 0, sides[2]};
  const double origin[3] = {box[0], box[2], box[4]};
  numbers_write(out, ' ', 9, lattice);
  fputs("\" Origin=\"", out);
  numbers_write(out, ' ', 3, origin);
  fputs("\" pbc=\"", out);
  for (int k = 0; k < 3; k++)
    fprintf(out, k ? " %c" : "%c", f->shape->wraps[k] ? 'T' : 'F');
  fputs("\" "
        "Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:id:I:1:mass:R:1:"
        "angular_velocity:R:3 Time=",
        out);
  numbers_write(out, ' ', 1, &b->t);
  if (note)
    origin_put(out, &origin_attribute, "Note", note);
  write_origin(out, &origin_attribute, f);
  fputc('\n', out);
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    const double place[7] = {x[0], x[1], x[2], b->r[i], v[0], v[1], v[2]};
    const double rest[4] = {b->m[i], w[0], w[1], w[2]};
    fputs("X ", out);
    numbers_write(out, ' ', 7, place);
    fprintf(out, " %ld ", b->id[i]);
    numbers_write(out, ' ', 4, rest);
    fputc('\n', out);
  }
}
