/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One sphere of unit mass above a plane in two unknowns, the gap l and its rate
   (m, m/s): the equations of motion (2.13) and (2.14) where there is no more to
   know. One integration at a time. Tested in tests/test_drop.c. */
#ifndef DROP_H
#define DROP_H

#include <stddef.h>
#include "model/contact.h"
#include "steppers/integrate.h"

struct drop {
  /* Force on the sphere (N) and, unless NULL, its derivatives by gap and rate.
     A law with more to it than struct contact_law has a struct of its own that
     begins with this one. */
  double (*force)(const struct drop *d, double gap, double rate,
                  double slope[2]);
  struct contact_law law;
  double gravity;     /* m/s^2 */
  double travel;      /* m, the furthest in a step; 0: any */
  size_t evaluations; /* so far */
};

/* The paper's law, (2.1) to (2.5), without the cut at lmax. */
double drop_contact(const struct drop *d, double gap, double rate,
                    double slope[2]);

/* Starts at time 0. d must stay where it is. Codes as of integrate_alloc. */
int drop_alloc(struct integrator **out, struct drop *d,
               const struct integrate_options *o, double gap, double rate);

/* Energy of the paper's law: in motion, from gravity (of the gap 0), and
   stored in the contact (J). */
double drop_energy(const struct drop *d, const double y[]);

/* The mode of greatest rate, lambda^2 = f_l + f_l' lambda. */
struct stiffness_mode drop_mode(const struct drop *d, const double y[]);

#endif
