/* SPDX-License-Identifier: GPL-3.0-or-later */
/* By number, within a class from p to q whose volume is spread evenly over the
   logarithm of the size: dN ~ r^-3 d ln r, so a share u of the class is below
   the r of p^-3 - r^-3 = u (p^-3 - q^-3), and the class has (p^-3 - q^-3)/
   (3 ln(q/p)) spheres per volume (times 3/4 pi). Quotients of radii alone are
   raised to powers, so that the unit of length does not matter to the bits. */
#include "model/sizes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

/* Where the distributions without an end are cut, in standard deviations. Of a
   normal one 0.3 % are lost, and radii stay positive up to a deviation of a
   third of the mean; of a lognormal one much of the volume is beyond three. */
static const double normal_cut = 3, lognormal_cut = 4;

/* The largest radius by the smallest: more cannot be in one bed of as many
   spheres as a machine holds, and is a mistake. */
static const double most_ratio = 1e4;

/* Classes of a normal distribution by volume. */
enum { NORMAL_CLASSES = 600 };

void sizes_free(struct sizes *s) {
  if (!s)
    return;
  free(s->radius);
  free(s->share);
  free(s);
}

int sizes_alloc_table(struct sizes **out, enum sizes_kind kind, bool by_volume,
                      size_t count, const double radius[],
                      const double share[]) {
  struct sizes *s = calloc(1, sizeof *s);
  if (!s)
    return GSL_ENOMEM;
  *s = (struct sizes){.kind = kind, .by_volume = by_volume, .count = count};
  s->radius = calloc(count + 1, sizeof *s->radius);
  s->share = calloc(count + 1, sizeof *s->share);
  if (!s->radius || !s->share) {
    sizes_free(s);
    return GSL_ENOMEM;
  }
  double sum = 0;
  for (size_t k = 0; k < count; k++)
    sum += share[k];
  for (size_t k = 0; k < count; k++) {
    s->radius[k] = radius[k];
    s->share[k] = share[k] / sum;
  }
  *out = s;
  return GSL_SUCCESS;
}

/* A normal distribution of the volume as a table. */
static int normal_table(struct sizes **out, double mean, double deviation) {
  double radius[NORMAL_CLASSES + 1], share[NORMAL_CLASSES + 1] = {0};
  for (size_t k = 0; k <= NORMAL_CLASSES; k++) {
    const double z = normal_cut * (2.0 * (double)k / NORMAL_CLASSES - 1);
    radius[k] = mean + deviation * z;
    if (k < NORMAL_CLASSES)
      share[k] = gsl_cdf_ugaussian_P(z + 2 * normal_cut / NORMAL_CLASSES) -
                 gsl_cdf_ugaussian_P(z);
  }
  return sizes_alloc_table(out, SIZES_TABLE, true, NORMAL_CLASSES + 1, radius,
                           share);
}

int sizes_alloc(struct sizes **out, enum sizes_kind kind, bool by_volume,
                double a, double b) {
  assert(kind <= SIZES_LOGNORMAL);
  if (kind == SIZES_NORMAL && by_volume && b > 0)
    return normal_table(out, a, b);
  struct sizes *s = calloc(1, sizeof *s);
  if (!s)
    return GSL_ENOMEM;
  *s = (struct sizes){.kind = kind, .by_volume = by_volume, .a = a, .b = b};
  *out = s;
  return GSL_SUCCESS;
}

bool sizes_adds_up(size_t count, const double share[]) {
  double sum = 0;
  for (size_t k = 0; k < count; k++)
    sum += share[k];
  return fabs(sum - 1) <= sizes_rounding ||
         fabs(sum / 100 - 1) <= sizes_rounding;
}

static const char *check_columns(const struct sizes *s) {
  const bool table = s->kind == SIZES_TABLE;
  if (s->count < (table ? 2 : 1))
    return table ? "expected at least two sizes" : "expected a size";
  for (size_t k = 0; k < s->count; k++) {
    if (!(s->radius[k] > 0 && gsl_finite(s->radius[k])))
      return "expected radii above 0";
    if (!(s->share[k] >= 0 && gsl_finite(s->share[k])))
      return "expected shares of at least 0";
    if (table && k && !(s->radius[k] > s->radius[k - 1]))
      return "expected ascending sizes";
  }
  if (table && s->share[s->count - 1] > 0)
    return "sizes without an end: expected a share of 0 at the largest";
  return NULL;
}

static double largest_by_smallest(const struct sizes *s) {
  switch (s->kind) {
  case SIZES_UNIFORM:
    return s->b / s->a;
  case SIZES_NORMAL:
    return (s->a + normal_cut * s->b) / (s->a - normal_cut * s->b);
  case SIZES_LOGNORMAL:
    return exp(2 * lognormal_cut * s->b);
  default:
    break;
  }
  double low = GSL_POSINF, high = 0;
  for (size_t k = 0; k < s->count; k++) {
    low = GSL_MIN(low, s->radius[k]);
    high = GSL_MAX(high, s->radius[k]);
  }
  return high / low;
}

const char *sizes_check(const struct sizes *s) {
  const char *wrong = NULL;
  if (s->kind >= SIZES_MIX)
    wrong = check_columns(s);
  else if (!(s->a > 0 && gsl_finite(s->a)))
    wrong = "expected a first number above 0";
  else if (!(s->b >= 0 && gsl_finite(s->b)))
    wrong = "expected a second number of at least 0";
  else if (s->kind == SIZES_UNIFORM && !(s->b >= s->a))
    wrong = "expected R2 of at least R1";
  else if (s->kind == SIZES_NORMAL && !(s->a - normal_cut * s->b > 0))
    wrong = "sizes without an end above 0: expected a MEAN of more than 3 SD";
  if (!wrong && !(largest_by_smallest(s) <= most_ratio))
    wrong = s->kind == SIZES_LOGNORMAL
                ? "sizes without an end: expected a SIGMA of at most 1.15"
                : "sizes differ too much: expected a ratio of at most 10000";
  return wrong;
}

/* Spheres in a class by its share, up to a factor for all; lengths by unit. */
static double class_number(const struct sizes *s, size_t k, double unit) {
  if (s->kind == SIZES_MIX)
    return s->by_volume ? s->share[k] / gsl_pow_3(s->radius[k] / unit)
                        : s->share[k];
  if (k + 1 == s->count)
    return 0;
  const double x = gsl_pow_3(s->radius[k] / s->radius[k + 1]);
  return s->share[k] * (1 - x) / -log(x) / gsl_pow_3(s->radius[k] / unit);
}

/* The class of a share u of the spheres, and u's share within it. */
static size_t find_class(const struct sizes *s, double *u) {
  const double unit = s->radius[0];
  double all = 0, below = 0;
  for (size_t k = 0; k < s->count; k++)
    all += class_number(s, k, unit);
  size_t last = 0; /* that has spheres, should roundings lead beyond it */
  for (size_t k = 0; k < s->count; k++) {
    const double share = class_number(s, k, unit) / all;
    if (share > 0)
      last = k;
    if (share > 0 && *u <= below + share) {
      *u = GSL_MAX(*u - below, 0) / share;
      return k;
    }
    below += share;
  }
  *u = 1;
  return last;
}

/* The r that a share u is below where the number is spread as r^-(power + 1).
 */
static double power_law(double p, double q, int power, double u) {
  const double rest = 1 - u * (1 - gsl_pow_int(p / q, power));
  return GSL_MIN(p * pow(rest, -1.0 / power), q);
}

/* The z that a share u of a normal distribution of unit width and mean -shift,
   cut to [-cut, cut], is below. */
static double between(double shift, double cut, double u) {
  const double low = gsl_cdf_ugaussian_P(shift - cut);
  const double high = gsl_cdf_ugaussian_P(shift + cut);
  const double z = gsl_cdf_ugaussian_Pinv(low + u * (high - low)) - shift;
  return GSL_MIN(GSL_MAX(z, -cut), cut);
}

double sizes_quantile(const struct sizes *s, double u) {
  switch (s->kind) {
  case SIZES_UNIFORM: /* by volume r^-3, and so r^-2 below r */
    return s->by_volume ? power_law(s->a, s->b, 2, u)
                        : s->a + (s->b - s->a) * u;
  case SIZES_NORMAL:
    return s->a + s->b * between(0, normal_cut, u);
  case SIZES_LOGNORMAL: /* by number it is one too, 3 sigma^2 lower */
    return s->a *
           exp(s->b * between(s->by_volume ? 3 * s->b : 0, lognormal_cut, u));
  default:
    break;
  }
  const size_t k = find_class(s, &u);
  return s->kind == SIZES_MIX ? s->radius[k]
                              : power_law(s->radius[k], s->radius[k + 1], 3, u);
}

int sizes_draw(const struct sizes *s, size_t seed, size_t n, double radius[]) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_ranlxd2);
  if (!rng)
    return GSL_ENOMEM;
  gsl_rng_set(rng, (unsigned long)seed);
  for (size_t i = 0; i < n; i++)
    radius[i] =
        sizes_quantile(s, ((double)i + gsl_rng_uniform(rng)) / (double)n);
  gsl_ran_shuffle(rng, radius, n, sizeof *radius);
  gsl_rng_free(rng);
  return GSL_SUCCESS;
}

void sizes_masses(size_t n, const double radius[], double mean, double mass,
                  double masses[]) {
  for (size_t i = 0; i < n; i++)
    masses[i] = mass * gsl_pow_3(radius[i] / mean);
}
