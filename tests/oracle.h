/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The right-hand side (2.13)-(2.15) as the paper writes it: every pair, every
   wall, one formula after the other, without regard to speed. The optimised
   kernels are compared with it; it shares the structs scene and bed with them
   and no code. Beyond the paper: radii r_i and masses m_i, so gaps d - r_i -
   r_j, torques with a sphere's own radius, I_i = 2/5 m_i r_i^2; and what
   model/contact.h says of lever arms and of rolling resistance. */
#ifndef ORACLE_H
#define ORACLE_H

#include <math.h>
#include <stddef.h>
#include "model/bed.h"
#include "model/scene.h"

/* The effect of a contact on sphere i, and the quantities it follows from. */
struct oracle_contact {
  double gap;           /* l, between the surfaces (m) */
  double n[3];          /* unit vector from the other body to the sphere */
  double rate;          /* l' (m/s) */
  double t[3];          /* slip velocity (m/s) */
  double repulsion;     /* F[l] (N), 0 beyond lmax */
  double rep[3], fr[3]; /* forces (N) */
  double torque[3];     /* (N m) */
  double roll;          /* speed of rolling (m/s) */
};

/* (2.1) */
static inline double oracle_f(const struct scene *s, double l) {
  return l > s->law.lmax ? 0 : s->law.f0 * exp(-s->law.kappa * l);
}

/* (2.4) */
static inline double oracle_rho(const struct scene *s, double v) {
  const double e = s->law.restitution;
  return e * e + 0.5 * (1 - e * e) * (1 + tanh(s->law.psi * v));
}

/* (2.8) */
static inline double oracle_sigma(const struct scene *s, double v) {
  const double vmin = s->law.vmin;
  return v < vmin
             ? 3 * v * v / (vmin * vmin) - 2 * v * v * v / (vmin * vmin * vmin)
             : 1;
}

/* The variants of section 3: basic is phi = 0, friction is I -> infinity with
   spins that start at 0. */
static inline double oracle_phi(const struct scene *s) {
  return s->model == SCENE_BASIC ? 0 : s->law.friction;
}

static inline double oracle_spin(const struct scene *s, const struct bed *b,
                                 size_t i, size_t c) {
  return s->model == SCENE_ROTATION ? b->w[3 * i + c] : 0;
}

static inline void oracle_cross(const double a[3], const double b[3],
                                double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double oracle_norm(const double a[3]) {
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* (2.6), (2.9) */
static inline void oracle_friction(const struct scene *s,
                                   struct oracle_contact *c) {
  const double v = oracle_norm(c->t);
  for (int k = 0; k < 3; k++)
    c->fr[k] = v == 0 ? 0
                      : -oracle_phi(s) * c->repulsion * oracle_sigma(s, v) *
                            c->t[k] / v;
}

/* Centre to contact point: that halves the gap, or is on the surface. */
static inline double oracle_arm(const struct scene *s, double r, double gap) {
  return s->law.lever == LEVER_CONTACT ? r + gap / 2 : r;
}

/* Adds the torque of rolling resistance. w: difference of spins; radius:
   reduced. */
static inline void oracle_roll(const struct scene *s, double radius,
                               const double w[3], struct oracle_contact *c) {
  double wxn[3], u[3];
  oracle_cross(w, c->n, wxn);
  oracle_cross(c->n, wxn, u); /* n x (w x n) is w without its part along n */
  for (int k = 0; k < 3; k++)
    u[k] *= radius;
  const double v = c->roll = oracle_norm(u);
  for (int k = 0; k < 3 && v > 0; k++)
    c->torque[k] -=
        s->law.rolling * c->repulsion * radius * oracle_sigma(s, v) * u[k] / v;
}

/* Spheres i and j: (2.2), (2.3), (2.6), (2.7), (2.11). */
static inline struct oracle_contact
oracle_pair(const struct scene *s, const struct bed *b, size_t i, size_t j) {
  struct oracle_contact c;
  double x[3], v[3], w[3], rw[3], rwxx[3], xxf[3];
  for (size_t k = 0; k < 3; k++) {
    x[k] = b->x[3 * i + k] - b->x[3 * j + k];
    v[k] = b->v[3 * i + k] - b->v[3 * j + k];
  }
  const double d = oracle_norm(x);
  c.gap = d - b->r[i] - b->r[j];
  const double arm = oracle_arm(s, b->r[i], c.gap);
  for (size_t k = 0; k < 3; k++) {
    const double wi = oracle_spin(s, b, i, k), wj = oracle_spin(s, b, j, k);
    rw[k] = arm * wi + oracle_arm(s, b->r[j], c.gap) * wj;
    w[k] = wi - wj;
  }
  c.rate = (x[0] * v[0] + x[1] * v[1] + x[2] * v[2]) / d;
  c.repulsion = oracle_f(s, c.gap);
  oracle_cross(rw, x, rwxx);
  for (int k = 0; k < 3; k++) {
    c.n[k] = x[k] / d;
    c.rep[k] = c.repulsion * oracle_rho(s, -c.rate) * x[k] / d;
    c.t[k] = v[k] - c.rate / d * x[k] - rwxx[k] / d;
  }
  oracle_friction(s, &c);
  oracle_cross(x, c.fr, xxf);
  for (int k = 0; k < 3; k++)
    c.torque[k] = -arm / d * xxf[k];
  oracle_roll(s, 1 / (1 / b->r[i] + 1 / b->r[j]), w, &c);
  return c;
}

/* Sphere i and a wall of outward normal n_k: (2.5), (2.9), (2.10), (2.12). */
static inline struct oracle_contact
oracle_wall(const struct scene *s, const struct bed *b, size_t i, size_t wall) {
  struct oracle_contact c;
  const double *n = s->walls[wall].normal, *v = b->v + 3 * i;
  double w[3], wxn[3], nxf[3], d = 0;
  for (size_t k = 0; k < 3; k++) {
    w[k] = oracle_spin(s, b, i, k);
    d += (s->walls[wall].point[k] - b->x[3 * i + k]) * n[k];
  }
  const double vn = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
  c.gap = d - b->r[i];
  c.rate = -vn;
  const double arm = oracle_arm(s, b->r[i], c.gap);
  c.repulsion = oracle_f(s, c.gap);
  oracle_cross(w, n, wxn);
  for (int k = 0; k < 3; k++) {
    c.n[k] = -n[k];
    c.rep[k] = -c.repulsion * oracle_rho(s, vn) * n[k];
    c.t[k] = v[k] - vn * n[k] + arm * wxn[k];
  }
  oracle_friction(s, &c);
  oracle_cross(n, c.fr, nxf);
  for (int k = 0; k < 3; k++)
    c.torque[k] = arm * nxf[k];
  oracle_roll(s, b->r[i], w, &c);
  return c;
}

/* Accelerations and angular accelerations, 3n each; load, n: the sum of F[l]
   over a sphere's contacts, against which errors are measured (N). */
static inline void oracle_rates(const struct scene *s, const struct bed *b,
                                double *a, double *alpha, double *load) {
  for (size_t i = 0; i < b->n; i++) {
    double force[3] = {0}, torque[3] = {0};
    load[i] = 0;
    for (size_t j = 0; j < b->n + s->walls_count; j++) {
      if (j == i)
        continue;
      const struct oracle_contact c =
          j < b->n ? oracle_pair(s, b, i, j) : oracle_wall(s, b, i, j - b->n);
      if (c.gap > s->law.lmax)
        continue;
      load[i] += c.repulsion;
      for (size_t k = 0; k < 3; k++) {
        force[k] += c.rep[k] + c.fr[k];
        torque[k] += c.torque[k];
      }
    }
    for (size_t k = 0; k < 3; k++) {
      a[3 * i + k] = force[k] / b->m[i] + s->gravity[k];
      alpha[3 * i + k] = s->model == SCENE_ROTATION
                             ? torque[k] / (0.4 * b->m[i] * b->r[i] * b->r[i])
                             : 0;
    }
  }
}

/* Energy of gravity, from the origin, and of the contacts, the integral of
   (2.1) from each gap to infinity (J). */
static inline double oracle_potential(const struct scene *s,
                                      const struct bed *b) {
  double sum = 0;
  for (size_t i = 0; i < b->n; i++) {
    for (size_t k = 0; k < 3; k++)
      sum -= b->m[i] * s->gravity[k] * b->x[3 * i + k];
    for (size_t j = 0; j < i; j++)
      sum += oracle_pair(s, b, i, j).repulsion / s->law.kappa;
    for (size_t k = 0; k < s->walls_count; k++)
      sum += oracle_wall(s, b, i, k).repulsion / s->law.kappa;
  }
  return sum;
}

#endif
