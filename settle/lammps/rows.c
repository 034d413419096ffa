/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "rows.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "dynamics/rates.h"
#include "dynamics/scale.h"

struct rows {
  struct contact_list list;
  const struct kernel *kernel;
  struct contact_part part;
  size_t incoming[2]; /* one part: no pair comes in */
  uint32_t *i, *j;    /* pairs that may come near, in the order of near */
  size_t *first;
  uint32_t *fixed; /* ascending */
  size_t fixed_count;
};

int rows_alloc(struct rows **out, const struct scene *s, bool equal) {
  struct rows *r = calloc(1, sizeof *r);
  if (!r)
    return GSL_ENOMEM;
  struct contact_list *l = &r->list;
  l->law = s->law;
  l->has = contact_features_of(s, equal);
  l->stride = l->has.rotation ? ROW_SPIN : ROW_PLAIN;
  memcpy(l->gravity, s->gravity, sizeof l->gravity);
  l->walls_count = s->walls_count;
  l->walls = malloc((s->walls_count + 1) * sizeof *l->walls);
  l->cylinders = s->walls_count && s->walls[s->walls_count - 1].radius > 0;
  l->threads = 1;
  l->part = &r->part;
  l->incoming = r->incoming;
  r->kernel = kernel_select(NULL);
  if (!l->walls) {
    rows_free(r);
    return GSL_ENOMEM;
  }
  if (s->walls_count)
    memcpy(l->walls, s->walls, s->walls_count * sizeof *l->walls);
  *out = r;
  return GSL_SUCCESS;
}

static void forget_layout(struct rows *r) {
  struct contact_list *l = &r->list;
  void *arrays[] = {l->radius,   l->mass,    l->push,       l->turn,
                    l->near.i,   l->near.j,  l->near.first, l->wall_first,
                    l->wall_row, l->wall_id, r->part.sums,  r->fixed,
                    r->i,        r->j,       r->first};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
    free(arrays[k]);
}

void rows_free(struct rows *r) {
  if (!r)
    return;
  forget_layout(r);
  free(r->list.walls);
  free(r);
}

size_t rows_stride(const struct rows *r) {
  return r->list.stride;
}

static void *copied(const void *from, size_t count, size_t size) {
  void *to = malloc((count + 1) * size);
  if (to && count)
    memcpy(to, from, count * size);
  return to;
}

int rows_set(struct rows *r, const struct rows_layout *layout) {
  const size_t n = layout->count, all = n + layout->ghosts;
  const size_t pairs = layout->first[n];
  struct contact_list *l = &r->list;
  forget_layout(r);
  size_t room = 1;
  while (room < n)
    room *= 2;
  l->rows = l->moving = n;
  l->ghosts = layout->ghosts;
  l->radius = copied(layout->radius, all, sizeof *l->radius);
  l->mass = copied(layout->mass, all, sizeof *l->mass);
  l->push = malloc((n + 1) * sizeof *l->push);
  l->turn = malloc((n + 1) * sizeof *l->turn);
  r->i = copied(layout->i, pairs, sizeof *r->i);
  r->j = copied(layout->j, pairs, sizeof *r->j);
  r->first = copied(layout->first, n + 1, sizeof *r->first);
  l->near.i = malloc((pairs + 1) * sizeof *l->near.i);
  l->near.j = malloc((pairs + 1) * sizeof *l->near.j);
  l->near.first = calloc(n + 1, sizeof *l->near.first);
  l->near.count = 0;
  r->fixed = copied(layout->fixed, layout->fixed_count, sizeof *r->fixed);
  r->fixed_count = layout->fixed_count;
  l->wall_first = malloc((n + 1) * sizeof *l->wall_first);
  l->wall_row = malloc((n * l->walls_count + 1) * sizeof *l->wall_row);
  l->wall_id = malloc((n * l->walls_count + 1) * sizeof *l->wall_id);
  r->part =
      (struct contact_part){.from = 0,
                            .to = n,
                            .sums = calloc(room * CONTACT_SUM, sizeof(double)),
                            .mask = room - 1};
  if (!l->radius || !l->mass || !l->push || !l->turn || !l->near.i ||
      !l->near.j || !l->near.first || !l->wall_first || !l->wall_row ||
      !l->wall_id || !r->part.sums || !r->fixed || !r->i || !r->j || !r->first)
    return GSL_ENOMEM;
  l->wall_contacts = 0;
  for (size_t i = 0, fixed = 0; i < n; i++) {
    contact_list_mass(l, i);
    l->wall_first[i] = l->wall_contacts;
    if (fixed < r->fixed_count && r->fixed[fixed] == i) {
      fixed++;
      continue;
    }
    for (size_t w = 0; w < l->walls_count; w++)
      if (wall_distance(&l->walls[w], layout->x + 3 * i) - l->radius[i] <=
          l->law.lmax + layout->skin) {
        l->wall_row[l->wall_contacts] = (uint32_t)i;
        l->wall_id[l->wall_contacts++] = (uint32_t)w;
      }
  }
  l->wall_first[n] = l->wall_contacts;
  return GSL_SUCCESS;
}

void rows_near(struct rows *r, const double y[], double skin) {
  struct contact_list *l = &r->list;
  const double reach = l->law.lmax + skin;
  size_t count = 0;
  for (size_t row = 0; row < l->rows; row++) {
    l->near.first[row] = count;
    for (size_t p = r->first[row]; p < r->first[row + 1]; p++) {
      const uint32_t i = r->i[p], j = r->j[p];
      const double most = l->radius[i] + l->radius[j] + reach;
      double way[3];
      vec3_sub(y + i * l->stride + ROW_X, y + j * l->stride + ROW_X, way);
      l->near.i[count] = i;
      l->near.j[count] = j;
      count += vec3_dot(way, way) <= most * most;
    }
  }
  l->near.first[l->rows] = l->near.count = count;
}

size_t rows_contacts(const struct rows *r) {
  return contact_list_size(&r->list);
}

int rows_rates(const struct rows *r, const double y[], double f[]) {
  const size_t stride = r->list.stride;
  const int status =
      rates_evaluate(&r->list, r->kernel, y, &(struct rates_to){.dydt = f});
  for (size_t k = 0; k < r->fixed_count; k++)
    memset(f + r->fixed[k] * stride, 0, stride * sizeof *f);
  return status;
}

int rows_stage(const struct rows *r, const double y[],
               const struct stage *stage, double out[]) {
  const size_t stride = r->list.stride;
  const int status = rates_evaluate(
      &r->list, r->kernel, y, &(struct rates_to){.stage = stage, .out = out});
  for (size_t k = 0; k < r->fixed_count; k++) {
    const size_t at = r->fixed[k] * stride;
    memcpy(out + at, y + at, stride * sizeof *out);
  }
  return status;
}

void rows_weights(const struct rows *r, double weight[]) {
  contact_list_scale(&r->list, weight);
  for (size_t i = 0; i < r->list.rows * r->list.stride; i++)
    weight[i] = 1 / weight[i];
}
