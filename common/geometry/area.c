/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Discs. The argument of volume.c in the plane: seen from the centre O of the
   disc, what lies behind an edge of the polygon P, its shadow, is taken away or
   added whole,

     A = [O in P] pi r^2 - sum_i sign(h_i) shadow(edge i),

   and the edge from s0 to s1, measured along its line from the foot of O,
   leaves W(s1) - W(s0), where W(s) = (r^2 atan(s/h) - h s)/2 is the sector less
   the triangle.

   Shells. Seen along the axis, at the azimuth t from its own, sphere i covers
   of the line on the shell of radius R the heights |zeta| <= sqrt(q) over its
   centre. With the distance a of the centre from the axis,

     q = r^2 - a^2 - R^2 + 2 a R cos t = H^2 (1 - sin^2(t/2) / k^2),
     H^2 = r^2 - (a - R)^2,  k = H / (2 sqrt(a R)).

   Its power cell and the ends of the shell bound zeta by functions

     nz zeta <= A + C cos t + S sin t,

   and since a cell is convex one interval is left of each line. Between the
   azimuths where two of the bounds meet the same ones are in force, each with
   an antiderivative in closed form; for the sphere itself with Legendre's
   elliptic integrals,

     int_0^t sqrt(q) dt = 2 H E(t/2, 1/k)                               k > 1,
                        = 2 H (E(x, k) - (1 - k^2) F(x, k)) / k,
                          sin x = sin(t/2) / k                          k < 1.

   Two planes meet where a sine wave is zero, a plane and the sphere at a root
   of a quartic in tan(t/2). Where bounds meet they are equal, so the error of
   such an azimuth enters squared, and one too many costs time only. */
#include "geometry/area.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_sf_ellint.h>
#include "geometry/halfspace.h"
#include "geometry/neighbors.h"
#include "geometry/vec3.h"

/* W of the above; h > 0, s of either sign. */
static double beyond(double r, double h, double s) {
  return (r * r * atan2(s, h) - h * s) / 2;
}

/* Shadow beyond the edge that half-plane i gives the disc. */
static double edge_shadow(double r, size_t count, const double (*lines)[3],
                          size_t i) {
  const double h = halfspace_off_zero(lines[i][2], r);
  double s1 = sqrt((r - h) * (r + h)), s0 = -s1;
  for (size_t j = 0; j < count && s0 < s1; j++) {
    const double other = halfspace_off_zero(lines[j][2], r);
    if (j == i || other >= r)
      continue;
    double d[2], sign;
    const double w =
        halfspace_restricted(2, lines[i], h, lines[j], other, d, &sign);
    const double sine = lines[i][0] * d[1] - lines[i][1] * d[0];
    if (fabs(sine) < HALFSPACE_PARALLEL) {
      if (halfspace_hidden(h, other, sign, j < i))
        return 0;
    } else if (sine > 0)
      s1 = fmin(s1, w / sine);
    else
      s0 = fmax(s0, w / sine);
  }
  return s0 < s1 ? beyond(r, fabs(h), s1) - beyond(r, fabs(h), s0) : 0;
}

double area_disc_lines(double r, size_t count, const double (*lines)[3]) {
  if (r <= 0)
    return 0;
  for (size_t i = 0; i < count; i++) {
    if (lines[i][2] <= -r)
      return 0;
    if (isnan(lines[i][2]))
      return GSL_NAN;
  }
  double area = 0;
  bool centre_inside = true;
  for (size_t i = 0; i < count; i++) {
    if (lines[i][2] >= r)
      continue;
    const double shadow = edge_shadow(r, count, lines, i);
    area += lines[i][2] > 0 ? -shadow : shadow;
    centre_inside = centre_inside && lines[i][2] > 0;
  }
  if (centre_inside)
    area += M_PI * r * r;
  return area < 0 ? 0 : area; /* less than nothing is rounding */
}

static bool misses(const double c[2], double r, const double b[4]) {
  const double dx = fmax(0, fmax(b[0] - c[0], c[0] - b[1]));
  const double dy = fmax(0, fmax(b[2] - c[1], c[1] - b[3]));
  return !(r > 0) || dx * dx + dy * dy >= r * r;
}

static bool empty(const double b[4]) {
  return b[1] <= b[0] || b[3] <= b[2];
}

/* The sides of a rectangle that a disc reaches, seen from its centre; room for
   4. */
static size_t sides(const double c[2], double r, const double rectangle[4],
                    double (*lines)[3]) {
  size_t count = 0;
  for (int k = 0; k < 4; k++) {
    const int axis = k / 2, sign = k % 2 ? 1 : -1;
    const double offset = sign * (rectangle[k] - c[axis]);
    if (offset >= r)
      continue;
    double *line = lines[count++];
    line[0] = line[1] = 0;
    line[axis] = sign;
    line[2] = offset;
  }
  return count;
}

double area_sum(size_t n, const double *c, const double *r,
                const double rectangle[4]) {
  double sum = 0, lines[4][3];
  if (empty(rectangle))
    return 0;
  for (size_t i = 0; i < n; i++)
    if (!misses(c + 2 * i, r[i], rectangle)) {
      const size_t count = sides(c + 2 * i, r[i], rectangle, lines);
      sum += area_disc_lines(r[i], count, (const double(*)[3])lines);
    }
  return sum;
}

/* Room for n discs or spheres, their pairs and what one of them has to do with
   its partners. */
struct work {
  size_t n;
  double *x, *r; /* rows of three */
  struct neighbors nb;
  size_t *start;
  uint32_t *partner;
  size_t most; /* partners */
};

static void work_free(struct work *w) {
  neighbors_free(&w->nb);
  free(w->x);
  free(w->r);
  free(w->start);
  free(w->partner);
}

static int work_alloc(struct work *w, size_t room) {
  *w = (struct work){.x = calloc(room + 1, 3 * sizeof *w->x),
                     .r = calloc(room + 1, sizeof *w->r)};
  return w->x && w->r ? GSL_SUCCESS : GSL_ENOMEM;
}

static int work_pairs(struct work *w) {
  const int status = neighbors_find(&w->nb, w->n, w->x, 3, w->r, 0);
  if (status != GSL_SUCCESS)
    return status;
  w->start = calloc(w->n + 2, sizeof *w->start);
  w->partner = calloc(w->nb.count + 1, 2 * sizeof *w->partner);
  if (!w->start || !w->partner)
    return GSL_ENOMEM;
  w->most = neighbors_partners(&w->nb, w->n, w->start, w->partner);
  return GSL_SUCCESS;
}

/* Does j hide concentric i? Of equals the first stays. */
static bool within(const struct work *w, size_t i, size_t j) {
  return w->r[j] > w->r[i] || (w->r[j] == w->r[i] && j < i);
}

/* What disc i has of its power cell and the rectangle. lines: room for 4 more
   than the most partners. */
static double disc_cell(const struct work *w, size_t i,
                        const double rectangle[4], double (*lines)[3]) {
  const double *c = w->x + 3 * i;
  size_t count = sides(c, w->r[i], rectangle, lines);
  for (size_t p = w->start[i]; p < w->start[i + 1]; p++) {
    const size_t j = w->partner[p];
    const double dx = w->x[3 * j] - c[0], dy = w->x[3 * j + 1] - c[1];
    const double distance = hypot(dx, dy), ri = w->r[i], rj = w->r[j];
    if (distance > 1e-20 * (ri + rj)) {
      double *line = lines[count++];
      line[0] = dx / distance;
      line[1] = dy / distance;
      line[2] = (distance + (ri - rj) * (ri + rj) / distance) / 2;
    } else if (within(w, i, j))
      return 0;
  }
  return area_disc_lines(w->r[i], count, (const double(*)[3])lines);
}

int area_union(size_t n, const double *c, const double *r,
               const double rectangle[4], double *area) {
  for (int k = 0; k < 4; k++)
    if (isnan(rectangle[k]))
      return GSL_EINVAL;
  size_t near = 0;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(c[2 * i]) || !isfinite(c[2 * i + 1]) || !isfinite(r[i]))
      return GSL_EINVAL;
    near += !misses(c + 2 * i, r[i], rectangle);
  }
  if (near == 0 || empty(rectangle)) {
    *area = 0;
    return GSL_SUCCESS;
  }
  struct work w;
  double(*lines)[3] = NULL;
  int status = work_alloc(&w, near);
  if (status != GSL_SUCCESS)
    goto done;
  for (size_t i = 0; i < n; i++)
    if (!misses(c + 2 * i, r[i], rectangle)) {
      w.x[3 * w.n] = c[2 * i];
      w.x[3 * w.n + 1] = c[2 * i + 1];
      w.r[w.n++] = r[i];
    }
  status = work_pairs(&w);
  if (status != GSL_SUCCESS)
    goto done;
  lines = calloc(w.most + 4, sizeof *lines);
  if (!lines) {
    status = GSL_ENOMEM;
    goto done;
  }
  *area = 0;
  for (size_t i = 0; i < w.n; i++)
    *area += disc_cell(&w, i, rectangle, lines);
done:
  free(lines);
  work_free(&w);
  return status;
}

/* Shells */

/* Of a line at the azimuth t: nz zeta <= a + c cos t + s sin t. */
struct bound {
  double nz, a, c, s;
};

/* A sphere as the shell has it: a, R, H and k of the above, and the azimuth
   where it ends, pi if nowhere. */
struct patch {
  double a, shell, height, k, end;
};

/* False if the sphere leaves nothing on the shell. */
static bool patch_of(struct patch *p, const double *x, double r,
                     const struct area_shell *s) {
  p->a = hypot(x[0] - s->axis[0], x[1] - s->axis[1]);
  p->shell = s->radius;
  const double d = p->a - s->radius;
  if (!(r > fabs(d)))
    return false;
  p->height = sqrt((r - d) * (r + d));
  /* finite even on the axis */
  p->k = fmin(1e100, p->height / (2 * sqrt(p->a * s->radius)));
  p->end = p->k >= 1 ? M_PI : 2 * asin(p->k);
  return x[2] + p->height > s->z[0] && x[2] - p->height < s->z[1];
}

/* sqrt(q) of the above. */
static double patch_height(const struct patch *p, double t) {
  const double s = sin(t / 2) / p->k;
  return p->height * sqrt(fmax(0, (1 - s) * (1 + s)));
}

/* Its integral from 0. */
static double patch_integral(const struct patch *p, double t) {
  const double k = p->k, s = sin(t / 2);
  if (k == 1) /* GSL has no modulus of 1 */
    return 2 * p->height * s;
  if (k > 1)
    return 2 * p->height * gsl_sf_ellint_E(t / 2, 1 / k, GSL_PREC_DOUBLE);
  const double x = asin(fmax(-1, fmin(1, s / k)));
  return 2 * p->height *
         (gsl_sf_ellint_E(x, k, GSL_PREC_DOUBLE) -
          (1 - k) * (1 + k) * gsl_sf_ellint_F(x, k, GSL_PREC_DOUBLE)) /
         k;
}

/* Integral over [from, to] of the bound in force; NULL: of sqrt(q), of the
   sign. Differences of sines as products, since nz may be tiny. */
static double bound_integral(const struct patch *p, const struct bound *b,
                             double sign, double from, double to) {
  if (!b)
    return sign * (patch_integral(p, to) - patch_integral(p, from));
  const double middle = (from + to) / 2, chord = 2 * sin((to - from) / 2);
  return (b->a * (to - from) +
          chord * (b->c * cos(middle) + b->s * sin(middle))) /
         b->nz;
}

/* Room for what one sphere needs: bounds, and azimuths where they meet. */
struct shell_work {
  struct bound *bounds;
  double *meet;
  gsl_poly_complex_workspace *quartic;
};

/* Keeps an azimuth if it is on the sphere. */
static size_t meet_add(const struct patch *p, double *meet, size_t count,
                       double t) {
  t = remainder(t, 2 * M_PI);
  if (fabs(t) < p->end)
    meet[count++] = t;
  return count;
}

/* Where a + c cos t + s sin t = 0. */
static size_t meet_wave(const struct patch *p, double *meet, size_t count,
                        double a, double c, double s) {
  const double size = hypot(c, s);
  if (!(fabs(a) <= size) || size == 0)
    return count;
  const double top = atan2(s, c), half = acos(-a / size);
  count = meet_add(p, meet, count, top - half);
  return meet_add(p, meet, count, top + half);
}

/* Where a bound meets the sphere: nz^2 q = (a + c cos t + s sin t)^2. */
static size_t meet_sphere(const struct patch *p, const struct shell_work *w,
                          size_t count, const struct bound *b) {
  const double near = b->a + b->c, far = b->a - b->c; /* at t = 0 and pi */
  const double n2 = b->nz * b->nz, q = p->height * p->height;
  const double q_far = q - 4 * p->a * p->shell;
  double f[5] = {n2 * q - near * near, -4 * b->s * near,
                 n2 * (q + q_far) - 2 * near * far - 4 * b->s * b->s,
                 -4 * b->s * far, n2 * q_far - far * far};
  double z[8], size = 0;
  if (b->nz == 0)
    return meet_wave(p, w->meet, count, b->a, b->c, b->s);
  for (int k = 0; k < 5; k++)
    size += fabs(f[k]);
  if (f[4] == 0) /* a root at pi; the solver wants four finite ones */
    f[4] = 1e-30 * size;
  if (gsl_poly_complex_solve(f, 5, w->quartic, z) != GSL_SUCCESS)
    return count;
  for (int k = 0; k < 4; k++)
    count = meet_add(p, w->meet, count, 2 * atan(z[2 * k]));
  return count;
}

static int compare_doubles(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Area of the sphere's patch inside all bounds. */
static double patch_area(const struct patch *p, const struct shell_work *w,
                         size_t bounds) {
  const struct bound *b = w->bounds;
  size_t count = 0;
  w->meet[count++] = -p->end;
  w->meet[count++] = p->end;
  for (size_t i = 0; i < bounds; i++) {
    count = meet_sphere(p, w, count, &b[i]);
    for (size_t j = 0; j < i; j++)
      count = meet_wave(p, w->meet, count, b[i].a * b[j].nz - b[j].a * b[i].nz,
                        b[i].c * b[j].nz - b[j].c * b[i].nz,
                        b[i].s * b[j].nz - b[j].s * b[i].nz);
  }
  qsort(w->meet, count, sizeof *w->meet, compare_doubles);
  double area = 0;
  for (size_t m = 1; m < count; m++) {
    const double from = w->meet[m - 1], to = w->meet[m], t = (from + to) / 2;
    const double cosine = cos(t), sine = sin(t);
    double high = patch_height(p, t), low = -high;
    const struct bound *above = NULL, *below = NULL;
    for (size_t i = 0; i < bounds; i++) {
      const double most = b[i].a + b[i].c * cosine + b[i].s * sine;
      if (b[i].nz > 0 && most / b[i].nz < high) {
        high = most / b[i].nz;
        above = &b[i];
      } else if (b[i].nz < 0 && most / b[i].nz > low) {
        low = most / b[i].nz;
        below = &b[i];
      } else if (b[i].nz == 0 && most < 0)
        low = high;
    }
    if (low < high && from < to)
      area += bound_integral(p, above, 1, from, to) -
              bound_integral(p, below, -1, from, to);
  }
  return area > 0 ? area * p->shell : 0;
}

/* Adds what sphere i has of the shell to *sum, and to *united what of that is
   in its power cell. */
static void add_patch(const struct work *w, size_t i,
                      const struct area_shell *shell,
                      const struct shell_work *room, double *sum,
                      double *united) {
  const double *xi = w->x + 3 * i, ri = w->r[i];
  struct patch p;
  if (!patch_of(&p, xi, ri, shell))
    return;
  const double cx = xi[0] - shell->axis[0], cy = xi[1] - shell->axis[1];
  const double ux = p.a > 0 ? cx / p.a : 1, uy = p.a > 0 ? cy / p.a : 0;
  size_t count = 0;
  if (shell->z[1] - xi[2] < p.height)
    room->bounds[count++] = (struct bound){1, shell->z[1] - xi[2], 0, 0};
  if (xi[2] - shell->z[0] < p.height)
    room->bounds[count++] = (struct bound){-1, xi[2] - shell->z[0], 0, 0};
  const size_t ends = count;
  bool hidden = false;
  for (size_t q = w->start[i]; q < w->start[i + 1]; q++) {
    const size_t j = w->partner[q];
    const double rj = w->r[j];
    double d[3];
    vec3_sub(w->x + 3 * j, xi, d);
    const double distance = vec3_norm(d);
    if (distance <= 1e-20 * (ri + rj)) {
      hidden = hidden || within(w, i, j);
      continue;
    }
    const double h = (distance + (ri - rj) * (ri + rj) / distance) / 2;
    const double n1 = (d[0] * ux + d[1] * uy) / distance;
    const double n2 = (d[1] * ux - d[0] * uy) / distance;
    room->bounds[count++] = (struct bound){d[2] / distance, h + n1 * p.a,
                                           -n1 * p.shell, -n2 * p.shell};
  }
  const double alone = patch_area(&p, room, ends);
  *sum += alone;
  if (!hidden)
    *united += count > ends ? patch_area(&p, room, count) : alone;
}

int area_shell_covered(size_t n, const double *x, const double *r,
                       const struct area_shell *shell, double *sum,
                       double *united) {
  if (!(shell->radius > 0) || !isfinite(shell->radius) ||
      !isfinite(shell->axis[0]) || !isfinite(shell->axis[1]) ||
      isnan(shell->z[0]) || isnan(shell->z[1]))
    return GSL_EINVAL;
  struct patch p;
  size_t near = 0;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(x[3 * i]) || !isfinite(x[3 * i + 1]) ||
        !isfinite(x[3 * i + 2]) || !isfinite(r[i]))
      return GSL_EINVAL;
    near += patch_of(&p, x + 3 * i, r[i], shell);
  }
  struct work w;
  struct shell_work room = {0};
  int status = work_alloc(&w, near);
  if (status != GSL_SUCCESS)
    goto done;
  for (size_t i = 0; i < n; i++)
    if (patch_of(&p, x + 3 * i, r[i], shell)) {
      memcpy(w.x + 3 * w.n, x + 3 * i, 3 * sizeof *x);
      w.r[w.n++] = r[i];
    }
  status = work_pairs(&w);
  if (status != GSL_SUCCESS)
    goto done;
  const size_t most = w.most + 2;
  room.bounds = calloc(most, sizeof *room.bounds);
  room.meet = calloc(most * (most + 3) + 2, sizeof *room.meet);
  room.quartic = gsl_poly_complex_workspace_alloc(5);
  if (!room.bounds || !room.meet || !room.quartic) {
    status = GSL_ENOMEM;
    goto done;
  }
  *sum = *united = 0;
  for (size_t i = 0; i < w.n; i++)
    add_patch(&w, i, shell, &room, sum, united);
done:
  if (room.quartic)
    gsl_poly_complex_workspace_free(room.quartic);
  free(room.meet);
  free(room.bounds);
  work_free(&w);
  return status;
}
