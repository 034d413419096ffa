/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Compiled once per instruction set with KERNEL_ISA set to its name. Flags
   that matter here: no errno and no traps from sqrt, so that loops vectorise;
   NaN and infinity are kept, since they tell of a step too long. */
#include "dynamics/kernel.h"

#include <string.h>
#include "platform/vector_exp.h"

#ifndef KERNEL_ISA
#define KERNEL_ISA native
#endif
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

#define INLINE static inline __attribute__((always_inline))

/* Contacts go through the law in blocks that stay in the first-level cache:
   gather into columns, evaluate, add to the spheres' rows. */
enum { BLOCK = 64, LANES = 8 };

struct block {
  double nx[BLOCK], ny[BLOCK], nz[BLOCK]; /* unit normal to the sphere */
  double gap[BLOCK];
  double vx[BLOCK], vy[BLOCK], vz[BLOCK]; /* velocity less the other's */
  double sx[BLOCK], sy[BLOCK], sz[BLOCK]; /* sum of radius * spin */
  double fx[BLOCK], fy[BLOCK], fz[BLOCK]; /* force */
  double tx[BLOCK], ty[BLOCK], tz[BLOCK]; /* n x friction force */
  /* Where the torques of the two are not equal: 1/r of the sphere and of the
     other (0: a wall), their reduced radius, sum and difference of their spins,
     and what the other has of t. */
  double inverse_i[BLOCK], inverse_j[BLOCK], reduced[BLOCK];
  double px[BLOCK], py[BLOCK], pz[BLOCK];
  double qx[BLOCK], qy[BLOCK], qz[BLOCK];
  double ox[BLOCK], oy[BLOCK], oz[BLOCK];
};

/* Whether the torques on both spheres of a contact, by radius, differ. */
INLINE bool has_sides(const struct contact_features has) {
  return has.lever || has.rolling;
}

/* Where registers hold four doubles. */
#ifdef __AVX2__
enum { WIDE = 1 };
#else
enum { WIDE = 0 };
#endif

/* Rows of four doubles are turned into columns and back four at a time: loads
   and shuffles, no gather instructions, which cost more on today's machines. */
typedef double vec4 __attribute__((vector_size(32)));

INLINE vec4 vec4_load(const double *p) {
  vec4 v;
  memcpy(&v, p, sizeof v);
  return v;
}

INLINE void vec4_store(vec4 v, double *p) {
  memcpy(p, &v, sizeof v);
}

INLINE void transpose(vec4 r[4]) {
  const vec4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
  const vec4 b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const vec4 c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
  const vec4 d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/* One pair's differences of positions and velocities and its sum of r w. */
INLINE void load_pair(const struct contact_list *list, const double *y,
                      size_t i, size_t j, size_t c, struct block *b,
                      const struct contact_features has) {
  const size_t stride = has.rotation ? ROW_SPIN : ROW_PLAIN;
  const double *p = y + i * stride, *q = y + j * stride;
  const double ri = has.uniform ? 1 : list->radius[i],
               rj = has.uniform ? 1 : list->radius[j];
  b->nx[c] = p[ROW_X] - q[ROW_X];
  b->ny[c] = p[ROW_X + 1] - q[ROW_X + 1];
  b->nz[c] = p[ROW_X + 2] - q[ROW_X + 2];
  b->vx[c] = p[ROW_V] - q[ROW_V];
  b->vy[c] = p[ROW_V + 1] - q[ROW_V + 1];
  b->vz[c] = p[ROW_V + 2] - q[ROW_V + 2];
  if (has.rotation) {
    b->sx[c] = ri * p[ROW_W] + rj * q[ROW_W];
    b->sy[c] = ri * p[ROW_W + 1] + rj * q[ROW_W + 1];
    b->sz[c] = ri * p[ROW_W + 2] + rj * q[ROW_W + 2];
  }
  if (!has.uniform)
    b->gap[c] = -(ri + rj);
  if (has_sides(has)) {
    b->inverse_i[c] = 1 / ri;
    b->inverse_j[c] = 1 / rj;
    b->reduced[c] = contact_reduced(ri, rj);
    b->px[c] = p[ROW_W] + q[ROW_W];
    b->py[c] = p[ROW_W + 1] + q[ROW_W + 1];
    b->pz[c] = p[ROW_W + 2] + q[ROW_W + 2];
    b->qx[c] = p[ROW_W] - q[ROW_W];
    b->qy[c] = p[ROW_W + 1] - q[ROW_W + 1];
    b->qz[c] = p[ROW_W + 2] - q[ROW_W + 2];
  }
}

/* The same for four pairs of equal spheres. */
INLINE void load_four(const double *y, const uint32_t *i, const uint32_t *j,
                      size_t c, struct block *b,
                      const struct contact_features has) {
  const size_t stride = has.rotation ? ROW_SPIN : ROW_PLAIN;
  const vec4 plus = {-1, -1, 1, 1}; /* velocities less, spins and */
  vec4 u[4], w[4];
  for (size_t l = 0; l < 4; l++) {
    const double *p = y + i[l] * stride;
    const double *q = y + j[l] * stride;
    u[l] = vec4_load(p) - vec4_load(q);
    if (has.rotation) {
      w[l] = vec4_load(p + ROW_V + 1) + plus * vec4_load(q + ROW_V + 1);
      b->sz[c + l] = p[ROW_W + 2] + q[ROW_W + 2];
    } else {
      w[l] = vec4_load(p + ROW_X + 2) - vec4_load(q + ROW_X + 2);
    }
  }
  transpose(u);
  transpose(w);
  vec4_store(u[0], b->nx + c);
  vec4_store(u[1], b->ny + c);
  vec4_store(u[2], b->nz + c);
  vec4_store(u[3], b->vx + c);
  vec4_store(w[has.rotation ? 0 : 2], b->vy + c);
  vec4_store(w[has.rotation ? 1 : 3], b->vz + c);
  if (has.rotation) {
    vec4_store(w[2], b->sx + c);
    vec4_store(w[3], b->sy + c);
  }
}

/* (2.2): separation vectors, relative velocities and spins of pairs. */
INLINE void load_pairs(const struct contact_list *list, const double *y,
                       const uint32_t *i, const uint32_t *j, size_t count,
                       struct block *b, const struct contact_features has) {
  size_t c = 0;
  if (WIDE && has.uniform)
    for (; c + 4 <= count; c += 4)
      load_four(y, i + c, j + c, c, b, has);
  for (; c < count; c++)
    load_pair(list, y, i[c], j[c], c, b, has);
}

/* Separation vectors between nearest images. */
static void take_nearest(const double period[3], size_t count,
                         struct block *b) {
  double *u[3] = {b->nx, b->ny, b->nz};
  for (int k = 0; k < 3; k++)
    for (size_t c = 0; c < count && period[k] > 0; c++)
      u[k][c] -= period[k] * __builtin_rint(u[k][c] / period[k]);
}

/* Distances and normals of pairs, in place of separation vectors. */
INLINE void normalise(const struct contact_list *list, size_t count,
                      struct block *b, const struct contact_features has) {
  const double r = list->radius[0];
#pragma omp simd
  for (size_t l = 0; l < count; l++) {
    const double d =
        sqrt(b->nx[l] * b->nx[l] + b->ny[l] * b->ny[l] + b->nz[l] * b->nz[l]);
    const double inverse = 1 / d;
    b->gap[l] = d + (has.uniform ? -2 * r : b->gap[l]);
    b->nx[l] *= inverse;
    b->ny[l] *= inverse;
    b->nz[l] *= inverse;
    if (has.rotation && has.uniform) {
      b->sx[l] *= r;
      b->sy[l] *= r;
      b->sz[l] *= r;
    }
  }
}

/* A wall is a body at rest with the normal -n_k, (2.5) and (2.10). */
INLINE void load_wall(const struct contact_list *list, const double *y,
                      size_t k, size_t c, struct block *b,
                      const struct contact_features has) {
  const size_t stride = has.rotation ? ROW_SPIN : ROW_PLAIN;
  const size_t i = list->wall_row[k];
  const struct wall *w = &list->walls[list->wall_id[k]];
  const double *p = y + i * stride;
  const double r = list->radius[i];
  b->nx[c] = -w->normal[0];
  b->ny[c] = -w->normal[1];
  b->nz[c] = -w->normal[2];
  b->gap[c] = plane_distance(w, p) - r;
  b->vx[c] = p[ROW_V];
  b->vy[c] = p[ROW_V + 1];
  b->vz[c] = p[ROW_V + 2];
  if (has.rotation) {
    b->sx[c] = r * p[ROW_W];
    b->sy[c] = r * p[ROW_W + 1];
    b->sz[c] = r * p[ROW_W + 2];
  }
  if (has_sides(has)) {
    b->inverse_i[c] = 1 / r;
    b->inverse_j[c] = 0;
    b->reduced[c] = r;
    b->px[c] = b->qx[c] = p[ROW_W];
    b->py[c] = b->qy[c] = p[ROW_W + 1];
    b->pz[c] = b->qz[c] = p[ROW_W + 2];
  }
}

/* The same four at a time, for equal spheres that spin; rows, points and
   normals are turned into columns. */
INLINE void load_four_walls(const struct contact_list *list, const double *y,
                            size_t k, size_t c, struct block *b) {
  const double r = list->radius[0];
  vec4 u[4], w[4], n[4], d[4];
  for (size_t l = 0; l < 4; l++) {
    const double *p = y + (size_t)list->wall_row[k + l] * ROW_SPIN;
    const struct wall *wall = &list->walls[list->wall_id[k + l]];
    const double *at = wall->point, *normal = wall->normal;
    u[l] = vec4_load(p);
    w[l] = vec4_load(p + ROW_V + 1);
    b->sz[c + l] = r * p[ROW_W + 2];
    n[l] = (vec4){normal[0], normal[1], normal[2], 0};
    d[l] = (vec4){at[0], at[1], at[2], 0} - u[l];
  }
  transpose(u);
  transpose(w);
  transpose(n);
  transpose(d);
  vec4_store(-n[0], b->nx + c);
  vec4_store(-n[1], b->ny + c);
  vec4_store(-n[2], b->nz + c);
  vec4_store(d[0] * n[0] + d[1] * n[1] + d[2] * n[2] - r, b->gap + c);
  vec4_store(u[3], b->vx + c);
  vec4_store(w[0], b->vy + c);
  vec4_store(w[1], b->vz + c);
  vec4_store(r * w[2], b->sx + c);
  vec4_store(r * w[3], b->sy + c);
}

INLINE void load_walls(const struct contact_list *list, const double *y,
                       size_t from, size_t count, struct block *b,
                       const struct contact_features has) {
  size_t c = 0;
  if (WIDE && has.uniform && has.rotation)
    for (; c + 4 <= count; c += 4)
      load_four_walls(list, y, from + c, c, b);
  for (; c < count; c++)
    load_wall(list, y, from + c, c, b, has);
}

/* Where some walls are cylinders, puts in their normals and gaps. */
INLINE void bend_walls(const struct contact_list *list, const double *y,
                       size_t from, size_t count, struct block *b,
                       const struct contact_features has) {
  const size_t stride = has.rotation ? ROW_SPIN : ROW_PLAIN;
  for (size_t c = 0; c < count; c++) {
    const size_t i = list->wall_row[from + c];
    const struct wall *w = &list->walls[list->wall_id[from + c]];
    double normal[3];
    if (!(w->radius > 0))
      continue;
    b->gap[c] = cylinder_distance(w, y + i * stride, normal) - list->radius[i];
    b->nx[c] = -normal[0];
    b->ny[c] = -normal[1];
    b->nz[c] = -normal[2];
  }
}

/* Fills a block up to whole vectors with idle contacts, so that a contact is
   computed the same way, to the last bit, wherever it stands in a block. */
INLINE size_t pad(struct block *b, size_t count,
                  const struct contact_features has) {
  const size_t padded = (count + LANES - 1) / LANES * LANES;
  for (; count < padded; count++) {
    b->nx[count] = 1;
    b->ny[count] = b->nz[count] = b->gap[count] = 0;
    b->vx[count] = b->vy[count] = b->vz[count] = 0;
    b->sx[count] = b->sy[count] = b->sz[count] = 0;
    if (has_sides(has)) {
      b->inverse_i[count] = b->inverse_j[count] = b->reduced[count] = 0;
      b->px[count] = b->py[count] = b->pz[count] = 0;
      b->qx[count] = b->qy[count] = b->qz[count] = 0;
    }
  }
  return padded;
}

/* n x f as it turns the sphere and the other, who multiply it by -r/I: with the
   arms of the contact point, and with the couple of rolling resistance. */
INLINE void evaluate_sides(const struct contact_law *law, size_t c, double f,
                           struct block *b, const struct contact_features has) {
  const double tx = b->tx[c], ty = b->ty[c], tz = b->tz[c];
  const double i = b->inverse_i[c], j = b->inverse_j[c];
  const double half = has.lever ? 0.5 * b->gap[c] : 0;
  const double own = 1 + half * i, other = 1 + half * j;
  double ux = 0, uy = 0, uz = 0;
  if (has.rolling) {
    const double nx = b->nx[c], ny = b->ny[c], nz = b->nz[c];
    const double qx = b->qx[c], qy = b->qy[c], qz = b->qz[c];
    const double along = qx * nx + qy * ny + qz * nz;
    const double reduced = b->reduced[c], vmin = law->vmin;
    ux = reduced * (qx - along * nx);
    uy = reduced * (qy - along * ny);
    uz = reduced * (qz - along * nz);
    const double u = sqrt(ux * ux + uy * uy + uz * uz);
    const double s = u / vmin;
    const double slip =
        u < vmin ? (3 - 2 * s) * s / vmin : 1 / (u < vmin ? vmin : u);
    const double g = law->rolling * f * reduced * slip;
    ux *= g;
    uy *= g;
    uz *= g;
  }
  b->tx[c] = own * tx + i * ux;
  b->ty[c] = own * ty + i * uy;
  b->tz[c] = own * tz + i * uz;
  b->ox[c] = other * tx - j * ux;
  b->oy[c] = other * ty - j * uy;
  b->oz[c] = other * tz - j * uz;
}

/* The law: contact.h, written for columns. Each loop calls exp or keeps much in
   registers, not both. */
INLINE void evaluate(const struct contact_law *law, size_t count,
                     struct block *b, const struct contact_features has) {
  const double f0 = law->f0, kappa = law->kappa, lmax = law->lmax;
  const double e2 = law->restitution * law->restitution;
  const double psi2 = 2 * law->psi;
  const double vmin = law->vmin, inverse_vmin = 1 / vmin;
  const double phi = law->friction;
  double rates[BLOCK], repulsion[BLOCK], rebound[BLOCK];
#pragma omp simd
  for (size_t c = 0; c < count; c++) {
    rates[c] = b->vx[c] * b->nx[c] + b->vy[c] * b->ny[c] + b->vz[c] * b->nz[c];
    rebound[c] = psi2 * rates[c];
    repulsion[c] = -kappa * b->gap[c];
  }
#pragma omp simd
  for (size_t c = 0; c < count; c++)
    repulsion[c] = exp(repulsion[c]);
  if (!has.elastic)
#pragma omp simd
    for (size_t c = 0; c < count; c++)
      rebound[c] = exp(rebound[c]);
#pragma omp simd
  for (size_t c = 0; c < count; c++) {
    const double nx = b->nx[c], ny = b->ny[c], nz = b->nz[c];
    const double vx = b->vx[c], vy = b->vy[c], vz = b->vz[c];
    const double rate = rates[c];
    const double in_reach = f0 * repulsion[c];
    const double f = b->gap[c] > lmax ? 0 : in_reach;
    const double normal =
        has.elastic ? f : f * (e2 + (1 - e2) / (1 + rebound[c]));
    double fx = normal * nx, fy = normal * ny, fz = normal * nz;
    if (has.friction) {
      double tx = vx - rate * nx, ty = vy - rate * ny, tz = vz - rate * nz;
      if (has.rotation) {
        double sx = b->sx[c], sy = b->sy[c], sz = b->sz[c];
        if (has.lever) {
          const double half = 0.5 * b->gap[c];
          sx += half * b->px[c];
          sy += half * b->py[c];
          sz += half * b->pz[c];
        }
        tx -= sy * nz - sz * ny;
        ty -= sz * nx - sx * nz;
        tz -= sx * ny - sy * nx;
      }
      const double t = sqrt(tx * tx + ty * ty + tz * tz);
      const double s = t * inverse_vmin;
      const double slip =
          t < vmin ? (3 - 2 * s) * s * inverse_vmin : 1 / (t < vmin ? vmin : t);
      const double g = -phi * f * slip;
      tx *= g;
      ty *= g;
      tz *= g;
      fx += tx;
      fy += ty;
      fz += tz;
      if (has.rotation) {
        b->tx[c] = ny * tz - nz * ty;
        b->ty[c] = nz * tx - nx * tz;
        b->tz[c] = nx * ty - ny * tx;
        if (has_sides(has))
          evaluate_sides(law, c, f, b, has);
      }
    }
    b->fx[c] = fx;
    b->fy[c] = fy;
    b->fz[c] = fz;
  }
}

/* Four contacts' results as rows. */
INLINE void unload_four(const struct block *b, size_t c, vec4 f[4], vec4 t[4],
                        const struct contact_features has) {
  if (WIDE) {
    f[0] = vec4_load(b->fx + c);
    f[1] = vec4_load(b->fy + c);
    f[2] = vec4_load(b->fz + c);
    f[3] = (vec4){0};
    transpose(f);
    if (has.rotation) {
      t[0] = vec4_load(b->tx + c);
      t[1] = vec4_load(b->ty + c);
      t[2] = vec4_load(b->tz + c);
      t[3] = (vec4){0};
      transpose(t);
    }
    return;
  }
  for (int l = 0; l < 4; l++, c++) {
    f[l] = (vec4){b->fx[c], b->fy[c], b->fz[c], 0};
    if (has.rotation)
      t[l] = (vec4){b->tx[c], b->ty[c], b->tz[c], 0};
  }
}

INLINE double *sum_of(const struct contact_part *part, size_t i) {
  return part->sums + (i & part->mask) * CONTACT_SUM;
}

INLINE bool within(const struct contact_part *part, size_t i) {
  return i >= part->from && i < part->to;
}

/* The torque of the other sphere of a contact. */
INLINE vec4 other_torque(const struct block *b, size_t c, vec4 own,
                         const struct contact_features has) {
  return has_sides(has) ? (vec4){b->ox[c], b->oy[c], b->oz[c], 0} : own;
}

/* As second partner the force is reversed, the torque is not. The first
   partner's sum stays in registers over its run of pairs. */
INLINE void scatter_pairs(const struct block *b, const uint32_t *i,
                          const uint32_t *j, size_t count,
                          const struct contact_part *part,
                          const struct contact_features has) {
  size_t owner = i[0];
  double *sum = sum_of(part, owner);
  bool ours = within(part, owner);
  vec4 own_f = {0}, own_t = {0};
  if (ours) {
    own_f = vec4_load(sum);
    own_t = vec4_load(sum + 4);
  }
  for (size_t c = 0; c < count; c += 4) {
    vec4 f[4], t[4];
    unload_four(b, c, f, t, has);
    for (size_t l = 0; l < 4 && c + l < count; l++) {
      if (i[c + l] != owner) {
        if (ours) {
          vec4_store(own_f, sum);
          if (has.rotation)
            vec4_store(own_t, sum + 4);
        }
        owner = i[c + l];
        sum = sum_of(part, owner);
        ours = within(part, owner);
        if (ours) {
          own_f = vec4_load(sum);
          own_t = vec4_load(sum + 4);
        }
      }
      own_f += f[l];
      if (has.rotation)
        own_t += t[l];
      if (within(part, j[c + l])) {
        double *other = sum_of(part, j[c + l]);
        vec4_store(vec4_load(other) - f[l], other);
        if (has.rotation)
          vec4_store(vec4_load(other + 4) + other_torque(b, c + l, t[l], has),
                     other + 4);
      }
    }
  }
  if (ours) {
    vec4_store(own_f, sum);
    if (has.rotation)
      vec4_store(own_t, sum + 4);
  }
}

INLINE void scatter_walls(const struct block *b, const uint32_t *row,
                          size_t count, const struct contact_part *part,
                          const struct contact_features has) {
  for (size_t c = 0; c < count; c += 4) {
    vec4 f[4], t[4];
    unload_four(b, c, f, t, has);
    for (size_t l = 0; l < 4 && c + l < count; l++) {
      double *sum = sum_of(part, row[c + l]);
      vec4_store(vec4_load(sum) + f[l], sum);
      if (has.rotation)
        vec4_store(vec4_load(sum + 4) + t[l], sum + 4);
    }
  }
}

INLINE void add_pairs(const struct contact_list *list, const double *y,
                      const uint32_t *i, const uint32_t *j, size_t count,
                      const struct contact_part *part,
                      const struct contact_features has) {
  struct block b;
  for (size_t from = 0; from < count; from += BLOCK) {
    const size_t some = count - from < BLOCK ? count - from : BLOCK;
    load_pairs(list, y, i + from, j + from, some, &b, has);
    if (list->periodic)
      take_nearest(list->period, some, &b);
    const size_t padded = pad(&b, some, has);
    normalise(list, padded, &b, has);
    evaluate(&list->law, padded, &b, has);
    scatter_pairs(&b, i + from, j + from, some, part, has);
  }
}

INLINE void add_walls(const struct contact_list *list, const double *y,
                      size_t from, size_t to, const struct contact_part *part,
                      const struct contact_features has) {
  struct block b;
  const size_t end = list->wall_first[to];
  for (size_t w = list->wall_first[from]; w < end; w += BLOCK) {
    const size_t some = end - w < BLOCK ? end - w : BLOCK;
    load_walls(list, y, w, some, &b, has);
    if (list->cylinders)
      bend_walls(list, y, w, some, &b, has);
    evaluate(&list->law, pad(&b, some, has), &b, has);
    scatter_walls(&b, list->wall_row + w, some, part, has);
  }
}

/* (2.13)-(2.15): torque = -r n x f, I = 2 m r^2 / 5. The rates of a row that
   spins, stored four by four from the first on, each over what the one before
   wrote too much; sum for what must be finite, free spins too. */
INLINE vec4 finish_row(const double *state, double *rate, const double *sum,
                       vec4 gravity, double push, double turn,
                       const double *more) {
  const vec4 v = vec4_load(state + ROW_V);
  vec4 a = gravity + push * vec4_load(sum), b = turn * vec4_load(sum + 4);
  if (more) {
    a += vec4_load(more + ROW_V);
    b += (vec4){more[ROW_W], more[ROW_W + 1], more[ROW_W + 2], 0};
  }
  vec4_store(v, rate);
  vec4_store(a, rate + ROW_V);
  rate[ROW_W] = b[0];
  rate[ROW_W + 1] = b[1];
  rate[ROW_W + 2] = b[2];
  /* the last of v is a spin, and that of a one too where more is */
  return v + a + b + 0 * vec4_load(state + ROW_W - 1);
}

INLINE double finish_plain(const double *state, double *rate, const double *sum,
                           const double gravity[3], double push,
                           const double *more) {
  double checksum = 0;
  for (int c = 0; c < 3; c++) {
    rate[c] = state[ROW_V + c];
    rate[ROW_V + c] = gravity[c] + push * sum[c];
    if (more)
      rate[ROW_V + c] += more[ROW_V + c];
    checksum += rate[c] + rate[ROW_V + c];
  }
  return checksum;
}

INLINE bool finish(const struct contact_list *list, const double *y,
                   double *rates, size_t from, size_t to,
                   const struct contact_part *part,
                   const struct contact_features has, const bool frozen) {
  const size_t stride = has.rotation ? ROW_SPIN : ROW_PLAIN;
  const double *g = list->gravity;
  const vec4 gravity = {g[0], g[1], g[2], 0};
  vec4 checksum = {0};
  for (size_t i = from; i < to; i++) {
    const double *state = y + i * stride;
    double *rate = rates + (i - from) * stride, *sum = sum_of(part, i);
    const double *more = frozen ? list->frozen + i * stride : NULL;
    if (has.rotation)
      checksum += finish_row(state, rate, sum, gravity, list->push[i],
                             list->turn[i], more);
    else
      checksum[0] += finish_plain(state, rate, sum, g, list->push[i], more);
    vec4_store((vec4){0}, sum);
    vec4_store((vec4){0}, sum + 4);
  }
  return isfinite(checksum[0] + checksum[1] + checksum[2] + checksum[3]);
}

/* One specialised loop for each combination of features. */
#define DISPATCH(call)                                                         \
  do {                                                                         \
    const struct contact_features h = list->has;                               \
    if (h.lever && h.rolling)                                                  \
      DISPATCH_SIDES(call, true, true);                                        \
    else if (h.lever)                                                          \
      DISPATCH_SIDES(call, true, false);                                       \
    else if (h.rolling)                                                        \
      DISPATCH_SIDES(call, false, true);                                       \
    else if (h.rotation)                                                       \
      DISPATCH_REST(call, true, true);                                         \
    else if (h.friction)                                                       \
      DISPATCH_REST(call, true, false);                                        \
    else                                                                       \
      DISPATCH_REST(call, false, false);                                       \
  } while (0)
#define DISPATCH_SIDES(call, lever, rolling)                                   \
  do {                                                                         \
    if (h.elastic)                                                             \
      call(((struct contact_features){true, true, true, false, lever,          \
                                      rolling}));                              \
    else                                                                       \
      call(((struct contact_features){true, true, false, false, lever,         \
                                      rolling}));                              \
  } while (0)
#define DISPATCH_REST(call, friction, rotation)                                \
  do {                                                                         \
    if (h.elastic && h.uniform)                                                \
      call(((struct contact_features){friction, rotation, true, true, 0, 0})); \
    else if (h.elastic)                                                        \
      call(                                                                    \
          ((struct contact_features){friction, rotation, true, false, 0, 0})); \
    else if (h.uniform)                                                        \
      call(                                                                    \
          ((struct contact_features){friction, rotation, false, true, 0, 0})); \
    else                                                                       \
      call((                                                                   \
          (struct contact_features){friction, rotation, false, false, 0, 0})); \
  } while (0)

static void add_pairs_any(const struct contact_list *list, const double *y,
                          const uint32_t *i, const uint32_t *j, size_t count,
                          const struct contact_part *part) {
#define CALL(has) add_pairs(list, y, i, j, count, part, has)
  DISPATCH(CALL);
#undef CALL
}

static void add_walls_any(const struct contact_list *list, const double *y,
                          size_t from, size_t to,
                          const struct contact_part *part) {
#define CALL(has) add_walls(list, y, from, to, part, has)
  DISPATCH(CALL);
#undef CALL
}

static bool finish_any(const struct contact_list *list, const double *y,
                       double *rates, size_t from, size_t to,
                       const struct contact_part *part) {
  const struct contact_features turning = {.rotation = true}, plain = {0};
#define CALL(has, frozen) finish(list, y, rates, from, to, part, has, frozen)
  if (list->has.rotation)
    return list->frozen ? CALL(turning, true) : CALL(turning, false);
  return list->frozen ? CALL(plain, true) : CALL(plain, false);
#undef CALL
}

extern const struct kernel JOIN(kernel_, KERNEL_ISA);
const struct kernel JOIN(kernel_, KERNEL_ISA) = {
    TEXT(KERNEL_ISA), add_pairs_any, add_walls_any, finish_any};
