/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Areas of discs and of spheres on a cylinder's shell against closed forms,
   against quadrature of lengths that are found in another way, and against the
   volumes that they integrate to. A failing random case prints its seed.

   An area is a sum of terms of the size of a disc, each with a few rounding
   errors: hence the tolerances of ULPS(terms) times an area. Quadrature has the
   tolerance that it was asked for plus its own estimate of the error. */
#include <float.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "geometry/area.h"
#include "check.h"
#include "geometry/volume.h"
#include "sample.h"

#define ULPS(n) ((n)*DBL_EPSILON)

enum { MOST = 64, PIECES = 4000 };

static double segment(double r, double h) { /* of a disc beyond a line at h */
  return r * r * acos(h / r) - h * sqrt((r - h) * (r + h));
}

static double united(size_t n, const double *c, const double *r,
                     const double b[4]) {
  double area = GSL_NAN;
  CHECK(area_union(n, c, r, b, &area) == GSL_SUCCESS);
  return area;
}

/* --- the oracle: lengths of lines, integrated -----------------------------*/

struct interval {
  double from, to;
};

static int compare_intervals(const void *a, const void *b) {
  const double x = ((const struct interval *)a)->from;
  const double y = ((const struct interval *)b)->from;
  return (x > y) - (x < y);
}

/* Length of the intervals' union, which is sorted on the way. */
static double covered(size_t n, struct interval *v) {
  qsort(v, n, sizeof *v, compare_intervals);
  double length = 0, reached = -GSL_DBL_MAX;
  for (size_t i = 0; i < n; i++) {
    if (v[i].to > reached)
      length += v[i].to - fmax(reached, v[i].from);
    reached = fmax(reached, v[i].to);
  }
  return length;
}

static int compare_doubles(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Integral of f from a to b piece by piece between its kinks. */
static double integral(gsl_function *f, double a, double b, size_t n,
                       double *kinks, double tol, double *error) {
  gsl_integration_cquad_workspace *w =
      gsl_integration_cquad_workspace_alloc(PIECES);
  qsort(kinks, n, sizeof *kinks, compare_doubles);
  double total = 0, left = a;
  for (size_t i = 0; i <= n; i++) {
    const double right = i < n ? fmin(b, fmax(left, kinks[i])) : b;
    double part = 0, estimate = 0;
    if (right > left)
      gsl_integration_cquad(f, left, right, tol, 0, w, &part, &estimate, NULL);
    total += part;
    *error += estimate;
    left = right;
  }
  gsl_integration_cquad_workspace_free(w);
  return total;
}

struct discs {
  size_t n;
  const double *c, *r, *b;
};

static double line_covered(double x, void *params) {
  const struct discs *p = params;
  struct interval v[MOST];
  size_t count = 0;
  for (size_t i = 0; i < p->n; i++) {
    const double d = x - p->c[2 * i], q = p->r[i] * p->r[i] - d * d;
    if (q <= 0)
      continue;
    v[count].from = fmax(p->b[2], p->c[2 * i + 1] - sqrt(q));
    v[count].to = fmin(p->b[3], p->c[2 * i + 1] + sqrt(q));
    count += v[count].from < v[count].to;
  }
  return covered(count, v);
}

/* Kinks are where a circle begins, ends, or crosses another or a side. */
static double oracle_union(size_t n, const double *c, const double *r,
                           const double b[4], double *error) {
  double *kinks = malloc((6 * n + 2 * n * n) * sizeof *kinks);
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const double x = c[2 * i], y = c[2 * i + 1];
    kinks[count++] = x - r[i];
    kinks[count++] = x + r[i];
    for (int k = 2; k < 4; k++) {
      const double q = r[i] * r[i] - (b[k] - y) * (b[k] - y);
      kinks[count++] = x - sqrt(fmax(0, q));
      kinks[count++] = x + sqrt(fmax(0, q));
    }
    for (size_t j = 0; j < i; j++) {
      const double dx = c[2 * j] - x, dy = c[2 * j + 1] - y;
      const double d = hypot(dx, dy);
      const double h = (d + (r[i] - r[j]) * (r[i] + r[j]) / d) / 2;
      const double s = sqrt(fmax(0, r[i] * r[i] - h * h));
      if (d == 0)
        continue;
      kinks[count++] = x + (h * dx - s * dy) / d;
      kinks[count++] = x + (h * dx + s * dy) / d;
    }
  }
  struct discs p = {n, c, r, b};
  gsl_function f = {line_covered, &p};
  const double area = integral(&f, b[0], b[1], count, kinks, 1e-13, error);
  free(kinks);
  return area;
}

/* --- discs ----------------------------------------------------------------*/

static void test_lines(void) {
  const double r = 1.5;
  CHECK_CLOSE(area_disc_lines(r, 0, NULL), M_PI * r * r, ULPS(4) * r * r);
  for (int k = -7; k <= 7; k++) {
    const double h = 0.2 * k;
    const double line[][3] = {{0.6, 0.8, h}};
    CHECK_CLOSE(area_disc_lines(r, 1, line), M_PI * r * r - segment(r, h),
                ULPS(16) * r * r);
    const double strip[][3] = {{0.6, 0.8, h}, {-0.6, -0.8, 0.1 - h}};
    const double beyond = h - 0.1 > -r ? segment(r, h - 0.1) : M_PI * r * r;
    const double both = beyond - segment(r, h);
    CHECK_CLOSE(area_disc_lines(r, 2, strip), both, ULPS(32) * r * r);
  }
  /* lines through the centre: half, quarter, a wedge, nothing */
  const double wedge[][3] = {{-1, 0, 0}, {0, -1, 0}, {0.6, -0.8, 0}};
  CHECK_CLOSE(area_disc_lines(r, 1, wedge), M_PI * r * r / 2, ULPS(16) * r * r);
  CHECK_CLOSE(area_disc_lines(r, 2, wedge), M_PI * r * r / 4, ULPS(16) * r * r);
  CHECK_CLOSE(area_disc_lines(r, 3, wedge), r * r / 2 * atan2(4, 3),
              ULPS(32) * r * r);
  const double none[][3] = {{1, 0, 0}, {-1, 0, 0}};
  CHECK_CLOSE(area_disc_lines(r, 2, none), 0, ULPS(16) * r * r);
  const double same[][3] = {{1, 0, 0.5}, {1, 0, 0.5}, {1, 0, 0.5}};
  CHECK_CLOSE(area_disc_lines(r, 3, same), M_PI * r * r - segment(r, 0.5),
              ULPS(32) * r * r);
  const double bad[][3] = {{1, 0, GSL_NAN}};
  CHECK(isnan(area_disc_lines(r, 1, bad)));
  const double away[][3] = {{1, 0, -r}};
  CHECK(area_disc_lines(r, 1, away) == 0);
  CHECK(area_disc_lines(0, 0, NULL) == 0);
}

static void test_closed_forms(void) {
  const double box[4] = {0, 1, 0, 1};
  const double corners[] = {0, 0, 1, 0, 0, 1, 1, 1},
               big[] = {0.6, 0.6, 0.6, 0.6};
  const double half[] = {0.5, 0.5, 0.5, 0.5};
  /* one disc, quarter by quarter; touching; overlapping */
  CHECK_CLOSE(area_sum(4, corners, half, box), M_PI / 4, ULPS(64));
  CHECK_CLOSE(united(4, corners, half, box), M_PI / 4, ULPS(64));
  CHECK_CLOSE(area_sum(4, corners, big, box), M_PI * 0.36, ULPS(64));
  CHECK_CLOSE(united(4, corners, big, box), M_PI * 0.36 - 4 * segment(0.6, 0.5),
              ULPS(64));
  /* four discs whose borders meet in one point leave nothing uncovered */
  const double root[] = {M_SQRT1_2, M_SQRT1_2, M_SQRT1_2, M_SQRT1_2};
  CHECK_CLOSE(united(4, corners, root, box), 1, ULPS(64));
  /* a disc in a disc, equal discs in one place, one outside */
  const double inner[] = {0.5, 0.5, 0.52, 0.5, 0.5, 0.5, 0.5, 0.5, 3, 0.5};
  const double radii[] = {0.3, 0.1, 0.3, 0.2, 0.3};
  CHECK_CLOSE(united(5, inner, radii, box), M_PI * 0.09, ULPS(64));
  /* two of them, one larger than the rectangle */
  const double two[] = {0.4, 0.5, 0.7, 0.5}, r2[] = {0.2, 0.25};
  const double h = (0.3 + (0.2 * 0.2 - 0.25 * 0.25) / 0.3) / 2;
  CHECK_CLOSE(united(2, two, r2, box),
              M_PI * (0.04 + 0.0625) - segment(0.2, h) - segment(0.25, 0.3 - h),
              ULPS(64));
  const double huge[] = {0.4, 10}, where[] = {0.5, 0.5, 0.2, 0.2};
  CHECK_CLOSE(united(2, where, huge, box), 1, ULPS(256) * 100);
}

static void test_random(void) {
  for (unsigned long seed = 1; seed <= 40; seed++) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    const size_t n = 1 + gsl_rng_uniform_int(rng, 30);
    double c[2 * MOST], r[MOST], b[4], sum = 0, error = 0;
    for (size_t i = 0; i < n; i++) {
      c[2 * i] = gsl_rng_uniform(rng);
      c[2 * i + 1] = gsl_rng_uniform(rng);
      r[i] = seed % 2 ? 0.1 : uniform(rng, 0.01, 0.3);
    }
    for (int k = 0; k < 4; k++)
      b[k] = k % 2 ? uniform(rng, 0.6, 1.2) : uniform(rng, -0.2, 0.5);
    const double area = united(n, c, r, b);
    for (size_t i = 0; i < n; i++)
      sum += oracle_union(1, c + 2 * i, r + i, b, &error);
    bool ok = CHECK_CLOSE(area_sum(n, c, r, b), sum, error + ULPS(64));
    error = 0;
    const double want = oracle_union(n, c, r, b, &error);
    ok &= CHECK_CLOSE(area, want, error + ULPS(64) * (double)n);
    /* two halves of the rectangle */
    const double middle = uniform(rng, b[0], b[1]);
    const double left[4] = {b[0], middle, b[2], b[3]};
    const double right[4] = {middle, b[1], b[2], b[3]};
    ok &= CHECK_CLOSE(united(n, c, r, left) + united(n, c, r, right), area,
                      ULPS(64) * (double)n);
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    gsl_rng_free(rng);
  }
}

static void test_refusals(void) {
  const double b[4] = {0, 1, 0, 1}, bad[4] = {0, GSL_NAN, 0, 1};
  const double none[4] = {1, 0, 0, 1};
  const double c[2] = {0.5, 0.5}, nan[2] = {0.5, GSL_NAN}, r = 0.1;
  const double inf = GSL_POSINF;
  double area = -1;
  CHECK(area_union(1, nan, &r, b, &area) == GSL_EINVAL && area == -1);
  CHECK(area_union(1, c, &inf, b, &area) == GSL_EINVAL && area == -1);
  CHECK(area_union(1, c, &r, bad, &area) == GSL_EINVAL && area == -1);
  CHECK(area_union(1, c, &r, none, &area) == GSL_SUCCESS && area == 0);
  CHECK(area_sum(1, c, &r, none) == 0);
  area = -1;
  CHECK(area_union(0, NULL, NULL, b, &area) == GSL_SUCCESS && area == 0);
  const struct area_shell shell = {{0, 0}, 0, {0, 1}};
  const struct area_shell good = {{0, 0}, 1, {0, 1}};
  const double x[3] = {0.5, GSL_NAN, 0};
  double sum = -1;
  CHECK(area_shell_covered(0, NULL, NULL, &shell, &sum, &area) == GSL_EINVAL);
  CHECK(area_shell_covered(1, x, &r, &good, &sum, &area) == GSL_EINVAL);
  CHECK(sum == -1);
  CHECK(area_shell_covered(0, NULL, NULL, &good, &sum, &area) == GSL_SUCCESS &&
        sum == 0 && area == 0);
}

/* --- slices integrate to the volume ----------------------------------------*/

struct spheres {
  size_t n;
  const double *x, *r;
  const double *box;
  bool sum;
};

static double slice(double z, void *params) {
  const struct spheres *p = params;
  double c[2 * MOST], r[MOST];
  size_t count = 0;
  for (size_t i = 0; i < p->n; i++) {
    const double d = z - p->x[3 * i + 2], q = p->r[i] * p->r[i] - d * d;
    if (q <= 0)
      continue;
    c[2 * count] = p->x[3 * i];
    c[2 * count + 1] = p->x[3 * i + 1];
    r[count++] = sqrt(q);
  }
  return p->sum ? area_sum(count, c, r, p->box) : united(count, c, r, p->box);
}

static void random_spheres(gsl_rng *rng, size_t n, double most, double *x,
                           double *r) {
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++)
      x[3 * i + (size_t)k] = gsl_rng_uniform(rng);
    r[i] = uniform(rng, most / 2, most);
  }
}

static void test_slices(void) {
  for (unsigned long seed = 1; seed <= 4; seed++) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    const size_t n = 12;
    double x[3 * MOST], r[MOST], kinks[2 * MOST];
    random_spheres(rng, n, 0.3, x, r);
    const double box[6] = {0.1, 0.8, 0.2, 0.9, 0.05, 0.95};
    for (size_t i = 0; i < n; i++) {
      kinks[2 * i] = x[3 * i + 2] - r[i];
      kinks[2 * i + 1] = x[3 * i + 2] + r[i];
    }
    struct spheres p = {n, x, r, box, true};
    gsl_function f = {slice, &p};
    double error = 0, volume;
    const double sum =
        integral(&f, box[4], box[5], 2 * n, kinks, 1e-10, &error);
    bool ok = CHECK_CLOSE(sum, volume_sum(n, x, r, box), error + 1e-10);
    p.sum = false;
    error = 0;
    const double whole =
        integral(&f, box[4], box[5], 2 * n, kinks, 1e-10, &error);
    ok &= CHECK(volume_union(n, x, r, box, &volume) == GSL_SUCCESS);
    ok &= CHECK(error < 1e-7);
    ok &= CHECK_CLOSE(whole, volume, error + 1e-10);
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    gsl_rng_free(rng);
  }
}

/* --- shells ----------------------------------------------------------------*/

/* The oracle turns the order of integration: at each azimuth the union of
   segments along the axis, over all azimuths. */
struct mantle {
  struct spheres s;
  const struct area_shell *shell;
};

static double segments(double azimuth, void *params) {
  const struct mantle *m = params;
  const struct area_shell *s = m->shell;
  struct interval v[MOST];
  size_t count = 0;
  for (size_t i = 0; i < m->s.n; i++) {
    const double *x = m->s.x + 3 * i;
    const double dx = s->axis[0] + s->radius * cos(azimuth) - x[0];
    const double dy = s->axis[1] + s->radius * sin(azimuth) - x[1];
    const double q = m->s.r[i] * m->s.r[i] - dx * dx - dy * dy;
    if (q <= 0)
      continue;
    v[count].from = fmax(s->z[0], x[2] - sqrt(q));
    v[count].to = fmin(s->z[1], x[2] + sqrt(q));
    count += v[count].from < v[count].to;
  }
  return s->radius * covered(count, v);
}

static double oracle_shell(size_t n, const double *x, const double *r,
                           const struct area_shell *s, double *error) {
  struct mantle m = {{n, x, r, NULL, false}, s};
  gsl_function f = {segments, &m};
  double kinks[6 * MOST];
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = x[3 * i] - s->axis[0], dy = x[3 * i + 1] - s->axis[1];
    const double a = hypot(dx, dy), over[3] = {0, s->z[0], s->z[1]};
    for (int k = 0; k < 3; k++) { /* the sphere ends, or cuts an end */
      const double zeta = k ? over[k] - x[3 * i + 2] : 0;
      const double t =
          (a * a + s->radius * s->radius + zeta * zeta - r[i] * r[i]) /
          (2 * a * s->radius);
      const double half = acos(fmax(-1, fmin(1, t)));
      kinks[count++] = remainder(atan2(dy, dx) - half, 2 * M_PI);
      kinks[count++] = remainder(atan2(dy, dx) + half, 2 * M_PI);
    }
  }
  return integral(&f, -M_PI, M_PI, count, kinks, 1e-9, error);
}

static void test_shell_one(void) {
  const double r[] = {0.1, 0.5, 0.999999, 1.000001, 1.7, 2.2};
  const double a[] = {0, 1e-12, 1e-3, 0.3, 0.7, 1, 1.2};
  for (size_t i = 0; i < sizeof r / sizeof *r; i++)
    for (size_t j = 0; j < sizeof a / sizeof *a; j++)
      for (int cut = 0; cut < 2; cut++) {
        const struct area_shell shell = {
            {0.3, -0.2}, 1, {cut ? -0.15 : -3, cut ? 0.05 : 3}};
        const double x[3] = {0.3 + a[j] * 0.6, -0.2 + a[j] * 0.8, 0};
        double sum = GSL_NAN, both = GSL_NAN, error = 0;
        CHECK(area_shell_covered(1, x, &r[i], &shell, &sum, &both) ==
              GSL_SUCCESS);
        const double want = oracle_shell(1, x, &r[i], &shell, &error);
        if (!(CHECK_CLOSE(sum, want, error + 1e-9) & CHECK(both == sum) &
              CHECK(error < 1e-6)))
          fprintf(stderr, "  r=%g a=%g cut=%d\n", r[i], a[j], cut);
      }
  /* about the axis: whole circles */
  const struct area_shell shell = {{0, 0}, 0.6, {-3, 3}};
  const double x[3] = {0, 0, 0}, one = 1;
  double sum, both;
  area_shell_covered(1, x, &one, &shell, &sum, &both);
  CHECK_CLOSE(sum, 2 * M_PI * 0.6 * 1.6, ULPS(32));
}

static void test_shell_random(void) {
  for (unsigned long seed = 1; seed <= 12; seed++) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    const size_t n = 2 + gsl_rng_uniform_int(rng, 20);
    double x[3 * MOST], r[MOST], sum = GSL_NAN, both = GSL_NAN, error = 0;
    random_spheres(rng, n, 0.3, x, r);
    const struct area_shell shell = {
        {0.5, 0.45}, uniform(rng, 0.02, 0.6), {0.1, uniform(rng, 0.3, 1.2)}};
    if (seed % 3 == 0) { /* a sphere within and one twice */
      for (int k = 0; k < 6; k++)
        x[k] = x[k % 3];
      r[1] = seed % 2 ? r[0] : 0.5 * r[0];
    }
    bool ok =
        CHECK(area_shell_covered(n, x, r, &shell, &sum, &both) == GSL_SUCCESS);
    double want = oracle_shell(n, x, r, &shell, &error);
    ok &= CHECK(error < 1e-6);
    ok &= CHECK_CLOSE(both, want, error + 1e-9);
    want = error = 0;
    for (size_t i = 0; i < n; i++)
      want += oracle_shell(1, x + 3 * i, r + i, &shell, &error);
    ok &= CHECK_CLOSE(sum, want, error + 1e-12);
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    gsl_rng_free(rng);
  }
}

/* What shells share with all areas: parts add up, and turning the spheres about
   the axis changes nothing; the latter also with a lattice, whose azimuths meet
   in heaps. */
static void test_shell_identities(void) {
  for (unsigned long seed = 1; seed <= 12; seed++) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    size_t n = 0;
    double x[3 * MOST], y[3 * MOST], r[MOST], sum[4], both[4];
    if (seed % 2) {
      n = 30;
      random_spheres(rng, n, 0.3, x, r);
    } else {
      for (; n < 64; n++) {
        for (size_t k = 0; k < 3; k++)
          x[3 * n + k] = 0.125 + 0.25 * (double)(n >> 2 * k & 3);
        r[n] = seed % 4 ? 0.15 : 0.125;
      }
    }
    const double turn = uniform(rng, 0, 7);
    for (size_t i = 0; i < n; i++) {
      const double dx = x[3 * i] - 0.5, dy = x[3 * i + 1] - 0.5;
      y[3 * i] = 0.5 + dx * cos(turn) - dy * sin(turn);
      y[3 * i + 1] = 0.5 + dx * sin(turn) + dy * cos(turn);
      y[3 * i + 2] = x[3 * i + 2];
    }
    const double radius =
        seed > 6 ? 0.125 * (double)(seed - 6) : uniform(rng, 0.02, 0.6);
    const double middle = uniform(rng, 0.1, 0.9);
    const struct area_shell whole = {{0.5, 0.5}, radius, {0, 1}};
    const struct area_shell low = {{0.5, 0.5}, radius, {0, middle}};
    const struct area_shell high = {{0.5, 0.5}, radius, {middle, 1}};
    const struct area_shell *shells[] = {&whole, &low, &high, &whole};
    bool ok = true;
    for (int k = 0; k < 4; k++)
      ok &= CHECK(area_shell_covered(n, k == 3 ? y : x, r, shells[k], &sum[k],
                                     &both[k]) == GSL_SUCCESS);
    /* the azimuth of an end has an error of sqrt(eps) where they just touch */
    const double tol = ULPS(64) * (double)n;
    ok &= CHECK_CLOSE(sum[1] + sum[2], sum[0], tol);
    ok &= CHECK_CLOSE(both[1] + both[2], both[0], tol);
    ok &= CHECK_CLOSE(sum[3], sum[0], tol);
    ok &= CHECK_CLOSE(both[3], both[0], tol);
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
    gsl_rng_free(rng);
  }
}

/* Spheres of any size beside the shell's keep their digits. A sphere whose
   centre is on the shell: with sin(t/2) = k sin(phi), k = r/2R, its area is
   4 R r k int cos^2 phi / sqrt(1 - k^2 sin^2 phi) dphi over half a turn, and
   the series in k ends soon. */
static double on_shell(double r, double shell) {
  const double k2 = gsl_pow_2(r / (2 * shell));
  double term = M_PI_2, sum = 0; /* of int cos^2 sin^2n */
  for (int n = 0; n < 12; n++) {
    sum += term;
    const double power = (2 * n + 1.0) / (2 * n + 2);
    term *= power * k2 * (2 * n + 1) / (2 * n + 4);
  }
  return 4 * shell * r * r / (2 * shell) * sum;
}

static void test_shell_small(void) {
  for (int ten = 1; ten <= 12; ten++) {
    const double r = pow(10, -ten);
    const struct area_shell shell = {{0, 0}, 1, {-3, 3}};
    /* alone, and two that overlap, one over the other and side by side */
    const double half = r / 2, turn = asin(half); /* centres r apart */
    const double x[3] = {0, 1, 0}, over[6] = {1, 0, -half, 1, 0, half};
    const double beside[6] = {cos(turn), half, 0, cos(turn), -half, 0};
    const double radii[2] = {r, r}, lens = 2 * segment(r, half);
    double sum = GSL_NAN, both = GSL_NAN;
    CHECK(area_shell_covered(1, x, &r, &shell, &sum, &both) == GSL_SUCCESS);
    bool ok = CHECK_REL(sum, on_shell(r, 1), ULPS(16)) & CHECK(both == sum);
    /* flat, to the square of how far the shell bends away */
    CHECK(area_shell_covered(2, over, radii, &shell, &sum, &both) ==
          GSL_SUCCESS);
    ok &= CHECK_REL(sum, 2 * on_shell(r, 1), ULPS(16));
    ok &= CHECK_REL(both, 2 * M_PI * r * r - lens, r * r + ULPS(64));
    CHECK(area_shell_covered(2, beside, radii, &shell, &sum, &both) ==
          GSL_SUCCESS);
    ok &= CHECK_REL(sum, 2 * on_shell(r, 1), ULPS(16));
    ok &= CHECK_REL(both, 2 * M_PI * r * r - lens, r * r + ULPS(64));
    if (!ok)
      fprintf(stderr, "  r=%g\n", r);
  }
  /* off the shell, where a - R must keep what hypot rounds away */
  for (int ten = 1; ten <= 9; ten++) {
    const double r = pow(10, -ten);
    const struct area_shell shell = {{0.1, 0.3}, 1, {-3, 3}};
    const double x[3] = {0.1 + 0.6 + 0.2 * r, 0.3 + 0.8 - 0.1 * r, 0};
    double sum = GSL_NAN, both = GSL_NAN;
    CHECK(area_shell_covered(1, x, &r, &shell, &sum, &both) == GSL_SUCCESS);
    const long double dx = (long double)x[0] - shell.axis[0];
    const long double dy = (long double)x[1] - shell.axis[1];
    const long double d = sqrtl(dx * dx + dy * dy) - 1;
    const double height2 = (double)((r - d) * (r + d));
    /* pi H^2 / sqrt(a) and a relative k^2/8 */
    const double want = M_PI * height2 / sqrt((double)(1 + d)) *
                        (1 + height2 / (double)(1 + d) / 32);
    if (!CHECK_REL(sum, want,
                   gsl_pow_4(r) + ULPS(32) + 64 * (double)LDBL_EPSILON / r))
      fprintf(stderr, "  r=%g\n", r);
  }
}

/* The plainest oracle: azimuths, and a few of their steps for its error where
   segments end. */
static void sampled_shell(size_t n, const double *x, const double *r,
                          const struct area_shell *s, size_t azimuths,
                          double *sum, double *both) {
  *sum = *both = 0;
  for (size_t q = 0; q < azimuths; q++) {
    const double t = 2 * M_PI * ((double)q + 0.5) / (double)azimuths;
    const double at[2] = {s->axis[0] + s->radius * cos(t),
                          s->axis[1] + s->radius * sin(t)};
    struct interval v[MOST];
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
      const double dx = at[0] - x[3 * i], dy = at[1] - x[3 * i + 1];
      const double h2 = r[i] * r[i] - dx * dx - dy * dy;
      if (h2 <= 0)
        continue;
      v[count].from = fmax(s->z[0], x[3 * i + 2] - sqrt(h2));
      v[count].to = fmin(s->z[1], x[3 * i + 2] + sqrt(h2));
      if (v[count].from < v[count].to) {
        *sum += v[count].to - v[count].from;
        count++;
      }
    }
    *both += covered(count, v);
  }
  *sum *= 2 * M_PI * s->radius / (double)azimuths;
  *both *= 2 * M_PI * s->radius / (double)azimuths;
}

/* Between ends that are close together a strip is left, which has the rounding
   of the whole sphere: its height goes down with the distance of the ends, and
   it is never more than the mantle. */
static void test_shell_thin(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (unsigned long seed = 1; seed <= 300; seed++) {
    gsl_rng_set(rng, seed);
    const size_t n = 20;
    double x[3 * MOST], r[MOST], sum = GSL_NAN, both = GSL_NAN;
    random_spheres(rng, n, 0.4, x, r);
    const double z = uniform(rng, 0, 1), thin = pow(10, uniform(rng, -16, -3));
    const struct area_shell shell = {
        {0.5, 0.5}, uniform(rng, 0.02, 0.6), {z, z + thin}};
    const double height = shell.z[1] - shell.z[0];
    CHECK(area_shell_covered(n, x, r, &shell, &sum, &both) == GSL_SUCCESS);
    const double mantle = 2 * M_PI * shell.radius * height;
    CHECK(both <= sum && both <= mantle && both >= 0);
    double plain_sum, plain;
    sampled_shell(n, x, r, &shell, 4000, &plain_sum, &plain);
    const double tol = 1e-2 * mantle + ULPS(64) * (double)n;
    if (!(CHECK_CLOSE(both, plain, tol) &
          CHECK_CLOSE(sum, plain_sum, tol * (double)n)))
      fprintf(stderr, "  seed %lu\n", seed);
  }
  gsl_rng_free(rng);
}

/* Sets whose numbers are multiples of 1/4: spheres that touch each other, the
   shell and its ends, or are one, planes that touch the shell or hold its axis.
   Against the plainest oracle, which errs by no more than a few of its steps
   where segments end: with N azimuths by some (1/N)^(3/2) of the mantle, and
   more of them are taken where they do not agree. */
static double quarters(gsl_rng *rng, int from, int to) {
  return 0.25 *
         (from + (int)gsl_rng_uniform_int(rng, (unsigned long)(to - from + 1)));
}

static void test_shell_degenerate(void) {
  static const struct {
    size_t azimuths;
    double tol; /* of the mantle */
  } tries[] = {{400, 1e-4}, {20000, 1e-6}, {4000000, 2e-8}};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 1);
  for (size_t set = 0; set < 6000; set++) {
    const size_t n = 1 + gsl_rng_uniform_int(rng, 5);
    struct area_shell s = {{quarters(rng, -2, 2), quarters(rng, -2, 2)},
                           quarters(rng, 1, 8),
                           {quarters(rng, -8, 0)}};
    s.z[1] = s.z[0] + quarters(rng, 1, 8);
    double x[3 * MOST], r[MOST], sum = GSL_NAN, both = GSL_NAN;
    for (size_t i = 0; i < n; i++) {
      for (size_t k = 0; k < 3; k++)
        x[3 * i + k] = quarters(rng, -8, 8);
      r[i] = quarters(rng, 1, 12) / 2;
    }
    if (set % 4 == 0) { /* the same with roundings */
      const double turn = uniform(rng, 0, 7), c = cos(turn), q = sin(turn);
      for (size_t i = 0; i <= n; i++) {
        double *p = i < n ? x + 3 * i : s.axis;
        const double was[2] = {p[0], p[1]};
        p[0] = c * was[0] - q * was[1];
        p[1] = q * was[0] + c * was[1];
      }
    }
    const double mantle = 2 * M_PI * s.radius * (s.z[1] - s.z[0]);
    bool ok = area_shell_covered(n, x, r, &s, &sum, &both) == GSL_SUCCESS;
    ok = ok && both <= sum && both <= mantle && both >= 0;
    bool agree = false;
    for (size_t k = 0; k < 3 && ok && !agree; k++) {
      double plain_sum, plain;
      sampled_shell(n, x, r, &s, tries[k].azimuths, &plain_sum, &plain);
      agree = fabs(plain - both) <= tries[k].tol * mantle &&
              fabs(plain_sum - sum) <= tries[k].tol * mantle * (double)n;
    }
    if (!CHECK(ok && agree))
      fprintf(stderr, "  set %zu: sum %.17g, union %.17g\n", set, sum, both);
  }
  gsl_rng_free(rng);
}

/* Shells integrate to the volume. */
static double shell_of(double radius, void *params) {
  const struct spheres *p = params;
  const struct area_shell shell = {{0.5, 0.5}, radius, {p->box[4], p->box[5]}};
  double sum = GSL_NAN, both = GSL_NAN;
  CHECK(area_shell_covered(p->n, p->x, p->r, &shell, &sum, &both) ==
        GSL_SUCCESS);
  return p->sum ? sum : both;
}

static void test_shell_volume(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 1);
  const size_t n = 8;
  double x[3 * MOST], r[MOST], kinks[2 * MOST], error = 0, volume;
  random_spheres(rng, n, 0.3, x, r);
  const double box[6] = {-5, 5, -5, 5, 0.1, 0.9};
  for (size_t i = 0; i < n; i++) {
    const double a = hypot(x[3 * i] - 0.5, x[3 * i + 1] - 0.5);
    kinks[2 * i] = fabs(a - r[i]);
    kinks[2 * i + 1] = a + r[i];
  }
  struct spheres p = {n, x, r, box, true};
  gsl_function f = {shell_of, &p};
  const double sum = integral(&f, 1e-9, 2, 2 * n, kinks, 1e-7, &error);
  CHECK_CLOSE(sum, volume_sum(n, x, r, box), error + 1e-7);
  p.sum = false;
  error = 0;
  const double whole = integral(&f, 1e-9, 2, 2 * n, kinks, 1e-7, &error);
  CHECK(volume_union(n, x, r, box, &volume) == GSL_SUCCESS);
  CHECK_CLOSE(whole, volume, error + 1e-7);
  CHECK(error < 1e-5);
  gsl_rng_free(rng);
}

int main(void) {
  gsl_set_error_handler_off();
  test_lines();
  test_closed_forms();
  test_random();
  test_refusals();
  test_slices();
  test_shell_one();
  test_shell_random();
  test_shell_identities();
  test_shell_small();
  test_shell_thin();
  test_shell_degenerate();
  test_shell_volume();
  return check_done();
}
