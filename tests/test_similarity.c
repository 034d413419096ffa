/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of a sphere by the paper's: the ratios that decide a bed are the same
   for every sphere, and units that are powers of two are exact. */
#include <float.h>
#include <math.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "model/similarity.h"
#include "sample.h"

/* a few roundings of each of a handful of factors */
static const double rounding = 32 * DBL_EPSILON;

static const struct dimension length = {1, 0, 0}, speed = {1, -1, 0},
                              force = {1, -2, 1}, stiffness = {-1, 0, 0},
                              psi = {-1, 1, 0};

/* The paper's: Tab. 4.2. */
static void test_paper(void) {
  const struct similarity s = similarity_of(0.1, 1, 9.81);
  CHECK(s.length == 1 && s.time == 1 && s.mass == 1);
  CHECK(similarity_scale(&s, force) == 1);
}

/* kappa r, psi sqrt(g r), F0/(m g), vmin/sqrt(g r) and lmax/r do not change. */
static void test_ratios(gsl_rng *rng) {
  for (int k = 0; k < 100; k++) {
    const double r = pow(10, uniform(rng, -6, 3)),
                 m = pow(10, uniform(rng, -9, 9)),
                 g = pow(10, uniform(rng, -3, 3));
    const struct similarity s = similarity_of(r, m, g);
    const double unit = sqrt(g * r / (9.81 * 0.1));
    CHECK_CLOSE(similarity_scale(&s, stiffness) * r / 0.1, 1, rounding);
    CHECK_CLOSE(similarity_scale(&s, length) * 0.1 / r, 1, rounding);
    CHECK_CLOSE(similarity_scale(&s, speed) / unit, 1, rounding);
    CHECK_CLOSE(similarity_scale(&s, psi) * unit, 1, rounding);
    CHECK_CLOSE(similarity_scale(&s, force) * 9.81 / (m * g), 1, rounding);
  }
}

/* Without gravity lengths and times are as with the paper's. */
static void test_no_gravity(void) {
  const struct similarity none = similarity_of(0.4, 2, 0),
                          some = similarity_of(0.4, 2, 9.81);
  CHECK(none.time == 2);
  CHECK(none.length == some.length && none.time == some.time &&
        none.mass == some.mass);
}

static void test_powers_of_two(void) {
  for (int k = -12; k <= 12; k++) {
    const struct similarity s =
        similarity_of(ldexp(0.1, 2 * k), ldexp(1, k), 9.81);
    CHECK(s.length == ldexp(1, 2 * k) && s.time == ldexp(1, k) &&
          s.mass == ldexp(1, k));
    CHECK(similarity_scale(&s, force) == ldexp(1, k));
    CHECK(similarity_scale(&s, psi) == ldexp(1, -k));
  }
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    abort();
  test_paper();
  test_ratios(rng);
  test_no_gravity();
  test_powers_of_two();
  gsl_rng_free(rng);
  return check_done();
}
