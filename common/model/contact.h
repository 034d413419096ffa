/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The contact law of P. Strachota, "DEM simulations of settling of spherical
   particles using a soft contact model and adaptive time stepping"
   (ALGORITMY 2024), equations (2.1)-(2.12), as pure inline functions.

   A contact is seen from one body, "the sphere". n is the unit vector from the
   other body's centre to the sphere's, or a wall's inward normal; l is the gap
   between the surfaces (m), negative where they overlap. Units are SI; the
   paper's spheres have unit mass. Safe in any thread. Tested in
   tests/test_contact.c, on beds in tests/test_dynamics.c and on collisions of
   unequal spheres in tests/test_pairs.c.

   Unequal spheres (not in the paper). F, rho and Sigma depend on the gap and
   the velocities alone, so they hold for any radii and masses. A force f on
   sphere i and -f on sphere j keep the momentum. Their distance is d = r_i +
   r_j + l, so they turn the pair by d n x f; what turns the spheres are the
   torques -a_i n x f and -a_j n x f, with lever arms a. The sum (d - a_i - a_j)
   n x f is what angular momentum changes by:

     paper    a = r        l n x f: kept only at touch. Equal spheres or not.
     contact  a = r + l/2  0: kept. The contact point halves the gap.

   The slip velocity has the same arms, t = w - (w.n) n - (a_i w_i + a_j w_j) x
   n, so that friction does the work f.t <= 0 and no other. A pair that turns as
   one body, with the angular velocity W, slips by l |W x n| with the paper's
   arms and not at all with the others. The paper's are the default, so that a
   mixture of equal spheres is the paper's bed; at the overlaps of a bed, a few
   per cent of r, the two differ by as much.

   Along n a pair moves like one body of the mass m_i m_j/(m_i + m_j); e does
   not depend on it, since (2.4) has velocities only. Against slip it has the
   mass m' of 1/m' = 1/m_i + 1/m_j + a_i^2/I_i + a_j^2/I_j, which at touch is
   2/7 of that along n.

   Rolling resistance (not in the paper). The surfaces roll on each other with
   the velocity u = R (w_ij - (w_ij.n) n), w_ij = w_i - w_j, where R is the
   reduced radius r_i r_j/(r_i + r_j), at a wall r_i. The torque on i is
   -X F[l] R Sigma[|u|] u/|u|, on j the opposite: a couple, which keeps momentum
   and angular momentum and takes the energy X F Sigma |u|. It is smooth, and as
   slip below vmin creeps, so does rolling: on a slope nothing is ever quite at
   rest. A sphere that rolls on the floor, faster than vmin, slows down by
   5/7 X 2 g/(1 + e^2), as long as friction holds it (5/7 X < phi), because at
   rest F = 2 m g/(1 + e^2). */
#ifndef CONTACT_H
#define CONTACT_H

#include <math.h>
#include "geometry/vec3.h"

/* Lever arms of friction, see above. */
enum contact_lever { LEVER_PAPER, LEVER_CONTACT };

struct contact_law {
  double f0;          /* F0, repulsion at touch (N) */
  double kappa;       /* stiffness exponent (1/m) */
  double psi;         /* dissipation focusing (s/m) */
  double restitution; /* e, 0..1 */
  double friction;    /* phi, friction coefficient */
  double vmin;        /* slip speed of full friction (m/s) */
  double lmax;        /* gap beyond which a contact is skipped (m) */
  double rolling;     /* X, of rolling resistance; 0: none, the paper's */
  enum contact_lever lever;
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

/* Distance of the contact point from the centre of a sphere, its lever arm. */
static inline double contact_arm(const struct contact_law *c, double radius,
                                 double l) {
  return c->lever == LEVER_CONTACT ? radius + 0.5 * l : radius;
}

/* Reduced radius of two spheres (m); with a wall it is the sphere's. */
static inline double contact_reduced(double ri, double rj) {
  return ri * rj / (ri + rj);
}

/* Relative velocity t of the surfaces in the tangent plane, (2.7) and (2.10).
   w: velocity of the sphere less that of the other body (m/s); s: sum of
   lever arm times angular velocity of both (m/s). Returns l' = w.n. */
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
   The torque on it is -r n x f, (2.11) and (2.12), with r the lever arm; the
   other body's force is -f and its torque has the same sign. */
static inline void contact_friction(const struct contact_law *c, double l,
                                    const double t[3], double f[3]) {
  const double k =
      -c->friction * contact_repulsion(c, l) * contact_slip(c, vec3_norm(t));
  for (int i = 0; i < 3; i++)
    f[i] = k * t[i];
}

/* Torque of rolling resistance on the sphere (N m); the other body's is the
   opposite. reduced: R (m); w: angular velocity of the sphere less that of the
   other body (rad/s). */
static inline void contact_roll(const struct contact_law *c, double l,
                                double reduced, const double n[3],
                                const double w[3], double torque[3]) {
  const double along = vec3_dot(w, n);
  double u[3];
  for (int i = 0; i < 3; i++)
    u[i] = reduced * (w[i] - along * n[i]);
  const double k = -c->rolling * contact_repulsion(c, l) * reduced *
                   contact_slip(c, vec3_norm(u));
  for (int i = 0; i < 3; i++)
    torque[i] = k * u[i];
}

/* Energy stored in a contact (J), the integral of (2.1) from l to infinity. */
static inline double contact_energy(const struct contact_law *c, double l) {
  return contact_repulsion(c, l) / c->kappa;
}

#endif
