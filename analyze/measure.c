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
  const char *wrong = scene_from_header(&s, frames_header(f), b);
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

bool frame_base_box(const struct bed_header *h, double box[6]) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  double walls[6] = {0};
  bool walled[6];
  header_walls(h, walls, walled);
  walls[5] = walls[4] + GSL_MIN(walls[1] - walls[0], walls[3] - walls[2]);
  const bool base =
      walled[0] && walled[1] && walled[2] && walled[3] && walled[4];
  const bool valid = base && box_valid(walls);
  memcpy(box, valid ? walls : unit, sizeof unit);
  return valid;
}

void frame_choose_box(const struct frames *f, const struct option_list *given,
                      double box[6]) {
  if (given->count)
    memcpy(box, given->at, 6 * sizeof *box);
  else
    frame_base_box(frames_header(f), box);
}

/* The box that the spheres take up. */
static void spheres_span(const struct bed *b, double span[6]) {
  for (int k = 0; k < 3; k++) {
    span[2 * k] = GSL_POSINF;
    span[2 * k + 1] = GSL_NEGINF;
    for (size_t i = 0; i < b->n; i++) {
      const double x = b->x[3 * i + (size_t)k], r = b->r[i];
      span[2 * k] = fmin(span[2 * k], x - r);
      span[2 * k + 1] = fmax(span[2 * k + 1], x + r);
    }
  }
}

static const double much_wider = 0.1;

static const char *box_text(const double box[6], char *text, size_t size) {
  snprintf(text, size, "%.10g,%.10g,%.10g,%.10g,%.10g,%.10g", box[0], box[1],
           box[2], box[3], box[4], box[5]);
  return text;
}

void box_watch_end(const struct box_watch *w) {
  char box[160], span[160];
  if (!w->looks)
    return;
  box_text(w->box, box, sizeof box);
  box_text(w->span, span, sizeof span);
  if (!w->found) {
    warn("%s: no sphere is in the box %s%s; the spheres span %s m", w->name,
         box, w->default_ ? " (the default without walls)" : "", span);
    return;
  }
  /* a bed of grains in the corner of a cube of a metre */
  if (w->default_ && w->span[1] - w->span[0] < much_wider &&
      w->span[3] - w->span[2] < much_wider)
    warn("%s: has no walls, so that the box is the unit cube; the spheres span "
         "%s m: expected --box",
         w->name, span);
}

void box_watch_see(struct box_watch *w, const struct frames *f,
                   const struct bed *b, bool from_base, size_t count,
                   const double (*boxes)[6]) {
  if (f->first) {
    box_watch_end(w);
    *w = (struct box_watch){0};
  }
  w->name = f->name;
  if (b->n == 0)
    return;
  double unit[6];
  w->looks++;
  w->default_ = from_base && !frame_base_box(frames_header(f), unit);
  memcpy(w->box, boxes[0], sizeof w->box);
  spheres_span(b, w->span);
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < b->n && !w->found; i++)
      w->found = w->default_
                     ? box_holds(boxes[k], b->x + 3 * i)
                     : !box_misses_ball(boxes[k], b->x + 3 * i, b->r[i]);
}

void frame_warn_rewritten(const struct frames *f) {
  const double r = radius_dynamics(frames_header(f));
  if (r > 0)
    warn("%s: the radius was rewritten: contacts and forces are those of the "
         "new one, not of radius_dynamics=%g, at which the bed settled",
         f->name, r);
}

void frame_check(const struct frames *f, const struct bed *b, int status) {
  switch (status) {
  case GSL_SUCCESS:
    return;
  case GSL_EDOM:
    frame_refuse(f, b, "two spheres have the same centre, expected one each");
  case GSL_EINVAL:
    frame_refuse(f, b, "a number is not finite");
  default:
    die(EXIT_IO, "%s: t=%g: %s", f->name, b->t,
        status == GSL_ENOMEM ? "out of memory" : gsl_strerror(status));
  }
}

void frame_box(const struct bed *b, double margin, double box[6]) {
  for (size_t k = 0; k < 3; k++) {
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
