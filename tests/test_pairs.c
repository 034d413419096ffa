/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Collisions of unequal spheres and rolling, integrated, against closed forms:
   what is conserved with which lever arms, that nothing slips in a pair that
   turns as one body, what friction means in an impact and at rest, and how a
   sphere that rolls comes to rest. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_odeiv2.h>
#include "check.h"
#include "dynamics/dynamics.h"

/* Two spheres, m and kg. */
static const double radius[] = {0.1, 0.03}, mass[] = {1, 0.05};

static struct scene pair_scene(enum contact_lever lever) {
  struct scene s = scene_default();
  s.gravity[2] = 0;
  s.law.lever = lever;
  return s;
}

static struct bed new_bed(size_t n) {
  struct bed b;
  CHECK(bed_alloc(&b, n) == GSL_SUCCESS);
  for (size_t i = 0; i < n; i++) {
    b.r[i] = radius[i];
    b.m[i] = mass[i];
  }
  return b;
}

/* From b.t to the time, to a local error of 1e-12. */
static void integrate(const struct scene *s, struct bed *b, double time) {
  struct dynamics *d = NULL;
  CHECK(dynamics_alloc(&d, s, b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
  double y[18];
  dynamics_pack(d, b, y);
  gsl_odeiv2_system system = {dynamics_rhs, NULL, dynamics_dimension(d), d};
  gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(
      &system, gsl_odeiv2_step_rk8pd, 1e-6, 1e-12, 0);
  gsl_odeiv2_driver_set_hmax(driver, 1e-3); /* the contact is not missed */
  CHECK(gsl_odeiv2_driver_apply(driver, &b->t, time, y) == GSL_SUCCESS);
  gsl_odeiv2_driver_free(driver);
  dynamics_unpack(d, y, b);
  dynamics_free(d);
}

/* Of all spheres, about the origin (kg m^2/s). */
static void angular_momentum(const struct bed *b, double sum[3]) {
  sum[0] = sum[1] = sum[2] = 0;
  for (size_t i = 0; i < b->n; i++) {
    double orbit[3];
    vec3_cross(b->x + 3 * i, b->v + 3 * i, orbit);
    vec3_axpy(b->m[i], orbit, sum);
    vec3_axpy(0.4 * b->m[i] * b->r[i] * b->r[i], b->w + 3 * i, sum);
  }
}

static void momentum(const struct bed *b, double sum[3]) {
  sum[0] = sum[1] = sum[2] = 0;
  for (size_t i = 0; i < b->n; i++)
    vec3_axpy(b->m[i], b->v + 3 * i, sum);
}

/* An oblique impact with spin. Momentum is kept with any arms; the angular one
   with those of the contact point, and not with the paper's: there l n x f is
   left, with overlaps of some millimetres. */
static void test_impact(void) {
  for (int lever = LEVER_PAPER; lever <= LEVER_CONTACT; lever++)
    for (int rolling = 0; rolling < 2; rolling++) {
      struct scene s = pair_scene((enum contact_lever)lever);
      s.law.rolling = 0.1 * rolling;
      struct bed b = new_bed(2);
      memcpy(b.x + 3, (double[]){0.25, 0.05, 0.01}, 3 * sizeof(double));
      memcpy(b.v + 3, (double[]){-3, 0.5, 0.2}, 3 * sizeof(double));
      memcpy(b.w, (double[]){1, -4, 5, 20, 3, -8}, 6 * sizeof(double));
      double p[2][3], l[2][3], by_momentum = 0, by_spin = 0;
      momentum(&b, p[0]);
      angular_momentum(&b, l[0]);
      integrate(&s, &b, 0.15);
      momentum(&b, p[1]);
      angular_momentum(&b, l[1]);
      double u[3];
      vec3_sub(b.x + 3, b.x, u);
      CHECK(vec3_norm(u) > 0.13 + 0.05); /* they met and parted */
      CHECK(b.v[3] > -1);
      for (int k = 0; k < 3; k++) {
        by_momentum = GSL_MAX(by_momentum, fabs(p[1][k] - p[0][k]));
        by_spin = GSL_MAX(by_spin, fabs(l[1][k] - l[0][k]));
      }
      /* p is some 0.15 kg m/s, l 0.02; errors of a few hundred steps */
      CHECK(by_momentum < 1e-10);
      if (lever == LEVER_CONTACT)
        CHECK(by_spin < 1e-10);
      else
        CHECK(by_spin > 1e-5);
      bed_free(&b);
    }
}

/* Two spheres that turn about their common centre as one body have no slip with
   the arms of the contact point, so friction does nothing. With the paper's it
   pulls as (2.6) does at the slip l W. */
static void test_one_body(void) {
  for (int lever = LEVER_PAPER; lever <= LEVER_CONTACT; lever++) {
    struct scene s = pair_scene((enum contact_lever)lever);
    struct bed b = new_bed(2);
    const double gap = -0.004, d = radius[0] + radius[1] + gap, w = 1.7;
    const double centre = d * mass[1] / (mass[0] + mass[1]);
    b.x[0] = -centre;
    b.x[3] = d - centre;
    b.v[1] = w * b.x[0]; /* W along z */
    b.v[4] = w * b.x[3];
    b.w[2] = b.w[5] = w;
    struct dynamics *dy = NULL;
    CHECK(
        dynamics_alloc(&dy, &s, &b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
    double y[18], rate[18];
    dynamics_pack(dy, &b, y);
    CHECK(dynamics_rhs(0, y, rate, dy) == GSL_SUCCESS);
    const double f = s.law.f0 * exp(-s.law.kappa * gap);
    const double slip = fabs(gap) * w / s.law.vmin;
    CHECK(slip < 1);
    const double pull = s.law.friction * f * (3 - 2 * slip) * slip * slip;
    const double want = lever == LEVER_CONTACT ? 0 : pull;
    /* rounding of speeds by the slope of Sigma */
    const double tol = 1e-15 * w / s.law.vmin * f;
    CHECK_CLOSE(fabs(rate[4]) * mass[0], want, tol);
    CHECK_CLOSE(fabs(rate[13]) * mass[1], want, tol);
    CHECK_CLOSE(
        rate[8],
        rate[17] * (want > 0 ? mass[1] * radius[1] / (mass[0] * radius[0]) : 1),
        2.5 * tol / (mass[1] * radius[1]));
    dynamics_free(dy);
    bed_free(&b);
  }
}

/* A floor. */
static struct scene floor_scene(double e) {
  struct scene s = scene_default();
  s.law.restitution = e;
  const double point[3] = {0}, down[3] = {0, 0, -1};
  CHECK(scene_add_wall(&s, point, down) == GSL_SUCCESS);
  return s;
}

/* In an impact the integral of F is m v (1 + 1/e) in the limit of a large psi:
   gross sliding changes the tangential velocity by phi (1 + 1/e) v, which is
   Coulomb's friction with phi/e, and the spin by 5/2 of it over r. The exact
   integral for a finite psi: m v_out/e^2 of unloading, since there F rho =
   e^2 F but for slow approach, where rho is between; so the figure is within
   the share of the speed that psi blurs, some 1/(psi v). */
static void test_friction_of_impact(void) {
  for (int k = 0; k < 3; k++) {
    const double e = (double[]){0.4, 0.7, 1}[k], v = 4;
    struct scene s = floor_scene(e);
    s.gravity[2] = 0;
    s.law.psi = 100;
    struct bed b = new_bed(1);
    b.x[2] = radius[0] + 0.15;
    b.v[0] = 20; /* slides all the time */
    b.v[2] = -v;
    integrate(&s, &b, 0.3);
    CHECK_REL(b.v[2], e * v, 0.01);
    const double slid = s.law.friction * (1 + 1 / e) * v;
    CHECK_REL(20 - b.v[0], slid, 0.01);
    CHECK_REL(b.w[1], 2.5 * (20 - b.v[0]) / radius[0], 1e-9);
    scene_free(&s);
    bed_free(&b);
  }
}

/* At rest the floor carries rho(0) F = m g, so that friction holds up to phi F
   = 2 phi/(1 + e^2) m g: on a slope below that a body creeps at s vmin, where 3
   s^2 - 2 s^3 is the share of the limit that the slope asks for; above it goes
   on, faster and faster. The model without spin: a block. */
static void test_friction_at_rest(void) {
  for (int steep = 0; steep < 2; steep++) {
    struct scene s = floor_scene(0.4);
    s.model = SCENE_FRICTION;
    const double most = 2 * s.law.friction / (1 + 0.4 * 0.4);
    const double share = steep ? 1.1 : 0.5; /* 3 s^2 - 2 s^3 = 1/2: s = 1/2 */
    const double g = 9.81, angle = atan(share * most);
    s.gravity[0] = g * sin(angle);
    s.gravity[2] = -g * cos(angle);
    struct bed b = new_bed(1);
    const double load = 2 / (1 + 0.4 * 0.4) * g * cos(angle);
    b.x[2] = radius[0] - log(load / s.law.f0) / s.law.kappa;
    integrate(&s, &b, 1);
    if (steep) /* the rest of the limit accelerates, once vmin is passed */
      CHECK_REL(b.v[0], (share - 1) * most * g * cos(angle), 0.05);
    else
      CHECK_REL(b.v[0], s.law.vmin / 2, 1e-6);
    scene_free(&s);
    bed_free(&b);
  }
}

/* A sphere that rolls slows down by 5/7 X 2 g/(1 + e^2), after it has come to
   slip as little as that friction asks for, and then stands still: from v its
   way is v^2/2 over that, and a little more of creep. Without resistance it
   rolls on. */
static void test_rolling(void) {
  const double e = 0.4, g = 9.81, start = 0.5;
  for (int lever = LEVER_PAPER; lever <= LEVER_CONTACT; lever++)
    for (int k = 0; k < 3; k++) {
      const double x = (double[]){0, 0.05, 0.1}[k];
      struct scene s = floor_scene(e);
      s.law.lever = (enum contact_lever)lever;
      s.law.rolling = x;
      s.law.vmin = 1e-3;
      struct bed b = new_bed(1);
      const double load = 2 / (1 + e * e) * g;
      const double gap = -log(load / s.law.f0) / s.law.kappa;
      const double arm = radius[0] + (lever == LEVER_CONTACT ? 0.5 * gap : 0);
      b.x[2] = radius[0] + gap;
      b.v[0] = start;
      b.w[1] = start / arm;
      /* with an arm a, of m a v' = -friction a ... = -X F r - I w', w' = v'/a:
         v' = -X F r / (m a + I/a), which is 5/7 X F/m for a = r */
      const double slows =
          x * load * radius[0] / (arm + 0.4 * radius[0] * radius[0] / arm);
      if (lever == LEVER_PAPER)
        CHECK_REL(slows, 5. / 7 * x * load, 1e-12);
      double before =
          0.5 * start * start * (1 + 0.4 * gsl_pow_2(radius[0] / arm));
      for (int step = 1; step <= 4; step++) {
        integrate(&s, &b, 0.05 * step);
        /* it slips by less than vmin more than it did */
        CHECK_CLOSE(b.v[0], start - slows * b.t, 1e-3);
        const double energy =
            0.5 * (gsl_pow_2(b.v[0]) + 0.4 * gsl_pow_2(radius[0] * b.w[1]));
        if (x > 0)
          CHECK(energy < before);
        else
          CHECK_CLOSE(energy, before, 1e-9);
        before = energy;
      }
      if (x > 0) {
        integrate(&s, &b, 3);
        CHECK(fabs(b.v[0]) < 1e-3 && fabs(radius[0] * b.w[1]) < 1e-3);
        CHECK_CLOSE(b.x[0], start * start / (2 * slows), 0.01);
      }
      scene_free(&s);
      bed_free(&b);
    }
}

int main(void) {
  test_impact();
  test_one_body();
  test_friction_of_impact();
  test_friction_at_rest();
  test_rolling();
  return check_done();
}
