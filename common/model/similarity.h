/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Beds that are alike. Only ratios matter to a bed: kappa r, F0/(m g),
   psi sqrt(g r), vmin/sqrt(g r), lmax/r, e and phi; lengths are by r, times by
   sqrt(r/g), masses by m. So the paper's numbers, which belong to its sphere of
   0.1 m and 1 kg, have their counterparts for any other. Not in the paper.
   Safe in any thread. Tested in tests/test_similarity.sh and
   tests/test_similarity.c. */
#ifndef SIMILARITY_H
#define SIMILARITY_H

/* A sphere's units by the paper's. Where the radius is 4^k of the paper's and
   the mass 2^j, these are powers of two, and so bits stay. */
struct similarity {
  double length, time, mass;
  double squared_time; /* length by gravity: no root is taken and squared */
};

/* Powers of the units in a quantity: {1, -1, 0} is a speed. */
struct dimension {
  int length, time, mass;
};

/* Of a radius (m), a mass (kg), both positive, and gravity |g| (m/s^2); without
   gravity the paper's, since then no time is singled out. */
struct similarity similarity_of(double radius, double mass, double gravity);

/* The quantity that is 1 for the paper's sphere. */
double similarity_scale(const struct similarity *s, struct dimension d);

#endif
