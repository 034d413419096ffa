/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the volumes come about.

   Stand at the centre O of the ball and look along a ray. It starts in the
   polyhedron P or not, and each face of P that it crosses toggles that: a face
   whose plane has O on its inner side (offset h > 0) is a way out, the others
   are ways in. Everything in the ball behind a face, its shadow, is therefore
   taken away or added whole:

     V = [O in P] 4/3 pi r^3 - sum_i sign(h_i) shadow(face i).

   The plane of a face cuts the ball in a disc of radius rho,
   rho^2 = r^2 - h^2, whose shadow is a cap, pi/3 (r - |h|)^2 (2 r + |h|). The
   face is the part of the disc inside the other half-spaces. The same argument
   serves again, now within the plane and from the foot F of O: the face ends
   at lines with offsets e_j from F, and

     shadow(face) = [F in face] cap - sum_j sign(e_j) shadow(beyond edge j),

   where the part beyond an edge is what lies, seen from F, between the edge
   and the circle. With s along the line, from the foot of F, the edge from s0
   to s1 leaves U(s1) - U(s0), and U(s) is the primitive: the shadow of a
   sector of the disc with angle alpha = atan(s/e) less that of the right
   triangle F, foot, end of the edge. The sector's is the cap times
   alpha / (2 pi). The triangle's is the sector of the ball over it, r^3/3
   times the solid angle, less the tetrahedron below it, h e s / 6. At the
   azimuth f the triangle reaches to the polar angle t with
   tan t = e / (h cos f), so that its solid angle is

     int_0^alpha (1 - cos t) df = alpha - A,
     A = int_0^alpha h cos f / sqrt(e^2 + h^2 cos^2 f) df
       = asin(h sin alpha / sqrt(h^2 + e^2))
       = atan(h s / (e sqrt(h^2 + e^2 + s^2))),

   and (r - h)^2 (2 r + h) = 2 r^3 - 3 r^2 h + h^3 gives

     6 U = 2 r^3 A + h e s - h (3 r^2 - h^2) alpha.

   Nothing needs to be bounded, no polygon or polyhedron is ever built, and a
   plane or an edge that misses the ball leaves exactly nothing.

   Rounding. An error of a line on a face costs no more than the strip that it
   moves over, if both faces see one and the same line and both edges at a
   corner one and the same corner. So that they do at any angle, offsets within
   planes and lines come from differences of normals and of offsets, which are
   accurate even if planes nearly coincide or nearly meet in O.

   The time is O(count^3) at worst, but only half-spaces that cut a face inside
   the ball go beyond O(count^2). */
#include "geometry/volume.h"

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "geometry/halfspace.h"
#include "geometry/power.h"
#include "geometry/vec3.h"

/* U of the above; h, e > 0, s of either sign. */
static double beyond(double r, double h, double e, double s) {
  const double a = atan2(h * s, e * sqrt(h * h + e * e + s * s));
  return (2 * r * r * r * a + h * e * s -
          h * (3 * r * r - h * h) * atan2(s, e)) /
         6;
}

static double ball(double r) {
  return 4 * M_PI / 3 * r * r * r;
}

static double cap(double r, double h) {
  return M_PI / 3 * (r - h) * (r - h) * (2 * r + h);
}

/* The plane of half-space i, and u, v, which span it. */
struct face {
  size_t i;
  const double *normal;
  double r, h, rho2, u[3], v[3];
};

static struct face face_of(double r, const double (*planes)[4], size_t i) {
  const double *n = planes[i];
  struct face f = {
      .i = i, .normal = n, .r = r, .h = halfspace_off_zero(n[3], r)};
  f.rho2 = (r - f.h) * (r + f.h);
  /* Duff et al., J. Computer Graphics Techniques 6 (2017) 1 */
  const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]);
  f.u[0] = 1 + sign * n[0] * n[0] * a;
  f.u[1] = sign * n[0] * n[1] * a;
  f.u[2] = -sign * n[0];
  f.v[0] = n[0] * n[1] * a;
  f.v[1] = sign + n[1] * n[1] * a;
  f.v[2] = -n[1];
  return f;
}

/* How much of a face's disc a half-space leaves. */
enum leaves { ALL, SOME, NONE };

/* Half-space j on a face: {y: line[0] y_u + line[1] y_v <= line[2]} if it
   leaves SOME of the disc. */
static enum leaves trace(const struct face *f, const double (*planes)[4],
                         size_t j, double line[3]) {
  const double h = halfspace_off_zero(planes[j][3], f->r);
  if (h >= f->r)
    return ALL;
  double d[3], sign;
  const double w =
      halfspace_restricted(3, f->normal, f->h, planes[j], h, d, &sign);
  const double pu = vec3_dot(d, f->u), pv = vec3_dot(d, f->v);
  const double sine2 = pu * pu + pv * pv;
  if (sine2 < HALFSPACE_PARALLEL * HALFSPACE_PARALLEL)
    return halfspace_hidden(f->h, h, sign, j < f->i) ? NONE : ALL;
  if (w * w >= f->rho2 * sine2)
    return w < 0 ? NONE : ALL;
  const double sine = sqrt(sine2);
  line[0] = pu / sine;
  line[1] = pv / sine;
  line[2] = halfspace_off_zero(w / sine, fabs(f->h));
  return SOME;
}

/* Shadow beyond the edge that half-space j gives a face. */
static double edge_shadow(const struct face *f, size_t count,
                          const double (*planes)[4], size_t j,
                          const double line[3]) {
  const double e = line[2];
  double s1 = sqrt(fmax(0, f->rho2 - e * e)), s0 = -s1;
  for (size_t k = 0; k < count && s0 < s1; k++) {
    double other[3], d[2], sign;
    if (k == f->i || k == j || trace(f, planes, k, other) != SOME)
      continue;
    const double w =
        halfspace_restricted(2, line, e, other, other[2], d, &sign);
    const double sine = line[0] * d[1] - line[1] * d[0];
    if (fabs(sine) < HALFSPACE_PARALLEL) {
      if (halfspace_hidden(e, other[2], sign, k < j))
        return 0;
    } else if (sine > 0)
      s1 = fmin(s1, w / sine);
    else
      s0 = fmax(s0, w / sine);
  }
  if (s0 >= s1)
    return 0;
  return beyond(f->r, fabs(f->h), fabs(e), s1) -
         beyond(f->r, fabs(f->h), fabs(e), s0);
}

static double face_shadow(double r, size_t count, const double (*planes)[4],
                          size_t i) {
  const struct face f = face_of(r, planes, i);
  double line[3], shadow = 0;
  bool foot_inside = true;
  for (size_t j = 0; j < count; j++)
    if (j != i && trace(&f, planes, j, line) == NONE)
      return 0;
  for (size_t j = 0; j < count; j++) {
    if (j == i || trace(&f, planes, j, line) == ALL)
      continue;
    const double part = edge_shadow(&f, count, planes, j, line);
    shadow += line[2] < 0 ? part : -part;
    foot_inside = foot_inside && line[2] > 0;
  }
  return foot_inside ? shadow + cap(r, fabs(f.h)) : shadow;
}

double volume_ball_planes(double r, size_t count, const double (*planes)[4]) {
  if (r <= 0)
    return 0;
  for (size_t i = 0; i < count; i++) {
    if (planes[i][3] <= -r)
      return 0;
    if (isnan(planes[i][3]))
      return GSL_NAN;
  }
  double volume = 0;
  bool centre_inside = true;
  for (size_t i = 0; i < count; i++) {
    if (planes[i][3] >= r)
      continue;
    const double shadow = face_shadow(r, count, planes, i);
    volume += planes[i][3] > 0 ? -shadow : shadow;
    centre_inside = centre_inside && planes[i][3] > 0;
  }
  if (centre_inside)
    volume += ball(r);
  return volume < 0 ? 0 : volume; /* less than nothing is rounding */
}

static bool empty(const double box[6]) {
  return box[1] <= box[0] || box[3] <= box[2] || box[5] <= box[4];
}

/* The faces of a box that a ball reaches, seen from its centre; room for 6. */
static size_t box_planes(const double c[3], double r, const double box[6],
                         double (*planes)[4]) {
  size_t count = 0;
  for (int k = 0; k < 6; k++) {
    const int axis = k / 2, sign = k % 2 ? 1 : -1;
    const double offset = sign * (box[k] - c[axis]);
    if (offset >= r)
      continue;
    double *plane = planes[count++];
    plane[0] = plane[1] = plane[2] = 0;
    plane[axis] = sign;
    plane[3] = offset;
  }
  return count;
}

double volume_ball_box(const double c[3], double r, const double box[6]) {
  if (r <= 0 || empty(box) || box_misses_ball(box, c, r))
    return 0;
  double planes[6][4];
  const size_t count = box_planes(c, r, box, planes);
  return volume_ball_planes(r, count, (const double(*)[4])planes);
}

/* Neumaier's compensated sum: total + lost. */
struct sum {
  double total, lost;
};

static void sum_add(struct sum *sum, double term) {
  const double total = sum->total + term;
  if (fabs(sum->total) >= fabs(term))
    sum->lost += (sum->total - total) + term;
  else
    sum->lost += (term - total) + sum->total;
  sum->total = total;
}

double volume_sum(size_t n, const double *x, const double *r,
                  const double box[6]) {
  struct sum sum = {0, 0};
  for (size_t i = 0; i < n; i++)
    sum_add(&sum, volume_ball_box(x + 3 * i, r[i], box));
  return sum.total + sum.lost;
}

/* Where a union is measured. */
struct place {
  const double *box;
  size_t planes;
  const double (*plane)[4];
};

/* Volume of ball i in its power cell and a place. planes: room for what that
   has and the most partners. */
static double cell_volume(const struct power *p, size_t i,
                          const struct place *in, double (*planes)[4]) {
  const double *c = p->x + 3 * i;
  size_t count = box_planes(c, p->r[i], in->box, planes);
  for (size_t k = 0; k < in->planes; k++) {
    const double offset = in->plane[k][3] - vec3_dot(in->plane[k], c);
    if (offset >= p->r[i])
      continue;
    memcpy(planes[count], in->plane[k], 3 * sizeof(double));
    planes[count++][3] = offset;
  }
  for (size_t q = p->start[i]; q < p->start[i + 1]; q++) {
    const enum power_leaves leaves =
        power_plane(p, i, p->partner[q], planes[count]);
    if (leaves == POWER_NONE)
      return 0;
    /* of a large ball's partners few cut it */
    count += leaves == POWER_HALF && planes[count][3] < p->r[i];
  }
  const double volume =
      volume_ball_planes(p->r[i], count, (const double(*)[4])planes);
  assert(!(volume > ball(p->r[i]) * (1 + 1e-9)));
  return volume;
}

static bool reaches(const double *c, double r, const void *box) {
  return r > 0 && !empty(box) && !box_misses_ball(box, c, r);
}

int volume_union(size_t n, const double *x, const double *r,
                 const double box[6], double *volume) {
  return volume_union_told(n, x, r, box, NULL, volume);
}

int volume_union_told(size_t n, const double *x, const double *r,
                      const double box[6], const struct observer *observer,
                      double *volume) {
  return volume_union_planes(n, x, r, box, 0, NULL, observer, volume);
}

int volume_union_planes(size_t n, const double *x, const double *r,
                        const double box[6], size_t count,
                        const double (*plane)[4],
                        const struct observer *observer, double *volume) {
  const struct place in = {box, count, plane};
  for (int k = 0; k < 6; k++)
    if (isnan(box[k]))
      return GSL_EINVAL;
  struct power *p;
  const int status = power_alloc(&p, 3, n, x, r, reaches, box);
  if (status != GSL_SUCCESS)
    return status;
  double(*planes)[4] = calloc(p->most + 6 + count, sizeof *planes);
  struct sum sum = {0, 0};
  for (size_t i = 0; i < p->n && planes; i++) {
    observer_tell(observer, i, p->n);
    sum_add(&sum, cell_volume(p, i, &in, planes));
  }
  if (planes) {
    /* a box that is full may come out as more than that by rounding */
    const double whole = fmax(0, box_volume(box)), all = sum.total + sum.lost;
    *volume = all > whole ? whole : all;
  }
  power_free(p);
  free(planes);
  return planes ? GSL_SUCCESS : GSL_ENOMEM;
}

static double midpoint(const double box[6], int axis, size_t count, size_t i) {
  const double step = (box[2 * axis + 1] - box[2 * axis]) / (double)count;
  return box[2 * axis] + ((double)i + 0.5) * step;
}

static size_t index_clamped(double index, size_t count) {
  if (!(index > 0)) /* NaN too */
    return 0;
  return index < (double)count ? (size_t)index : count;
}

/* Midpoints *first ... *end - 1 hold all within r of c along an axis. */
static void sample_range(double c, double r, const double box[6], int axis,
                         size_t count, size_t *first, size_t *end) {
  const double x0 = box[2 * axis];
  const double step = (box[2 * axis + 1] - x0) / (double)count;
  /* one more on either side, so that only the distance decides */
  *first = index_clamped(floor((c - r - x0) / step) - 1, count);
  *end = index_clamped(ceil((c + r - x0) / step) + 1, count);
}

/* Marks the midpoints in a ball; returns how many they are and adds to *fresh
   those that had no mark. */
static size_t mark(const double c[3], double r, const double box[6],
                   size_t count, unsigned char *marks, size_t *fresh) {
  size_t a[3], b[3], hits = 0;
  for (int k = 0; k < 3; k++)
    sample_range(c[k], r, box, k, count, &a[k], &b[k]);
  for (size_t k = a[2]; k < b[2]; k++) {
    const double z = midpoint(box, 2, count, k) - c[2];
    for (size_t j = a[1]; j < b[1]; j++) {
      const double y = midpoint(box, 1, count, j) - c[1];
      unsigned char *row = marks + (k * count + j) * count;
      for (size_t i = a[0]; i < b[0]; i++) {
        const double x = midpoint(box, 0, count, i) - c[0];
        if (x * x + y * y + z * z > r * r)
          continue;
        hits++;
        *fresh += !row[i];
        row[i] = 1;
      }
    }
  }
  return hits;
}

int volume_sampled(size_t n, const double *x, const double *r,
                   const double box[6], size_t count,
                   const struct observer *observer, double *sum,
                   double *united) {
  if (count == 0 || empty(box)) {
    *sum = *united = 0;
    return GSL_SUCCESS;
  }
  if (count > SIZE_MAX / count / count)
    return GSL_ENOMEM;
  unsigned char *marks = calloc(count * count, count);
  if (!marks)
    return GSL_ENOMEM;
  size_t hits = 0, fresh = 0;
  for (size_t i = 0; i < n; i++) {
    observer_tell(observer, i, n);
    if (r[i] >= 0)
      hits += mark(x + 3 * i, r[i], box, count, marks, &fresh);
  }
  free(marks);
  const double points = (double)count * (double)count * (double)count;
  const double whole = box_volume(box);
  *sum = (double)hits / points * whole;
  *united = (double)fresh / points * whole;
  return GSL_SUCCESS;
}
