/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distributions of sizes: what was drawn has the shares that were asked for, by
   number and by volume, by distribution functions written down here. */
#include <float.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_statistics.h>
#include "check.h"
#include "geometry/vec3.h"
#include "model/fill.h"
#include "model/sizes.h"

enum { N = 20000 };

static double cut_normal(double z, double cut) {
  const double low = gsl_cdf_ugaussian_P(-cut);
  return (gsl_cdf_ugaussian_P(z) - low) / (1 - 2 * low);
}

/* Shares below r of the quantity that the distribution is given by. */
static double uniform_below(double a, double b, double r) {
  return (r - a) / (b - a);
}
static double normal_below(double a, double b, double r) {
  return cut_normal((r - a) / b, 3);
}
static double lognormal_below(double a, double b, double r) {
  return cut_normal(log(r / a) / b, 4);
}

static const struct {
  enum sizes_kind kind;
  double a, b, low, high;
  double (*below)(double a, double b, double r);
} kinds[] = {
    {SIZES_UNIFORM, 0.05, 0.2, 0.05, 0.2, uniform_below},
    {SIZES_NORMAL, 0.1, 0.02, 0.04, 0.16, normal_below},
    {SIZES_LOGNORMAL, 0.1, 0.3, 0.03012, 0.3320, lognormal_below},
};

static void draw(struct sizes *s, size_t seed, double r[]) {
  CHECK(sizes_check(s) == NULL);
  CHECK(sizes_draw(s, seed, N, r) == GSL_SUCCESS);
}

/* The share of the spheres, or of their volume, below a radius. */
static double share_below(const double r[], bool by_volume, double limit) {
  double all = 0, below = 0;
  for (size_t i = 0; i < N; i++) {
    const double share = by_volume ? gsl_pow_3(r[i]) : 1;
    all += share;
    below += r[i] <= limit ? share : 0;
  }
  return below / all;
}

/* Each n-th of the distribution has one sphere, so a number is right within
   one, and a volume within a few of the largest spheres. */
static void test_shares(void) {
  static double r[N];
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    for (int by_volume = 0; by_volume < 2; by_volume++) {
      struct sizes *s;
      CHECK(sizes_alloc(&s, kinds[k].kind, by_volume, kinds[k].a, kinds[k].b) ==
            GSL_SUCCESS);
      draw(s, 1, r);
      double largest = 0, volume = 0;
      for (size_t i = 0; i < N; i++) {
        CHECK(r[i] >= kinds[k].low * (1 - 1e-3) &&
              r[i] <= kinds[k].high * (1 + 1e-3));
        largest = GSL_MAX(largest, r[i]);
        volume += gsl_pow_3(r[i]);
      }
      const double tol =
          by_volume ? 4 * gsl_pow_3(largest) / volume + 1e-4 : 1.5 / N;
      for (int q = 1; q < 20; q++) {
        const double limit =
            kinds[k].low + (kinds[k].high - kinds[k].low) * q / 20;
        CHECK_CLOSE(share_below(r, by_volume, limit),
                    kinds[k].below(kinds[k].a, kinds[k].b, limit), tol);
      }
      sizes_free(s);
    }
}

/* 30 % are 30 % of the spheres, or of their volume up to one of the largest. */
static void test_mix(void) {
  static double r[N];
  const double radius[] = {0.2, 0.05, 0.1}, share[] = {70, 10, 20};
  for (int by_volume = 0; by_volume < 2; by_volume++) {
    struct sizes *s;
    CHECK(sizes_alloc_table(&s, SIZES_MIX, by_volume, 3, radius, share) ==
          GSL_SUCCESS);
    draw(s, 7, r);
    const double tol = by_volume ? 1e-3 : 1.5 / N;
    CHECK_CLOSE(share_below(r, by_volume, 0.05), 0.1, tol);
    CHECK_CLOSE(share_below(r, by_volume, 0.1), 0.3, tol);
    CHECK(share_below(r, by_volume, 0.2) == 1);
    sizes_free(s);
  }
}

/* A sieve curve: its shares at its meshes, and straight over the logarithm
   between them; a class without a share stays empty. */
static void test_table(void) {
  static double r[N];
  const double edge[] = {0.1, 0.2, 0.25, 0.4}, share[] = {0.5, 0, 0.5, 0};
  struct sizes *s;
  CHECK(sizes_alloc_table(&s, SIZES_TABLE, true, 4, edge, share) ==
        GSL_SUCCESS);
  draw(s, 3, r);
  CHECK_CLOSE(share_below(r, true, 0.1 * M_SQRT2), 0.25, 1e-3);
  CHECK_CLOSE(share_below(r, true, 0.2), 0.5, 1e-3);
  CHECK_CLOSE(share_below(r, true, 0.25 * (1 - 1e-9)), 0.5, 1e-3);
  CHECK_CLOSE(share_below(r, true, sqrt(0.25 * 0.4)), 0.75, 1e-3);
  for (size_t i = 0; i < N; i++)
    CHECK(r[i] >= 0.1 && r[i] <= 0.4 &&
          (r[i] <= 0.2 * (1 + 8 * DBL_EPSILON) || r[i] >= 0.25));
  sizes_free(s);
}

/* Another unit of length, a power of two, is another exponent and no more. */
static void test_units(void) {
  const double edge[] = {0.1, 0.2, 0.25}, share[] = {0.4, 0.6, 0},
               scaled[] = {0x1p-9 * 0.1, 0x1p-9 * 0.2, 0x1p-9 * 0.25};
  for (int k = 0; k < 5; k++)
    for (int by_volume = 0; by_volume < 2; by_volume++) {
      struct sizes *s[2];
      if (k < 3) {
        const double b = kinds[k].b;
        sizes_alloc(&s[0], kinds[k].kind, by_volume, kinds[k].a, b);
        sizes_alloc(&s[1], kinds[k].kind, by_volume, 0x1p-9 * kinds[k].a,
                    kinds[k].kind == SIZES_LOGNORMAL ? b : 0x1p-9 * b);
      } else {
        const enum sizes_kind kind = k == 3 ? SIZES_MIX : SIZES_TABLE;
        sizes_alloc_table(&s[0], kind, by_volume, 3, edge, share);
        sizes_alloc_table(&s[1], kind, by_volume, 3, scaled, share);
      }
      for (int q = 0; q <= 1000; q++)
        CHECK(sizes_quantile(s[1], q / 1000.0) ==
              0x1p-9 * sizes_quantile(s[0], q / 1000.0));
      sizes_free(s[0]);
      sizes_free(s[1]);
    }
}

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Seeds shuffle; equal spheres are equal. */
static void test_seeds(void) {
  static double r[3][N];
  struct sizes *s;
  CHECK(sizes_alloc(&s, SIZES_UNIFORM, false, 1, 3) == GSL_SUCCESS);
  for (size_t k = 0; k < 3; k++)
    draw(s, 1 + k / 2, r[k]);
  CHECK(!memcmp(r[0], r[1], sizeof r[0]));
  size_t same = 0, ascending = 0;
  for (size_t i = 0; i < N; i++) {
    same += fabs(r[0][i] - r[2][i]) < 2.0 / N;
    ascending += i && r[0][i] > r[0][i - 1];
  }
  CHECK(same < 20); /* some 2 by chance */
  CHECK_CLOSE((double)ascending / N, 0.5, 5 * sqrt(1 / 12. / N));
  qsort(r[0], N, sizeof **r, compare);
  for (size_t i = 0; i < N; i++)
    CHECK_CLOSE(r[0][i], 1 + 2 * ((double)i + 0.5) / N, 1.0 / N * (1 + 1e-9));
  sizes_free(s);
  CHECK(sizes_alloc(&s, SIZES_UNIFORM, false, 0.1, 0.1) == GSL_SUCCESS);
  draw(s, 1, r[0]);
  for (size_t i = 0; i < N; i++)
    CHECK(r[0][i] == 0.1);
  sizes_free(s);
}

/* A share of all ends with the largest, wherever rounding has the sum of the
   classes end. */
static void test_last(void) {
  double radius[40], share[40];
  for (size_t count = 1; count <= 40; count++) {
    for (size_t k = 0; k < count; k++) {
      radius[k] = 0.1 + 0.01 * (double)k;
      share[k] = 1 / (double)count;
    }
    struct sizes *s;
    CHECK(sizes_alloc_table(&s, SIZES_MIX, false, count, radius, share) ==
          GSL_SUCCESS);
    CHECK(sizes_quantile(s, 1) == radius[count - 1]);
    sizes_free(s);
  }
}

static void test_masses(void) {
  const double r[] = {0.1, 0.2, 0.05};
  double m[3];
  sizes_masses(3, r, 0.1, 2, m);
  CHECK(m[0] == 2 && m[1] == 16 && m[2] == 0.25);
}

/* A start of many sizes: apart, in the box, and not in a tower: the places of
   small spheres are shared. */
static void test_fill(void) {
  enum { SPHERES = 600 };
  const double radius[] = {0.1, 0.02}, share[] = {0.1, 0.9};
  struct sizes *s[3];
  CHECK(sizes_alloc_table(&s[0], SIZES_MIX, false, 2, radius, share) ==
        GSL_SUCCESS);
  CHECK(sizes_alloc(&s[1], SIZES_LOGNORMAL, false, 0.05, 0.5) == GSL_SUCCESS);
  CHECK(sizes_alloc(&s[2], SIZES_UNIFORM, false, 0.05, 0.1) == GSL_SUCCESS);
  for (size_t k = 0; k < 3; k++) {
    struct bed b;
    CHECK(bed_alloc(&b, SPHERES) == GSL_SUCCESS);
    CHECK(sizes_draw(s[k], 1, SPHERES, b.r) == GSL_SUCCESS);
    const double largest = gsl_stats_max(b.r, 1, b.n);
    const struct fill f = {.base = {5 * largest, 7.5 * largest},
                           .drop = 1,
                           .jitter = 0.25, /* more presses on walls */
                           .seed = 3};
    CHECK(fill_grid_of(&f, NULL, &b) == GSL_SUCCESS);
    double top = 0;
    for (size_t i = 0; i < SPHERES; i++) {
      const double *x = b.x + 3 * i;
      CHECK(x[0] >= b.r[i] && x[0] <= f.base[0] - b.r[i]);
      CHECK(x[1] >= b.r[i] && x[1] <= f.base[1] - b.r[i]);
      CHECK(x[2] >= f.drop + b.r[i]);
      top = GSL_MAX(top, x[2] + b.r[i]);
      for (size_t j = 0; j < i; j++) {
        double u[3];
        vec3_sub(x, b.x + 3 * j, u);
        CHECK(vec3_norm(u) > b.r[i] + b.r[j]);
      }
    }
    /* 60 large ones and 540 of which 125 share a place: 65 places, 6 a layer */
    if (k == 0)
      CHECK(top <= f.drop + 11 * 2.5 * largest);
    bed_free(&b);
    sizes_free(s[k]);
  }
}

static int grid(double radius, double a, double b, size_t count, double *top) {
  const struct fill f = {
      .count = count, .radius = radius, .mass = 1, .base = {a, b}, .seed = 1};
  struct bed bed;
  const int status = fill_grid(&f, &bed);
  if (status != GSL_SUCCESS)
    return status;
  *top = gsl_stats_max(bed.x + 2, 3, bed.n);
  bed_free(&bed);
  return GSL_SUCCESS;
}

/* What fits exactly is in, although 0.3/0.1 is 2.9999999999999996. */
static void test_rounding(void) {
  double top = 0;
  CHECK(0.3 / 0.1 < 3 && 2.5 * 0.04 == 0.1);
  CHECK(grid(0.04, 0.3, 0.3, 9, &top) == GSL_SUCCESS);
  CHECK_REL(top, 0.05, 1e-15); /* one layer of 3 by 3 */
  CHECK(grid(0.04, 0.3, 0.3, 10, &top) == GSL_SUCCESS);
  CHECK_REL(top, 0.15, 1e-15);
  CHECK(grid(0.04, 0.0999, 0.3, 1, &top) == GSL_EINVAL);
  /* an end to the number of spheres across */
  CHECK(grid(0.04, 1e5, 0.1, 2, &top) == GSL_SUCCESS);
  CHECK(grid(0.04, 1.1e5, 0.1, 2, &top) == GSL_EINVAL);
  /* 27 of a third of the radius share a place */
  struct bed b;
  CHECK(bed_alloc(&b, 9 + 27) == GSL_SUCCESS);
  for (size_t i = 0; i < b.n; i++)
    b.r[i] = i < 9 ? 0.3 : 0.1;
  const struct fill f = {.base = {7.5 * 0.3, 7.5 * 0.3}, .seed = 1};
  CHECK(fill_grid_of(&f, NULL, &b) == GSL_SUCCESS);
  CHECK_REL(gsl_stats_max(b.x + 2, 3, b.n), (1 + 5. / 6) * 0.75, 1e-14);
  CHECK_REL(gsl_stats_max(b.x + 27, 3, 27), 0.75 * 5 / 6, 1e-14);
  bed_free(&b);
}

static void refused(enum sizes_kind kind, double a, double b) {
  struct sizes *s;
  CHECK(sizes_alloc(&s, kind, false, a, b) == GSL_SUCCESS);
  CHECK(sizes_check(s) != NULL);
  sizes_free(s);
}

static void refused_table(enum sizes_kind kind, size_t count, const double r[],
                          const double share[]) {
  struct sizes *s;
  CHECK(sizes_alloc_table(&s, kind, true, count, r, share) == GSL_SUCCESS);
  CHECK(sizes_check(s) != NULL);
  sizes_free(s);
}

static void test_wrong(void) {
  for (enum sizes_kind k = SIZES_UNIFORM; k <= SIZES_LOGNORMAL; k++) {
    refused(k, 0, 1);
    refused(k, -1, 1);
    refused(k, NAN, 0.1);
    refused(k, 1, NAN);
    refused(k, 1, -0.1);
    refused(k, 1, INFINITY);
  }
  refused(SIZES_UNIFORM, 1, 0.9);
  refused(SIZES_UNIFORM, 1, 1e5);
  refused(SIZES_NORMAL, 1, 1. / 3);
  refused(SIZES_LOGNORMAL, 1, 1.2);
  const double r[] = {1, 2, 2}, down[] = {2, 1}, zero[] = {0, 1};
  const double share[] = {0.5, 0.5, 0}, open[] = {0.5, 0.5},
               negative[] = {1.5, -0.5, 0};
  refused_table(SIZES_TABLE, 3, r, share);
  refused_table(SIZES_TABLE, 2, r, open);
  refused_table(SIZES_TABLE, 2, down, share);
  refused_table(SIZES_TABLE, 1, r, share);
  refused_table(SIZES_MIX, 0, r, share);
  refused_table(SIZES_MIX, 2, zero, share);
  refused_table(SIZES_MIX, 3, r, negative);
  CHECK(sizes_adds_up(2, open) && sizes_adds_up(3, share));
  const double percent[] = {30, 70}, short_of_it[] = {0.3, 0.69};
  CHECK(sizes_adds_up(2, percent) && !sizes_adds_up(2, short_of_it));
}

int main(void) {
  test_shares();
  test_mix();
  test_table();
  test_units();
  test_seeds();
  test_last();
  test_masses();
  test_fill();
  test_rounding();
  test_wrong();
  return check_done();
}
