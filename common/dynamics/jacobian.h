/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Analytic Jacobian of the contact forces. Internal to dynamics.c. */
#ifndef JACOBIAN_H
#define JACOBIAN_H

#include "dynamics/kernel.h"

/* Fills dfdy, (stride n)^2 doubles row by row, for the contacts in k. */
void jacobian_dense(const struct kernel_data *k, size_t n, const double *y,
                    double *dfdy);

#endif
