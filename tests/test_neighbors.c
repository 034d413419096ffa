/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of neighbours against a plain search of all pairs. The random clouds
   are numbered by their seeds; a failing one prints its own. */
#define _POSIX_C_SOURCE 200809L
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "check.h"
#include "limit.h"
#include "geometry/neighbors.h"
#include "sample.h"

struct cloud {
  size_t n, stride;
  double *x, *r; /* n rows stride apart; n */
};

static struct cloud new_cloud(size_t n, size_t stride) {
  /* exactly as long as promised: the last row may end after z */
  struct cloud c = {n, stride,
                    malloc((n ? (n - 1) * stride + 3 : 1) * sizeof(double)),
                    malloc((n ? n : 1) * sizeof(double))};
  if (!c.x || !c.r)
    abort();
  for (size_t u = 0; n && u < (n - 1) * stride + 3; u++)
    c.x[u] = NAN; /* what is between the rows is not looked at */
  return c;
}

static void free_cloud(struct cloud *c) {
  free(c->x);
  free(c->r);
}

/* Where rounding decides: gaps within this of reach may be listed or not. The
   gap comes from differences of coordinates and a few sums. */
static double undecided(const struct cloud *c, size_t i, size_t j,
                        double reach) {
  return 8 * DBL_EPSILON * (c->r[i] + c->r[j] + fabs(reach));
}

static double gap_of(const struct cloud *c, size_t i, size_t j) {
  const double *p = c->x + i * c->stride, *q = c->x + j * c->stride;
  return hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) - c->r[i] -
         c->r[j];
}

/* Sorted, complete, nothing besides, and first[] says where each begins. */
static bool list_is_right(const struct neighbors *nb, const struct cloud *c,
                          double reach, const char *what, unsigned long seed) {
  const char *wrong = NULL;
  size_t p = 0, i = 0, j = 0;
  for (p = 0; p < nb->count && !wrong; p++) {
    i = nb->i[p], j = nb->j[p];
    if (i >= j || j >= c->n)
      wrong = "not i < j < n";
    else if (p &&
             (nb->i[p - 1] > i || (nb->i[p - 1] == i && nb->j[p - 1] >= j)))
      wrong = "not sorted";
  }
  p = 0;
  for (i = 0; i < c->n && !wrong; i++) {
    if (nb->first[i] != p)
      wrong = "first[] is wrong";
    for (j = i + 1; j < c->n && !wrong; j++) {
      const double beyond = gap_of(c, i, j) - reach;
      const bool listed = p < nb->count && nb->i[p] == i && nb->j[p] == j;
      p += listed;
      if (fabs(beyond) <= undecided(c, i, j, reach))
        continue;
      if (listed && beyond > 0)
        wrong = "too far apart";
      if (!listed && !(beyond > 0)) /* so is a gap that is not a number */
        wrong = "not listed";
    }
  }
  if (!wrong && (p != nb->count || nb->first[c->n] != p))
    wrong = "count or first[n] is wrong";
  if (!check_report(!wrong, __FILE__, __LINE__, what))
    fprintf(stderr, "  seed %lu, n=%zu, reach %g: %s at (%zu, %zu)\n", seed,
            c->n, reach, wrong, i, j);
  return !wrong;
}

static bool search(struct neighbors *nb, const struct cloud *c, double reach,
                   const char *what, unsigned long seed) {
  const int status = neighbors_find(nb, c->n, c->x, c->stride, c->r, reach);
  return CHECK(status == GSL_SUCCESS) &&
         list_is_right(nb, c, reach, what, seed);
}

/* --- shapes ----------------------------------------------------------------*/

enum shape {
  CUBE,    /* full */
  SLAB,    /* a plane across the axes */
  PLANE,   /* z = 7 */
  LINE,    /* along y */
  POINT,   /* all in one place */
  PAIR,    /* two clusters far apart */
  FLUNG,   /* one sphere 1e12 away */
  LATTICE, /* on the borders of the grid's cells */
  SHAPES
};
static const char *const shape_names[SHAPES] = {
    "cube", "slab", "plane", "line", "point", "pair", "flung", "lattice"};

static struct cloud random_cloud(gsl_rng *rng, enum shape shape, size_t n,
                                 double spacing, bool equal, double reach) {
  const size_t strides[3] = {3, 6, 9};
  struct cloud c = new_cloud(n, strides[gsl_rng_uniform_int(rng, 3)]);
  const double side = spacing * cbrt((double)n);
  const double centre = uniform(rng, -20, 20);
  /* cells are as wide as the largest sphere reaches */
  const double cell = 2 * 0.1 + reach;
  for (size_t i = 0; i < n; i++) {
    double *x = c.x + i * c.stride;
    c.r[i] = equal ? 0.1 : uniform(rng, 0.01, 0.1);
    for (int k = 0; k < 3; k++)
      x[k] = centre + uniform(rng, -side / 2, side / 2);
    switch (shape) {
    case SLAB:
      x[2] = x[0] - 2 * x[1];
      break;
    case PLANE:
      x[2] = 7;
      break;
    case LINE:
      x[0] = x[2] = -3;
      x[1] *= 5;
      break;
    case POINT:
      x[0] = x[1] = x[2] = centre;
      break;
    case PAIR:
      x[1] += i % 2 ? 1000 : 0;
      break;
    case FLUNG:
      if (i == n / 2)
        x[gsl_rng_uniform_int(rng, 3)] = gsl_rng_get(rng) % 2 ? 1e12 : -1e12;
      break;
    case LATTICE:
      for (int k = 0; k < 3; k++)
        x[k] = cell * floor(x[k] / cell);
      c.r[i] = 0.1;
      break;
    default:
      break;
    }
  }
  return c;
}

/* One list for all searches, so that it grows and shrinks; every so often a
   fresh one must give the same. */
static void test_clouds(gsl_rng *rng) {
  static const double reaches[] = {0, 0.12, 1e-9, -0.05, -0.3, 0.6, 50, 1e300};
  static const size_t sizes[] = {100, 2, 1, 0, 3, 250, 17, 40};
  static const double spacings[] = {0.05, 0.15, 0.4, 3};
  struct neighbors nb = {0};
  size_t pairs = 0;
  for (unsigned long seed = 0; seed < SHAPES * 8 * 8; seed++) {
    gsl_rng_set(rng, seed);
    const enum shape shape = seed % SHAPES;
    const double reach = reaches[seed / SHAPES % 8];
    const size_t n = sizes[(seed + seed / 64) % 8];
    struct cloud c = random_cloud(rng, shape, n, spacings[seed / 7 % 4],
                                  seed % 3 == 0, reach < 1e3 ? reach : 1);
    search(&nb, &c, reach, shape_names[shape], seed);
    pairs += nb.count;
    if (seed % 16 == 0) {
      struct neighbors fresh = {0};
      search(&fresh, &c, reach, "fresh list", seed);
      CHECK(fresh.count == nb.count);
      neighbors_free(&fresh);
    }
    free_cloud(&c);
  }
  CHECK(pairs > 100000);
  neighbors_free(&nb);
  CHECK(nb.i == NULL && nb.count == 0);
  neighbors_free(&nb); /* and once more */
}

/* --- sizes of all kinds
 * ------------------------------------------------------*/

enum mixture {
  DECADES, /* even over six decades */
  GIANT,   /* one a thousand times larger, in the middle of the list */
  CORNER,  /* half of them a thousand times smaller, all in one corner */
  POINTS,  /* half of them without a radius */
  CLASSES, /* powers of two, on the borders between classes */
  MIXTURES
};
static const char *const mixture_names[MIXTURES] = {
    "decades", "giant", "corner", "points", "classes"};

/* As dense as a bed would be, if the spheres did not overlap. */
static struct cloud mixed_cloud(gsl_rng *rng, enum mixture mixture, size_t n) {
  struct cloud c = new_cloud(n, 3);
  double volume = 0;
  for (size_t i = 0; i < n; i++) {
    const bool odd = i % 2;
    c.r[i] = mixture == DECADES  ? pow(10, uniform(rng, -5, 1))
             : mixture == GIANT  ? (i == n / 2 ? 100 : 0.1)
             : mixture == CORNER ? (odd ? 1e-4 : 0.1)
             : mixture == POINTS
                 ? (odd ? 0 : 0.1)
                 : ldexp(0.1, -(int)gsl_rng_uniform_int(rng, 8));
    volume += mixture == GIANT && i == n / 2 ? 0 : 8 * gsl_pow_3(c.r[i]);
  }
  const double side = cbrt(volume);
  const double corner = 2e-4 * cbrt((double)n / 2);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++)
      c.x[3 * i + k] =
          uniform(rng, 0, mixture == CORNER && i % 2 ? corner : side);
  return c;
}

static void test_mixtures(gsl_rng *rng) {
  static const double reaches[] = {0, 0.03, 1e-4, -0.05, 1};
  static const size_t sizes[] = {300, 2, 1, 90, 700};
  struct neighbors nb = {0};
  size_t pairs = 0;
  for (unsigned long seed = 0; seed < MIXTURES * 5 * 5; seed++) {
    gsl_rng_set(rng, seed);
    struct cloud c =
        mixed_cloud(rng, seed % MIXTURES, sizes[seed / MIXTURES % 5]);
    search(&nb, &c, reaches[seed / 25], mixture_names[seed % MIXTURES], seed);
    pairs += nb.count;
    free_cloud(&c);
  }
  CHECK(pairs > 10000);
  neighbors_free(&nb);
}

/* By hand: what touches, at most reach included. All numbers are exact. */
static void test_exact(void) {
  double x[] = {0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, -8}, r[] = {1, 2, 1, 3};
  /* gaps: 01: 0; 02: 2; 03: 4; 12: 5 - 3 = 2; 13: sqrt(73) - 5 = 3.544;
     23: sqrt(80) - 4 = 4.944 */
  static const struct {
    double reach;
    size_t count;
    uint32_t i[6], j[6];
  } cases[] = {{0, 1, {0}, {1}},
               {-1e-15, 0, {0}, {0}},
               {1.9999999999999, 1, {0}, {1}},
               {2, 3, {0, 0, 1}, {1, 2, 2}},
               {4, 5, {0, 0, 0, 1, 1}, {1, 2, 3, 2, 3}},
               {5, 6, {0, 0, 0, 1, 1, 2}, {1, 2, 3, 2, 3, 3}}};
  struct neighbors nb = {0};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    CHECK(neighbors_find(&nb, 4, x, 3, r, cases[c].reach) == GSL_SUCCESS);
    CHECK(nb.count == cases[c].count);
    for (size_t p = 0; p < nb.count && p < cases[c].count; p++)
      CHECK(nb.i[p] == cases[c].i[p] && nb.j[p] == cases[c].j[p]);
  }
  neighbors_free(&nb);
}

/* --- what it costs ---------------------------------------------------------*/

static double seconds(const struct cloud *c, struct neighbors *nb,
                      double reach) {
  struct timespec t[2];
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t[0]);
  CHECK(neighbors_find(nb, c->n, c->x, c->stride, c->r, reach) == GSL_SUCCESS);
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t[1]);
  return (double)(t[1].tv_sec - t[0].tv_sec) +
         1e-9 * (double)(t[1].tv_nsec - t[0].tv_nsec);
}

/* A sphere that escaped must cost neither memory nor time: the grid takes no
   more than a few words for each sphere. All pairs of 20,000 spheres would
   take some hundred times as long as those of a grid; a factor of 20 leaves
   room for a coarser grid and for the clock. */
static void test_flung_cost(gsl_rng *rng) {
  enum { N = 20000 };
  gsl_rng_set(rng, 1);
  struct cloud c = new_cloud(N, 3);
  const double side = 0.2 * cbrt(N);
  for (size_t i = 0; i < N; i++) {
    c.r[i] = 0.1;
    for (size_t k = 0; k < 3; k++)
      c.x[3 * i + k] = uniform(rng, 0, side);
  }
  struct neighbors nb = {0};
  seconds(&c, &nb, 0.1);
  const double usual = seconds(&c, &nb, 0.1);
  const size_t pairs = nb.count, tested = nb.tested;
  /* 1e12 along one axis; 1e12 along each; as far as doubles go */
  static const double places[3][3] = {
      {0, 0, 1e12}, {1e12, -1e12, 1e12}, {-1e300, 0, 0}};
  for (int p = 0; p < 3; p++) {
    memcpy(c.x + 3 * 777, places[p], sizeof places[p]);
    const double time = seconds(&c, &nb, 0.1);
    printf("%d spheres: %.4f s; with one at (%g, %g, %g): %.4f s\n", N, usual,
           places[p][0], places[p][1], places[p][2], time);
    CHECK(nb.count > pairs - 100 && nb.count < pairs);
    CHECK(nb.scratch_size < 100 * N);
    CHECK(time < 20 * usual + 0.01);
    /* two layers of 2 % on either side share the cells at the border */
    CHECK(nb.tested < 2 * tested);
    for (size_t q = 0; q < nb.count; q++)
      if (nb.i[q] == 777 || nb.j[q] == 777)
        CHECK(false); /* a far sphere has no partner */
  }
  neighbors_free(&nb);
  free_cloud(&c);
}

/* What it looks at besides the pairs that it finds stays in proportion to the
   spheres, whatever their sizes: a count, so that no clock decides. Of equal
   spheres in a bed some 27 are looked at each; a search in cells as wide as the
   largest sphere would look at thousands. Sparse spheres may have no more cells
   than spheres. */
static void test_mixed_cost(gsl_rng *rng) {
  enum { N = 20000 };
  struct neighbors nb = {0};
  for (unsigned long m = 0; m < MIXTURES; m++) {
    gsl_rng_set(rng, m);
    struct cloud c = mixed_cloud(rng, (enum mixture)m, N);
    const double time = seconds(&c, &nb, 0);
    printf("%d spheres, %s: %zu pairs of %zu looked at, %.4f s\n", N,
           mixture_names[m], nb.count, nb.tested, time);
    CHECK(nb.tested < 400 * (size_t)N);
    CHECK(nb.scratch_size < 100 * N);
    free_cloud(&c);
  }
  gsl_rng_set(rng, 7);
  struct cloud c = random_cloud(rng, CUBE, N, 3, true, 0);
  seconds(&c, &nb, 0);
  CHECK(nb.tested < 400 * (size_t)N);
  CHECK(nb.scratch_size < 100 * N);
  /* far apart, half of them much farther: a grid over all would be one cell */
  for (size_t i = 0; i < N / 50; i++)
    c.x[i * c.stride] = 1e9 * (double)i;
  seconds(&c, &nb, 0);
  CHECK(nb.tested < 400 * (size_t)N);
  CHECK(nb.scratch_size < 100 * N);
  free_cloud(&c);
  /* points: only what is in one place touches, or nothing */
  c = random_cloud(rng, CUBE, N, 0.1, true, 0);
  for (size_t i = 0; i < N; i++)
    c.r[i] = 0;
  for (int negative = 0; negative < 2; negative++) {
    CHECK(neighbors_find(&nb, N, c.x, c.stride, c.r, -negative) == GSL_SUCCESS);
    CHECK(nb.count == 0 && nb.tested < 400 * (size_t)N);
  }
  free_cloud(&c);
  neighbors_free(&nb);
}

/* --- errors ----------------------------------------------------------------*/

static void test_errors(gsl_rng *rng) {
  gsl_rng_set(rng, 2);
  struct neighbors nb = {0};
  struct cloud c = random_cloud(rng, CUBE, 12, 0.2, true, 0.1);
  search(&nb, &c, 0.1, "before", 2);
  static const double bad[] = {NAN, INFINITY, -INFINITY};
  for (size_t i = 0; i < 12; i++)
    for (size_t k = 0; k < 3; k++)
      for (size_t b = 0; b < 3; b++) {
        const double good = c.x[i * c.stride + k];
        c.x[i * c.stride + k] = bad[b];
        CHECK(neighbors_find(&nb, 12, c.x, c.stride, c.r, 0.1) == GSL_EINVAL);
        CHECK(nb.count == 0);
        c.x[i * c.stride + k] = good;
      }
  search(&nb, &c, 0.1, "after", 2);
  /* spheres are numbered with 32 bits; refused before anything is read */
  CHECK(neighbors_find(&nb, (size_t)UINT32_MAX, NULL, 3, NULL, 0.1) ==
        GSL_EINVAL);
  CHECK(nb.count == 0);
  CHECK(neighbors_find(&nb, 0, NULL, 3, NULL, 0.1) == GSL_SUCCESS);
  CHECK(nb.count == 0 && nb.first[0] == 0);

  /* differences of these are beyond the largest double: refused or right, but
     an end there must be */
  search(&nb, &c, 0.1, "again", 2);
  static const double huge[] = {1e308, -1.7e308};
  for (size_t h = 0; h < 2; h++) {
    c.x[0] = huge[h];
    c.x[c.stride] = -huge[h];
    const int status = neighbors_find(&nb, 12, c.x, c.stride, c.r, 0.1);
    CHECK(status == GSL_EINVAL || status == GSL_SUCCESS);
    if (status == GSL_SUCCESS)
      list_is_right(&nb, &c, 0.1, "huge", h);
    else
      CHECK(nb.count == 0);
  }
  neighbors_free(&nb);
  free_cloud(&c);
}

/* Threads share a search and find the same list. */
static void test_threads(gsl_rng *rng) {
  enum { N = 5001 };
  gsl_rng_set(rng, 5);
  struct cloud c = new_cloud(N, 3);
  for (size_t i = 0; i < N; i++) {
    c.r[i] = 0.1;
    for (size_t k = 0; k < 3; k++)
      c.x[3 * i + k] = uniform(rng, 0, 3);
  }
  struct neighbors one = {0};
  CHECK(neighbors_find(&one, N, c.x, c.stride, c.r, 0.1) == GSL_SUCCESS);
  CHECK(one.count > N);
  for (size_t threads = 2; threads <= 4; threads++) {
    struct neighbors nb = {.threads = threads};
    for (size_t again = 0; again < 2; again++)
      CHECK(neighbors_find(&nb, N, c.x, c.stride, c.r, 0.1) == GSL_SUCCESS);
    CHECK(nb.count == one.count && nb.tested == one.tested);
    CHECK(!memcmp(nb.i, one.i, one.count * sizeof *nb.i));
    CHECK(!memcmp(nb.j, one.j, one.count * sizeof *nb.j));
    CHECK(!memcmp(nb.first, one.first, (N + 1) * sizeof *nb.first));
    neighbors_free(&nb);
  }
  neighbors_free(&one);
  free_cloud(&c);
}

int main(void) {
  limit_cpu(300); /* a loop without end is a failure too */
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_clouds(rng);
  test_mixtures(rng);
  test_exact();
  test_flung_cost(rng);
  test_mixed_cost(rng);
  test_threads(rng);
  test_errors(rng);
  gsl_rng_free(rng);
  return check_done();
}
