/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dormand-Prince 5(4), the embedded method of MATLAB's ode45, with local
   extrapolation; six evaluations per step, the last reused. J. R. Dormand, P.
   J. Prince, J. Comput. Appl. Math. 6 (1980) 19. Stable to -3.307 on the real
   axis, to 0.997 i. Tested in tests/test_steppers.c. */
#ifndef DOPRI5_H
#define DOPRI5_H

#include <gsl/gsl_odeiv2.h>

extern const gsl_odeiv2_step_type *const dopri5;

#endif
