/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Planes and a tube: volumes in closed form, sums over parts of a box, columns;
   lines and distances against each other. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "geometry/area.h"
#include "geometry/container.h"

static double measured(const struct container *c, const double box[6]) {
  double volume = GSL_NAN;
  CHECK(container_volume(c, box, &volume) == GSL_SUCCESS);
  return volume;
}

static void unit_vector(gsl_rng *rng, double e[3]) {
  do
    for (int k = 0; k < 3; k++)
      e[k] = 2 * gsl_rng_uniform(rng) - 1;
  while (vec3_norm(e) > 1 || vec3_norm(e) < 0.1);
  const double norm = vec3_norm(e);
  for (int k = 0; k < 3; k++)
    e[k] /= norm;
}

/* Rounding is that of the whole disc, slice by slice. */
static const double rounding = 64 * DBL_EPSILON;

static void test_closed_forms(void) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  struct container c = container_none();
  CHECK(measured(&c, unit) == 1);
  c.box[0] = 0.25;
  c.box[5] = 0.5;
  CHECK(measured(&c, unit) == 0.375);
  c.box[1] = 0.25;
  CHECK(measured(&c, unit) == 0);
  /* upright, inside of the box and cut by its sides */
  c = container_none();
  c.radius = 0.4;
  c.axis[2] = 1;
  c.point[0] = c.point[1] = 0.5;
  c.point[2] = 77;
  CHECK_CLOSE(measured(&c, unit), M_PI * 0.16, rounding);
  c.radius = 0.6;
  double area;
  CHECK(area_union(1, c.point, &c.radius, unit, &area) == GSL_SUCCESS);
  CHECK_CLOSE(measured(&c, unit), area, rounding);
  c.point[0] = 3;
  CHECK(measured(&c, unit) == 0);
  /* leaning through a slab: as long as the slab is thick along it */
  static const double slab[6] = {-9, 9, -9, 9, -1, 0.5};
  c = (struct container){.box = {-8, 8, -8, 8, GSL_NEGINF, GSL_POSINF},
                         .radius = 0.7,
                         .point = {1, 2, 3},
                         .axis = {0.36, 0.48, 0.8}};
  CHECK_CLOSE(measured(&c, slab), M_PI * 0.49 * 1.5 / 0.8, 64 * rounding);
  /* and ended by a plane across it, whose middle is the tube's */
  static const double end[1][4] = {{0.36, 0.48, 0.8, 3.72}};
  c.planes = 1;
  c.plane = end;
  static const double tall[6] = {-9, 9, -9, 9, -1, 9};
  /* its middle is where the axis is at 3.72 along itself, and at -5 of the
     height -1 */
  CHECK_CLOSE(measured(&c, tall), M_PI * 0.49 * 5, 64 * rounding);
  /* the corner beyond a plane, h^3/6 by the plane x + y + z = h, and a
     hexagon's half */
  static const double corner[1][4] = {{0.57735026918962573, 0.57735026918962573,
                                       0.57735026918962573,
                                       0.57735026918962573 / 2}};
  c = container_none();
  c.planes = 1;
  c.plane = corner;
  CHECK_CLOSE(measured(&c, unit), 1. / 48, rounding);
  static const double half[1][4] = {{0.57735026918962573, 0.57735026918962573,
                                     0.57735026918962573,
                                     0.57735026918962573 * 1.5}};
  c.plane = half;
  CHECK_CLOSE(measured(&c, unit), 0.5, rounding);
  /* numbers that are not finite, and a box without volume */
  double volume = 7;
  static const double flat[6] = {0, 1, 0, 1, 1, 1};
  CHECK(measured(&c, flat) == 0);
  c.radius = GSL_NAN;
  CHECK(container_volume(&c, unit, &volume) == GSL_EINVAL && volume == 7);
  static const double bad[6] = {0, GSL_NAN, 0, 1, 0, 1};
  c = container_none();
  CHECK(container_volume(&c, bad, &volume) == GSL_EINVAL && volume == 7);
}

/* Columns along x, count^2 of them. */
static double by_columns(const struct container *c, const double box[6],
                         int count) {
  static const double e[3] = {1, 0, 0};
  double sum = 0, t[2];
  for (int j = 0; j < count; j++)
    for (int k = 0; k < count; k++) {
      const double p[3] = {0, box[2] + (box[3] - box[2]) * (j + 0.5) / count,
                           box[4] + (box[5] - box[4]) * (k + 0.5) / count};
      if (container_line(c, p, e, t))
        sum += fmax(0, fmin(t[1], box[1]) - fmax(t[0], box[0]));
    }
  return sum * (box[3] - box[2]) * (box[5] - box[4]) / count / count;
}

static void test_random(gsl_rng *rng) {
  static const double box[6] = {-0.5, 0.75, 0, 1, -0.25, 1};
  double plane[3][4];
  size_t some = 0;
  for (int m = 0; m < 60; m++) {
    struct container c = container_none();
    c.planes = (size_t)(m % 4);
    c.plane = (const double(*)[4])plane;
    for (size_t k = 0; k < 3; k++) {
      unit_vector(rng, plane[k]);
      plane[k][3] = gsl_rng_uniform(rng) - 0.2;
    }
    if (m % 3) {
      c.radius = 0.2 + 0.6 * gsl_rng_uniform(rng);
      unit_vector(rng, c.axis);
      for (int k = 0; k < 3; k++)
        c.point[k] = gsl_rng_uniform(rng);
    }
    if (m % 5 == 0)
      c.box[3] = 0.7;
    const double whole = measured(&c, box);
    some += whole > 0.1 && whole < 1;
    /* a column sees of a curved or slanting side what is within its width */
    CHECK_CLOSE(by_columns(&c, box, 300), whole, 1e-4);
    double sum = 0;
    for (int part = 0; part < 8; part++) {
      double piece[6];
      for (int k = 0; k < 3; k++) {
        piece[2 * k] = part >> k & 1 ? 0.31 : box[2 * k];
        piece[2 * k + 1] = part >> k & 1 ? box[2 * k + 1] : 0.31;
      }
      sum += measured(&c, piece);
    }
    CHECK_CLOSE(sum, whole, 1e-13);
    /* of grains of sand: all lengths by 2^-10 */
    double tiny[6];
    for (int k = 0; k < 6; k++) {
      tiny[k] = box[k] / 1024;
      c.box[k] /= 1024;
    }
    for (int k = 0; k < 3; k++) {
      plane[k][3] /= 1024;
      c.point[k] /= 1024;
    }
    c.radius /= 1024;
    CHECK_REL(measured(&c, tiny) * gsl_pow_3(1024), whole, 1e-13);
  }
  CHECK(some > 20);
}

/* Distances and lines agree on what is inside. */
static void test_lines(gsl_rng *rng) {
  double plane[2][4];
  size_t inside = 0;
  for (int m = 0; m < 2000; m++) {
    struct container c = container_none();
    c.planes = 2;
    c.plane = (const double(*)[4])plane;
    for (size_t k = 0; k < 2; k++) {
      unit_vector(rng, plane[k]);
      plane[k][3] = gsl_rng_uniform(rng);
    }
    c.radius = 0.5;
    unit_vector(rng, c.axis);
    c.box[m % 6] = m % 2 ? 0.5 : -0.5;
    double p[3], e[3], t[2], q[3];
    unit_vector(rng, e);
    for (int k = 0; k < 3; k++)
      p[k] = gsl_rng_uniform(rng) - 0.5;
    if (m % 7 == 0)
      memcpy(e, c.axis, sizeof e);
    const bool meets = container_line(&c, p, e, t);
    bool right = true;
    for (int k = -30; k < 30; k++) {
      memcpy(q, p, sizeof q);
      vec3_axpy(0.1 * k, e, q);
      const bool in = container_distance(&c, q) > 0;
      right = right && in == (meets && 0.1 * k > t[0] && 0.1 * k < t[1]);
      inside += in;
    }
    CHECK(right);
    for (int end = 0; end < 2 && meets && isfinite(t[end]); end++) {
      memcpy(q, p, sizeof q);
      vec3_axpy(t[end], e, q);
      CHECK_CLOSE(container_distance(&c, q), 0, 1e-12);
    }
    CHECK(container_slants(&c));
  }
  CHECK(inside > 300);
}

int main(void) {
  gsl_set_error_handler_off();
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 1);
  test_closed_forms();
  test_random(rng);
  test_lines(rng);
  gsl_rng_free(rng);
  return check_done();
}
