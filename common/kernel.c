/* Compiled once per instruction set with KERNEL_ISA set to its name. Flags
   that matter here: no errno and no traps from sqrt, so that loops vectorise;
   NaN and infinity are kept, since they tell of a step too long. */
#include "kernel.h"

#include <math.h>

#ifndef KERNEL_ISA
#define KERNEL_ISA native
#endif
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

#if defined __x86_64__ && defined __GNUC__ && !defined __clang__
/* glibc's libmvec has vector variants; math.h declares them only under
   -ffast-math. */
#pragma omp declare simd notinbranch
double exp(double);
#endif

#define INLINE static inline __attribute__((always_inline))

/* Contacts go through the law in blocks that stay in the first-level cache:
   gather into columns, evaluate, scatter into rows. */
enum { BLOCK = 64 };

struct block {
  double nx[BLOCK], ny[BLOCK], nz[BLOCK]; /* unit normal to the sphere */
  double gap[BLOCK];
  double vx[BLOCK], vy[BLOCK], vz[BLOCK]; /* velocity less the other's */
  double sx[BLOCK], sy[BLOCK], sz[BLOCK]; /* sum of radius * spin */
  double fx[BLOCK], fy[BLOCK], fz[BLOCK]; /* force */
  double tx[BLOCK], ty[BLOCK], tz[BLOCK]; /* n x friction force */
};

/* (2.2): separation vectors, relative velocities and spins of pairs. */
INLINE void load_pairs(const struct kernel_data *k, const double *y,
                       size_t from, size_t count, struct block *b,
                       const struct kernel_features has) {
  const size_t stride = has.rotation ? 9 : 6;
  for (size_t c = 0; c < count; c++) {
    const size_t i = k->i[from + c], j = k->j[from + c];
    const double *p = y + i * stride, *q = y + j * stride;
    b->nx[c] = p[0] - q[0];
    b->ny[c] = p[1] - q[1];
    b->nz[c] = p[2] - q[2];
    b->vx[c] = p[3] - q[3];
    b->vy[c] = p[4] - q[4];
    b->vz[c] = p[5] - q[5];
    const double ri = k->radius[has.uniform ? 0 : i],
                 rj = k->radius[has.uniform ? 0 : j];
    if (has.rotation) {
      b->sx[c] = ri * p[6] + rj * q[6];
      b->sy[c] = ri * p[7] + rj * q[7];
      b->sz[c] = ri * p[8] + rj * q[8];
    }
    if (!has.uniform)
      b->gap[c] = -(ri + rj);
  }
  const double touching = -2 * k->radius[0];
#pragma omp simd
  for (size_t c = 0; c < count; c++) {
    const double d =
        sqrt(b->nx[c] * b->nx[c] + b->ny[c] * b->ny[c] + b->nz[c] * b->nz[c]);
    const double inverse = 1 / d;
    b->gap[c] = d + (has.uniform ? touching : b->gap[c]);
    b->nx[c] *= inverse;
    b->ny[c] *= inverse;
    b->nz[c] *= inverse;
  }
}

/* A wall is a body at rest with the normal -n_k, (2.5) and (2.10). */
INLINE void load_walls(const struct kernel_data *k, const double *y,
                       size_t from, size_t count, struct block *b,
                       const struct kernel_features has) {
  const size_t stride = has.rotation ? 9 : 6;
  for (size_t c = 0; c < count; c++) {
    const size_t i = k->wall_sphere[from + c];
    const struct wall *w = &k->walls[k->wall_id[from + c]];
    const double *p = y + i * stride;
    const double r = k->radius[i];
    b->nx[c] = -w->normal[0];
    b->ny[c] = -w->normal[1];
    b->nz[c] = -w->normal[2];
    b->gap[c] = wall_distance(w, p) - r;
    b->vx[c] = p[3];
    b->vy[c] = p[4];
    b->vz[c] = p[5];
    if (has.rotation) {
      b->sx[c] = r * p[6];
      b->sy[c] = r * p[7];
      b->sz[c] = r * p[8];
    }
  }
}

/* The law: contact.h, written for columns. */
INLINE void evaluate(const struct contact_law *law, size_t count,
                     struct block *b, const struct kernel_features has) {
  const double f0 = law->f0, kappa = law->kappa, lmax = law->lmax;
  const double e2 = law->restitution * law->restitution;
  const double psi2 = 2 * law->psi;
  const double vmin = law->vmin, inverse_vmin = 1 / vmin;
  const double phi = law->friction;
#pragma omp simd
  for (size_t c = 0; c < count; c++) {
    const double nx = b->nx[c], ny = b->ny[c], nz = b->nz[c];
    const double vx = b->vx[c], vy = b->vy[c], vz = b->vz[c];
    const double rate = vx * nx + vy * ny + vz * nz;
    const double in_reach = f0 * exp(-kappa * b->gap[c]);
    const double f = b->gap[c] > lmax ? 0 : in_reach;
    const double normal =
        has.elastic ? f : f * (e2 + (1 - e2) / (1 + exp(psi2 * rate)));
    double fx = normal * nx, fy = normal * ny, fz = normal * nz;
    if (has.friction) {
      double tx = vx - rate * nx, ty = vy - rate * ny, tz = vz - rate * nz;
      if (has.rotation) {
        const double sx = b->sx[c], sy = b->sy[c], sz = b->sz[c];
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
      }
    }
    b->fx[c] = fx;
    b->fy[c] = fy;
    b->fz[c] = fz;
  }
}

INLINE void store(const struct block *b, size_t count, double *row,
                  const struct kernel_features has) {
  const size_t width = has.rotation ? 8 : 4;
  for (size_t c = 0; c < count; c++, row += width) {
    row[0] = b->fx[c];
    row[1] = b->fy[c];
    row[2] = b->fz[c];
    if (has.rotation) {
      row[4] = b->tx[c];
      row[5] = b->ty[c];
      row[6] = b->tz[c];
    }
  }
}

INLINE void contacts(const struct kernel_data *k, const double *y, size_t from,
                     size_t to, const struct kernel_features has) {
  struct block b;
  const size_t width = has.rotation ? 8 : 4;
  while (from < to) {
    const bool wall = from >= k->pairs;
    const size_t end = wall || to <= k->pairs ? to : k->pairs;
    const size_t count = end - from < BLOCK ? end - from : BLOCK;
    if (wall)
      load_walls(k, y, from - k->pairs, count, &b, has);
    else
      load_pairs(k, y, from, count, &b, has);
    evaluate(&k->law, count, &b, has);
    store(&b, count, k->rows + from * width, has);
    from += count;
  }
}

/* (2.13)-(2.15): as second partner the force is reversed, the torque is not. */
INLINE bool gather(const struct kernel_data *k, const double *y, double *dydt,
                   size_t from, size_t to, const struct kernel_features has) {
  const size_t stride = has.rotation ? 9 : 6, width = has.rotation ? 8 : 4;
  double checksum = 0;
  for (size_t i = from; i < to; i++) {
    double sum[8] = {0};
    for (size_t q = k->second_first[i]; q < k->second_first[i + 1]; q++) {
      const double *row = k->rows + k->second[q] * width;
      for (int c = 0; c < 4; c++)
        sum[c] -= row[c];
      if (has.rotation)
        for (int c = 4; c < 8; c++)
          sum[c] += row[c];
    }
    for (size_t p = k->first[i]; p < k->first[i + 1]; p++)
      for (size_t c = 0; c < width; c++)
        sum[c] += k->rows[p * width + c];
    for (size_t p = k->wall_first[i]; p < k->wall_first[i + 1]; p++)
      for (size_t c = 0; c < width; c++)
        sum[c] += k->rows[(k->pairs + p) * width + c];

    const double *state = y + i * stride;
    double *rate = dydt + i * stride;
    const double inverse_mass = 1 / k->mass[i];
    for (int c = 0; c < 3; c++) {
      rate[c] = state[3 + c];
      rate[3 + c] = k->gravity[c] + inverse_mass * sum[c];
      checksum += rate[c] + rate[3 + c];
    }
    if (has.rotation) {
      /* torque = -r n x f, I = 2 m r^2 / 5 */
      const double scale = -2.5 * inverse_mass / k->radius[i];
      for (int c = 0; c < 3; c++) {
        rate[6 + c] = scale * sum[4 + c];
        checksum += rate[6 + c];
      }
    }
  }
  return isfinite(checksum);
}

/* One specialised loop for each combination of features. */
#define DISPATCH(call)                                                         \
  do {                                                                         \
    const struct kernel_features h = k->has;                                   \
    if (h.rotation)                                                            \
      DISPATCH_REST(call, true, true);                                         \
    else if (h.friction)                                                       \
      DISPATCH_REST(call, true, false);                                        \
    else                                                                       \
      DISPATCH_REST(call, false, false);                                       \
  } while (0)
#define DISPATCH_REST(call, friction, rotation)                                \
  do {                                                                         \
    if (h.elastic && h.uniform)                                                \
      call(((struct kernel_features){friction, rotation, true, true}));        \
    else if (h.elastic)                                                        \
      call(((struct kernel_features){friction, rotation, true, false}));       \
    else if (h.uniform)                                                        \
      call(((struct kernel_features){friction, rotation, false, true}));       \
    else                                                                       \
      call(((struct kernel_features){friction, rotation, false, false}));      \
  } while (0)

static void contacts_any(const struct kernel_data *k, const double *y,
                         size_t from, size_t to) {
#define CALL(has) contacts(k, y, from, to, has)
  DISPATCH(CALL);
#undef CALL
}

static bool gather_any(const struct kernel_data *k, const double *y,
                       double *dydt, size_t from, size_t to) {
  if (k->has.rotation)
    return gather(k, y, dydt, from, to,
                  (struct kernel_features){.rotation = true});
  return gather(k, y, dydt, from, to, (struct kernel_features){0});
}

extern const struct kernel JOIN(kernel_, KERNEL_ISA);
const struct kernel JOIN(kernel_, KERNEL_ISA) = {TEXT(KERNEL_ISA), contacts_any,
                                                 gather_any};
