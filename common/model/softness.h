/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How soft contacts may be and how far friction may creep, as a choice and as
   an error. Not in the paper. Safe in any thread. Tested in
   tests/test_softness.c and tests/test_softness.sh.

   A bed of weight W on a base of area A presses at half its height with
   p = W/(2 A). Its contacts carry <N> = 6 p <V>/(phi_s Z <d>) on average, by
   the virial theorem with the solid fraction phi_s = 0.6, Z = 5.5 contacts of a
   sphere and the mean volume <V> and diameter <d>; at the floor it is twice as
   much. At rest rho(0) F = N, rho(0) = (1 + e^2)/2. The geometric mean of N
   over a bed is 0.57 <N> (measured), so contacts have no gap on average if F0 =
   0.57 <N>/rho(0): then the nominal radius is that of the geometry.

   Those that touch the floor have by (2.1) the mean overlap
   <ln(N/(rho(0) F0))>/kappa, which is 1.38/kappa to 1.56/kappa in the paper's
   box and in a wider one, for kappa r from 15 to 240, with and without
   friction; so kappa = 1.47/overlap. For a column of single spheres it
   is 1.30/kappa. */
#ifndef SOFTNESS_H
#define SOFTNESS_H

struct softness_load {
  double weight;   /* W (N) */
  double area;     /* A (m^2) */
  double volume;   /* <V> (m^3) */
  double diameter; /* <d> (m) */
};

/* F0 (N) of contacts that have no gap on average, for restitution e. */
double softness_f0(const struct softness_load *load, double restitution);

/* kappa (1/m) for a mean overlap (m) of the contacts at the floor. */
double softness_kappa(double overlap);

/* lmax (m) for that kappa: a gap of the paper's force, F0 exp(-15). */
double softness_lmax(double kappa);

/* A contact that carries half of the friction that it can creeps at vmin/2
   (2.8): over a distance (m) in a time (s) for this vmin (m/s). */
double softness_vmin(double distance, double time);
double softness_creep(double vmin, double time);

/* Expected errors of the union of a bed, with the figures of docs/softness.md:
   how much denser than with hard contacts, by kappa times the radius (measured
   0.9 to 1.5 by it); and how much denser than without creep, by the distance
   that a contact creeps, in radii (0.025 for 0.4 radii, the paper's by 8 s). */
double softness_error(double kappa_radius);
double softness_creep_error(double radii);

#endif
