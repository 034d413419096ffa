/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own format, bare positions, and a table with a row of names and a column
 * of times. */
#include "writers.h"

void write_positions(FILE *out, const struct write_frame *f,
                     const struct write_options *o) {
  (void)o;
  const double *x = f->bed->x;
  for (size_t i = 0; i < f->bed->n; i++, x += 3)
    fprintf(out, "%.17g\t%.17g\t%.17g\n", x[0], x[1], x[2]);
}

void write_csv(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  if (f->first)
    fprintf(out, "t,id,x,y,z,r,m,vx,vy,vz,wx,wy,wz\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    fprintf(
        out,
        "%.17g,%ld,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,"
        "%.17g\n",
        b->t, b->id[i], x[0], x[1], x[2], b->r[i], b->m[i], v[0], v[1], v[2],
        w[0], w[1], w[2]);
  }
}

void write_bed(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  struct bed_header header = frames_copy_header(f->shape->frames);
  bed_write_frame(out, &header, f->bed, true);
  bed_write_status(out, frames_status(f->shape->frames));
  bed_header_free(&header);
}
