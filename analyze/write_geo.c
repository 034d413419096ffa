/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gmsh, by its OpenCASCADE kernel: the pore as a box, or what walls leave of
   one, less spheres and bridges, with names for its surfaces. Everything is
   exact there, too, but for a tolerance of 1e-7 in the units written. */
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "geometry/box.h"
#include "geometry/neighbors.h"
#include "measure.h"
#include "program/options.h"
#include "writers.h"

/* Points that OpenCASCADE takes as one (Precision::Confusion). */
static const double tolerance = 1e-7;

static void put_list(FILE *out, size_t count, const double *x) {
  char text[NUMBER_SIZE];
  for (size_t i = 0; i < count; i++) {
    number_format(x[i], text);
    fprintf(out, i ? ", %s" : "%s", text);
  }
  fputs("};\n", out);
}

/* Pairs for which it cannot be told whether they touch. */
static size_t undecided(const struct shape *s) {
  const struct bed *b = &s->bed;
  struct neighbors nb = {0};
  frame_check(s->frames, s->source,
              neighbors_find(&nb, b->n, b->x, 3, b->r, tolerance));
  size_t count = 0;
  for (size_t p = 0; p < nb.count; p++) {
    double d[3];
    vec3_sub(b->x + 3 * (size_t)nb.i[p], b->x + 3 * (size_t)nb.j[p], d);
    count += fabs(vec3_norm(d) - b->r[nb.i[p]] - b->r[nb.j[p]]) <= tolerance;
  }
  neighbors_free(&nb);
  return count;
}

static void check(struct shape *s) {
  char why[200];
  const double least = shape_least_radius(s);
  if (least < 1000 * tolerance) {
    snprintf(
        why, sizeof why,
        "a radius of %g; gmsh's kernel has a tolerance of %g: --scale 1000 "
        "makes mm",
        least, tolerance);
    frame_refuse(s->frames, s->source, why);
  }
  shape_say_ends(s);
  const size_t pairs = undecided(s);
  if (pairs && !s->solid.bridges)
    shape_add(s,
              "; %zu pair%s of spheres touch to %g, which gmsh's kernel cannot "
              "tell from a gap: --gap or --bridge",
              pairs, pairs == 1 ? "" : "s", tolerance);
}

/* The box that holds a bridge. */
static void bridge_box(const struct shape *s, size_t k, double box[6]) {
  const double *p = s->solid.x + 3 * (size_t)s->ends[k][0];
  const double *q = s->solid.x + 3 * (size_t)s->ends[k][1];
  for (int m = 0; m < 3; m++) {
    box[2 * m] = fmin(p[m], q[m]) - s->solid.bridge_radius;
    box[2 * m + 1] = fmax(p[m], q[m]) + s->solid.bridge_radius;
  }
}

static void put_cylinder(FILE *out, size_t number, const double p[3],
                         const double d[3], double radius) {
  fprintf(out, "Cylinder(%zu) = {", number);
  put_list(out, 7, (double[]){p[0], p[1], p[2], d[0], d[1], d[2], radius});
}

/* Writes the spheres and bridges that reach into the domain, as volumes from 2
   on; the last one's number. */
static size_t write_tools(FILE *out, const struct shape *s,
                          const double domain[6]) {
  const struct bed *b = &s->bed;
  size_t last = 1;
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    if (box_misses_ball(domain, x, b->r[i]))
      continue;
    fprintf(out, "Sphere(%zu) = {", ++last);
    put_list(out, 4, (double[]){x[0], x[1], x[2], b->r[i]});
  }
  for (size_t k = 0; k < s->solid.bridges; k++) {
    /* from centre to centre: gmsh is sooner done with shorter ones, which do
       not cross, and then loses some */
    const double *p = s->solid.x + 3 * (size_t)s->ends[k][0];
    const double *q = s->solid.x + 3 * (size_t)s->ends[k][1];
    double middle[3], d[3];
    vec3_sub(q, p, d);
    for (int m = 0; m < 3; m++)
      middle[m] = p[m] + d[m] / 2;
    if (box_misses_ball(domain, middle,
                        hypot(vec3_norm(d) / 2, s->solid.bridge_radius)))
      continue;
    put_cylinder(out, ++last, p, d, s->solid.bridge_radius);
  }
  return last;
}

/* Writes a tube and slanting walls, numbered after the last tool, and what they
   leave of the box as inside(). */
static void write_container(FILE *out, const struct shape *s, size_t last) {
  const struct container *c = s->solid.container;
  double p[3], q[3];
  fputs("inside() = {1};\n", out);
  if (!c)
    return;
  if (c->radius > 0) {
    shape_tube(s, p, q);
    vec3_sub(q, p, q);
    put_cylinder(out, ++last, p, q, c->radius);
  }
  for (size_t k = 0; k < c->planes; k++) {
    shape_plane(s, k, p, q);
    put_cylinder(out, last + k + 1, p, q, vec3_norm(q));
  }
  if (c->radius > 0)
    fprintf(out,
            "inside() = BooleanIntersection{ Volume{1}; Delete; }"
            "{ Volume{%zu}; Delete; };\n",
            last);
  if (c->planes)
    fprintf(out,
            "inside() = BooleanDifference{ Volume{inside()}; Delete; }"
            "{ Volume{%zu:%zu}; Delete; };\n",
            last + 1, last + c->planes);
}

/* The surfaces within a box, with a bit to spare on all sides. */
static void put_within(FILE *out, const char *name, const double box[6],
                       double spare) {
  double corners[6];
  for (int m = 0; m < 3; m++) {
    corners[m] = box[2 * m] - spare;
    corners[3 + m] = box[2 * m + 1] + spare;
  }
  fprintf(out, "%s() = Surface In BoundingBox{", name);
  put_list(out, 6, corners);
}

static void put_surface(FILE *out, const char *list, const char *name) {
  fprintf(out, "If (#%s() > 0)\n  Physical Surface(\"%s\") = {%s()};\nEndIf\n",
          list, name, list);
}

/* Of what is not on the domain's faces, walls() is all that is not within the
   box around a sphere or bridge. */
static void tell_walls(FILE *out, const struct shape *s,
                       const double domain[6]) {
  const struct bed *b = &s->bed;
  const double spare = 1e-3 * shape_least_radius(s);
  double box[6];
  fputs("walls() = {solid()};\n", out);
  for (size_t i = 0; i < b->n; i++) {
    if (box_misses_ball(domain, b->x + 3 * i, b->r[i]))
      continue;
    for (int k = 0; k < 6; k++)
      box[k] = b->x[3 * i + (size_t)k / 2] + (k % 2 ? b->r[i] : -b->r[i]);
    put_within(out, "part", box, spare);
    fputs("walls() -= part();\n", out);
  }
  for (size_t k = 0; k < s->solid.bridges; k++) {
    bridge_box(s, k, box);
    put_within(out, "part", box, spare);
    fputs("walls() -= part();\n", out);
  }
  fputs("solid() -= walls();\n", out);
  put_surface(out, "walls", "walls");
}

void write_geo(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  static const char *const faces[6] = {"xmin", "xmax", "ymin",
                                       "ymax", "zmin", "zmax"};
  struct shape *s = f->shape;
  double box[6], least = GSL_POSINF;
  shape_domain(s, box);
  check(s);
  shape_measure(s);
  write_origin(out, &origin_slashes, f);
  fprintf(out,
          "// %s\n"
          "// gmsh -3 makes a mesh of the pore\n"
          "SetFactory(\"OpenCASCADE\");\n"
          "h = ",
          s->statement);
  char text[NUMBER_SIZE];
  number_format(shape_least_radius(s) / 4, text);
  fprintf(out, "%s; // the longest edges\nBox(1) = {", text);
  put_list(out, 6,
           (double[]){box[0], box[2], box[4], box[1] - box[0], box[3] - box[2],
                      box[5] - box[4]});
  const size_t last = write_tools(out, s, box);
  write_container(out, s, last);
  if (last > 1)
    fprintf(out,
            "pore() = BooleanDifference{ Volume{inside()}; Delete; }"
            "{ Volume{2:%zu}; Delete; };\n",
            last);
  else
    fprintf(out, "pore() = {inside()};\n");
  fprintf(out, "Physical Volume(\"pore\") = {pore()};\n"
               "solid() = Boundary{ Volume{pore()}; };\n");
  for (int k = 0; k < 3; k++)
    least = fmin(least, box[2 * k + 1] - box[2 * k]);
  for (int k = 0; k < 6; k++) {
    double face[6];
    for (int m = 0; m < 6; m++)
      face[m] = box[m];
    face[k ^ 1] = box[k];
    put_within(out, faces[k], face, 1e-4 * least);
    fprintf(out, "solid() -= %s();\n", faces[k]);
    put_surface(out, faces[k], faces[k]);
  }
  if (s->solid.container && container_slants(s->solid.container))
    tell_walls(out, s, box);
  put_surface(out, "solid", "spheres");
  fprintf(out, "Mesh.CharacteristicLengthMax = h;\n"
               "Mesh.CharacteristicLengthMin = h / 10;\n");
}
