/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equal spheres on a line, e = 1, no gravity, every bond between neighbours
   kept: the Toda lattice. The eigenvalues of the symmetric matrix with the
   velocities on its diagonal and
     sqrt(F0/kappa) exp(-kappa l/2)
   beside it are constant in time (Flaschka, Phys. Rev. B 9 (1974) 1924), so
   their drift is an error at any time without a reference.

   Open, the line flies apart after its collisions. Closed, between two walls,
   it is half of a ring: the walls are bodies that rest for symmetry, their
   other sides have the line's mirror image, and the matrix is the ring's. So it
   can go on for any time. */
#include <stdlib.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include "measure.h"

/* The gap of next neighbours is 2 r + two gaps. An overlap, were all energy in
   it, is ln(kappa E/F0)/kappa, below 0.05 m for 400 spheres: so it is beyond
   lmax, and the force at lmax is F0 exp(-57). */
static const double radius = 0.25, lmax = 0.38;

static const size_t most = 20000000;

struct line {
  size_t n;
  bool closed;
  double end; /* the second wall (m); the first is at 0 */
  struct contact_law law;
};

static size_t ring_size(const struct line *l) {
  return l->closed ? 2 * l->n + 2 : l->n;
}

static double beside(const struct line *l, double gap) {
  return sqrt(l->law.f0 / l->law.kappa) * exp(-0.5 * l->law.kappa * gap);
}

/* Eigenvalues in ascending order of a state with rows of 6. */
static int eigenvalues(const struct line *l, const double y[], double value[]) {
  const size_t n = l->n, size = ring_size(l);
  gsl_matrix *m = gsl_matrix_calloc(size, size);
  gsl_eigen_symm_workspace *w = gsl_eigen_symm_alloc(size);
  int status = m && w ? GSL_SUCCESS : GSL_ENOMEM;
  if (status == GSL_SUCCESS) {
    /* row 0 is the first wall, n + 1 the second; gsl_eigen_symm reads the lower
       triangle */
    const size_t first = l->closed ? 1 : 0;
    for (size_t i = 0; i < n; i++) {
      const double velocity = y[ROW_PLAIN * i + ROW_V];
      gsl_matrix_set(m, first + i, first + i, velocity);
      if (l->closed)
        gsl_matrix_set(m, size - 1 - i, size - 1 - i, -velocity);
    }
    for (size_t i = 0; i + 1 < n; i++) {
      const double b = beside(l, y[6 * (i + 1)] - y[6 * i] - 2 * radius);
      gsl_matrix_set(m, first + i + 1, first + i, b);
      if (l->closed)
        gsl_matrix_set(m, size - 1 - i, size - 2 - i, b);
    }
    if (l->closed) {
      const double low = beside(l, y[ROW_X] - radius);
      const double high = beside(l, l->end - y[6 * (n - 1)] - radius);
      gsl_matrix_set(m, 1, 0, low);
      gsl_matrix_set(m, size - 1, 0, low);
      gsl_matrix_set(m, n + 1, n, high);
      gsl_matrix_set(m, n + 2, n + 1, high);
    }
    gsl_vector_view v = gsl_vector_view_array(value, size);
    status = gsl_eigen_symm(m, &v.vector, w);
    gsl_sort(value, 1, size);
  }
  gsl_eigen_symm_free(w);
  gsl_matrix_free(m);
  return status;
}

/* Gaps of -0.02 to 0.1 m, speeds up to 2 m/s. */
static int fill(const struct precision_case *c, struct line *l, struct scene *s,
                struct bed *b) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng)
    return GSL_ENOMEM;
  gsl_rng_set(rng, (unsigned long)c->seed);
  int status = bed_alloc(b, l->n);
  if (status == GSL_SUCCESS) {
    double at = -radius;
    for (size_t i = 0; i < l->n; i++) {
      at += 2 * radius - 0.02 + 0.12 * gsl_rng_uniform(rng);
      b->x[3 * i] = at;
      b->v[3 * i] = 4 * gsl_rng_uniform(rng) - 2;
      b->r[i] = radius;
    }
    l->end = at + radius + 0.04;
    if (l->closed)
      status = scene_add_wall(s, (double[]){0, 0, 0}, (double[]){-1, 0, 0});
    if (l->closed && status == GSL_SUCCESS)
      status = scene_add_wall(s, (double[]){l->end, 0, 0}, (double[]){1, 0, 0});
  }
  gsl_rng_free(rng);
  return status;
}

static int run(const struct precision_case *c, bool closed,
               struct precision_result *r) {
  struct line line = {.n = c->count, .closed = closed, .law = c->law};
  struct scene scene = {.model = SCENE_BASIC, .law = c->law};
  struct bed bed = {0};
  struct motion *m = NULL;
  const size_t size = ring_size(&line);
  double *value = malloc(2 * size * sizeof *value);
  int status = value ? fill(c, &line, &scene, &bed) : GSL_ENOMEM;
  if (status == GSL_SUCCESS)
    status = motion_alloc(&m, &scene, &bed, c->integrate,
                          &(struct dynamics_options){.threads = 1}, c->travel);
  if (status == GSL_SUCCESS)
    status = eigenvalues(&line, integrate_state(m->integrator), value);
  if (status == GSL_SUCCESS) {
    measure_start(r);
    r->status = measure_until(m->integrator, c->time, most);
    measure_stop(r);
    status = eigenvalues(&line, integrate_state(m->integrator), value + size);
  }
  if (status == GSL_SUCCESS) {
    double moved = 0;
    for (size_t i = 0; i < size; i++)
      if (!(fabs(value[size + i] - value[i]) <= moved))
        moved = fabs(value[size + i] - value[i]);
    moved /= GSL_MAX(-value[0], value[size - 1]);
    measure_add(r, m->integrator, dynamics_counts(m->dynamics).evaluations,
                &moved, 1);
    measure_mean(r);
    if (r->status == measure_ok && !(moved <= 1))
      r->status = "lost";
  }
  motion_free(m);
  bed_free(&bed);
  scene_free(&scene);
  free(value);
  return status;
}

static void open_defaults(struct precision_case *c) {
  c->law.restitution = 1;
  c->law.friction = 0;
  c->law.lmax = lmax;
  c->gravity = 0;
  c->count = 6;
  c->time = 0.2;
}

static int run_open(const struct precision_case *c, const void *reference,
                    struct precision_result *r) {
  (void)reference;
  return run(c, false, r);
}

const struct precision_scene scene_toda_open = {
    .name = "toda-open",
    .summary = "a line of spheres, e = 1, that collide and fly apart: drift of "
               "the Toda lattice's eigenvalues by their largest",
    .errors = {"error_eigenvalue", NULL},
    .defaults = open_defaults,
    .run = run_open};

static void closed_defaults(struct precision_case *c) {
  open_defaults(c);
  c->time = 10;
}

static int run_closed(const struct precision_case *c, const void *reference,
                      struct precision_result *r) {
  (void)reference;
  return run(c, true, r);
}

const struct precision_scene scene_toda_closed = {
    .name = "toda-closed",
    .summary = "a line of spheres between two walls, e = 1: drift of the "
               "eigenvalues of the ring that it is half of",
    .errors = {"error_eigenvalue", NULL},
    .defaults = closed_defaults,
    .run = run_closed};
