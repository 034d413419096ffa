/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shape.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "files/radius_keys.h"
#include "geometry/box.h"
#include "measure.h"

/* The box that holds the spheres and ends at walls along the axes, where a
   centre is not beyond them. */
static void lattice(const struct bed_header *header, const struct bed *b,
                    double box[6]) {
  for (size_t k = 0; k < 3; k++) {
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
  for (size_t k = 0; k < 3; k++) {
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
static void move_bed(const struct shape *s, struct bed *b) {
  for (size_t i = 0; i < b->n; i++) {
    for (size_t k = 0; k < 3; k++) {
      b->x[3 * i + k] = s->scale * b->x[3 * i + k] + s->offset[k];
      b->v[3 * i + k] *= s->scale;
    }
    b->r[i] *= s->scale;
  }
}

static void move(struct shape *s) {
  move_bed(s, &s->bed);
  move_bed(s, &s->filled);
  move_box(s, s->box);
  move_box(s, s->lattice);
  struct container *c = &s->container;
  move_box(s, c->box);
  for (size_t k = 0; k < c->planes; k++)
    s->planes[k][3] =
        s->scale * s->planes[k][3] + vec3_dot(s->planes[k], s->offset);
  for (int k = 0; k < 3; k++)
    c->point[k] = s->scale * c->point[k] + s->offset[k];
  c->radius *= s->scale;
}

static double least_radius(const struct bed *b) {
  double least = GSL_POSINF;
  for (size_t i = 0; i < b->n; i++)
    least = fmin(least, b->r[i]);
  return least;
}

/* Pairs whose gap is small at the radius that the bed settled with. */
static void find_bridges(struct shape *s, const struct shape_options *o) {
  const struct bed *b = s->source;
  const double least = least_radius(&s->bed);
  if (!(o->bridge < least)) {
    char why[120];
    snprintf(why, sizeof why,
             "--bridge %g: expected less than the least radius, %g m",
             o->bridge, least);
    frame_refuse(s->frames, b, why);
  }
  const double dynamics = radius_dynamics(s->header);
  double *r = measure_alloc(b->n, sizeof *r);
  for (size_t i = 0; i < b->n; i++)
    r[i] = dynamics > 0 ? dynamics : b->r[i];
  frame_check(
      s->frames, b,
      solid_pairs(b->n, b->x, r, o->reach, &s->ends, &s->solid.bridges));
  free(r);
  s->solid.ends = (const uint32_t(*)[2])s->ends;
  s->solid.bridge_radius = o->bridge;
  s->solid.bridges = solid_visible(&s->solid, s->ends);
}

static void shrink(struct shape *s, const struct shape_options *o) {
  struct bed *b = &s->bed;
  const int status =
      solid_shrink(s->solid.n, s->solid.x, s->solid.r, o->gap, &s->factor);
  if (status == GSL_EDOM)
    frame_refuse(s->frames, s->source,
                 "--gap: two centres are no farther apart than that");
  frame_check(s->frames, s->source, status);
  for (size_t i = 0; i < b->n; i++)
    b->r[i] *= s->factor;
  for (size_t i = 0; i < s->filled.n; i++)
    s->filled.r[i] *= s->factor;
}

static double nearer(int face, double a, double b) {
  return face % 2 ? fmin(a, b) : fmax(a, b);
}

/* The axis along which a wall's normal is, or a tube; -1 if it slants. */
static int axis_along(const double normal[3]) {
  for (int k = 0; k < 3; k++)
    if (normal[(k + 1) % 3] == 0 && normal[(k + 2) % 3] == 0)
      return k;
  return -1;
}

/* The container that the walls enclose. */
static void take_container(struct shape *s) {
  struct container *c = &s->container;
  struct scene scene = frame_scene(s->frames, s->source);
  s->planes = measure_alloc(scene.walls_count, sizeof *s->planes);
  for (size_t i = 0; i < scene.walls_count; i++) {
    const struct wall *w = &scene.walls[i];
    const int axis = axis_along(w->normal);
    if (w->radius > 0) {
      if (c->radius > 0)
        frame_refuse(s->frames, s->source,
                     "--walls: the header has several cylinders, expected one");
      c->radius = w->radius;
      memcpy(c->point, w->point, sizeof c->point);
      memcpy(c->axis, w->normal, sizeof c->axis);
    } else if (axis >= 0) {
      const int face = 2 * axis + (w->normal[axis] > 0);
      c->box[face] = nearer(face, c->box[face], w->point[axis]);
    } else {
      memcpy(s->planes[c->planes], w->normal, 3 * sizeof(double));
      s->planes[c->planes++][3] = vec3_dot(w->normal, w->point);
    }
  }
  c->plane = (const double(*)[4])s->planes;
  scene_free(&scene);
}

/* Makes the box reach into the walls: around a tube along an axis, around all
   spheres in one that leans. */
static void widen_box(struct shape *s, double thickness) {
  const struct container *c = &s->container;
  double spheres[6], unit[6];
  shape_bounds(s, spheres);
  const bool base = frame_base_box(s->header, unit);
  const int along = axis_along(c->axis);
  for (int k = 0; k < 6; k++) {
    const double outwards = k % 2 ? 1 : -1;
    double end = outwards * GSL_POSINF;
    if (c->radius > 0 && along < 0)
      end = spheres[k] + outwards * thickness;
    else if (c->radius > 0 && along != k / 2)
      end = c->point[k / 2] + outwards * c->radius + outwards * thickness;
    end = nearer(k, end, c->box[k] + outwards * thickness);
    if (isfinite(end))
      s->box[k] = end;
    else if (c->radius > 0 && !base && s->bed.n)
      s->box[k] = spheres[k];
  }
}

/* Is all of the box within the container? That is convex. */
static bool reaches_no_wall(const struct shape *s) {
  for (int corner = 0; corner < 8; corner++) {
    double p[3];
    for (int k = 0; k < 3; k++)
      p[k] = s->box[2 * k + (corner >> k & 1)];
    if (container_distance(&s->container, p) < 0)
      return false;
  }
  return true;
}

/* Makes the box reach into the walls, and these solid. */
static void add_walls(struct shape *s, const struct shape_options *o) {
  take_container(s);
  if (!o->box_given)
    widen_box(s, o->thickness > 0 ? o->thickness : least_radius(s->source));
  if (reaches_no_wall(s))
    frame_refuse(s->frames, s->source,
                 o->box_given ? "--walls: none is within --box"
                              : "--walls: the header has none near the box");
  s->solid.container = &s->container;
}

/* The fraction that the spheres have with the radii that they came with. */
static void measure_bare(struct shape *s) {
  struct solid bare = s->solid;
  struct solid_volume v;
  bare.bridges = 0;
  bare.r = s->images.n ? s->images.r : s->source->r;
  if (!frame_box_resolved(s->source, s->box))
    return;
  frame_check(s->frames, s->source, solid_volume(&bare, s->box, &v));
  s->bare = v.spheres / box_volume(s->box);
}

/* Copies get numbers of their own, after all others. */
static void number_copies(struct bed *images, const struct bed *from) {
  long last = 0;
  for (size_t i = 0; i < from->n; i++)
    last = GSL_MAX(last, from->id[i]);
  size_t i = 0;
  for (size_t m = 0; m < images->n; m++) {
    while (from->id[i] != images->id[m]) /* they come in this order */
      i++;
    if (memcmp(from->x + 3 * i, images->x + 3 * m, 3 * sizeof *from->x))
      images->id[m] = ++last;
  }
}

/* The copies of a periodic bed's spheres that reach into the box, with them. */
static void add_copies(struct shape *s, bool written) {
  if (!bed_header_get(s->header, "periodic"))
    return;
  struct scene scene = frame_scene(s->frames, s->source);
  for (int k = 0; k < 3; k++) {
    const double period = scene.period[k];
    const double times = (s->box[2 * k + 1] - s->box[2 * k]) / period;
    s->around[k] = period > 0 && fabs(times - rint(times)) < 1e-9;
    s->wraps[k] = period > 0 && !written && !s->box_given;
    if (s->wraps[k]) {
      s->lattice[2 * k] = 0;
      s->lattice[2 * k + 1] = period;
    }
  }
  if (s->source->n) {
    frame_check(s->frames, s->source, bed_copy(&s->images, s->source));
    frame_add_images(s->frames, &s->images, 1, (const double(*)[6])s->box);
    number_copies(&s->images, s->source);
  }
  scene_free(&scene);
}

void shape_make(struct shape *s, const struct shape_options *o,
                const struct frames *f, const struct bed *b) {
  *s = (struct shape){.source = b,
                      .header = frames_header(f),
                      .frames = f,
                      .scale = o->scale,
                      .box_given = o->box_given,
                      .bare = GSL_NAN,
                      .factor = 1,
                      .container = container_none(),
                      .changed = o->gap_given || o->bridge > 0,
                      .fraction = GSL_NAN};
  memcpy(s->offset, o->offset, sizeof s->offset);
  if (o->box_given)
    memcpy(s->box, o->box, sizeof s->box);
  else
    frame_base_box(s->header, s->box);
  lattice(s->header, b, s->lattice);
  add_copies(s, o->images);
  if (o->images && s->images.n) {
    s->copies = true;
    s->source = b = &s->images;
  } else if (s->images.n) {
    frame_check(f, b, bed_copy(&s->filled, &s->images));
  }
  frame_check(f, b, bed_copy(&s->bed, b));
  if (s->copies)
    lattice(s->header, b, s->lattice);
  if (o->box_given)
    memcpy(s->lattice, s->box, sizeof s->lattice);
  const struct bed *solid = s->filled.n ? &s->filled : &s->bed;
  s->solid = (struct solid){.n = solid->n, .x = solid->x, .r = solid->r};
  if (o->gap_given)
    shrink(s, o);
  if (o->bridge > 0)
    find_bridges(s, o);
  if (o->walls)
    add_walls(s, o);
  if (o->gap_given)
    measure_bare(s);
  memcpy(s->source_box, s->box, sizeof s->box);
  if (o->base > 0)
    s->scale = o->base / (s->box[1] - s->box[0]);
  s->solid.bridge_radius *= s->scale;
  move(s);
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
  add(s, "t=%g: %zu spheres%s, ", s->bed.t, s->bed.n,
      s->copies     ? " with copies across periodic sides"
      : s->images.n ? " of a periodic bed"
                    : "");
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
  const double box = box_volume(s->box);
  if (s->solid.container)
    add(s, " (exact union, walls %.12g of it; %.12g of the rest is solid)",
        v.walls / box, (v.spheres + v.bridges) / (box - v.walls));
  else
    add(s, " (exact union)");
  if (!isnan(s->bare))
    add(s, "; gap: radii times %.9g, change of the fraction %+.12g", s->factor,
        v.spheres / box - s->bare);
  if (s->solid.bridge_radius > 0)
    add(s, "; bridges: %zu, change of the fraction %+.12g", s->solid.bridges,
        v.bridges / box);
  if (s->solid.bridge_radius > 0 || s->container.radius > 0)
    add(s, " +- %.1g", v.error / box);
}

void shape_say(struct shape *s) {
  shape_measure(s);
  warn("%s", s->statement);
  if (s->more[0])
    warn("%s", s->more);
}

const char *shape_note(struct shape *s) {
  if (!s->changed)
    return NULL;
  shape_measure(s);
  return s->statement;
}

void shape_bounds(const struct shape *s, double box[6]) {
  for (int k = 0; k < 3; k++) {
    box[2 * k] = GSL_POSINF;
    box[2 * k + 1] = GSL_NEGINF;
    for (size_t i = 0; i < s->bed.n; i++) {
      const double x = s->bed.x[3 * i + (size_t)k], r = s->bed.r[i];
      box[2 * k] = fmin(box[2 * k], x - r);
      box[2 * k + 1] = fmax(box[2 * k + 1], x + r);
    }
  }
}

void shape_domain(const struct shape *s, double box[6]) {
  memcpy(box, s->box, sizeof s->box);
  for (int k = 0; k < 6 && s->solid.container; k++)
    box[k] = nearer(k, box[k], s->container.box[k]);
}

/* The middle of the box; its diagonal. */
static double middle_of(const double box[6], double middle[3]) {
  double side[3];
  for (int k = 0; k < 3; k++) {
    side[k] = box[2 * k + 1] - box[2 * k];
    middle[k] = box[2 * k] + side[k] / 2;
  }
  return vec3_norm(side);
}

void shape_tube(const struct shape *s, double from[3], double to[3]) {
  const struct container *c = &s->container;
  double middle[3], away[3];
  const double length = middle_of(s->box, middle);
  container_away(c, middle, away);
  vec3_sub(middle, away, from);
  memcpy(to, from, 3 * sizeof *to);
  vec3_axpy(-length, c->axis, from);
  vec3_axpy(length, c->axis, to);
}

void shape_plane(const struct shape *s, size_t k, double foot[3],
                 double outwards[3]) {
  const double *plane = s->planes[k];
  const double length = middle_of(s->box, foot);
  vec3_axpy(plane[3] - vec3_dot(plane, foot), plane, foot);
  for (int m = 0; m < 3; m++)
    outwards[m] = length * plane[m];
}

/* Spheres that a wall of the container or a face of the domain cuts, which
   leave wedges there, and those that end before one, which leave gaps. */
struct ends {
  size_t cut;
  double wedge; /* the sharpest angle between the surfaces (degrees) */
  double gap;   /* the narrowest; infinite without any */
};

/* One sphere and one surface at the distance d from its centre; a tube of a
   radius, or a plane. */
static bool look_at_end(struct ends *e, double d, double r, double radius) {
  if (d >= r)
    e->gap = fmin(e->gap, d - r);
  if (!(fabs(d) < r))
    return false;
  /* where they meet farthest out, by the cosine rule in a cut across a tube */
  const double away = radius - d;
  const double cosine =
      radius > 0 && away > 0
          ? (radius * radius + r * r - away * away) / (2 * radius * r)
          : d / r;
  e->wedge = fmin(e->wedge, acos(fmin(1, fabs(cosine))) * 180 / M_PI);
  return true;
}

static void find_ends(const struct shape *s, struct ends *e) {
  const struct container *c = s->solid.container;
  double box[6], away[3];
  shape_domain(s, box);
  *e = (struct ends){.wedge = GSL_POSINF, .gap = GSL_POSINF};
  for (size_t i = 0; i < s->solid.n; i++) {
    const double *x = s->solid.x + 3 * i, r = s->solid.r[i];
    bool cut = false;
    if (box_misses_ball(box, x, r) ||
        (c && container_slant_distance(c, x) <= -r))
      continue;
    for (int k = 0; k < 6; k++)
      cut |= look_at_end(e, (k % 2 ? 1 : -1) * (box[k] - x[k / 2]), r, 0);
    for (size_t k = 0; c && k < c->planes; k++)
      cut |= look_at_end(e, c->plane[k][3] - vec3_dot(c->plane[k], x), r, 0);
    if (c && c->radius > 0)
      cut |=
          look_at_end(e, c->radius - container_away(c, x, away), r, c->radius);
    e->cut += cut;
  }
}

void shape_say_ends(struct shape *s) {
  struct ends e;
  find_ends(s, &e);
  if (e.cut)
    shape_add(s, "walls and faces cut %zu spheres, at %.2g degrees and more",
              e.cut, e.wedge);
  else
    shape_add(s, "walls and faces cut no sphere");
  if (isfinite(e.gap))
    shape_add(s, "; the narrowest gap to others is %.2g", e.gap);
}

double shape_least_radius(const struct shape *s) {
  return least_radius(&s->bed);
}

void shape_free(struct shape *s) {
  free(s->ends);
  s->ends = NULL;
  free(s->planes);
  s->planes = NULL;
  bed_free(&s->bed);
  bed_free(&s->images);
  bed_free(&s->filled);
}
