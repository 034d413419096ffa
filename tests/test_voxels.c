/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Voxel grids: one cell against the closed form of an octant in long double;
   grids against volume_ball_box, volume_union and volume_sampled; distances
   against all spheres. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "geometry/ball_cell.h"
#include "check.h"
#include "geometry/volume.h"
#include "geometry/voxels.h"

/* --- one ball, one cell ----------------------------------------------------
 */

static long double root(long double x) {
  return x > 0 ? sqrtl(x) : 0;
}

/* Volume of {x > a, y > b, z > c} in a ball of radius r about the origin, for
   a, b, c >= 0. The cone over its part of the sphere less those over its flat
   faces: S r/3 - sum a A/3. S by Gauss-Bonnet: the angles at the corners less
   pi, and each side turns by a/r times its angle phi. */
static long double octant(long double r, const long double p[3]) {
  const long double pi = acosl(-1), r2 = r * r;
  if (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] >= r2)
    return 0;
  long double excess = -pi, sides = 0, faces = 0;
  for (int k = 0; k < 3; k++) {
    const long double a = p[k], b = p[(k + 1) % 3], c = p[(k + 2) % 3];
    const long double rho2 = r2 - a * a, rho = root(rho2);
    const long double phi = acosl(b / rho) - asinl(c / rho);
    const long double area = (rho2 * phi - b * (root(rho2 - b * b) - c) -
                              c * (root(rho2 - c * c) - b)) /
                             2;
    excess += acosl(a * b / (rho * root(r2 - b * b)));
    sides += a / r * phi;
    faces += a * area;
  }
  return (r2 * r * (excess - sides) - faces) / 3;
}

/* Ball about the origin in a box, by the octants at the corners of its parts in
   each octant of space. */
static long double oracle(long double r, const double box[6]) {
  long double sum = 0;
  for (int part = 0; part < 8; part++) {
    long double low[3], high[3];
    bool empty = false;
    for (int k = 0; k < 3; k++) {
      const bool turned = part >> k & 1;
      low[k] = fmax(0, turned ? -box[2 * k + 1] : box[2 * k]);
      high[k] = turned ? -box[2 * k] : box[2 * k + 1];
      empty = empty || low[k] >= high[k];
    }
    for (int corner = 0; corner < 8 && !empty; corner++) {
      long double p[3], sign = 1;
      for (int k = 0; k < 3; k++) {
        const bool far = corner >> k & 1;
        p[k] = far ? high[k] : low[k];
        sign = far ? -sign : sign;
      }
      sum += sign * octant(r, p);
    }
  }
  return sum;
}

static void cell_case(const struct ball_cell *q, const double c[3], double r,
                      const double cell[6]) {
  static const double origin[3];
  double box[6], volume = 1, longest = 0, shortest = HUGE_VAL;
  for (int k = 0; k < 3; k++) {
    /* the oracle's box as the function sees it */
    box[2 * k] = cell[2 * k] - c[k];
    box[2 * k + 1] = cell[2 * k + 1] - c[k];
    const double side = box[2 * k + 1] - box[2 * k];
    volume *= side;
    longest = fmax(longest, side);
    shortest = fmin(shortest, side);
  }
  const double want = (double)oracle(r, box);
  const double got = ball_cell_volume(q, origin, r, box);
  /* A surface that is off by an ulp or two of r, over the cell's largest face.
     Where cells are coarse, the closed form's rounding, some ulps of r^3. The
     oracle's own is that of long double. */
  const double local = 8 * DBL_EPSILON * r / shortest * volume;
  const double coarse = longest > r / 12 ? 16 * DBL_EPSILON * r * r * r : 0;
  const double own = 16 * (double)LDBL_EPSILON * r * r * r;
  CHECK_CLOSE(got, want, local + coarse + own);
  /* and where the cell is, at the rounding of its place */
  CHECK_CLOSE(ball_cell_volume(q, c, r, cell), want, local + coarse + own);
  /* all lengths by a power of two: no bit changes */
  for (int k = 0; k < 6; k++)
    box[k] *= 64;
  CHECK(ball_cell_volume(q, origin, 64 * r, box) == 64. * 64 * 64 * got);
}

static void random_cells(gsl_rng *rng, const struct ball_cell *q, double h,
                         const double shape[3], int count) {
  for (int m = 0; m < count; m++) {
    const double c[3] = {gsl_rng_uniform(rng), gsl_rng_uniform(rng),
                         gsl_rng_uniform(rng)};
    double u[3], norm = 0, cell[6];
    for (int k = 0; k < 3; k++) {
      /* near an axis or a plane of axes now and then */
      u[k] = gsl_rng_uniform(rng) - 0.5;
      u[k] *= gsl_rng_uniform(rng) < 0.3 ? h : 1;
      norm += u[k] * u[k];
    }
    for (int k = 0; k < 3; k++) {
      cell[2 * k] =
          c[k] + u[k] / sqrt(norm) - h * shape[k] * gsl_rng_uniform(rng);
      cell[2 * k + 1] = cell[2 * k] + h * shape[k];
    }
    cell_case(q, c, 1, cell);
  }
}

static void test_cell(gsl_rng *rng) {
  struct ball_cell q;
  CHECK(ball_cell_init(&q) == GSL_SUCCESS);
  static const double cube[3] = {1, 1, 1}, plate[3] = {1, 0.7, 0.2},
                      rod[3] = {0.3, 0.2, 1};
  for (double h = 1; h > 2e-3; h *= 0.6) {
    random_cells(rng, &q, h, cube, 300);
    random_cells(rng, &q, h, plate, 100);
    random_cells(rng, &q, h, rod, 100);
  }
  /* at a pole, where a circle small against the cell turns a long way in it */
  for (int m = 0; m < 3000; m++) {
    const double h = 0.1 * pow(2, -3 * gsl_rng_uniform(rng));
    double cell[6];
    for (int k = 0; k < 2; k++) {
      cell[2 * k] = -h * gsl_rng_uniform(rng);
      cell[2 * k + 1] = cell[2 * k] + h;
    }
    cell[4] = 1 - h * h / 2 * gsl_rng_uniform(rng);
    cell[5] = cell[4] + h;
    static const double origin[3];
    const double want = (double)oracle(1, cell);
    /* of what is there, unlike in cell_case: 1e-16 of it by the rule, a plane
       that is off by an ulp, the oracle's own */
    const double flat = h * h * DBL_EPSILON;
    CHECK_CLOSE(ball_cell_volume(&q, origin, 1, cell), want,
                1e-14 * want + flat + 16 * (double)LDBL_EPSILON);
  }
  /* cells that meet the sphere in a point or along an edge only, and at the
     poles, with faces through the centre */
  static const double c[3] = {0, 0, 0};
  const double h = 1.0 / 64;
  for (int i = -2; i < 2; i++)
    for (int j = -2; j < 2; j++)
      for (int k = 62; k < 66; k++)
        for (int axis = 0; axis < 3; axis++)
          for (int sign = -1; sign <= 1; sign += 2) {
            double cell[6];
            const int low[3] = {i, j, sign > 0 ? k : -k - 1};
            for (int m = 0; m < 3; m++) {
              cell[2 * ((axis + 1 + m) % 3)] = h * low[m];
              cell[2 * ((axis + 1 + m) % 3) + 1] = h * (low[m] + 1);
            }
            cell_case(&q, c, 1, cell);
          }
}

/* --- grids -----------------------------------------------------------------
 */

struct spheres {
  size_t n;
  double x[3 * 64], r[64];
};

static struct solid solid_of(const struct spheres *s) {
  return (struct solid){.n = s->n, .x = s->x, .r = s->r};
}

static struct spheres random_spheres(gsl_rng *rng, size_t n, double low,
                                     double high) {
  struct spheres s = {.n = n};
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 3; k++)
      s.x[3 * i + k] = 1.4 * gsl_rng_uniform(rng) - 0.2;
    s.r[i] = low + (high - low) * gsl_rng_uniform(rng);
  }
  return s;
}

static double *solid_grid(const struct solid *s, const double box[6],
                          const size_t cells[3], enum voxels_value what,
                          size_t threads, size_t rows) {
  double *value = calloc(cells[0] * cells[1] * cells[2], sizeof *value);
  struct voxels *v;
  if (!CHECK(voxels_open(&v, s, box, cells) == GSL_SUCCESS))
    return value;
  for (size_t k = 0; k < cells[2]; k++)
    for (size_t j = 0; j < cells[1]; j += rows) {
      const size_t end = j + rows < cells[1] ? j + rows : cells[1];
      CHECK(voxels_rows(v, what, k, j, end, threads,
                        value + (k * cells[1] + j) * cells[0]) == GSL_SUCCESS);
    }
  voxels_close(v);
  return value;
}

static double *grid(const struct spheres *s, const double box[6],
                    const size_t cells[3], enum voxels_value what,
                    size_t threads, size_t rows) {
  const struct solid solid = solid_of(s);
  return solid_grid(&solid, box, cells, what, threads, rows);
}

static double sum_of(const double *value, size_t count) {
  long double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += value[i];
  return (double)sum;
}

/* Cells add up to the union; each is the union's part in it. */
static void fraction_case(const struct spheres *s, const double box[6],
                          const size_t cells[3]) {
  const size_t count = cells[0] * cells[1] * cells[2];
  double *f = grid(s, box, cells, VOXELS_FRACTION, 1, cells[1]);
  double whole = 1, united, largest = 0;
  for (int k = 0; k < 3; k++)
    whole *= (box[2 * k + 1] - box[2 * k]) / (double)cells[k];
  CHECK(volume_union(s->n, s->x, s->r, box, &united) == GSL_SUCCESS);
  CHECK_REL(sum_of(f, count) * whole, united, 1e-12);
  for (size_t i = 0; i < s->n; i++)
    largest = fmax(largest, s->r[i]);
  /* the rounding of volume_union for a ball, for those near a cell */
  const double tol = 64 * DBL_EPSILON * largest * largest * largest / whole;
  double worst = 0;
  bool inside = true;
  for (size_t m = 0; m < count; m++) {
    const size_t at[3] = {m % cells[0], m / cells[0] % cells[1],
                          m / cells[0] / cells[1]};
    double cell[6], part;
    for (int k = 0; k < 3; k++) {
      const double h = (box[2 * k + 1] - box[2 * k]) / (double)cells[k];
      cell[2 * k] = box[2 * k] + h * (double)at[k];
      cell[2 * k + 1] = box[2 * k] + h * (double)(at[k] + 1);
    }
    inside = inside && f[m] >= 0 && f[m] <= 1;
    if (volume_union(s->n, s->x, s->r, cell, &part) != GSL_SUCCESS)
      part = NAN;
    const double d = fabs(f[m] - part / whole);
    worst = d <= worst ? worst : d; /* NaN stays */
  }
  CHECK(inside);
  CHECK_CLOSE(worst, 0, tol);
  free(f);
}

static void test_fraction(gsl_rng *rng) {
  static const double unit[6] = {0, 1, 0, 1, 0, 1},
                      odd[6] = {-0.1, 0.8, 0.2, 1.4, 0.05, 0.6};
  static const size_t cells[][3] = {{1, 1, 1},   {2, 3, 5},   {16, 16, 16},
                                    {40, 7, 13}, {3, 40, 20}, {24, 24, 24}};
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
    const struct spheres few = random_spheres(rng, 5, 0.1, 0.3);
    const struct spheres some = random_spheres(rng, 40, 0.02, 0.25);
    const struct spheres large = random_spheres(rng, 3, 0.5, 1.5);
    fraction_case(&few, unit, cells[i]);
    fraction_case(&some, odd, cells[i]);
    fraction_case(&large, unit, cells[i]);
  }
  /* alike, one in another, touching, on the faces of cells, of no size */
  static const size_t eight[3] = {8, 8, 8};
  const struct spheres special = {7,
                                  {0.5,  0.5,  0.5,  0.5,  0.5,  0.5,  0.5,
                                   0.5,  0.55, 0.25, 0.25, 0.25, 0.75, 0.25,
                                   0.25, 0,    0,    0,    0.9,  0.9,  0.9},
                                  {0.25, 0.25, 0.1, 0.25, 0.25, 0.125, 0}};
  fraction_case(&special, unit, eight);
  const struct spheres none = {0};
  fraction_case(&none, unit, eight);
  const struct spheres outside = {1, {3, 3, 3}, {1}};
  fraction_case(&outside, unit, eight);
  const struct spheres around = {1, {0.5, 0.5, 0.5}, {9}};
  double *f = grid(&around, unit, eight, VOXELS_FRACTION, 1, 8);
  for (size_t i = 0; i < 512; i++)
    CHECK(f[i] == 1);
  free(f);
}

/* A fine grid: one sphere, whose cells the closed form knows. */
static void test_fine(void) {
  const struct spheres s = {1, {0.501, 0.498, 0.5}, {0.4}};
  static const double unit[6] = {0, 1, 0, 1, 0, 1};
  static const size_t cells[3] = {128, 128, 128};
  double *f = grid(&s, unit, cells, VOXELS_FRACTION, 2, 128);
  const double count = 128.0 * 128 * 128;
  CHECK_REL(sum_of(f, (size_t)count) / count, 4 * M_PI / 3 * 0.4 * 0.4 * 0.4,
            1e-13);
  free(f);
}

static void test_midpoint(gsl_rng *rng) {
  static const double box[6] = {-0.1, 0.8, 0.2, 1.1, 0.05, 0.95};
  static const size_t cells[3] = {30, 30, 30};
  for (int round = 0; round < 3; round++) {
    const struct spheres s = random_spheres(rng, 30, 0.05, 0.25);
    double *f = grid(&s, box, cells, VOXELS_MIDPOINT, 1, 30);
    double sum, united, whole = 0.9 * 0.9 * 0.9 / 27000;
    CHECK(volume_sampled(s.n, s.x, s.r, box, 30, NULL, &sum, &united) ==
          GSL_SUCCESS);
    CHECK(fabs(sum_of(f, 27000) - united / whole) < 0.5); /* whole numbers */
    free(f);
  }
}

static void test_distance(gsl_rng *rng) {
  static const double box[6] = {-0.5, 1.5, 0, 1, -0.2, 1};
  static const size_t cells[3] = {37, 21, 18};
  for (size_t n = 0; n < 60; n = 2 * n + 1) {
    const struct spheres s = random_spheres(rng, n, 0.01, 0.2);
    double *f = grid(&s, box, cells, VOXELS_DISTANCE, 1, 21);
    for (size_t m = 0; m < 37 * 21 * 18; m += 1) {
      const size_t at[3] = {m % 37, m / 37 % 21, m / 37 / 21};
      double least = HUGE_VAL;
      for (size_t i = 0; i < n; i++) {
        double d2 = 0;
        for (size_t k = 0; k < 3; k++) {
          const double h = (box[2 * k + 1] - box[2 * k]) / (double)cells[k];
          d2 += pow(box[2 * k] + h * ((double)at[k] + 0.5) - s.x[3 * i + k], 2);
        }
        least = fmin(least, sqrt(d2) - s.r[i]);
      }
      if (n == 0)
        CHECK(f[m] == HUGE_VAL);
      else
        CHECK_CLOSE(f[m], least, 16 * DBL_EPSILON); /* lengths of order 1 */
    }
    free(f);
  }
}

static void test_same_bits(gsl_rng *rng) {
  static const double box[6] = {0, 1, 0, 1, 0, 1};
  static const size_t cells[3] = {33, 29, 7};
  const struct spheres s = random_spheres(rng, 40, 0.05, 0.2);
  for (int k = VOXELS_FRACTION; k <= VOXELS_DISTANCE; k++) {
    const enum voxels_value what = (enum voxels_value)k;
    double *one = grid(&s, box, cells, what, 1, 29);
    double *three = grid(&s, box, cells, what, 3, 10);
    double *many = grid(&s, box, cells, what, 8, 29);
    CHECK(!memcmp(one, three, 33 * 29 * 7 * sizeof *one));
    CHECK(!memcmp(one, many, 33 * 29 * 7 * sizeof *one));
    free(many);
    free(one);
    free(three);
  }
}

/* --- bridges and walls -----------------------------------------------------
 */

static void test_solid(gsl_rng *rng) {
  static const double box[6] = {-0.25, 1, 0, 1.25, 0.125, 1.25};
  static const struct container walls = {
      .box = {-0.1, 0.9, 0.01, GSL_POSINF, 0.2, 1.2}};
  static const double end[1][4] = {{0.6, 0, -0.8, 0.2}};
  static const struct container tube = {
      .box = {-0.2, GSL_POSINF, GSL_NEGINF, GSL_POSINF, 0.2, 1.2},
      .planes = 1,
      .plane = end,
      .radius = 0.5,
      .point = {0.4, 0.6, 0},
      .axis = {-0.28, 0, 0.96}};
  static const struct container *const containers[3] = {NULL, &walls, &tube};
  static const size_t cells[3] = {20, 25, 18};
  enum { COUNT = 20 * 25 * 18 };
  const struct spheres some = random_spheres(rng, 45, 0.1, 0.2);
  uint32_t(*ends)[2] = NULL;
  struct solid s = solid_of(&some);
  s.bridge_radius = 0.09;
  CHECK(solid_pairs(s.n, s.x, s.r, 0.05, &ends, &s.bridges) == GSL_SUCCESS);
  CHECK(s.bridges > 10);
  s.ends = (const uint32_t(*)[2])ends;
  for (int walled = 0; walled < 3; walled++) {
    s.container = containers[walled];
    double *fraction = solid_grid(&s, box, cells, VOXELS_FRACTION, 1, 25);
    double *middle = solid_grid(&s, box, cells, VOXELS_MIDPOINT, 1, 25);
    double *distance = solid_grid(&s, box, cells, VOXELS_DISTANCE, 1, 25);
    double worst = 0, sum = 0, whole = 1;
    size_t cut = 0, wrong = 0;
    for (size_t m = 0; m < COUNT; m++) {
      const size_t at[3] = {m % 20, m / 20 % 25, m / 500};
      double cell[6], p[3], want = HUGE_VAL;
      whole = 1;
      for (int k = 0; k < 3; k++) {
        const double h = (box[2 * k + 1] - box[2 * k]) / (double)cells[k];
        cell[2 * k] = box[2 * k] + h * (double)at[k];
        cell[2 * k + 1] = cell[2 * k] + h;
        p[k] = cell[2 * k] + h / 2;
        whole *= h;
      }
      for (size_t i = 0; i < s.n; i++)
        want = fmin(want, solid_ball_distance(s.x + 3 * i, s.r[i], p));
      for (size_t b = 0; b < s.bridges; b++)
        want = fmin(want, solid_cylinder_distance(s.x + 3 * ends[b][0],
                                                  s.x + 3 * ends[b][1],
                                                  s.bridge_radius, p));
      if (walled)
        want = fmin(want, container_distance(s.container, p));
      wrong += !(fabs(distance[m] - want) <= 1e-14);
      wrong += fabs(want) > 1e-14 && middle[m] != (want < 0);
      sum += fraction[m];
      struct solid_volume v = {.bridges = GSL_NAN};
      if (m % (walled == 2 ? 290 : 29) == 0) { /* each takes its time */
        CHECK(solid_volume(&s, cell, &v) == GSL_SUCCESS);
        const double d = fabs(fraction[m] - v.total / whole);
        worst = d <= worst ? worst : d;
        cut += v.bridges > 1e-3 * whole;
      }
    }
    struct solid_volume v = {.total = GSL_NAN};
    CHECK(solid_volume(&s, box, &v) == GSL_SUCCESS);
    CHECK(wrong == 0);
    CHECK(walled == 2 || cut > 5);
    CHECK_CLOSE(worst, 0,
                walled == 2 ? 6e-3 : 3e-3); /* a rim within 1/24 of a cell */
    CHECK_CLOSE(sum * whole, v.total, walled == 2 ? 5e-5 : 1e-5);
    double *again = solid_grid(&s, box, cells, VOXELS_FRACTION, 3, 4);
    CHECK(!memcmp(again, fraction, COUNT * sizeof *again));
    free(again);
    free(distance);
    free(middle);
    free(fraction);
  }
  free(ends);
}

static void test_refused(void) {
  static const double x[3] = {0.5, 0.5, 0.5}, r[1] = {0.1}, bad[1] = {NAN};
  static const double unit[6] = {0, 1, 0, 1, 0, 1},
                      flat[6] = {0, 1, 0, 0, 0, 1},
                      turned[6] = {0, 1, 0, 1, 1, 0},
                      far[6] = {1e17, 1e17 + 64, 0, 1, 0, 1},
                      endless[6] = {0, INFINITY, 0, 1, 0, 1};
  static const size_t cells[3] = {4, 4, 4}, no[3] = {4, 0, 4},
                      fine[3] = {64, 4, 4};
  const struct solid s = {.n = 1, .x = x, .r = r},
                     wrong = {.n = 1, .x = x, .r = bad};
  struct voxels *v = NULL;
  CHECK(voxels_open(&v, &s, flat, cells) == GSL_EINVAL);
  CHECK(voxels_open(&v, &s, turned, cells) == GSL_EINVAL);
  CHECK(voxels_open(&v, &s, endless, cells) == GSL_EINVAL);
  CHECK(voxels_open(&v, &s, unit, no) == GSL_EINVAL);
  CHECK(voxels_open(&v, &wrong, unit, cells) == GSL_EINVAL);
  for (int k = 0; k < 6; k++) { /* any number of any sphere */
    double y[6] = {0.5, 0.5, 0.5, 0.7, 0.7, 0.7};
    const struct solid nowhere = {
        .n = 2, .x = y, .r = (const double[]){0.1, 0.1}};
    y[k] = NAN;
    CHECK(voxels_open(&v, &nowhere, unit, cells) == GSL_EINVAL);
  }
  /* cells that double cannot tell apart */
  CHECK(voxels_open(&v, &s, far, fine) == GSL_EINVAL);
  CHECK(v == NULL);
  voxels_close(NULL);
}

/* What is beyond a wall is solid, and a midpoint on it is not beyond. */
static void test_on_wall(void) {
  static const double box[6] = {0, 1, 0, 1, 0, 1};
  static const size_t cells[3] = {4, 4, 4};
  static const struct container walls = {
      .box = {0.125, GSL_POSINF, GSL_NEGINF, 0.625, 0.375, 0.875}};
  const struct solid s = {.container = &walls};
  double *middle = solid_grid(&s, box, cells, VOXELS_MIDPOINT, 1, 4);
  for (size_t m = 0; m < 64; m++)
    CHECK(middle[m] == (m / 4 % 4 == 3 || m / 16 == 0));
  free(middle);
}

int main(void) {
  const unsigned long seed = 1;
  printf("random cases: seed %lu\n", seed);
  gsl_set_error_handler_off();
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  test_cell(rng);
  test_fraction(rng);
  test_fine();
  test_midpoint(rng);
  test_distance(rng);
  test_same_bits(rng);
  test_solid(rng);
  test_on_wall();
  test_refused();
  gsl_rng_free(rng);
  return check_done();
}
