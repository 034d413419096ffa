/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a contact list against the list that they are parts of: the marked
   rows have the same rates, near and far contacts add up to all of them, and
   what was left out could not have come within reach. Random cases are numbered
   by their seeds. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>
#include "check.h"
#include "dynamics/contact_subset.h"
#include "dynamics/islands.h"
#include "dynamics/rates.h"
#include "sample.h"

struct sample {
  struct contact_list *list;
  double *y, *rates;
};

/* n spheres in a box that presses on some of them. */
static struct sample random_sample(gsl_rng *rng, size_t n, int threads) {
  struct sample s = {0};
  struct scene scene = scene_default();
  struct bed bed;
  scene.model = (enum scene_model)(gsl_rng_get(rng) % 3);
  const double side = 0.2 * cbrt((double)n);
  if (bed_alloc(&bed, n) != GSL_SUCCESS ||
      scene_add_box(&scene, side, side) != GSL_SUCCESS)
    abort();
  const bool equal = gsl_rng_get(rng) % 2;
  for (size_t i = 0; i < n; i++) {
    bed.r[i] = equal ? 0.1 : uniform(rng, 0.05, 0.15);
    bed.m[i] = equal ? 1 : uniform(rng, 0.2, 5);
    for (size_t k = 0; k < 3; k++)
      bed.x[3 * i + k] = uniform(rng, 0, side);
  }
  CHECK(contact_list_alloc(&s.list, &scene, &bed, (size_t)threads, NULL) ==
        GSL_SUCCESS);
  const size_t stride = s.list->stride, dim = n * stride;
  s.y = numbers(dim);
  s.rates = numbers(dim);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 3; k++)
      s.y[i * stride + k] = bed.x[3 * s.list->order[i] + k];
    for (size_t k = ROW_V; k < stride; k++)
      s.y[i * stride + k] = uniform(rng, -2, 2);
  }
  CHECK(contact_list_update(s.list, s.y) == GSL_SUCCESS);
  bed_free(&bed);
  scene_free(&scene);
  return s;
}

static void sample_free(struct sample *s) {
  contact_list_free(s->list);
  free(s->y);
  free(s->rates);
}

static struct contact_list *part_of(const struct contact_list *l) {
  struct contact_list *part = NULL;
  if (contact_subset_alloc(&part, l) != GSL_SUCCESS)
    abort();
  return part;
}

static void evaluate(const struct contact_list *l, const double *y,
                     double *rates) {
  CHECK(rates_evaluate(l, kernel_select(NULL), y,
                       &(struct rates_to){.dydt = rates}) == GSL_SUCCESS);
}

/* The state of a part's rows and ghosts. */
static double *state_of(const struct contact_list *part, const double *y) {
  const size_t stride = part->stride;
  double *own = numbers((part->rows + part->ghosts) * stride);
  for (size_t a = 0; a < part->rows + part->ghosts; a++)
    memcpy(own + a * stride, y + part->order[a] * stride, stride * sizeof *own);
  return own;
}

/* Sums in another order: rounding of the sum of the forces' sizes, which for
   these beds, deep overlaps and all, is within 1e6 of each of them. */
static double worst_of(const struct contact_list *part, const double *got,
                       const double *want, double scale) {
  double worst = 0;
  for (size_t a = 0; a < part->rows; a++)
    for (size_t c = 0; c < part->stride; c++)
      worst = GSL_MAX(worst, fabs(got[a * part->stride + c] -
                                  want[part->order[a] * part->stride + c]));
  return worst / scale;
}

static double largest(const double *x, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    most = GSL_MAX(most, fabs(x[i]));
  return most;
}

static struct contact_reach everything(const double *y) {
  return (struct contact_reach){.y = y, .h = 0, .gap = 1e3};
}

/* The rows of that many marks. */
static size_t rows_of(size_t n, const bool *marked, uint32_t *rows) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (marked[i])
      rows[count++] = (uint32_t)i;
  return count;
}

static int take(struct contact_list *part, struct contact_list *from,
                const bool *marked, const struct contact_reach *reach) {
  uint32_t *rows = calloc(from->rows + 1, sizeof *rows);
  CHECK(contact_list_partners(from) == GSL_SUCCESS);
  const int status = contact_subset_rows(
      &part, 1, from, rows, rows_of(from->rows, marked, rows), reach);
  free(rows);
  return status;
}

/* Rates of the marked rows, then of some of those among them. */
static void test_rows(gsl_rng *rng, unsigned long seed) {
  gsl_rng_set(rng, seed);
  const size_t n = 1 + gsl_rng_get(rng) % 120;
  struct sample s = random_sample(rng, n, 1);
  evaluate(s.list, s.y, s.rates);
  const double scale = largest(s.rates, n * s.list->stride) + 1;
  bool *marked = calloc(n, sizeof *marked);
  const double share = uniform(rng, 0, 1);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    count += marked[i] = gsl_rng_uniform(rng) < share;
  struct contact_list *part = part_of(s.list), *deeper = part_of(s.list);
  const struct contact_reach all = everything(s.y);
  CHECK(take(part, s.list, marked, &all) == GSL_SUCCESS);
  bool ok = CHECK(part->rows == count);
  for (size_t a = 0; a < part->rows; a++)
    ok = ok && marked[part->order[a]] &&
         (a == 0 || part->order[a] > part->order[a - 1]);
  for (size_t a = part->rows; a < part->rows + part->ghosts; a++)
    ok = ok && !marked[part->order[a]];
  CHECK(ok);
  double *y = state_of(part, s.y), *rates = numbers(n * s.list->stride);
  evaluate(part, y, rates);
  CHECK_CLOSE(worst_of(part, rates, s.rates, scale), 0, 64 * DBL_EPSILON);

  bool *again = calloc(n, sizeof *again);
  for (size_t a = 0; a < part->rows; a++)
    again[a] = gsl_rng_uniform(rng) < 0.5;
  const struct contact_reach within = everything(y);
  CHECK(take(deeper, part, again, &within) == GSL_SUCCESS);
  double *z = state_of(deeper, y), *own = numbers(n * s.list->stride);
  evaluate(deeper, z, own);
  if (!CHECK_CLOSE(worst_of(deeper, own, rates, scale), 0, 64 * DBL_EPSILON))
    fprintf(stderr, "  seed %lu\n", seed);
  free(z);
  free(own);
  free(again);
  free(y);
  free(rates);
  free(marked);
  contact_list_free(part);
  contact_list_free(deeper);
  sample_free(&s);
}

/* Marked rows in two lists, of their near contacts and of the others, which add
   up. */
static void test_parts(gsl_rng *rng, unsigned long seed) {
  gsl_rng_set(rng, seed);
  const size_t n = 1 + gsl_rng_get(rng) % 120;
  struct sample s = random_sample(rng, n, 1);
  evaluate(s.list, s.y, s.rates);
  const double scale = largest(s.rates, n * s.list->stride) + 1;
  uint32_t *rows = calloc(n, sizeof *rows);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (gsl_rng_uniform(rng) < 0.4)
      rows[count++] = (uint32_t)i;
  struct contact_list *part[2] = {part_of(s.list), part_of(s.list)};
  const struct contact_reach reach[2] = {
      {.y = s.y, .h = uniform(rng, 0, 0.01), .gap = uniform(rng, -0.02, 0.1)},
      everything(s.y)};
  CHECK(contact_list_partners(s.list) == GSL_SUCCESS);
  CHECK(contact_subset_rows(part, 2, s.list, rows, count, reach) ==
        GSL_SUCCESS);
  memset(part[1]->gravity, 0, sizeof part[1]->gravity);
  double *far = numbers(count * s.list->stride),
         *rates = numbers(count * s.list->stride);
  double *y = state_of(part[1], s.y), *z = state_of(part[0], s.y);
  evaluate(part[1], y, far);
  part[0]->frozen = far;
  evaluate(part[0], z, rates);
  bool ok = CHECK_CLOSE(worst_of(part[0], rates, s.rates, scale), 0,
                        64 * DBL_EPSILON);
  /* each has what is within its own reach */
  for (size_t k = 0; k < 2; k++)
    for (size_t q = 0; q < part[k]->near.count; q++)
      ok = ok && (k == 0) == contact_subset_within(
                                 s.list, part[k]->order[part[k]->near.i[q]],
                                 part[k]->order[part[k]->near.j[q]], reach);
  if (!CHECK(ok))
    fprintf(stderr, "  seed %lu\n", seed);
  for (size_t k = 0; k < 2; k++)
    contact_list_free(part[k]);
  free(y);
  free(z);
  free(far);
  free(rates);
  free(rows);
  sample_free(&s);
}

/* Near and far contacts add up; a far one frozen gives its rates. */
static void test_split(gsl_rng *rng, unsigned long seed) {
  gsl_rng_set(rng, seed);
  const size_t n = 1 + gsl_rng_get(rng) % 120;
  struct sample s = random_sample(rng, n, 1);
  evaluate(s.list, s.y, s.rates);
  const size_t stride = s.list->stride, dim = n * stride;
  struct contact_list *near = part_of(s.list), *far = part_of(s.list);
  const struct contact_reach reach = {
      .y = s.y, .h = uniform(rng, 0, 0.01), .gap = uniform(rng, -0.02, 0.1)};
  CHECK(contact_subset_split(near, far, s.list, &reach) == GSL_SUCCESS);
  CHECK(contact_list_size(near) + contact_list_size(far) ==
        contact_list_size(s.list));
  double *frozen = numbers(dim), *rates = numbers(dim);
  memset(far->gravity, 0, sizeof far->gravity);
  evaluate(far, s.y, frozen);
  near->frozen = frozen;
  evaluate(near, s.y, rates);
  const double scale = largest(s.rates, dim) + 1;
  if (!CHECK_CLOSE(worst_of(near, rates, s.rates, scale), 0, 64 * DBL_EPSILON))
    fprintf(stderr, "  seed %lu\n", seed);
  /* the far ones keep their distance, speeds being as they are */
  for (size_t q = 0; q < far->near.count; q++) {
    const size_t i = far->near.i[q], j = far->near.j[q];
    const double *p = s.y + i * stride, *w = s.y + j * stride;
    double least = GSL_POSINF;
    for (size_t k = 0; k <= 16; k++) {
      const double t = (double)k / 16 * reach.h;
      double u[3];
      for (size_t c = 0; c < 3; c++)
        u[c] = p[c] - w[c] + t * (p[ROW_V + c] - w[ROW_V + c]);
      least = GSL_MIN(least, vec3_norm(u));
    }
    CHECK(least >= far->radius[i] + far->radius[j] + reach.gap);
  }
  free(frozen);
  free(rates);
  contact_list_free(near);
  contact_list_free(far);
  sample_free(&s);
}

/* Islands: together all marked rows, each once, ascending; nothing is within
   reach from one to another, and each holds together. */
static void test_islands(gsl_rng *rng, unsigned long seed) {
  gsl_rng_set(rng, seed);
  const size_t n = 1 + gsl_rng_get(rng) % 150;
  struct sample s = random_sample(rng, n, 1);
  bool *marked = calloc(n, sizeof *marked);
  size_t *island = calloc(n, sizeof *island), count = 0;
  const double share = uniform(rng, 0, 1);
  for (size_t i = 0; i < n; i++)
    count += marked[i] = gsl_rng_uniform(rng) < share;
  const struct contact_reach reach = {
      .y = s.y, .h = uniform(rng, 0, 0.01), .gap = uniform(rng, -0.05, 0.05)};
  struct islands k = {0};
  for (int again = 0; again < 2; again++) /* the same a second time */
    CHECK(islands_find(&k, s.list, marked, &reach) == GSL_SUCCESS);
  CHECK(k.begin[0] == 0 && k.begin[k.count] == count);
  for (size_t q = 0; q < k.count; q++) {
    CHECK(k.begin[q + 1] > k.begin[q]);
    CHECK(q == 0 || k.row[k.begin[q]] > k.row[k.begin[q - 1]]);
    for (size_t p = k.begin[q]; p < k.begin[q + 1]; p++) {
      CHECK(marked[k.row[p]] && island[k.row[p]] == 0);
      CHECK(p == k.begin[q] || k.row[p] > k.row[p - 1]);
      island[k.row[p]] = q + 1;
    }
  }
  /* colours spread over contacts until nothing changes: an island has one */
  size_t *colour = calloc(n, sizeof *colour);
  for (size_t i = 0; i < n; i++)
    colour[i] = i;
  for (bool changes = true; changes;) {
    changes = false;
    for (size_t p = 0; p < s.list->near.count; p++) {
      const size_t i = s.list->near.i[p], j = s.list->near.j[p];
      if (!marked[i] || !marked[j] ||
          !contact_subset_within(s.list, i, j, &reach))
        continue;
      CHECK(island[i] == island[j]);
      changes = changes || colour[i] != colour[j];
      colour[i] = colour[j] = GSL_MIN(colour[i], colour[j]);
    }
  }
  for (size_t q = 0; q < k.count; q++)
    for (size_t p = k.begin[q]; p < k.begin[q + 1]; p++)
      CHECK(colour[k.row[p]] == k.row[k.begin[q]]);
  islands_free(&k);
  free(colour);
  free(island);
  free(marked);
  sample_free(&s);
}

/* Large parts are shared among threads, with the same bits. */
static void test_threads(gsl_rng *rng) {
  enum { N = 2500 };
  double *first = NULL;
  for (int threads = 1; threads <= 4; threads++) {
    gsl_rng_set(rng, 7);
    struct sample s = random_sample(rng, N, threads);
    bool *marked = calloc(N, sizeof *marked);
    for (size_t i = 0; i < N; i++)
      marked[i] = i % 7 > 0;
    struct contact_list *part = part_of(s.list);
    const struct contact_reach all = everything(s.y);
    CHECK(take(part, s.list, marked, &all) == GSL_SUCCESS);
    CHECK(part->threads == (size_t)threads);
    double *y = state_of(part, s.y), *rates = numbers(N * s.list->stride);
    evaluate(part, y, rates);
    if (!first)
      first = rates;
    else {
      CHECK(!memcmp(first, rates, part->rows * part->stride * sizeof *rates));
      free(rates);
    }
    free(y);
    free(marked);
    contact_list_free(part);
    sample_free(&s);
  }
  free(first);
}

/* Near and far contacts of a large list are dealt out by several threads, to
   the same lists. */
static void test_shared_split(gsl_rng *rng) {
  enum { N = 2500 };
  struct sample s[2];
  struct contact_list *near[2], *far[2];
  for (int k = 0; k < 2; k++) {
    gsl_rng_set(rng, 8);
    s[k] = random_sample(rng, N, k ? 3 : 1);
    near[k] = part_of(s[k].list);
    far[k] = part_of(s[k].list);
    const struct contact_reach reach = {.y = s[k].y, .h = 1e-3, .gap = 0.02};
    for (int again = 0; again < 2; again++)
      CHECK(contact_subset_split(near[k], far[k], s[k].list, &reach) ==
            GSL_SUCCESS);
  }
  for (int k = 0; k < 2; k++) {
    const struct contact_list *a = k ? near[0] : far[0],
                              *b = k ? near[1] : far[1];
    if (!CHECK(a->near.count > N / 10 && a->near.count == b->near.count) ||
        !CHECK(a->wall_contacts > 0 && a->wall_contacts == b->wall_contacts))
      continue;
    const size_t pairs = a->near.count * sizeof *a->near.i,
                 walls = a->wall_contacts * sizeof *a->wall_row;
    CHECK(!memcmp(a->near.i, b->near.i, pairs));
    CHECK(!memcmp(a->near.j, b->near.j, pairs));
    CHECK(!memcmp(a->wall_row, b->wall_row, walls));
    CHECK(!memcmp(a->wall_id, b->wall_id, walls));
    const size_t firsts = (N + 1) * sizeof *a->near.first;
    CHECK(!memcmp(a->near.first, b->near.first, firsts));
    CHECK(!memcmp(a->wall_first, b->wall_first, firsts));
  }
  for (int k = 0; k < 2; k++) {
    contact_list_free(near[k]);
    contact_list_free(far[k]);
    sample_free(&s[k]);
  }
}

/* No row, and one without a partner. */
static void test_empty(gsl_rng *rng) {
  gsl_rng_set(rng, 1);
  struct sample s = random_sample(rng, 5, 1);
  struct contact_list *part = part_of(s.list);
  bool marked[5] = {false};
  const struct contact_reach all = everything(s.y);
  CHECK(take(part, s.list, marked, &all) == GSL_SUCCESS);
  CHECK(part->rows == 0 && part->ghosts == 0 && part->near.count == 0);
  marked[3] = true;
  const struct contact_reach none = {.y = s.y, .gap = -10};
  CHECK(take(part, s.list, marked, &none) == GSL_SUCCESS);
  CHECK(part->rows == 1 && part->ghosts == 0 && part->near.count == 0);
  contact_list_free(part);
  sample_free(&s);
}

/* What the list is kept by does not depend on which sphere comes first: a giant
   there, or a grain. */
static void test_first_sphere(void) {
  struct scene scene = scene_default();
  double way[2];
  for (size_t first = 0; first < 2; first++) {
    struct bed bed;
    struct contact_list *l;
    CHECK(bed_alloc(&bed, 101) == GSL_SUCCESS);
    for (size_t i = 0; i < bed.n; i++) {
      bed.r[i] = i == 100 * first ? 10 : 0.1;
      bed.x[3 * i] = 0.3 * (double)i;
    }
    CHECK(contact_list_alloc(&l, &scene, &bed, 1, NULL) == GSL_SUCCESS);
    way[first] = contact_list_longest_way(l);
    contact_list_free(l);
    bed_free(&bed);
  }
  CHECK_REL(way[1], way[0], 101 * DBL_EPSILON);
  CHECK_REL(way[0], (10 + 100 * 0.1) / 101, 101 * DBL_EPSILON);
}

/* A wall 0.05 m away is within reach by the speed towards it, which may grow by
   30 %; a sphere that goes away comes no nearer, and keeps its gap. */
static void test_walls(void) {
  const struct {
    double v, h, gap;
    bool near;
  } cases[] = {{-1, 0.0305, 0.01, false}, {-1, 0.031, 0.01, true},
               {1, 0.031, 0.01, false},   {1, 0.031, 0.0501, true},
               {0, 1, 0.0499, false},     {0, 1, 0.0501, true}};
  struct scene scene = scene_default();
  scene.model = SCENE_BASIC;
  struct bed bed;
  struct contact_list *l = NULL;
  CHECK(scene_add_wall(&scene, (double[]){0, 0, 0}, (double[]){0, 0, -1}) ==
        GSL_SUCCESS);
  CHECK(bed_alloc(&bed, 1) == GSL_SUCCESS);
  bed.r[0] = 0.1;
  bed.m[0] = 1;
  CHECK(contact_list_alloc(&l, &scene, &bed, 1, NULL) == GSL_SUCCESS);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    double y[6] = {0, 0, 0.15, 0, 0, cases[k].v};
    const struct contact_reach reach = {y, cases[k].h, cases[k].gap};
    struct contact_list *near = part_of(l), *far = part_of(l);
    CHECK(contact_list_update(l, y) == GSL_SUCCESS && l->wall_contacts == 1);
    CHECK(contact_subset_split(near, far, l, &reach) == GSL_SUCCESS);
    CHECK(near->wall_contacts == cases[k].near &&
          far->wall_contacts == !cases[k].near);
    contact_list_free(near);
    contact_list_free(far);
  }
  contact_list_free(l);
  bed_free(&bed);
  scene_free(&scene);
}

/* A list holds for states within half of its skin of where it was made. */
static void test_holds(gsl_rng *rng) {
  gsl_rng_set(rng, 1);
  struct sample s = random_sample(rng, 60, 1);
  const double half = s.list->skin / 2, ways[] = {0.99, 1.01, GSL_NAN};
  CHECK(half > 0);
  for (size_t k = 0; k < 3; k++) {
    double *x = s.y + 7 * s.list->stride;
    const double whole = x[1];
    x[1] += ways[k] * half;
    CHECK(contact_list_holds(s.list, s.y) == (k == 0));
    x[1] = whole;
    CHECK(contact_list_holds(s.list, s.y));
  }
  sample_free(&s);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return 1;
  for (unsigned long seed = 0; seed < 100; seed++) {
    test_rows(rng, seed);
    test_parts(rng, seed);
    test_split(rng, seed);
    test_islands(rng, seed);
  }
  test_walls();
  test_holds(rng);
  test_threads(rng);
  test_shared_split(rng);
  test_empty(rng);
  test_first_sphere();
  gsl_rng_free(rng);
  return check_done();
}
