/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Binary STL: each sphere is a closed surface with the same number of facets,
   the geodesic subdivision of an icosahedron. Spheres that overlap are written
   whole, as surfaces that pass through each other; single precision, as STL has
   it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_math.h>
#include "program/options.h"
#include "geometry/vec3.h"
#include "program/version.h"
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

/* The facets of the unit sphere, 20 m^2 rows of three corners. */
static void make_facets(size_t m, double (*facet)[9]) {
  size_t count = 0;
  for (int a = 0; a < 12; a++)
    for (int b = a + 1; b < 12; b++)
      for (int c = b + 1; c < 12; c++) {
        /* the faces: any three corners at an edge's length, 2 */
        const int face[3] = {a, b, c};
        bool near = true;
        for (int k = 0; k < 3; k++) {
          double x[3], y[3], d[3];
          corner_at(face[k], x);
          corner_at(face[(k + 1) % 3], y);
          vec3_sub(x, y, d);
          near = near && vec3_dot(d, d) < 4.5;
        }
        if (!near)
          continue;
        for (size_t i = 0; i < m; i++)
          for (size_t j = 0; i + j < m; j++) {
            const size_t l = m - i - j; /* of the third corner, at least 1 */
            const size_t up[3][3] = {
                {i, j, l}, {i + 1, j, l - 1}, {i, j + 1, l - 1}};
            add_facet(&facet[count++], face, up);
            if (l < 2)
              continue;
            const size_t down[3][3] = {
                {i + 1, j + 1, l - 2}, {i + 1, j, l - 1}, {i, j + 1, l - 1}};
            add_facet(&facet[count++], face, down);
          }
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

void write_stl(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  const struct bed *b = f->bed;
  size_t m = (size_t)ceil(sqrt((double)o->facets / 20));
  while (20 * m * m < o->facets)
    m++;
  const size_t count = 20 * m * m;
  if (b->n > UINT32_MAX / count)
    die(EXIT_INPUT, "%zu spheres of %zu facets: STL holds at most %lu facets",
        b->n, count, (unsigned long)UINT32_MAX);
  double(*facet)[9] = calloc(count, sizeof *facet);
  if (!facet)
    die(EXIT_IO, "out of memory for %zu facets", count);
  make_facets(m, facet);
  const double sphere = 4 * M_PI / 3;
  double share = facets_volume(count, (const double(*)[9])facet) / sphere;
  const double scale = o->equal_volume ? cbrt(1 / share) : 1;
  if (o->equal_volume)
    share = 1;
  char header[81];
  memset(header, ' ', sizeof header);
  const int length =
      snprintf(header, sizeof header,
               "analyze export %s: %zu facets a sphere, volume %.6f of a ball",
               DEM_VERSION, count, share);
  header[length] = ' ';
  fwrite(header, 1, 80, out);
  const uint32_t facets = (uint32_t)(count * b->n);
  write_little_endian(out, &facets, sizeof facets, 1);
  for (size_t i = 0; i < b->n && !ferror(out); i++)
    for (size_t q = 0; q < count; q++) {
      float number[12] = {0};
      double u[3], v[3], normal[3];
      vec3_sub(facet[q] + 3, facet[q], u);
      vec3_sub(facet[q] + 6, facet[q], v);
      vec3_cross(u, v, normal);
      const double norm = vec3_norm(normal);
      for (int k = 0; k < 3; k++)
        number[k] = (float)(normal[k] / norm);
      for (int k = 0; k < 9; k++)
        number[3 + k] =
            (float)(b->x[3 * i + k % 3] + scale * b->r[i] * facet[q][k]);
      static const uint16_t attributes = 0;
      write_little_endian(out, number, sizeof *number, 12);
      write_little_endian(out, &attributes, sizeof attributes, 1);
    }
  free(facet);
  if (!o->quiet)
    warn("%zu facets a sphere, with %.6f of the volume of a ball%s", count,
         share, o->equal_volume ? "" : " (--equal-volume: all of it)");
}
