/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the volume comes about.

   Let z be the axis along which the cell is farthest from the centre of the
   ball, and above it. There the ball's surface is a graph z = f(x, y) with
   f = sqrt(r^2 - x^2 - y^2), and the ball's part of the cell is what lies
   between f and the cell's floor less what lies between f and its ceiling:

     V = P(floor) - P(ceiling),
     P(a) = int int (f - a) dx dy   over the rectangle where f > a.

   That region R is the rectangle's part inside the circle of radius
   rho^2 = r^2 - a^2. In polar coordinates about a point p0, with p on R's
   boundary,

     P = closed int (p - p0) x dp  int_0^1 (f(p0 + t (p - p0)) - a) t dt.

   In a quadrant of the plane p0 is the corner nearest the axis. Its two edges
   contribute nothing, and what remains of R's boundary are parts of the two
   other edges and one arc. The arc is taken as a rational curve of the tangent
   of a quarter of its angle, without any trigonometric function. All integrands
   are analytic, so Gauss's rule converges geometrically; how fast follows from
   the distance to the equator, where f has its branch point. */
#include "geometry/ball_cell.h"

#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include "platform/multiversion.h"
#include "geometry/volume.h"

static const size_t points[BALL_CELL_RULES] = {8, 12, 16};

int ball_cell_init(struct ball_cell *q) {
  for (int i = 0; i < BALL_CELL_RULES; i++) {
    gsl_integration_glfixed_table *t =
        gsl_integration_glfixed_table_alloc(points[i]);
    if (!t)
      return GSL_ENOMEM;
    for (size_t k = 0; k < points[i]; k++)
      gsl_integration_glfixed_point(0, 1, k, &q->rule[i].node[k],
                                    &q->rule[i].weight[k], t);
    gsl_integration_glfixed_table_free(t);
  }
  return GSL_SUCCESS;
}

/* Into each instruction set's copy of the caller. */
#define INLINED static inline __attribute__((always_inline))

/* A rule and the part of the plane that it integrates over. */
struct region {
  const double *node, *weight;
  double r2, a, rho2, rho; /* r^2, the plane, its circle */
  double x0, x1, y0, y1;   /* 0 <= x0 < x1, 0 <= y0 < y1 */
};

/* int_0^1 (f - a) t dt along the ray from the near corner by (dx, dy). */
INLINED double along_ray(const struct region *g, int n, double dx, double dy) {
  const double q0 = g->r2 - g->x0 * g->x0 - g->y0 * g->y0;
  const double q1 = 2 * (g->x0 * dx + g->y0 * dy), q2 = dx * dx + dy * dy;
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (int k = 0; k < n; k++) {
    const double t = g->node[k];
    sum += g->weight[k] * t * (sqrt(q0 - t * (q1 + t * q2)) - g->a);
  }
  return sum;
}

INLINED double right_edge(const struct region *g, int n, double y_end) {
  const double dx = g->x1 - g->x0, length = y_end - g->y0;
  double sum = 0;
  for (int k = 0; k < n; k++)
    sum += g->weight[k] * along_ray(g, n, dx, length * g->node[k]);
  return sum * dx * length;
}

INLINED double top_edge(const struct region *g, int n, double x_end) {
  const double dy = g->y1 - g->y0, length = x_end - g->x0;
  double sum = 0;
  for (int k = 0; k < n; k++)
    sum += g->weight[k] * along_ray(g, n, length * g->node[k], dy);
  return sum * dy * length;
}

/* Arc from s to e, counter-clockwise and at most a quarter of the circle. A
   point at the angle 2 atan(t) from its middle m is
   ((1 - t^2) m + 2 t m') / (1 + t^2), m' being m turned by a right angle. Its
   poles are at t = i, 10 half-lengths or more from a part of the arc. */
INLINED double arc(const struct region *g, int n, const double s[2],
                   const double e[2]) {
  const double sum_x = s[0] + e[0], sum_y = s[1] + e[1];
  const double twice = sqrt(sum_x * sum_x + sum_y * sum_y);
  const double chord_x = e[0] - s[0], chord_y = e[1] - s[1];
  const double chord = sqrt(chord_x * chord_x + chord_y * chord_y);
  const double end = chord / (2 * g->rho + twice);
  const double m[2] = {g->rho * sum_x / twice, g->rho * sum_y / twice};
  const int parts = (int)ceil(end / 0.1);
  const double length = 2 * end / parts;
  double sum = 0;
  for (int part = 0; part < parts; part++)
    for (int k = 0; k < n; k++) {
      const double t = length * (part + g->node[k]) - end;
      const double w = 1 / (1 + t * t);
      const double along = -2 * t * t * w, across = 2 * t * w;
      const double x = m[0] + (along * m[0] - across * m[1]);
      const double y = m[1] + (along * m[1] + across * m[0]);
      const double dx = x - g->x0, dy = y - g->y0;
      sum += g->weight[k] * w * (dx * x + dy * y) * along_ray(g, n, dx, dy);
    }
  return 2 * length * sum;
}

/* P of the above over a rectangle in the first quadrant. */
INLINED double above_quadrant(const struct region *g, int n) {
  const double xx0 = g->x0 * g->x0, xx1 = g->x1 * g->x1;
  const double yy0 = g->y0 * g->y0, yy1 = g->y1 * g->y1, rho2 = g->rho2;
  if (xx0 + yy0 >= rho2)
    return 0;
  double start[2] = {g->x1, g->y0}, end[2] = {g->x0, g->y1};
  double sum = 0;
  if (xx1 + yy1 <= rho2)
    return right_edge(g, n, g->y1) + top_edge(g, n, g->x1);
  if (xx1 + yy0 < rho2) {
    start[1] = sqrt(rho2 - xx1);
    sum += right_edge(g, n, start[1]);
  } else
    start[0] = sqrt(rho2 - yy0);
  if (xx0 + yy1 < rho2) {
    end[0] = sqrt(rho2 - yy1);
    sum += top_edge(g, n, end[0]);
  } else
    end[1] = sqrt(rho2 - xx0);
  return sum + arc(g, n, start, end);
}

/* The same for a rectangle anywhere, by its parts in each quadrant, turned
   into the first. */
INLINED double above(struct region *g, int n, double a, const double x[2],
                     const double y[2]) {
  g->a = a;
  g->rho2 = g->r2 - a * a;
  if (g->rho2 <= 0)
    return 0;
  g->rho = sqrt(g->rho2);
  double sum = 0;
  for (int i = 0; i < 2; i++) {
    g->x0 = fmax(0, i ? -x[1] : x[0]);
    g->x1 = i ? -x[0] : x[1];
    for (int j = 0; j < 2 && g->x0 < g->x1; j++) {
      g->y0 = fmax(0, j ? -y[1] : y[0]);
      g->y1 = j ? -y[0] : y[1];
      if (g->y0 < g->y1)
        sum += above_quadrant(g, n);
    }
  }
  return sum;
}

/* One for each rule, so that the loops' lengths are known. */
#define WITH(n)                                                                \
  MULTIVERSION static double with_##n(struct region *g, const double x[2],     \
                                      const double y[2], const double z[2]) {  \
    return above(g, n, z[0], x, y) - above(g, n, z[1], x, y);                  \
  }
WITH(8)
WITH(12)
WITH(16)

static const struct {
  double size; /* of the ellipse, to the power -2n about 1e-17 */
  double (*integrate)(struct region *g, const double x[2], const double y[2],
                      const double z[2]);
} rules[BALL_CELL_RULES] = {{11.5, with_8}, {5.1, with_12}, {3.4, with_16}};

static double square(double x) {
  return x * x;
}

/* The ellipse about the interval of integration within which f is analytic, by
   the sum of its half-axes; the rule's error goes with its -2n-th power. The
   equator is at least r less the farthest point of R away, and no line of
   integration is longer than a diagonal. 0 if this is no place for the rule. */
static double ellipse(double r, const double x[2], const double y[2],
                      double floor) {
  const double x_far = fmax(fabs(x[0]), fabs(x[1]));
  const double y_far = fmax(fabs(y[0]), fabs(y[1]));
  const double rho2 = (r - floor) * (r + floor);
  const double far2 = fmin(x_far * x_far + y_far * y_far, rho2);
  if (floor <= 0 || far2 <= 0 || far2 >= r * r)
    return 0;
  const double half = sqrt(square(x[1] - x[0]) + square(y[1] - y[0])) / 2;
  const double z = 1 + (r - sqrt(far2)) / half;
  return z + sqrt(z * z - 1);
}

double ball_cell_volume(const struct ball_cell *q, const double c[3], double r,
                        const double cell[6]) {
  double side[3][2];
  int up = 0;
  for (int k = 0; k < 3; k++) {
    side[k][0] = cell[2 * k] - c[k];
    side[k][1] = cell[2 * k + 1] - c[k];
    if (fabs(side[k][0] + side[k][1]) > fabs(side[up][0] + side[up][1]))
      up = k;
  }
  double z[2] = {side[up][0], side[up][1]};
  if (z[0] + z[1] < 0) {
    z[0] = -side[up][1];
    z[1] = -side[up][0];
  }
  const double *x = side[(up + 1) % 3], *y = side[(up + 2) % 3];
  const double size = ellipse(r, x, y, z[0]);
  for (int i = 0; i < BALL_CELL_RULES; i++)
    if (size > rules[i].size) {
      struct region g = {
          .r2 = r * r, .node = q->rule[i].node, .weight = q->rule[i].weight};
      return rules[i].integrate(&g, x, y, z);
    }
  return volume_ball_box(c, r, cell);
}
