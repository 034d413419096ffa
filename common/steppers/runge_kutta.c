/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/runge_kutta.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

struct state {
  const struct tableau *tableau;
  double work[]; /* stages of dim doubles, then y at the start, then a stage */
};

void *runge_kutta_alloc(const struct tableau *t, size_t dim) {
  struct state *s =
      calloc(1, sizeof *s + (t->stages + 2) * dim * sizeof(double));
  if (s)
    s->tableau = t;
  return s;
}

/* out = base + h sum_j weight[j] k_j over the stages with a weight */
static void combine(const double *weight, size_t stages, double h,
                    const double *k, size_t dim, const double *base,
                    double *out) {
  for (size_t i = 0; i < dim; i++)
    out[i] = base ? base[i] : 0;
  for (size_t j = 0; j < stages; j++) {
    const double hw = h * weight[j];
    if (hw != 0)
      for (size_t i = 0; i < dim; i++)
        out[i] += hw * k[j * dim + i];
  }
}

int runge_kutta_apply(void *state, size_t dim, double t, double h, double y[],
                      double yerr[], const double dydt_in[], double dydt_out[],
                      const gsl_odeiv2_system *sys) {
  struct state *s = state;
  const struct tableau *tab = s->tableau;
  double *k = s->work, *start = k + tab->stages * dim, *stage = start + dim;
  int status = GSL_SUCCESS;
  memcpy(start, y, dim * sizeof *y);
  if (dydt_in)
    memcpy(k, dydt_in, dim * sizeof *k);
  else
    status = GSL_ODEIV_FN_EVAL(sys, t, y, k);
  const double *a = tab->a;
  for (size_t j = 1; j < tab->stages && status == GSL_SUCCESS; a += j++) {
    combine(a, j, h, k, dim, start, stage);
    status = GSL_ODEIV_FN_EVAL(sys, t + tab->c[j] * h, stage, k + j * dim);
  }
  if (status != GSL_SUCCESS)
    return status;
  const double *last = k + (tab->stages - 1) * dim;
  combine(tab->b, tab->stages, h, k, dim, start, y);
  if (dydt_out && tab->fsal)
    memcpy(dydt_out, last, dim * sizeof *last);
  else if (dydt_out)
    status = GSL_ODEIV_FN_EVAL(sys, t + h, y, dydt_out);
  if (status != GSL_SUCCESS) {
    memcpy(y, start, dim * sizeof *y);
    return status;
  }
  combine(tab->e, tab->stages, h, k, dim, NULL, yerr);
  return GSL_SUCCESS;
}

unsigned runge_kutta_order(void *state) {
  const struct state *s = state;
  return s->tableau->order;
}

void runge_kutta_free(void *state) {
  free(state);
}
