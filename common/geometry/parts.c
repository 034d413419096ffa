/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hoshen and Kopelman, Phys. Rev. B 14 (1976) 3438, with runs in the place of
   cells. A run gets a label of its own, and the sets of two labels are united
   where two runs of one kind meet, in the row before or in the layer before.
   After each layer a set that has no run in it, nor in the first layer if the
   last one meets that, is complete: it is counted, and the labels of the others
   begin at 0 again. */
#include "geometry/parts.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

/* Equal cells of a row, up to the one before end. */
struct run {
  size_t end, label;
};

struct layer {
  size_t count, size, *first; /* first[j]: the first run of row j; ny + 1 */
  struct run *run;
  bool *solid; /* is the first run of row j */
};

struct set {
  size_t parent; /* another label of the set; its own: the root */
  size_t renamed;
  bool solid;
};

static const size_t NO_NAME = SIZE_MAX;

struct parts {
  size_t nx, ny, row; /* rows of the layer in work */
  bool around[3];
  struct layer before, now;
  struct layer bottom; /* the first one, if the last one meets it */
  bool any;            /* a layer before */
  size_t labels, size;
  struct set *set;
  size_t complete[2], open[2];
};

static int layer_alloc(struct layer *l, size_t ny) {
  l->first = calloc(ny + 1, sizeof *l->first);
  l->solid = calloc(ny, sizeof *l->solid);
  return l->first && l->solid ? GSL_SUCCESS : GSL_ENOMEM;
}

static void layer_free(struct layer *l) {
  free(l->first);
  free(l->solid);
  free(l->run);
}

int parts_open(struct parts **out, size_t nx, size_t ny, const bool around[3]) {
  struct parts *p = calloc(1, sizeof *p);
  if (!p)
    return GSL_ENOMEM;
  p->nx = nx;
  p->ny = ny;
  memcpy(p->around, around, sizeof p->around);
  if (layer_alloc(&p->before, ny) != GSL_SUCCESS ||
      layer_alloc(&p->now, ny) != GSL_SUCCESS ||
      layer_alloc(&p->bottom, ny) != GSL_SUCCESS) {
    parts_close(p);
    return GSL_ENOMEM;
  }
  *out = p;
  return GSL_SUCCESS;
}

void parts_close(struct parts *p) {
  if (!p)
    return;
  layer_free(&p->before);
  layer_free(&p->now);
  layer_free(&p->bottom);
  free(p->set);
  free(p);
}

static size_t root(struct parts *p, size_t label) {
  while (p->set[label].parent != label) {
    p->set[label].parent = p->set[p->set[label].parent].parent;
    label = p->set[label].parent;
  }
  return label;
}

static int add_run(struct parts *p, size_t end, bool solid) {
  struct layer *l = &p->now;
  if (l->count == l->size) {
    const size_t size = 2 * l->size + 64;
    struct run *run = realloc(l->run, size * sizeof *run);
    if (!run)
      return GSL_ENOMEM;
    l->run = run;
    l->size = size;
  }
  if (p->labels == p->size) {
    const size_t size = 2 * p->size + 64;
    struct set *set = realloc(p->set, size * sizeof *set);
    if (!set)
      return GSL_ENOMEM;
    p->set = set;
    p->size = size;
  }
  p->set[p->labels] = (struct set){.parent = p->labels, .solid = solid};
  l->run[l->count++] = (struct run){end, p->labels++};
  return GSL_SUCCESS;
}

static void unite(struct parts *p, size_t a, size_t b) {
  const size_t x = root(p, a), y = root(p, b);
  p->set[x > y ? x : y].parent = x > y ? y : x;
}

/* Unites the runs of row j of a layer with those of one kind that they meet in
   row i of another. */
static void meet(struct parts *p, const struct layer *l, size_t j,
                 const struct layer *other, size_t i) {
  size_t a = l->first[j], b = other->first[i];
  const size_t a_end = l->first[j + 1], b_end = other->first[i + 1];
  bool same = l->solid[j] == other->solid[i];
  while (a < a_end && b < b_end) {
    if (same)
      unite(p, l->run[a].label, other->run[b].label);
    /* the kinds alternate along both rows */
    const size_t a_at = l->run[a].end, b_at = other->run[b].end;
    a += a_at <= b_at;
    b += b_at <= a_at;
    same = a_at == b_at ? same : !same;
  }
}

/* Gives the sets of a layer's runs new names, those that have none yet. */
static void rename_runs(struct parts *p, struct layer *l, size_t *names) {
  for (size_t r = 0; r < l->count; r++) {
    const size_t k = root(p, l->run[r].label);
    if (p->set[k].renamed == NO_NAME) {
      p->set[k].renamed = (*names)++;
      p->open[p->set[k].solid]++;
    }
    l->run[r].label = p->set[k].renamed;
  }
}

/* What kind the renamed sets of a layer are. */
static void tell_kinds(struct parts *p, const struct layer *l) {
  for (size_t j = 0; j < p->ny; j++)
    for (size_t r = l->first[j]; r < l->first[j + 1]; r++)
      p->set[l->run[r].label].solid = l->solid[j] == !((r - l->first[j]) & 1);
}

/* Keeps the first layer. */
static int copy_layer(struct layer *to, const struct layer *from, size_t ny) {
  to->run = calloc(from->count, sizeof *to->run);
  if (!to->run)
    return GSL_ENOMEM;
  to->count = to->size = from->count;
  memcpy(to->run, from->run, from->count * sizeof *to->run);
  memcpy(to->first, from->first, (ny + 1) * sizeof *to->first);
  memcpy(to->solid, from->solid, ny * sizeof *to->solid);
  return GSL_SUCCESS;
}

/* The layer is complete: the sets that go on are those with a run in it, or in
   the first one. */
static int end_layer(struct parts *p) {
  for (size_t k = 0; k < p->labels; k++)
    p->set[k].renamed = NO_NAME;
  size_t names = 0;
  p->open[0] = p->open[1] = 0;
  rename_runs(p, &p->now, &names);
  rename_runs(p, &p->bottom, &names);
  for (size_t k = 0; k < p->labels; k++)
    if (p->set[k].parent == k && p->set[k].renamed == NO_NAME)
      p->complete[p->set[k].solid]++;
  tell_kinds(p, &p->now);
  tell_kinds(p, &p->bottom);
  for (size_t k = 0; k < names; k++)
    p->set[k].parent = k;
  p->labels = names;
  if (p->around[2] && !p->any &&
      copy_layer(&p->bottom, &p->now, p->ny) != GSL_SUCCESS)
    return GSL_ENOMEM;
  const struct layer swap = p->before;
  p->before = p->now;
  p->now = swap;
  p->now.count = 0;
  p->row = 0;
  p->any = true;
  return GSL_SUCCESS;
}

int parts_row(struct parts *p, const bool *solid) {
  struct layer *l = &p->now;
  const size_t j = p->row;
  l->first[j] = l->count;
  l->solid[j] = solid[0];
  for (size_t i = 1; i <= p->nx; i++)
    if ((i == p->nx || solid[i] != solid[i - 1]) &&
        add_run(p, i, solid[i - 1]) != GSL_SUCCESS)
      return GSL_ENOMEM;
  l->first[j + 1] = l->count;
  if (p->around[0] && solid[0] == solid[p->nx - 1])
    unite(p, l->run[l->first[j]].label, l->run[l->count - 1].label);
  if (j > 0)
    meet(p, l, j, l, j - 1);
  if (p->around[1] && j + 1 == p->ny)
    meet(p, l, j, l, 0);
  if (p->any)
    meet(p, l, j, &p->before, j);
  if (++p->row == p->ny)
    return end_layer(p);
  return GSL_SUCCESS;
}

void parts_count(struct parts *p, size_t count[2]) {
  if (p->around[2] && p->any) {
    for (size_t j = 0; j < p->ny; j++)
      meet(p, &p->before, j, &p->bottom, j);
    p->open[0] = p->open[1] = 0;
    for (size_t k = 0; k < p->labels; k++)
      p->open[p->set[k].solid] += p->set[k].parent == k;
  }
  for (int k = 0; k < 2; k++)
    count[k] = p->complete[k] + p->open[k];
}
