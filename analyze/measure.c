/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "geometry/periodic.h"
#include "geometry/volume.h"
#include "files/radius_keys.h"
#include "model/base_box.h"
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

/* The numbers of a key, count of them; false if that is not what it has. */
static bool header_numbers(const char *value, double count,
                           struct option_list *numbers) {
  struct option_spec spec = {
      .type = OPTION_LIST, .value = numbers, .least = count, .most = count};
  return value && !option_set(&spec, value);
}

/* The walls and periodic sides of a header, without what is no such key; to be
   freed. */
static struct scene header_container(const struct bed_header *h) {
  struct scene s = {0};
  struct option_list v;
  int status = GSL_SUCCESS;
  for (size_t i = 0; i < h->count && status != GSL_ENOMEM; i++) {
    const char *value = h->at[i].value;
    if (!strcmp(h->at[i].name, "wall") && header_numbers(value, 6, &v))
      status = scene_add_wall(&s, v.at, v.at + 3);
    if (!strcmp(h->at[i].name, "cylinder") && header_numbers(value, 7, &v))
      status = scene_add_cylinder(&s, v.at, v.at + 3, v.at[6]);
  }
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  const char *periodic = bed_header_get(h, "periodic");
  for (int k = 0; k < 2; k++)
    if (periodic && strchr(periodic, "xy"[k]) &&
        header_numbers(bed_header_get(h, "base"), 2, &v))
      s.period[k] = v.at[k];
  return s;
}

void header_walls(const struct bed_header *h, double box[6], bool walled[6]) {
  struct scene s = header_container(h);
  base_faces(&s, box, walled);
  scene_free(&s);
}

bool frame_base_box(const struct bed_header *h, double box[6]) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  struct scene s = header_container(h);
  const bool valid = base_box(&s, box);
  if (!valid)
    memcpy(box, unit, sizeof unit);
  scene_free(&s);
  return valid;
}

void frame_choose_box(const struct frames *f, const struct option_list *given,
                      double box[6]) {
  if (given->count)
    memcpy(box, given->at, 6 * sizeof *box);
  else
    frame_base_box(frames_header(f), box);
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
  struct periodic_images images = {0};
  const int status =
      periodic_images_in_box(&images, b->n, b->x, b->r, scene.period, all);
  if (status == GSL_ERANGE)
    frame_refuse(f, b,
                 "a box so much larger than the periodic cell that the "
                 "images in it are too many");
  frame_check(f, b, status);
  struct bed more;
  frame_check(f, b, bed_alloc(&more, images.count));
  for (size_t k = 0; k < images.count; k++) {
    const size_t i = images.of[k];
    more.id[k] = b->id[i];
    memcpy(more.x + 3 * k, images.x + 3 * k, 3 * sizeof *more.x);
    memcpy(more.v + 3 * k, b->v + 3 * i, 3 * sizeof *more.v);
    memcpy(more.w + 3 * k, b->w + 3 * i, 3 * sizeof *more.w);
    more.r[k] = b->r[i];
    more.m[k] = b->m[i];
  }
  more.t = b->t;
  bed_free(b);
  *b = more;
  periodic_images_free(&images);
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
  if (w->found)
    return;
  struct bed all;
  frame_check(f, b, bed_copy(&all, b));
  frame_add_images(f, &all, count, boxes);
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < all.n && !w->found; i++)
      w->found = w->default_
                     ? box_holds(boxes[k], all.x + 3 * i)
                     : !box_misses_ball(boxes[k], all.x + 3 * i, all.r[i]);
  bed_free(&all);
}

double frame_union(struct frames_part part, const struct option_list *given,
                   const struct bed *b, struct box_watch *watch) {
  struct frames *f = part.frames;
  double united, box[6];
  frame_choose_box(f, given, box);
  box_watch_see(watch, f, b, !given->count, 1, (const double(*)[6])box);
  frame_check_box(f, b, box);
  struct bed all;
  frame_check(f, b, bed_copy(&all, b));
  frame_add_images(f, &all, 1, (const double(*)[6])box);
  const struct observer told = frames_observer(&part);
  frame_check(f, b,
              volume_union_told(all.n, all.x, all.r, box, &told, &united));
  bed_free(&all);
  return united / box_volume(box);
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

/* Faces of the centres less margin on either side. */
static void centres_span(const struct bed *b, size_t axis, double margin,
                         double face[2]) {
  double low = GSL_POSINF, high = GSL_NEGINF;
  for (size_t i = 0; i < b->n; i++) {
    low = GSL_MIN(low, b->x[3 * i + axis]);
    high = GSL_MAX(high, b->x[3 * i + axis]);
  }
  face[0] = low + margin;
  face[1] = high - margin;
}

/* The piece of a tube that the centres span, less margin. */
static void tube_span(const struct bed *b, const struct wall *tube,
                      double margin, struct region *region) {
  double low = GSL_POSINF, high = GSL_NEGINF, most = 0;
  for (size_t i = 0; i < b->n; i++) {
    double d[3], normal[3];
    vec3_sub(b->x + 3 * i, tube->point, d);
    const double along = vec3_dot(d, tube->normal);
    low = fmin(low, along);
    high = fmax(high, along);
    most = fmax(most,
                tube->radius - cylinder_distance(tube, b->x + 3 * i, normal));
  }
  /* the furthest centre, too, in spite of rounding */
  region->radius = fmax(DBL_MIN, most * (1 + 1e-12) - margin);
  memcpy(region->point, tube->point, sizeof region->point);
  memcpy(region->axis, tube->normal, sizeof region->axis);
  region->ends[0] = low + margin;
  region->ends[1] = high - margin;
}

const struct wall *scene_tube(const struct scene *s, size_t *count) {
  const struct wall *tube = NULL;
  *count = 0;
  for (size_t k = 0; k < s->walls_count; k++)
    if (s->walls[k].radius > 0) {
      tube = &s->walls[k];
      ++*count;
    }
  return tube;
}

struct region frame_region(const struct frames *f, const struct bed *b,
                           const struct option_list *given, double margin) {
  struct region region = {0};
  if (given->count) {
    memcpy(region.box, given->at, sizeof region.box);
    return region;
  }
  struct scene scene = frame_scene(f, b);
  for (size_t k = 0; k < 3; k++) {
    region.period[k] = scene.period[k];
    region.box[2 * k + 1] = scene.period[k];
    if (!(scene.period[k] > 0))
      centres_span(b, k, margin, region.box + 2 * k);
  }
  size_t tubes;
  const struct wall *tube = scene_tube(&scene, &tubes);
  if (tubes == 1 && !periodic_any(scene.period))
    tube_span(b, tube, margin, &region);
  scene_free(&scene);
  return region;
}

void *measure_alloc(size_t count, size_t size) {
  void *p = calloc(count + 1, size);
  if (!p)
    die(EXIT_IO, "out of memory");
  return p;
}
