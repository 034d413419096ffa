/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One sphere above a plane in two unknowns, the gap l and its rate, for scenes
   that need no more unknowns. Not in the paper. */
#ifndef DROP_H
#define DROP_H

#include "model/contact.h"
#include "scenes.h"

struct drop {
  /* Force on the sphere (N) and, unless NULL, its derivatives by gap and
     rate. */
  double (*force)(const struct drop *d, double gap, double rate,
                  double slope[2]);
  struct contact_law law;
  double gravity;            /* m/s^2 */
  double travel;             /* m, 0: any */
  double loading, unloading; /* N/m, of linear laws */
  double deepest;            /* overlap at an accepted step so far (m) */
  size_t evaluations;        /* so far */
};

/* The paper's law, (2.1) to (2.5), without the cut at lmax. */
double drop_contact(const struct drop *d, double gap, double rate,
                    double slope[2]);

/* Starts at time 0. d must stay where it is. Codes as of integrate_alloc. */
int drop_start(struct drop *d, struct integrator **it,
               const struct integrate_options *o, double gap, double rate);

#endif
