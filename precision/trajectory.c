/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres fall into a box, 2 x 2 x 2 of them or the paper's 200, over the time
   for which two tight runs agree on their positions. That time depends on the
   scene: settling is chaotic, and errors grow until nothing is left to
   compare. Without friction (--friction 0) it is the basic variant. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/fill.h"
#include "measure.h"

/* Tolerances of the two runs of the reference (m/s), the sharper one last. */
static const double tight[] = {1e-10, 1e-11};
static const size_t most_steps = 20000000;

struct reference {
  size_t n;
  double at[]; /* 3n positions, 3n velocities */
};

static void defaults(struct precision_case *c) {
  c->count = 8;
  c->law.lmax = 0.2; /* the jump there is F0 exp(-30) = 1e-12 N */
  c->time = 1;
}

static int start(const struct precision_case *c, struct scene *s,
                 struct bed *b) {
  const double side = c->count > 8 ? 1 : 0.5;
  const struct fill fill = {.count = c->count,
                            .mass = 1,
                            .radius = 0.1,
                            .base = {side, side},
                            .drop = 1.1,
                            .jitter = 0.25,
                            .seed = c->seed};
  *s = (struct scene){
      .model = SCENE_ROTATION, .law = c->law, .gravity = {0, 0, -c->gravity}};
  const int status = scene_add_box(s, side, side);
  return status == GSL_SUCCESS ? fill_grid(&fill, b) : status;
}

/* Runs the case as o says, to at. */
static int fall(const struct precision_case *c,
                const struct integrate_options *o, double at[],
                struct precision_result *r) {
  struct scene scene;
  struct bed bed;
  struct motion *m = NULL;
  int status = start(c, &scene, &bed);
  if (status == GSL_SUCCESS) {
    status = motion_alloc(&m, &scene, &bed, o,
                          &(struct dynamics_options){.threads = 1}, c->travel);
    if (status == GSL_SUCCESS) {
      r->status = measure_until(m->integrator, c->time, most_steps);
      dynamics_unpack(m->dynamics, integrate_state(m->integrator), &bed);
      memcpy(at, bed.x, 3 * bed.n * sizeof *at);
      memcpy(at + 3 * bed.n, bed.v, 3 * bed.n * sizeof *at);
      measure_counts(m, r);
      motion_free(m);
    }
    bed_free(&bed);
  }
  scene_free(&scene);
  return status;
}

/* Largest distance between two states: positions in diameters, velocities in
   m/s. */
static void compare(size_t n, const double a[], const double b[],
                    double error[]) {
  const double unit[] = {0.2, 1};
  for (size_t k = 0; k < 2; k++) {
    error[k] = 0;
    for (size_t i = k * n; i < (k + 1) * n; i++) {
      double d[3];
      vec3_sub(a + 3 * i, b + 3 * i, d);
      const double far = vec3_norm(d) / unit[k];
      if (!(far <= error[k]) && !isnan(error[k])) /* a NaN comes in and stays */
        error[k] = far;
    }
  }
}

static int prepare(const struct precision_case *c, void **out, double error[]) {
  const size_t size = 6 * c->count;
  struct reference *ref = malloc(sizeof *ref + 2 * size * sizeof *ref->at);
  if (!ref)
    return GSL_ENOMEM;
  ref->n = c->count;
  int status = GSL_SUCCESS;
  for (size_t k = 0; k < 2 && status == GSL_SUCCESS; k++) {
    struct precision_result r;
    struct precision_case capped = *c;
    capped.travel = 1 / c->law.kappa;
    status = fall(&capped,
                  &(struct integrate_options){.method = "rk8pd",
                                              .control = "standard",
                                              .tol = tight[k],
                                              .hinit = 1e-3},
                  ref->at + (k == 0) * size, &r);
    if (status == GSL_SUCCESS && r.status != measure_ok)
      status = GSL_EFAILED;
  }
  if (status != GSL_SUCCESS) {
    free(ref);
    return status;
  }
  compare(ref->n, ref->at, ref->at + size, error);
  *out = ref;
  return GSL_SUCCESS;
}

static int run(const struct precision_case *c, const void *reference,
               struct precision_result *r) {
  const struct reference *ref = reference;
  double *at = malloc(6 * ref->n * sizeof *at);
  if (!at)
    return GSL_ENOMEM;
  const int status = fall(c, c->integrate, at, r);
  if (status == GSL_SUCCESS) {
    compare(ref->n, at, ref->at, r->error);
    if (r->status == measure_ok && r->error[0] > 1)
      r->status = "lost";
  }
  free(at);
  return status;
}

const struct precision_scene scene_trajectory = {
    .name = "trajectory",
    .summary = "2 x 2 x 2 or more spheres fall into a box, against rk8pd at "
               "1e-11",
    .errors = {"error_position", "error_velocity", NULL},
    .defaults = defaults,
    .prepare = prepare,
    .run = run};
