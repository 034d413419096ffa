/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/network.h"

#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/periodic.h"

void network_free(struct network *w) {
  free(w->at);
  *w = (struct network){0};
}

/* The law: u, velocity of the sphere less that of the other body; spin, sum of
   lever arm times angular velocity of both. */
static void set_forces(struct network_contact *c, const struct scene *s,
                       const double u[3], const double spin[3]) {
  double t[3];
  if (c->gap > s->law.lmax)
    return;
  const double rate = contact_tangent(c->n, u, spin, t);
  c->normal = contact_normal(&s->law, c->gap, rate);
  if (scene_has_friction(s))
    contact_friction(&s->law, c->gap, t, c->friction);
}

static void set_pair(struct network_contact *c, const struct scene *s,
                     const struct bed *b, size_t i, size_t j) {
  double u[3], spin[3] = {0};
  *c = (struct network_contact){.i = i, .j = j, .counts = true};
  vec3_sub(b->x + 3 * i, b->x + 3 * j, c->n);
  periodic_nearest(s->period, c->n);
  const double d = vec3_norm(c->n);
  for (int k = 0; k < 3; k++)
    c->n[k] /= d;
  c->gap = d - b->r[i] - b->r[j];
  vec3_sub(b->v + 3 * i, b->v + 3 * j, u);
  if (scene_has_rotation(s)) {
    vec3_axpy(contact_arm(&s->law, b->r[i], c->gap), b->w + 3 * i, spin);
    vec3_axpy(contact_arm(&s->law, b->r[j], c->gap), b->w + 3 * j, spin);
  }
  set_forces(c, s, u, spin);
}

static void set_wall(struct network_contact *c, const struct scene *s,
                     const struct bed *b, size_t i, size_t k, double gap) {
  double spin[3] = {0};
  *c = (struct network_contact){
      .i = i, .j = k, .wall = true, .counts = true, .gap = gap};
  wall_nearest(&s->walls[k], b->x + 3 * i, c->n);
  for (int a = 0; a < 3; a++)
    c->n[a] = -c->n[a];
  if (scene_has_rotation(s))
    vec3_axpy(contact_arm(&s->law, b->r[i], gap), b->w + 3 * i, spin);
  set_forces(c, s, b->v + 3 * i, spin);
}

static double wall_gap(const struct scene *s, const struct bed *b, size_t i,
                       size_t k) {
  return wall_distance(&s->walls[k], b->x + 3 * i) - b->r[i];
}

static bool both_fixed(const struct bed *b, size_t i, size_t j) {
  return bed_is_fixed(b, i) && bed_is_fixed(b, j);
}

static size_t count_walls(const struct scene *s, const struct bed *b,
                          double reach) {
  size_t count = 0;
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < s->walls_count; k++)
      count += wall_gap(s, b, i, k) <= reach;
  return count;
}

int network_find(struct network *w, const struct scene *s, const struct bed *b,
                 double reach) {
  struct neighbors near = {0};
  network_free(w);
  const int status =
      periodic_find(&near, b->n, b->x, 3, b->r, reach, s->period);
  if (status != GSL_SUCCESS) {
    neighbors_free(&near);
    return status;
  }
  const double wall_reach = GSL_MAX(reach, s->law.lmax);
  const size_t all = near.count + count_walls(s, b, wall_reach);
  w->at = malloc((all + 1) * sizeof *w->at);
  if (!w->at) {
    neighbors_free(&near);
    return GSL_ENOMEM;
  }
  w->spheres = b->n;
  w->walls = s->walls_count;
  memcpy(w->period, s->period, sizeof w->period);
  bool apart = true;
  for (size_t p = 0; p < near.count; p++) {
    if (both_fixed(b, near.i[p], near.j[p]))
      continue;
    struct network_contact *c = &w->at[w->count++];
    set_pair(c, s, b, near.i[p], near.j[p]);
    apart = apart && isfinite(c->n[0]); /* 0/0 where two centres are one */
  }
  neighbors_free(&near);
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < s->walls_count; k++) {
      const double gap = wall_gap(s, b, i, k);
      if (gap <= wall_reach && !bed_is_fixed(b, i))
        set_wall(&w->at[w->count++], s, b, i, k, gap);
    }
  assert(w->count <= all);
  if (!apart)
    network_free(w);
  return apart ? GSL_SUCCESS : GSL_EDOM;
}

void network_mark(struct network *w, double gap, double force) {
  for (size_t p = 0; p < w->count; p++) {
    struct network_contact *c = &w->at[p];
    c->counts = force > 0 ? c->normal >= force : c->gap <= gap;
  }
}

void network_point(const struct network_contact *c, const struct bed *b,
                   double x[3]) {
  memcpy(x, b->x + 3 * c->i, 3 * sizeof *x);
  vec3_axpy(-(b->r[c->i] + c->gap / 2), c->n, x);
}

void network_degrees(const struct network *w, const bool *without,
                     size_t *degree, size_t *with_spheres) {
  memset(degree, 0, w->spheres * sizeof *degree);
  memset(with_spheres, 0, w->spheres * sizeof *with_spheres);
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    if (!c->counts ||
        (without && (without[c->i] || (!c->wall && without[c->j]))))
      continue;
    degree[c->i]++;
    if (c->wall)
      continue;
    degree[c->j]++;
    with_spheres[c->i]++;
    with_spheres[c->j]++;
  }
}

/* Partners of the spheres by the contacts that count: sphere i's are
   partner[start[i]] ... partner[start[i + 1] - 1]. start: spheres + 2. */
static void list_partners(const struct network *w, size_t *start,
                          size_t *partner) {
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    start[c->i + 2] += c->counts && !c->wall;
    if (!c->wall)
      start[c->j + 2] += c->counts;
  }
  for (size_t k = 2; k < w->spheres + 2; k++)
    start[k] += start[k - 1];
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    if (!c->counts || c->wall)
      continue;
    partner[start[c->i + 1]++] = c->j;
    partner[start[c->j + 1]++] = c->i;
  }
}

/* Each sphere is taken out once, and its partners looked at then: a chain of n
   goes in n steps, not in n rounds. */
int network_rattlers(const struct network *w, size_t least, const bool *fixed,
                     bool *rattler) {
  const size_t n = w->spheres;
  size_t *degree = calloc(4 * n + 2 * w->count + 3, sizeof *degree);
  if (!degree)
    return GSL_ENOMEM;
  size_t *with_spheres = degree + n, *start = with_spheres + n;
  size_t *partner = start + n + 2, *out = partner + 2 * w->count; /* a stack */
  network_degrees(w, NULL, degree, with_spheres);
  list_partners(w, start, partner);
  size_t waiting = 0;
  for (size_t i = 0; i < n; i++) {
    rattler[i] = degree[i] < least && !(fixed && fixed[i]);
    if (rattler[i])
      out[waiting++] = i;
  }
  while (waiting) {
    const size_t i = out[--waiting];
    for (size_t q = start[i]; q < start[i + 1]; q++) {
      const size_t j = partner[q];
      if (rattler[j] || --degree[j] >= least || (fixed && fixed[j]))
        continue;
      rattler[j] = true;
      out[waiting++] = j;
    }
  }
  free(degree);
  return GSL_SUCCESS;
}

void network_net_force(const struct network *w, const struct scene *s,
                       const struct bed *b, double *force) {
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < 3; k++)
      force[3 * i + k] = b->m[i] * s->gravity[k];
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    vec3_axpy(c->normal, c->n, force + 3 * c->i);
    vec3_axpy(1, c->friction, force + 3 * c->i);
    if (c->wall)
      continue;
    vec3_axpy(-c->normal, c->n, force + 3 * c->j);
    vec3_axpy(-1, c->friction, force + 3 * c->j);
  }
}

void network_wall_load(const struct network *w, size_t k, double load[3]) {
  load[0] = load[1] = load[2] = 0;
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    if (!c->wall || c->j != k)
      continue;
    vec3_axpy(-c->normal, c->n, load);
    vec3_axpy(-1, c->friction, load);
  }
}

size_t network_fabric(const struct network *w, const struct bed *b,
                      const double box[6], double fabric[6]) {
  static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  size_t count = 0;
  for (int k = 0; k < 6; k++)
    fabric[k] = 0;
  for (size_t p = 0; p < w->count; p++) {
    const struct network_contact *c = &w->at[p];
    double x[3];
    network_point(c, b, x);
    if (!c->counts || c->wall || (box && !periodic_in_box(w->period, box, x)))
      continue;
    count++;
    for (int k = 0; k < 6; k++)
      fabric[k] += c->n[row[k]] * c->n[column[k]];
  }
  for (int k = 0; k < 6 && count; k++)
    fabric[k] /= (double)count;
  return count;
}

double network_anisotropy(const double fabric[6]) {
  const double mean = (fabric[0] + fabric[1] + fabric[2]) / 3;
  double sum = 0;
  for (int k = 0; k < 3; k++)
    sum += gsl_pow_2(fabric[k] - mean) + 2 * gsl_pow_2(fabric[k + 3]);
  return sqrt(1.5 * sum);
}
