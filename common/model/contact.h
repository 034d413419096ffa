/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact law of P. Strachota, "DEM simulations of settling of spherical
   particles using a soft contact model and adaptive time stepping"
   (ALGORITMY 2024), equations (2.1)-(2.12), as pure inline functions.

   A contact is seen from one body, "the sphere". n is the unit vector from the
   other body's centre to the sphere's, or a wall's inward normal; l is the gap
   between the surfaces (m), negative where they overlap. Units are SI; the
   paper's spheres have unit mass. Safe in any thread. Tested in
   tests/test_contact.c. */
#ifndef CONTACT_H
#define CONTACT_H

#include <math.h>
#include "geometry/vec3.h"

struct contact_law {
  double f0;          /* F0, repulsion at touch (N) */
  double kappa;       /* stiffness exponent (1/m) */
  double psi;         /* dissipation focusing (s/m) */
  double restitution; /* e, 0..1 */
  double friction;    /* phi, friction coefficient */
  double vmin;        /* slip speed of full friction (m/s) */
  double lmax;        /* gap beyond which a contact is skipped (m) */
};

/* F[l], magnitude of the repulsion (N), (2.1). */
static inline double contact_repulsion(const struct contact_law *c, double l) {
  return c->f0 * exp(-c->kappa * l);
}

/* rho[v], the rebound function (2.4); v > 0 while the surfaces approach.
   Written with one exp: (1 + tanh x)/2 = 1/(1 + exp(-2x)). */
static inline double contact_rebound(const struct contact_law *c, double v) {
  const double e2 = c->restitution * c->restitution;
  return e2 + (1 - e2) / (1 + exp(-2 * c->psi * v));
}

/* d rho[v] / dv, without overflow (s/m). */
static inline double contact_rebound_slope(const struct contact_law *c,
                                           double v) {
  const double e2 = c->restitution * c->restitution;
  const double sech = 1 / cosh(fmin(fabs(c->psi * v), 350));
  return 0.5 * (1 - e2) * c->psi * sech * sech;
}

/* Sigma[v]/v, the limiter (2.8) by the slip speed v >= 0 (s/m). Without the
   division it is smooth at v = 0. */
static inline double contact_slip(const struct contact_law *c, double v) {
  const double s = v / c->vmin;
  return v < c->vmin ? (3 - 2 * s) * s / c->vmin : 1 / v;
}

/* Sigma[v], the limiter (2.8). */
static inline double contact_limiter(const struct contact_law *c, double v) {
  return v * contact_slip(c, v);
}

/* Force on the sphere along n by (2.3) and (2.5): F[l] rho[-l'], where lrate
   is the time derivative l' of the gap (m/s). */
static inline double contact_normal(const struct contact_law *c, double l,
                                    double lrate) {
  return contact_repulsion(c, l) * contact_rebound(c, -lrate);
}

/* Relative velocity t of the surfaces in the tangent plane, (2.7) and (2.10).
   w: velocity of the sphere less that of the other body (m/s); s: sum of
   radius times angular velocity of both (m/s). Returns l' = w.n. */
static inline double contact_tangent(const double n[3], const double w[3],
                                     const double s[3], double t[3]) {
  const double lrate = vec3_dot(w, n);
  double sxn[3];
  vec3_cross(s, n, sxn);
  for (int k = 0; k < 3; k++)
    t[k] = w[k] - lrate * n[k] - sxn[k];
  return lrate;
}

/* Friction force on the sphere (N), (2.6) and (2.9), for slip velocity t.
   The torque on it is -r n x f, (2.11) and (2.12); the other body's force is
   -f and its torque has the same sign. */
static inline void contact_friction(const struct contact_law *c, double l,
                                    const double t[3], double f[3]) {
  const double k =
      -c->friction * contact_repulsion(c, l) * contact_slip(c, vec3_norm(t));
  for (int i = 0; i < 3; i++)
    f[i] = k * t[i];
}

/* Energy stored in a contact (J), the integral of (2.1) from l to infinity. */
static inline double contact_energy(const struct contact_law *c, double l) {
  return contact_repulsion(c, l) / c->kappa;
}

#endif
