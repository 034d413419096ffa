/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Binary STL: each sphere is a closed surface with the same number of facets,
   the geodesic subdivision of an icosahedron. Spheres that overlap are written
   whole, as surfaces that pass through each other; single precision, as STL has
   it. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/command_line.h"
#include "geometry/vec3.h"
#include "geometry/surface.h"
#include "measure.h"
#include "writers.h"

/* Corners and faces, counter-clockwise from outside. */
static const double golden = 1.6180339887498949; /* (1 + sqrt(5))/2 */
static const signed char corner[12][3] = {
    /* cyclic permutations of (0, +-1, +-golden): 2 stands for golden */
    {0, 1, 2},  {0, 1, -2},  {0, -1, 2}, {0, -1, -2}, {1, 2, 0},  {1, -2, 0},
    {-1, 2, 0}, {-1, -2, 0}, {2, 0, 1},  {2, 0, -1},  {-2, 0, 1}, {-2, 0, -1}};

static void corner_at(int i, double x[3]) {
  for (int k = 0; k < 3; k++)
    x[k] =
        abs(corner[i][k]) == 2 ? copysign(golden, corner[i][k]) : corner[i][k];
}

/* The point of a face with whole barycentric coordinates, on the unit sphere.
   Corners come in ascending order, so that faces agree on a common edge to the
   last bit. */
static void face_point(const int face[3], const size_t weight[3], double u[3]) {
  u[0] = u[1] = u[2] = 0;
  for (int k = 0; k < 3; k++) {
    double x[3];
    corner_at(face[k], x);
    for (int c = 0; c < 3; c++)
      u[c] += (double)weight[k] * x[c];
  }
  const double norm = vec3_norm(u);
  for (int c = 0; c < 3; c++)
    u[c] /= norm;
}

static void add_facet(double (*facet)[9], const int face[3],
                      const size_t weights[3][3]) {
  double *u = *facet, normal[3], a[3], b[3];
  for (int k = 0; k < 3; k++)
    face_point(face, weights[k], u + 3 * k);
  vec3_sub(u + 3, u, a);
  vec3_sub(u + 6, u, b);
  vec3_cross(a, b, normal);
  if (vec3_dot(normal, u) < 0) /* inside out */
    for (int c = 0; c < 3; c++) {
      const double swap = u[3 + c];
      u[3 + c] = u[6 + c];
      u[6 + c] = swap;
    }
}

/* Are these three corners at an edge's length, 2, from each other? */
static bool is_face(const int face[3]) {
  for (int k = 0; k < 3; k++) {
    double x[3], y[3], d[3];
    corner_at(face[k], x);
    corner_at(face[(k + 1) % 3], y);
    vec3_sub(x, y, d);
    if (vec3_dot(d, d) >= 4.5)
      return false;
  }
  return true;
}

/* The m^2 facets of a face. */
static void divide_face(size_t m, const int face[3], double (*facet)[9]) {
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; i + j < m; j++) {
      const size_t l = m - i - j; /* of the third corner, at least 1 */
      const size_t up[3][3] = {{i, j, l}, {i + 1, j, l - 1}, {i, j + 1, l - 1}};
      add_facet(facet++, face, up);
      if (l < 2)
        continue;
      const size_t down[3][3] = {
          {i + 1, j + 1, l - 2}, {i + 1, j, l - 1}, {i, j + 1, l - 1}};
      add_facet(facet++, face, down);
    }
}

/* The facets of the unit sphere, 20 m^2 rows of three corners. */
static void make_facets(size_t m, double (*facet)[9]) {
  for (int a = 0; a < 12; a++)
    for (int b = a + 1; b < 12; b++)
      for (int c = b + 1; c < 12; c++) {
        const int face[3] = {a, b, c};
        if (!is_face(face))
          continue;
        divide_face(m, face, facet);
        facet += m * m;
      }
}

static double facets_volume(size_t count, const double (*facet)[9]) {
  double six = 0;
  for (size_t i = 0; i < count; i++) {
    double cross[3];
    vec3_cross(facet[i], facet[i] + 3, cross);
    six += vec3_dot(cross, facet[i] + 6);
  }
  return six / 6;
}

/* 80 bytes: what wrote it, of the bed with which checksum, and what fits. */
static void put_header(FILE *out, const char *name, const struct shape *s,
                       const char *text, size_t facets) {
  output_need_room(out, name, 84 + 50 * (double)facets);
  char by[80], header[240];
  const char *sum = bed_reader_sum(s->frames->reader);
  origin_name(by, sizeof by);
  snprintf(header, sizeof header, "%s%s%s: %-80s", by, sum ? " of " : "",
           sum ? sum : "", text);
  fwrite(header, 1, 80, out);
  const uint32_t count = (uint32_t)facets;
  write_little_endian(out, &count, sizeof count, 1);
}

static void put_facet(FILE *out, const double normal[3],
                      const double corner[9]) {
  float number[12];
  for (int k = 0; k < 3; k++)
    number[k] = (float)normal[k];
  for (int k = 0; k < 9; k++)
    number[3 + k] = (float)corner[k];
  static const uint16_t attributes = 0;
  write_little_endian(out, number, sizeof *number, 12);
  write_little_endian(out, &attributes, sizeof attributes, 1);
}

/* The unit normal of a facet, corners counter-clockwise from outside. */
static void normal_of(const double corner[9], double normal[3]) {
  double u[3], v[3];
  vec3_sub(corner + 3, corner, u);
  vec3_sub(corner + 6, corner, v);
  vec3_cross(u, v, normal);
  const double norm = vec3_norm(normal);
  for (int k = 0; k < 3; k++)
    normal[k] /= norm;
}

static void put_corners(FILE *out, const double a[3], const double b[3],
                        const double c[3]) {
  double corner[9], normal[3];
  memcpy(corner, a, 3 * sizeof *a);
  memcpy(corner + 3, b, 3 * sizeof *b);
  memcpy(corner + 6, c, 3 * sizeof *c);
  normal_of(corner, normal);
  put_facet(out, normal, corner);
}

/* Facets of a bridge, a prism with this number of sides from one centre to the
   other. */
static size_t prism_facets(size_t sides) {
  return 4 * sides - 4;
}

static void put_prism(FILE *out, const double a[3], const double b[3],
                      double radius, size_t sides) {
  double axis[3], u[3], v[3], corner[4][3];
  vec3_sub(b, a, axis);
  vec3_across(axis, u);
  const double length = vec3_norm(axis);
  for (int k = 0; k < 3; k++)
    u[k] *= radius;
  vec3_cross(axis, u, v);
  for (int k = 0; k < 3; k++)
    v[k] /= length;
  for (size_t i = 0; i < sides; i++) {
    /* corners i and i + 1 of the end a, then of the end b */
    for (int m = 0; m < 4; m++) {
      const double angle =
          2 * M_PI * (double)((i + (size_t)(m % 2)) % sides) / (double)sides;
      memcpy(corner[m], m < 2 ? a : b, sizeof corner[m]);
      vec3_axpy(cos(angle), u, corner[m]);
      vec3_axpy(sin(angle), v, corner[m]);
    }
    put_corners(out, corner[0], corner[1], corner[2]);
    put_corners(out, corner[1], corner[3], corner[2]);
    if (i == 0 || i + 1 == sides)
      continue;
    for (int m = 0; m < 3; m += 2) { /* the ends, from corner 0 */
      double first[3];
      memcpy(first, m ? b : a, sizeof first);
      vec3_axpy(1, u, first);
      put_corners(out, first, corner[m ? 2 : 1], corner[m ? 3 : 0]);
    }
  }
}

/* A box. */
enum { PLATE_FACETS = 12 };

static void put_box(FILE *out, const double box[6]) {
  /* corners by the bits of x, y, z; each face counter-clockwise */
  static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  double corner[8][3];
  for (int c = 0; c < 8; c++)
    for (int k = 0; k < 3; k++)
      corner[c][k] = box[2 * k + (c >> k & 1)];
  for (int f = 0; f < 6; f++)
    for (int half = 1; half < 3; half++)
      put_corners(out, corner[face[f][0]], corner[face[f][half]],
                  corner[face[f][half + 1]]);
}

/* The walls as plates from the container to the box, one for each. */
static size_t plates(const struct shape *s, double plate[6][6]) {
  size_t count = 0;
  for (int k = 0; k < 6 && s->solid.container; k++) {
    const double wall = s->container.box[k];
    if (k % 2 ? s->box[k] <= wall : s->box[k] >= wall)
      continue;
    memcpy(plate[count], s->box, sizeof s->box);
    plate[count][k ^ 1] = wall;
    count++;
  }
  return count;
}

/* The largest coordinate, whose last digit in single precision is the finest
   that a file can tell. */
static double ulp(const struct shape *s) {
  double most = 0;
  for (size_t i = 0; i < s->bed.n; i++)
    for (size_t k = 0; k < 3; k++)
      most = fmax(most, fabs(s->bed.x[3 * i + k]) + s->bed.r[i]);
  return most * FLT_EPSILON;
}

static void check_count(double facets) {
  if (facets > (double)UINT32_MAX)
    die(EXIT_INPUT, "%.0f facets: STL holds at most %lu", facets,
        (unsigned long)UINT32_MAX);
}

static double shortest_edge(size_t count, const double (*facet)[9]) {
  double shortest = GSL_POSINF;
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      double d[3];
      vec3_sub(facet[i] + 3 * k, facet[i] + 3 * ((k + 1) % 3), d);
      shortest = fmin(shortest, vec3_norm(d));
    }
  return shortest;
}

static void write_bodies(FILE *out, const char *name, const struct shape *s,
                         const struct write_options *o, const char *note) {
  const struct bed *b = &s->bed;
  size_t m = (size_t)ceil(sqrt((double)o->facets / 20));
  while (20 * m * m < o->facets)
    m++;
  const size_t count = 20 * m * m, sides = GSL_MAX(8, 5 * m);
  double plate[6][6];
  if (!o->apart && s->solid.container && container_slants(s->solid.container))
    frame_refuse(s->frames, s->source,
                 "--walls: a tube or slanting wall, expected --merged with it");
  const size_t walls = o->apart ? 0 : plates(s, plate);
  check_count((double)count * (double)b->n +
              (double)prism_facets(sides) * (double)s->solid.bridges +
              (double)PLATE_FACETS * (double)walls);
  double(*facet)[9] = calloc(count, sizeof *facet);
  if (!facet)
    die(EXIT_IO, "out of memory for %zu facets", count);
  make_facets(m, facet);
  const double sphere = 4 * M_PI / 3;
  double share = facets_volume(count, (const double(*)[9])facet) / sphere;
  const double scale = o->equal_volume ? cbrt(1 / share) : 1;
  const double polygon =
      (double)sides * sin(2 * M_PI / (double)sides) / (2 * M_PI);
  const double radius =
      s->solid.bridge_radius * (o->equal_volume ? sqrt(1 / polygon) : 1);
  if (o->equal_volume)
    share = 1;
  double least = GSL_POSINF;
  for (size_t i = 0; i < b->n; i++)
    least = fmin(least, b->r[i]);
  write_check_single(s, least * scale *
                            shortest_edge(count, (const double(*)[9])facet));
  char text[120];
  if (note)
    snprintf(text, sizeof text, "%s", note);
  else
    snprintf(text, sizeof text, "%zu facets each, %.6f of a ball", count,
             share);
  put_header(out, name, s, text,
             count * b->n + prism_facets(sides) * s->solid.bridges +
                 PLATE_FACETS * walls);
  for (size_t i = 0; i < b->n && !ferror(out); i++) {
    for (size_t q = 0; q < count; q++) {
      double corner[9], normal[3];
      normal_of(facet[q], normal);
      for (size_t k = 0; k < 9; k++)
        corner[k] = b->x[3 * i + k % 3] + scale * b->r[i] * facet[q][k];
      put_facet(out, normal, corner);
    }
  }
  free(facet);
  for (size_t k = 0; k < s->solid.bridges && !ferror(out); k++)
    put_prism(out, b->x + 3 * (size_t)s->ends[k][0],
              b->x + 3 * (size_t)s->ends[k][1], radius, sides);
  for (size_t k = 0; k < walls; k++)
    put_box(out, plate[k]);
  if (!o->quiet)
    warn("%zu facets per sphere, with %.6f of the volume of a ball%s", count,
         share, o->equal_volume ? "" : " (--equal-volume: all of it)");
}

/* The file of a merged surface, and its volume, times 6, as it comes
   out in single precision; from a corner, which keeps digits. */
struct merged {
  FILE *out;
  double origin[3], six;
};

static void put_merged(const double corner[3][3], void *context) {
  struct merged *m = context;
  double p[3][3], cross[3];
  put_corners(m->out, corner[0], corner[1], corner[2]);
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      p[c][k] = (float)corner[c][k] - m->origin[k];
  vec3_cross(p[0], p[1], cross);
  m->six += vec3_dot(cross, p[2]);
}

static void check_merged(int status, size_t cells) {
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory for %zu cells", cells);
  if (status != GSL_SUCCESS)
    die(EXIT_INPUT, "--merged: no spheres, expected at least one");
}

/* One closed surface of the union: of all of it, or within a box. */
static void write_merged(FILE *out, const char *name, struct shape *s,
                         const struct write_options *o) {
  const bool whole = !s->box_given && !s->solid.container;
  const bool clip = !whole || s->copies;
  double region[6];
  memcpy(region, s->box, sizeof region);
  if (whole) { /* but for periodic sides, which cut it */
    shape_bounds(s, region);
    for (int k = 0; k < 6; k++)
      if (s->around[k / 2])
        region[k] = s->box[k];
  }
  struct surface *surface = NULL;
  size_t count = 0;
  check_merged(surface_open(&surface, &s->solid, region, clip, o->cells[0]),
               o->cells[0]);
  const double step = surface_step(surface);
  if (SURFACE_MARGIN * step < 4 * ulp(s))
    die(EXIT_INPUT,
        "--cells %zu: steps of %.2g are too small for single precision, which "
        "STL has, at places of %.2g; fewer cells, or --offset",
        o->cells[0], step, ulp(s) / FLT_EPSILON);
  check_merged(surface_walk(surface, NULL, NULL, &count), o->cells[0]);
  check_count((double)count);
  struct solid_volume exact;
  frame_check(s->frames, s->source, solid_volume(&s->solid, region, &exact));
  char text[120];
  snprintf(text, sizeof text, "%zu spheres, %zu bridges, volume %.9g", s->bed.n,
           s->solid.bridges, exact.total);
  put_header(out, name, s, text, count);
  struct merged merged = {.out = out};
  for (int k = 0; k < 3; k++)
    merged.origin[k] = region[2 * k];
  check_merged(surface_walk(surface, put_merged, &merged, &count), o->cells[0]);
  surface_close(surface);
  const double ratio = step / shape_least_radius(s);
  shape_add(s,
            "one closed surface of %zu facets, volume %.9g, that is %+.2e of "
            "the exact %.9g; bound (step/r)^2/3 = %.1e",
            count, merged.six / 6, merged.six / 6 / exact.total - 1,
            exact.total, ratio * ratio / 3);
}

void write_stl(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  if (o->merged)
    write_merged(out, f->name, f->shape, o);
  else
    write_bodies(out, f->name, f->shape, o, shape_note(f->shape));
}
