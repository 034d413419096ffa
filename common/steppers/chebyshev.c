/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "steppers/chebyshev.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Damping keeps |R(z)| below 1 - epsilon/3 in the interior of the interval;
   the value is the authors'. */
static const double damping = 2. / 13;

struct chebyshev {
  double reach[CHEBYSHEV_MOST + 1]; /* 0: not known yet */
  struct chebyshev_scheme *scheme[CHEBYSHEV_MOST + 1];
};

/* T_j, T_j' and T_j'' at w0, and those of j - 1. */
struct recurrence {
  double w0;
  double t, d, e;
  double t_before, d_before, e_before;
};

/* j = 1 */
static struct recurrence recurrence_begin(size_t stages) {
  const double s = (double)stages, w0 = 1 + damping / (s * s);
  return (struct recurrence){.w0 = w0, .t_before = 1, .t = w0, .d = 1};
}

static void recurrence_next(struct recurrence *r) {
  const double t = 2 * r->w0 * r->t - r->t_before;
  const double d = 2 * r->w0 * r->d - r->d_before + 2 * r->t;
  const double e = 2 * r->w0 * r->e - r->e_before + 4 * r->d;
  r->t_before = r->t, r->t = t;
  r->d_before = r->d, r->d = d;
  r->e_before = r->e, r->e = e;
}

int chebyshev_alloc(struct chebyshev **out) {
  struct chebyshev *c = calloc(1, sizeof *c);
  if (!c)
    return GSL_ENOMEM;
  *out = c;
  return GSL_SUCCESS;
}

void chebyshev_free(struct chebyshev *c) {
  if (!c)
    return;
  for (size_t s = 0; s <= CHEBYSHEV_MOST; s++)
    free(c->scheme[s]);
  free(c);
}

double chebyshev_reach(size_t stages) {
  assert(stages >= 2);
  struct recurrence r = recurrence_begin(stages);
  for (size_t j = 2; j <= stages; j++)
    recurrence_next(&r);
  return (r.w0 + 1) * r.e / r.d;
}

static double known_reach(struct chebyshev *c, size_t stages) {
  if (!(c->reach[stages] > 0))
    c->reach[stages] = chebyshev_reach(stages);
  return c->reach[stages];
}

size_t chebyshev_stages(struct chebyshev *c, double z) {
  if (!(z <= known_reach(c, CHEBYSHEV_MOST)))
    return 0;
  /* 1 / 0.65; the neighbours are one or two off */
  const double guess = floor(sqrt(1 + 1.54 * GSL_MAX(z, 0)));
  size_t stages = (size_t)GSL_MIN(GSL_MAX(2, guess), CHEBYSHEV_MOST);
  while (stages > 2 && known_reach(c, stages - 1) >= z)
    stages--;
  while (known_reach(c, stages) < z)
    stages++;
  return stages;
}

/* b_j = T_j''/(T_j')^2, and 1/(4 w0^2), the b_2, for j = 0 and 1; a_j = 1 - b_j
   T_j; w1 = T_s'/T_s'' = (w0 + 1)/reach. mu = 2 w0 b_j/b_j-1, nu = -b_j/b_j-2,
   rate = 2 w1 b_j/b_j-1, start = -a_j-1 rate. */
static void fill(struct chebyshev_scheme *scheme) {
  struct recurrence r = recurrence_begin(scheme->stages);
  const double w1 = (r.w0 + 1) / scheme->reach;
  double b1 = 1 / (4 * r.w0 * r.w0), b0 = b1; /* b_j-1, b_j-2 */
  double c1 = w1 * b1, c0 = 0;                /* c_j-1, c_j-2 */
  scheme->w1 = w1, scheme->b1 = b1;
  for (size_t j = 2; j <= scheme->stages; j++) {
    const double a1 = 1 - b1 * r.t;
    recurrence_next(&r);
    const double b = r.e / (r.d * r.d);
    struct chebyshev_stage *to = &scheme->stage[j - 2];
    to->mu = 2 * b * r.w0 / b1;
    to->nu = -b / b0;
    to->rate = 2 * b * w1 / b1;
    to->start = -a1 * to->rate;
    to->time = c1;
    const double time = to->mu * c1 + to->nu * c0 + to->rate + to->start;
    c0 = c1, c1 = time;
    b0 = b1, b1 = b;
  }
}

const struct chebyshev_scheme *chebyshev_scheme(struct chebyshev *c,
                                                size_t stages) {
  assert(stages >= 2 && stages <= CHEBYSHEV_MOST);
  if (!c->scheme[stages]) {
    struct chebyshev_scheme *scheme =
        malloc(sizeof *scheme + (stages - 1) * sizeof *scheme->stage);
    if (!scheme)
      return NULL;
    scheme->stages = stages;
    scheme->reach = known_reach(c, stages);
    fill(scheme);
    c->scheme[stages] = scheme;
  }
  return c->scheme[stages];
}
