/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/radius.h"

#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include "geometry/box.h"
#include "geometry/periodic.h"
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
  struct periodic_pairs near = {0};
  const int status = periodic_pairs_find(&near, n, x, 2 * r, s->period);
  for (size_t p = 0; p < near.near.count; p++) {
    size_t i, j;
    double u[3];
    if (!periodic_pair(&near, p, &i, &j, u))
      continue;
    const double distance = vec3_norm(u);
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
  periodic_pairs_free(&near);
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

/* A distance that two centres have, not much more than the least of all as a
   rule: the least from some of them. Infinite without a second centre. */
static double some_distance(const double period[3], size_t n, const double *x) {
  enum { SOME = 16 };
  double least = GSL_POSINF;
  for (int k = 0; k < 3; k++) /* of two images of one sphere */
    if (period[k] > 0)
      least = fmin(least, period[k]);
  for (size_t k = 0; k < SOME; k++) {
    const size_t i = k * n / SOME;
    for (size_t j = 0; j < n; j++) {
      double u[3];
      vec3_sub(x + 3 * i, x + 3 * j, u);
      periodic_nearest(period, u);
      if (i != j)
        least = fmin(least, vec3_norm(u));
    }
  }
  return least;
}

int radius_touching(const struct scene *s, size_t n, const double *x,
                    double *r) {
  struct contacts c;
  const double some = some_distance(s->period, n, x);
  /* a little more, so that rounding leaves a pair */
  const int status =
      find_contacts(s, n, x, isfinite(some) ? some / 2 * (1 + 1e-9) : 0, &c);
  if (status != GSL_SUCCESS)
    return status;
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

/* The spheres of one radius, and all their images in the box. */
static int find_images(const struct scene *s, size_t n, const double *x,
                       const double box[6], double r,
                       struct periodic_images *all) {
  double *radii = malloc((n + 1) * sizeof *radii);
  if (!radii)
    return GSL_ENOMEM;
  for (size_t i = 0; i < n; i++)
    radii[i] = r;
  const int status = periodic_images_in_box(all, n, x, radii, s->period, box);
  free(radii);
  return status;
}

int radius_volume(const struct scene *s, size_t n, const double *x,
                  const double box[6], double r, bool sum,
                  const struct observer *observer, double *volume) {
  struct periodic_images all = {0};
  int status = find_images(s, n, x, box, r, &all);
  if (status == GSL_SUCCESS && sum)
    *volume = volume_sum(all.count, all.x, all.radius, box);
  else if (status == GSL_SUCCESS)
    status =
        volume_union_told(all.count, all.x, all.radius, box, observer, volume);
  periodic_images_free(&all);
  return status;
}

/* Marks per axis that the first guess of a union is counted on. */
enum { MARKS = 32 };

static int sampled_union(const struct scene *s, size_t n, const double *x,
                         const double box[6], double r, double *volume) {
  struct periodic_images all = {0};
  double sum;
  int status = find_images(s, n, x, box, r, &all);
  if (status == GSL_SUCCESS)
    status = volume_sampled(all.count, all.x, all.radius, box, MARKS, NULL,
                            &sum, volume);
  periodic_images_free(&all);
  return status;
}

struct target {
  const struct scene *s;
  size_t n;
  const double *x, *box;
  double volume;
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
  if (t->status == GSL_SUCCESS)
    t->status =
        radius_volume(t->s, t->n, t->x, t->box, r, t->sum, NULL, &volume);
  /* an end to the search for the root, which is then thrown away */
  return t->status == GSL_SUCCESS ? volume - t->volume : 0;
}

/* A bed of many spheres that is so wide of its fraction that each reaches over
   so many others, on average, has no radius: its union would take hours, as the
   square of their number, and is that of one lump. */
enum { MOST_PARTNERS = 60, FEW_PAIRS = 100000 };

static int is_lump(const struct target *t, double r, bool *lump) {
  struct periodic_pairs near = {0};
  const int status =
      periodic_pairs_find(&near, t->n, t->x, 2 * r, t->s->period);
  const double pairs = (double)near.near.count;
  *lump = pairs > FEW_PAIRS && pairs > 0.5 * MOST_PARTNERS * (double)t->n;
  periodic_pairs_free(&near);
  return status;
}

/* About the radius of a union, by marks. high: of the volume without any
   overlap, which the radius is not below. */
static int guess(const struct target *t, double high, double *r) {
  double low = 0, volume = 0;
  bool lump = false;
  for (int k = 0; k < 200 && volume < t->volume; k++) {
    int status = is_lump(t, high, &lump);
    if (status == GSL_SUCCESS && !lump)
      status = sampled_union(t->s, t->n, t->x, t->box, high, &volume);
    if (status != GSL_SUCCESS || lump)
      return lump ? GSL_EDOM : status;
    if (volume < t->volume)
      low = high;
    high *= 1.25;
  }
  if (volume < t->volume)
    return GSL_EDOM;
  for (int k = 0; k < 12; k++) {
    const double middle = (low + high) / 2;
    const int status = sampled_union(t->s, t->n, t->x, t->box, middle, &volume);
    if (status != GSL_SUCCESS)
      return status;
    *(volume < t->volume ? &low : &high) = middle;
  }
  *r = (low + high) / 2;
  return GSL_SUCCESS;
}

/* Moves the ends of an interval apart until the root is between them. */
static int bracket(struct target *t, double *low, double *high) {
  double step = 0.002;
  for (; *low > 0 && excess(*low, t) > 0; step *= 4) {
    *high = *low;
    *low *= GSL_MAX(0, 1 - step);
  }
  for (int k = 0; k < 100; k++, step *= 4) {
    if (excess(*high, t) >= 0)
      return t->status;
    *low = *high;
    *high *= 1 + GSL_MIN(step, 0.5);
  }
  return GSL_EDOM;
}

int radius_of_fraction(const struct scene *s, size_t n, const double *x,
                       const double box[6], double fraction, bool sum,
                       const struct observer *observer, double *r) {
  const double volume = box_volume(box);
  if (n == 0 || !(fraction > 0) || (!sum && fraction >= 1) || !(volume > 0))
    return GSL_EDOM;
  struct target t = {.s = s,
                     .n = n,
                     .x = x,
                     .box = box,
                     .volume = fraction * volume,
                     .sum = sum,
                     .observer = observer};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!solver)
    return GSL_ENOMEM;
  gsl_function f = {excess, &t};
  double low = 0, high = cbrt(t.volume / (double)n * 3 / (4 * M_PI));
  int status = GSL_SUCCESS;
  if (!sum) {
    status = guess(&t, high, &high);
    low = high * (1 - 1e-3); /* what MARKS leave uncertain, as a rule */
    high *= 1 + 1e-3;
  }
  if (status == GSL_SUCCESS)
    status = bracket(&t, &low, &high);
  if (status == GSL_SUCCESS)
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
  gsl_root_fsolver_free(solver);
  return status;
}
