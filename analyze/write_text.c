/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own format, bare positions, and a table with a row of names and a column
 * of times. */
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "files/radius_keys.h"
#include "measure.h"
#include "writers.h"

void write_positions(FILE *out, const struct write_frame *f,
                     const struct write_options *o) {
  (void)o;
  const double *x = f->bed->x;
  for (size_t i = 0; i < f->bed->n; i++, x += 3) {
    numbers_write(out, '\t', 3, x);
    fputc('\n', out);
  }
}

void write_csv(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  if (f->first)
    fprintf(out, "t,id,x,y,z,r,m,vx,vy,vz,wx,wy,wz\n");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, *v = b->v + 3 * i, *w = b->w + 3 * i;
    const double row[] = {x[0], x[1], x[2], b->r[i], b->m[i], v[0],
                          v[1], v[2], w[0], w[1],    w[2]};
    numbers_write(out, ',', 1, &b->t);
    fprintf(out, ",%ld,", b->id[i]);
    numbers_write(out, ',', 11, row);
    fputc('\n', out);
  }
}

/* The radius that the bed settled with stays, as analyze radius has it. */
static void note_gap(struct shape *s, struct bed_header *h) {
  const struct bed *b = s->source;
  char text[NUMBER_SIZE];
  for (size_t i = 1; i < b->n; i++)
    if (b->r[i] != b->r[0])
      frame_refuse(s->frames, b,
                   "--gap: spheres of several radii; a bed says of one what it "
                   "was");
  int status = GSL_SUCCESS;
  if (b->n && !bed_header_get(h, "radius_dynamics")) {
    number_format(b->r[0], text);
    status = bed_header_set(h, "radius_dynamics", text);
  }
  if (status == GSL_SUCCESS && b->n)
    status = radius_rewrite(&s->bed, h, s->bed.r[0], "gap");
  if (status == GSL_SUCCESS)
    status = bed_header_set(h, "gap", s->statement);
  frame_check(s->frames, b, status);
}

void write_bed(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  struct shape *s = f->shape;
  struct bed_header header = frames_copy_header(s->frames);
  const char *note = shape_note(s);
  if (note)
    note_gap(s, &header);
  if (!frames_are_beds(s->frames))
    warn("%s: has no walls: the bed has none", s->frames->name);
  bed_write_frame(out, &header, f->bed, true);
  bed_write_status(out, frames_status(s->frames));
  bed_header_free(&header);
}
