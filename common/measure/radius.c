/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/radius.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include "geometry/box.h"
#include "geometry/neighbors.h"
#include "geometry/vec3.h"
#include "geometry/volume.h"

/* Of all pairs of centres and walls within a sphere's diameter or radius. */
struct contacts {
  size_t pairs, walls;
  double pair_sum, wall_sum;     /* of distances */
  double pair_least, wall_least; /* infinite without any */
};

static int find_contacts(const struct scene *s, size_t n, const double *x,
                         double r, struct contacts *c) {
  *c = (struct contacts){.pair_least = GSL_POSINF, .wall_least = GSL_POSINF};
  double *radii = calloc(n + 1, sizeof *radii);
  if (!radii)
    return GSL_ENOMEM;
  for (size_t i = 0; i < n; i++)
    radii[i] = r;
  struct neighbors nb = {0};
  const int status = neighbors_find(&nb, n, x, 3, radii, 0);
  for (size_t p = 0; p < nb.count; p++) {
    double d[3];
    vec3_sub(x + 3 * (size_t)nb.i[p], x + 3 * (size_t)nb.j[p], d);
    const double distance = vec3_norm(d);
    c->pairs++;
    c->pair_sum += distance;
    c->pair_least = fmin(c->pair_least, distance);
  }
  for (size_t i = 0; i < n && status == GSL_SUCCESS; i++)
    for (size_t k = 0; k < s->walls_count; k++) {
      const double distance = wall_distance(&s->walls[k], x + 3 * i);
      c->wall_least = fmin(c->wall_least, distance);
      if (distance > r)
        continue;
      c->walls++;
      c->wall_sum += distance;
    }
  neighbors_free(&nb);
  free(radii);
  return status;
}

int radius_overlaps(const struct scene *s, size_t n, const double *x, double r,
                    struct radius_overlaps *o) {
  struct contacts c;
  const int status = find_contacts(s, n, x, r, &c);
  if (status != GSL_SUCCESS)
    return status;
  const double pairs = (double)c.pairs, walls = (double)c.walls;
  o->count = c.pairs + c.walls;
  o->largest = fmax(0, fmax(2 * r - c.pair_least, r - c.wall_least) / (2 * r));
  o->mean = 0;
  if (o->count) /* rounding may leave less than nothing */
    o->mean = fmax(0, (2 * r * pairs - c.pair_sum + r * walls - c.wall_sum) /
                          (2 * r * (pairs + walls)));
  return GSL_SUCCESS;
}

int radius_touching(const struct scene *s, size_t n, const double *x,
                    double *r) {
  double low[3], high[3], extent = 0;
  for (int k = 0; k < 3; k++) {
    low[k] = GSL_POSINF;
    high[k] = GSL_NEGINF;
  }
  for (size_t i = 0; i < 3 * n; i++) {
    low[i % 3] = fmin(low[i % 3], x[i]);
    high[i % 3] = fmax(high[i % 3], x[i]);
  }
  for (int k = 0; k < 3; k++)
    extent += high[k] - low[k];
  struct contacts c;
  /* the first guess is that of a bed which fills its extent */
  double guess = n > 1 && extent > 0 ? extent / 3 / cbrt((double)n) : 1;
  for (;;) {
    const int status = find_contacts(s, n, x, guess, &c);
    if (status != GSL_SUCCESS)
      return status;
    if (c.pairs || n < 2)
      break;
    guess *= 2;
  }
  const double least = fmin(c.pair_least / 2, c.wall_least);
  if (!(least > 0) || !isfinite(least))
    return GSL_EDOM;
  *r = least;
  return GSL_SUCCESS;
}

int radius_contact_mean(const struct scene *s, size_t n, const double *x,
                        double nominal, double *r) {
  struct contacts c;
  const int status = find_contacts(s, n, x, nominal, &c);
  if (status != GSL_SUCCESS)
    return status;
  const double mean =
      (c.pair_sum + c.wall_sum) / (2 * (double)c.pairs + (double)c.walls);
  if (!(mean > 0)) /* NaN without contacts */
    return GSL_EDOM;
  *r = mean;
  return GSL_SUCCESS;
}

struct target {
  size_t n;
  const double *x, *box;
  double *radii, volume;
  bool sum;
  int status; /* of the first volume that failed */
  const struct observer *observer;
  size_t volumes; /* made so far */
};

/* Volumes that a root takes, about. */
enum { VOLUMES = 20 };

/* Volume beyond the one that is wanted. */
static double excess(double r, void *params) {
  struct target *t = params;
  double volume = GSL_NAN;
  observer_tell(t->observer, GSL_MIN(t->volumes, VOLUMES - 1), VOLUMES);
  t->volumes++;
  for (size_t i = 0; i < t->n; i++)
    t->radii[i] = r;
  if (t->sum)
    volume = volume_sum(t->n, t->x, t->radii, t->box);
  else if (t->status == GSL_SUCCESS)
    t->status = volume_union(t->n, t->x, t->radii, t->box, &volume);
  /* an end to the search for the root, which is then thrown away */
  return t->status == GSL_SUCCESS ? volume - t->volume : 0;
}

int radius_of_fraction(size_t n, const double *x, const double box[6],
                       double fraction, bool sum,
                       const struct observer *observer, double *r) {
  const double volume = box_volume(box);
  if (n == 0 || !(fraction > 0) || (!sum && fraction >= 1) || !(volume > 0))
    return GSL_EDOM;
  struct target t = {.n = n,
                     .x = x,
                     .box = box,
                     .radii = malloc(n * sizeof *t.radii),
                     .volume = fraction * volume,
                     .sum = sum,
                     .observer = observer};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  int status = GSL_ENOMEM;
  if (!t.radii || !solver)
    goto done;
  gsl_function f = {excess, &t};
  /* the volume without any overlap: the root is not below */
  double low = 0, high = cbrt(t.volume / (double)n * 3 / (4 * M_PI));
  for (int k = 0; k < 100 && excess(high, &t) < 0; k++) {
    low = high;
    high *= 1.5;
  }
  status = GSL_EDOM;
  if (excess(high, &t) >= 0)
    status = gsl_root_fsolver_set(solver, &f, low, high);
  for (int k = 0; k < 200 && status == GSL_SUCCESS; k++) {
    status = gsl_root_fsolver_iterate(solver);
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver),
                               gsl_root_fsolver_x_upper(solver), 0,
                               4 * GSL_DBL_EPSILON) == GSL_SUCCESS)
      break;
  }
  if (t.status != GSL_SUCCESS)
    status = t.status;
  if (status == GSL_SUCCESS)
    *r = gsl_root_fsolver_root(solver);
done:
  if (solver)
    gsl_root_fsolver_free(solver);
  free(t.radii);
  return status;
}
