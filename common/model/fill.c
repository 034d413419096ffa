/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/fill.h"

#include <math.h>
#include <stdbool.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics.h>

/* Spheres across the base in each direction; false if there is none. */
static bool count_across(const struct fill *f, double spacing,
                         size_t across[2]) {
  for (int k = 0; k < 2; k++) {
    /* 1 m / 0.25 m is 4 whatever the rounding */
    double fit = floor(f->base[k] / spacing * (1 + 1e-12));
    if (f->centred) /* one in a narrow tube, too */
      fit = fmax(fit, 1);
    if (fit < 1 || fit > 1e6)
      return false;
    across[k] = (size_t)fit;
  }
  return true;
}

/* Parts of a place that a sphere needs one of, along each side. */
enum { MOST_PARTS = 100 };

static size_t parts_of(double largest, double radius) {
  const double fit = floor(largest / radius * (1 + 1e-12));
  return (size_t)fmin(fit, MOST_PARTS);
}

/* The place of the grid that spheres of one size are being put into. */
struct place {
  size_t number, used, room; /* parts used, and parts that fit */
};

/* The number of the place that has the next part, and which it is. */
static size_t take_part(struct place *p, size_t m, size_t *places,
                        size_t part[3]) {
  if (p->used == p->room)
    *p = (struct place){.number = (*places)++, .room = m * m * m};
  part[0] = p->used % m;
  part[1] = p->used / m % m;
  part[2] = p->used / (m * m);
  p->used++;
  return p->number;
}

/* Whether a sphere of radius r stays within the walls, wherever within `more`
   of its place on each axis it is put: the room is convex, so that corners
   decide. */
static bool fits(const struct scene *s, const double x[3], double r,
                 double more) {
  for (int corner = 0; corner < 8; corner++) {
    double at[3];
    for (int k = 0; k < 3; k++)
      at[k] = x[k] + (corner >> k & 1 ? more : 0);
    for (size_t w = 0; s && w < s->walls_count; w++)
      if (wall_distance(&s->walls[w], at) < r * (1 - 1e-9))
        return false;
  }
  return true;
}

/* Layers in a row without a place for a sphere, after which there is none. */
enum { EMPTY_LAYERS = 1000 };

int fill_grid_of(const struct fill *f, const struct scene *s, struct bed *b) {
  const double radius = gsl_stats_max(b->r, 1, b->n), spacing = 2.5 * radius;
  const double jitter = f->jitter * radius;
  size_t across[2];
  double low[2];
  if (!count_across(f, spacing, across))
    return GSL_EINVAL;
  for (int k = 0; k < 2; k++) {
    low[k] = f->origin[k];
    if (f->centred) /* with half of the displacement */
      low[k] += (f->base[k] - (double)across[k] * spacing - jitter) / 2;
  }
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  gsl_rng_set(rng, (unsigned long)f->seed);
  const size_t layer = across[0] * across[1];
  struct place open[MOST_PARTS + 1] = {{0}};
  size_t places = 0, last = 0, i = 0; /* last: places when a sphere fitted */
  while (i < b->n && places <= last + EMPTY_LAYERS * layer) {
    const size_t m = parts_of(radius, b->r[i]);
    size_t part[3];
    const size_t at = take_part(&open[m], m, &places, part);
    const size_t in_layer = at % layer;
    const double own = (double)m;
    double *x = b->x + 3 * i;
    x[0] = low[0] +
           ((double)(in_layer % across[0]) + ((double)part[0] + 0.5) / own) *
               spacing;
    x[1] = low[1] +
           ((double)(in_layer / across[0]) + ((double)part[1] + 0.5) / own) *
               spacing;
    x[2] = f->drop +
           ((double)(at / layer) + ((double)part[2] + 0.5) / own) * spacing;
    if (!fits(s, x, b->r[i], jitter / own))
      continue;
    last = places;
    for (int k = 0; k < 3; k++)
      x[k] += f->jitter * radius / own * gsl_rng_uniform(rng);
    i++;
  }
  gsl_rng_free(rng);
  return i == b->n ? GSL_SUCCESS : GSL_EINVAL;
}

int fill_grid(const struct fill *f, struct bed *b) {
  struct bed full;
  int status = bed_alloc(&full, f->count);
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < full.n; i++) {
    full.r[i] = f->radius;
    full.m[i] = f->mass;
  }
  status = fill_grid_of(f, NULL, &full);
  if (status != GSL_SUCCESS) {
    bed_free(&full);
    return status;
  }
  *b = full;
  return GSL_SUCCESS;
}
