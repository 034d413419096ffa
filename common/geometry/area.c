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
                        = 2 H k (F(x, k) - D(x, k)),
                          sin x = sin(t/2) / k                          k < 1,

   where F - D, by Carlson's R_F and R_D, is what E - (1 - k^2) F loses the
   digits of when k is small. Two planes meet where a sine wave is zero, a plane
   and the sphere at a root of a quartic in tan(t/2).

   Those azimuths only say where to look. A plane that touches the shell, or all
   but holds the axis, makes roots that coincide or coefficients that are mere
   rounding; so the bounds in force are looked up there and half-way between,
   and where they differ the way is halved until each change is found. Bounds
   are equal where they change, so an error of that azimuth enters squared, and
   a look too many costs time only.

   Rounding. Of a sphere small beside the shell, a - R, and of a bound its value
   at t = 0, A + C, have the digits; both come from differences that are exact
   or nearly so, and the rest goes with 1 - cos t = 2 sin^2(t/2). */
#include "geometry/area.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_sf_ellint.h>
#include "geometry/halfspace.h"
#include "geometry/power.h"

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

/* Area of disc i in its power cell and the rectangle. lines: room for 4 more
   than the most partners. */
static double disc_cell(const struct power *p, size_t i,
                        const double rectangle[4], double (*lines)[3]) {
  size_t count = sides(p->x + 3 * i, p->r[i], rectangle, lines);
  for (size_t q = p->start[i]; q < p->start[i + 1]; q++) {
    double plane[4];
    const enum power_leaves leaves = power_plane(p, i, p->partner[q], plane);
    if (leaves == POWER_NONE)
      return 0;
    if (leaves == POWER_ALL || plane[3] >= p->r[i])
      continue;
    double *line = lines[count++];
    line[0] = plane[0];
    line[1] = plane[1];
    line[2] = plane[3];
  }
  const double area =
      area_disc_lines(p->r[i], count, (const double(*)[3])lines);
  assert(!(area > M_PI * p->r[i] * p->r[i] * (1 + 1e-9)));
  return area;
}

static bool disc_reaches(const double *c, double r, const void *rectangle) {
  return !empty(rectangle) && !misses(c, r, rectangle);
}

int area_union(size_t n, const double *c, const double *r,
               const double rectangle[4], double *area) {
  for (int k = 0; k < 4; k++)
    if (isnan(rectangle[k]))
      return GSL_EINVAL;
  struct power *p;
  const int status = power_alloc(&p, 2, n, c, r, disc_reaches, rectangle);
  if (status != GSL_SUCCESS)
    return status;
  double(*lines)[3] = calloc(p->most + 4, sizeof *lines);
  double sum = 0;
  for (size_t i = 0; i < p->n && lines; i++)
    sum += disc_cell(p, i, rectangle, lines);
  const double whole =
      fmax(0, rectangle[1] - rectangle[0]) * (rectangle[3] - rectangle[2]);
  if (lines) /* a full one may come out as more than that by rounding */
    *area = sum > whole ? fmax(0, whole) : sum;
  power_free(p);
  free(lines);
  return lines ? GSL_SUCCESS : GSL_ENOMEM;
}

/* Shells */

/* Of a line at the azimuth t: nz zeta <= near + c (cos t - 1) + s sin t. */
struct bound {
  double nz, near, c, s;
};

/* A sphere as the shell has it: a, R, a - R, H and k of the above, and the
   azimuth where it ends, pi if nowhere. ux, uy: the way to it from the axis. */
struct patch {
  double a, shell, beyond, height, k, end, ux, uy;
};

/* The rounding error of x - y. */
static double lost(double x, double y) {
  const double d = x - y, part = x - d;
  return (x - (d + part)) + (part - y);
}

/* How much sqrt(x^2 + y^2) is more than a, which is its rounded value; lost_x
   and lost_y belong to x and y. */
static double hypot_rest(double x, double y, double lost_x, double lost_y,
                         double a) {
  const double most = fmax(fabs(x), fabs(y)), least = fmin(fabs(x), fabs(y));
  const double most2 = most * most, least2 = least * least, a2 = a * a;
  const double rest = ((most2 - a2) + least2) + fma(most, most, -most2) +
                      fma(least, least, -least2) - fma(a, a, -a2);
  return a > 0 ? (rest / 2 + x * lost_x + y * lost_y) / a : 0;
}

/* False if the sphere leaves nothing on the shell. A sphere much smaller than
   the shell has all its digits in a - R, which must not come from a rounded. */
static bool patch_of(struct patch *p, const double *x, double r,
                     const struct area_shell *s) {
  const double dx = x[0] - s->axis[0], dy = x[1] - s->axis[1];
  p->a = hypot(dx, dy);
  p->shell = s->radius;
  p->beyond = (p->a - s->radius) + hypot_rest(dx, dy, lost(x[0], s->axis[0]),
                                              lost(x[1], s->axis[1]), p->a);
  if (!(r > fabs(p->beyond)))
    return false;
  p->ux = p->a > 0 ? dx / p->a : 1;
  p->uy = p->a > 0 ? dy / p->a : 0;
  p->height = sqrt((r - p->beyond) * (r + p->beyond));
  /* finite even on the axis */
  p->k = fmin(1e100, p->height / (2 * sqrt(p->a * s->radius)));
  p->end = p->k >= 1 ? M_PI : 2 * asin(p->k);
  return x[2] + p->height > s->z[0] && x[2] - p->height < s->z[1] && p->end > 0;
}

static bool patch_reaches(const double *x, double r, const void *shell) {
  struct patch p;
  return patch_of(&p, x, r, shell);
}

/* sqrt(q) of the above; half: sin(t/2). */
static double patch_height(const struct patch *p, double half) {
  const double s = half / p->k;
  return p->height * sqrt(fmax(0, (1 - s) * (1 + s)));
}

/* Its integral from 0. */
static double patch_integral(const struct patch *p, double t) {
  const double k = p->k, half = sin(t / 2);
  if (k == 1) /* F and D have no end */
    return 2 * p->height * half;
  if (k > 1)
    return 2 * p->height * gsl_sf_ellint_E(t / 2, 1 / k, GSL_PREC_DOUBLE);
  const double s = fmax(-1, fmin(1, half / k)), c2 = (1 - s) * (1 + s);
  const double d2 = (1 - half) * (1 + half);
  return 2 * p->height * k * s *
         (gsl_sf_ellint_RF(c2, d2, 1, GSL_PREC_DOUBLE) -
          s * s / 3 * gsl_sf_ellint_RD(c2, d2, 1, GSL_PREC_DOUBLE));
}

/* sin x - x, to its own digits. */
static double sine_less(double x) {
  if (fabs(x) > 1)
    return sin(x) - x;
  double term = x, sum = 0;
  for (int k = 2; k < 20; k += 2) {
    term *= -x * x / (k * (k + 1));
    sum += term;
  }
  return sum;
}

/* Integral over [from, to] of the bound in force; NULL: of sqrt(q), of the
   sign. Differences of sines as products, since nz may be tiny. */
static double bound_integral(const struct patch *p, const struct bound *b,
                             double sign, double from, double to) {
  if (!b)
    return sign * (patch_integral(p, to) - patch_integral(p, from));
  const double middle = (from + to) / 2, half = (to - from) / 2;
  const double chord = 2 * sin(half), sine = sin(middle / 2);
  return (b->near * 2 * half +
          b->c * (2 * sine_less(half) - 2 * chord * sine * sine) +
          b->s * chord * sin(middle)) /
         b->nz;
}

/* Room for what one sphere needs: bounds, and azimuths where they may meet. */
struct shell_work {
  size_t bounds;
  struct bound *bound;
  size_t meets, room;
  double *meet;
  gsl_poly_complex_workspace *solver[5]; /* by degree, 2 to 4 */
};

/* Keeps an azimuth if it is on the sphere. */
static void meet_add(const struct patch *p, struct shell_work *w, double t) {
  t = remainder(t, 2 * M_PI);
  assert(w->meets < w->room);
  if (fabs(t) < p->end)
    w->meet[w->meets++] = t;
}

/* Where near + c (cos t - 1) + s sin t = 0; with w = tan(t/2) that is
   near + 2 s w + (near - 2 c) w^2 = 0. */
static void meet_wave(const struct patch *p, struct shell_work *w, double near,
                      double c, double s) {
  const double far = near - 2 * c, square = s * s - near * far;
  if (!(square >= 0))
    return;
  const double q = -(s + copysign(sqrt(square), s));
  meet_add(p, w, 2 * atan2(q, far));
  meet_add(p, w, 2 * atan2(near, q));
}

/* Where a bound may meet the sphere: nz^2 q = (...)^2, a quartic in tan(t/2),
   in units of the sphere's own end. A leading coefficient that is no more than
   rounding would spoil all roots, and its own is far beyond the end or at pi,
   which is an end. Steep bounds come and go about their zeros and extremes. */
static int meet_sphere(const struct patch *p, struct shell_work *w,
                       const struct bound *b) {
  static const double noise = 1e-14;
  const double unit = p->end < M_PI_2 ? tan(p->end / 2) : 1;
  const double n2 = b->nz * b->nz, u2 = unit * unit;
  const double q0 = p->height * p->height;
  const double q2 = (q0 - 4 * p->a * p->shell) * u2;
  const double b0 = b->near, b1 = 2 * b->s * unit;
  const double b2 = (b->near - 2 * b->c) * u2;
  const double f[5] = {n2 * q0 - b0 * b0, -2 * b0 * b1,
                       n2 * (q0 * u2 + q2) - b1 * b1 - 2 * b0 * b2,
                       -2 * b1 * b2, n2 * q2 * u2 - b2 * b2};
  double size = 0, z[8];
  meet_wave(p, w, b->near, b->c, b->s);
  meet_add(p, w, atan2(b->s, b->c));
  meet_add(p, w, atan2(-b->s, -b->c));
  if (b->nz == 0)
    return GSL_SUCCESS;
  for (int k = 0; k < 5; k++)
    size += fabs(f[k]);
  size_t degree = 4;
  while (degree > 0 && !(fabs(f[degree]) > noise * size))
    degree--;
  if (degree == 1)
    meet_add(p, w, 2 * atan(-f[0] / f[1] * unit));
  if (degree < 2)
    return GSL_SUCCESS;
  if (gsl_poly_complex_solve(f, degree + 1, w->solver[degree], z) !=
      GSL_SUCCESS)
    return GSL_EFAILED;
  for (size_t k = 0; k < degree; k++)
    meet_add(p, w, 2 * atan(z[2 * k] * unit));
  return GSL_SUCCESS;
}

/* The bounds that a line of the sphere ends at, NULL for the sphere itself. */
struct force {
  bool nothing; /* is left of the line */
  const struct bound *above, *below;
};

static bool same(const struct force *f, const struct force *g) {
  return f->nothing == g->nothing && f->above == g->above &&
         f->below == g->below;
}

static struct force in_force(const struct patch *p, const struct shell_work *w,
                             double t) {
  static const struct force nothing = {.nothing = true};
  const double half = sin(t / 2), sine = sin(t);
  double high = patch_height(p, half), low = -high;
  struct force f = {0};
  for (size_t i = 0; i < w->bounds; i++) {
    const struct bound *b = &w->bound[i];
    const double most = b->near - 2 * b->c * half * half + b->s * sine;
    if (b->nz > 0 && most < high * b->nz) {
      high = most / b->nz;
      f.above = b;
    } else if (b->nz < 0 && most < low * b->nz) {
      low = most / b->nz;
      f.below = b;
    } else if (b->nz == 0 && most < 0)
      return nothing;
    if (!(low < high))
      return nothing;
  }
  return low < high ? f : nothing;
}

/* A way over the sphere's azimuths: since `from` the same bounds are in force.
   The stretch between is added up when others come. */
struct sweep {
  const struct patch *p;
  const struct shell_work *w;
  double from, area;
  struct force force;
};

static void turn_to(struct sweep *s, double t, const struct force *force) {
  const struct force *f = &s->force;
  const double width = t - s->from;
  if (!f->nothing && width > 0) {
    const double part = bound_integral(s->p, f->above, 1, s->from, t) -
                        bound_integral(s->p, f->below, -1, s->from, t);
    /* a steep bound that is in force at less than a rounding error's width
       may come out as anything */
    s->area += fmax(0, fmin(part, 2 * s->p->height * width));
  }
  s->from = t;
  s->force = *force;
}

/* Goes on from a to b, at which `at_a` and `at_b` are in force, and halves the
   way until every change in between is found. */
static void sweep_on(struct sweep *s, double a, const struct force *at_a,
                     double b, const struct force *at_b) {
  if (same(at_a, at_b))
    return;
  const double middle = a + (b - a) / 2;
  if (b - a < GSL_DBL_EPSILON / 4 * s->p->end || middle <= a || middle >= b) {
    turn_to(s, middle, at_b);
    return;
  }
  const struct force at_middle = in_force(s->p, s->w, middle);
  sweep_on(s, a, at_a, middle, &at_middle);
  sweep_on(s, middle, &at_middle, b, at_b);
}

static int compare_doubles(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Room for the meetings of the bounds: with the sphere 8 each, among
   themselves, and the ends. */
static int reserve_meets(struct shell_work *w) {
  const size_t want = w->bounds * (w->bounds + 7) + 2;
  w->meets = 0;
  if (want <= w->room)
    return GSL_SUCCESS;
  double *meet =
      w->bounds > UINT32_MAX ? NULL : realloc(w->meet, want * sizeof *w->meet);
  if (!meet)
    return GSL_ENOMEM;
  w->meet = meet;
  w->room = want;
  return GSL_SUCCESS;
}

/* Area of the sphere's patch inside all bounds. */
static int patch_area(const struct patch *p, struct shell_work *w,
                      double *area) {
  int status = reserve_meets(w);
  for (size_t i = 0; i < w->bounds && status == GSL_SUCCESS; i++) {
    const struct bound *b = &w->bound[i];
    status = meet_sphere(p, w, b);
    for (const struct bound *o = w->bound; o < b; o++)
      meet_wave(p, w, b->near * o->nz - o->near * b->nz,
                b->c * o->nz - o->c * b->nz, b->s * o->nz - o->s * b->nz);
  }
  if (status != GSL_SUCCESS)
    return status;
  qsort(w->meet, w->meets, sizeof *w->meet, compare_doubles);
  /* looked at: where bounds may meet, and half-way between */
  struct sweep s = {.p = p, .w = w, .from = -p->end};
  double at = -p->end;
  struct force force = {0};
  for (size_t m = 0; m <= w->meets; m++) {
    const double next = m < w->meets ? w->meet[m] : p->end;
    const double middle = at + (next - at) / 2;
    const struct force at_middle = in_force(p, w, middle);
    if (m == 0)
      s.force = at_middle;
    else
      sweep_on(&s, at, &force, middle, &at_middle);
    if (m == w->meets)
      break;
    force = in_force(p, w, next);
    sweep_on(&s, middle, &at_middle, next, &force);
    at = next;
  }
  turn_to(&s, p->end, &s.force);
  *area = s.area * p->shell;
  return GSL_SUCCESS;
}

/* The ends of the shell that cut the patch, seen from its centre. */
static void bound_ends(struct shell_work *w, const struct patch *p, double z,
                       const struct area_shell *shell) {
  const double up = shell->z[1] - z, down = z - shell->z[0];
  w->bounds = 0;
  if (up < p->height)
    w->bound[w->bounds++] = (struct bound){.nz = 1, .near = up};
  if (down < p->height)
    w->bound[w->bounds++] = (struct bound){.nz = -1, .near = down};
}

/* The planes between sphere i and its partners that cut it. False if nothing
   of it is left. */
static bool bound_partners(struct shell_work *w, const struct patch *p,
                           const struct power *cells, size_t i) {
  for (size_t q = cells->start[i]; q < cells->start[i + 1]; q++) {
    double n[4];
    const enum power_leaves leaves =
        power_plane(cells, i, cells->partner[q], n);
    if (leaves == POWER_NONE || (leaves == POWER_HALF && n[3] <= -cells->r[i]))
      return false;
    if (leaves == POWER_ALL || n[3] >= cells->r[i])
      continue;
    const double n1 = n[0] * p->ux + n[1] * p->uy;
    const double n2 = n[1] * p->ux - n[0] * p->uy;
    w->bound[w->bounds++] = (struct bound){n[2], n[3] + n1 * p->beyond,
                                           -n1 * p->shell, -n2 * p->shell};
  }
  return true;
}

/* Areas so far: of the spheres by themselves, of what they have in their power
   cells; and rounding: more than what the two may be wrong by. */
struct covered {
  double sum, united, rounding;
};

/* Adds what sphere i has of the shell. */
static int add_patch(const struct power *cells, size_t i,
                     const struct area_shell *shell, struct shell_work *w,
                     struct covered *all) {
  struct patch p;
  const bool reaches = patch_of(&p, cells->x + 3 * i, cells->r[i], shell);
  assert(reaches);
  (void)reaches;
  double alone, own = 0;
  bound_ends(w, &p, cells->x[3 * i + 2], shell);
  int status = patch_area(&p, w, &alone);
  if (status == GSL_SUCCESS && bound_partners(w, &p, cells, i))
    status = patch_area(&p, w, &own);
  if (status != GSL_SUCCESS)
    return status;
  const double mantle = 2 * M_PI * shell->radius * (shell->z[1] - shell->z[0]);
  /* of terms of its own size, however little is left of them */
  const double rounding = 1e-9 * p.height * p.end * p.shell;
  assert(!(alone > mantle + rounding) && !(own > alone + rounding));
  alone = fmin(alone, mantle);
  all->sum += alone;
  all->united += fmin(own, alone);
  all->rounding += rounding;
  return GSL_SUCCESS;
}

static void shell_work_free(struct shell_work *w) {
  if (!w)
    return;
  for (size_t degree = 2; degree <= 4; degree++)
    if (w->solver[degree])
      gsl_poly_complex_workspace_free(w->solver[degree]);
  free(w->meet);
  free(w->bound);
  free(w);
}

static int shell_work_alloc(struct shell_work **out, size_t most) {
  struct shell_work *w = calloc(1, sizeof *w);
  bool room = w != NULL;
  if (w)
    w->bound = calloc(most + 2, sizeof *w->bound);
  for (size_t degree = 2; w && degree <= 4; degree++) {
    w->solver[degree] = gsl_poly_complex_workspace_alloc(degree + 1);
    room = room && w->solver[degree];
  }
  if (!room || !w->bound) {
    shell_work_free(w);
    return GSL_ENOMEM;
  }
  *out = w;
  return GSL_SUCCESS;
}

int area_shell_covered(size_t n, const double *x, const double *r,
                       const struct area_shell *shell, double *sum,
                       double *united) {
  if (!(shell->radius > 0) || !isfinite(shell->radius) ||
      !isfinite(shell->axis[0]) || !isfinite(shell->axis[1]) ||
      isnan(shell->z[0]) || isnan(shell->z[1]))
    return GSL_EINVAL;
  struct power *cells;
  struct shell_work *w = NULL;
  int status = power_alloc(&cells, 3, n, x, r, patch_reaches, shell);
  if (status != GSL_SUCCESS)
    return status;
  struct covered all = {0, 0, 0};
  status = shell_work_alloc(&w, cells->most);
  for (size_t i = 0; i < cells->n && status == GSL_SUCCESS; i++)
    status = add_patch(cells, i, shell, w, &all);
  if (status == GSL_SUCCESS) {
    const double mantle =
        2 * M_PI * shell->radius * (shell->z[1] - shell->z[0]);
    assert(!(all.united > mantle + all.rounding));
    *sum = all.sum;
    *united = all.united < mantle ? all.united : mantle;
  }
  shell_work_free(w);
  power_free(cells);
  return status;
}
