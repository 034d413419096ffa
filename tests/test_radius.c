/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The radius of a bed's geometry: lattices and pairs, where every choice has a
   closed form, and random clusters, where it obeys its definition. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "files/radius_keys.h"
#include "measure/radius.h"
#include "geometry/volume.h"

#define ULPS(n) ((n)*DBL_EPSILON)

static const struct scene no_walls;
static const double unit[6] = {0, 1, 0, 1, 0, 1};

/* k^3 centres of a simple cubic lattice that fills the unit box. */
static size_t lattice(size_t k, double *x) {
  const double a = 1 / (double)k;
  for (size_t i = 0; i < k * k * k; i++) {
    x[3 * i] = a * ((double)(i % k) + 0.5);
    x[3 * i + 1] = a * ((double)(i / k % k) + 0.5);
    x[3 * i + 2] = a * ((double)(i / k / k) + 0.5);
  }
  return k * k * k;
}

static struct scene box_walls(void) {
  struct scene s = {0};
  CHECK(scene_add_box(&s, 1, 1) == GSL_SUCCESS);
  return s;
}

static void test_lattice(void) {
  double x[3 * 64], r = 0;
  const size_t n = lattice(4, x);
  struct scene walls = box_walls();
  struct radius_overlaps o;
  /* spacing 1/4, walls at 1/8 */
  CHECK(radius_touching(&no_walls, n, x, &r) == GSL_SUCCESS && r == 0.125);
  CHECK(radius_touching(&walls, n, x, &r) == GSL_SUCCESS && r == 0.125);
  CHECK(radius_overlaps(&walls, n, x, 0.124, &o) == GSL_SUCCESS);
  CHECK(o.count == 0 && o.largest == 0 && o.mean == 0);
  CHECK(radius_overlaps(&walls, n, x, 0.15, &o) == GSL_SUCCESS);
  CHECK(o.count == 3 * 3 * 16 + 5 * 16); /* no lid */
  CHECK_CLOSE(o.largest, 0.05 / 0.3, ULPS(8));
  CHECK_CLOSE(o.mean, (144 * 0.05 + 80 * 0.025) / 224 / 0.3, ULPS(224));
  CHECK(radius_overlaps(&no_walls, n, x, 0.15, &o) == GSL_SUCCESS);
  CHECK(o.count == 144);
  CHECK_CLOSE(o.mean, 0.05 / 0.3, ULPS(224));
  CHECK(radius_contact_mean(&walls, n, x, 0.15, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.125, ULPS(224));
  /* one wall away from the lattice's own: the spheres there decide */
  const double point[3] = {0, 0, 0.025}, down[3] = {0, 0, -1};
  CHECK(scene_add_wall(&walls, point, down) == GSL_SUCCESS);
  CHECK(radius_touching(&walls, n, x, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.1, ULPS(2));
  CHECK(radius_contact_mean(&walls, n, x, 0.15, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, (144 * 0.25 + 80 * 0.125 + 16 * 0.1) / (2 * 144 + 96),
              ULPS(240));
  /* fractions: 64 r^3 4 pi/3, and less the lenses once spheres overlap; at the
     walls the box cuts caps of the same size as halves of lenses */
  const double sphere = 64 * 4 * M_PI / 3;
  CHECK(radius_of_fraction(&no_walls, n, x, unit, 0.3, false, NULL, &r) ==
        GSL_SUCCESS);
  CHECK_CLOSE(r, cbrt(0.3 / sphere), ULPS(16));
  const double want = 0.14, h = 0.125;
  const double cap = M_PI / 3 * (want - h) * (want - h) * (2 * want + h);
  const double united = sphere * gsl_pow_3(want) - 64 * 6 * cap;
  CHECK(radius_of_fraction(&no_walls, n, x, unit, united, false, NULL, &r) ==
        GSL_SUCCESS);
  CHECK_CLOSE(r, want, ULPS(256));
  const double sum = sphere * gsl_pow_3(want) - 6 * 16 * cap;
  CHECK(radius_of_fraction(&no_walls, n, x, unit, sum, true, NULL, &r) ==
        GSL_SUCCESS);
  CHECK_CLOSE(r, want, ULPS(256));
  scene_free(&walls);
}

/* The same lattice without an end along all axes: 3 contacts for each sphere.
 */
static void test_periodic(void) {
  double x[3 * 64], r = 0;
  const size_t n = lattice(4, x);
  const struct scene cell = {.period = {1, 1, 1}};
  struct radius_overlaps o;
  for (size_t i = 0; i < 3 * n; i++) /* anywhere along them */
    x[i] += 0.17 - (double)(i % 5);
  CHECK(radius_touching(&cell, n, x, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.125, ULPS(16)); /* places of up to 4 */
  CHECK(radius_contact_mean(&cell, n, x, 0.15, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.125, ULPS(224));
  CHECK(radius_overlaps(&cell, n, x, 0.15, &o) == GSL_SUCCESS);
  CHECK(o.count == 3 * 64);
  CHECK_CLOSE(o.largest, 0.05 / 0.3, ULPS(64));
  CHECK_CLOSE(o.mean, 0.05 / 0.3, ULPS(224));
  /* any cell, and any eight of them */
  const double sphere = 64 * 4 * M_PI / 3, want = 0.14, h = 0.125;
  const double cap = M_PI / 3 * (want - h) * (want - h) * (2 * want + h);
  const double cells[2][6] = {{0, 1, 0, 1, 0, 1}, {-0.3, 1.7, 5, 7, 0.1, 2.1}};
  for (int k = 0; k < 2; k++)
    for (int sum = 0; sum < 2; sum++) {
      const double fraction =
          sphere * gsl_pow_3(want) - (sum ? 0 : 64 * 6 * cap);
      CHECK(radius_of_fraction(&cell, n, x, cells[k], fraction, sum, NULL,
                               &r) == GSL_SUCCESS);
      CHECK_CLOSE(r, want, ULPS(2048));
    }
  /* a sphere and its own image */
  CHECK(radius_touching(&cell, 1, x, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.5, ULPS(16));
}

/* Work that does not grow as the square of the number: one sphere far from all
   others, and spheres that would have to be a lump to fill a box below them. */
static void test_many(void) {
  enum { SIDE = 24, N = SIDE * SIDE * SIDE };
  double *x = malloc(3 * N * sizeof *x), r = 7;
  if (!x)
    abort();
  CHECK(lattice(SIDE, x) == N);
  x[0] = -1e9;
  CHECK(radius_touching(&no_walls, N, x, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.5 / SIDE, ULPS(2));
  const double below[6] = {0, 1, 0, 1, -1, 0}, around[6] = {0, 1, 0, 1, 0, 1};
  x[0] = x[3 * (SIDE - 1)]; /* two of one place */
  CHECK(radius_of_fraction(&no_walls, N, x, below, 0.6, false, NULL, &r) ==
        GSL_EDOM);
  CHECK(radius_of_fraction(&no_walls, N, x, below, 0.6, true, NULL, &r) ==
        GSL_SUCCESS);
  CHECK(r > 0.5 / SIDE);
  /* sqrt(3)/2 covers all; 120,000 pairs, along the edges of the lattice and the
     diagonals of its squares */
  CHECK(radius_of_fraction(&no_walls, N, x, around, 0.98, false, NULL, &r) ==
        GSL_SUCCESS);
  CHECK(r > M_SQRT1_2 / SIDE && r < 0.87 / SIDE);
  free(x);
}

static void test_none(void) {
  const double x[6] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
  const double bad[6] = {0.5, 0.5, 0.5, 0.5, GSL_NAN, 0.5};
  double r = 7;
  struct radius_overlaps o;
  CHECK(radius_touching(&no_walls, 1, x, &r) == GSL_EDOM);
  CHECK(radius_touching(&no_walls, 2, x, &r) == GSL_EDOM);
  CHECK(radius_touching(&no_walls, 2, bad, &r) == GSL_EINVAL);
  CHECK(radius_contact_mean(&no_walls, 1, x, 0.1, &r) == GSL_EDOM);
  CHECK(radius_contact_mean(&no_walls, 2, bad, 0.1, &r) == GSL_EINVAL);
  CHECK(radius_of_fraction(&no_walls, 0, x, unit, 0.5, false, NULL, &r) ==
        GSL_EDOM);
  CHECK(radius_of_fraction(&no_walls, 1, x, unit, 1, false, NULL, &r) ==
        GSL_EDOM);
  CHECK(radius_of_fraction(&no_walls, 1, x, unit, 0, true, NULL, &r) ==
        GSL_EDOM);
  CHECK(radius_of_fraction(&no_walls, 1, x, unit, GSL_NAN, true, NULL, &r) ==
        GSL_EDOM);
  CHECK(radius_of_fraction(&no_walls, 2, bad, unit, 0.5, false, NULL, &r) ==
        GSL_EINVAL);
  CHECK(radius_overlaps(&no_walls, 2, bad, 0.1, &o) == GSL_EINVAL);
  CHECK(r == 7);
  /* one sphere on a floor; two far apart */
  struct scene walls = box_walls();
  const double one[3] = {0.5, 0.4, 0.3}, far[6] = {0, 0, 0, 1e9, 0, 0};
  CHECK(radius_touching(&walls, 1, one, &r) == GSL_SUCCESS);
  CHECK_CLOSE(r, 0.3, ULPS(1));
  CHECK(radius_touching(&no_walls, 2, far, &r) == GSL_SUCCESS && r == 5e8);
  const double outside[3] = {0.5, 0.4, -0.3};
  CHECK(radius_touching(&walls, 1, outside, &r) == GSL_EDOM);
  /* a sphere that reaches beyond the box all around fills it */
  CHECK(radius_of_fraction(&no_walls, 1, one, unit, 0.999999, false, NULL,
                           &r) == GSL_SUCCESS);
  CHECK(r < sqrt(0.25 + 0.36 + 0.49));
  scene_free(&walls);
}

static void test_random(void) {
  for (unsigned long seed = 1; seed <= 10; seed++) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    enum { N = 50 };
    double x[3 * N], r, least = GSL_POSINF, radii[N], volume;
    for (int i = 0; i < 3 * N; i++)
      x[i] = gsl_rng_uniform(rng);
    struct scene walls = box_walls();
    for (int i = 0; i < N; i++) {
      for (int j = 0; j < i; j++)
        least =
            fmin(least,
                 hypot(hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1]),
                       x[3 * i + 2] - x[3 * j + 2]) /
                     2);
      for (int k = 0; k < 3; k++)
        least = fmin(least, k < 2 ? fmin(x[3 * i + k], 1 - x[3 * i + k])
                                  : x[3 * i + k]);
    }
    bool ok = CHECK(radius_touching(&walls, N, x, &r) == GSL_SUCCESS);
    ok &= CHECK_REL(r, least, ULPS(8));
    struct radius_overlaps o;
    ok &= CHECK(radius_overlaps(&walls, N, x, r, &o) == GSL_SUCCESS);
    ok &= CHECK(o.largest <= ULPS(2));
    ok &= CHECK(radius_overlaps(&walls, N, x, 1.001 * r, &o) == GSL_SUCCESS);
    ok &= CHECK(o.count == 1 && o.mean == o.largest);
    const double f = 0.1 + 0.8 * gsl_rng_uniform(rng);
    for (int sum = 0; sum < 2; sum++) {
      ok &= CHECK(radius_of_fraction(&no_walls, N, x, unit, f, sum, NULL, &r) ==
                  GSL_SUCCESS);
      for (int i = 0; i < N; i++)
        radii[i] = r;
      ok &= CHECK(volume_union(N, x, radii, unit, &volume) == GSL_SUCCESS);
      /* d volume/dr r/volume < 3 */
      ok &= CHECK_CLOSE(sum ? volume_sum(N, x, radii, unit) : volume, f,
                        ULPS(64));
    }
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    scene_free(&walls);
    gsl_rng_free(rng);
  }
}

static void test_rewrite(void) {
  struct bed b;
  struct bed_header h = {0};
  CHECK(bed_alloc(&b, 2) == GSL_SUCCESS);
  b.r[0] = b.r[1] = 0.1;
  CHECK(bed_header_add(&h, "radius", "0.1") == GSL_SUCCESS);
  CHECK(radius_dynamics(&h) == 0);
  CHECK(radius_rewrite(&b, &h, 0.09, "touching") == GSL_SUCCESS);
  CHECK(radius_rewrite(&b, &h, 0.08, "fraction=0.6") == GSL_SUCCESS);
  CHECK(b.r[0] == 0.08 && b.r[1] == 0.08);
  CHECK(radius_dynamics(&h) == 0.1);
  CHECK(!strcmp(bed_header_get(&h, "radius"), "0.08"));
  CHECK(!strcmp(bed_header_get(&h, "radius_keep"), "fraction=0.6"));
  CHECK(radius_rewrite(&b, &h, radius_dynamics(&h), NULL) == GSL_SUCCESS);
  CHECK(b.r[1] == 0.1 && radius_dynamics(&h) == 0 && h.count == 1);
  CHECK(!strcmp(bed_header_get(&h, "radius"), "0.1"));
  const char *const bad[] = {"", "x", "0", "-1", "nan", "inf", "0.1 0.2"};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    CHECK(bed_header_set(&h, "radius_dynamics", bad[k]) == GSL_SUCCESS);
    CHECK(radius_dynamics(&h) < 0);
  }
  bed_header_free(&h);
  bed_free(&b);
}

int main(void) {
  gsl_set_error_handler_off();
  test_lattice();
  test_periodic();
  test_many();
  test_none();
  test_random();
  test_rewrite();
  return check_done();
}
