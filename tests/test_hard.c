/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of hard contacts: beds that follow the law exactly, and how often
   the interval holds the true one where they follow it but for chance. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include "check.h"
#include "measure/hard.h"
#include "sample.h"

static void test_exact(gsl_rng *rng) {
  for (int k = 0; k < 50; k++) {
    const double u = uniform(rng, 0.4, 0.7), c = uniform(rng, 0, 3);
    double kr[8], fraction[8];
    const size_t n = 2 + gsl_rng_uniform_int(rng, 7);
    for (size_t i = 0; i < n; i++) {
      kr[i] = 30 * (double)(i + 1);
      fraction[i] = u + c / kr[i];
    }
    struct hard_limit h;
    CHECK(hard_limit_fit(n, kr, fraction, 0.006, &h) == GSL_SUCCESS);
    /* least squares lose the square of the condition, (60/30)^2 or so */
    CHECK_CLOSE(h.value, u, 1e3 * DBL_EPSILON);
    CHECK_CLOSE(h.slope, c, 1e5 * DBL_EPSILON);
    if (n > 2)
      CHECK_CLOSE(h.high - h.low, 0, 1e-12);
  }
}

/* Two beds of kappa r and twice that: U = 2 y2 - y1, so its error is sqrt(5)
   that of a bed. */
static void test_two(void) {
  const double kr[] = {30, 60}, fraction[] = {0.588, 0.563};
  struct hard_limit h;
  CHECK(hard_limit_fit(2, kr, fraction, 0.006, &h) == GSL_SUCCESS);
  CHECK_CLOSE(h.value, 0.538, 1e-12);
  const double half = 1.959963984540054 * sqrt(5) * 0.006;
  CHECK_CLOSE(h.high - h.value, half, 1e-12);
  CHECK_CLOSE(h.value - h.low, half, 1e-12);
  CHECK(h.deviation == 0.006);
}

/* 95 % of the intervals, give or take three standard deviations of that share,
   hold the limit. */
static void test_coverage(gsl_rng *rng, size_t n) {
  const double u = 0.54, c = 1.5, chance = 0.006;
  const int trials = 4000;
  int held = 0;
  for (int k = 0; k < trials; k++) {
    double kr[12], fraction[12];
    for (size_t i = 0; i < n; i++) {
      kr[i] = 30 * gsl_pow_int(2, (int)(i % 4));
      fraction[i] = u + c / kr[i] + gsl_ran_gaussian(rng, chance);
    }
    struct hard_limit h;
    CHECK(hard_limit_fit(n, kr, fraction, chance, &h) == GSL_SUCCESS);
    held += h.low <= u && u <= h.high;
  }
  CHECK_CLOSE(held, 0.95 * trials, 3 * sqrt(0.95 * 0.05 * trials));
}

static void test_refused(void) {
  const double kr[] = {30, 30, -1, GSL_NAN}, fraction[] = {0.5, 0.6, 0.5, 0.5};
  struct hard_limit h = {.value = 7};
  CHECK(hard_limit_fit(1, kr, fraction, 0, &h) == GSL_EINVAL);
  CHECK(hard_limit_fit(2, kr, fraction, 0, &h) == GSL_EDOM);
  CHECK(hard_limit_fit(3, kr, fraction, 0, &h) == GSL_EINVAL);
  CHECK(hard_limit_fit(2, kr + 2, fraction, 0, &h) == GSL_EINVAL);
  CHECK(h.value == 7);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_exact(rng);
  test_two();
  for (size_t n = 2; n <= 12; n += n < 4 ? 1 : 4)
    test_coverage(rng, n);
  test_refused();
  gsl_rng_free(rng);
  return check_done();
}
