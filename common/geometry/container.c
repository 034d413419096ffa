/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A slice across the tube's axis is a disc within straight lines, whose area is
   elementary (area.h). Along the axis it is smooth except where a corner of the
   polyhedron passes, where a side of the slice touches the circle, and where a
   corner of the slice meets it. Between those places, all of them known, a
   quadrature for singular ends comes to rounding. Without a tube the disc is
   larger than the box. */
#include "geometry/container.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include "geometry/area.h"
#include "geometry/line.h"

/* Cuts the range of t to where speed t <= ahead. */
static bool cut(double speed, double ahead, double t[2]) {
  if (speed > 0)
    t[1] = fmin(t[1], ahead / speed);
  else if (speed < 0)
    t[0] = fmax(t[0], ahead / speed);
  else if (ahead < 0)
    return false;
  return t[0] < t[1];
}

static bool tube_line(const struct container *c, const double p[3],
                      const double e[3], double t[2]) {
  static const double none[3];
  double d[3], across[3] = {e[0], e[1], e[2]}, within[2];
  container_away(c, p, d);
  vec3_axpy(-vec3_dot(e, c->axis), c->axis, across);
  /* as solid_line_cylinder has it */
  if (!(vec3_dot(across, across) > 1e-24 * vec3_dot(e, e)))
    return vec3_norm(d) < c->radius;
  if (!line_ball(none, c->radius, d, across, within))
    return false;
  t[0] = fmax(t[0], within[0]);
  t[1] = fmin(t[1], within[1]);
  return t[0] < t[1];
}

bool container_line(const struct container *c, const double p[3],
                    const double e[3], double t[2]) {
  t[0] = -INFINITY;
  t[1] = INFINITY;
  for (int k = 0; k < 3; k++)
    if (!cut(-e[k], p[k] - c->box[2 * k], t) ||
        !cut(e[k], c->box[2 * k + 1] - p[k], t))
      return false;
  for (size_t k = 0; k < c->planes; k++)
    if (!cut(vec3_dot(c->plane[k], e),
             c->plane[k][3] - vec3_dot(c->plane[k], p), t))
      return false;
  return !(c->radius > 0) || tube_line(c, p, e, t);
}

/* A side of the slices: {y: normal.y <= from + t slope} with a unit normal. */
struct side {
  double normal[2], from, slope;
};

struct slices {
  double radius, low, high; /* of the disc; of t */
  size_t sides;
  struct side *side;
  double (*line)[3];
};

static double slice_area(double t, void *params) {
  struct slices *s = params;
  for (size_t k = 0; k < s->sides; k++) {
    s->line[k][0] = s->side[k].normal[0];
    s->line[k][1] = s->side[k].normal[1];
    s->line[k][2] = s->side[k].from + t * s->side[k].slope;
  }
  return area_disc_lines(s->radius, s->sides, (const double(*)[3])s->line);
}

/* Adds the plane normal.x <= offset, seen from the origin of the slices. */
static void add_side(struct slices *s, const double normal[3], double offset,
                     const double u[3], const double v[3],
                     const double axis[3]) {
  const double nu = vec3_dot(normal, u), nv = vec3_dot(normal, v);
  const double along = vec3_dot(normal, axis), length = hypot(nu, nv);
  if (length > 1e-12) {
    s->side[s->sides++] = (struct side){
        {nu / length, nv / length}, offset / length, -along / length};
  } else if (along > 0) {
    s->high = fmin(s->high, offset / along);
  } else {
    s->low = fmax(s->low, offset / along);
  }
}

/* Where a + b t + c t^2 = 0, as far as there are places. */
static size_t roots(double a, double b, double c, double t[2]) {
  if (c == 0) {
    t[0] = -a / b;
    return b != 0;
  }
  const double square = b * b - 4 * a * c;
  if (!(square >= 0))
    return 0;
  const double q = -(b + copysign(sqrt(square), b)) / 2;
  t[0] = q / c;
  t[1] = q != 0 ? a / q : t[0];
  return 2;
}

static void keep(const struct slices *s, double t, double *at, size_t *count) {
  if (t > s->low && t < s->high)
    at[(*count)++] = t;
}

/* The place where sides i and j cross, y + t way; false if they are parallel.
 */
static bool crossing(const struct side *i, const struct side *j, double y[2],
                     double way[2]) {
  const double sine = i->normal[0] * j->normal[1] - i->normal[1] * j->normal[0];
  if (fabs(sine) < 1e-12)
    return false;
  y[0] = (i->from * j->normal[1] - j->from * i->normal[1]) / sine;
  y[1] = (j->from * i->normal[0] - i->from * j->normal[0]) / sine;
  way[0] = (i->slope * j->normal[1] - j->slope * i->normal[1]) / sine;
  way[1] = (j->slope * i->normal[0] - i->slope * j->normal[0]) / sine;
  return true;
}

/* Places where the area may not be smooth; at has room for all. */
static size_t find_kinks(const struct slices *s, double *at) {
  size_t count = 0;
  double t[2], y[2], way[2];
  for (size_t i = 0; i < s->sides; i++) {
    const struct side *a = &s->side[i];
    for (int sign = -1; sign <= 1 && a->slope != 0; sign += 2)
      keep(s, (sign * s->radius - a->from) / a->slope, at, &count);
    for (size_t j = 0; j < i; j++) {
      if (!crossing(a, &s->side[j], y, way))
        continue;
      const size_t found =
          roots(y[0] * y[0] + y[1] * y[1] - s->radius * s->radius,
                2 * (y[0] * way[0] + y[1] * way[1]),
                way[0] * way[0] + way[1] * way[1], t);
      for (size_t m = 0; m < found; m++)
        keep(s, t[m], at, &count);
      for (size_t k = 0; k < j; k++) {
        const struct side *c = &s->side[k];
        const double ahead =
            c->from - c->normal[0] * y[0] - c->normal[1] * y[1];
        const double speed =
            c->normal[0] * way[0] + c->normal[1] * way[1] - c->slope;
        if (speed != 0)
          keep(s, ahead / speed, at, &count);
      }
    }
  }
  return count;
}

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

enum { INTERVALS = 200 };

static int integrate(struct slices *s, double *at, double *volume) {
  size_t count = find_kinks(s, at);
  at[count++] = s->low;
  at[count++] = s->high;
  qsort(at, count, sizeof *at, compare);
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(INTERVALS);
  if (!w)
    return GSL_ENOMEM;
  gsl_function f = {slice_area, s};
  const double enough =
      1e-14 * M_PI * s->radius * s->radius * (s->high - s->low);
  *volume = 0;
  for (size_t k = 1; k < count; k++) {
    double part = 0, error;
    /* rounding may be all that is left of the tolerance */
    if (at[k] > at[k - 1])
      gsl_integration_qags(&f, at[k - 1], at[k], enough, 1e-13, INTERVALS, w,
                           &part, &error);
    *volume += part;
  }
  gsl_integration_workspace_free(w);
  return GSL_SUCCESS;
}

/* The slices of what is in a box, from its middle or the foot of that on the
   tube's axis. */
static void slice(struct slices *s, const struct container *c,
                  const double box[6]) {
  double middle[3], half = 0, axis[3] = {0, 0, 1}, u[3], v[3], d[3];
  for (int k = 0; k < 3; k++) {
    const double side = box[2 * k + 1] - box[2 * k];
    middle[k] = box[2 * k] + side / 2;
    half += side * side / 4;
  }
  s->radius = 1.01 * sqrt(half);
  if (c->radius > 0) {
    s->radius = c->radius;
    memcpy(axis, c->axis, sizeof axis);
    container_away(c, middle, d);
    vec3_sub(middle, d, middle);
    half += vec3_dot(d, d);
  }
  vec3_across(axis, u);
  vec3_cross(axis, u, v);
  s->high = sqrt(half);
  s->low = -s->high;
  for (int k = 0; k < 6; k++) {
    double normal[3] = {0, 0, 0};
    const double sign = k % 2 ? 1 : -1;
    normal[k / 2] = sign;
    add_side(s, normal, sign * (box[k] - middle[k / 2]), u, v, axis);
  }
  for (size_t k = 0; k < c->planes; k++)
    add_side(s, c->plane[k], c->plane[k][3] - vec3_dot(c->plane[k], middle), u,
             v, axis);
}

static bool is_finite(const struct container *c) {
  double sum = c->radius;
  for (size_t k = 0; k < c->planes; k++)
    for (int m = 0; m < 4; m++)
      sum += fabs(c->plane[k][m]);
  for (int k = 0; k < 3 && c->radius > 0; k++)
    sum += fabs(c->point[k]) + fabs(c->axis[k]);
  return isfinite(sum);
}

int container_volume(const struct container *c, const double box[6],
                     double *volume) {
  double within[6];
  if (!is_finite(c))
    return GSL_EINVAL;
  for (int k = 0; k < 6; k++)
    within[k] = k % 2 ? fmin(box[k], c->box[k]) : fmax(box[k], c->box[k]);
  if (!box_valid(within)) {
    if (isnan(box_volume(box)))
      return GSL_EINVAL;
    *volume = 0;
    return GSL_SUCCESS;
  }
  if (!container_slants(c)) {
    *volume = box_volume(within);
    return GSL_SUCCESS;
  }
  const size_t most = c->planes + 6, triples = most * most * most;
  struct slices s = {.side = calloc(most, sizeof *s.side),
                     .line = calloc(most, sizeof *s.line)};
  double *at = calloc(3 * triples + 2, sizeof *at);
  int status = GSL_ENOMEM;
  if (s.side && s.line && at) {
    slice(&s, c, within);
    *volume = 0;
    status = s.low < s.high ? integrate(&s, at, volume) : GSL_SUCCESS;
  }
  free(at);
  free(s.line);
  free(s.side);
  return status;
}
