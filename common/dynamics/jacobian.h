/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Analytic Jacobian of the contact forces. Internal to dynamics.c. */
#ifndef JACOBIAN_H
#define JACOBIAN_H

#include "dynamics/contact_list.h"

/* Fills dfdy, (stride rows)^2 doubles row by row, for the list's contacts. Safe
   in any thread. Tested in tests/test_dynamics.c. */
void jacobian_dense(const struct contact_list *list, const double *y,
                    double *dfdy);

#endif
