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
   adapts to its kinks. Of several collars the first counts.

   What a ball has beyond a tube, a lune, is found likewise, by lines along the
   tube. At the distance s from the ball's centre, across the tube, they are 2 h
   long, h = sqrt(r^2 - s^2), and those beyond the tube of radius R take up the
   angle 2 alpha, where sin^2(alpha/2) = (a + s - R)(a + s + R)/(4 a s) and a is
   the centre's distance from the axis. So, with s d s = -h d h,

     V = int 4 alpha h^2 d h,

   which h = h_max (1 - u^2) makes smooth at both ends; h_max belongs to the
   nearest such line. Where a lune also meets a ball before it in the list or a
   plane, the length left of each line depends on the azimuth as well. */
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

/* One collar or lune among others. */
struct disturbed {
  const struct solid *s;
  const struct container *clip; /* what is beyond does not count */
  const struct collar *c;
  struct lune *lune;
  double u[3], v[3]; /* span the plane across the axis */
  size_t balls, bridges;
  const size_t *ball, *bridge; /* that it may meet */
  double (*cut)[2];            /* balls + bridges */
  double rho;
  gsl_integration_workspace *inner;
  double tolerance, worst; /* of a ring's integral: wanted, found */
};

/* What is left of a line's part from low to high. */
static double line_left(const struct disturbed *q, const double p[3],
                        const double axis[3], double low, double high) {
  double t[2];
  if (!container_line(q->clip, p, axis, t))
    return 0;
  low = fmax(low, t[0]);
  high = fmin(high, t[1]);
  if (!(low < high))
    return 0;
  size_t count = 0;
  for (size_t m = 0; m < q->balls; m++) {
    const size_t i = q->ball[m];
    if (line_ball(q->s->x + 3 * i, q->s->r[i], p, axis, t))
      memcpy(q->cut[count++], t, sizeof t);
  }
  for (size_t m = 0; m < q->bridges; m++) {
    const uint32_t *ends = q->s->ends[q->bridge[m]];
    if (solid_line_cylinder(q->s->x + 3 * (size_t)ends[0],
                            q->s->x + 3 * (size_t)ends[1], q->s->bridge_radius,
                            p, axis, t))
      memcpy(q->cut[count++], t, sizeof t);
  }
  return (high - low) - solid_covered(count, q->cut, low, high);
}

/* The point at an azimuth and the distance rho from a. */
static void polar(const struct disturbed *q, const double a[3], double azimuth,
                  double p[3]) {
  memcpy(p, a, 3 * sizeof *p);
  vec3_axpy(q->rho * cos(azimuth), q->u, p);
  vec3_axpy(q->rho * sin(azimuth), q->v, p);
}

static double collar_line(double azimuth, void *params) {
  const struct disturbed *q = params;
  const struct collar *c = q->c;
  const double rho2 = q->rho * q->rho;
  double p[3];
  polar(q, c->a, azimuth, p);
  return line_left(q, p, c->axis, sqrt(c->ra * c->ra - rho2),
                   c->d - sqrt(c->rb * c->rb - rho2));
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
  gsl_function f = {collar_line, q};
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
  vec3_across(c->axis, q->u);
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
static int sum_collars(const struct solid *s, const struct container *clip,
                       const struct collar *collar, const size_t *start,
                       const uint32_t *partner, size_t *scratch, double *sum,
                       double *error) {
  *sum = 0;
  for (size_t k = 0; k < s->bridges; k++) {
    const struct collar *c = &collar[k];
    const double whole = whole_collar(c);
    if (whole == 0 || box_misses_ball(clip->box, c->ball, c->reach))
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
    if (!balls && !bridges && container_distance(clip, c->ball) >= c->reach) {
      *sum += whole;
      continue;
    }
    struct disturbed q = {.s = s,
                          .clip = clip,
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

/* Balls of all spheres and, behind them, of pieces: who is near to whom. */
struct near {
  size_t *start, *scratch; /* scratch: room for a piece's partners */
  uint32_t *partner;
};

static void near_free(struct near *w) {
  free(w->scratch);
  free(w->partner);
  free(w->start);
}

/* ball: three numbers and a radius for each piece. */
static int near_find(const struct solid *s, size_t pieces,
                     const double (*ball)[4], struct near *w) {
  const size_t all = s->n + pieces;
  struct neighbors nb = {0};
  double *x = calloc(all + 1, 3 * sizeof *x), *r = calloc(all + 1, sizeof *r);
  int status = GSL_ENOMEM;
  *w = (struct near){.start = calloc(all + 2, sizeof *w->start)};
  if (x && r && w->start) {
    if (s->n) {
      memcpy(x, s->x, 3 * s->n * sizeof *x);
      memcpy(r, s->r, s->n * sizeof *r);
    }
    for (size_t k = 0; k < pieces; k++) {
      memcpy(x + 3 * (s->n + k), ball[k], 3 * sizeof *x);
      r[s->n + k] = ball[k][3];
    }
    status = neighbors_find(&nb, all, x, 3, r, 0);
  }
  if (status == GSL_SUCCESS) {
    status = GSL_ENOMEM;
    w->partner = calloc(nb.count + 1, 2 * sizeof *w->partner);
  }
  if (w->partner) {
    const size_t most = neighbors_partners(&nb, all, w->start, w->partner);
    w->scratch = calloc(most + 1, sizeof *w->scratch);
    status = w->scratch ? GSL_SUCCESS : GSL_ENOMEM;
  }
  neighbors_free(&nb);
  free(r);
  free(x);
  return status;
}

static int bridges_volume(const struct solid *s, const struct container *clip,
                          double *volume, double *error) {
  struct near w = {0};
  struct collar *collar = calloc(s->bridges, sizeof *collar);
  double(*ball)[4] = calloc(s->bridges, sizeof *ball);
  int status = collar && ball ? GSL_SUCCESS : GSL_ENOMEM;
  for (size_t k = 0; k < s->bridges && status == GSL_SUCCESS; k++) {
    status = collar_of(s, k, &collar[k]);
    memcpy(ball[k], collar[k].ball, sizeof collar[k].ball);
    ball[k][3] = collar[k].reach;
  }
  if (status == GSL_SUCCESS)
    status = near_find(s, s->bridges, (const double(*)[4])ball, &w);
  if (status == GSL_SUCCESS)
    status = sum_collars(s, clip, collar, w.start, w.partner, w.scratch, volume,
                         error);
  near_free(&w);
  free(ball);
  free(collar);
  return status;
}

/* What a ball has beyond a tube. */
struct lune {
  size_t i;               /* the ball */
  const double *c;        /* its centre */
  double r, away, radius; /* of the ball; of c from the axis; of the tube */
  double outwards[3], longest; /* from the axis to c; h_max */
  double alpha;                /* of the lines in work */
};

/* False if it has nothing there. ball: what holds the lune. */
static bool lune_of(const struct solid *s, size_t i, struct lune *l,
                    double ball[4]) {
  const struct container *c = s->container;
  *l = (struct lune){
      .i = i, .c = s->x + 3 * i, .r = s->r[i], .radius = c->radius};
  l->away = container_away(c, l->c, l->outwards);
  if (!(l->r > 0) || !(l->away + l->r > l->radius))
    return false;
  const double nearest = fmax(0, l->radius - l->away);
  l->longest = sqrt((l->r - nearest) * (l->r + nearest));
  memcpy(ball, l->c, 3 * sizeof *ball);
  ball[3] = l->r;
  if (!(l->away > 0)) {
    vec3_across(c->axis, l->outwards);
    return true;
  }
  for (int k = 0; k < 3; k++)
    l->outwards[k] /= l->away;
  /* it is farther out than the lines of the tube that touch the ball */
  const double foot =
      ((l->radius - l->r) * (l->radius + l->r) / l->away - l->away) / 2;
  if (foot > 0) {
    vec3_axpy(foot, l->outwards, ball);
    ball[3] = sqrt((l->r - foot) * (l->r + foot));
  }
  return true;
}

/* Half the angle of the part of the circle of radius s that is beyond the
   tube. */
static double lune_angle(const struct lune *l, double s) {
  const double beyond = (l->away + s - l->radius) * (l->away + s + l->radius);
  if (!(beyond > 0))
    return 0;
  const double sine2 = beyond / (4 * l->away * s);
  return sine2 < 1 ? 2 * asin(sqrt(sine2)) : M_PI;
}

/* The ring of the variable u: half the length of its lines, their distance, and
   the weight of their mean length. */
static double lune_ring(struct lune *l, double u, double *h, double *s) {
  *h = l->longest * (1 - u * u);
  *s = sqrt((l->r - *h) * (l->r + *h));
  l->alpha = lune_angle(l, *s);
  return 2 * l->alpha * *h * 2 * l->longest * u;
}

static double lune_whole(double u, void *params) {
  double h, s;
  const double weight = lune_ring(params, u, &h, &s);
  return weight * 2 * h;
}

static double lune_line(double share, void *params) {
  const struct disturbed *q = params;
  const struct lune *l = q->lune;
  const double h = sqrt(fmax(0, (l->r - q->rho) * (l->r + q->rho)));
  double p[3];
  polar(q, l->c, share * l->alpha, p);
  return line_left(q, p, q->s->container->axis, -h, h);
}

static double lune_left(double u, void *params) {
  struct disturbed *q = params;
  struct lune l = *q->lune, *const before = q->lune;
  double h, error;
  const double weight = lune_ring(&l, u, &h, &q->rho);
  gsl_function f = {lune_line, q};
  q->lune = &l;
  const double twice =
      parts(&f, -1, 1, SECTORS / 4, q->tolerance, q->inner, &error);
  q->lune = before;
  q->worst = fmax(q->worst, error);
  return weight * twice / 2;
}

/* alone: the lune meets nothing. */
static double lune_volume(struct disturbed *q, bool alone,
                          gsl_integration_workspace *outer, double *error) {
  struct lune *l = q->lune;
  gsl_function f = {lune_whole, l};
  double e;
  const double exact = 1e-15 * gsl_pow_3(l->r);
  const double whole = parts(&f, 0, 1, RINGS, exact, outer, &e);
  if (alone) {
    *error += e;
    return whole;
  }
  memcpy(q->u, l->outwards, sizeof q->u);
  vec3_cross(q->s->container->axis, q->u, q->v);
  f.function = lune_left;
  f.params = q;
  q->tolerance = 1e-6 * l->longest;
  q->worst = 0;
  const double left =
      parts(&f, 0, 1, RINGS, fmax(exact, 1e-6 * whole), outer, &e);
  *error += e + q->worst * whole / l->longest;
  return left;
}

/* What the union of the spheres has beyond the tube and within a clip without
   one. ball: those of the lunes. */
static int sum_lunes(const struct solid *s, const struct container *clip,
                     size_t lunes, struct lune *lune, const double (*ball)[4],
                     const struct near *w, double *sum, double *error) {
  gsl_integration_workspace *outer = gsl_integration_workspace_alloc(INTERVALS);
  struct disturbed q = {.s = s,
                        .clip = clip,
                        .ball = w->scratch,
                        .inner = gsl_integration_workspace_alloc(INTERVALS),
                        .cut = calloc(s->n + 1, sizeof *q.cut)};
  const bool room = outer && q.inner && q.cut;
  *sum = 0;
  for (size_t k = 0; k < lunes && room; k++) {
    if (box_misses_ball(clip->box, ball[k], ball[k][3]))
      continue;
    q.lune = &lune[k];
    q.balls = 0;
    for (size_t p = w->start[s->n + k]; p < w->start[s->n + k + 1]; p++)
      if (w->partner[p] < lune[k].i)
        w->scratch[q.balls++] = w->partner[p];
    const bool alone =
        !q.balls && container_distance(clip, ball[k]) >= ball[k][3];
    *sum += lune_volume(&q, alone, outer, error);
  }
  free(q.cut);
  if (q.inner)
    gsl_integration_workspace_free(q.inner);
  if (outer)
    gsl_integration_workspace_free(outer);
  return room ? GSL_SUCCESS : GSL_ENOMEM;
}

static int beyond_tube(const struct solid *s, const struct container *clip,
                       double *volume, double *error) {
  struct container open = *clip;
  open.radius = 0;
  struct near w = {0};
  struct lune *lune = calloc(s->n + 1, sizeof *lune);
  double(*ball)[4] = calloc(s->n + 1, sizeof *ball);
  size_t lunes = 0;
  int status = lune && ball ? GSL_SUCCESS : GSL_ENOMEM;
  for (size_t i = 0; i < s->n && status == GSL_SUCCESS; i++)
    lunes += lune_of(s, i, &lune[lunes], ball[lunes]);
  if (status == GSL_SUCCESS)
    status = near_find(s, lunes, (const double(*)[4])ball, &w);
  if (status == GSL_SUCCESS)
    status = sum_lunes(s, &open, lunes, lune, (const double(*)[4])ball, &w,
                       volume, error);
  near_free(&w);
  free(ball);
  free(lune);
  return status;
}

int solid_volume(const struct solid *s, const double box[6],
                 struct solid_volume *volume) {
  struct solid_volume v = {0};
  struct container clip = s->container ? *s->container : container_none();
  double inside, beyond = 0;
  for (int k = 0; k < 6; k++)
    clip.box[k] = k % 2 ? fmin(box[k], clip.box[k]) : fmax(box[k], clip.box[k]);
  const bool any = box_valid(clip.box);
  int status = container_volume(&clip, box, &inside);
  if (status == GSL_SUCCESS && s->container)
    v.walls = box_volume(box) - inside;
  if (status == GSL_SUCCESS && any)
    status = volume_union_planes(s->n, s->x, s->r, clip.box, clip.planes,
                                 clip.plane, NULL, &v.spheres);
  if (status == GSL_SUCCESS && any && clip.radius > 0)
    status = beyond_tube(s, &clip, &beyond, &v.error);
  if (status == GSL_SUCCESS && any && s->bridges)
    status = bridges_volume(s, &clip, &v.bridges, &v.error);
  if (status != GSL_SUCCESS)
    return status;
  v.spheres -= beyond;
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
