/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed surfaces of unions: every edge in two triangles, in opposite
   directions, no two corners in one place, the right numbers of holes, and
   volumes that converge to the exact ones. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "geometry/surface.h"

/* Corners as STL keeps them. */
struct mesh {
  size_t count, size;
  float (*corner)[3][3];
};

static void keep(const double corner[3][3], void *context) {
  struct mesh *m = context;
  if (m->count == m->size) {
    m->size = 2 * m->size + 1024;
    m->corner = realloc(m->corner, m->size * sizeof *m->corner);
  }
  for (int k = 0; k < 9; k++)
    m->corner[m->count][k / 3][k % 3] = (float)corner[k / 3][k % 3];
  m->count++;
}

static int compare_edges(const void *a, const void *b) {
  return memcmp(a, b, 6 * sizeof(float));
}

static int compare_corners(const void *a, const void *b) {
  return memcmp(a, b, 3 * sizeof(float));
}

/* Is every edge passed once in each direction? *euler: corners less edges plus
   triangles, 2 for a ball, 0 for a ring. */
static bool manifold(const struct mesh *m, long *euler) {
  const size_t n = 3 * m->count;
  float(*edge)[6] = calloc(n, sizeof *edge),
  (*back)[6] = calloc(n, sizeof *back);
  float(*corner)[3] = calloc(n, sizeof *corner);
  for (size_t i = 0; i < n; i++) {
    const float *p = m->corner[i / 3][i % 3],
                *q = m->corner[i / 3][(i + 1) % 3];
    memcpy(edge[i], p, sizeof *corner);
    memcpy(edge[i] + 3, q, sizeof *corner);
    memcpy(back[i], q, sizeof *corner);
    memcpy(back[i] + 3, p, sizeof *corner);
    memcpy(corner[i], p, sizeof *corner);
  }
  qsort(edge, n, sizeof *edge, compare_edges);
  qsort(back, n, sizeof *back, compare_edges);
  qsort(corner, n, sizeof *corner, compare_corners);
  bool ok = true;
  long corners = 0;
  for (size_t i = 0; i < n; i++) {
    ok = ok && !compare_edges(edge[i], back[i]) &&
         (i == 0 || compare_edges(edge[i], edge[i - 1])) &&
         compare_corners(edge[i], edge[i] + 3);
    corners += i == 0 || compare_corners(corner[i], corner[i - 1]);
  }
  *euler = corners - (long)n / 2 + (long)m->count;
  free(corner);
  free(back);
  free(edge);
  return ok;
}

static double mesh_volume(const struct mesh *m) {
  double six = 0;
  for (size_t i = 0; i < m->count; i++) {
    double p[3][3], cross[3];
    for (int k = 0; k < 9; k++)
      p[k / 3][k % 3] = m->corner[i][k / 3][k % 3];
    vec3_cross(p[0], p[1], cross);
    six += vec3_dot(cross, p[2]);
  }
  return six / 6;
}

/* The region of a solid without walls. */
static void bounds(const struct solid *s, double box[6]) {
  for (int k = 0; k < 3; k++) {
    box[2 * k] = GSL_POSINF;
    box[2 * k + 1] = GSL_NEGINF;
    for (size_t i = 0; i < s->n; i++) {
      box[2 * k] = fmin(box[2 * k], s->x[3 * i + (size_t)k] - s->r[i]);
      box[2 * k + 1] = fmax(box[2 * k + 1], s->x[3 * i + (size_t)k] + s->r[i]);
    }
  }
}

/* The volume by a number of cells; checks the surface. euler: NULL if unknown.
 */
static double surface_case(const struct solid *s, const double *clip,
                           size_t cells, const long *euler) {
  double box[6];
  if (clip)
    memcpy(box, clip, sizeof box);
  else
    bounds(s, box);
  struct surface *f = NULL;
  struct mesh m = {0};
  size_t counted = 0, walked = 0;
  CHECK(surface_open(&f, s, box, clip != NULL, cells) == GSL_SUCCESS);
  CHECK(surface_walk(f, NULL, NULL, &counted) == GSL_SUCCESS);
  CHECK(surface_walk(f, keep, &m, &walked) == GSL_SUCCESS);
  CHECK(counted == walked && walked == m.count && m.count > 0);
  long found;
  CHECK(manifold(&m, &found));
  if (euler)
    CHECK(found == *euler);
  const double volume = mesh_volume(&m);
  surface_close(f);
  free(m.corner);
  return volume;
}

static double exact(const struct solid *s, const double box[6]) {
  struct solid_volume v = {.total = GSL_NAN};
  CHECK(solid_volume(s, box, &v) == GSL_SUCCESS);
  return v.total;
}

static const long ball = 2, ring = 0;

/* One ball: what is missing falls with the square of the step, and is at most
   (step/r)^2 / 3 of the volume. */
static void test_ball(void) {
  static const double x[3] = {0.1, -0.2, 0.3}, r[1] = {0.7};
  const struct solid s = {.n = 1, .x = x, .r = r};
  const double volume = 4 * M_PI / 3 * gsl_pow_3(0.7);
  double before = 0;
  for (size_t cells = 10; cells <= 40; cells *= 2) {
    const double missing = 1 - surface_case(&s, NULL, cells, &ball) / volume;
    const double step = 2. / (double)cells;
    CHECK(missing > 0 && missing < step * step / 3);
    CHECK(before == 0 || (before / missing > 3.4 && before / missing < 4.6));
    before = missing;
  }
}

/* Nodes on the surface to the last bit, in numbers that binary holds. */
static void test_ties(void) {
  static const double x[6] = {0.5, 0.5, 0.5, 0.5, 0.5, 1.5}, r[2] = {0.5, 0.5};
  static const double unit[6] = {-0.0625, 1.0625,  -0.0625,
                                 1.0625,  -0.0625, 2.0625};
  static const uint32_t ends[1][2] = {{0, 1}};
  struct solid s = {.n = 2, .x = x, .r = r};
  surface_case(&s, unit, 17, NULL); /* touching in a node */
  surface_case(&s, unit, 34, NULL);
  s.ends = ends;
  s.bridges = 1;
  s.bridge_radius = 0.25;
  surface_case(&s, unit, 17, &ball);
  surface_case(&s, unit, 34, &ball);
  /* two that touch are two, or one with a thin neck */
  s.bridges = 0;
  surface_case(&s, NULL, 30, NULL);
}

static void test_shapes(void) {
  enum { N = 8 };
  double x[3 * N], r[N];
  uint32_t ends[N][2];
  for (size_t i = 0; i < N; i++) {
    const double angle = 2 * M_PI * (double)i / N + 0.1;
    x[3 * i] = cos(angle);
    x[3 * i + 1] = sin(angle);
    x[3 * i + 2] = 0.3 * cos(angle);
    r[i] = 0.3;
    ends[i][0] = (uint32_t)i;
    ends[i][1] = (uint32_t)((i + 1) % N);
  }
  struct solid s = {.n = N,
                    .x = x,
                    .r = r,
                    .bridges = N,
                    .ends = (const uint32_t(*)[2])ends,
                    .bridge_radius = 0.15};
  double box[6];
  bounds(&s, box);
  const double volume = exact(&s, box);
  CHECK_REL(surface_case(&s, NULL, 60, &ring), volume, 0.04);
  s.bridges--; /* open it */
  CHECK_REL(surface_case(&s, NULL, 60, &ball), exact(&s, box), 0.04);
  s.bridges = 0; /* eight balls */
  const long balls = N * ball;
  CHECK_REL(surface_case(&s, NULL, 60, &balls), exact(&s, box), 0.04);
  /* half a ring, closed by the box */
  static const double half[6] = {0, 2, -2, 2, -2, 2};
  s.bridges = N;
  CHECK_REL(surface_case(&s, half, 150, &ball), exact(&s, half), 0.04);
}

/* A crowd, whole, clipped and within walls. */
static void test_crowd(gsl_rng *rng) {
  enum { N = 30 };
  double x[3 * N], r[N], box[6];
  for (size_t i = 0; i < N; i++) {
    r[i] = 0.1 + 0.05 * gsl_rng_uniform(rng);
    for (int k = 0; k < 3; k++)
      x[3 * i + (size_t)k] = gsl_rng_uniform(rng);
  }
  uint32_t(*ends)[2] = NULL;
  struct solid s = {.n = N, .x = x, .r = r, .bridge_radius = 0.05};
  CHECK(solid_pairs(N, x, r, 0.02, &ends, &s.bridges) == GSL_SUCCESS);
  s.ends = (const uint32_t(*)[2])ends;
  static const double part[6] = {0.1, 0.9, 0.05, 1.1, -0.1, 0.8};
  static const double outer[6] = {-0.2, 1.2, -0.2, 1.2, -0.2, 1};
  static const struct container inner = {
      .box = {0, 1, 0, 1, 0, GSL_POSINF}};
  /* a tube that leans, with an end across it */
  static const double end[1][4] = {{0.6, 0, -0.8, 0.1}};
  static const struct container tube = {
      .box = {GSL_NEGINF, GSL_POSINF, GSL_NEGINF, GSL_POSINF, 0, GSL_POSINF},
      .planes = 1,
      .plane = end,
      .radius = 0.45,
      .point = {0.4, 0.5, 0},
      .axis = {-0.28, 0, 0.96}};
  bounds(&s, box);
  const double whole = exact(&s, box), clipped = exact(&s, part);
  struct solid walled = s;
  walled.container = &inner;
  struct solid tubed = s;
  tubed.container = &tube;
  const double in_walls = exact(&walled, outer), in_tube = exact(&tubed, outer);
  for (size_t cells = 40; cells <= 80; cells *= 2) {
    const double step = 1.4 / (double)cells / 0.1;
    const double a = surface_case(&s, NULL, cells, NULL) / whole - 1;
    const double b = surface_case(&s, part, cells, NULL) / clipped - 1;
    const double c = surface_case(&walled, outer, cells, NULL) / in_walls - 1;
    const double d = surface_case(&tubed, outer, cells, NULL) / in_tube - 1;
    CHECK(fabs(a) < step * step / 3);
    CHECK(fabs(b) < step * step / 3);
    CHECK(fabs(c) < step * step / 3);
    CHECK(fabs(d) < step * step / 3);
  }
  free(ends);
}

static void test_refusals(void) {
  static const double x[3] = {0, 0, GSL_NAN}, r[1] = {1};
  static const double unit[6] = {0, 1, 0, 1, 0, 1},
                      flat[6] = {0, 1, 0, 0, 0, 1};
  const struct solid s = {.n = 1, .x = x, .r = r}, none = {0};
  struct surface *f = NULL;
  CHECK(surface_open(&f, &s, unit, false, 10) == GSL_EINVAL);
  CHECK(surface_open(&f, &none, flat, false, 10) == GSL_EINVAL);
  CHECK(surface_open(&f, &none, unit, false, 0) == GSL_EINVAL);
  CHECK(surface_open(&f, &none, unit, false, 1000000000) == GSL_ENOMEM);
  CHECK(f == NULL);
  size_t count = 7;
  CHECK(surface_open(&f, &none, unit, false, 10) == GSL_SUCCESS);
  CHECK(surface_walk(f, NULL, NULL, &count) == GSL_SUCCESS && count == 0);
  CHECK(surface_step(f) == 0.1);
  surface_close(f);
}

int main(void) {
  gsl_set_error_handler_off();
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_ball();
  test_ties();
  test_shapes();
  test_crowd(rng);
  test_refusals();
  gsl_rng_free(rng);
  return check_done();
}
