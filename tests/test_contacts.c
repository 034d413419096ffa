/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts, their forces, coordination, rattlers and loads (measure/network), a
   scene from a header (program/scene_options), and the rest criterion. */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "dynamics/dynamics.h"
#include "steppers/integrate.h"
#include "lattice.h"
#include "measure/network.h"
#include "program/scene_options.h"

static const double eps = GSL_DBL_EPSILON;

static struct bed make_bed(size_t n) {
  struct bed b = {0};
  if (bed_alloc(&b, n) != GSL_SUCCESS)
    exit(1);
  return b;
}

/* Spheres of several sizes and masses, overlapping each other and the walls,
   moving and spinning. */
static struct bed tangle(size_t n, unsigned long seed) {
  struct bed b = make_bed(n);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 3; k++) {
      b.x[3 * i + k] = 0.05 + 0.9 * gsl_rng_uniform(rng);
      b.v[3 * i + k] = 0.05 * (gsl_rng_uniform(rng) - 0.5);
      b.w[3 * i + k] = gsl_rng_uniform(rng) - 0.5;
    }
    b.r[i] = 0.05 + 0.05 * gsl_rng_uniform(rng);
    b.m[i] = 0.5 + gsl_rng_uniform(rng);
  }
  gsl_rng_free(rng);
  return b;
}

/* Forces contact by contact add up to what the right-hand side has. The scale
   of rounding is the sum of the magnitudes; libmvec's exp is good to 4 ulp and
   a gap's rounding is magnified by kappa. */
static void test_against_dynamics(enum scene_model model) {
  struct scene s = scene_default();
  s.model = model;
  s.gravity[0] = 1;
  CHECK(scene_add_box(&s, 1, 1) == GSL_SUCCESS);
  struct bed b = tangle(60, 7);
  struct network w = {0};
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  CHECK(w.count > 100);
  double *force = calloc(3 * b.n, sizeof *force);
  double *scale = calloc(b.n, sizeof *scale);
  network_net_force(&w, &s, &b, force);
  size_t rubbing = 0;
  for (size_t p = 0; p < w.count; p++) {
    const struct network_contact *c = &w.at[p];
    const double size = c->normal + vec3_norm(c->friction);
    rubbing += vec3_norm(c->friction) > 0;
    CHECK(fabs(vec3_dot(c->n, c->friction)) <= 8 * eps * size);
    scale[c->i] += size;
    if (!c->wall)
      scale[c->j] += size;
  }
  CHECK((rubbing > 0) == (model != SCENE_BASIC));
  struct dynamics *d = NULL;
  CHECK(dynamics_alloc(&d, &s, &b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
  const size_t dim = dynamics_dimension(d), stride = dynamics_stride(d);
  double *y = calloc(dim, sizeof *y), *dydt = calloc(dim, sizeof *dydt);
  dynamics_pack(d, &b, y);
  CHECK(dynamics_rhs(0, y, dydt, d) == GSL_SUCCESS);
  for (size_t i = 0; i < b.n; i++)
    for (size_t k = 0; k < 3; k++) {
      const double tol =
          eps * (20 + 4 * s.law.kappa) * (scale[i] + b.m[i] * 9.81);
      CHECK_CLOSE(force[3 * i + k], b.m[i] * dydt[i * stride + 3 + k], tol);
    }
  dynamics_free(d);

  /* what the walls carry and what is left over are the weight */
  double sum[3] = {0}, size = 0;
  for (size_t i = 0; i < b.n; i++) {
    vec3_axpy(1, force + 3 * i, sum);
    vec3_axpy(-b.m[i], s.gravity, sum);
    size += scale[i];
  }
  for (size_t k = 0; k < s.walls_count; k++) {
    double load[3];
    network_wall_load(&w, k, load);
    vec3_axpy(1, load, sum);
  }
  for (int k = 0; k < 3; k++)
    CHECK_CLOSE(sum[k], 0, eps * 20 * size);
  free(force);
  free(scale);
  free(y);
  free(dydt);
  network_free(&w);
  bed_free(&b);
  scene_free(&s);
}

/* Two spheres at rest that overlap: F0 exp(-kappa l) (1 + e^2)/2, and the same
   for unequal ones. */
static void test_two_spheres(void) {
  struct scene s = scene_default();
  struct bed b = make_bed(2);
  struct network w = {0};
  b.r[0] = 0.1;
  b.r[1] = 0.07;
  b.x[0] = 0.5;
  b.x[3] = 0.5 + 0.17 - 0.012;
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  CHECK(w.count == 1 && !w.at[0].wall && w.at[0].i == 0 && w.at[0].j == 1);
  CHECK_CLOSE(w.at[0].gap, -0.012, 4 * eps);
  CHECK_REL(w.at[0].normal, 10 * exp(150 * 0.012) * (1 + 0.16) / 2,
            4 * eps * 150);
  CHECK(vec3_norm(w.at[0].friction) == 0);
  CHECK_CLOSE(w.at[0].n[0], -1, eps);
  double x[3];
  network_point(&w.at[0], &b, x);
  CHECK_CLOSE(x[0], 0.5 + 0.1 - 0.006, 4 * eps); /* between the surfaces */

  /* gap, and force: each threshold from both sides */
  network_mark(&w, 0, 0);
  CHECK(w.at[0].counts);
  network_mark(&w, -0.0121, 0);
  CHECK(!w.at[0].counts);
  network_mark(&w, -1, w.at[0].normal * 0.999);
  CHECK(w.at[0].counts);
  network_mark(&w, 1, w.at[0].normal * 1.001);
  CHECK(!w.at[0].counts);

  /* beyond lmax there is no force, though it may be listed */
  b.x[3] = 0.5 + 0.17 + 0.11;
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS && w.count == 0);
  CHECK(network_find(&w, &s, &b, 0.12) == GSL_SUCCESS && w.count == 1);
  CHECK(w.at[0].normal == 0);

  memcpy(b.x, b.x + 3, 3 * sizeof *b.x);
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_EDOM && w.count == 0);
  b.x[1] = GSL_NAN;
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_EINVAL && w.count == 0);
  network_free(&w);
  bed_free(&b);
}

/* Friction on the floor: phi F Sigma(v) against the slip, none in rolling. */
static void test_slip(void) {
  struct scene s = scene_default();
  struct bed b = make_bed(1);
  struct network w = {0};
  const double v = 0.004;
  CHECK(scene_add_wall(&s, (double[]){0, 0, 0}, (double[]){0, 0, -2}) ==
        GSL_SUCCESS);
  b.r[0] = 0.1;
  b.x[2] = 0.09;
  b.v[0] = v;
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS && w.count == 1);
  const double push = 10 * exp(1.5), limit = 3 * 0.16 - 2 * 0.064;
  CHECK_REL(w.at[0].normal, push * 0.58, 1e-13);
  CHECK_REL(w.at[0].friction[0], -0.2 * push * limit, 1e-13);
  CHECK(w.at[0].friction[1] == 0 && w.at[0].friction[2] == 0);
  double load[3];
  network_wall_load(&w, 0, load);
  CHECK_REL(load[2], -push * 0.58, 1e-13);
  CHECK_REL(load[0], 0.2 * push * limit, 1e-13);
  b.w[1] = v / b.r[0];
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  CHECK_CLOSE(w.at[0].friction[0], 0, 1e-13);
  s.model = SCENE_FRICTION; /* spins are none of its business */
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  CHECK_REL(w.at[0].friction[0], -0.2 * push * limit, 1e-13);
  network_free(&w);
  bed_free(&b);
  scene_free(&s);
}

/* A column at rest in closed form: the k-th contact from above carries k
   weights, F(l) rho(0) = k m g. */
static void test_column(void) {
  enum { N = 12 };
  struct scene s = scene_default();
  CHECK(scene_add_box(&s, 1, 1) == GSL_SUCCESS);
  const double e = s.law.restitution, r = 0.1, m = 1.5, weight = 9.81 * m;
  struct bed b = make_bed(N);
  double z = 0;
  for (size_t i = 0; i < N; i++) {
    const double carried = (double)(N - i) * weight;
    const double gap = -log(carried / (10 * (1 + e * e) / 2)) / s.law.kappa;
    z += gap + (i ? 2 * r : r);
    b.x[3 * i] = b.x[3 * i + 1] = 0.5;
    b.x[3 * i + 2] = z;
    b.r[i] = r;
    b.m[i] = m;
  }
  struct network w = {0};
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS && w.count == N);
  for (size_t i = 0; i + 1 < N; i++)
    CHECK_REL(w.at[i].normal, (double)(N - 1 - i) * weight, 1e-9);
  double load[3], force[3 * N];
  network_wall_load(&w, 0, load);
  CHECK_REL(load[2], -N * weight, 1e-9);
  network_net_force(&w, &s, &b, force);
  for (size_t k = 0; k < 3 * N; k++)
    CHECK_CLOSE(force[k], 0, 1e-9 * weight);
  double fabric[7] = {[6] = 17}; /* six of it are written */
  CHECK(network_fabric(&w, &b, NULL, fabric) == N - 1);
  CHECK(fabric[6] == 17);
  CHECK_CLOSE(fabric[2], 1, eps);
  CHECK_CLOSE(network_anisotropy(fabric), 1, 4 * eps);
  network_free(&w);
  bed_free(&b);
  scene_free(&s);
}

/* Coordination of the inside; cubic and ideal hexagonal fabrics are
   isotropic. */
static void test_lattice(const char *name, size_t want) {
  const struct lattice l = lattice_named(name);
  struct scene s = scene_default();
  struct bed b;
  struct network w = {0};
  size_t centre = 0;
  CHECK(lattice_bed(&l, 6, &b, &centre) == GSL_SUCCESS);
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  /* spheres touch to within the rounding of coordinates */
  network_mark(&w, 1e-12, 0);
  size_t *degree = calloc(2 * b.n, sizeof *degree), least = 100, most = 0;
  network_degrees(&w, NULL, degree, degree + b.n);
  CHECK(degree[centre] == want);
  double near[6], fabric[6];
  for (size_t i = 0; i < b.n; i++) {
    bool inside = true;
    for (size_t k = 0; k < 3; k++)
      inside = inside && fabs(b.x[3 * i + k]) < 1.5;
    if (inside) {
      least = GSL_MIN(least, degree[i]);
      most = GSL_MAX(most, degree[i]);
    }
    CHECK(degree[i] == degree[b.n + i]);
  }
  CHECK(least == want && most == want);
  /* all contacts of the sphere in the middle and no others */
  for (size_t k = 0; k < 6; k++)
    near[k] = b.x[3 * centre + k / 2] + (k % 2 ? 0.51 : -0.51);
  CHECK(network_fabric(&w, &b, near, fabric) == want);
  for (int k = 0; k < 6; k++)
    CHECK_CLOSE(fabric[k], k < 3 ? 1. / 3 : 0, 8 * eps);
  CHECK_CLOSE(network_anisotropy(fabric), 0, 32 * eps);
  free(degree);
  network_free(&w);
  bed_free(&b);
}

/* A ring of six with a tail of three: the tail goes one by one, the ring
   stays; a chain goes altogether. */
static size_t rattlers(const struct network *w, size_t least, bool *rattler) {
  CHECK(network_rattlers(w, least, NULL, rattler) == GSL_SUCCESS);
  size_t count = 0;
  for (size_t i = 0; i < w->spheres; i++)
    count += rattler[i];
  return count;
}

static void test_rattlers(void) {
  enum { RING = 6, TAIL = 3, N = RING + TAIL };
  struct scene s = scene_default();
  struct bed b = make_bed(N);
  struct network w = {0};
  bool rattler[N];
  size_t degree[N], with_spheres[N];
  for (size_t i = 0; i < N; i++) {
    const double angle = M_PI / 3 * (double)i;
    b.r[i] = 0.1;
    b.x[3 * i] = i < RING ? 0.2 * cos(angle) : 0.2 * (double)(i - RING + 2);
    b.x[3 * i + 1] = i < RING ? 0.2 * sin(angle) : 0;
  }
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  network_mark(&w, 1e-9, 0);
  CHECK(rattlers(&w, 2, rattler) == TAIL);
  for (size_t i = 0; i < N; i++)
    CHECK(rattler[i] == (i >= RING));
  network_degrees(&w, rattler, degree, with_spheres);
  for (size_t i = 0; i < N; i++)
    CHECK(degree[i] == (i < RING ? 2 : 0));
  CHECK(rattlers(&w, 3, rattler) == N);
  CHECK(rattlers(&w, 1, rattler) == 0);

  /* a wall holds what it touches: the tail's end has two contacts now */
  const double end = b.x[3 * (N - 1)] + 0.1;
  CHECK(scene_add_wall(&s, (double[]){end, 0, 0}, (double[]){1, 0, 0}) ==
        GSL_SUCCESS);
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  network_mark(&w, 1e-9, 0);
  CHECK(rattlers(&w, 2, rattler) == 0);
  network_degrees(&w, NULL, degree, with_spheres);
  CHECK(degree[N - 1] == 2 && with_spheres[N - 1] == 1);
  CHECK(degree[0] == 3 && with_spheres[0] == 3);
  network_free(&w);
  bed_free(&b);
  scene_free(&s);
}

/* Contacts that all point one way, whichever, are as far from isotropic as can
   be: 1; that is no matter of axes. Two ways at right angles: D is diag(1/6,
   1/6, -1/3), so 1/2. */
static void test_anisotropy(void) {
  const double n[3] = {2. / 7, 3. / 7, 6. / 7},
               m[3] = {6. / 7, 2. / 7, -3. / 7};
  double one[6], two[6];
  for (int k = 0; k < 6; k++) {
    const int i = k < 3 ? k : k == 5, j = k < 3 ? k : k == 3 ? 1 : 2;
    one[k] = n[i] * n[j];
    two[k] = 0.5 * (n[i] * n[j] + m[i] * m[j]);
  }
  CHECK_CLOSE(network_anisotropy(one), 1, 8 * eps);
  CHECK_CLOSE(network_anisotropy(two), 0.5, 8 * eps);
}

/* Integration's params. */
static int rhs(double t, const double y[], double dydt[], void *d) {
  return dynamics_rhs(t, y, dydt, d);
}

/* A small bed settled by the integrator itself: the walls carry it but for its
   last bit of acceleration. */
static void test_settled(void) {
  struct scene s = scene_default();
  CHECK(scene_add_box(&s, 0.5, 0.5) == GSL_SUCCESS);
  struct bed b = make_bed(12);
  for (size_t i = 0; i < b.n; i++) {
    b.r[i] = 0.1;
    b.x[3 * i] = i % 2 ? 0.14 : 0.37;
    b.x[3 * i + 1] = i / 2 % 2 ? 0.13 : 0.36;
    b.x[3 * i + 2] = 0.12 + 0.21 * (double)(i / 4) + 0.005 * (double)(i % 3);
  }
  struct dynamics *d = NULL;
  CHECK(dynamics_alloc(&d, &s, &b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
  const size_t dim = dynamics_dimension(d);
  double *y = calloc(dim, sizeof *y), *dydt = calloc(dim, sizeof *dydt);
  double *scale = calloc(dim, sizeof *scale);
  dynamics_pack(d, &b, y);
  dynamics_scale(d, scale);
  struct integrate_options o = {.method = "rkc", .hinit = 1e-3};
  integrate_defaults(&o);
  struct integrator *integrator = NULL;
  const struct integrate_problem problem = {
      .system = {.function = rhs, .dimension = dim, .params = d},
      .scale = scale,
      .row = dynamics_stride(d),
      .positions = 3};
  CHECK(integrate_alloc(&integrator, &o, &problem, 0, y) == GSL_SUCCESS);
  int status = GSL_SUCCESS;
  while (status == GSL_SUCCESS && integrate_time(integrator) < 3)
    status = integrate_step(integrator);
  CHECK(status == GSL_SUCCESS);
  memcpy(y, integrate_state(integrator), dim * sizeof *y);
  dynamics_unpack(d, y, &b);
  CHECK(dynamics_rhs(3, y, dydt, d) == GSL_SUCCESS);
  CHECK(dynamics_fastest(d, y) < s.law.vmin);

  struct network w = {0};
  CHECK(network_find(&w, &s, &b, s.law.lmax) == GSL_SUCCESS);
  double *force = calloc(3 * b.n, sizeof *force);
  network_net_force(&w, &s, &b, force);
  const size_t stride = dynamics_stride(d);
  double up = 0, inertia = 0;
  for (size_t i = 0; i < b.n; i++) {
    for (size_t k = 0; k < 3; k++) /* forces of some n weights, 4 ulp each */
      CHECK_CLOSE(force[3 * i + k], dydt[i * stride + 3 + k],
                  eps * 4 * s.law.kappa * 9.81 * (double)b.n);
    inertia += dydt[i * stride + 5];
  }
  for (size_t k = 0; k < s.walls_count; k++) {
    double load[3];
    network_wall_load(&w, k, load);
    up -= load[2];
  }
  CHECK_REL(up, 9.81 * (double)b.n + inertia, 1e-12);
  CHECK_REL(up, 9.81 * (double)b.n, 1e-2); /* it has come to rest, about */
  network_free(&w);
  integrate_free(integrator);
  dynamics_free(d);
  free(force);
  free(y);
  free(dydt);
  free(scale);
  bed_free(&b);
  scene_free(&s);
}

static void test_header(void) {
  struct scene s;
  struct bed_header h = {0};
  CHECK(scene_from_header(&s, NULL, NULL) == NULL);
  CHECK(s.walls_count == 0 && s.gravity[2] == -9.81 && s.law.kappa == 150 &&
        s.model == SCENE_ROTATION);
  scene_free(&s);
  const char *const keys[][2] = {
      {"model", "basic"},     {"kappa", "33.5"},    {"seed", "not ours"},
      {"radius", "0.2"},      {"gravity", "1,2,3"}, {"wall", "0 0 0 0 0 -2"},
      {"wall", "1 0 0 1 0 0"}};
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
    CHECK(bed_header_add(&h, keys[k][0], keys[k][1]) == GSL_SUCCESS);
  CHECK(scene_from_header(&s, &h, NULL) == NULL);
  CHECK(s.model == SCENE_BASIC && s.law.kappa == 33.5 && s.law.f0 == 10);
  CHECK(s.gravity[0] == 1 && s.gravity[1] == 2 && s.gravity[2] == 3);
  CHECK(s.walls_count == 2 && s.walls[0].normal[2] == -1 &&
        s.walls[1].point[0] == 1);
  scene_free(&s);
  const char *const bad[][3] = {{"model", "rough", "model=rough"},
                                {"friction", "-1", "friction=-1"},
                                {"vmin", "0", "vmin=0"},
                                {"gravity", "1,2", "one number or three"},
                                {"wall", "0 0 0 0 0 0", "wall="},
                                {"wall", "0 0 0 0 1", "wall="}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    struct bed_header wrong = {0};
    CHECK(bed_header_add(&wrong, bad[k][0], bad[k][1]) == GSL_SUCCESS);
    const char *what = scene_from_header(&s, &wrong, NULL);
    CHECK(what && strstr(what, bad[k][2]) && strstr(what, "expected"));
    scene_free(&s);
    bed_header_free(&wrong);
  }
  bed_header_free(&h);
}

/* Across a periodic side, the contact is that with the nearest image: 0.125 m
   apart, where the spheres themselves are 0.875 m apart. */
static void test_image(void) {
  struct scene s = scene_default();
  struct bed b;
  struct network w = {0};
  s.period[0] = 1;
  CHECK(bed_alloc(&b, 2) == GSL_SUCCESS);
  for (size_t i = 0; i < 2; i++) {
    b.r[i] = 0.125;
    b.m[i] = 1;
    b.x[3 * i] = i ? 0.9375 : 0.0625;
  }
  CHECK(network_find(&w, &s, &b, 0) == GSL_SUCCESS);
  if (CHECK(w.count == 1)) {
    const struct network_contact *c = w.at;
    CHECK(c->i == 0 && c->j == 1 && c->gap == -0.125);
    CHECK(c->n[0] == 1 && c->n[1] == 0 && c->n[2] == 0);
  }
  network_free(&w);
  bed_free(&b);
  scene_free(&s);
}

int main(void) {
  gsl_set_error_handler_off();
  test_against_dynamics(SCENE_BASIC);
  test_against_dynamics(SCENE_FRICTION);
  test_against_dynamics(SCENE_ROTATION);
  test_two_spheres();
  test_slip();
  test_column();
  test_lattice("sc", 6);
  test_lattice("bcc", 8);
  test_lattice("fcc", 12);
  test_lattice("hcp", 12);
  test_rattlers();
  test_anisotropy();
  test_settled();
  test_header();
  test_image();
  return check_done();
}
