/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each pass moves the two spheres of a contact that is too deep along its
   normal, the lighter one further, as if each contact were alone, times a share
   that falls with the number of contacts that push the same sphere. A sum over
   c contacts of a push by 1/2 overshoots by at most c, so a share below 2/c
   converges; 1.5/c does so without ringing, and 1 is exact for a single one.
   The positions of a pass are those before it, so that the order of spheres
   does not matter. */
#include "model/relax.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/periodic.h"
#include "geometry/vec3.h"
#include "model/bed_check.h"

/* Of the smaller radius: how much further than enough they are pushed, since
   the last of the way is slow; and how far pairs are listed. */
static const double slack = 0.02, skin = 0.3;

struct relax {
  const struct scene *scene;
  struct bed *bed;
  double unit; /* g r, energy of a unit of mass (J/kg) */
  double deep, enough;
  struct neighbors near;
  double reach;  /* of the list (m) */
  double moved;  /* since it was made, at most (m) */
  double *push;  /* 3n */
  size_t *count; /* n, contacts that push */
};

/* Gap of a contact that stores x m g r, m being the mass of its lighter sphere:
   0 where one that touches stores more. */
static double gap_of(const struct relax *k, double x, double mass) {
  const struct contact_law *c = &k->scene->law;
  const double energy = x * mass * k->unit;
  return fmin(0, -log(c->kappa * energy / c->f0) / c->kappa);
}

/* A contact: the normal to the first sphere, its gap, and what its sphere or
   spheres have. */
struct touch {
  double n[3], gap;
  double mass;    /* of the lighter that moves */
  double radius;  /* of the smaller */
  double closest; /* least gap whatever is stored */
  double share;   /* of the first sphere in the way, the second has the rest */
};

/* Any direction, another one for another pair: two spheres in one place. */
static void any_direction(size_t i, size_t j, double n[3]) {
  const double turn = fmod((double)i * M_SQRT2 + (double)j * M_SQRT3, 1);
  const double z = 2 * fmod((double)i * M_E + (double)j * M_PI, 1) - 1;
  const double across = sqrt(1 - z * z);
  n[0] = across * cos(2 * M_PI * turn);
  n[1] = across * sin(2 * M_PI * turn);
  n[2] = z;
}

/* False for obstacles among each other. */
static bool touch_pair(const struct relax *k, size_t i, size_t j,
                       struct touch *t) {
  const struct bed *b = k->bed;
  const bool fixed[2] = {bed_is_fixed(b, i), bed_is_fixed(b, j)};
  if (fixed[0] && fixed[1])
    return false;
  vec3_sub(b->x + 3 * i, b->x + 3 * j, t->n);
  periodic_nearest(k->scene->period, t->n);
  const double d = vec3_norm(t->n), touch = b->r[i] + b->r[j];
  if (d > 0)
    for (int c = 0; c < 3; c++)
      t->n[c] /= d;
  else
    any_direction(i, j, t->n);
  t->gap = d - touch;
  t->closest = (bed_closest - 1) * touch;
  t->radius = fmin(b->r[i], b->r[j]);
  t->mass = fixed[0] || (!fixed[1] && b->m[j] < b->m[i]) ? b->m[j] : b->m[i];
  t->share = fixed[0] ? 0 : fixed[1] ? 1 : b->m[j] / (b->m[i] + b->m[j]);
  return true;
}

static bool touch_wall(const struct relax *k, size_t i, size_t wall,
                       struct touch *t) {
  const struct bed *b = k->bed;
  double normal[3];
  if (bed_is_fixed(b, i))
    return false;
  t->gap = wall_nearest(&k->scene->walls[wall], b->x + 3 * i, normal) - b->r[i];
  for (int c = 0; c < 3; c++)
    t->n[c] = -normal[c];
  t->closest = -b->r[i];
  t->radius = b->r[i];
  t->mass = b->m[i];
  t->share = 1;
  return true;
}

static bool deeper(const struct relax *k, const struct touch *t, double x) {
  return t->gap < 0 && (t->gap < gap_of(k, x, t->mass) || t->gap < t->closest);
}

/* Calls a function for each contact, j being the sphere's partner or n + the
   number of a wall. */
typedef void touch_visit(struct relax *k, size_t i, size_t j,
                         const struct touch *t, void *params);

static void visit(struct relax *k, touch_visit *f, void *params) {
  const size_t n = k->bed->n;
  struct touch t;
  for (size_t p = 0; p < k->near.count; p++)
    if (touch_pair(k, k->near.i[p], k->near.j[p], &t))
      f(k, k->near.i[p], k->near.j[p], &t, params);
  for (size_t i = 0; i < n; i++)
    for (size_t w = 0; w < k->scene->walls_count; w++)
      if (touch_wall(k, i, w, &t))
        f(k, i, n + w, &t, params);
}

static void look(struct relax *k, size_t i, size_t j, const struct touch *t,
                 void *params) {
  struct relax_report *r = params;
  if (!deeper(k, t, k->deep))
    return;
  *(j < k->bed->n ? &r->pairs : &r->walls) += 1;
  if (-t->gap > r->depth) {
    r->depth = -t->gap;
    r->sphere = i;
  }
}

static void count(struct relax *k, size_t i, size_t j, const struct touch *t,
                  void *params) {
  if (!deeper(k, t, k->enough))
    return;
  *(size_t *)params += 1;
  k->count[i]++;
  if (j < k->bed->n)
    k->count[j]++;
}

static void push(struct relax *k, size_t i, size_t j, const struct touch *t,
                 void *params) {
  (void)params;
  if (!deeper(k, t, k->enough))
    return;
  size_t most = k->count[i];
  if (j < k->bed->n)
    most = GSL_MAX(most, k->count[j]);
  const double aim = fmax(gap_of(k, k->enough, t->mass), t->closest);
  const double way =
      (aim + slack * t->radius - t->gap) * (most > 1 ? 1.5 / (double)most : 1);
  vec3_axpy(way * t->share, t->n, k->push + 3 * i);
  if (j < k->bed->n)
    vec3_axpy(way * (t->share - 1), t->n, k->push + 3 * j);
}

static int list(struct relax *k) {
  const struct bed *b = k->bed;
  k->moved = 0;
  return periodic_find(&k->near, b->n, b->x, 3, b->r, k->reach,
                       k->scene->period);
}

/* One pass; the contacts that were too deep before it. */
static int pass(struct relax *k, size_t *left) {
  struct bed *b = k->bed;
  int status = GSL_SUCCESS;
  if (2 * k->moved > k->reach)
    status = list(k);
  if (status != GSL_SUCCESS)
    return status;
  *left = 0;
  memset(k->push, 0, 3 * b->n * sizeof *k->push);
  memset(k->count, 0, b->n * sizeof *k->count);
  visit(k, count, left);
  visit(k, push, NULL);
  double furthest = 0;
  for (size_t i = 0; i < b->n; i++) {
    vec3_axpy(1, k->push + 3 * i, b->x + 3 * i);
    furthest = fmax(furthest, vec3_norm(k->push + 3 * i));
  }
  k->moved += furthest;
  return GSL_SUCCESS;
}

static int relax(struct relax *k, const double before[], size_t passes,
                 struct relax_report *r) {
  int status = list(k);
  if (status != GSL_SUCCESS)
    return status;
  visit(k, look, r);
  if (r->pairs + r->walls == 0)
    return GSL_SUCCESS;
  r->left = r->pairs + r->walls;
  while (status == GSL_SUCCESS && r->left && r->passes < passes) {
    status = pass(k, &r->left);
    r->passes++;
  }
  for (size_t i = 0; i < k->bed->n; i++) {
    double way[3];
    vec3_sub(k->bed->x + 3 * i, before + 3 * i, way);
    const double moved = vec3_norm(way);
    r->moved += moved > 0;
    r->furthest = fmax(r->furthest, moved);
  }
  return status == GSL_SUCCESS && r->left ? GSL_EMAXITER : status;
}

int relax_bed(const struct scene *s, const struct similarity *units,
              const struct relax_limits *limits, struct bed *b,
              struct relax_report *report) {
  const size_t bytes = 3 * b->n * sizeof *b->x;
  struct relax k = {.scene = s, .bed = b};
  /* g r of the paper's sphere is 0.981 m^2/s^2 */
  k.unit = 0.981 * similarity_scale(units, (struct dimension){2, -2, 0});
  k.deep = limits->deep;
  k.enough = limits->enough;
  double smallest = b->n ? b->r[0] : 0;
  for (size_t i = 1; i < b->n; i++)
    smallest = fmin(smallest, b->r[i]);
  k.reach = skin * smallest;
  k.push = malloc(bytes);
  k.count = malloc(b->n * sizeof *k.count);
  double *before = malloc(bytes);
  struct relax_report r = {0};
  int status = GSL_ENOMEM;
  if (k.push && k.count && before) {
    memcpy(before, b->x, bytes);
    status = relax(&k, before, limits->passes, &r);
    if (status != GSL_SUCCESS)
      memcpy(b->x, before, bytes);
  }
  if (status == GSL_SUCCESS || status == GSL_EMAXITER)
    *report = r;
  neighbors_free(&k.near);
  free(k.push);
  free(k.count);
  free(before);
  return status;
}
