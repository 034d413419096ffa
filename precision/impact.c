/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The impacts of Chung and Ooi (Granular Matter 13 (2011) 643), tests 1 to 8,
   without gravity: a sphere on a plane or on another one, with the speeds,
   angles and spins of these tests, and with our law instead of theirs.

   Without gravity F0 and kappa only set how long a contact takes: the normal
   speed afterwards is closed_restitution, and since friction is proportional to
   F, the slip afterwards is that after closed_impulse, whatever they are. The
   spin and the speed along the plane follow from the slip, as friction takes
   both by fixed shares: 2/7 of the slip that it took goes into the speed, 5/7
   into the spin. So errors are of the integration alone, but for pairs that
   rub, whose normal turns a little while they touch, by some 1/(kappa r).

   In the limit of a large psi and a small vmin they are the hard sphere's,
   e v and slip - 7/2 mu (1 + e) v or 0, with phi = mu e; how far off they are
   still is the last column. */
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "model/closed_forms.h"
#include "measure.h"

enum varied { NOTHING, RESTITUTION, ANGLE, TANGENT, SPIN };

struct impact {
  double radius, other; /* m; 0: a plane */
  double speed;         /* along the normal, but with ANGLE that of all (m/s) */
  double e, mu;
  enum varied varied;
  int spheres_that_turn; /* 2: with opposite spins */
};

/* Angles are 5, 10, ..., 85 degrees: of the speed (ANGLE), or their tangents
   are the ratio of slip to speed along the normal. What is not the tests' own
   is e and mu of 5, the radius of the second sphere of 8. */
static const struct impact impacts[8] = {
    {.radius = 0.01, .other = 0.01, .speed = 20, .e = 1},
    {.radius = 0.1, .speed = 0.2, .e = 1},
    {.radius = 0.0025, .speed = 3.9, .varied = RESTITUTION},
    {.radius = 0.0025, .speed = 3.9, .e = 0.98, .mu = 0.092, .varied = ANGLE},
    {.radius = 1e-5, .speed = 5, .e = 1, .mu = 0.3, .varied = TANGENT},
    {0.1, 0, 0.2, 0.5, 0.4, SPIN, 1},
    {0.1, 0.1, 0.4, 0.5, 0.4, SPIN, 2},
    {0.1, 0.4, 0.2, 0.5, 0.4, SPIN, 1}};

enum { ANGLES = 17, RESTITUTIONS = 5 };

/* One of a test's impacts. */
struct hit {
  double e, mu;
  double normal, along; /* speeds of the first sphere to the other (m/s) */
  double spin[2];       /* r w, so that a positive one adds to the slip (m/s) */
};

static size_t hits_of(const struct impact *t) {
  return t->varied == NOTHING       ? 1
         : t->varied == RESTITUTION ? RESTITUTIONS
                                    : ANGLES;
}

static struct hit hit_of(const struct impact *t, size_t k) {
  struct hit h = {.e = t->e, .mu = t->mu, .normal = t->speed};
  const double angle = 5 * M_PI / 180 * (double)(k + 1);
  if (t->varied == RESTITUTION)
    h.e = 0.2 * (double)(k + 1);
  if (t->varied == ANGLE) {
    h.normal = t->speed * cos(angle);
    h.along = t->speed * sin(angle);
  }
  if (t->varied == TANGENT)
    h.along = t->speed * tan(angle);
  if (t->varied == SPIN)
    h.spin[0] = t->speed * tan(angle);
  if (t->spheres_that_turn == 2)
    h.spin[1] = -h.spin[0];
  return h;
}

/* The law's numbers by the test's: impacts are at 100/psi and 1000 vmin. */
static void defaults_of(const struct impact *t, struct precision_case *c) {
  c->law.kappa = 1500 / t->radius;
  c->law.f0 = 0.5 * c->law.kappa * t->speed * t->speed;
  c->law.psi = 100 / t->speed;
  c->law.vmin = t->speed / 1000;
  c->law.lmax = 100 / c->law.kappa;
  c->gravity = 0;
}

/* Two spheres on the z axis, the first one above, or one above the floor, as
   far as contacts store 1e-16 of the energy. */
static int place(const struct impact *t, const struct hit *h, double gap,
                 struct scene *s, struct bed *b) {
  const bool pair = t->other > 0;
  int status = bed_alloc(b, pair ? 2 : 1);
  if (status == GSL_SUCCESS && !pair)
    status = scene_add_wall(s, (double[]){0, 0, 0}, (double[]){0, 0, -1});
  if (status != GSL_SUCCESS)
    return status;
  b->r[0] = t->radius;
  b->x[2] = t->radius + gap;
  b->v[0] = h->along;
  b->v[2] = -h->normal;
  b->w[1] = -h->spin[0] / t->radius;
  if (pair) {
    b->r[1] = t->other;
    b->m[1] = gsl_pow_3(t->other / t->radius);
    b->x[5] = -t->other;
    b->w[4] = -h->spin[1] / t->other;
  }
  return GSL_SUCCESS;
}

/* Along the normal and across it, as the law has it. */
static void speeds(const struct bed *b, double *gap, double *normal,
                   double *slip) {
  double n[3] = {0, 0, 1}, v[3], s[3] = {0}, t[3];
  memcpy(v, b->v, sizeof v);
  *gap = b->x[2] - b->r[0];
  vec3_axpy(b->r[0], b->w, s);
  if (b->n == 2) {
    vec3_sub(b->x, b->x + 3, n);
    const double d = vec3_norm(n);
    *gap = d - b->r[0] - b->r[1];
    for (int k = 0; k < 3; k++)
      n[k] /= d;
    vec3_sub(b->v, b->v + 3, v);
    vec3_axpy(b->r[1], b->w + 3, s);
  }
  *normal = contact_tangent(n, v, s, t);
  *slip = vec3_norm(t);
}

/* Steps until they have parted as far as they began. */
static const char *collide(const struct hit *h, struct motion *m, struct bed *b,
                           double far) {
  const char *word;
  double gap, normal, slip;
  do {
    word = measure_step(m->integrator, 20000000);
    dynamics_unpack(m->dynamics, integrate_state(m->integrator), b);
    speeds(b, &gap, &normal, &slip);
    if (integrate_time(m->integrator) > 1e4 * far / h->normal)
      word = "too_long";
  } while (word == measure_ok && !(normal > 0 && gap > far));
  return word;
}

/* What the first sphere's should be: by the integrals of the law, and hard. */
static int expected(const struct contact_law *law, const struct hit *h,
                    double *normal, double *slip, double *hard) {
  const double before = fabs(h->along + h->spin[0] + h->spin[1]);
  double error;
  int status = closed_restitution(law, h->normal, normal, &error);
  if (status == GSL_SUCCESS)
    status = closed_slip(
        before, law->vmin,
        3.5 * law->friction * closed_impulse(law, h->normal, *normal), slip);
  *hard = fmax(0, before - 3.5 * h->mu * (1 + h->e) * h->normal);
  return status;
}

static int run_hit(const struct impact *t, const struct hit *h,
                   const struct precision_case *c, struct precision_result *r) {
  struct scene s = {.model = SCENE_ROTATION, .law = c->law};
  s.law.restitution = h->e;
  s.law.friction = h->mu * h->e;
  struct bed b = {0};
  struct motion *m = NULL;
  struct integrate_options o = *c->integrate;
  double normal, slip, hard, gap, v, left;
  /* masses of some 1, so energies of the square of a speed */
  const double far =
      log(s.law.f0 / (s.law.kappa * 1e-16 * 0.25 * gsl_pow_2(h->normal))) /
      s.law.kappa;
  o.hinit = GSL_MIN(o.hinit, 1 / (s.law.kappa * t->speed));
  int status = expected(&s.law, h, &normal, &slip, &hard);
  if (status == GSL_SUCCESS)
    status = place(t, h, far, &s, &b);
  if (status == GSL_SUCCESS)
    status =
        motion_alloc(&m, &s, &b, &o, &(struct dynamics_options){.threads = 1},
                     c->travel > 0 ? c->travel : 1 / s.law.kappa);
  if (status == GSL_SUCCESS) {
    measure_start(r);
    const char *word = collide(h, m, &b, far);
    measure_stop(r);
    speeds(&b, &gap, &v, &left);
    const double error[] = {
        fabs(v - normal) / h->normal, fabs(left - slip) / h->normal,
        hypot(v - h->e * h->normal, left - hard) / h->normal};
    measure_add(r, m->integrator, dynamics_counts(m->dynamics).evaluations,
                error, 3);
    if (word != measure_ok)
      r->status = word;
  }
  motion_free(m);
  bed_free(&b);
  scene_free(&s);
  return status;
}

static int run(const struct impact *t, const struct precision_case *c,
               struct precision_result *r) {
  int status = GSL_SUCCESS;
  for (size_t k = 0; k < hits_of(t) && status == GSL_SUCCESS; k++) {
    const struct hit h = hit_of(t, k);
    status = run_hit(t, &h, c, r);
  }
  measure_mean(r);
  return status;
}

/* Scenes have no argument of their own. */
#define TEST(i)                                                                \
  static void defaults_##i(struct precision_case *c) {                         \
    defaults_of(&impacts[i - 1], c);                                           \
  }                                                                            \
  static int run_##i(const struct precision_case *c, const void *reference,    \
                     struct precision_result *r) {                             \
    (void)reference;                                                           \
    return run(&impacts[i - 1], c, r);                                         \
  }
TEST(1)
TEST(2)
TEST(3)
TEST(4)
TEST(5)
TEST(6)
TEST(7)
TEST(8)

#define SCENE(i, summary_)                                                     \
  {                                                                            \
    .name = "impact-" #i, .summary = summary_,                                 \
    .errors = {"error_speed", "error_slip", "error_hard", NULL},               \
    .defaults = defaults_##i, .run = run_##i                                   \
  }
const struct precision_scene scene_impacts[8] = {
    SCENE(1, "Chung and Ooi 1: two equal spheres, e = 1"),
    SCENE(2, "2: a sphere on a plane, e = 1"),
    SCENE(3, "3: the same with e from 0.2 to 1"),
    SCENE(4, "4: at 5 to 85 degrees, e = 0.98, mu = 0.092"),
    SCENE(5, "5: tangential speed of 0.09 to 11 times the normal one"),
    SCENE(6, "6: spin of 0.09 to 11 times the normal speed"),
    SCENE(7, "7: two equal spheres that turn in opposite directions"),
    SCENE(8, "8: two unequal spheres, one turns")};
