/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shape.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "geometry/box.h"
#include "measure.h"

/* The box that holds the spheres and ends at walls along the axes, where a
   centre is not beyond them. */
static void lattice(const struct bed_header *header, const struct bed *b,
                    double box[6]) {
  for (int k = 0; k < 3; k++) {
    box[2 * k] = b->n ? GSL_POSINF : 0;
    box[2 * k + 1] = b->n ? GSL_NEGINF : 1;
    for (size_t i = 0; i < b->n; i++) {
      box[2 * k] = fmin(box[2 * k], b->x[3 * i + k] - b->r[i]);
      box[2 * k + 1] = fmax(box[2 * k + 1], b->x[3 * i + k] + b->r[i]);
    }
  }
  bool walled[6];
  header_walls(header, box, walled);
  /* programs refuse a box without volume and lose atoms that are outside */
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < b->n; i++) {
      box[2 * k] = fmin(box[2 * k], b->x[3 * i + k]);
      box[2 * k + 1] = fmax(box[2 * k + 1], b->x[3 * i + k]);
    }
    if (!(box[2 * k + 1] > box[2 * k]))
      box[2 * k + 1] = box[2 * k] + 1;
  }
}

static void move_box(const struct shape *s, double box[6]) {
  for (int k = 0; k < 6; k++)
    box[k] = s->scale * box[k] + s->offset[k / 2];
}

/* Lengths and speeds into the client's units; 1 and 0 change no bit. */
static void move(struct shape *s) {
  struct bed *b = &s->bed;
  for (size_t i = 0; i < b->n; i++) {
    for (size_t k = 0; k < 3; k++) {
      b->x[3 * i + k] = s->scale * b->x[3 * i + k] + s->offset[k];
      b->v[3 * i + k] *= s->scale;
    }
    b->r[i] *= s->scale;
  }
  move_box(s, s->box);
  move_box(s, s->lattice);
}

void shape_make(struct shape *s, const struct shape_options *o,
                const struct frames *f, const struct bed *b) {
  *s = (struct shape){.source = b,
                      .header = frames_header(f),
                      .frames = f,
                      .scale = o->scale,
                      .fraction = GSL_NAN};
  memcpy(s->offset, o->offset, sizeof s->offset);
  frame_check(f, b, bed_copy(&s->bed, b));
  if (o->box_given)
    memcpy(s->box, o->box, sizeof s->box);
  else
    frame_base_box(s->header, s->box);
  lattice(s->header, &s->bed, s->lattice);
  if (o->box_given)
    memcpy(s->lattice, s->box, sizeof s->lattice);
  memcpy(s->source_box, s->box, sizeof s->box);
  if (o->base > 0)
    s->scale = o->base / (s->box[1] - s->box[0]);
  move(s);
  s->solid = (struct solid){.n = s->bed.n, .x = s->bed.x, .r = s->bed.r};
}

static void __attribute__((format(printf, 2, 3)))
add(struct shape *s, const char *format, ...) {
  const size_t used = strlen(s->statement);
  va_list args;
  va_start(args, format);
  vsnprintf(s->statement + used, sizeof s->statement - used, format, args);
  va_end(args);
}

void shape_add(struct shape *s, const char *format, ...) {
  const size_t used = strlen(s->more);
  va_list args;
  va_start(args, format);
  vsnprintf(s->more + used, sizeof s->more - used, format, args);
  va_end(args);
}

void shape_measure(struct shape *s) {
  struct solid_volume v;
  if (s->statement[0])
    return;
  s->statement[0] = 0;
  add(s, "t=%g: %zu spheres, ", s->bed.t, s->bed.n);
  if (!frame_box_resolved(&s->bed, s->box)) {
    add(s, "in a box too small beside them for its volume");
    return;
  }
  frame_check(s->frames, &s->bed, solid_volume(&s->solid, s->box, &v));
  s->fraction = v.total / box_volume(s->box);
  add(s, "solid fraction %.12g of the box ", s->fraction);
  for (int k = 0; k < 6; k++) {
    char text[NUMBER_SIZE];
    number_format(s->box[k], text);
    add(s, k ? ",%s" : "%s", text);
  }
  add(s, " (exact union)");
}

void shape_say(struct shape *s) {
  shape_measure(s);
  warn("%s", s->statement);
  if (s->more[0])
    warn("%s", s->more);
}

void shape_free(struct shape *s) {
  bed_free(&s->bed);
}
