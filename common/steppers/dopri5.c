/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/dopri5.h"
#include "steppers/runge_kutta.h"
#include "steppers/step_type.h"

static const double c[] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1};
static const double a[] = {1. / 5,
                           3. / 40,
                           9. / 40,
                           44. / 45,
                           -56. / 15,
                           32. / 9,
                           19372. / 6561,
                           -25360. / 2187,
                           64448. / 6561,
                           -212. / 729,
                           9017. / 3168,
                           -355. / 33,
                           46732. / 5247,
                           49. / 176,
                           -5103. / 18656,
                           35. / 384,
                           0,
                           500. / 1113,
                           125. / 192,
                           -2187. / 6784,
                           11. / 84};
static const double b[] = {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784,
                           11. / 84,  0};
/* fifth less fourth order */
static const double e[] = {
    71. / 57600,      0,         -71. / 16695, 71. / 1920,
    -17253. / 339200, 22. / 525, -1. / 40};

/* The solution is of order 5, the estimate O(h^5). */
static const struct tableau tableau = {
    .stages = 7, .a = a, .b = b, .e = e, .c = c, .order = 5, .fsal = true};

static void *alloc(size_t dim) {
  return runge_kutta_alloc(&tableau, dim);
}

static const gsl_odeiv2_step_type type = {.name = "dopri5",
                                          .can_use_dydt_in = 1,
                                          .gives_exact_dydt_out = 1,
                                          .alloc = alloc,
                                          .apply = runge_kutta_apply,
                                          .set_driver = step_no_driver,
                                          .reset = step_no_reset,
                                          .order = runge_kutta_order,
                                          .free = runge_kutta_free};

const gsl_odeiv2_step_type *const dopri5 = &type;
