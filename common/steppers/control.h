/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Step controls of our own as gsl_odeiv2 control types. */
#ifndef CONTROL_H
#define CONTROL_H

#include <gsl/gsl_odeiv2.h>
#include "platform/store.h"

/* Error per unit step: a step is accepted when 3 |E| / h < delta, with E the
   embedded error estimate of every component as it comes, in m, m/s and rad/s
   alike (for Merson 3 E/h = 0.2 k1 - 0.9 k3 + 0.8 k4 - 0.1 k5). The next step
   is 0.8 (delta/error)^(1/5) h, or 2 h where the error is 0; growth is not
   limited. Steps below 1e-9 s are accepted whatever their error. GSL_SUCCESS,
   GSL_EINVAL unless delta > 0, GSL_ENOMEM. Tested in tests/test_steppers.c. */
int control_paper_alloc(gsl_odeiv2_control **out, double delta);

/* A step is accepted when the error estimate of every unknown i is below
   abstol scale[i] + reltol |y[i]|. The next step is predicted from the last
   two errors (Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533), so that a
   collision is met by steps that shrink ahead of it instead of by rejected
   ones; not in the paper. order is that of the step type. scale, dim numbers,
   is copied. GSL_SUCCESS, GSL_EINVAL unless both tolerances are 0 or more and
   one is positive, GSL_ENOMEM. Tested in tests/test_steppers.c. */
int control_predictive_alloc(gsl_odeiv2_control **out, double abstol,
                             double reltol, const double *scale, size_t dim);

/* Its memory (platform/store.h). */
void control_predictive_store(gsl_odeiv2_control *c, struct store *s);

#endif
