/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/fill.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include "geometry/periodic.h"

const struct fill_named fill_ways[] = {
    [FILL_GRID] = {"grid", "layers of a square grid"},
    [FILL_RANDOM] = {"random", "random places without overlaps"},
    [FILL_RAIN] = {"rain", "falling already, to arrive one by one at --rate"},
    {0}};

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

/* --- random places ---------------------------------------------------------*/

/* Spheres that have places, in lists by cells. Spheres between R/2^(k+1) and
   R/2^k, R the largest radius, are in cells 2R/2^k wide. Since the largest come
   first, all that the next one can overlap are in the 27 cells around it of
   each such level. Cells share lists where their hashes do: that costs tries,
   and changes nothing. */
struct crowd {
  const struct bed *b;
  const double *period;
  double largest;
  int levels;     /* in use */
  size_t lists;   /* a power of two */
  size_t *first;  /* of each list, the sphere's index + 1; 0: none */
  size_t *next;   /* of each sphere, the same */
  size_t *sorted; /* spheres by radius, ascending */
};

static void crowd_free(struct crowd *c) {
  free(c->first);
  free(c->next);
  free(c->sorted);
}

static int crowd_alloc(struct crowd *c, const struct bed *b,
                       const double period[3]) {
  *c = (struct crowd){.b = b, .period = period, .lists = 1};
  while (c->lists < 2 * b->n)
    c->lists *= 2;
  c->first = calloc(c->lists, sizeof *c->first);
  c->next = calloc(b->n, sizeof *c->next);
  c->sorted = calloc(b->n, sizeof *c->sorted);
  if (!c->first || !c->next || !c->sorted) {
    crowd_free(c);
    return GSL_ENOMEM;
  }
  gsl_sort_index(c->sorted, b->r, 1, b->n);
  c->largest = b->r[c->sorted[b->n - 1]];
  return GSL_SUCCESS;
}

static void crowd_empty(struct crowd *c) {
  for (size_t k = 0; k < c->lists; k++)
    c->first[k] = 0;
  c->levels = 0;
}

/* The list of the cell that is `shift` cells away from that of x. */
static size_t list_of(const struct crowd *c, int level, const double x[3],
                      const int shift[3]) {
  static const uint64_t primes[3] = {73856093, 19349663, 83492791};
  uint64_t hash = (uint64_t)level * 2654435761;
  for (int k = 0; k < 3; k++) {
    const double period = c->period[k], least = ldexp(2 * c->largest, -level);
    const double cells = period > 0 ? floor(period / least) : 0;
    const double width = cells > 0 ? period / cells : least;
    double at = floor(x[k] / width) + shift[k];
    if (cells > 0)
      at -= cells * floor(at / cells);
    at = fmin(fmax(at, -1e18), 1e18); /* cells out there share their list */
    hash ^= (uint64_t)(int64_t)at * primes[k];
  }
  return (size_t)(hash ^ hash >> 32) & (c->lists - 1);
}

static bool is_free(const struct crowd *c, const double x[3], double r) {
  for (int level = 0; level < c->levels; level++)
    for (int cell = 0; cell < 27; cell++) {
      const int shift[3] = {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
      size_t i = c->first[list_of(c, level, x, shift)];
      for (; i; i = c->next[i - 1]) {
        double u[3];
        vec3_sub(c->b->x + 3 * (i - 1), x, u);
        periodic_nearest(c->period, u);
        if (vec3_norm(u) < r + c->b->r[i - 1])
          return false;
      }
    }
  return true;
}

static void crowd_add(struct crowd *c, size_t i) {
  const int here[3] = {0, 0, 0};
  int level = 0;
  while (ldexp(c->largest, -level - 1) >= c->b->r[i])
    level++;
  const size_t list = list_of(c, level, c->b->x + 3 * i, here);
  c->next[i] = c->first[list];
  c->first[list] = i + 1;
  c->levels = level + 1;
}

/* Volume of the spheres by the area of the base, or of the tube in it. */
static double solid_height(const struct fill *f, const struct bed *b) {
  double cubes = 0;
  for (size_t i = 0; i < b->n; i++)
    cubes += gsl_pow_3(b->r[i]);
  return 4 * M_PI / 3 * cubes /
         (f->base[0] * f->base[1] * (f->centred ? M_PI / 4 : 1));
}

/* One try across the base; false if a sphere of radius r is too wide for it. */
static bool throw_across(const struct fill *f, const double period[3],
                         gsl_rng *rng, double r, double x[3]) {
  for (int k = 0; k < 2; k++) {
    const double edge = period[k] > 0 ? 0 : r, room = f->base[k] - 2 * edge;
    if (room < -1e-9 * r)
      return false;
    x[k] = f->origin[k] + edge + fmax(room, 0) * gsl_rng_uniform(rng);
  }
  return true;
}

/* Share of the room that is filled at first; tries after which the height
   grows, and after which there is no place. */
static const double random_share = 0.2;
enum { TRIES = 300, MOST_TRIES = 60000 };

static const double no_period[3] = {0, 0, 0};

int fill_random(const struct fill *f, const struct scene *s, struct bed *b) {
  struct crowd c;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  int status = crowd_alloc(&c, b, s ? s->period : no_period);
  if (status != GSL_SUCCESS) {
    gsl_rng_free(rng);
    return status;
  }
  gsl_rng_set(rng, (unsigned long)f->seed);
  double height = fmax(solid_height(f, b) / random_share, 2 * c.largest);
  size_t left = b->n, tries = 0;
  while (left && status == GSL_SUCCESS) {
    const size_t i = c.sorted[left - 1];
    const double r = b->r[i];
    double *x = b->x + 3 * i;
    if (tries == MOST_TRIES || !throw_across(f, c.period, rng, r, x)) {
      status = GSL_EINVAL;
      break;
    }
    x[2] = f->drop + r + (height - 2 * r) * gsl_rng_uniform(rng);
    if (fits(s, x, r, 0) && is_free(&c, x, r)) {
      crowd_add(&c, i);
      left--;
      tries = 0;
    } else if (++tries % TRIES == 0) {
      height += c.largest;
    }
  }
  crowd_free(&c);
  gsl_rng_free(rng);
  return status;
}

/* Rain whose spheres are a height d apart at the top. GSL_EINVAL if one finds
   no place. */
static int rain_at(const struct fill *f, const struct scene *s, double d,
                   gsl_rng *rng, struct crowd *c, struct bed *b) {
  const double g = -s->gravity[2], n = (double)b->n;
  const double rate = f->rate > 0 ? f->rate : sqrt(g * n / d);
  const double speed = g * n / rate + rate * d;
  if (!isfinite(speed * n / rate))
    return GSL_EINVAL;
  gsl_rng_set(rng, (unsigned long)f->seed);
  crowd_empty(c);
  for (size_t left = b->n; left; left--) {
    const size_t i = c->sorted[left - 1];
    const double t = (double)(i + 1) / rate, r = b->r[i];
    double *x = b->x + 3 * i;
    x[2] = f->drop + r + (speed - 0.5 * g * t) * t;
    b->v[3 * i + 2] = -(speed - g * t);
    bool placed = false;
    for (size_t tries = 0; !placed && tries < MOST_TRIES / 10; tries++) {
      if (!throw_across(f, c->period, rng, r, x))
        return GSL_EINVAL;
      placed = fits(s, x, r, 0) && is_free(c, x, r);
    }
    if (!placed)
      return GSL_EINVAL;
    crowd_add(c, i);
  }
  return GSL_SUCCESS;
}

int fill_rain(const struct fill *f, const struct scene *s, struct bed *b) {
  if (!(s->gravity[2] < 0 && s->gravity[0] == 0 && s->gravity[1] == 0))
    return GSL_EDOM;
  struct crowd c;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  int status = crowd_alloc(&c, b, s->period);
  if (status != GSL_SUCCESS) {
    gsl_rng_free(rng);
    return status;
  }
  /* one above the other at last, where all that is in the way are walls */
  const double widest = 2 * c.largest;
  double d = fmin(solid_height(f, b) / (double)b->n / random_share, widest);
  while ((status = rain_at(f, s, d, rng, &c, b)) == GSL_EINVAL && d < widest)
    d = fmin(1.5 * d, widest);
  crowd_free(&c);
  gsl_rng_free(rng);
  return status;
}
