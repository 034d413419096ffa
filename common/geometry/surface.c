/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"

struct surface {
  const struct solid *solid;
  bool clip;
  double region[6], low[3], step;
  size_t nodes[3];
  /* Of two layers of nodes, which are inside. */
  unsigned char *inside[2];
  /* Members that may meet the cubes of a row in the layer in work: spheres,
     then bridges; those of row j are member[start[j]] ... member[start[j+1] -
     1]. */
  size_t *start, *member, members_size;
};

static double node(const struct surface *f, int axis, size_t i) {
  return f->low[axis] + (double)i * f->step;
}

static bool is_finite(const struct solid *s) {
  for (size_t i = 0; i < s->n; i++)
    if (!isfinite(s->x[3 * i]) || !isfinite(s->x[3 * i + 1]) ||
        !isfinite(s->x[3 * i + 2]) || !isfinite(s->r[i]))
      return false;
  return true;
}

int surface_open(struct surface **out, const struct solid *s,
                 const double region[6], bool clip, size_t cells) {
  if (!box_valid(region) || cells == 0 || !is_finite(s))
    return GSL_EINVAL;
  struct surface *f = calloc(1, sizeof *f);
  if (!f)
    return GSL_ENOMEM;
  f->solid = s;
  f->clip = clip;
  memcpy(f->region, region, sizeof f->region);
  double longest = 0, nodes = 1;
  for (int k = 0; k < 3; k++)
    longest = fmax(longest, region[2 * k + 1] - region[2 * k]);
  f->step = longest / (double)cells;
  /* faces are half a step from the nodes */
  for (int k = 0; k < 3; k++) {
    const double side = region[2 * k + 1] - region[2 * k];
    const double steps = ceil(side / f->step - 1e-9) + 2;
    f->low[k] = region[2 * k] - f->step / 2;
    nodes *= k < 2 ? steps : 1;
    if (!(steps < 1e9) || !(nodes < 1e12)) {
      free(f);
      return GSL_ENOMEM;
    }
    f->nodes[k] = (size_t)steps;
  }
  const size_t layer = f->nodes[0] * f->nodes[1];
  f->inside[0] = calloc(layer, 1);
  f->inside[1] = calloc(layer, 1);
  f->start = calloc(f->nodes[1] + 2, sizeof *f->start);
  if (!f->inside[0] || !f->inside[1] || !f->start) {
    surface_close(f);
    return GSL_ENOMEM;
  }
  *out = f;
  return GSL_SUCCESS;
}

void surface_close(struct surface *f) {
  if (!f)
    return;
  free(f->inside[0]);
  free(f->inside[1]);
  free(f->start);
  free(f->member);
  free(f);
}

double surface_step(const struct surface *f) {
  return f->step;
}

/* The nodes along an axis from *first to the one before *end hold all between
   low and high. */
static void nodes_between(const struct surface *f, int axis, double low,
                          double high, size_t *first, size_t *end) {
  const double last = (double)f->nodes[axis];
  const double from = floor((low - f->low[axis]) / f->step);
  const double to = ceil((high - f->low[axis]) / f->step) + 1;
  *first = (size_t)fmin(fmax(from, 0), last);
  *end = (size_t)fmin(fmax(to, 0), last);
}

static const double *end_of(const struct solid *s, size_t bridge, int end) {
  return s->x + 3 * (size_t)s->ends[bridge][end];
}

static void mark_ball(const struct surface *f, size_t i, size_t k,
                      unsigned char *inside) {
  const double *c = f->solid->x + 3 * i, r = f->solid->r[i];
  const double dz = node(f, 2, k) - c[2];
  if (!(r > 0) || fabs(dz) >= r)
    return;
  size_t j, j_end, q, q_end;
  nodes_between(f, 1, c[1] - r, c[1] + r, &j, &j_end);
  for (; j < j_end; j++) {
    const double dy = node(f, 1, j) - c[1], rest = r * r - dz * dz - dy * dy;
    if (rest <= 0)
      continue;
    nodes_between(f, 0, c[0] - sqrt(rest), c[0] + sqrt(rest), &q, &q_end);
    for (; q < q_end; q++) {
      const double dx = node(f, 0, q) - c[0];
      if (dx * dx < rest)
        inside[j * f->nodes[0] + q] = 1;
    }
  }
}

static void mark_bridge(const struct surface *f, size_t b, size_t k,
                        unsigned char *inside) {
  const struct solid *s = f->solid;
  const double *p = end_of(s, b, 0), *q = end_of(s, b, 1);
  const double r = s->bridge_radius, z = node(f, 2, k);
  if (z < fmin(p[2], q[2]) - r || z > fmax(p[2], q[2]) + r)
    return;
  size_t j, j_end, first, end;
  nodes_between(f, 1, fmin(p[1], q[1]) - r, fmax(p[1], q[1]) + r, &j, &j_end);
  nodes_between(f, 0, fmin(p[0], q[0]) - r, fmax(p[0], q[0]) + r, &first, &end);
  for (; j < j_end; j++)
    for (size_t i = first; i < end; i++) {
      const double at[3] = {node(f, 0, i), node(f, 1, j), z};
      if (solid_cylinder_distance(p, q, r, at) < 0)
        inside[j * f->nodes[0] + i] = 1;
    }
}

/* Which nodes of layer k are inside. */
static void mark(const struct surface *f, size_t k, unsigned char *inside) {
  const struct solid *s = f->solid;
  memset(inside, 0, f->nodes[0] * f->nodes[1]);
  for (size_t i = 0; i < s->n; i++)
    mark_ball(f, i, k, inside);
  for (size_t b = 0; b < s->bridges; b++)
    mark_bridge(f, b, k, inside);
  if (!f->clip)
    return;
  for (size_t j = 0; j < f->nodes[1]; j++)
    for (size_t i = 0; i < f->nodes[0]; i++) {
      const double at[3] = {node(f, 0, i), node(f, 1, j), node(f, 2, k)};
      unsigned char *in = &inside[j * f->nodes[0] + i];
      if (s->container && container_distance(s->container, at) < 0)
        *in = 1;
      if (!(box_distance(f->region, at) > 0))
        *in = 0;
    }
}

/* The rows of cubes that a primitive may meet between layers k and k + 1, with
   a bit to spare. False if none. */
static bool rows_met(const struct surface *f, size_t m, size_t k, size_t *first,
                     size_t *end) {
  const struct solid *s = f->solid;
  double low[2], high[2];
  const bool ball = m < s->n;
  const double *p = ball ? s->x + 3 * m : end_of(s, m - s->n, 0);
  const double *q = ball ? p : end_of(s, m - s->n, 1);
  const double r = (ball ? s->r[m] : s->bridge_radius) + 1e-6 * f->step;
  for (int axis = 1; axis < 3; axis++) {
    low[axis - 1] = fmin(p[axis], q[axis]) - r;
    high[axis - 1] = fmax(p[axis], q[axis]) + r;
  }
  if (low[1] > node(f, 2, k + 1) || high[1] < node(f, 2, k))
    return false;
  nodes_between(f, 1, low[0], high[0], first, end);
  *first -= *first > 0;
  *end = GSL_MIN(*end, f->nodes[1] - 1);
  return *first < *end;
}

static int list_members(struct surface *f, size_t k) {
  const size_t rows = f->nodes[1] - 1, all = f->solid->n + f->solid->bridges;
  size_t first, end;
  memset(f->start, 0, (rows + 2) * sizeof *f->start);
  for (size_t m = 0; m < all; m++)
    if (rows_met(f, m, k, &first, &end))
      for (size_t j = first; j < end; j++)
        f->start[j + 2]++;
  for (size_t j = 2; j < rows + 2; j++)
    f->start[j] += f->start[j - 1];
  const size_t want = f->start[rows + 1];
  if (want > f->members_size) {
    size_t *member = realloc(f->member, (want + want / 2) * sizeof *member);
    if (!member)
      return GSL_ENOMEM;
    f->member = member;
    f->members_size = want + want / 2;
  }
  for (size_t m = 0; m < all; m++)
    if (rows_met(f, m, k, &first, &end))
      for (size_t j = first; j < end; j++)
        f->member[f->start[j + 1]++] = m;
  return GSL_SUCCESS;
}

/* Where the line from p, outside, to q = p + e, inside, first enters the
   solid: a share of the way. */
static double entry(const struct surface *f, size_t row, const double p[3],
                    const double e[3]) {
  const struct solid *s = f->solid;
  double from = 0, least = 1, t[2];
  if (f->clip)
    for (int k = 0; k < 3; k++) {
      if (p[k] < f->region[2 * k] && e[k] > 0)
        from = fmax(from, (f->region[2 * k] - p[k]) / e[k]);
      if (p[k] > f->region[2 * k + 1] && e[k] < 0)
        from = fmax(from, (f->region[2 * k + 1] - p[k]) / e[k]);
    }
  /* where it leaves the container, if it is within that at first */
  if (s->container)
    least = container_line(s->container, p, e, t) && t[0] <= from && t[1] > from
                ? fmin(least, t[1])
                : from;
  const double reach = f->step;
  for (size_t m = f->start[row]; m < f->start[row + 1]; m++) {
    const size_t i = f->member[m];
    bool meets;
    if (i < s->n) {
      const double *c = s->x + 3 * i;
      if (fabs(c[0] - p[0]) > s->r[i] + reach || !(s->r[i] > 0))
        continue;
      meets = line_ball(c, s->r[i], p, e, t);
    } else {
      meets =
          solid_line_cylinder(end_of(s, i - s->n, 0), end_of(s, i - s->n, 1),
                              s->bridge_radius, p, e, t);
    }
    if (meets && t[1] > from)
      least = fmin(least, fmax(from, t[0]));
  }
  return GSL_MIN(GSL_MAX(least, SURFACE_MARGIN), 1 - SURFACE_MARGIN);
}

struct walk {
  struct surface *f;
  surface_triangle *each;
  void *context;
  size_t count;
  size_t at[3]; /* of the cube */
};

/* Corner c of the cube: bits for x, y, z. */
static void corner_at(const struct walk *w, int c, double p[3]) {
  for (int k = 0; k < 3; k++)
    p[k] = node(w->f, k, w->at[k] + (size_t)(c >> k & 1));
}

static void crossing(const struct walk *w, int outside, int inside,
                     double at[3]) {
  double p[3], q[3], e[3];
  corner_at(w, outside, p);
  corner_at(w, inside, q);
  vec3_sub(q, p, e);
  memcpy(at, p, sizeof p);
  vec3_axpy(entry(w->f, w->at[1], p, e), e, at);
}

/* The triangle that cuts edges a[m]-b[m], one end inside; turned round if
   flip. */
static void add(struct walk *w, const int a[3], const int b[3], unsigned inside,
                bool flip) {
  w->count++;
  if (!w->each)
    return;
  double corner[3][3];
  for (int m = 0; m < 3; m++) {
    const bool in = inside >> a[m] & 1;
    crossing(w, in ? b[m] : a[m], in ? a[m] : b[m],
             corner[flip && m ? 3 - m : m]);
  }
  w->each((const double(*)[3])corner, w->context);
}

/* A tetrahedron of corners v, with a positive volume by the right-hand rule
   unless odd; inside: a bit for each corner of the cube. */
static void cut(struct walk *w, const int v[4], bool odd, unsigned inside) {
  int in[4], out[4], ins = 0, outs = 0;
  bool flip = odd;
  for (int m = 0; m < 4; m++)
    if (inside >> v[m] & 1) {
      in[ins++] = v[m];
      /* it moves past those outside before it: each a change of places */
      flip ^= outs & 1;
    } else {
      out[outs++] = v[m];
    }
  /* now (in, out) has the orientation that flip says */
  if (ins == 1) {
    add(w, (int[]){in[0], in[0], in[0]}, out, inside, flip);
  } else if (ins == 3) {
    add(w, in, (int[]){out[0], out[0], out[0]}, inside, flip);
  } else if (ins == 2) {
    /* around the quadrilateral: 0-0, 0-1, 1-1, 1-0 */
    add(w, (int[]){in[0], in[0], in[1]}, (int[]){out[0], out[1], out[1]},
        inside, flip);
    add(w, (int[]){in[0], in[1], in[1]}, (int[]){out[0], out[1], out[0]},
        inside, flip);
  }
}

static void cut_cube(struct walk *w, unsigned inside) {
  /* from corner 0 to 7 along the axes in each order */
  static const int path[6][2] = {{1, 3}, {2, 6}, {4, 5},
                                 {2, 3}, {4, 6}, {1, 5}};
  for (int m = 0; m < 6; m++) {
    const int v[4] = {0, path[m][0], path[m][1], 7};
    cut(w, v, m >= 3, inside);
  }
}

int surface_walk(struct surface *f, surface_triangle *each, void *context,
                 size_t *count) {
  struct walk w = {.f = f, .each = each, .context = context};
  const size_t nx = f->nodes[0], ny = f->nodes[1];
  mark(f, 0, f->inside[0]);
  for (size_t k = 0; k + 1 < f->nodes[2]; k++) {
    const unsigned char *low = f->inside[k % 2];
    unsigned char *high = f->inside[(k + 1) % 2];
    mark(f, k + 1, high);
    if (each && list_members(f, k) != GSL_SUCCESS)
      return GSL_ENOMEM;
    w.at[2] = k;
    for (size_t j = 0; j + 1 < ny; j++) {
      w.at[1] = j;
      const size_t row = j * nx;
      for (size_t i = 0; i + 1 < nx; i++) {
        const size_t q = row + i;
        const int inside = low[q] | low[q + 1] << 1 | low[q + nx] << 2 |
                           low[q + nx + 1] << 3 | high[q] << 4 |
                           high[q + 1] << 5 | high[q + nx] << 6 |
                           high[q + nx + 1] << 7;
        if (inside == 0 || inside == 255)
          continue;
        w.at[0] = i;
        cut_cube(&w, (unsigned)inside);
      }
    }
  }
  *count = w.count;
  return GSL_SUCCESS;
}
