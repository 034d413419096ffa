/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/merson.h"
#include "steppers/runge_kutta.h"
#include "steppers/step_type.h"

static const double c[] = {0, 1. / 3, 1. / 3, 1. / 2, 1};
static const double a[] = {1. / 3,                 /**/
                           1. / 6, 1. / 6,         /**/
                           1. / 8, 0,      3. / 8, /**/
                           1. / 2, 0,      -3. / 2, 2};
static const double b[] = {1. / 6, 0, 0, 4. / 6, 1. / 6};
static const double e[] = {2. / 30, 0, -9. / 30, 8. / 30, -1. / 30};

static const struct tableau tableau = {
    .stages = 5, .a = a, .b = b, .e = e, .c = c, .order = 4};

static void *alloc(size_t dim) {
  return runge_kutta_alloc(&tableau, dim);
}

static const gsl_odeiv2_step_type type = {.name = "merson",
                                          .can_use_dydt_in = 1,
                                          .gives_exact_dydt_out = 1,
                                          .alloc = alloc,
                                          .apply = runge_kutta_apply,
                                          .set_driver = step_no_driver,
                                          .reset = step_no_reset,
                                          .order = runge_kutta_order,
                                          .free = runge_kutta_free};

const gsl_odeiv2_step_type *const merson = &type;
