/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How radii are distributed, and spheres of such radii. Not in the paper.

   A distribution is given by its share of spheres in each range of radii, or by
   the share of their volume. All have two ends, since one giant would decide
   about a bed: a normal one is cut at 3 standard deviations, a lognormal one at
   4, on either side. A sieve's classes, and a normal distribution by volume,
   are tables: within a class the volume is spread evenly over the logarithm of
   the size, as the straight pieces of a sieve curve have it.

   The k-th of n spheres takes its radius from the k-th n-th of the distribution
   (stratified sampling), and then they are shuffled: a mix of 30 % has 30 % of
   the spheres, up to one, whatever the seed. Safe in any thread. Tested in
   tests/test_sizes.c. */
#ifndef SIZES_H
#define SIZES_H

#include <stdbool.h>
#include <stddef.h>

enum sizes_kind {
  SIZES_UNIFORM,   /* a, b: the ends (m) */
  SIZES_NORMAL,    /* mean and standard deviation (m) */
  SIZES_LOGNORMAL, /* median (m), standard deviation of the logarithm */
  SIZES_MIX,       /* radii and their shares */
  SIZES_TABLE      /* ascending edges of classes and the classes' shares */
};

struct sizes {
  enum sizes_kind kind;
  bool by_volume; /* shares are of the volume, not of the number */
  double a, b;
  size_t count;   /* of a mix's radii, of a table's edges */
  double *radius; /* m */
  double *share;  /* as many; a table's last is 0 */
};

/* Of the first three kinds, by the two numbers. */
int sizes_alloc(struct sizes **out, enum sizes_kind kind, bool by_volume,
                double a, double b);
/* Of the other two: a copy of the columns. Shares are scaled so that they add
   up to 1. A table's are by volume. */
int sizes_alloc_table(struct sizes **out, enum sizes_kind kind, bool by_volume,
                      size_t count, const double radius[],
                      const double share[]);
/* Both return GSL_SUCCESS, GSL_ENOMEM; what is wrong with the numbers is
   sizes_check's. */
void sizes_free(struct sizes *s);

/* NULL if spheres can be drawn, else what is wrong and what was expected, a
   static string. */
const char *sizes_check(const struct sizes *s);

/* Shares add up to 1, or to 100 as percent, within this part of it. */
static const double sizes_rounding = 1e-3;
bool sizes_adds_up(size_t count, const double share[]);

/* The radius that a share u of the spheres, by number, is smaller than;
   0 <= u <= 1. Scales by powers of two to the last bit. */
double sizes_quantile(const struct sizes *s, double u);

/* Radii of n spheres, from a generator of its own: the numbers of a start's
   places do not depend on whether there are sizes. GSL_SUCCESS, GSL_ENOMEM. */
int sizes_draw(const struct sizes *s, size_t seed, size_t n, double radius[]);

/* Masses of spheres of one density, of which one with the mean radius (m) has
   the mass (kg). */
void sizes_masses(size_t n, const double radius[], double mean, double mass,
                  double masses[]);

#endif
