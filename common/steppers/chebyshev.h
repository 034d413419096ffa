/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The coefficients of the Runge-Kutta-Chebyshev method of order 2, by the
   number of stages: B. P. Sommeijer, L. F. Shampine, J. G. Verwer, J. Comput.
   Appl. Math. 88 (1998) 315. Not in the paper. With F_j = f(t + c_j h, Y_j),
     Y_0 = y,   Y_1 = y + h w1 b1 F_0,
     Y_j = (1 - mu - nu) y + mu Y_j-1 + nu Y_j-2 + rate h F_j-1 + start h F_0,
   and Y_s is y at t + h. They follow from a recurrence of s terms; a struct
   chebyshev remembers the numbers of stages that were asked for. One per
   thread. Tested in tests/test_rkc.c. */
#ifndef CHEBYSHEV_H
#define CHEBYSHEV_H

#include <stddef.h>
#include "steppers/stage.h"

/* More stages gain nothing on a shorter step and let rounding grow. */
enum { CHEBYSHEV_MOST = 400 };

struct chebyshev_stage { /* j, from 2 on */
  double mu, nu;
  double rate, start; /* of F_j-1 and of F_0 */
  double time;        /* c_j-1 */
};

struct chebyshev_scheme {
  size_t stages;
  double reach; /* as of chebyshev_reach */
  double w1, b1;
  struct chebyshev_stage stage[]; /* stages - 1, the first is j = 2 */
};

/* The largest h times spectral radius on the negative real axis for which this
   number of stages, 2 or more, is stable, about 0.65 stages^2; by the
   recurrence, anew at each call. Safe in any thread. */
double chebyshev_reach(size_t stages);

struct chebyshev;

/* GSL_SUCCESS, GSL_ENOMEM. */
int chebyshev_alloc(struct chebyshev **out);
void chebyshev_free(struct chebyshev *c);

/* The fewest stages that reach z = h times spectral radius, 0 if
   CHEBYSHEV_MOST do not or z is NaN. */
size_t chebyshev_stages(struct chebyshev *c, double z);

/* The scheme with this number of stages, from 2 to CHEBYSHEV_MOST; it stays
   c's. NULL without memory. */
const struct chebyshev_scheme *chebyshev_scheme(struct chebyshev *c,
                                                size_t stages);

/* Stage j of a step of length h from y at start, whose derivative is rate, as
   the combination of Y_j-1 (its y) and Y_j-2 (its out) that it is. */
static inline struct stage chebyshev_stage(const struct chebyshev_stage *j,
                                           double h, const double *start,
                                           const double *rate) {
  return (struct stage){.start = start,
                        .rate = rate,
                        .of_start = 1 - j->mu - j->nu,
                        .of_rate = h * j->start,
                        .of_y = j->mu,
                        .of_out = j->nu,
                        .of_f = h * j->rate};
}

#endif
