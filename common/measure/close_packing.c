/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/close_packing.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>

/* Rods: the error of the fraction is some 1/RODS of it. */
enum { RODS = 20000 };

/* Least gap by the shorter neighbour. */
static const double least_gap = 0.7654;

/* Chords at random: a line meets spheres in proportion to their squares, and at
   a distance from the centre whose square is even, so a chord's square is a
   share u, even as well, of the diameter's. The rods' u and their spheres are
   stratified, and independent of each other: the latter in the order of a
   golden section. */
static void make_rods(size_t n, const double r[], double squares, double *rod) {
  const double golden = 0.5 * (sqrt(5) - 1);
  size_t sphere = 0;
  double below = r[0] * r[0];
  for (size_t k = 0; k < RODS; k++) {
    const double at = squares * ((double)k + 0.5) / RODS;
    while (below < at && sphere + 1 < n) {
      sphere++;
      below += r[sphere] * r[sphere];
    }
    const double u = golden * ((double)k + 0.5);
    rod[k] = 2 * r[sphere] * sqrt(u - floor(u));
  }
}

/* A heap with the widest gap first. */
static void sift_down(double *gap, size_t count) {
  const double moved = gap[0];
  size_t at = 0;
  for (size_t next; (next = 2 * at + 1) < count; at = next) {
    next += next + 1 < count && gap[next + 1] > gap[next];
    if (!(gap[next] > moved))
      break;
    gap[at] = gap[next];
  }
  gap[at] = moved;
}

static void sift_up(double *gap, size_t at) {
  const double moved = gap[at];
  for (; at > 0 && gap[(at - 1) / 2] < moved; at = (at - 1) / 2)
    gap[at] = gap[(at - 1) / 2];
  gap[at] = moved;
}

int close_packing_rods(size_t n, const double r[], double *fraction) {
  double *rod = malloc(2 * RODS * sizeof *rod), *gap = rod + RODS;
  double *sorted = malloc(n * sizeof *sorted);
  if (!rod || !sorted) {
    free(rod);
    free(sorted);
    return GSL_ENOMEM;
  }
  double squares = 0, rods = 0, gaps = 0;
  for (size_t i = 0; i < n; i++) {
    sorted[i] = r[i];
    squares += r[i] * r[i];
  }
  gsl_sort(sorted, 1, n); /* the order of spheres does not matter */
  make_rods(n, sorted, squares, rod);
  gsl_sort(rod, 1, RODS);
  for (size_t k = 0; k < RODS; k++) {
    const double length = rod[RODS - 1 - k], least = least_gap * length;
    rods += length;
    if (k > 0) {
      gap[0] = GSL_MAX(least, gap[0] - length - least);
      sift_down(gap, k);
    }
    gap[k] = least;
    sift_up(gap, k);
  }
  for (size_t k = 0; k < RODS; k++)
    gaps += gap[k];
  free(rod);
  free(sorted);
  *fraction = rods / (rods + gaps);
  return GSL_SUCCESS;
}

void close_packing_spread(size_t n, const double r[], double *deviation,
                          double *skewness) {
  *deviation = *skewness = 0;
  if (n == 0 || !(gsl_stats_max(r, 1, n) > gsl_stats_min(r, 1, n)))
    return;
  const double mean = gsl_stats_mean(r, 1, n);
  const double sd = gsl_stats_sd_with_fixed_mean(r, 1, n, mean);
  *deviation = sd / mean;
  *skewness = gsl_stats_skew_m_sd(r, 1, n, mean, sd);
}

double close_packing_spread_fraction(double deviation, double skewness) {
  return 0.634 + 0.0658 * deviation + 0.0857 * skewness * deviation * deviation;
}
