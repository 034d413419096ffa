/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures of mixtures by a few spheres in known places. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "measure/close_packing.h"
#include "measure/mixture.h"

static struct bed new_bed(size_t n, const double r[], const double z[]) {
  struct bed b;
  CHECK(bed_alloc(&b, n) == GSL_SUCCESS);
  for (size_t i = 0; i < n; i++) {
    b.r[i] = r[i];
    b.x[3 * i + 2] = z[i];
  }
  return b;
}

/* Each radius a class of its own, in ascending order; an empty bed has one. */
static void test_classes(void) {
  const double r[] = {0.2, 0.1, 0.2, 0.3}, z[4] = {0};
  struct bed b = new_bed(4, r, z);
  struct mixture m;
  CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS);
  CHECK(m.count == 3);
  for (size_t i = 0; i < 4; i++) {
    const size_t k = mixture_find(&m, r[i]);
    CHECK(k == (i == 1 ? 0u : i == 3 ? 2u : 1u));
    CHECK(m.at[k].low <= r[i] && r[i] < m.at[k].high);
  }
  CHECK(mixture_find(&m, 1e9) == 2 && mixture_find(&m, 0) == 0);
  b.n = 0;
  CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS && m.count == 1);
  b.n = 4;
  bed_free(&b);
}

/* Many radii: four parts whose volumes are equal up to the largest sphere. */
static void test_parts(void) {
  enum { N = 1000 };
  static double r[N], z[N];
  double all = 0;
  for (size_t i = 0; i < N; i++) {
    r[i] = 0.1 + 0.1 * (double)(i * 387 % N) / N; /* in another order */
    all += gsl_pow_3(r[i]);
  }
  struct bed b = new_bed(N, r, z);
  struct mixture m;
  CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS);
  CHECK(m.count == MIXTURE_PARTS);
  mixture_measure(&m, &b, NULL, NULL);
  size_t spheres = 0;
  for (size_t k = 0; k < m.count; k++) {
    CHECK_CLOSE(m.at[k].share, 0.25, 0.008 / all);
    spheres += m.at[k].spheres;
    CHECK(m.at[k].radius >= m.at[k].low && m.at[k].radius < m.at[k].high);
  }
  CHECK(spheres == N);
  bed_free(&b);
}

/* Volumes 8, 8, 1, 1, 1, 1 in (0.1 m)^3. By volume the large are at z = 2, the
   small at 5, all at (32 + 20)/20 = 2.6 with the squares 16 0.6^2 + 4 2.4^2 and
   both (1 + 1) 8 more from the pairs at 2 +- 1: 28.8 + 16 = 44.8, by 20. */
static void test_heights(void) {
  const double r[] = {0.2, 0.2, 0.1, 0.1, 0.1, 0.1}, z[] = {1, 3, 5, 5, 5, 5};
  struct bed b = new_bed(6, r, z);
  struct mixture m;
  CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS);
  mixture_measure(&m, &b, NULL, NULL);
  const double spread = sqrt(3 * 44.8 / 20);
  CHECK(m.at[0].spheres == 4 && m.at[1].spheres == 2);
  CHECK(m.at[0].radius == 0.1 && m.at[1].radius == 0.2);
  CHECK_REL(m.at[0].share, 0.2, 16 * DBL_EPSILON);
  CHECK_REL(m.at[0].height, 5., 16 * DBL_EPSILON);
  CHECK_REL(m.at[1].height, 2., 16 * DBL_EPSILON);
  CHECK_REL(m.at[0].segregation, 2.4 / (0.8 * spread), 64 * DBL_EPSILON);
  CHECK_REL(m.at[1].segregation, -0.6 / (0.2 * spread), 64 * DBL_EPSILON);
  /* a part: the large alone, who have no others */
  const bool large[] = {true, true, false, false, false, false};
  mixture_measure(&m, &b, large, NULL);
  CHECK(m.at[0].spheres == 0 && isnan(m.at[0].height) &&
        isnan(m.at[0].segregation));
  CHECK(m.at[1].spheres == 2 && m.at[1].share == 1 &&
        isnan(m.at[1].segregation));
  bed_free(&b);
}

/* One class on the other, in a fine column: 1 and -1; alternating: 0. */
static void test_segregation(void) {
  enum { N = 2000 };
  static double r[N], z[N];
  for (int mixed = 0; mixed < 2; mixed++) {
    for (size_t i = 0; i < N; i++) {
      z[i] = (double)i / N;
      r[i] = (mixed ? i % 10 < 3 : (double)i < 0.3 * N) ? 0.1 : 0.101;
    }
    struct bed b = new_bed(N, r, z);
    struct mixture m;
    CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS);
    mixture_measure(&m, &b, NULL, NULL);
    /* volumes differ by 3 %, places by those of a period of ten */
    CHECK_CLOSE(m.at[0].segregation, mixed ? 0 : -1, mixed ? 0.01 : 0.03);
    CHECK_CLOSE(m.at[1].segregation, mixed ? 0 : 1, mixed ? 0.01 : 0.03);
    bed_free(&b);
  }
}

/* Large, small, small in a row on the floor, and a small one that touches none.
   Contacts: the large one 1 sphere and the floor; the small ones 2, 1 and 0
   spheres, all but the last the floor; one of these within the class. */
static void test_contacts(void) {
  const double r[] = {0.2, 0.1, 0.1, 0.1}, z[] = {0.2, 0.1, 0.1, 1};
  const double large_x = sqrt(0.3 * 0.3 - 0.1 * 0.1);
  const double x[] = {0, large_x - 1e-9, large_x + 0.2 - 2e-9, 0};
  struct scene s = scene_default();
  const double point[3] = {0}, down[3] = {0, 0, -1};
  CHECK(scene_add_wall(&s, point, down) == GSL_SUCCESS);
  for (size_t last = 0; last < 4;
       last += 3) { /* the large one first, or last */
    struct bed b;
    CHECK(bed_alloc(&b, 4) == GSL_SUCCESS);
    for (size_t k = 0; k < 4; k++) {
      const size_t i = last ? last - k : k;
      b.r[i] = r[k];
      b.x[3 * i] = x[k];
      b.x[3 * i + 2] = z[k] - (k < 3 ? 1e-9 : 0);
    }
    struct network w = {0};
    CHECK(network_find(&w, &s, &b, 0.05) == GSL_SUCCESS);
    network_mark(&w, 0, 0);
    struct mixture m;
    CHECK(mixture_of_radii(&b, &m) == GSL_SUCCESS);
    mixture_measure(&m, &b, NULL, &w);
    CHECK(m.at[1].z == 2 && m.at[1].z_own == 0 && m.at[1].z_walls == 1);
    CHECK_REL(m.at[0].z, 5. / 3, 4 * DBL_EPSILON);
    CHECK_REL(m.at[0].z_own, 2. / 3, 4 * DBL_EPSILON);
    CHECK_REL(m.at[0].z_walls, 2. / 3, 4 * DBL_EPSILON);
    network_free(&w);
    bed_free(&b);
  }
  scene_free(&s);
}

/* Rods: the published figure of equal spheres; no unit matters, and neither the
   order nor copies of the spheres; two sizes lie denser, the most near 70 % of
   the volume large, and sizes that differ endlessly fill as spheres among
   spheres: 1 - (1 - f)^2 at the most. */
static void test_close(void) {
  double r[1000], f, g;
  for (size_t i = 0; i < 1000; i++)
    r[i] = 0.1;
  CHECK(close_packing_rods(1, r, &f) == GSL_SUCCESS);
  CHECK_CLOSE(f, 0.6435, 5e-4);
  CHECK(close_packing_rods(1000, r, &g) == GSL_SUCCESS);
  CHECK_CLOSE(g, f, 1e-9);
  for (size_t i = 0; i < 1000; i++)
    r[i] = i % 3 ? 0x1p-4 : 0x1p-3;
  CHECK(close_packing_rods(999, r, &f) == GSL_SUCCESS);
  for (size_t i = 0; i < 999; i++)
    r[i] = i < 333 ? 0x1p-13 : 0x1p-14;
  CHECK(close_packing_rods(999, r, &g) == GSL_SUCCESS);
  CHECK(f == g);
  double best = 0, where = 0;
  for (int q = 1; q < 20; q++) {
    const double share = q / 20.;
    /* n_large : n_small = share : (1 - share) 4^3 */
    const double small = (1 - share) * 64;
    size_t large = (size_t)(1000 * share / (share + small) + 0.5);
    for (size_t i = 0; i < 1000; i++)
      r[i] = i < large ? 0.4 : 0.1;
    CHECK(close_packing_rods(1000, r, &f) == GSL_SUCCESS);
    if (f > best) {
      best = f;
      where = share;
    }
  }
  CHECK(best > 0.7 && best < 1 - gsl_pow_2(1 - 0.6435));
  CHECK(where >= 0.6 && where <= 0.8);
}

static int descending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x < y) - (x > y);
}

/* The rods of equal spheres put in by the plain rule: each into the widest gap
   that there is, which it divides in two, of 0.7654 of its length at the least.
 */
static void test_rods(void) {
  enum { N = 20000 };
  static double rod[N], gap[N];
  double r = 1, f, all = 0, empty = 0;
  for (size_t k = 0; k < N; k++) {
    const double u = (sqrt(5) - 1) / 2 * ((double)k + 0.5);
    rod[k] = 2 * r * sqrt(u - floor(u));
    all += rod[k];
  }
  qsort(rod, N, sizeof *rod, descending);
  for (size_t k = 0; k < N; k++) {
    const double least = 0.7654 * rod[k];
    size_t widest = 0;
    for (size_t i = 1; i < k; i++)
      widest = gap[i] > gap[widest] ? i : widest;
    if (k)
      gap[widest] = fmax(least, gap[widest] - rod[k] - least);
    gap[k] = least;
  }
  for (size_t k = 0; k < N; k++)
    empty += gap[k];
  CHECK(close_packing_rods(1, &r, &f) == GSL_SUCCESS);
  CHECK_CLOSE(f, all / (all + empty), 1e-12);
}

/* By hand: radii 1, 1, 4 have the mean 2, the squares 1, 1, 4 about it, 2 on
   the average, and the cubes -1, -1, 8, 2 on the average. */
static void test_spread(void) {
  const double r[] = {1, 1, 4}, equal[] = {0.1, 0.1, 0.1};
  double d, s;
  close_packing_spread(3, r, &d, &s);
  CHECK_REL(d, M_SQRT2 / 2, 8 * DBL_EPSILON);
  CHECK_REL(s, 2 / sqrt(8), 8 * DBL_EPSILON);
  close_packing_spread(3, equal, &d, &s);
  CHECK(d == 0 && s == 0);
  CHECK(close_packing_spread_fraction(0, 0) == 0.634);
  CHECK_REL(close_packing_spread_fraction(0.4, 1), 0.674032, 1e-9);
}

int main(void) {
  test_classes();
  test_parts();
  test_heights();
  test_segregation();
  test_contacts();
  test_close();
  test_rods();
  test_spread();
  return check_done();
}
