/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta-Merson, order 4 with an embedded estimate, five evaluations
   per step: the paper's method. J. Christiansen, Numer. Math. 14 (1970) 317.
   Stable to -3.548 on the real axis and to 3.464 i. The estimate is of the
   error's order on linear problems with constant coefficients, an
   overestimate, O(h^4), on others. Tested in tests/test_steppers.c. */
#ifndef MERSON_H
#define MERSON_H

#include <gsl/gsl_odeiv2.h>

extern const gsl_odeiv2_step_type *const merson;

#endif
