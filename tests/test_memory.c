/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constructors when memory fails: every allocation in turn, GSL's too. Each
   failure is GSL_ENOMEM and nothing else, the output stays as it was, and what
   was allocated is freed, which the sanitizer sees. The linker puts the
   functions below in the place of the allocators (Makefile). */
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_rstat.h>
#include "check.h"
#include "dynamics/motion.h"
#include "geometry/area.h"
#include "geometry/clearance.h"
#include "geometry/neighbors.h"
#include "geometry/parts.h"
#include "geometry/solid.h"
#include "geometry/surface.h"
#include "geometry/volume.h"
#include "geometry/voxels.h"
#include "measure/bond_order.h"
#include "measure/correlation.h"
#include "measure/network.h"
#include "measure/radius.h"
#include "model/bed_check.h"
#include "model/relax.h"
#include "program/run_watch.h"
#include "steppers/chebyshev.h"
#include "steppers/merson.h"

/* --- allocators that fail --------------------------------------------------*/

static size_t calls, failing; /* number of the call that fails; 0: none */

static bool fails(void) {
  return ++calls == failing;
}

#define WRAP(type, name, parameters, arguments)                                \
  type __real_##name parameters;                                               \
  type __wrap_##name parameters;                                               \
  type __wrap_##name parameters {                                              \
    return fails() ? NULL : __real_##name arguments;                           \
  }

WRAP(void *, malloc, (size_t size), (size))
WRAP(void *, calloc, (size_t count, size_t size), (count, size))
WRAP(void *, realloc, (void *p, size_t size), (p, size))
WRAP(gsl_odeiv2_step *, gsl_odeiv2_step_alloc,
     (const gsl_odeiv2_step_type *type, size_t dim), (type, dim))
WRAP(gsl_odeiv2_evolve *, gsl_odeiv2_evolve_alloc, (size_t dim), (dim))
WRAP(gsl_odeiv2_control *, gsl_odeiv2_control_scaled_new,
     (double eps_abs, double eps_rel, double a_y, double a_dydt,
      const double scale[], size_t dim),
     (eps_abs, eps_rel, a_y, a_dydt, scale, dim))

WRAP(gsl_rng *, gsl_rng_alloc, (const gsl_rng_type *type), (type))
WRAP(gsl_rstat_quantile_workspace *, gsl_rstat_quantile_alloc, (double p), (p))
WRAP(gsl_poly_complex_workspace *, gsl_poly_complex_workspace_alloc, (size_t n),
     (n))
WRAP(gsl_root_fsolver *, gsl_root_fsolver_alloc,
     (const gsl_root_fsolver_type *type), (type))
WRAP(gsl_integration_glfixed_table *, gsl_integration_glfixed_table_alloc,
     (size_t n), (n))

/* --- what is constructed ---------------------------------------------------*/

/* Enough spheres for rows in the order of space. */
enum { MANY = 1100 };

struct sample {
  struct scene scene;
  struct bed bed;
};

static void sample_alloc(struct sample *s, size_t n) {
  s->scene = scene_default();
  if (scene_add_box(&s->scene, 1, 1) != GSL_SUCCESS ||
      bed_alloc(&s->bed, n) != GSL_SUCCESS)
    abort();
  for (size_t i = 0; i < n; i++) {
    s->bed.r[i] = 0.1;
    s->bed.x[3 * i + 2] = 0.2 * (double)(i + 1);
  }
}

static void sample_free(struct sample *s) {
  bed_free(&s->bed);
  scene_free(&s->scene);
}

static int make_scene(const struct sample *s) {
  (void)s;
  struct scene scene = scene_default();
  const int status = scene_add_box(&scene, 1, 1);
  scene_free(&scene);
  return status;
}

static int make_bed(const struct sample *s) {
  (void)s;
  struct bed b;
  const int status = bed_alloc(&b, 10);
  bed_free(&b);
  return status;
}

static int make_dynamics(const struct sample *s) {
  struct dynamics *d = NULL;
  const int status = dynamics_alloc(&d, &s->scene, &s->bed,
                                    &(struct dynamics_options){.threads = 2});
  CHECK((status == GSL_SUCCESS) == (d != NULL));
  dynamics_free(d);
  return status;
}

static const struct integrate_options *options(const char *method,
                                               const char *control) {
  static struct integrate_options o;
  o = (struct integrate_options){.method = method,
                                 .control = control,
                                 .tol = 1e-3,
                                 .hinit = 1e-4,
                                 .step = control ? 0 : 1e-4};
  return &o;
}

static int make_motion(const struct sample *s,
                       const struct integrate_options *o) {
  struct motion *m = NULL;
  const int status = motion_alloc(&m, &s->scene, &s->bed, o,
                                  &(struct dynamics_options){.threads = 1}, 0);
  CHECK((status == GSL_SUCCESS) == (m != NULL));
  motion_free(m);
  return status;
}

static int make_rkc(const struct sample *s) {
  return make_motion(s, options("rkc", "predictive"));
}

static int make_paper(const struct sample *s) {
  return make_motion(s, options("merson", "paper"));
}

static int make_standard(const struct sample *s) {
  return make_motion(s, options("dopri5", "standard"));
}

static int make_verlet(const struct sample *s) {
  return make_motion(s, options("verlet", NULL));
}

static int make_multirate(const struct sample *s) {
  return make_motion(s, options("multirate", "local"));
}

/* The allocations of a run, spheres that meet and part; a few at a time, so
   that there are as many failures as steps to fail. */
static int run_multirate(const struct sample *s) {
  struct motion *m = NULL;
  const size_t stop = failing > calls ? failing : 0;
  failing = 0;
  if (motion_alloc(&m, &s->scene, &s->bed, options("multirate", "local"),
                   &(struct dynamics_options){.threads = 1},
                   0.01) != GSL_SUCCESS)
    abort();
  calls = 0;
  failing = stop;
  int status = GSL_SUCCESS;
  while (integrate_time(m->integrator) < 0.3 && status == GSL_SUCCESS)
    status = integrate_step(m->integrator);
  failing = 0;
  motion_free(m);
  return status;
}

static int make_over_floor(const struct sample *s) {
  struct scene scene = scene_default();
  struct motion *m = NULL;
  (void)s;
  const int status = motion_alloc_over_floor(
      &m, &scene, 0.1, (double[]){0, 0, 1}, (double[]){0, 0, 0},
      options("rkc", "predictive"), 0);
  CHECK((status == GSL_SUCCESS) == (m != NULL));
  motion_free(m);
  return status;
}

/* Dynamics for which no allocation fails. */
static struct dynamics *dynamics_of(const struct sample *s) {
  struct dynamics *d = NULL;
  failing = 0;
  if (dynamics_alloc(&d, &s->scene, &s->bed,
                     &(struct dynamics_options){.threads = 2}) != GSL_SUCCESS)
    abort();
  return d;
}

/* The first evaluation makes the list. One failure in it is one too few for
   the next to fail. */
static int first_evaluation(const struct sample *s) {
  const size_t stop = failing > calls ? failing : 0;
  struct dynamics *d = dynamics_of(s);
  const size_t dim = dynamics_dimension(d);
  double *y = calloc(2 * dim, sizeof *y);
  if (!y)
    abort();
  dynamics_pack(d, &s->bed, y);
  calls = 0;
  failing = stop;
  const int status = dynamics_rhs(0, y, y + dim, d);
  failing = 0;
  if (status != GSL_SUCCESS) /* memory is back */
    CHECK(dynamics_rhs(0, y, y + dim, d) == GSL_SUCCESS);
  free(y);
  dynamics_free(d);
  return status;
}

/* A list that could not be made anew, for spheres that are closer and so have
   more pairs, is none for where they were before, either. */
static int later_evaluation(const struct sample *s) {
  const size_t stop = failing > calls ? failing : 0;
  struct dynamics *d = dynamics_of(s);
  const size_t dim = dynamics_dimension(d);
  double *y = calloc(4 * dim, sizeof *y);
  if (!y)
    abort();
  double *close = y + dim, *before = close + dim, *after = before + dim;
  dynamics_pack(d, &s->bed, y);
  dynamics_pack(d, &s->bed, close);
  for (size_t i = 2; i < dim; i += dynamics_stride(d))
    close[i] *= 0.3;
  CHECK(dynamics_rhs(0, y, before, d) == GSL_SUCCESS);
  calls = 0;
  failing = stop;
  const int status = dynamics_rhs(0, close, after, d);
  failing = 0;
  CHECK(dynamics_rhs(0, y, after, d) == GSL_SUCCESS);
  CHECK(!memcmp(before, after, dim * sizeof *y));
  free(y);
  dynamics_free(d);
  return status;
}

static int make_chebyshev(const struct sample *s) {
  struct chebyshev *c = NULL;
  (void)s;
  int status = chebyshev_alloc(&c);
  CHECK((status == GSL_SUCCESS) == (c != NULL));
  for (size_t k = 2; k <= 9 && status == GSL_SUCCESS; k++)
    if (!chebyshev_scheme(c, k))
      status = GSL_ENOMEM;
  chebyshev_free(c);
  return status;
}

static int make_stiffness(const struct sample *s) {
  struct stiffness *stiff = NULL;
  (void)s;
  const int status = stiffness_alloc(&stiff, 10);
  CHECK((status == GSL_SUCCESS) == (stiff != NULL));
  stiffness_free(stiff);
  return status;
}

static int make_limits(const struct sample *s) {
  struct stiffness_limits l = {{0}};
  (void)s;
  const int status = stiffness_limits(merson, &l);
  CHECK((status == GSL_SUCCESS) == (l.at[0] > 0));
  return status;
}

/* With a method that has limits, which take a while to measure: the medians. */
static int make_run_watch(const struct sample *s) {
  const size_t stop = failing;
  failing = 0;
  struct motion *m = NULL;
  const struct integrate_options *o = options("verlet", NULL);
  if (motion_alloc(&m, &s->scene, &s->bed, o,
                   &(struct dynamics_options){.threads = 1}, 0) != GSL_SUCCESS)
    abort();
  struct run_watch *w = NULL;
  calls = 0;
  failing = stop;
  const int status = run_watch_alloc(
      &w,
      &(struct run_watch_options){.integrate = o, .integrator = m->integrator});
  failing = 0;
  CHECK((status == GSL_SUCCESS) == (w != NULL));
  run_watch_free(w);
  motion_free(m);
  return status;
}

static int make_crowd(const struct sample *s) {
  struct bed_crowd c;
  return bed_find_crowd(s->scene.period, &s->bed, &c);
}

/* The same spheres again, which overlap. */
static int push_apart(const struct sample *s) {
  struct bed b;
  const size_t stop = failing;
  failing = 0;
  if (bed_copy(&b, &s->bed) != GSL_SUCCESS)
    abort();
  calls = 0;
  failing = stop;
  const struct similarity units = similarity_of(0.1, 1, 9.81);
  struct relax_report r = {.passes = 99};
  const int status =
      relax_bed(&s->scene, &units, &(struct relax_limits){10, 1, 1000}, &b, &r);
  failing = 0;
  CHECK((status == GSL_SUCCESS) == (r.pairs > 0));
  CHECK((status == GSL_SUCCESS) == (b.x[2] != s->bed.x[2]));
  bed_free(&b);
  return status;
}

/* --- what is measured ------------------------------------------------------*/

/* What a function gives, which must stay when it fails. */
static const double before = 42;

/* Spheres of the column overlap each other and the floor. */
static const double box[6] = {0, 1, 0, 1, 0, 1};

static int find_volume(const struct sample *s) {
  double volume = before;
  const int status = volume_union(s->bed.n, s->bed.x, s->bed.r, box, &volume);
  CHECK((status == GSL_SUCCESS) == (volume != before));
  return status;
}

static int sample_volume(const struct sample *s) {
  double sum = before, both = before;
  const int status =
      volume_sampled(s->bed.n, s->bed.x, s->bed.r, box, 10, NULL, &sum, &both);
  CHECK((status == GSL_SUCCESS) == (sum != before && both != before));
  return status;
}

static int find_area(const struct sample *s) {
  double area = before;
  const int status = area_union(s->bed.n, s->bed.x, s->bed.r, box, &area);
  CHECK((status == GSL_SUCCESS) == (area != before));
  return status;
}

static int find_shell(const struct sample *s) {
  const struct area_shell shell = {{0.5, 0.55}, 0.05, {0, 0.35}};
  double sum = before, both = before;
  const int status =
      area_shell_covered(s->bed.n, s->bed.x, s->bed.r, &shell, &sum, &both);
  CHECK((status == GSL_SUCCESS) == (sum != before && both != before));
  return status;
}

static int find_neighbors(const struct sample *s) {
  struct neighbors nb = {0};
  const int status = neighbors_find(&nb, s->bed.n, s->bed.x, 3, s->bed.r, 0.01);
  CHECK((status == GSL_SUCCESS) == (nb.count > 0));
  neighbors_free(&nb);
  return status;
}

static int find_network(const struct sample *s) {
  struct network w = {0};
  const int status = network_find(&w, &s->scene, &s->bed, 0.1);
  CHECK((status == GSL_SUCCESS) == (w.count > 0));
  bool *rattler = NULL;
  int more = status;
  if (status == GSL_SUCCESS) {
    rattler = calloc(s->bed.n, sizeof *rattler);
    more = rattler ? network_rattlers(&w, 2, NULL, rattler) : GSL_ENOMEM;
  }
  free(rattler);
  network_free(&w);
  return more;
}

static int find_order(const struct sample *s) {
  struct bond_order order[3];
  return bond_order_find(s->bed.n, s->bed.x, s->scene.period, 0.25, NULL,
                         order);
}

static int find_correlation(const struct sample *s) {
  double pairs[2] = {before}, expected[2] = {before};
  struct region region = {0};
  memcpy(region.box, box, sizeof region.box);
  const int status = correlation_count(s->bed.n, s->bed.x, &region, 0.5, 2,
                                       NULL, pairs, expected);
  CHECK((status == GSL_SUCCESS) == (pairs[0] != before));
  return status;
}

static int find_radii(const struct sample *s) {
  double r = before;
  struct radius_overlaps o;
  int status = radius_touching(&s->scene, s->bed.n, s->bed.x, &r);
  if (status == GSL_SUCCESS)
    status = radius_contact_mean(&s->scene, s->bed.n, s->bed.x, 0.1, &r);
  if (status == GSL_SUCCESS)
    status = radius_overlaps(&s->scene, s->bed.n, s->bed.x, 0.1, &o);
  return status;
}

/* The root's search goes on after a volume that failed, and must not find
   anything. */
static int find_radius_of_fraction(const struct sample *s) {
  double r = before;
  const int status = radius_of_fraction(&s->scene, s->bed.n, s->bed.x, box,
                                        0.01, false, NULL, &r);
  CHECK((status == GSL_SUCCESS) == (r != before));
  return status;
}

static int find_voxels(const struct sample *s) {
  static const size_t cells[3] = {4, 4, 4};
  struct voxels *v = NULL;
  double value[16];
  int status = voxels_open(
      &v, &(struct solid){.n = s->bed.n, .x = s->bed.x, .r = s->bed.r}, box,
      cells);
  CHECK((status == GSL_SUCCESS) == (v != NULL));
  for (int what = VOXELS_FRACTION; what <= VOXELS_DISTANCE; what++)
    if (status == GSL_SUCCESS)
      status = voxels_rows(v, (enum voxels_value)what, 0, 0, 4, 2, value);
  voxels_close(v);
  return status;
}

/* A solid of all spheres with bridges between neighbours; to be freed. */
static int make_solid(const struct sample *s, struct solid *solid,
                      uint32_t (**ends)[2]) {
  *solid = (struct solid){.n = s->bed.n, .x = s->bed.x, .r = s->bed.r};
  *ends = NULL;
  const int status =
      solid_pairs(s->bed.n, s->bed.x, s->bed.r, 0.1, ends, &solid->bridges);
  CHECK((status == GSL_SUCCESS) == (*ends != NULL));
  solid->ends = (const uint32_t(*)[2]) * ends;
  solid->bridge_radius = 0.09;
  return status;
}

static int find_solid_volume(const struct sample *s) {
  /* the box cuts a bridge, which is then integrated */
  static const double part[6] = {0, 0.5, 0, 1, 0, 1};
  struct solid solid;
  uint32_t(*ends)[2];
  struct solid_volume v = {.total = -1};
  int status = make_solid(s, &solid, &ends);
  if (status == GSL_SUCCESS) {
    status = solid_volume(&solid, part, &v);
    CHECK((status == GSL_SUCCESS) == (v.total >= 0 && v.error > 0));
  }
  free(ends);
  return status;
}

static int find_shrink(const struct sample *s) {
  double factor = -1;
  const int status = solid_shrink(s->bed.n, s->bed.x, s->bed.r, 0.001, &factor);
  CHECK((status == GSL_SUCCESS) == (factor > 0));
  return status;
}

static int find_diffuse(const struct sample *s) {
  double mean = -1;
  const int status =
      solid_diffuse(s->bed.n, s->bed.x, s->bed.r, box, 0.1, &mean);
  CHECK((status == GSL_SUCCESS) == (mean >= 0));
  return status;
}

static int find_clearance(const struct sample *s) {
  const struct solid solid = {.n = s->bed.n, .x = s->bed.x, .r = s->bed.r};
  double point[3], clearance = -1;
  const int status = clearance_deepest(&solid, box, point, &clearance);
  CHECK((status == GSL_SUCCESS) == (clearance > 0));
  return status;
}

static void nothing(const double corner[3][3], void *context) {
  (void)corner;
  (void)context;
}

static int walk_surface(const struct sample *s) {
  const struct solid solid = {.n = s->bed.n, .x = s->bed.x, .r = s->bed.r};
  struct surface *f = NULL;
  size_t count = 0;
  int status = surface_open(&f, &solid, box, true, 20);
  CHECK((status == GSL_SUCCESS) == (f != NULL));
  if (status == GSL_SUCCESS) {
    status = surface_walk(f, nothing, NULL, &count);
    CHECK((status == GSL_SUCCESS) == (count > 0));
  }
  surface_close(f);
  return status;
}

static int count_parts(const struct sample *s) {
  struct parts *p = NULL;
  bool solid[100];
  (void)s;
  int status = parts_open(&p, 100, 2, (const bool[3]){true, true, true});
  CHECK((status == GSL_SUCCESS) == (p != NULL));
  for (int row = 0; row < 6 && status == GSL_SUCCESS; row++) {
    for (int i = 0; i < 100; i++)
      solid[i] = (i + row) % 2;
    status = parts_row(p, solid);
  }
  parts_close(p);
  return status;
}

/* Fails the first, second, ... allocation until there are no more. */
static void check_each(const char *what, int (*make)(const struct sample *),
                       const struct sample *s, size_t least) {
  size_t k = 1;
  for (;; k++) {
    calls = 0;
    failing = k;
    const int status = make(s);
    failing = 0;
    if (status == GSL_SUCCESS)
      break;
    if (!CHECK(status == GSL_ENOMEM)) {
      fprintf(stderr, "  %s, allocation %zu: %s\n", what, k,
              gsl_strerror(status));
      break;
    }
  }
  if (!CHECK(k > least)) /* else the allocators were not replaced */
    fprintf(stderr, "  %s: %zu allocations\n", what, k - 1);
}

int main(void) {
  struct sample few, some, many;
  gsl_set_error_handler_off();
  sample_alloc(&few, 3);
  sample_alloc(&some, 12);
  sample_alloc(&many, MANY);
  check_each("scene", make_scene, &few, 4);
  check_each("bed", make_bed, &few, 5);
  check_each("dynamics", make_dynamics, &few, 11);
  check_each("dynamics in order", make_dynamics, &many, 12);
  check_each("rkc", make_rkc, &few, 16);
  check_each("paper", make_paper, &few, 16);
  check_each("standard", make_standard, &few, 16);
  check_each("verlet", make_verlet, &few, 15);
  check_each("multirate", make_multirate, &few, 40);
  check_each("run of multirate", run_multirate, &some, 30);
  check_each("over the floor", make_over_floor, &few, 22);
  check_each("first evaluation", first_evaluation, &few, 4);
  check_each("first evaluation in order", first_evaluation, &many, 6);
  check_each("later evaluation", later_evaluation, &some, 1);
  check_each("chebyshev", make_chebyshev, &few, 8);
  check_each("stiffness", make_stiffness, &few, 2);
  check_each("limits", make_limits, &few, STIFFNESS_RAYS);
  check_each("watch", make_run_watch, &few, 3);
  check_each("crowd", make_crowd, &few, 2);
  for (size_t i = 0; i < few.bed.n; i++) { /* overlapping, inside the walls */
    few.bed.x[3 * i] = few.bed.x[3 * i + 1] = 0.5;
    few.bed.x[3 * i + 2] = 0.05 + 0.15 * (double)i;
  }
  check_each("pushed apart", push_apart, &few, 5);
  check_each("volume", find_volume, &few, 10);
  check_each("sampled volume", sample_volume, &few, 1);
  check_each("area", find_area, &few, 10);
  check_each("shell", find_shell, &few, 16);
  check_each("neighbors", find_neighbors, &few, 5);
  many.bed.r[5] = 1000;
  check_each("neighbors of two sizes", find_neighbors, &many, 7);
  check_each("network", find_network, &few, 7);
  check_each("bond order", find_order, &few, 8);
  check_each("correlation", find_correlation, &few, 7);
  check_each("radii", find_radii, &few, 15);
  check_each("radius of a fraction", find_radius_of_fraction, &few, 100);
  check_each("voxels", find_voxels, &few, 10);
  check_each("volume of a solid", find_solid_volume, &few, 25);
  check_each("shrinking", find_shrink, &few, 3);
  check_each("diffuse profile", find_diffuse, &few, 100);
  check_each("clearance", find_clearance, &few, 1);
  check_each("surface", walk_surface, &few, 5);
  check_each("parts", count_parts, &few, 10);
  sample_free(&few);
  sample_free(&some);
  sample_free(&many);
  return check_done();
}
