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

/* The numbers of a key, count of them; false if that is not what it has. */
static bool header_numbers(const char *value, double count,
                           struct option_list *numbers) {
  struct option_spec spec = {
      .type = OPTION_LIST, .value = numbers, .least = count, .most = count};
  return value && !option_set(&spec, value);
}

/* Where periodic sides are instead of walls, or an upright tube, its inscribed
   square. */
static void header_sides(const struct bed_header *h, double box[6],
                         bool sided[6]) {
  struct option_list v;
  const char *periodic = bed_header_get(h, "periodic");
  for (int k = 0; k < 2; k++)
    if (periodic && strchr(periodic, "xy"[k]) &&
        header_numbers(bed_header_get(h, "base"), 2, &v)) {
      box[2 * k] = 0;
      box[2 * k + 1] = v.at[k];
      sided[2 * k] = sided[2 * k + 1] = true;
    }
  for (size_t i = 0; i < h->count; i++)
    if (!strcmp(h->at[i].name, "cylinder") &&
        header_numbers(h->at[i].value, 7, &v) && v.at[3] == 0 && v.at[4] == 0)
      for (int face = 0; face < 4; face++)
        if (!sided[face]) {
          const double half = (face % 2 ? 1 : -1) * v.at[6] * M_SQRT1_2;
          box[face] = v.at[face / 2] + half;
          sided[face] = true;
        }
}

bool frame_base_box(const struct bed_header *h, double box[6]) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  double walls[6] = {0};
  bool walled[6];
  header_walls(h, walls, walled);
  header_sides(h, walls, walled);
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

/* Images that a frame may have. */
static const double most_images = 1e7;

/* How often the ball may be moved by whole periods along an axis so that it
   still reaches into the box: from least to most. */
static void image_range(double x, double r, double period, double low,
                        double high, double *least, double *most) {
  *least = *most = 0;
  if (!(period > 0))
    return;
  *least = floor((low - r - x) / period) + 1;
  *most = ceil((high + r - x) / period) - 1;
}

static void put_sphere(struct bed *to, size_t at, const struct bed *from,
                       size_t i, const double move[2]) {
  to->id[at] = from->id[i];
  memcpy(to->x + 3 * at, from->x + 3 * i, 3 * sizeof *to->x);
  memcpy(to->v + 3 * at, from->v + 3 * i, 3 * sizeof *to->v);
  memcpy(to->w + 3 * at, from->w + 3 * i, 3 * sizeof *to->w);
  to->x[3 * at] += move[0];
  to->x[3 * at + 1] += move[1];
  to->r[at] = from->r[i];
  to->m[at] = from->m[i];
}

/* Puts the spheres and images of them that reach into the box to `to`, unless
   that is NULL; how many. */
static size_t put_images(const struct bed *b, const double period[3],
                         const double box[6], struct bed *to) {
  size_t count = 0;
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    double from[2], until[2];
    for (int k = 0; k < 2; k++)
      image_range(x[k], b->r[i], period[k], box[2 * k], box[2 * k + 1],
                  &from[k], &until[k]);
    const double images = (until[0] - from[0] + 1) * (until[1] - from[1] + 1);
    if (!to) {
      count += images > most_images ? (size_t)most_images : (size_t)images;
      continue;
    }
    for (double a = from[0]; a <= until[0]; a++)
      for (double c = from[1]; c <= until[1]; c++)
        put_sphere(to, count++, b, i,
                   (const double[]){a * period[0], c * period[1]});
  }
  return count;
}

void frame_add_images(const struct frames *f, struct bed *b, size_t count,
                      const double (*boxes)[6]) {
  if (!b->n || !bed_header_get(frames_header(f), "periodic"))
    return;
  struct scene scene = frame_scene(f, b);
  double all[6];
  memcpy(all, boxes[0], sizeof all);
  for (size_t k = 1; k < count; k++)
    for (int face = 0; face < 6; face++)
      all[face] = face % 2 ? fmax(all[face], boxes[k][face])
                           : fmin(all[face], boxes[k][face]);
  const size_t images = put_images(b, scene.period, all, NULL);
  if ((double)images >= most_images)
    frame_refuse(f, b,
                 "a box so much larger than the periodic cell that the "
                 "images in it are too many");
  struct bed more;
  frame_check(f, b, bed_alloc(&more, images));
  put_images(b, scene.period, all, &more);
  more.t = b->t;
  bed_free(b);
  *b = more;
  scene_free(&scene);
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

void frame_warn_open(const struct frames *f) {
  if (f->first && bed_header_get(frames_header(f), "periodic"))
    warn("%s: periodic sides are taken as open, each sphere is there once",
         f->name);
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
