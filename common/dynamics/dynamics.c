/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/dynamics.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/allpairs.h"
#include "dynamics/jacobian.h"
#include "dynamics/kernel.h"
#include "geometry/neighbors.h"
#include "dynamics/survey.h"
#include "model/travel.h"

struct dynamics {
  struct kernel_data k;
  const struct kernel *kernel;
  struct dynamics_options options;
  struct dynamics_counts counts;
  size_t n, walls_count;
  struct wall *walls;
  /* Row of the state <-> sphere of the bed: order[row] = sphere. */
  size_t *order;
  double *radius, *mass; /* by row */
  struct neighbors near;
  size_t *wall_first;              /* n + 1 */
  uint32_t *wall_sphere, *wall_id; /* room for n * walls */
  /* One part a thread. Pairs with one partner in an earlier part are computed
     there and here: incoming[p] to incoming[p+1], ascending. */
  struct kernel_part *part;
  double *sums; /* of all parts */
  size_t sums_size;
  size_t *incoming;
  uint32_t *in_i, *in_j;
  size_t incoming_size;
  /* The list holds for states within skin/2 of reference, 3n. */
  double *reference;
  double skin;
  size_t age; /* evaluations since it was built */
};

/* Cost of building the list, in evaluations; measured, only the skin depends
   on it. */
static const double build_cost = 4;

void dynamics_free(struct dynamics *d) {
  if (!d)
    return;
  neighbors_free(&d->near);
  free(d->walls);
  free(d->order);
  free(d->part);
  free(d->incoming);
  free(d->in_i);
  free(d->in_j);
  free(d->radius);
  free(d->mass);
  free(d->wall_first);
  free(d->wall_sphere);
  free(d->wall_id);
  free(d->sums);
  free(d->reference);
  free(d);
}

/* Zeroed; never NULL for want of size. */
static void *allocate(size_t bytes) {
  return calloc(1, bytes ? bytes : 1);
}

/* From so many spheres on, rows are put in the order of space, so that
   partners are near each other in memory. */
enum { REORDER = 1024 };

struct place {
  double cell[2], z;
  size_t sphere;
};

static int compare_places(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  for (int k = 0; k < 2; k++)
    if (p->cell[k] != q->cell[k])
      return p->cell[k] < q->cell[k] ? -1 : 1;
  if (p->z != q->z)
    return p->z < q->z ? -1 : 1;
  return (p->sphere > q->sphere) - (p->sphere < q->sphere);
}

/* Columns of cells one after the other, from the floor up: spheres fall along
   their column, so the order stays good. */
static int find_order(struct dynamics *d, const struct bed *b, double edge) {
  for (size_t i = 0; i < b->n; i++)
    d->order[i] = i;
  if (b->n < REORDER)
    return GSL_SUCCESS;
  struct place *places = malloc(b->n * sizeof *places);
  if (!places)
    return GSL_ENOMEM;
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    places[i] =
        (struct place){{floor(x[0] / edge), floor(x[1] / edge)}, x[2], i};
  }
  qsort(places, b->n, sizeof *places, compare_places);
  for (size_t i = 0; i < b->n; i++)
    d->order[i] = places[i].sphere;
  free(places);
  return GSL_SUCCESS;
}

struct dynamics *dynamics_alloc(const struct scene *s, const struct bed *b,
                                const struct dynamics_options *o) {
  const size_t n = b->n;
  if (n == 0)
    return NULL;
  for (size_t i = 0; i < n; i++)
    if (!(b->r[i] > 0) || !(b->m[i] > 0))
      return NULL;
  struct dynamics *d = calloc(1, sizeof *d);
  if (!d)
    return NULL;
  const size_t room = n * s->walls_count, parts = (size_t)o->threads + 1;
  d->n = n;
  d->options = *o;
  d->walls_count = s->walls_count;
  d->walls = allocate(s->walls_count * sizeof *s->walls);
  d->order = allocate(n * sizeof(size_t));
  d->radius = allocate(n * sizeof(double));
  d->mass = allocate(n * sizeof(double));
  d->wall_first = allocate((n + 1) * sizeof(size_t));
  d->wall_sphere = allocate(room * sizeof(uint32_t));
  d->wall_id = allocate(room * sizeof(uint32_t));
  d->part = allocate(parts * sizeof *d->part);
  d->incoming = allocate(parts * sizeof(size_t));
  d->reference = allocate(3 * n * sizeof(double));
  if (!d->walls || !d->order || !d->radius || !d->mass || !d->wall_first ||
      !d->wall_sphere || !d->wall_id || !d->part || !d->incoming ||
      !d->reference ||
      find_order(d, b, 2 * b->r[0] + s->law.lmax) != GSL_SUCCESS) {
    dynamics_free(d);
    return NULL;
  }
  for (size_t k = 0; k < s->walls_count; k++)
    d->walls[k] = s->walls[k];
  bool uniform = true;
  double smallest = GSL_POSINF;
  for (size_t i = 0; i < n; i++) {
    d->radius[i] = b->r[d->order[i]];
    d->mass[i] = b->m[d->order[i]];
    uniform = uniform && d->radius[i] == d->radius[0];
    smallest = GSL_MIN(smallest, d->radius[i]);
  }
  d->kernel = kernel_select();
  d->skin = 0.2 * smallest;
  d->k = (struct kernel_data){
      .law = s->law,
      .has = {.friction = scene_has_friction(s),
              .rotation = scene_has_rotation(s),
              .elastic = s->law.restitution == 1,
              .uniform = uniform},
      .gravity = {s->gravity[0], s->gravity[1], s->gravity[2]},
      .radius = d->radius,
      .mass = d->mass,
      .walls = d->walls,
      .wall_first = d->wall_first,
      .wall_sphere = d->wall_sphere,
      .wall_id = d->wall_id};
  d->k.stride = d->k.has.rotation ? 9 : 6;
  d->age = SIZE_MAX; /* no list yet */
  return d;
}

size_t dynamics_stride(const struct dynamics *d) {
  return d->k.stride;
}

size_t dynamics_dimension(const struct dynamics *d) {
  return d->k.stride * d->n;
}

struct dynamics_counts dynamics_counts(const struct dynamics *d) {
  return d->counts;
}

const char *dynamics_kernel(const struct dynamics *d) {
  return d->options.all_pairs ? "all pairs" : d->kernel->name;
}

void dynamics_pack(const struct dynamics *d, const struct bed *b, double y[]) {
  for (size_t i = 0; i < d->n; i++)
    for (int c = 0; c < 3; c++) {
      double *row = y + i * d->k.stride;
      const size_t at = 3 * d->order[i] + c;
      row[c] = b->x[at];
      row[3 + c] = b->v[at];
      if (d->k.has.rotation)
        row[6 + c] = b->w[at];
    }
}

void dynamics_unpack(const struct dynamics *d, const double y[],
                     struct bed *b) {
  for (size_t i = 0; i < d->n; i++)
    for (int c = 0; c < 3; c++) {
      const double *row = y + i * d->k.stride;
      const size_t at = 3 * d->order[i] + c;
      b->x[at] = row[c];
      b->v[at] = row[3 + c];
      if (d->k.has.rotation)
        b->w[at] = row[6 + c];
    }
}

/* Wider skins are rebuilt less often but hold more idle pairs; both costs are
   equal at the best skin. overhead: idle pairs' share of an evaluation. */
static double skin_overhead(const struct dynamics *d) {
  return 3 * d->skin / (2 * d->radius[0] + d->k.law.lmax + d->skin);
}

static void tune_skin(struct dynamics *d) {
  const double idle = skin_overhead(d) * (double)d->age;
  const double factor = sqrt(build_cost / GSL_MAX(idle, 1e-3));
  const double r = d->radius[0];
  d->skin *= GSL_MIN(GSL_MAX(factor, 0.7), 1.4);
  d->skin = GSL_MIN(GSL_MAX(d->skin, 0.02 * r), 2 * r);
}

static void build_wall_list(struct dynamics *d, const double *y) {
  const double reach = d->k.law.lmax + d->skin;
  size_t count = 0;
  for (size_t i = 0; i < d->n; i++) {
    d->wall_first[i] = count;
    for (size_t m = 0; m < d->walls_count; m++) {
      const double gap =
          wall_distance(&d->walls[m], y + i * d->k.stride) - d->radius[i];
      if (gap <= reach) {
        d->wall_sphere[count] = (uint32_t)i;
        d->wall_id[count++] = (uint32_t)m;
      }
    }
  }
  d->wall_first[d->n] = count;
  d->k.wall_contacts = count;
}

/* Parts of about equal work. They decide who computes what, never what comes
   out. */
static void split_rows(struct dynamics *d) {
  const size_t threads = (size_t)d->options.threads;
  const size_t *first = d->near.first, *wall_first = d->wall_first;
  const double all = (double)(first[d->n] + wall_first[d->n] + d->n);
  size_t row = 0;
  for (size_t p = 0; p < threads; p++) {
    const double until = all * (double)p / (double)threads;
    while (row < d->n && (double)(first[row] + wall_first[row] + row) < until)
      row++;
    d->part[p].from = row;
    if (p)
      d->part[p - 1].to = row;
  }
  d->part[threads - 1].to = d->n;
}

/* Rows that a part finishes at a time. */
enum { ROWS = 64 };

/* Room for the sums in flight: a chunk of rows and their furthest partner. */
static int reserve_sums(struct dynamics *d) {
  const struct neighbors *near = &d->near;
  const size_t threads = (size_t)d->options.threads;
  size_t span = 0, rows = 1;
  for (size_t p = 0; p < near->count; p++)
    span = GSL_MAX(span, (size_t)(near->j[p] - near->i[p]));
  while (rows < span + 2 * ROWS)
    rows *= 2;
  if (rows > d->sums_size) {
    free(d->sums);
    d->sums = allocate(threads * rows * KERNEL_SUM * sizeof *d->sums);
    d->sums_size = d->sums ? rows : 0;
    if (!d->sums)
      return GSL_ENOMEM;
  }
  for (size_t p = 0; p < threads; p++) {
    d->part[p].sums = d->sums + p * d->sums_size * KERNEL_SUM;
    d->part[p].mask = d->sums_size - 1;
  }
  return GSL_SUCCESS;
}

static size_t part_of(const struct dynamics *d, size_t row) {
  size_t p = 0;
  while (row >= d->part[p].to)
    p++;
  return p;
}

/* Lists for each part the pairs that come into it from earlier ones. */
static int list_incoming(struct dynamics *d) {
  const struct neighbors *near = &d->near;
  const size_t threads = (size_t)d->options.threads;
  memset(d->incoming, 0, (threads + 1) * sizeof *d->incoming);
  if (threads == 1)
    return GSL_SUCCESS;
  for (int pass = 0; pass < 2; pass++) { /* count, then fill */
    size_t p = 0;
    for (size_t i = 0; i < d->n; i++) {
      while (i >= d->part[p].to)
        p++;
      for (size_t q = near->first[i]; q < near->first[i + 1]; q++)
        if (near->j[q] >= d->part[p].to) {
          size_t *end = &d->incoming[part_of(d, near->j[q]) + (pass == 0)];
          if (pass) {
            d->in_i[*end] = near->i[q];
            d->in_j[*end] = near->j[q];
          }
          ++*end;
        }
    }
    if (pass == 0) {
      for (size_t q = 0; q < threads; q++)
        d->incoming[q + 1] += d->incoming[q];
      const size_t count = d->incoming[threads];
      if (count > d->incoming_size) {
        free(d->in_i);
        free(d->in_j);
        d->in_i = allocate(2 * count * sizeof *d->in_i);
        d->in_j = allocate(2 * count * sizeof *d->in_j);
        d->incoming_size = d->in_i && d->in_j ? 2 * count : 0;
        if (!d->incoming_size)
          return GSL_ENOMEM;
      }
    }
  }
  for (size_t q = threads; q > 0; q--) /* the ends are the next beginnings */
    d->incoming[q] = d->incoming[q - 1];
  d->incoming[0] = 0;
  return GSL_SUCCESS;
}

static int build_list(struct dynamics *d, const double *y) {
  if (d->age != SIZE_MAX)
    tune_skin(d);
  d->age = SIZE_MAX; /* stays so if anything below fails */
  int status = neighbors_find(&d->near, d->n, y, d->k.stride, d->radius,
                              d->k.law.lmax + d->skin);
  if (status == GSL_SUCCESS) {
    build_wall_list(d, y);
    split_rows(d);
    status = list_incoming(d);
  }
  if (status == GSL_SUCCESS)
    status = reserve_sums(d);
  if (status != GSL_SUCCESS)
    return status == GSL_EINVAL ? GSL_EBADFUNC : status;
  for (size_t i = 0; i < d->n; i++)
    memcpy(d->reference + 3 * i, y + i * d->k.stride, 3 * sizeof *y);
  d->k.pairs = d->near.count;
  d->k.i = d->near.i;
  d->k.j = d->near.j;
  d->k.first = d->near.first;
  d->counts.builds++;
  d->counts.contacts = d->near.count + d->k.wall_contacts;
  d->age = 0;
  return GSL_SUCCESS;
}

/* Spheres from which on threads share what is a few operations a sphere. */
enum { WORTH_SHARING = 4096 };

/* Makes the list hold for y; the result does not depend on when it was built,
   since pairs beyond lmax add zero and the order is always that of ids. */
static int update_list(struct dynamics *d, const double *y) {
  if (d->age == SIZE_MAX)
    return build_list(d, y);
  const double most = 0.25 * d->skin * d->skin;
  double furthest = 0;
  bool sound = true; /* a maximum keeps a NaN out */
#pragma omp parallel for num_threads(d->options.threads) schedule(static)      \
    reduction(max : furthest) reduction(&& : sound)                            \
    if (d->n >= WORTH_SHARING)
  for (size_t i = 0; i < d->n; i++) {
    const double *x = y + i * d->k.stride, *x0 = d->reference + 3 * i;
    const double dx = x[0] - x0[0], dy = x[1] - x0[1], dz = x[2] - x0[2];
    const double moved = dx * dx + dy * dy + dz * dz;
    furthest = furthest > moved ? furthest : moved;
    sound = sound && moved == moved;
  }
  if (!sound)
    return GSL_EBADFUNC;
  const bool too_wide = skin_overhead(d) * (double)d->age > 8 * build_cost &&
                        d->skin > 0.03 * d->radius[0];
  if (furthest > most || too_wide)
    return build_list(d, y);
  return GSL_SUCCESS;
}

static bool evaluate_all_pairs(struct dynamics *d, const double *y,
                               double *dydt) {
  bool finite = true;
#pragma omp parallel for num_threads(d->options.threads) schedule(static)      \
    reduction(&& : finite)
  for (size_t i = 0; i < d->n; i++)
    finite = allpairs_rates(&d->k, d->walls_count, d->n, y, dydt, i, i + 1) &&
             finite;
  return finite;
}

/* Where the rates of an evaluation go: all into dydt, or a few rows at a time,
   while they are in the cache, into a linear combination. */
struct destination {
  double *dydt; /* NULL for the combination */
  const struct stage *stage;
  double *out;
};

/* A part a few rows at a time, each finished while it is in the cache: a row's
   pairs as second partner belong to rows before it. */
static bool evaluate_part(const struct dynamics *d, size_t p, const double *y,
                          const struct destination *to) {
  const struct kernel *kernel = d->kernel;
  const struct kernel_data *k = &d->k;
  const struct kernel_part *part = &d->part[p];
  const size_t in = d->incoming[p], incoming = d->incoming[p + 1] - in;
  if (incoming)
    kernel->add_pairs(k, y, d->in_i + in, d->in_j + in, incoming, part);
  bool finite = true;
  double few[ROWS * 9];
  for (size_t i = part->from; i < part->to; i += ROWS) {
    const size_t end = GSL_MIN(i + ROWS, part->to), at = i * k->stride;
    const size_t first = k->first[i], last = k->first[end];
    double *rates = to->dydt ? to->dydt + at : few;
    kernel->add_pairs(k, y, k->i + first, k->j + first, last - first, part);
    kernel->add_walls(k, y, i, end, part);
    finite = kernel->finish(k, y, rates, i, end, part) && finite;
    if (!to->dydt)
      stage_combine(to->stage, at, (end - i) * k->stride, y, rates, to->out);
  }
  return finite;
}

static bool evaluate_list(const struct dynamics *d, const double *y,
                          const struct destination *to) {
  const int threads = d->options.threads;
  if (threads == 1)
    return evaluate_part(d, 0, y, to);
  bool finite = true;
#pragma omp parallel for num_threads(threads) schedule(static, 1)              \
    reduction(&& : finite)
  for (int p = 0; p < threads; p++)
    finite = evaluate_part(d, (size_t)p, y, to) && finite;
  return finite;
}

int dynamics_rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  struct dynamics *d = params;
  d->counts.evaluations++;
  if (d->options.all_pairs)
    return evaluate_all_pairs(d, y, dydt) ? GSL_SUCCESS : GSL_EBADFUNC;
  const int status = update_list(d, y);
  if (status != GSL_SUCCESS)
    return status;
  d->age++;
  const struct destination to = {.dydt = dydt};
  return evaluate_list(d, y, &to) ? GSL_SUCCESS : GSL_EBADFUNC;
}

int dynamics_stage(double t, const double y[], const struct stage *stage,
                   double out[], void *params) {
  (void)t;
  struct dynamics *d = params;
  d->counts.evaluations++;
  const int status = update_list(d, y);
  if (status != GSL_SUCCESS)
    return status;
  d->age++;
  const struct destination to = {.stage = stage, .out = out};
  return evaluate_list(d, y, &to) ? GSL_SUCCESS : GSL_EBADFUNC;
}

int dynamics_jacobian(double t, const double y[], double *dfdy, double dfdt[],
                      void *params) {
  (void)t;
  struct dynamics *d = params;
  const int status = update_list(d, y);
  if (status != GSL_SUCCESS)
    return status;
  const size_t dim = dynamics_dimension(d);
  memset(dfdt, 0, dim * sizeof *dfdt);
  jacobian_dense(&d->k, d->n, y, dfdy);
  double checksum = 0; /* 0 times a number that is not finite is NaN */
  for (size_t i = 0; i < dim; i++)
    checksum += 0 * y[i];
  for (size_t i = 0; i < dim * dim; i++)
    checksum += 0 * dfdy[i];
  return checksum == 0 ? GSL_SUCCESS : GSL_EBADFUNC;
}

double dynamics_step_limit(const struct dynamics *d, const double y[],
                           const double dydt[], double travel) {
  double least = GSL_POSINF;
  for (size_t i = 0; i < d->n; i++) {
    const double v = vec3_norm(y + i * d->k.stride + 3);
    const double a = vec3_norm(dydt + i * d->k.stride + 3);
    least = GSL_MIN(least, travel_time(v, a, travel));
  }
  return least;
}

void dynamics_scale(const struct dynamics *d, double scale[]) {
  const size_t stride = d->k.stride;
  for (size_t i = 0; i < d->n; i++)
    for (size_t c = 0; c < stride; c++)
      scale[i * stride + c] = c < 3   ? 1 / d->k.law.kappa
                              : c < 6 ? 1
                                      : 1 / d->radius[i];
}

double dynamics_kinetic(const struct dynamics *d, const double y[]) {
  double sum = 0;
  for (size_t i = 0; i < d->n; i++) {
    const double *row = y + i * d->k.stride;
    double twice = vec3_dot(row + 3, row + 3);
    if (d->k.has.rotation)
      twice += 0.4 * d->radius[i] * d->radius[i] * vec3_dot(row + 6, row + 6);
    sum += 0.5 * d->mass[i] * twice;
  }
  return sum;
}

int dynamics_survey(struct dynamics *d, const double y[],
                    struct dynamics_survey *s) {
  const int status = update_list(d, y);
  if (status != GSL_SUCCESS)
    return status;
  survey_take(&d->k, d->n, y, s);
  s->sphere = d->order[s->sphere];
  s->outsider = d->order[s->outsider];
  return GSL_SUCCESS;
}

double dynamics_potential(struct dynamics *d, const double y[]) {
  struct dynamics_survey s;
  return dynamics_survey(d, y, &s) == GSL_SUCCESS ? s.gravity + s.stored
                                                  : GSL_NAN;
}

double dynamics_fastest(const struct dynamics *d, const double y[]) {
  double fastest = 0;
  for (size_t i = 0; i < d->n; i++) {
    const double *row = y + i * d->k.stride;
    fastest = GSL_MAX(fastest, vec3_norm(row + 3));
    if (d->k.has.rotation)
      fastest = GSL_MAX(fastest, d->radius[i] * vec3_norm(row + 6));
  }
  return fastest;
}
