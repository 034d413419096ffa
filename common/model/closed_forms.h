/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solutions of the model in closed form or as an integral, for tests and for
   charts of accuracy; not in the paper unless said otherwise. One sphere of
   unit mass. Results are good to some 1e-13 of their size unless a function
   gives its own error. GSL_SUCCESS, or the code of the root finding or the
   quadrature that failed, with the results untouched. Safe in any thread.
   Tested in tests/test_closed_forms.c, which compares them with
   trajectories, and in tests/test_impacts.c. */
#ifndef CLOSED_FORMS_H
#define CLOSED_FORMS_H

#include "model/contact.h"

/* Elastic collision with a wall, no gravity, of approach speed v0: gap (m) and
   velocity (m/s) at time tau from the turning point,
     exp(-kappa l) = (kappa v0^2/2 F0) sech^2(kappa v0 tau/2).
   For two equal spheres: F0 doubled, v0 the relative speed. */
void closed_collision(double f0, double kappa, double v0, double tau,
                      double *gap, double *velocity);

/* Speed v1 after a collision without gravity of approach speed v0, from
     int_0^v0 u/rho(u) du = int_0^v1 u/rho(-u) du,
   whatever F0 and kappa. v0 > 0, else GSL_EDOM. */
int closed_restitution(const struct contact_law *c, double v0, double *v1,
                       double *error);

/* Time from the drop at a gap of height (m) to the next apex, e = 1, by the
   energy integral. The drop begins in free flight, height > 40/kappa, else
   GSL_EDOM. */
int closed_rebound_time(double f0, double kappa, double gravity, double height,
                        double *time, double *error);

/* Gap of a sphere at rest on a floor that pushes with the force normal (N):
   F[l] rho[0] = normal, (2.5). */
double closed_rest_gap(const struct contact_law *c, double normal);

/* Time (s) in which slip falls from vmin to s vmin, 0 < s <= 1, if friction
   slows it by rate Sigma (m/s^2): the integral of 1/(3 s^2 - 2 s^3). Its
   inverse needs t >= 0, else GSL_EDOM. */
double closed_slip_time(double s, double vmin, double rate);
int closed_slip_share(double t, double vmin, double rate, double *s);

/* Integral of F over a collision without gravity, by the mass that it moves
   (m/s), of a contact that comes with v0 and goes with v1, the speed of
   closed_restitution:
     int_-v1^v0 du/rho(u),
   whatever F0 and kappa. For a large psi it is v0 (1 + 1/e), to 1/psi: where
   friction slides all the time it slows a body by phi times that, which is
   Coulomb's phi/e times (1 + e) v0. */
double closed_impulse(const struct contact_law *c, double v0, double v1);

/* Slip (m/s) that is left of one before, if full friction (Sigma = 1) would
   have taken braked of it: down to vmin it does, and below by (2.8). slip,
   braked >= 0, else GSL_EDOM. */
int closed_slip(double slip, double vmin, double braked, double *left);

/* Speed (m/s) of a block on a slope, where full friction could hold twice as
   much as it has to, from vmin at t = 0 on; rate (m/s^2) is what full friction
   slows by: vmin (1/2 + sqrt(3) w/sqrt(1 + 4 w^2)),
   w = exp(-3 rate t/(2 vmin))/sqrt(8), since 3 s^2 - 2 s^3 - 1/2 has the roots
   1/2 and 1/2 +- sqrt(3)/2. It goes on creeping with vmin/2. */
double closed_creep(double t, double vmin, double rate);

#endif
