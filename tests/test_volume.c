/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volumes of clipped balls and unions against closed forms, against quadrature
   of areas that are found in another way, and against the identities that any
   volume obeys. The random cases are numbered by their seeds; a failing one
   prints its own.

   A volume is a sum of terms of the size of the ball's, each with a few
   rounding errors: hence most tolerances are a multiple of DBL_EPSILON times
   the number of terms times the volume of the balls. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "geometry/vec3.h"
#include "geometry/area.h"
#include "geometry/box.h"
#include "geometry/tube.h"
#include "geometry/volume.h"
#include "sample.h"

#define BALL (4 * M_PI / 3) /* the unit ball */
#define ULPS(n) ((double)(n)*DBL_EPSILON)

static const double everywhere[6] = {-1e3, 1e3, -1e3, 1e3, -1e3, 1e3};

static double ball(double r) {
  return BALL * r * r * r;
}

static double cap(double r, double h) { /* beyond a plane at h from O */
  return M_PI / 3 * (r - h) * (r - h) * (2 * r + h);
}

static double united(size_t n, const double *x, const double *r,
                     const double box[6]) {
  double volume = GSL_NAN;
  CHECK(volume_union(n, x, r, box, &volume) == GSL_SUCCESS);
  return volume;
}

static void random_spheres(gsl_rng *rng, size_t n, double rmin, double rmax,
                           double *x, double *r) {
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 3; k++)
      x[3 * i + k] = gsl_rng_uniform(rng);
    r[i] = uniform(rng, rmin, rmax);
  }
}

static void random_box(gsl_rng *rng, double a, double b, double box[6]) {
  for (int k = 0; k < 3; k++) {
    const double p = uniform(rng, a, b), q = uniform(rng, a, b);
    box[2 * k] = fmin(p, q);
    box[2 * k + 1] = fmax(p, q);
  }
}

static void random_plane(gsl_rng *rng, double reach, double plane[4]) {
  gsl_ran_dir_3d(rng, &plane[0], &plane[1], &plane[2]);
  const double norm = vec3_norm(plane);
  for (int k = 0; k < 3; k++)
    plane[k] /= norm;
  plane[3] = uniform(rng, -reach, reach);
}

/* --- quadrature ------------------------------------------------------------*/

/* Integral of f over [a, b], piece by piece between n breakpoints, which are
   where f has kinks; the error estimate adds up in *error. */
static double integral(gsl_function *f, double a, double b, size_t n,
                       const double *breaks, double tol, double *error) {
  enum { size = 2000 };
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(size);
  double total = 0;
  for (double left = a; left < b;) {
    double right = b;
    for (size_t i = 0; i < n; i++)
      if (breaks[i] > left && breaks[i] < right)
        right = breaks[i];
    double part, err;
    gsl_integration_qags(f, left, right, tol, 0, size, w, &part, &err);
    total += part;
    *error += err;
    left = right;
  }
  gsl_integration_workspace_free(w);
  return total;
}

/* Area of a disc of radius r about 0 in {x <= a, y <= b}, by integration of
   the height over x, part by part. */
static double disc_root(double r, double x) { /* of sqrt(r^2 - x^2) */
  const double t = fmin(1, fmax(-1, x / r));
  return r * r * (t * sqrt((1 - t) * (1 + t)) + asin(t)) / 2;
}

static double disc_quadrant(double r, double a, double b) {
  a = fmin(a, r);
  if (r <= 0 || a <= -r || b <= -r)
    return 0;
  const double half = disc_root(r, a) - disc_root(r, -r);
  if (b >= r)
    return 2 * half;
  /* |x| < w is where the line y = b is inside the disc */
  const double w = sqrt(r * r - b * b);
  const double x0 = fmin(a, -w), x1 = fmin(a, w);
  const double above =
      fmax(0, disc_root(r, x1) - disc_root(r, x0) - b * (x1 - x0));
  if (b >= 0)
    return 2 * half - above;
  /* for b < 0, the heights above the line are sqrt - b where the line is in
     the disc and 2 sqrt elsewhere */
  return disc_root(r, x1) - disc_root(r, x0) + b * (x1 - x0);
}

struct corner {
  double r, a, b, c;
};

static double corner_slice(double z, void *params) {
  const struct corner *p = params;
  const double rho = sqrt(fmax(0, p->r * p->r - z * z));
  return disc_quadrant(rho, p->a, p->b);
}

/* Ball in {x <= a, y <= b, z <= c}. */
static double corner_volume(struct corner p, double *error) {
  const double k2[3] = {p.r * p.r - p.a * p.a, p.r * p.r - p.b * p.b,
                        p.r * p.r - p.a * p.a - p.b * p.b};
  double breaks[7] = {0};
  for (int i = 0; i < 3; i++) {
    breaks[2 * i] = sqrt(fmax(0, k2[i]));
    breaks[2 * i + 1] = -breaks[2 * i];
  }
  gsl_function f = {corner_slice, &p};
  return integral(&f, -p.r, fmin(p.c, p.r), 7, breaks, 1e-14, error);
}

/* Ball clipped by planes: slices at z are discs clipped by lines, and between
   the heights y where any two of their borders cross, the left and the right
   border are one line or arc each. */
enum { planes_max = 8 };

struct clipped {
  size_t count;
  const double (*planes)[4];
};

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double clipped_strip(const struct clipped *p, double z, double rho,
                            double y0, double y1) {
  const double y = (y0 + y1) / 2,
               mean = disc_root(rho, y1) - disc_root(rho, y0);
  double right = sqrt(rho * rho - y * y), left = -right;
  double area_right = mean, area_left = -mean;
  for (size_t i = 0; i < p->count; i++) {
    const double *n = p->planes[i];
    const double x = (n[3] - n[1] * y - n[2] * z) / n[0];
    if (n[0] > 0 && x < right) {
      right = x;
      area_right = x * (y1 - y0);
    } else if (n[0] < 0 && x > left) {
      left = x;
      area_left = x * (y1 - y0);
    }
  }
  return right > left ? area_right - area_left : 0;
}

static double clipped_slice(double z, void *params) {
  const struct clipped *p = params;
  const double rho = sqrt(fmax(0, 1 - z * z));
  double y[2 + 2 * planes_max + planes_max * planes_max];
  size_t count = 0;
  y[count++] = -rho;
  y[count++] = rho;
  for (size_t i = 0; i < p->count; i++) {
    const double *a = p->planes[i], gap = a[3] - a[2] * z;
    const double d2 = a[0] * a[0] + a[1] * a[1],
                 w2 = rho * rho * d2 - gap * gap;
    if (w2 > 0) {
      y[count++] = (a[1] * gap + a[0] * sqrt(w2)) / d2;
      y[count++] = (a[1] * gap - a[0] * sqrt(w2)) / d2;
    }
    for (size_t j = 0; j < i; j++) {
      const double *b = p->planes[j], gap_b = b[3] - b[2] * z;
      y[count++] = (a[0] * gap_b - b[0] * gap) / (a[0] * b[1] - a[1] * b[0]);
    }
  }
  qsort(y, count, sizeof *y, ascending);
  double area = 0;
  for (size_t i = 0; i + 1 < count; i++)
    if (y[i] >= -rho && y[i + 1] <= rho && y[i + 1] > y[i])
      area += clipped_strip(p, z, rho, y[i], y[i + 1]);
  return area;
}

/* The unit ball clipped by planes none of which is along x. Kinks are at the
   ends of the circles and corners on the surface and inside. */
static double clipped_volume(size_t count, const double (*planes)[4],
                             double *error) {
  double breaks[planes_max * planes_max * (planes_max + 4)];
  size_t n = 0;
  for (size_t i = 0; i < count; i++) {
    const double *a = planes[i];
    const double w = sqrt((1 - a[3] * a[3]) * (1 - a[2] * a[2]));
    breaks[n++] = a[3] * a[2] - w;
    breaks[n++] = a[3] * a[2] + w;
    for (size_t j = 0; j < i; j++) {
      /* the line of both: p + t along */
      const double *b = planes[j];
      double along[3], p[3];
      vec3_cross(a, b, along);
      const double s2 = vec3_dot(along, along), c = vec3_dot(a, b);
      for (int k = 0; k < 3; k++)
        p[k] = ((a[3] - b[3] * c) * a[k] + (b[3] - a[3] * c) * b[k]) / s2;
      const double t2 = (1 - vec3_dot(p, p)) / s2;
      if (t2 < 0)
        continue;
      breaks[n++] = p[2] - sqrt(t2) * along[2];
      breaks[n++] = p[2] + sqrt(t2) * along[2];
      for (size_t k = 0; k < j; k++) {
        const double *q = planes[k];
        const double t = (q[3] - vec3_dot(q, p)) / vec3_dot(q, along);
        breaks[n++] = p[2] + t * along[2];
      }
    }
  }
  struct clipped params = {count, planes};
  gsl_function f = {clipped_slice, &params};
  return integral(&f, -1, 1, n, breaks, 1e-14, error);
}

/* Union of spheres in a box: a slice at z is a union of discs in a rectangle.
   Between the heights y at which circles and sides start, end or cross each
   other, it consists of strips whose sides are arcs or straight, and their
   areas are elementary. */
enum { slice_max = 16 };

struct slice {
  size_t n;
  const double *x, *r, *box;
};

/* Where circles a and b, {x, y, radius}, cross: returns how many y. */
static size_t crossings(const double a[3], const double b[3], double *y) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], d2 = dx * dx + dy * dy;
  const double t = (d2 + a[2] * a[2] - b[2] * b[2]) / (2 * d2);
  const double w2 = a[2] * a[2] / d2 - t * t;
  if (!(d2 > 0) || !(w2 > 0))
    return 0;
  y[0] = a[1] + t * dy + sqrt(w2) * dx;
  y[1] = a[1] + t * dy - sqrt(w2) * dx;
  return 2;
}

/* int_y0^y1 of the x of a circle's left or right side, held inside the box,
   which it doesn't leave in between. */
static double side_integral(const double c[3], int side, const double *box,
                            double y0, double y1) {
  const double ym = (y0 + y1) / 2 - c[1];
  const double xm = c[0] + side * sqrt(fmax(0, c[2] * c[2] - ym * ym));
  if (xm <= box[0] || xm >= box[1])
    return (xm <= box[0] ? box[0] : box[1]) * (y1 - y0);
  return c[0] * (y1 - y0) +
         side * (disc_root(c[2], y1 - c[1]) - disc_root(c[2], y0 - c[1]));
}

/* Area of one strip: walk the discs from the left, and let the covered x grow
   to the right. */
static double strip_area(size_t m, double c[][3], const double *box, double y0,
                         double y1) {
  const double y = (y0 + y1) / 2;
  double area = 0, x = box[0];
  bool used[slice_max] = {false};
  for (;;) {
    size_t next = m;
    double left = 0;
    for (size_t i = 0; i < m; i++) {
      const double w2 = c[i][2] * c[i][2] - (y - c[i][1]) * (y - c[i][1]);
      if (used[i] || w2 <= 0)
        continue;
      if (next == m || c[i][0] - sqrt(w2) < left) {
        next = i;
        left = c[i][0] - sqrt(w2);
      }
    }
    if (next == m)
      return area;
    used[next] = true;
    /* discs that the interval takes in push its right end on */
    size_t last = next;
    double right = 2 * c[next][0] - left;
    for (size_t i = 0; i < m; i++) {
      const double w2 = c[i][2] * c[i][2] - (y - c[i][1]) * (y - c[i][1]);
      if (used[i] || w2 <= 0 || c[i][0] - sqrt(w2) > right)
        continue;
      used[i] = true;
      if (c[i][0] + sqrt(w2) > right) {
        right = c[i][0] + sqrt(w2);
        last = i;
        i = SIZE_MAX; /* again from 0 */
      }
    }
    if (right > x && left < box[1])
      area += side_integral(c[last], 1, box, y0, y1) -
              side_integral(c[next], -1, box, y0, y1);
  }
}

static double slice_area(double z, void *params) {
  const struct slice *s = params;
  double c[slice_max][3], y[4 * slice_max * slice_max + 8 * slice_max + 2];
  size_t m = 0, count = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double dz = z - s->x[3 * i + 2], w2 = s->r[i] * s->r[i] - dz * dz;
    if (w2 <= 0)
      continue;
    c[m][0] = s->x[3 * i];
    c[m][1] = s->x[3 * i + 1];
    c[m++][2] = sqrt(w2);
  }
  y[count++] = s->box[2];
  y[count++] = s->box[3];
  for (size_t i = 0; i < m; i++) {
    y[count++] = c[i][1] - c[i][2];
    y[count++] = c[i][1] + c[i][2];
    for (int side = 0; side < 2; side++) {
      const double dx = s->box[side] - c[i][0],
                   w2 = c[i][2] * c[i][2] - dx * dx;
      if (w2 <= 0)
        continue;
      y[count++] = c[i][1] - sqrt(w2);
      y[count++] = c[i][1] + sqrt(w2);
    }
    for (size_t j = 0; j < i; j++)
      count += crossings(c[i], c[j], y + count);
  }
  qsort(y, count, sizeof *y, ascending);
  double area = 0;
  for (size_t i = 0; i + 1 < count; i++)
    if (y[i + 1] > y[i] && y[i] >= s->box[2] && y[i + 1] <= s->box[3])
      area += strip_area(m, c, s->box, y[i], y[i + 1]);
  return area;
}

static double union_quadrature(size_t n, const double *x, const double *r,
                               const double box[6], double *error) {
  struct slice s = {n, x, r, box};
  double breaks[2 * slice_max + 2 * slice_max * slice_max];
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    breaks[count++] = x[3 * i + 2] - r[i];
    breaks[count++] = x[3 * i + 2] + r[i];
    for (size_t j = 0; j < i;
         j++) { /* the ends of the circles where two meet */
      double d[3];
      vec3_sub(x + 3 * j, x + 3 * i, d);
      const double d2 = vec3_dot(d, d);
      const double t = (d2 + r[i] * r[i] - r[j] * r[j]) / (2 * d2);
      const double ring2 = r[i] * r[i] - t * t * d2;
      if (ring2 <= 0)
        continue;
      const double w = sqrt(ring2 * (d[0] * d[0] + d[1] * d[1]) / d2);
      breaks[count++] = x[3 * i + 2] + t * d[2] - w;
      breaks[count++] = x[3 * i + 2] + t * d[2] + w;
    }
  }
  gsl_function f = {slice_area, &s};
  return integral(&f, box[4], box[5], count, breaks, 1e-12, error);
}

/* --- one ball and planes ---------------------------------------------------*/

static void test_caps(void) {
  CHECK(volume_ball_planes(0, 0, NULL) == 0);
  CHECK_REL(volume_ball_planes(2, 0, NULL), ball(2), ULPS(2));
  for (int k = -19; k < 20; k++) {
    const double h = 0.1 * k;
    const double plane[1][4] = {{0.6, 0, -0.8, h}};
    CHECK_CLOSE(volume_ball_planes(2, 1, plane), ball(2) - cap(2, h),
                ULPS(4) * ball(2));
  }
  /* thin caps keep their relative accuracy; 1 - h is exact */
  for (double t = 0.5; t > 1e-12; t /= 2) {
    const double plane[1][4] = {{0, 1, 0, t - 1}};
    CHECK_REL(volume_ball_planes(1, 1, plane), M_PI / 3 * t * t * (3 - t),
              ULPS(8));
  }
  /* tangent planes and those beyond, from either side */
  const double h[] = {1, 1 + DBL_EPSILON, 5, GSL_POSINF};
  for (int i = 0; i < 4; i++) {
    const double in[1][4] = {{0, 0, 1, h[i]}}, out[1][4] = {{0, 0, 1, -h[i]}};
    CHECK(volume_ball_planes(1, 1, in) == volume_ball_planes(1, 0, NULL));
    CHECK(volume_ball_planes(1, 1, out) == 0);
  }
  CHECK(isnan(volume_ball_planes(1, 1, &(const double[4]){0, 0, 1, GSL_NAN})));
}

/* Planes through O: what is left is a share of the ball. */
static void test_shares(void) {
  for (int i = 1; i < 24; i++) {
    const double angle = i * M_PI / 24;
    const double c = cos(angle), s = sin(angle);
    /* y >= 0 and below the line at this angle */
    const double wedge[2][4] = {{0, -1, 0, 0}, {-s, c, 0, 0}};
    CHECK_CLOSE(volume_ball_planes(3, 2, wedge), ball(3) * i / 48.,
                ULPS(8) * ball(3));
    /* and a third plane along the edge, redundant */
    const double three[3][4] = {
        {0, -1, 0, 0}, {-s, c, 0, 0}, {-cos(angle / 2), -sin(angle / 2), 0, 0}};
    CHECK_CLOSE(volume_ball_planes(3, 3, three), ball(3) * i / 48.,
                ULPS(8) * ball(3));
  }
  const double octant[3][4] = {{1, 0, 0, 0}, {0, -1, 0, -0.0}, {0, 0, 1, 0}};
  CHECK_CLOSE(volume_ball_planes(1, 1, octant), BALL / 2, ULPS(4) * BALL);
  CHECK_CLOSE(volume_ball_planes(1, 2, octant), BALL / 4, ULPS(4) * BALL);
  CHECK_CLOSE(volume_ball_planes(1, 3, octant), BALL / 8, ULPS(4) * BALL);

  /* the fundamental cone of the cube's 48 symmetries */
  const double q = M_SQRT1_2;
  const double cone[3][4] = {{0, 0, -1, 0}, {-q, q, 0, 0}, {0, -q, q, 0}};
  CHECK_CLOSE(volume_ball_planes(1, 3, cone), BALL / 48, ULPS(8) * BALL);
  /* a face of the cube seen from its centre, four planes through O */
  const double face[4][4] = {
      {-q, q, 0, 0}, {-q, -q, 0, 0}, {-q, 0, q, 0}, {-q, 0, -q, 0}};
  CHECK_CLOSE(volume_ball_planes(1, 4, face), BALL / 6, ULPS(8) * BALL);
  /* the same with offsets that are rounding errors */
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (unsigned long seed = 1; seed <= 200; seed++) {
    gsl_rng_set(rng, seed);
    double near[4][4];
    memcpy(near, face, sizeof near);
    for (int k = 0; k < 4; k++)
      near[k][3] = gsl_rng_uniform_int(rng, 3)
                       ? uniform(rng, -1, 1) * pow(10, uniform(rng, -40, -15.5))
                       : 0;
    if (!CHECK_CLOSE(volume_ball_planes(1, 4, (const double(*)[4])near),
                     BALL / 6, ULPS(20) * BALL))
      fprintf(stderr, "  seed %lu\n", seed);
  }
  gsl_rng_free(rng);
}

static void test_degenerate_planes(void) {
  /* repeated, loosened, nearly repeated */
  const double c = cos(0.3), s = sin(0.3);
  for (int k = -3; k <= 3; k++) {
    const double h = 0.3 * k;
    const double rest = BALL - cap(1, h);
    const double same[4][4] = {
        {c, s, 0, h}, {c, s, 0, h}, {c, s, 0, h}, {c, s, 0, h + 0.01}};
    CHECK_CLOSE(volume_ball_planes(1, 4, same), rest, ULPS(4) * BALL);
    for (double tilt = 1e-3; tilt > 1e-20; tilt /= 7) {
      const double near[4][4] = {{c, s, 0, h},
                                 {cos(0.3 + tilt), sin(0.3 + tilt), 0, h},
                                 {c, s, tilt, h + tilt},
                                 {c, s, 0, h + 3 * tilt}};
      /* tilting moves the plane by less than tilt within the ball */
      CHECK_CLOSE(volume_ball_planes(1, 4, near), rest,
                  5 * tilt + ULPS(8) * BALL);
    }
    const double slab[2][4] = {{c, s, 0, h}, {-c, -s, 0, 0.05 - h}};
    CHECK_CLOSE(volume_ball_planes(1, 2, slab),
                rest + (BALL - cap(1, 0.05 - h)) - BALL, ULPS(8) * BALL);
    /* slabs without a thickness, or less */
    const double thin[2][4] = {{c, s, 0, h}, {-c, -s, 0, -h}};
    CHECK_CLOSE(volume_ball_planes(1, 2, thin), 0, 1e-15);
    const double none[2][4] = {{c, s, 0, h}, {-c, -s, 0, -h - 1e-9}};
    CHECK(volume_ball_planes(1, 2, none) == 0);
  }
  /* a triangle turned inside out, and one beyond the ball, whose planes all
     cut it */
  const double t = sqrt(0.75);
  for (int k = 0; k < 11; k++) {
    const double h = 0.01 + 0.09 * k;
    const double inside_out[3][4] = {
        {1, 0, 0, -h}, {-0.5, t, 0, -h}, {-0.5, -t, 0, -h}};
    CHECK(volume_ball_planes(1, 3, inside_out) == 0);
  }
  const double beyond[2][4] = {{M_SQRT1_2, M_SQRT1_2, 0, -0.8},
                               {M_SQRT1_2, -M_SQRT1_2, 0, -0.8}};
  CHECK(volume_ball_planes(1, 2, beyond) == 0);
  /* an edge that is tangent to the ball, from either side */
  const double edge[2][4] = {{-1, 0, 0, 0.6}, {0, -1, 0, 0.8}};
  CHECK_CLOSE(volume_ball_planes(1, 2, edge), BALL - cap(1, 0.6) - cap(1, 0.8),
              ULPS(4) * BALL);
  const double outer[2][4] = {{1, 0, 0, -0.6}, {0, 1, 0, -0.8}};
  CHECK_CLOSE(volume_ball_planes(1, 2, outer), 0, 1e-15);
  /* a cube about O: its edges touch the ball, then its corners */
  for (int k = 1; k <= 2; k++) {
    const double a = k == 1 ? M_SQRT1_2 : 1 / sqrt(3);
    const double box[6] = {-a, a, -a, a, -a, a}, o[3] = {0, 0, 0};
    const double want = k == 1 ? BALL - 6 * cap(1, a) : 8 * a * a * a;
    CHECK_CLOSE(volume_ball_box(o, 1, box), want, ULPS(16) * BALL);
  }
}

static void test_plane_quadrature(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double worst = 0;
  for (unsigned long seed = 1; seed <= 100; seed++) {
    gsl_rng_set(rng, seed);
    double planes[planes_max][4], error = 0;
    const size_t count = 1 + gsl_rng_uniform_int(rng, planes_max);
    for (size_t i = 0; i < count; i++) {
      random_plane(rng, 0.6, planes[i]);
      planes[i][3] += 0.3;
    }
    const double(*p)[4] = (const double(*)[4])planes;
    const double want = clipped_volume(count, p, &error);
    const double got = volume_ball_planes(1, count, p);
    worst = fmax(worst, fabs(got - want));
    if (!CHECK_CLOSE(got, want, 1e-14 + error) || !CHECK(error < 1e-10))
      fprintf(stderr, "  seed %lu, error of quadrature %g\n", seed, error);
  }
  printf("planes: within %.2g of quadrature\n", worst);
  gsl_rng_free(rng);
}

/* m planes cut space into 2^m cells, some of which are empty, and the parts of
   a ball in them add up to it. Every kind of coincidence is among them: planes
   through O, planes that are nearly parallel, planes along one line or through
   one point, planes that nearly touch the ball. */
static void test_cells(void) {
  enum { most = 6 };
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double worst = 0;
  for (unsigned long seed = 1; seed <= 3000; seed++) {
    gsl_rng_set(rng, seed);
    const size_t m = 1 + gsl_rng_uniform_int(rng, most);
    const unsigned long kind = gsl_rng_uniform_int(rng, 8);
    double planes[most][4], point[3], along[3];
    const double r = pow(10, uniform(rng, -4, 4));
    gsl_ran_dir_3d(rng, &point[0], &point[1], &point[2]);
    gsl_ran_dir_3d(rng, &along[0], &along[1], &along[2]);
    const double away = gsl_rng_uniform(rng);
    for (int k = 0; k < 3; k++)
      point[k] *= away;
    for (size_t i = 0; i < m; i++) {
      double *p = planes[i], cross[3];
      random_plane(rng, 1, p);
      const double tiny = pow(10, uniform(rng, -20, -2));
      if (kind == 1)
        p[3] = gsl_rng_uniform_int(rng, 2) ? 0 : tiny;
      if (kind == 2 && i > 0 && gsl_rng_uniform_int(rng, 3)) {
        const double *q = planes[gsl_rng_uniform_int(rng, i)];
        for (int k = 0; k < 3; k++)
          p[k] = q[k] + tiny * p[k];
        p[3] = gsl_rng_uniform_int(rng, 2) ? q[3] : q[3] + tiny;
      }
      if (kind == 3 || kind == 4) { /* along one line, at times through O */
        vec3_cross(p, along, cross);
        memcpy(p, cross, sizeof cross);
      }
      if (kind == 6) /* axes and diagonals */
        for (int k = 0; k < 3; k++)
          p[k] = (double)gsl_rng_uniform_int(rng, 3) - (k < 2 || p[0] != 0);
      if (kind == 7)
        p[3] = copysign(1 - tiny, p[3]);
      const double norm = vec3_norm(p);
      for (int k = 0; k < 3; k++)
        p[k] = norm > 0 ? p[k] / norm : k == 0;
      if (kind == 3 || kind == 5)
        p[3] = vec3_dot(p, point);
      if (kind == 4 || (kind == 6 && gsl_rng_uniform_int(rng, 2)))
        p[3] = 0;
      if (kind == 6 && gsl_rng_uniform_int(rng, 4) == 0)
        p[3] = 0.5;
    }
    double total = 0;
    bool sane = true;
    for (unsigned long cell = 0; cell < 1ul << m; cell++) {
      double cut[most][4];
      for (size_t i = 0; i < m; i++)
        for (int k = 0; k < 4; k++)
          cut[i][k] =
              (cell >> i & 1 ? -1 : 1) * planes[i][k] * (k == 3 ? r : 1);
      const double part = volume_ball_planes(r, m, (const double(*)[4])cut);
      sane = sane && part >= 0 && part <= ball(r) * (1 + ULPS(4));
      total += part;
    }
    const double error = fabs(total / ball(r) - 1);
    worst = fmax(worst, error);
    const double tol = ULPS(8 * m); /* Arm's fused multiply-adds take 44 */
    if (!CHECK(sane) || !CHECK(error <= tol))
      fprintf(stderr, "  seed %lu, kind %lu, %zu planes, error %g > %g\n", seed,
              kind, m, error, tol);
  }
  printf("cells: parts add up to the ball within %.2g\n", worst);
  gsl_rng_free(rng);
}

/* The order of planes, turning and scaling change nothing. */
static void test_plane_invariance(void) {
  enum { count = 7 };
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (unsigned long seed = 1; seed <= 300; seed++) {
    gsl_rng_set(rng, seed);
    double planes[count][4], turned[count][4], axes[3][3];
    for (size_t i = 0; i < count; i++) {
      random_plane(rng, 0.8, planes[i]);
      planes[i][3] += 0.3;
    }
    double other[3];
    gsl_ran_dir_3d(rng, &axes[0][0], &axes[0][1], &axes[0][2]);
    gsl_ran_dir_3d(rng, &other[0], &other[1], &other[2]);
    vec3_cross(axes[0], other, axes[1]);
    const double norm = vec3_norm(axes[1]);
    for (int k = 0; k < 3; k++)
      axes[1][k] /= norm;
    vec3_cross(axes[0], axes[1], axes[2]);
    for (size_t i = 0; i < count; i++) {
      for (int k = 0; k < 3; k++)
        turned[i][k] = vec3_dot(axes[k], planes[i]);
      turned[i][3] = planes[i][3];
    }
    const double want =
        volume_ball_planes(1, count, (const double(*)[4])planes);
    bool ok = CHECK_CLOSE(
        volume_ball_planes(1, count, (const double(*)[4])turned), want, 1e-14);
    gsl_ran_shuffle(rng, planes, count, sizeof planes[0]);
    ok &= CHECK_CLOSE(volume_ball_planes(1, count, (const double(*)[4])planes),
                      want, 1e-14);
    for (size_t i = 0; i < count; i++)
      planes[i][3] *= 1e-7;
    ok &= CHECK_CLOSE(
        volume_ball_planes(1e-7, count, (const double(*)[4])planes) * 1e21,
        want, 1e-14);
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
  }
  gsl_rng_free(rng);
}

/* --- one ball and a box ----------------------------------------------------*/

static void test_box(void) {
  const double o[3] = {0, 0, 0};
  const double box[6] = {0, 1, 0, 1, 0, 1};
  CHECK(volume_ball_box(o, 0, box) == 0);
  CHECK_CLOSE(volume_ball_box(o, 1, box), BALL / 8, ULPS(4) * BALL);
  CHECK_CLOSE(volume_ball_box(o, 2, box), 1, ULPS(4) * ball(2));
  CHECK_CLOSE(volume_ball_box((const double[3]){0.5, 0, 0}, 0.5, box),
              ball(0.5) / 4, ULPS(4) * ball(0.5));
  CHECK_CLOSE(volume_ball_box((const double[3]){0.5, 1, 0.5}, 0.5, box),
              ball(0.5) / 2, ULPS(4) * ball(0.5));
  CHECK_REL(volume_ball_box((const double[3]){0.5, 0.5, 0.5}, 0.5, box),
            ball(0.5), ULPS(2));
  /* touching the box's face, edge and corner from outside, and well outside */
  CHECK(volume_ball_box((const double[3]){0.5, 0.5, -0.5}, 0.5, box) == 0);
  CHECK(volume_ball_box((const double[3]){0.5, -0.3, -0.4}, 0.5, box) == 0);
  CHECK(volume_ball_box((const double[3]){-1, -1, -1}, sqrt(3), box) <= 1e-15);
  CHECK(volume_ball_box((const double[3]){9, 9, 9}, 1, box) == 0);
  /* all three planes of a corner cut the ball, which is beyond it */
  CHECK(volume_ball_box((const double[3]){-0.6, -0.6, -0.6}, 1, box) == 0);
  /* boxes without an inside, and with all of space */
  const double flat[6] = {0, 1, 0.2, 0.2, 0, 1}, wrong[6] = {0, 1, 0, 1, 1, 0};
  const double all[6] = {GSL_NEGINF, GSL_POSINF, GSL_NEGINF,
                         GSL_POSINF, GSL_NEGINF, GSL_POSINF};
  CHECK(volume_ball_box(o, 1, flat) == 0);
  CHECK(volume_ball_box(o, 1, wrong) == 0);
  CHECK_REL(volume_ball_box(o, 1, all), BALL, ULPS(2));
  CHECK(isnan(volume_ball_box((const double[3]){0, GSL_NAN, 0}, 1, box)));

  /* {x <= a, y <= b, z <= c} against quadrature */
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double worst = 0;
  for (unsigned long seed = 1; seed <= 300; seed++) {
    gsl_rng_set(rng, seed);
    const struct corner p = {1, uniform(rng, -1, 1), uniform(rng, -1, 1),
                             uniform(rng, -1, 1)};
    const double part[6] = {-2, p.a, -2, p.b, -2, p.c};
    double error = 0;
    const double want = corner_volume(p, &error);
    const double got = volume_ball_box(o, 1, part);
    worst = fmax(worst, fabs(got - want));
    if (!CHECK_CLOSE(got, want, 1e-14 + error) || !CHECK(error < 1e-11))
      fprintf(stderr, "  seed %lu, error of quadrature %g\n", seed, error);
  }
  printf("corners: within %.2g of quadrature\n", worst);
  gsl_rng_free(rng);
}

/* A box split into boxes, any kind of ball: the parts add up. */
static void test_box_split(void) {
  enum { most = 4 };
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (unsigned long seed = 1; seed <= 300; seed++) {
    gsl_rng_set(rng, seed);
    double cuts[3][most + 1], c[3], box[6];
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i <= most; i++)
        cuts[k][i] = gsl_rng_uniform(rng);
      qsort(cuts[k], most + 1, sizeof(double), ascending);
      box[2 * k] = cuts[k][0];
      box[2 * k + 1] = cuts[k][most];
      /* at times on a face */
      c[k] = gsl_rng_uniform_int(rng, 3) ? uniform(rng, -0.5, 1.5)
                                         : cuts[k][gsl_rng_uniform_int(rng, 5)];
    }
    const double r = uniform(rng, 0, 1);
    double total = 0;
    for (int i = 0; i < most * most * most; i++) {
      const int at[3] = {i % most, i / most % most, i / most / most};
      double part[6];
      for (int k = 0; k < 3; k++) {
        part[2 * k] = cuts[k][at[k]];
        part[2 * k + 1] = cuts[k][at[k] + 1];
      }
      total += volume_ball_box(c, r, part);
    }
    if (!CHECK_CLOSE(total, volume_ball_box(c, r, box),
                     ULPS(4) * most * ball(r)))
      fprintf(stderr, "  seed %lu\n", seed);
  }
  gsl_rng_free(rng);
}

/* --- unions ----------------------------------------------------------------*/

/* Two spheres, by the textbook's lens. */
static double lens(double a, double b, double d) {
  if (d >= a + b)
    return 0;
  if (d <= fabs(a - b))
    return ball(fmin(a, b));
  return M_PI * gsl_pow_2(a + b - d) *
         (d * d + 2 * d * (a + b) - 3 * gsl_pow_2(a - b)) / (12 * d);
}

static void test_two(void) {
  for (int i = 0; i < 10; i++)
    for (int k = 0; k < 96; k++) {
      const double b = 0.05 + 0.15 * i, d = 0.03125 * k;
      const double x[6] = {0.1, 0.2, 0.3, 0.1 + 0.6 * d, 0.2, 0.3 - 0.8 * d};
      const double r[2] = {1, b};
      CHECK_CLOSE(united(2, x, r, everywhere),
                  ball(1) + ball(b) - lens(1, b, d),
                  ULPS(16) * (ball(1) + ball(b)));
    }
  /* touching from inside and outside, nearly; identical; concentric */
  const double close[] = {0,     1e-200, 1e-100, 1e-30, 1e-19,
                          1e-17, 1e-16,  1e-12,  1e-8,  1e-4};
  for (int i = 0; i < 10; i++)
    for (int k = 0; k < 6; k++) {
      const double e = (k % 2 ? 1 : -1) * close[i];
      const double b = k / 2 == 1 ? 0.5 : 1;
      const double d = k / 2 == 0 ? e : k / 2 == 1 ? 0.5 + e : 2 + e;
      const double x[6] = {0, 0, 0, 0, d, 0}, r[2] = {1, b};
      CHECK_CLOSE(united(2, x, r, everywhere),
                  ball(1) + ball(b) - lens(1, b, fabs(d)), ULPS(16) * BALL);
    }
  const double same[9] = {0}, r[3] = {0.5, 1, 1};
  CHECK_REL(united(3, same, r, everywhere), BALL, ULPS(2));
  const double half[6] = {0, 1e3, -1e3, 1e3, -1e3, 1e3};
  CHECK_CLOSE(united(3, same, r, half), BALL / 2, ULPS(4) * BALL);
}

static void test_union_limits(void) {
  const double x[6] = {0, 0, 0, 1, 0, 0}, r[2] = {0.6, 0.6};
  CHECK(united(0, NULL, NULL, everywhere) == 0);
  CHECK(volume_sum(0, NULL, NULL, everywhere) == 0);
  const double zero[2] = {0, 0}, one[2] = {0.6, 0}, less[2] = {0.6, -0.6};
  CHECK(united(2, x, zero, everywhere) == 0);
  CHECK_REL(united(2, x, one, everywhere), ball(0.6), ULPS(2));
  CHECK_REL(united(2, x, less, everywhere), ball(0.6), ULPS(2));
  const double flat[6] = {-1, 1, 0, 0, -1, 1}, far[6] = {8, 9, 8, 9, 8, 9};
  CHECK(united(2, x, r, flat) == 0 && volume_sum(2, x, r, flat) == 0);
  CHECK(united(2, x, r, far) == 0 && volume_sum(2, x, r, far) == 0);
  /* what is behind the last one is none of its business */
  const double behind[7] = {0, 0, 0, 1, 0, 0, GSL_NAN};
  CHECK(united(2, behind, r, everywhere) == united(2, x, r, everywhere));

  const double bad[] = {GSL_NAN, GSL_POSINF, GSL_NEGINF};
  for (int i = 0; i < 3; i++) {
    double volume = -7, y[6], s[2];
    for (int k = 0; k < 6; k++) {
      memcpy(y, x, sizeof y);
      y[k] = bad[i];
      CHECK(volume_union(2, y, r, everywhere, &volume) == GSL_EINVAL);
    }
    memcpy(s, r, sizeof s);
    s[1] = bad[i];
    CHECK(volume_union(2, x, s, everywhere, &volume) == GSL_EINVAL);
    CHECK(volume == -7);
  }
  double volume = -7;
  const double nan_box[6] = {0, 1, 0, GSL_NAN, 0, 1};
  CHECK(volume_union(2, x, r, nan_box, &volume) == GSL_EINVAL && volume == -7);
}

/* Many terms add up without a loss. */
static void test_many(void) {
  const size_t side = 46, n = side * side * side;
  double *x = malloc(4 * n * sizeof *x), *r = x + 3 * n;
  for (size_t i = 0; i < n; i++) {
    x[3 * i] = (double)(i % side);
    x[3 * i + 1] = (double)(i / side % side);
    x[3 * i + 2] = (double)(i / side / side);
    r[i] = 0.4;
  }
  const double want = (double)n * ball(0.4);
  CHECK_REL(volume_sum(n, x, r, everywhere), want, ULPS(4));
  CHECK_REL(united(n, x, r, everywhere), want, ULPS(4));
  free(x);
}

/* Lattices: a cubic cell of side 1 with its corner on a sphere or beside it
   holds a known fraction. */
static size_t lattice(const double (*basis)[3], size_t sites, double r,
                      const double shift[3], double *x, double *radius) {
  size_t n = 0;
  for (int cell = 0; cell < 64; cell++)
    for (size_t s = 0; s < sites; s++, n++) {
      x[3 * n] = cell % 4 - 1 + basis[s][0] + shift[0];
      x[3 * n + 1] = cell / 4 % 4 - 1 + basis[s][1] + shift[1];
      x[3 * n + 2] = cell / 16 - 1 + basis[s][2] + shift[2];
      radius[n] = r;
    }
  return n;
}

static void test_lattices(void) {
  static const double fcc[4][3] = {
      {0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
  static const double bcc[2][3] = {{0, 0, 0}, {0.5, 0.5, 0.5}};
  static const double shifts[3][3] = {
      {0, 0, 0}, {-0.5, -0.25, -0.5}, {-0.123, -0.456, -0.789}};
  const double box[6] = {0, 1, 0, 1, 0, 1};
  double x[3 * 256], r[256];
  for (int i = 0; i < 3; i++) {
    size_t n = lattice(fcc, 1, 0.5, shifts[i], x, r);
    const double tol = ULPS(64);
    CHECK_CLOSE(volume_sum(n, x, r, box), M_PI / 6, tol);
    CHECK_CLOSE(united(n, x, r, box), M_PI / 6, tol);
    n = lattice(bcc, 2, sqrt(3) / 4, shifts[i], x, r);
    CHECK_CLOSE(volume_sum(n, x, r, box), M_PI * sqrt(3) / 8, tol);
    CHECK_CLOSE(united(n, x, r, box), M_PI * sqrt(3) / 8, tol);
    const double touch = sqrt(0.125);
    n = lattice(fcc, 4, touch, shifts[i], x, r);
    CHECK_CLOSE(volume_sum(n, x, r, box), M_PI / sqrt(18), tol);
    CHECK_CLOSE(united(n, x, r, box), M_PI / sqrt(18), tol);
    /* overlapping by so little that no three spheres meet */
    for (int k = 0; k < 8; k++) {
      const double s = 1.001 + 0.02 * k;
      const double rs = s * touch;
      n = lattice(fcc, 4, rs, shifts[i], x, r);
      CHECK_CLOSE(volume_sum(n, x, r, box), 4 * ball(rs), tol);
      CHECK_CLOSE(united(n, x, r, box), 4 * (ball(rs) - 12 * cap(rs, touch)),
                  tol);
    }
    n = lattice(fcc, 4, 0.501, shifts[i], x, r); /* no hole is left */
    CHECK_CLOSE(united(n, x, r, box), 1, tol);
  }
}

static void test_union_quadrature(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double worst = 0;
  for (unsigned long seed = 1; seed <= 30; seed++) {
    gsl_rng_set(rng, seed);
    double x[3 * 8], r[8], box[6] = {-2, 3, -2, 3, -2, 3}, error = 0;
    const size_t n = 3 + gsl_rng_uniform_int(rng, 6);
    random_spheres(rng, n, 0.2, 0.7, x, r);
    if (seed % 2)
      random_box(rng, -0.3, 1.3, box);
    const double want = union_quadrature(n, x, r, box, &error);
    const double got = united(n, x, r, box);
    worst = fmax(worst, fabs(got - want));
    if (!CHECK_CLOSE(got, want, 1e-13 + error) || !CHECK(error < 1e-8))
      fprintf(stderr, "  seed %lu, error of quadrature %g\n", seed, error);
  }
  printf("unions: within %.2g of quadrature\n", worst);
  gsl_rng_free(rng);
}

/* Sum and union of n spheres in a box: bounds, parts of the box, orders of the
   spheres, mirrors, orders of the axes, shifts. */
static bool check_identities(gsl_rng *rng, size_t n, double *x, double *r,
                             const double box[6]) {
  double balls = 0;
  for (size_t i = 0; i < n; i++)
    balls += ball(r[i]);
  const double tol = 1e-14 * (1 + balls);
  const double sum = volume_sum(n, x, r, box), all = united(n, x, r, box);
  const double room = (box[1] - box[0]) * (box[3] - box[2]) * (box[5] - box[4]);
  bool ok = CHECK(all >= 0) && CHECK(all <= sum + tol) &&
            CHECK(all <= room + tol) && CHECK(sum <= balls + tol);

  /* eight parts about a point */
  double cut[3], part[6], smaller[6], part_sum = 0, part_all = 0;
  for (int k = 0; k < 3; k++)
    cut[k] = uniform(rng, box[2 * k], box[2 * k + 1]);
  for (int i = 0; i < 8; i++) {
    for (int k = 0; k < 3; k++) {
      part[2 * k] = i >> k & 1 ? cut[k] : box[2 * k];
      part[2 * k + 1] = i >> k & 1 ? box[2 * k + 1] : cut[k];
    }
    part_sum += volume_sum(n, x, r, part);
    part_all += united(n, x, r, part);
  }
  ok &= CHECK_CLOSE(part_sum, sum, tol);
  ok &= CHECK_CLOSE(part_all, all, tol);
  for (int k = 0; k < 3; k++) {
    const double a = uniform(rng, box[2 * k], box[2 * k + 1]);
    const double b = uniform(rng, box[2 * k], box[2 * k + 1]);
    smaller[2 * k] = fmin(a, b);
    smaller[2 * k + 1] = fmax(a, b);
  }
  ok &= CHECK(volume_sum(n, x, r, smaller) <= sum + tol);
  ok &= CHECK(united(n, x, r, smaller) <= all + tol);

  double *y = malloc(4 * n * sizeof *y), *s = y + 3 * n, moved[6];
  double shift[3];
  for (size_t k = 0; k < 3; k++)
    shift[k] = ldexp((double)gsl_rng_uniform_int(rng, 9) - 4, -2);
  for (size_t i = 0; i < n; i++) { /* backwards, mirrored, axes turned, moved */
    s[i] = r[n - 1 - i];
    for (size_t k = 0; k < 3; k++)
      y[3 * i + k] = shift[k] - x[3 * (n - 1 - i) + (k + 1) % 3];
  }
  for (int k = 0; k < 3; k++) {
    moved[2 * k] = shift[k] - box[2 * ((k + 1) % 3) + 1];
    moved[2 * k + 1] = shift[k] - box[2 * ((k + 1) % 3)];
  }
  /* moving rounds coordinates of size 2, hence shifts surfaces */
  double surface = 0;
  for (size_t i = 0; i < n; i++)
    surface += 4 * M_PI * r[i] * r[i];
  const double tol_moved = tol + ULPS(1) * surface;
  ok &= CHECK_CLOSE(volume_sum(n, y, s, moved), sum, tol_moved);
  ok &= CHECK_CLOSE(united(n, y, s, moved), all, tol_moved);
  free(y);
  return ok;
}

static void test_identities(void) {
  enum { most = 200 };
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double x[3 * most], r[most], box[6] = {0, 1, 0, 1, 0, 1};
  for (unsigned long seed = 1; seed <= 400; seed++) {
    gsl_rng_set(rng, seed);
    const size_t n = 1 + gsl_rng_uniform_int(rng, 20);
    random_spheres(rng, n, 0.01, 0.4, x, r);
    if (seed % 4 == 0) /* many coincidences: a coarse grid of values */
      for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < 3; k++)
          x[3 * i + k] = floor(4 * x[3 * i + k]) / 4;
        r[i] = ceil(10 * r[i]) / 8;
      }
    random_box(rng, -0.2, 1.2, box);
    if (!check_identities(rng, n, x, r, box))
      fprintf(stderr, "  seed %lu\n", seed);
  }
  const double unit[6] = {0, 1, 0, 1, 0, 1};
  gsl_rng_set(rng, 1);
  random_spheres(rng, 200, 0.05, 0.15, x, r);
  CHECK(check_identities(rng, 200, x, r, unit));
  gsl_rng_free(rng);
}

static void test_symmetric_three(void) {
  /* a small sphere in the mouth of two others; each half is half */
  const double x[9] = {-0.5, 0, 0, 0.5, 0, 0, 0, 0.7, 0};
  const double r[3] = {0.7, 0.7, 0.4};
  const double left[6] = {-2, 0, -2, 2, -2, 2}, all[6] = {-2, 2, -2, 2, -2, 2};
  const double whole = united(3, x, r, all);
  CHECK_CLOSE(united(3, x, r, left), whole / 2, ULPS(16));
  double error = 0;
  CHECK_CLOSE(whole, union_quadrature(3, x, r, all, &error), 1e-10);
  CHECK(error < 1e-9);
}

/* --- midpoints -------------------------------------------------------------*/

static void naive_sampled(size_t n, const double *x, const double *r,
                          const double box[6], size_t count, double *sum,
                          double *all) {
  double p[3], h[3];
  for (int k = 0; k < 3; k++)
    h[k] = (box[2 * k + 1] - box[2 * k]) / (double)count;
  size_t hits = 0, points = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++)
      for (size_t k = 0; k < count; k++) {
        p[0] = box[0] + ((double)i + 0.5) * h[0];
        p[1] = box[2] + ((double)j + 0.5) * h[1];
        p[2] = box[4] + ((double)k + 0.5) * h[2];
        size_t here = 0;
        for (size_t s = 0; s < n; s++) {
          double d[3];
          vec3_sub(p, x + 3 * s, d);
          here += vec3_dot(d, d) <= r[s] * r[s];
        }
        hits += here;
        points += here > 0;
      }
  *sum = (double)hits * (h[0] * h[1] * h[2]);
  *all = (double)points * (h[0] * h[1] * h[2]);
}

static void test_sampled(void) {
  enum { most = 40 };
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  double x[3 * most], r[most], box[6], sum, all, want_sum, want_all;
  for (unsigned long seed = 1; seed <= 60; seed++) {
    gsl_rng_set(rng, seed);
    const size_t n = gsl_rng_uniform_int(rng, most + 1);
    random_spheres(rng, n, 0.0, 0.4, x, r);
    random_box(rng, -0.3, 1.3, box);
    const size_t count = 1 + gsl_rng_uniform_int(rng, 16);
    naive_sampled(n, x, r, box, count, &want_sum, &want_all);
    bool ok = CHECK(volume_sampled(n, x, r, box, count, NULL, &sum, &all) ==
                    GSL_SUCCESS);
    ok &= CHECK_REL(sum, want_sum, ULPS(8));
    ok &= CHECK_REL(all, want_all, ULPS(8));
    if (!ok)
      fprintf(stderr, "  seed %lu\n", seed);
  }
  /* midpoints on the sphere count: 8 corners of a cube, 1 centre, 6 beside */
  const double grid[6] = {0, 3, 0, 3, 0, 3}, mid[3] = {1.5, 1.5, 1.5};
  const double reach[4] = {0, 1, 0.999999, -1}, want[4] = {1, 7, 1, 0};
  for (int i = 0; i < 4; i++) {
    CHECK(volume_sampled(1, mid, reach + i, grid, 3, NULL, &sum, &all) ==
          GSL_SUCCESS);
    CHECK_REL(sum, want[i], ULPS(2));
    CHECK_REL(all, want[i], ULPS(2));
  }
  /* outside, huge, not a number */
  const double odd[9] = {9, 9, 9, 1e300, 0, 0, GSL_NAN, 1, 1};
  const double odd_r[3] = {1, 1, 1};
  CHECK(volume_sampled(3, odd, odd_r, grid, 3, NULL, &sum, &all) ==
        GSL_SUCCESS);
  CHECK(sum == 0 && all == 0);
  const double huge = 1e100;
  CHECK(volume_sampled(1, mid, &huge, grid, 3, NULL, &sum, &all) ==
        GSL_SUCCESS);
  CHECK_CLOSE(all, 27, ULPS(54));
  CHECK(volume_sampled(1, mid, &huge, grid, 0, NULL, &sum, &all) ==
        GSL_SUCCESS);
  CHECK(sum == 0 && all == 0);
  const double flat[6] = {0, 1, 0, 0, 0, 1};
  CHECK(volume_sampled(1, mid, &huge, flat, 3, NULL, &sum, &all) ==
        GSL_SUCCESS);
  CHECK(sum == 0 && all == 0);
  sum = all = -7;
  CHECK(volume_sampled(1, mid, &huge, grid, SIZE_MAX / 2, NULL, &sum, &all) ==
        GSL_ENOMEM);
  CHECK(sum == -7 && all == -7);

  /* towards the exact volumes: the surface passes through about
     surface/step^2 midpoints' cells; their errors, each of a variance below
     step^6/12, add up like random ones, and 4 deviations are granted */
  gsl_rng_set(rng, 5);
  const double unit[6] = {0, 1, 0, 1, 0, 1};
  random_spheres(rng, 30, 0.1, 0.3, x, r);
  const double exact_sum = volume_sum(30, x, r, unit);
  const double exact_all = united(30, x, r, unit);
  double surface = 0;
  for (int i = 0; i < 30; i++)
    surface += 4 * M_PI * r[i] * r[i];
  printf("midpoints  error of sum  of union\n");
  for (size_t count = 8; count <= 128; count *= 2) {
    const double step = 1 / (double)count;
    CHECK(volume_sampled(30, x, r, unit, count, NULL, &sum, &all) ==
          GSL_SUCCESS);
    printf("%6zu^3    %12.3g %9.3g\n", count, sum - exact_sum, all - exact_all);
    const double tol = 4 * sqrt(surface / 12) * step * step;
    CHECK_CLOSE(sum, exact_sum, tol);
    CHECK_CLOSE(all, exact_all, tol);
  }
  gsl_rng_free(rng);
}

/* What is full is full, and never more than that: a box among spheres that are
   larger than itself, a giant beside small ones; a rectangle likewise. */
static void test_full(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  size_t above = 0;
  for (unsigned long seed = 1; seed <= 300; seed++) {
    gsl_rng_set(rng, seed);
    enum { N = 12 };
    double x[3 * N], r[N], c[2 * N], box[6], volume = GSL_NAN, area = GSL_NAN;
    for (int k = 0; k < 6; k++)
      box[k] = k % 2 ? box[k - 1] + 0.1 + gsl_rng_uniform(rng)
                     : gsl_rng_uniform(rng) - 0.5;
    for (size_t i = 0; i < N; i++) {
      for (size_t k = 0; k < 3; k++)
        x[3 * i + k] =
            box[2 * k] + gsl_rng_uniform(rng) * (box[2 * k + 1] - box[2 * k]);
      c[2 * i] = x[3 * i];
      c[2 * i + 1] = x[3 * i + 1];
      r[i] = (i ? 0.1 : 2.5) * (1 + 10 * (double)(seed % 2)) +
             gsl_rng_uniform(rng);
    }
    const double whole = box_volume(box);
    const double rectangle = (box[1] - box[0]) * (box[3] - box[2]);
    CHECK(volume_union(N, x, r, box, &volume) == GSL_SUCCESS);
    CHECK(area_union(N, c, r, box, &area) == GSL_SUCCESS);
    const double scale = gsl_pow_3(r[0]) * N;
    CHECK_CLOSE(volume, whole, 100 * DBL_EPSILON * scale);
    CHECK_CLOSE(area, rectangle, 100 * DBL_EPSILON * scale);
    CHECK(volume <= whole && area <= rectangle);
    above += volume == whole;
  }
  CHECK(above > 10); /* else no rounding ever went that way */
  gsl_rng_free(rng);
}

/* --- balls in a tube
 * --------------------------------------------------------*/

/* Of one ball: the areas of all shells about the axis, found in another way. */
static double oracle_tube_shell(double radius, void *params) {
  const double *p = params; /* away, low, high, r */
  const double x[3] = {p[0], 0, 0};
  const struct area_shell shell = {{0, 0}, radius, {p[1], p[2]}};
  double sum, all = GSL_NAN;
  area_shell_covered(1, x, &p[3], &shell, &sum, &all);
  return all;
}

static void test_tube(void) {
  const double inf = GSL_POSINF;
  /* away from the mantle; on the axis; Viviani's; all of a piece of tube */
  CHECK_CLOSE(tube_ball_volume(0.3, 2, -inf, inf, 1), BALL, 4e-15 * BALL);
  CHECK_CLOSE(tube_ball_volume(0.3, 2, 0.2, 5, 1), cap(1, 0.2), 4e-15);
  CHECK_CLOSE(tube_ball_volume(0, 0.6, -inf, inf, 1), BALL * (1 - 0.512),
              4e-15 * BALL);
  CHECK_CLOSE(tube_ball_volume(0.5, 0.5, -inf, inf, 1), 2 * M_PI / 3 - 8. / 9,
              1e-10);
  CHECK_CLOSE(tube_ball_volume(0.2, 0.7, -1, 2, 50), 3 * M_PI * 0.49, 1e-13);
  CHECK(tube_ball_volume(0.2, 0.7, 1, 2, 0.5) == 0);
  CHECK(tube_ball_volume(3, 0.7, -1, 2, 0.5) == 0);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(2000);
  int exact = 0;
  for (int k = 0; k < 60; k++) {
    const double R = uniform(rng, 0.1, 1.5), away = uniform(rng, 0, 1) * R;
    const double low = uniform(rng, -1.2, 0.5);
    const double high = low + uniform(rng, 0, 2);
    double p[4] = {away, low, high, 1}, want, error;
    gsl_function f = {oracle_tube_shell, p};
    gsl_integration_qag(&f, 0, R, 1e-11, 1e-11, 2000, GSL_INTEG_GAUSS21, w,
                        &want, &error);
    const double got = tube_ball_volume(away, R, low, high, 1);
    CHECK_CLOSE(got, want, 1e-6);
    exact += fabs(got - want) <= 1e-10 + 2 * error;
    /* and the pieces of a tube are the whole */
    const double middle = uniform(rng, low, high);
    CHECK_CLOSE(tube_ball_volume(away, R, low, middle, 1) +
                    tube_ball_volume(away, R, middle, high, 1),
                got, 2e-6);
  }
  CHECK(exact >= 57);
  gsl_integration_workspace_free(w);
  gsl_rng_free(rng);
}

int main(void) {
  /* quadrature at the limit of rounding says so; its estimates are checked */
  gsl_set_error_handler_off();
  test_caps();
  test_shares();
  test_degenerate_planes();
  test_plane_quadrature();
  test_cells();
  test_plane_invariance();
  test_box();
  test_box_split();
  test_two();
  test_union_limits();
  test_many();
  test_lattices();
  test_union_quadrature();
  test_symmetric_three();
  test_identities();
  test_full();
  test_sampled();
  test_tube();
  return check_done();
}
