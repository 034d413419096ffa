/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pair correlation (measure/correlation) and bond order (measure/bond_order).
 */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sf_legendre.h>
#include "measure/bond_order.h"
#include "check.h"
#include "measure/correlation.h"
#include "lattice.h"
#include "sample.h"
#include "geometry/vec3.h"

static const double eps = GSL_DBL_EPSILON;
static const double open[3];

/* Pairs of a block of n^3 points of the simple cubic lattice: those a apart
   along x, b along y, c along z are (n-a)(n-b)(n-c) for each sign and order. */
static void test_sc_pairs(void) {
  enum { N = 7, BINS = 22 };
  const struct lattice l = lattice_named("sc");
  struct bed b;
  size_t centre;
  CHECK(lattice_bed(&l, N, &b, &centre) == GSL_SUCCESS);
  const struct region box = {.box = {-3.5, 3.5, -3.5, 3.5, -3.5, 3.5}};
  double pairs[BINS], expected[BINS], want[BINS] = {0};
  /* bins of 0.1 from 0 to 2.2: sqrt(1), sqrt(2), sqrt(3), sqrt(4) are 1, 1.41,
     1.73, 2; moved by a little so that none is on an edge */
  const double rmax = 2.2 * (1 - 1e-6);
  CHECK(correlation_count(b.n, b.x, &box, rmax, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  want[10] = 3 * N * N * (N - 1);
  want[14] = 6 * N * (N - 1) * (N - 1);
  want[17] = 4 * (N - 1) * (N - 1) * (N - 1);
  want[20] = 3 * N * N * (N - 2);
  for (size_t k = 0; k < BINS; k++)
    CHECK(pairs[k] == want[k]);
  bed_free(&b);
}

/* Shells around the deepest point: what the block has less without it. */
static void test_shells(const char *name, size_t count,
                        const double (*shell)[2]) {
  const struct lattice l = lattice_named(name);
  struct bed b;
  size_t centre;
  CHECK(lattice_bed(&l, 6, &b, &centre) == GSL_SUCCESS);
  const struct region box = {.box = {-9, 9, -9, 9, -9, 9}};
  enum { BINS = 200 };
  const double rmax = 2.0001;
  double all[BINS], expected[BINS], sum[BINS] = {0};
  double *rest = calloc(3 * b.n, sizeof *rest);
  CHECK(correlation_count(b.n, b.x, &box, rmax, BINS, NULL, all, expected) ==
        GSL_SUCCESS);
  memcpy(rest, b.x, 3 * b.n * sizeof *rest);
  memcpy(rest + 3 * centre, b.x + 3 * (b.n - 1), 3 * sizeof *rest);
  CHECK(correlation_count(b.n - 1, rest, &box, rmax, BINS, NULL, sum,
                          expected) == GSL_SUCCESS);
  for (size_t k = 0; k < BINS; k++) {
    double want = 0;
    for (size_t s = 0; s < count; s++)
      if ((size_t)(shell[s][0] / rmax * BINS) == k)
        want += shell[s][1];
    if (!CHECK(all[k] - sum[k] == want))
      fprintf(stderr, "  %s at %g: %g, expected %g\n", name,
              rmax * (double)k / BINS, all[k] - sum[k], want);
  }
  free(rest);
  bed_free(&b);
}

/* Points of a box that holds every distance: the expected pairs are all pairs,
   n(n-1)/2, whatever the shells' edges. */
static void test_expected(void) {
  enum { N = 200, BINS = 37 };
  const struct region box = {.box = {-0.3, 0.7, 2, 4.5, 0, 0.8}};
  double x[3 * N], pairs[BINS], expected[BINS], sum = 0, found = 0;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (size_t i = 0; i < 3 * N; i++)
    x[i] = uniform(rng, box.box[2 * (i % 3)], box.box[2 * (i % 3) + 1]);
  const double diagonal = sqrt(1 + 2.5 * 2.5 + 0.64) * 1.0001;
  CHECK(correlation_count(N, x, &box, diagonal, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  for (size_t k = 0; k < BINS; k++) {
    sum += expected[k];
    found += pairs[k];
    CHECK(expected[k] >= 0);
  }
  CHECK(found == N * (N - 1) / 2.);
  /* each point's shells add up to the box but for the rounding of each ball */
  CHECK_REL(sum, N * (N - 1) / 2., 1e-12);

  /* without faces in reach: n(n-1)/2 times the shell's share of the box */
  for (size_t i = 0; i < 3 * N; i++)
    x[i] = 5 + 0.01 * gsl_rng_uniform(rng);
  const struct region large = {.box = {0, 10, 0, 10, 0, 10}};
  CHECK(correlation_count(N, x, &large, 2, 2, NULL, pairs, expected) ==
        GSL_SUCCESS);
  CHECK_REL(expected[0], N * (N - 1) / 2. * 4 * M_PI / 3 / 1000, 8 * eps);
  CHECK_REL(expected[1], N * (N - 1) / 2. * 4 * M_PI / 3 * 7 / 1000, 8 * eps);
  CHECK(pairs[0] == N * (N - 1) / 2. && pairs[1] == 0);
  gsl_rng_free(rng);

  x[4] = GSL_NAN;
  CHECK(correlation_count(N, x, &large, 2, 2, NULL, pairs, expected) ==
        GSL_EINVAL);
  CHECK(correlation_count(1, x, &large, 2, 2, NULL, pairs, expected) ==
        GSL_SUCCESS);
  CHECK(pairs[0] == 0 && expected[0] == 0);
  CHECK(correlation_count(0, x, &large, 2, 2, NULL, pairs, expected) ==
        GSL_SUCCESS);
  CHECK(pairs[0] == 0 && expected[0] == 0);
}

/* Random points: counts are Poisson's about the expected, to the edge even
   where most of a shell is outside. Chi-squared, two-sided at 1e-4. */
static void test_random_points(unsigned long seed, bool periodic) {
  enum { N = 1500, BINS = 40 };
  const double side = periodic ? 1 : 0;
  const struct region box = {.box = {0, 1, 0, 1, 0, 1.5},
                             .period = {side, side, 0}};
  double *x = calloc(3 * N, sizeof *x), pairs[BINS], expected[BINS];
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < 3 * N; i++)
    x[i] = box.box[2 * (i % 3) + 1] * gsl_rng_uniform(rng);
  CHECK(correlation_count(N, x, &box, 0.6, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  double chi2 = 0, all = 0, want = 0;
  for (size_t k = 0; k < BINS; k++) {
    chi2 += gsl_pow_2(pairs[k] - expected[k]) / expected[k];
    all += pairs[k];
    want += expected[k];
  }
  const double p = gsl_cdf_chisq_Q(chi2, BINS);
  if (!CHECK(p > 1e-4 && p < 1 - 1e-4))
    fprintf(stderr, "  seed %lu: chi2 %g of %d, p %g\n", seed, chi2, BINS, p);
  CHECK_CLOSE(all, want, 4 * sqrt(want));
  gsl_rng_free(rng);
  free(x);
}

/* The same in a tube of no particular direction; and with shells that reach
   through all of it, where the expected pairs are all pairs. */
static void test_tube_points(unsigned long seed) {
  enum { N = 1000, BINS = 30 };
  const struct region tube = {.radius = 0.4,
                              .point = {3, -2, 7},
                              .axis = {1. / 3, 2. / 3, -2. / 3},
                              .ends = {-0.5, 1.2}};
  const double side[3] = {2. / 3, 1. / 3, 2. / 3};
  double across[3], x[3 * N], pairs[BINS], expected[BINS];
  vec3_cross(tube.axis, side, across);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < N; i++) {
    const double a = 0.4 * sqrt(gsl_rng_uniform(rng));
    const double angle = 2 * M_PI * gsl_rng_uniform(rng);
    memcpy(x + 3 * i, tube.point, 3 * sizeof *x);
    vec3_axpy(a * cos(angle), side, x + 3 * i);
    vec3_axpy(a * sin(angle), across, x + 3 * i);
    vec3_axpy(uniform(rng, -0.5, 1.2), tube.axis, x + 3 * i);
    CHECK(region_holds(&tube, x + 3 * i));
  }
  gsl_rng_free(rng);
  CHECK(correlation_count(N, x, &tube, 0.9, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  double chi2 = 0, sum = 0;
  for (size_t k = 0; k < BINS; k++)
    chi2 += gsl_pow_2(pairs[k] - expected[k]) / expected[k];
  const double p = gsl_cdf_chisq_Q(chi2, BINS);
  if (!CHECK(p > 1e-4 && p < 1 - 1e-4))
    fprintf(stderr, "  seed %lu: chi2 %g of %d, p %g\n", seed, chi2, BINS, p);
  CHECK(correlation_count(N, x, &tube, hypot(0.8, 1.7) * 1.001, BINS, NULL,
                          pairs, expected) == GSL_SUCCESS);
  for (size_t k = 0; k < BINS; k++)
    sum += expected[k];
  CHECK_REL(sum, N * (N - 1) / 2., 1e-9);
}

/* q_l^2 = mean of P_l(cos) over all pairs of bonds, by the addition theorem: no
   spherical harmonics. */
static double oracle_q(const struct bed *b, size_t i, double cutoff, int l) {
  double u[64][3], sum = 0;
  size_t n = 0;
  for (size_t j = 0; j < b->n; j++) {
    vec3_sub(b->x + 3 * j, b->x + 3 * i, u[n]);
    const double d = vec3_norm(u[n]);
    for (int k = 0; k < 3; k++)
      u[n][k] /= d;
    n += j != i && d <= cutoff;
  }
  for (size_t p = 0; p < n; p++)
    for (size_t q = 0; q < n; q++) {
      const double c = vec3_dot(u[p], u[q]);
      sum += gsl_sf_legendre_Pl(l, GSL_MAX(-1, GSL_MIN(1, c)));
    }
  return n ? sqrt(sum) / (double)n : 0;
}

/* Turned to no particular direction: invariants stay. */
static void turn(struct bed *b) {
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < 3; k++) {
      double *p = &b->x[3 * i + k], *q = &b->x[3 * i + (k + 1) % 3];
      const double c = cos(0.3 + (double)k), s = sin(0.3 + (double)k), x = *p,
                   y = *q;
      *p = c * x - s * y;
      *q = s * x + c * y;
    }
}

static void test_order(const char *name, size_t neighbours, double q4,
                       double q6, double w4, double w6, enum bond_class class) {
  const struct lattice l = lattice_named(name);
  const double cutoff = 1.2;
  struct bed b;
  size_t centre;
  CHECK(lattice_bed(&l, 6, &b, &centre) == GSL_SUCCESS);
  struct bond_order *o = calloc(b.n, sizeof *o);
  for (int turned = 0; turned < 2; turned++) {
    CHECK(bond_order_find(b.n, b.x, open, cutoff, NULL, o) == GSL_SUCCESS);
    const struct bond_order *c = &o[centre];
    CHECK(c->neighbours == neighbours);
    CHECK_CLOSE(c->q4, q4, 1e-9);
    CHECK_CLOSE(c->q6, q6, 1e-9);
    /* all neighbours are alike, so are the averages */
    CHECK_CLOSE(c->qbar4, q4, 1e-9);
    CHECK_CLOSE(c->qbar6, q6, 1e-9);
    CHECK_CLOSE(c->wbar4, w4, 1e-6); /* six published digits */
    CHECK_CLOSE(c->wbar6, w6, 1e-6);
    CHECK(bond_order_class(c, 0.4) == class);
    for (size_t i = 0; i < b.n; i += 17) {
      CHECK_CLOSE(o[i].q4, oracle_q(&b, i, cutoff, 4), 1e-9);
      CHECK_CLOSE(o[i].q6, oracle_q(&b, i, cutoff, 6), 1e-9);
    }
    turn(&b);
  }
  free(o);
  bed_free(&b);
}

/* Ideal hcp has no short closed form: the addition theorem over its bonds. */
static double hcp_q(int l) {
  const struct lattice h = lattice_named("hcp");
  struct bed b;
  size_t centre;
  if (lattice_bed(&h, 6, &b, &centre) != GSL_SUCCESS)
    return GSL_NAN;
  const double q = oracle_q(&b, centre, 1.2, l);
  bed_free(&b);
  return q;
}

/* Averages over unlike neighbours against their definition, by the addition
   theorem: |sum over i of q_lm(i)|^2 = sums of P_l over bonds of both. */
static void test_averages(void) {
  enum { N = 40 };
  double x[3 * N];
  struct bond_order o[N];
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 11);
  for (size_t i = 0; i < 3 * N; i++)
    x[i] = gsl_rng_uniform(rng);
  gsl_rng_free(rng);
  const double cutoff = 0.35;
  CHECK(bond_order_find(N, x, open, cutoff, NULL, o) == GSL_SUCCESS);
  double u[N][N][3];
  bool near[N][N];
  size_t count[N] = {0};
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < N; j++) {
      vec3_sub(x + 3 * j, x + 3 * i, u[i][j]);
      const double d = vec3_norm(u[i][j]);
      near[i][j] = i != j && d <= cutoff;
      count[i] += near[i][j];
      for (int k = 0; k < 3; k++)
        u[i][j][k] /= d;
    }
  for (size_t i = 0; i < N; i++) {
    CHECK(o[i].neighbours == count[i]);
    for (int l = 4; l <= 6; l += 2) {
      double sum = 0;
      for (size_t a = 0; a < N; a++)
        for (size_t c = 0; c < N; c++) {
          if ((a != i && !near[i][a]) || (c != i && !near[i][c]))
            continue;
          for (size_t p = 0; p < N; p++)
            for (size_t q = 0; q < N; q++)
              if (near[a][p] && near[c][q]) {
                const double cosine = vec3_dot(u[a][p], u[c][q]);
                sum += gsl_sf_legendre_Pl(l, GSL_MAX(-1, GSL_MIN(1, cosine))) /
                       (double)(count[a] * count[c]);
              }
        }
      const double want = sqrt(sum) / (double)(count[i] + 1);
      CHECK_CLOSE(l == 4 ? o[i].qbar4 : o[i].qbar6, want, 1e-9);
    }
  }

  /* no neighbours, one, and the same place twice */
  CHECK(bond_order_find(2, (double[]){0, 0, 0, 2, 0, 0}, open, 1, NULL, o) ==
        GSL_SUCCESS);
  CHECK(o[0].neighbours == 0 && o[0].q6 == 0 && o[0].qbar6 == 0);
  CHECK(bond_order_class(&o[0], 0.4) == BOND_DISORDERED);
  CHECK(bond_order_find(2, (double[]){0, 0, 0, 0, 0, -1}, open, 1, NULL, o) ==
        GSL_SUCCESS);
  CHECK(o[0].neighbours == 1);
  CHECK_CLOSE(o[0].q4, 1, 16 * eps);
  CHECK_CLOSE(o[1].qbar6, 1, 16 * eps);
  CHECK(bond_order_find(2, (double[]){1, 2, 3, 1, 2, 3}, open, 1, NULL, o) ==
        GSL_EDOM);
  CHECK(bond_order_find(1, (double[]){1, GSL_NAN, 3}, open, 1, NULL, o) ==
        GSL_EINVAL);
}

/* A crystal without an end: cells^3 cells about the origin, periodic along all
   axes, moved to no particular place. */
static struct region crystal(const char *name, size_t cells, struct bed *b) {
  const struct lattice l = lattice_named(name);
  struct region g = {.box = {0}};
  size_t centre;
  CHECK(lattice_bed(&l, cells, b, &centre) == GSL_SUCCESS);
  for (size_t k = 0; k < 3; k++)
    g.box[2 * k + 1] = g.period[k] = (double)cells * l.edge[k];
  for (size_t i = 0; i < 3 * b->n; i++)
    b->x[i] += 17.3 + 0.21 * (double)(i % 3);
  return g;
}

/* Every sphere of it has the neighbourhood that only the deepest of a block
   has, and every shell is whole. */
static void test_crystal(const char *name, size_t neighbours, double q4,
                         double q6, enum bond_class class, size_t count,
                         const double (*shell)[2]) {
  enum { BINS = 200 };
  struct bed b;
  const struct region g = crystal(name, 3, &b);
  const double rmax = 2.0001, n = (double)b.n;
  double pairs[BINS], expected[BINS];
  struct bond_order *o = calloc(b.n, sizeof *o);
  CHECK(bond_order_find(b.n, b.x, g.period, 1.2, NULL, o) == GSL_SUCCESS);
  for (size_t i = 0; i < b.n; i++) {
    CHECK(o[i].neighbours == neighbours);
    CHECK_CLOSE(o[i].q4, q4, 1e-9);
    CHECK_CLOSE(o[i].q6, q6, 1e-9);
    CHECK_CLOSE(o[i].qbar6, q6, 1e-9);
    CHECK(bond_order_class(&o[i], 0.4) == class);
  }
  CHECK(correlation_count(b.n, b.x, &g, rmax, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  for (size_t k = 0; k < BINS; k++) {
    double want = 0;
    for (size_t s = 0; s < count; s++)
      if ((size_t)(shell[s][0] / rmax * BINS) == k)
        want += n * shell[s][1] / 2;
    if (!CHECK(pairs[k] == want))
      fprintf(stderr, "  %s at %g: %g, expected %g\n", name,
              rmax * (double)k / BINS, pairs[k], want);
    const double volume =
        4 * M_PI / 3 * gsl_pow_3(rmax / BINS) * (double)(3 * k * k + 3 * k + 1);
    CHECK_REL(expected[k], n * (n - 1) / 2 * volume / region_volume(&g), 1e-12);
  }
  free(o);
  bed_free(&b);
}

/* Beyond half a period and a whole one, where images two periods away count:
   all images of others, at 3 those of (2 2 1) and not those of (3 0 0), which
   are the sphere itself, and so at sqrt(18) without (3 3 0). */
static void test_all_images(void) {
  enum { BINS = 45 };
  struct bed b;
  const struct region g = crystal("sc", 3, &b);
  double pairs[BINS], expected[BINS];
  const double squares[][2] = {{1, 6},   {2, 12},  {3, 8},   {4, 6},   {5, 24},
                               {6, 24},  {8, 12},  {9, 24},  {10, 24}, {11, 24},
                               {12, 8},  {13, 24}, {14, 48}, {16, 6},  {17, 48},
                               {18, 24}, {19, 24}, {20, 24}};
  const double rmax = 4.5 * (1 - 1e-6);
  CHECK(correlation_count(b.n, b.x, &g, rmax, BINS, NULL, pairs, expected) ==
        GSL_SUCCESS);
  for (size_t k = 0; k < BINS; k++) {
    double want = 0;
    for (size_t s = 0; s < sizeof squares / sizeof *squares; s++)
      if ((size_t)(sqrt(squares[s][0]) / rmax * BINS) == k)
        want += 27 * squares[s][1] / 2;
    CHECK(pairs[k] == want);
  }
  /* one sphere of a cell and its own images: a lattice of 6 neighbours each */
  struct bond_order o;
  const double x[3] = {7, 8, 9}, period[3] = {1, 1, 1};
  CHECK(bond_order_find(1, x, period, 1.2, NULL, &o) == GSL_SUCCESS);
  CHECK(o.neighbours == 6);
  CHECK_CLOSE(o.q4, 0.7637626158259734, 1e-9);
  CHECK_CLOSE(o.q6, 0.3535533905932738, 1e-9);
  bed_free(&b);
}

struct ideal {
  const char *name;
  size_t shells;
  double shell[6][2]; /* distance, spheres */
  size_t neighbours;
  double q4, q6, w4, w6;
  enum bond_class class;
};

int main(void) {
  gsl_set_error_handler_off();
  test_sc_pairs();
  /* cubic bonds: sc sqrt(7/12), sqrt(1/8); the 8 of bcc -sqrt(7/27),
     sqrt(32/81); with its 6 next ones the mean by their numbers */
  const struct ideal ideals[] = {
      {"sc",
       4,
       {{1, 6}, {sqrt(2), 12}, {sqrt(3), 8}, {2, 6}},
       6,
       sqrt(7. / 12),
       sqrt(1. / 8),
       0.159317,
       0.013161,
       BOND_DISORDERED},
      {"bcc",
       5,
       {{1, 8},
        {sqrt(4. / 3), 6},
        {sqrt(8. / 3), 12},
        {sqrt(11. / 3), 24},
        {2, 8}},
       14,
       (6 * sqrt(7. / 12) - 8 * sqrt(7. / 27)) / 14,
       (6 * sqrt(1. / 8) + 8 * sqrt(32. / 81)) / 14,
       0.159317,
       0.013161,
       BOND_BCC},
      {"fcc",
       4,
       {{1, 12}, {sqrt(2), 6}, {sqrt(3), 24}, {2, 12}},
       12,
       sqrt(7. / 192),
       sqrt(169. / 512),
       -0.159317,
       -0.013161,
       BOND_FCC},
      {"hcp",
       6,
       {{1, 12},
        {sqrt(2), 6},
        {sqrt(8. / 3), 2},
        {sqrt(3), 18},
        {sqrt(11. / 3), 12},
        {2, 6}},
       12,
       hcp_q(4),
       hcp_q(6),
       0.134097,
       -0.012442,
       BOND_HCP}};
  for (size_t k = 0; k < sizeof ideals / sizeof *ideals; k++) {
    const struct ideal *l = &ideals[k];
    test_shells(l->name, l->shells, l->shell);
    test_order(l->name, l->neighbours, l->q4, l->q6, l->w4, l->w6, l->class);
    test_crystal(l->name, l->neighbours, l->q4, l->q6, l->class, l->shells,
                 l->shell);
  }
  CHECK_CLOSE(hcp_q(4), 0.097, 5e-4); /* Mickel et al. 2013 */
  CHECK_CLOSE(hcp_q(6), 0.485, 5e-4);
  test_all_images();
  test_expected();
  for (unsigned long seed = 1; seed <= 2; seed++)
    for (int periodic = 0; periodic < 2; periodic++)
      test_random_points(seed, periodic);
  test_tube_points(1);
  test_tube_points(2);
  test_averages();
  return check_done();
}
