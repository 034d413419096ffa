/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The volume that a bridge adds. Along a line at the distance rho from the
   axis, the collar between spheres i and j at the distance d ends at both
   surfaces; it is d - s_i - s_j long there, s = sqrt(r^2 - rho^2). That grows
   with rho, from 0 at rho_0, the radius of the circle in which the spheres
   meet, or from the gap at rho_0 = 0 if they do not. So

     V = int_rho_0^X 2 pi rho (d - s_i - s_j) d rho,

   elementary. Where a collar also meets a third sphere, another collar or a
   face of the box, the length left of each line is still exact, a difference of
   intervals, but depends on the azimuth as well, and Gauss and Kronrod's rule
   adapts to its kinks. Of several collars the first counts. */
#include "geometry/solid.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "geometry/neighbors.h"
#include "geometry/volume.h"

/* A bridge, and the collar that it adds. */
struct collar {
  const double *a, *b; /* centres of its spheres */
  double axis[3];      /* unit vector from a to b */
  double d, ra, rb;    /* distance, radii */
  double inner, outer; /* radii of the collar; inner >= outer: there is none */
  double ball[3], reach; /* what holds it */
};

static int collar_of(const struct solid *s, size_t k, struct collar *c) {
  const size_t i = s->ends[k][0], j = s->ends[k][1];
  c->a = s->x + 3 * i;
  c->b = s->x + 3 * j;
  c->ra = s->r[i];
  c->rb = s->r[j];
  c->outer = c->inner = s->bridge_radius;
  if (!(c->outer > 0) || !(c->outer < c->ra) || !(c->outer < c->rb))
    return GSL_EDOM;
  vec3_sub(c->b, c->a, c->axis);
  c->d = vec3_norm(c->axis);
  const double x2 = c->outer * c->outer;
  const double sa = sqrt(c->ra * c->ra - x2), sb = sqrt(c->rb * c->rb - x2);
  c->reach = 0;
  memcpy(c->ball, c->a, sizeof c->ball);
  if (!(sa + sb < c->d))
    return GSL_SUCCESS;
  for (int m = 0; m < 3; m++)
    c->axis[m] /= c->d;
  c->inner = 0;
  if (c->d < c->ra + c->rb) {
    const double foot = (c->d + (c->ra - c->rb) * (c->ra + c->rb) / c->d) / 2;
    c->inner = sqrt(fmax(0, (c->ra - foot) * (c->ra + foot)));
  }
  vec3_axpy((sa + c->d - sb) / 2, c->axis, c->ball);
  c->reach = hypot(c->outer, (c->d - sa - sb) / 2);
  return GSL_SUCCESS;
}

/* int rho sqrt(r^2 - rho^2) d rho, without a difference of cubes. */
static double hidden(double r, double inner, double outer) {
  const double p = sqrt((r - inner) * (r + inner));
  const double q = sqrt((r - outer) * (r + outer));
  return (outer - inner) * (outer + inner) * (p * p + p * q + q * q) /
         (3 * (p + q));
}

static double whole_collar(const struct collar *c) {
  if (!(c->inner < c->outer))
    return 0;
  const double area = (c->outer - c->inner) * (c->outer + c->inner) / 2;
  return fmax(0, 2 * M_PI *
                     (c->d * area - hidden(c->ra, c->inner, c->outer) -
                      hidden(c->rb, c->inner, c->outer)));
}

static int compare_intervals(const void *a, const void *b) {
  const double *p = a, *q = b;
  return (p[0] > q[0]) - (p[0] < q[0]);
}

double solid_covered(size_t count, double (*interval)[2], double low,
                     double high) {
  qsort(interval, count, sizeof *interval, compare_intervals);
  double covered = 0, at = low;
  for (size_t i = 0; i < count && at < high; i++) {
    const double from = fmax(at, interval[i][0]);
    const double to = fmin(high, interval[i][1]);
    if (to > from) {
      covered += to - from;
      at = to;
    }
  }
  return covered;
}

/* One collar among others. */
struct disturbed {
  const struct solid *s;
  const double *box;
  const struct collar *c;
  double u[3], v[3]; /* span the plane across the axis */
  size_t balls, bridges;
  const size_t *ball, *bridge; /* that it may meet */
  double (*cut)[2];            /* balls + bridges */
  double rho;
  gsl_integration_workspace *inner;
  double tolerance, worst; /* of a ring's integral: wanted, found */
};

static double length_left(double azimuth, void *params) {
  const struct disturbed *q = params;
  const struct collar *c = q->c;
  const double rho2 = q->rho * q->rho;
  double p[3] = {c->a[0], c->a[1], c->a[2]}, t[2];
  vec3_axpy(q->rho * cos(azimuth), q->u, p);
  vec3_axpy(q->rho * sin(azimuth), q->v, p);
  double low = sqrt(c->ra * c->ra - rho2);
  double high = c->d - sqrt(c->rb * c->rb - rho2);
  for (int k = 0; k < 3; k++)
    for (int side = 0; side < 2; side++) {
      const double to = q->box[2 * k + side] - p[k];
      if (c->axis[k] == 0) {
        if (side ? to < 0 : to > 0)
          return 0;
      } else if ((c->axis[k] > 0) == side) {
        high = fmin(high, to / c->axis[k]);
      } else {
        low = fmax(low, to / c->axis[k]);
      }
    }
  if (!(low < high))
    return 0;
  size_t count = 0;
  for (size_t m = 0; m < q->balls; m++) {
    const size_t i = q->ball[m];
    if (solid_line_ball(q->s->x + 3 * i, q->s->r[i], p, c->axis, t))
      memcpy(q->cut[count++], t, sizeof t);
  }
  for (size_t m = 0; m < q->bridges; m++) {
    const uint32_t *ends = q->s->ends[q->bridge[m]];
    if (solid_line_cylinder(q->s->x + 3 * (size_t)ends[0],
                            q->s->x + 3 * (size_t)ends[1], q->s->bridge_radius,
                            p, c->axis, t))
      memcpy(q->cut[count++], t, sizeof t);
  }
  return (high - low) - solid_covered(count, q->cut, low, high);
}

/* A rule that sees nothing of a narrow cut would call it well integrated, so
   that adapting begins from several parts. */
enum { INTERVALS = 200, RINGS = 2, SECTORS = 16 };

static double parts(gsl_function *f, double low, double high, int count,
                    double tolerance, gsl_integration_workspace *w,
                    double *error) {
  double sum = 0;
  *error = 0;
  for (int i = 0; i < count; i++) {
    double part = 0, e = 0;
    /* kinks may keep the tolerance from being met: the error says so */
    gsl_integration_qag(f, low + (high - low) * i / count,
                        low + (high - low) * (i + 1) / count, tolerance / count,
                        0, INTERVALS, GSL_INTEG_GAUSS15, w, &part, &e);
    sum += part;
    *error += e;
  }
  return sum;
}

static double ring_left(double rho, void *params) {
  struct disturbed *q = params;
  gsl_function f = {length_left, q};
  double error;
  q->rho = rho;
  const double ring =
      parts(&f, 0, 2 * M_PI, SECTORS, q->tolerance, q->inner, &error);
  q->worst = fmax(q->worst, error);
  return rho * ring;
}

/* The part of a collar's volume that is left; adds to *error. */
static int collar_left(struct disturbed *q, double whole, double *left,
                       double *error) {
  const struct collar *c = q->c;
  /* any direction across the axis: that of its least component */
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(c->axis[k]) < fabs(c->axis[least]))
      least = k;
  double direction[3] = {0, 0, 0};
  direction[least] = 1;
  vec3_cross(c->axis, direction, q->u);
  const double norm = vec3_norm(q->u);
  for (int k = 0; k < 3; k++)
    q->u[k] /= norm;
  vec3_cross(c->axis, q->u, q->v);

  const double wanted = 1e-8 * whole;
  const double width = (c->outer - c->inner) * (c->outer + c->inner) / 2;
  int status = GSL_ENOMEM;
  gsl_integration_workspace *outer = gsl_integration_workspace_alloc(INTERVALS);
  q->inner = gsl_integration_workspace_alloc(INTERVALS);
  q->cut = calloc(q->balls + q->bridges + 1, sizeof *q->cut);
  if (outer && q->inner && q->cut) {
    gsl_function f = {ring_left, q};
    double e = 0;
    q->tolerance = wanted / width / 10;
    q->worst = 0;
    *left = parts(&f, c->inner, c->outer, RINGS, wanted, outer, &e);
    *error += e + q->worst * width;
    status = GSL_SUCCESS;
  }
  free(q->cut);
  if (q->inner)
    gsl_integration_workspace_free(q->inner);
  if (outer)
    gsl_integration_workspace_free(outer);
  return status;
}

/* The volume that bridges add to the spheres. near: balls of all spheres and,
   behind them, all collars. */
static int sum_collars(const struct solid *s, const double box[6],
                       const struct collar *collar, const size_t *start,
                       const uint32_t *partner, size_t *scratch, double *sum,
                       double *error) {
  *sum = 0;
  for (size_t k = 0; k < s->bridges; k++) {
    const struct collar *c = &collar[k];
    const double whole = whole_collar(c);
    if (whole == 0 || box_misses_ball(box, c->ball, c->reach))
      continue;
    size_t balls = 0, bridges = 0, *bridge = scratch;
    /* bridges from the front, balls behind them: both in ascending order */
    for (size_t p = start[s->n + k]; p < start[s->n + k + 1]; p++)
      if (partner[p] >= s->n && partner[p] - s->n < k &&
          collar[partner[p] - s->n].reach > 0)
        bridge[bridges++] = partner[p] - s->n;
    size_t *ball = scratch + bridges;
    for (size_t p = start[s->n + k]; p < start[s->n + k + 1]; p++)
      if (partner[p] < s->n && partner[p] != s->ends[k][0] &&
          partner[p] != s->ends[k][1])
        ball[balls++] = partner[p];
    if (!balls && !bridges && box_holds_ball(box, c->ball, c->reach)) {
      *sum += whole;
      continue;
    }
    struct disturbed q = {.s = s,
                          .box = box,
                          .c = c,
                          .balls = balls,
                          .bridges = bridges,
                          .ball = ball,
                          .bridge = bridge};
    double left;
    if (collar_left(&q, whole, &left, error) != GSL_SUCCESS)
      return GSL_ENOMEM;
    *sum += left;
  }
  return GSL_SUCCESS;
}

static int bridges_volume(const struct solid *s, const double box[6],
                          double *volume, double *error) {
  const size_t all = s->n + s->bridges;
  struct neighbors nb = {0};
  struct collar *collar = calloc(s->bridges, sizeof *collar);
  double *x = calloc(all, 3 * sizeof *x), *r = calloc(all, sizeof *r);
  size_t *start = calloc(all + 2, sizeof *start), *scratch = NULL;
  uint32_t *partner = NULL;
  int status = GSL_ENOMEM;
  if (!collar || !x || !r || !start)
    goto done;
  memcpy(x, s->x, 3 * s->n * sizeof *x);
  memcpy(r, s->r, s->n * sizeof *r);
  for (size_t k = 0; k < s->bridges; k++) {
    status = collar_of(s, k, &collar[k]);
    if (status != GSL_SUCCESS)
      goto done;
    memcpy(x + 3 * (s->n + k), collar[k].ball, sizeof collar[k].ball);
    r[s->n + k] = collar[k].reach;
  }
  status = neighbors_find(&nb, all, x, 3, r, 0);
  if (status != GSL_SUCCESS)
    goto done;
  status = GSL_ENOMEM;
  partner = calloc(nb.count + 1, 2 * sizeof *partner);
  if (!partner)
    goto done;
  scratch =
      calloc(neighbors_partners(&nb, all, start, partner) + 1, sizeof *scratch);
  if (scratch)
    status =
        sum_collars(s, box, collar, start, partner, scratch, volume, error);
done:
  free(scratch);
  free(partner);
  neighbors_free(&nb);
  free(start);
  free(r);
  free(x);
  free(collar);
  return status;
}

int solid_volume(const struct solid *s, const double box[6],
                 struct solid_volume *volume) {
  struct solid_volume v = {0};
  double within[6];
  memcpy(within, box, sizeof within);
  for (int k = 0; k < 3 && s->container; k++) {
    within[2 * k] = fmax(box[2 * k], s->container[2 * k]);
    within[2 * k + 1] = fmin(box[2 * k + 1], s->container[2 * k + 1]);
  }
  const bool any = box_valid(within);
  if (s->container)
    v.walls = box_volume(box) - (any ? box_volume(within) : 0);
  int status = GSL_SUCCESS;
  if (any)
    status = volume_union(s->n, s->x, s->r, within, &v.spheres);
  if (status == GSL_SUCCESS && any && s->bridges)
    status = bridges_volume(s, within, &v.bridges, &v.error);
  if (status != GSL_SUCCESS)
    return status;
  v.total = v.spheres + v.bridges + v.walls;
  *volume = v;
  return GSL_SUCCESS;
}

int solid_pairs(size_t n, const double *x, const double *r, double reach,
                uint32_t (**ends)[2], size_t *count) {
  struct neighbors nb = {0};
  int status = neighbors_find(&nb, n, x, 3, r, reach);
  uint32_t(*found)[2] = NULL;
  if (status == GSL_SUCCESS) {
    found = calloc(nb.count + 1, sizeof *found);
    status = found ? GSL_SUCCESS : GSL_ENOMEM;
  }
  for (size_t p = 0; p < nb.count && found; p++) {
    found[p][0] = nb.i[p];
    found[p][1] = nb.j[p];
  }
  if (found) {
    *ends = found;
    *count = nb.count;
  }
  neighbors_free(&nb);
  return status;
}

size_t solid_visible(const struct solid *s, uint32_t (*ends)[2]) {
  size_t count = 0;
  for (size_t k = 0; k < s->bridges; k++) {
    struct collar c;
    const uint32_t pair[2] = {s->ends[k][0], s->ends[k][1]};
    if (collar_of(s, k, &c) == GSL_SUCCESS && !(c.inner < c.outer))
      continue;
    memcpy(ends[count++], pair, sizeof pair);
  }
  return count;
}

int solid_shrink(size_t n, const double *x, const double *r, double gap,
                 double *factor) {
  struct neighbors nb = {0};
  const int status = neighbors_find(&nb, n, x, 3, r, gap);
  double least = 1;
  for (size_t p = 0; p < nb.count; p++) {
    double d[3];
    const size_t i = nb.i[p], j = nb.j[p];
    vec3_sub(x + 3 * i, x + 3 * j, d);
    least = fmin(least, (vec3_norm(d) - gap) / (r[i] + r[j]));
  }
  neighbors_free(&nb);
  if (status != GSL_SUCCESS)
    return status;
  if (!(least > 0))
    return GSL_EDOM;
  *factor = least;
  return GSL_SUCCESS;
}

struct profile {
  size_t n;
  const double *x, *r, *box;
  double xi, *grown;
  int status;
};

/* Volume below the distance at which the profile is (1 - u)/2. */
static double level_volume(double u, void *params) {
  struct profile *p = params;
  double volume = 0;
  for (size_t i = 0; i < p->n; i++)
    p->grown[i] = p->r[i] + 2 * p->xi * atanh(u);
  if (p->status == GSL_SUCCESS)
    p->status = volume_union(p->n, p->x, p->grown, p->box, &volume);
  return volume;
}

int solid_diffuse(size_t n, const double *x, const double *r,
                  const double box[6], double xi, double *mean) {
  if (!(xi > 0) || !box_valid(box))
    return GSL_EINVAL;
  struct profile p = {.n = n,
                      .x = x,
                      .r = r,
                      .box = box,
                      .xi = xi,
                      .grown = calloc(n + 1, sizeof *p.grown)};
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(INTERVALS);
  p.status = w && p.grown ? GSL_SUCCESS : GSL_ENOMEM;
  if (p.status == GSL_SUCCESS) {
    gsl_function f = {level_volume, &p};
    double sum, error;
    const int status = gsl_integration_qag(&f, -1, 1, 0, 1e-5, INTERVALS,
                                           GSL_INTEG_GAUSS15, w, &sum, &error);
    if (p.status == GSL_SUCCESS && status != GSL_EROUND)
      p.status = status;
    if (p.status == GSL_SUCCESS)
      *mean = sum / 2 / box_volume(box);
  }
  if (w)
    gsl_integration_workspace_free(w);
  free(p.grown);
  return p.status;
}
