/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/power.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include "geometry/neighbors.h"
#include "geometry/vec3.h"

/* In units of both radii: nearer centres are one to rounding. */
static const double concentric = 1e-20;

static bool finite_ball(int dim, const double *c, double r) {
  bool finite = isfinite(r);
  for (int k = 0; k < dim; k++)
    finite = finite && isfinite(c[k]);
  return finite;
}

static int find_partners(struct power *p) {
  struct neighbors nb = {0};
  int status = neighbors_find(&nb, p->n, p->x, 3, p->r, 0);
  if (status == GSL_SUCCESS) {
    p->start = calloc(p->n + 2, sizeof *p->start);
    p->partner = calloc(nb.count + 1, 2 * sizeof *p->partner);
    if (p->start && p->partner)
      p->most = neighbors_partners(&nb, p->n, p->start, p->partner);
    else
      status = GSL_ENOMEM;
  }
  neighbors_free(&nb);
  return status;
}

int power_alloc(struct power **out, int dim, size_t n, const double *x,
                const double *r,
                bool (*reaches)(const double *c, double r, const void *place),
                const void *place) {
  assert(dim == 2 || dim == 3);
  const size_t row = (size_t)dim;
  size_t near = 0;
  for (size_t i = 0; i < n; i++) {
    if (!finite_ball(dim, x + row * i, r[i]))
      return GSL_EINVAL;
    near += reaches(x + row * i, r[i], place);
  }
  struct power *p = calloc(1, sizeof *p);
  if (!p)
    return GSL_ENOMEM;
  p->dim = dim;
  p->x = calloc(near + 1, 3 * sizeof *p->x);
  p->r = calloc(near + 1, sizeof *p->r);
  if (!p->x || !p->r) {
    power_free(p);
    return GSL_ENOMEM;
  }
  for (size_t i = 0; i < n; i++)
    if (reaches(x + row * i, r[i], place)) {
      for (size_t k = 0; k < row; k++)
        p->x[3 * p->n + k] = x[row * i + k];
      p->r[p->n++] = r[i];
    }
  assert(p->n == near);
  const int status = find_partners(p);
  if (status != GSL_SUCCESS) {
    power_free(p);
    return status;
  }
  *out = p;
  return GSL_SUCCESS;
}

void power_free(struct power *p) {
  if (!p)
    return;
  free(p->partner);
  free(p->start);
  free(p->r);
  free(p->x);
  free(p);
}

enum power_leaves power_plane(const struct power *p, size_t i, size_t j,
                              double plane[4]) {
  const double ri = p->r[i], rj = p->r[j];
  double d[3];
  vec3_sub(p->x + 3 * j, p->x + 3 * i, d);
  const double distance = p->dim == 2 ? hypot(d[0], d[1]) : vec3_norm(d);
  if (distance <= concentric * (ri + rj))
    return rj > ri || (rj == ri && j < i) ? POWER_NONE : POWER_ALL;
  for (int k = 0; k < 3; k++)
    plane[k] = d[k] / distance;
  plane[3] = (distance + (ri - rj) * (ri + rj) / distance) / 2;
  return POWER_HALF;
}
