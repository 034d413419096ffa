/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "files/radius_keys.h"
#include "program/scene_options.h"

void box_check(const struct option_list *box) {
  if (box->count && !box_valid(box->at))
    die(EXIT_USAGE, "--box: expected x0 < x1, y0 < y1, z0 < z1");
}

void frame_refuse(const struct frames *f, const struct bed *b,
                  const char *why) {
  fflush(stdout); /* rows of the frames before it */
  die(EXIT_INPUT, "%s: t=%g: %s", f->name, b->t, why);
}

/* A clipped ball is a sum of parts of its own size, and rounding of those is
   all that is left where the box is this much smaller than the largest ball's
   cube: six digits and fewer. */
static const double smallest_box = 1e-9;

bool frame_box_resolved(const struct bed *b, const double box[6]) {
  double largest = 0;
  for (size_t i = 0; i < b->n; i++)
    largest = GSL_MAX(largest, b->r[i]);
  return box_volume(box) >= smallest_box * gsl_pow_3(largest);
}

void frame_check_box(const struct frames *f, const struct bed *b,
                     const double box[6]) {
  if (!frame_box_resolved(b, box))
    frame_refuse(f, b, "a box too small beside a sphere for its volume");
}

struct scene frame_scene(const struct frames *f, const struct bed *b) {
  struct scene s;
  if (f->first && !frames_are_beds(f))
    warn("%s: has no walls and no parameters; without walls, and with the "
         "parameters that settle has by default",
         f->name);
  const char *wrong = scene_from_header(&s, frames_header(f));
  if (wrong)
    frame_refuse(f, b, wrong);
  return s;
}

void header_walls(const struct bed_header *h, double box[6], bool walled[6]) {
  memset(walled, 0, 6 * sizeof *walled);
  for (size_t i = 0; i < h->count; i++) {
    struct option_list wall;
    struct option_spec spec = {
        .type = OPTION_LIST, .value = &wall, .least = 6, .most = 6};
    if (strcmp(h->at[i].name, "wall") || option_set(&spec, h->at[i].value))
      continue;
    const double *normal = wall.at + 3;
    for (int k = 0; k < 3; k++)
      if (normal[k] != 0 && normal[(k + 1) % 3] == 0 &&
          normal[(k + 2) % 3] == 0) {
        const int face = 2 * k + (normal[k] > 0);
        box[face] = wall.at[k];
        walled[face] = true;
      }
  }
}

void frame_base_box(const struct bed_header *h, double box[6]) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  double walls[6] = {0};
  bool walled[6];
  header_walls(h, walls, walled);
  walls[5] = walls[4] + GSL_MIN(walls[1] - walls[0], walls[3] - walls[2]);
  const bool base =
      walled[0] && walled[1] && walled[2] && walled[3] && walled[4];
  memcpy(box, base && box_valid(walls) ? walls : unit, sizeof unit);
}

void frame_warn_rewritten(const struct frames *f) {
  const double r = radius_dynamics(frames_header(f));
  if (r > 0)
    warn("%s: the radius was rewritten: contacts and forces are those of the "
         "new one, not of radius_dynamics=%g, at which the bed settled",
         f->name, r);
}

void frame_check(const struct frames *f, const struct bed *b, int status) {
  if (status == GSL_SUCCESS)
    return;
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "t=%g: out of memory", b->t);
  frame_refuse(f, b,
               status == GSL_EDOM
                   ? "two spheres have the same centre, expected one each"
                   : "a number is not finite");
}

void frame_box(const struct bed *b, double margin, double box[6]) {
  for (int k = 0; k < 3; k++) {
    double low = GSL_POSINF, high = GSL_NEGINF;
    for (size_t i = 0; i < b->n; i++) {
      low = GSL_MIN(low, b->x[3 * i + k]);
      high = GSL_MAX(high, b->x[3 * i + k]);
    }
    box[2 * k] = low + margin;
    box[2 * k + 1] = high - margin;
  }
}

void *measure_alloc(size_t count, size_t size) {
  void *p = calloc(count + 1, size);
  if (!p)
    die(EXIT_IO, "out of memory");
  return p;
}
