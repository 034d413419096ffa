/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres, bridges and walls: closed forms, a count along columns that know
   nothing of a bridge's axis, sums over parts of a box. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "geometry/area.h"
#include "geometry/box.h"
#include "geometry/clearance.h"
#include "geometry/solid.h"
#include "geometry/volume.h"

static const double everything[6] = {-9, 9, -9, 9, -9, 9};

static struct solid_volume measured(const struct solid *s,
                                    const double box[6]) {
  struct solid_volume v = {.total = GSL_NAN, .error = GSL_NAN};
  CHECK(solid_volume(s, box, &v) == GSL_SUCCESS);
  return v;
}

/* Collar between two spheres on the z axis by Simpson's rule in long double;
   s = sqrt(r^2 - rho^2) is smooth below X < r. */
static long double collar(long double ra, long double rb, long double d,
                          long double x) {
  const long double foot = (d + (ra - rb) * (ra + rb) / d) / 2;
  const long double from = d < ra + rb ? sqrtl(ra * ra - foot * foot) : 0;
  enum { STEPS = 20000 };
  long double sum = 0;
  for (int i = 0; i <= STEPS; i++) {
    const long double rho = from + (x - from) * i / STEPS;
    const long double length =
        d - sqrtl(ra * ra - rho * rho) - sqrtl(rb * rb - rho * rho);
    sum += rho * length * (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2);
  }
  return 2 * acosl(-1) * sum * (x - from) / STEPS / 3;
}

static void two(gsl_rng *rng, double ra, double rb, double d, double radius,
                long double want) {
  /* anywhere, in any direction */
  double x[6], e[3];
  const double r[2] = {ra, rb};
  static const uint32_t ends[1][2] = {{0, 1}};
  do
    for (int k = 0; k < 3; k++)
      e[k] = 2 * gsl_rng_uniform(rng) - 1;
  while (vec3_norm(e) > 1);
  for (int k = 0; k < 3; k++) {
    x[k] = gsl_rng_uniform(rng);
    x[3 + k] = x[k] + d * e[k] / vec3_norm(e);
  }
  const struct solid s = {.n = 2,
                          .x = x,
                          .r = r,
                          .bridges = 1,
                          .ends = ends,
                          .bridge_radius = radius};
  const struct solid_volume v = measured(&s, everything);
  /* rounding: of d, over the collar's area, of terms of X^2 d, of places */
  const double tol = 32 * DBL_EPSILON * radius * radius * (d + 4);
  CHECK_CLOSE(v.bridges, (double)want, tol);
  CHECK(v.error == 0);
  double united;
  CHECK(volume_union(2, x, r, everything, &united) == GSL_SUCCESS);
  CHECK(v.spheres == united && v.total == v.spheres + v.bridges);
  /* two parts, numerically now */
  double box[6];
  memcpy(box, everything, sizeof box);
  box[1] = x[0];
  const double left = measured(&s, box).bridges;
  const double error = measured(&s, box).error;
  box[0] = x[0];
  box[1] = everything[1];
  const double right = measured(&s, box).bridges;
  CHECK_CLOSE(left + right, v.bridges, error + measured(&s, box).error + tol);
}

static void test_two(gsl_rng *rng) {
  two(rng, 1, 1, 2, 0.3, collar(1, 1, 2, 0.3));         /* touching */
  two(rng, 1, 1, 2.1, 0.3, collar(1, 1, 2.1, 0.3));     /* apart */
  two(rng, 1, 1, 1.99, 0.3, collar(1, 1, 1.99, 0.3));   /* overlapping */
  two(rng, 1, 0.4, 1.4, 0.3, collar(1, 0.4, 1.4, 0.3)); /* unequal */
  two(rng, 1, 0.4, 1.39, 0.3, collar(1, 0.4, 1.39, 0.3));
  two(rng, 1, 1, 1.9, 0.3, 0);    /* within the circle of contact */
  two(rng, 1, 0.5, 0.55, 0.3, 0); /* almost concentric */
  /* touching equal spheres, X << r: 2 rho^2/(2 r) high, pi X^4/(2 r) */
  two(rng, 1, 1, 2, 1e-3, M_PI * 1e-12 / 2 * (1 + 1e-6 / 6));
}

/* The solid in a box by columns along x, count^2 of them. */
static double by_columns(const struct solid *s, const double box[6],
                         size_t count) {
  double(*cut)[2] = calloc(s->n + s->bridges, sizeof *cut), sum = 0;
  static const double e[3] = {1, 0, 0};
  for (size_t j = 0; j < count; j++)
    for (size_t k = 0; k < count; k++) {
      const double at[2] = {((double)j + 0.5) / (double)count,
                            ((double)k + 0.5) / (double)count};
      const double p[3] = {0, box[2] + (box[3] - box[2]) * at[0],
                           box[4] + (box[5] - box[4]) * at[1]};
      size_t cuts = 0;
      for (size_t i = 0; i < s->n; i++)
        cuts += line_ball(s->x + 3 * i, s->r[i], p, e, cut[cuts]);
      for (size_t b = 0; b < s->bridges; b++)
        cuts += solid_line_cylinder(s->x + 3 * s->ends[b][0],
                                    s->x + 3 * s->ends[b][1], s->bridge_radius,
                                    p, e, cut[cuts]);
      double low = box[0], high = box[1], t[2];
      if (s->container) {
        const bool any = container_line(s->container, p, e, t);
        low = any ? fmin(fmax(low, t[0]), high) : high;
        high = any ? fmax(fmin(high, t[1]), low) : high;
        sum += box[1] - box[0] - (high - low);
      }
      sum += solid_covered(cuts, cut, low, high);
    }
  free(cut);
  return sum * (box[3] - box[2]) * (box[5] - box[4]) / (double)(count * count);
}

/* Bridges that cross each other, a third sphere and the box's faces. */
static void test_crossing(gsl_rng *rng) {
  enum { N = 12 };
  double x[3 * N], r[N];
  for (size_t i = 0; i < N; i++) {
    r[i] = 0.15 + 0.05 * gsl_rng_uniform(rng);
    for (int k = 0; k < 3; k++)
      x[3 * i + (size_t)k] = gsl_rng_uniform(rng);
  }
  uint32_t(*ends)[2] = NULL;
  size_t bridges = 0;
  CHECK(solid_pairs(N, x, r, 0.05, &ends, &bridges) == GSL_SUCCESS);
  CHECK(bridges > 5);
  struct solid s = {.n = N,
                    .x = x,
                    .r = r,
                    .bridges = bridges,
                    .ends = (const uint32_t(*)[2])ends,
                    .bridge_radius = 0.1};
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  const size_t visible = solid_visible(&s, ends);
  CHECK(visible < bridges);
  const struct solid_volume all = measured(&s, unit);
  s.bridges = bridges = visible;
  const struct solid_volume v = measured(&s, unit);
  CHECK(v.bridges == all.bridges);
  CHECK(v.bridges > 0.005 && v.error > 0 && v.error < 1e-9);
  struct solid spheres = s;
  spheres.bridges = 0;
  /* Columns miss of a surface what is curved within their spacing, about
     spacing^1.5 at a rim. */
  CHECK_CLOSE(by_columns(&s, unit, 400) - by_columns(&spheres, unit, 400),
              v.bridges, 1e-5);
  CHECK_CLOSE(by_columns(&s, unit, 400), v.total, 1e-5);
  /* eight parts of the box */
  double sum = 0, error = v.error;
  for (int part = 0; part < 8; part++) {
    double box[6];
    for (int k = 0; k < 3; k++) {
      const bool high = part >> k & 1;
      box[2 * k] = high ? 0.45 : 0;
      box[2 * k + 1] = high ? 1 : 0.45;
    }
    const struct solid_volume w = measured(&s, box);
    sum += w.total;
    error += w.error;
  }
  CHECK_CLOSE(sum, v.total, error + 1e-14);
  /* in any order, also with one of them given twice */
  uint32_t(*turned)[2] = calloc(bridges + 1, sizeof *turned);
  for (size_t k = 0; k < bridges; k++) {
    turned[k][0] = ends[bridges - 1 - k][1];
    turned[k][1] = ends[bridges - 1 - k][0];
  }
  memcpy(turned[bridges], ends[0], sizeof *ends);
  struct solid other = s;
  other.ends = (const uint32_t(*)[2])turned;
  other.bridges = bridges + 1;
  const struct solid_volume w = measured(&other, unit);
  CHECK_CLOSE(w.total, v.total, v.error + w.error + 1e-14);
  /* walls: what is beyond is solid */
  static const struct container container = {.box = {0.1, 0.9, -1, 2, 0.2, 3}};
  s.container = &container;
  const struct solid_volume walled = measured(&s, unit);
  static const double within[6] = {0.1, 0.9, 0, 1, 0.2, 1};
  s.container = NULL;
  const struct solid_volume inside = measured(&s, within);
  CHECK_CLOSE(walled.walls, 1 - 0.8 * 0.8, 1e-15);
  CHECK_CLOSE(walled.total, inside.total + 0.36, 1e-14);
  static const double beyond[6] = {-1, 0, 0, 1, 0, 1};
  s.container = &container;
  CHECK(measured(&s, beyond).total == 1 && measured(&s, beyond).walls == 1);
  free(turned);
  free(ends);
}

/* Spheres in a tube. What they have beyond it is the area that they cover of
   shells around it (area.h), by Simpson's rule: a patch shrinks to a point
   linearly, so that the rule loses a few steps at each of the spheres' ends. */
static void test_tube(gsl_rng *rng) {
  enum { N = 24, SOME = 12, STEPS = 400 };
  double x[3 * N], r[N];
  for (size_t i = 0; i < N; i++) {
    r[i] = 0.1 + 0.1 * gsl_rng_uniform(rng);
    const double angle = 2 * M_PI * gsl_rng_uniform(rng);
    /* most of them at the wall, some beyond it, one on the axis */
    const double away = i ? 0.3 + 0.25 * gsl_rng_uniform(rng) : 0;
    x[3 * i] = away * cos(angle);
    x[3 * i + 1] = away * sin(angle);
    x[3 * i + 2] = gsl_rng_uniform(rng);
  }
  r[0] = 0.52;
  struct container tube = container_none();
  tube.radius = 0.5;
  tube.axis[2] = 1;
  struct solid s = {.n = N, .x = x, .r = r, .container = &tube};
  static const double box[6] = {-1, 1, -1, 1, 0.1, 0.9};
  const struct solid_volume v = measured(&s, box);
  double united, sum = 0;
  CHECK(volume_union(N, x, r, box, &united) == GSL_SUCCESS);
  for (int k = 0; k <= STEPS; k++) {
    struct area_shell shell = {{0, 0}, 0.5 + 0.25 * k / STEPS, {0.1, 0.9}};
    double one, covered;
    CHECK(area_shell_covered(N, x, r, &shell, &one, &covered) == GSL_SUCCESS);
    sum += covered * (k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2);
  }
  sum *= 0.25 / STEPS / 3;
  CHECK(united - v.spheres > 0.05);
  CHECK_CLOSE(v.spheres, united - sum, N * gsl_pow_2(0.25 / STEPS));
  CHECK_CLOSE(v.walls, 0.8 * (4 - M_PI / 4), 1e-14);
  CHECK_CLOSE(v.total, v.walls + v.spheres, 1e-14);
  CHECK(v.error < 1e-6);
  /* of one sphere, alone: the sum of four quarters, which planes cut */
  s.n = 1;
  r[0] = 0.1;
  x[0] = 0.45;
  x[1] = 0.01;
  x[2] = 0.5;
  const double alone = measured(&s, box).spheres;
  const double end = hypot(x[0], x[1]) + r[0];
  sum = 0;
  for (int k = 0; k <= STEPS; k++) {
    const struct area_shell shell = {
        {0, 0}, 0.5 + (end - 0.5) * k / STEPS, {0.1, 0.9}};
    double one, covered;
    CHECK(area_shell_covered(1, x, r, &shell, &one, &covered) == GSL_SUCCESS);
    sum += covered * (k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2);
  }
  CHECK_CLOSE(alone, 4 * M_PI / 3e3 - sum * (end - 0.5) / STEPS / 3, 1e-14);
  double quarters = 0, error = 1e-15;
  for (int part = 0; part < 4; part++) {
    const double quarter[6] = {-1,
                               1,
                               part % 2 ? 0.02 : -1,
                               part % 2 ? 1 : 0.02,
                               part / 2 ? 0.52 : 0.1,
                               part / 2 ? 0.9 : 0.52};
    const struct solid_volume q = measured(&s, quarter);
    quarters += q.spheres;
    error += q.error;
  }
  CHECK_CLOSE(quarters, alone, error);
  CHECK(error < 1e-8);
  /* and of a place where all lengths are 64 times as long */
  const double large[6] = {-64, 64, 1.28, 64, 33.28, 57.6};
  double as_small[6];
  for (int k = 0; k < 6; k++)
    as_small[k] = large[k] / 64;
  const struct solid_volume small = measured(&s, as_small);
  tube.radius *= 64;
  r[0] *= 64;
  for (int k = 0; k < 3; k++)
    x[k] *= 64;
  CHECK_REL(measured(&s, large).spheres, 64. * 64 * 64 * small.spheres, 1e-12);
  r[0] /= 64;
  /* leaning, with an end across it, and bridges */
  static const double across[1][4] = {{0.6, 0, -0.8, -0.1}};
  uint32_t(*ends)[2] = NULL;
  for (size_t i = 0; i < SOME; i++)
    for (size_t k = 0; k < 3; k++)
      x[3 * i + k] = gsl_rng_uniform(rng);
  s.n = SOME;
  s.bridge_radius = 0.09;
  CHECK(solid_pairs(SOME, x, r, 0.05, &ends, &s.bridges) == GSL_SUCCESS);
  s.ends = (const uint32_t(*)[2])ends;
  tube = (struct container){
      .box = {0.05, GSL_POSINF, GSL_NEGINF, 0.95, GSL_NEGINF, GSL_POSINF},
      .planes = 1,
      .plane = across,
      .radius = 0.5,
      .point = {0.4, 0.5, 0},
      .axis = {0.28, 0, 0.96}};
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  const struct solid_volume leaning = measured(&s, unit);
  CHECK_CLOSE(by_columns(&s, unit, 300), leaning.total, 2e-5);
  CHECK(leaning.bridges > 1e-5 && leaning.walls > 0.2);
  double sum_parts = 0, errors = leaning.error + 1e-13;
  for (int part = 0; part < 8; part++) {
    double piece[6];
    for (int k = 0; k < 3; k++) {
      piece[2 * k] = part >> k & 1 ? 0.55 : 0;
      piece[2 * k + 1] = part >> k & 1 ? 1 : 0.55;
    }
    const struct solid_volume w = measured(&s, piece);
    sum_parts += w.total;
    errors += w.error;
  }
  CHECK_CLOSE(sum_parts, leaning.total, 1e-7); /* estimates are careful */
  CHECK(errors < 1e-6);
  free(ends);
}

/* Distances and lines agree on what is inside. */
static void test_primitives(gsl_rng *rng) {
  size_t inside = 0;
  for (int m = 0; m < 2000; m++) {
    double a[3], b[3], p[3], e[3], t[2], q[3];
    for (int k = 0; k < 3; k++) {
      a[k] = gsl_rng_uniform(rng);
      b[k] = a[k] + gsl_rng_uniform(rng) - 0.5;
      p[k] = 2 * gsl_rng_uniform(rng) - 0.5;
      e[k] = m % 3 ? 2 * gsl_rng_uniform(rng) - 1 : k == m % 9 / 3;
    }
    const double radius = 0.2 + 0.2 * gsl_rng_uniform(rng);
    for (int what = 0; what < 2; what++) {
#define DISTANCE(y)                                                            \
  (what ? solid_cylinder_distance(a, b, radius, y)                             \
        : solid_ball_distance(a, radius, y))
      const bool meets = what ? solid_line_cylinder(a, b, radius, p, e, t)
                              : line_ball(a, radius, p, e, t);
      bool right = true;
      for (int k = -30; k < 30; k++) {
        const double s = 0.1 * k;
        memcpy(q, p, sizeof q);
        vec3_axpy(s, e, q);
        const bool in = DISTANCE(q) < 0;
        right = right && in == (meets && s > t[0] && s < t[1]);
        inside += in;
      }
      CHECK(right);
      for (int end = 0; end < 2 && meets; end++) {
        memcpy(q, p, sizeof q);
        vec3_axpy(t[end], e, q);
        CHECK_CLOSE(DISTANCE(q), 0, 1e-12);
      }
    }
    /* along the axis, which is a line parallel to the side */
    vec3_sub(b, a, e);
    CHECK(solid_line_cylinder(a, b, radius, a, e, t));
    CHECK_CLOSE(t[0], 0, 1e-12);
    CHECK_CLOSE(t[1], 1, 1e-12);
  }
  CHECK(inside > 300);
  static const double box[6] = {0, 1, 0, 2, 0, 3};
  CHECK(box_distance(box, (double[3]){0.25, 1, 1}) == 0.25);
  CHECK(box_distance(box, (double[3]){0.25, 2.5, 1}) == -0.5);
  double cuts[4][2] = {{3, 4}, {0, 1}, {0.5, 2}, {-5, -4}};
  CHECK(solid_covered(4, cuts, -4.5, 3.5) == 3);
  CHECK(solid_covered(0, cuts, 0, 1) == 0);
}

static void test_shrink(gsl_rng *rng) {
  enum { N = 40 };
  double x[3 * N], r[N];
  for (int m = 0; m < 20; m++) {
    const double gap = m % 4 ? 0.01 * m : 0;
    for (size_t i = 0; i < N; i++) {
      r[i] = 0.2 + 0.2 * gsl_rng_uniform(rng);
      for (int k = 0; k < 3; k++)
        x[3 * i + (size_t)k] = (m < 18 ? 1 : 20) * gsl_rng_uniform(rng);
    }
    double want = 1, factor = GSL_NAN;
    for (size_t i = 0; i < N; i++)
      for (size_t j = 0; j < i; j++) {
        double d[3];
        vec3_sub(x + 3 * i, x + 3 * j, d);
        want = fmin(want, (vec3_norm(d) - gap) / (r[i] + r[j]));
      }
    const int status = solid_shrink(N, x, r, gap, &factor);
    CHECK(status == (want > 0 ? GSL_SUCCESS : GSL_EDOM));
    if (want > 0)
      CHECK_CLOSE(factor, want, 4 * DBL_EPSILON);
    else
      CHECK(isnan(factor));
  }
}

/* The diffuse profile on midpoints, as a solver has it. */
static void test_diffuse(gsl_rng *rng) {
  enum { N = 9, CELLS = 80 };
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  double x[3 * N], r[N];
  for (size_t i = 0; i < N; i++) {
    r[i] = 0.2 + 0.1 * gsl_rng_uniform(rng);
    for (int k = 0; k < 3; k++)
      x[3 * i + (size_t)k] = gsl_rng_uniform(rng);
  }
  for (int m = 1; m < 4; m++) {
    const double xi = 0.03 * m;
    double sum = 0, got = GSL_NAN;
    for (size_t q = 0; q < CELLS * CELLS * CELLS; q++) {
      const double p[3] = {((double)(q % CELLS) + 0.5) / CELLS,
                           ((double)(q / CELLS % CELLS) + 0.5) / CELLS,
                           ((double)(q / CELLS / CELLS) + 0.5) / CELLS};
      double most = 0;
      for (size_t i = 0; i < N; i++)
        most = fmax(
            most,
            (1 - tanh(solid_ball_distance(x + 3 * i, r[i], p) / (2 * xi))) / 2);
      sum += most;
    }
    CHECK(solid_diffuse(N, x, r, unit, xi, &got) == GSL_SUCCESS);
    /* midpoints: h^2/24 times the mean second derivative, below 1/xi^2 */
    CHECK_CLOSE(got, sum / (CELLS * CELLS * CELLS),
                1. / (24 * CELLS * CELLS) / (xi * xi));
  }
  /* xi to 0: the union */
  double united, sharp;
  CHECK(volume_union(N, x, r, unit, &united) == GSL_SUCCESS);
  CHECK(solid_diffuse(N, x, r, unit, 1e-5, &sharp) == GSL_SUCCESS);
  CHECK_CLOSE(sharp, united, 1e-5);
  CHECK(solid_diffuse(N, x, r, unit, 0, &sharp) == GSL_EINVAL);
}

static double distance_to(const struct solid *s, const double box[6],
                          const double p[3]) {
  double d = box_distance(box, p);
  if (s->container)
    d = fmin(d, container_distance(s->container, p));
  for (size_t i = 0; i < s->n; i++)
    d = fmin(d, solid_ball_distance(s->x + 3 * i, s->r[i], p));
  for (size_t b = 0; b < s->bridges; b++)
    d = fmin(d, solid_cylinder_distance(s->x + 3 * s->ends[b][0],
                                        s->x + 3 * s->ends[b][1],
                                        s->bridge_radius, p));
  return d;
}

/* The deepest point of a grid's, which is no more than half a diagonal off. */
static void test_clearance(gsl_rng *rng) {
  enum { N = 30, CELLS = 40 };
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  static const struct container container = {.box = {0.1, 0.8, 0, 1, 0, 1},
                                             .radius = 0.4,
                                             .point = {0.5, 0.5, 0.5},
                                             .axis = {0.6, 0, 0.8}};
  double x[3 * N], r[N], p[3], depth = GSL_NAN;
  for (int m = 0; m < 6; m++) {
    for (size_t i = 0; i < N; i++) {
      r[i] = 0.1 + 0.1 * gsl_rng_uniform(rng);
      for (int k = 0; k < 3; k++)
        x[3 * i + (size_t)k] = gsl_rng_uniform(rng);
    }
    uint32_t(*ends)[2] = NULL;
    struct solid s = {.n = N,
                      .x = x,
                      .r = r,
                      .bridge_radius = 0.07,
                      .container = m % 2 ? &container : NULL};
    CHECK(solid_pairs(N, x, r, 0.1, &ends, &s.bridges) == GSL_SUCCESS);
    s.ends = (const uint32_t(*)[2])ends;
    CHECK(clearance_deepest(&s, unit, p, &depth) == GSL_SUCCESS);
    CHECK_CLOSE(distance_to(&s, unit, p), depth, 1e-15);
    double best = 0;
    for (size_t q = 0; q < CELLS * CELLS * CELLS; q++) {
      const double at[3] = {((double)(q % CELLS) + 0.5) / CELLS,
                            ((double)(q / CELLS % CELLS) + 0.5) / CELLS,
                            ((double)(q / CELLS / CELLS) + 0.5) / CELLS};
      best = fmax(best, distance_to(&s, unit, at));
    }
    CHECK(depth > best / 1.01 && depth < best + sqrt(3) / 2 / CELLS);
    free(ends);
  }
  /* an empty box, and a full one */
  const struct solid none = {0};
  CHECK(clearance_deepest(&none, unit, p, &depth) == GSL_SUCCESS);
  CHECK(depth > 0.5 / 1.01 && depth <= 0.5);
  static const double middle[3] = {0.5, 0.5, 0.5}, large[1] = {1};
  const struct solid full = {.n = 1, .x = middle, .r = large};
  CHECK(clearance_deepest(&full, unit, p, &depth) == GSL_EDOM);
  static const double flat[6] = {0, 1, 0, 1, 1, 1};
  CHECK(clearance_deepest(&none, flat, p, &depth) == GSL_EINVAL);
}

static void test_refusals(void) {
  static const double x[6] = {0, 0, 0, 0, 0, 2}, r[2] = {1, 0.5};
  static const uint32_t ends[1][2] = {{0, 1}};
  struct solid s = {
      .n = 2, .x = x, .r = r, .bridges = 1, .ends = ends, .bridge_radius = 0.5};
  struct solid_volume v = {.total = 7};
  CHECK(solid_volume(&s, everything, &v) == GSL_EDOM && v.total == 7);
  s.bridge_radius = GSL_NAN;
  CHECK(solid_volume(&s, everything, &v) == GSL_EDOM && v.total == 7);
  const double bad[6] = {0, GSL_NAN, 0, 0, 0, 2};
  s.bridge_radius = 0.1;
  s.x = bad;
  CHECK(solid_volume(&s, everything, &v) == GSL_EINVAL && v.total == 7);
  s.x = NULL;
  s.n = s.bridges = 0;
  CHECK(measured(&s, everything).total == 0);
}

int main(void) {
  gsl_set_error_handler_off();
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 1);
  test_two(rng);
  test_crossing(rng);
  test_tube(rng);
  test_primitives(rng);
  test_shrink(rng);
  test_diffuse(rng);
  test_clearance(rng);
  test_refusals();
  gsl_rng_free(rng);
  return check_done();
}
