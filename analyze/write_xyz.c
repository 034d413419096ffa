/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Extended XYZ, as OVITO and ASE read it. */
#include "writers.h"

void write_xyz(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  const double *box = f->shape->lattice;
  const char *note = shape_note(f->shape);
  fprintf(out,
          "%zu\nLattice=\"%.17g 0 0 0 %.17g 0 0 0 %.17g\" "
          "Origin=\"%.17g %.17g %.17g\" pbc=\"F F F\" "
          "Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:id:I:1:mass:R:1:"
          "angular_velocity:R:3 Time=%.17g%s%s%s\n",
          b->n, box[1] - box[0], box[3] - box[2], box[5] - box[4], box[0],
          box[2], box[4], b->t, note ? " Note=\"" : "", note ? note : "",
          note ? "\"" : "");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    fprintf(out,
            "X %.17g %.17g %.17g %.17g %.17g %.17g %.17g %ld %.17g %.17g %.17g "
            "%.17g\n",
            x[0], x[1], x[2], b->r[i], v[0], v[1], v[2], b->id[i], b->m[i],
            w[0], w[1], w[2]);
  }
}
