#include "control.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>

static const double smallest_step = 1e-9; /* s, the author's program */

static void *alloc(void) {
  return calloc(1, sizeof(double)); /* delta */
}

static int init(void *state, double delta, double eps_rel, double a_y,
                double a_dydt) {
  (void)eps_rel;
  (void)a_y;
  (void)a_dydt;
  *(double *)state = delta;
  return delta > 0 ? GSL_SUCCESS : GSL_EINVAL;
}

static int adjust(void *state, size_t dim, unsigned order, const double y[],
                  const double yerr[], const double yp[], double *h) {
  (void)order;
  (void)y;
  (void)yp;
  const double delta = *(double *)state;
  double error = 0;
  for (size_t i = 0; i < dim; i++) {
    const double e = fabs(yerr[i]);
    if (!(e <= error)) /* so that a NaN is kept */
      error = e;
  }
  error *= 3 / *h;
  const bool accepted = error < delta || *h < smallest_step;
  const double factor = error > 0 ? 0.8 * pow(delta / error, 0.2) : 2;
  *h *= isfinite(factor) && factor > 0 ? factor : 0.1;
  if (!accepted)
    return GSL_ODEIV_HADJ_DEC;
  return factor > 1 ? GSL_ODEIV_HADJ_INC : GSL_ODEIV_HADJ_NIL;
}

static int error_level(void *state, const double y, const double dydt,
                       const double h, const size_t i, double *level) {
  (void)y;
  (void)dydt;
  (void)i;
  *level = *(double *)state * fabs(h) / 3;
  return GSL_SUCCESS;
}

static int set_driver(void *state, const gsl_odeiv2_driver *d) {
  (void)state;
  (void)d;
  return GSL_SUCCESS;
}

static const gsl_odeiv2_control_type paper = {.name = "paper",
                                              .alloc = alloc,
                                              .init = init,
                                              .hadjust = adjust,
                                              .errlevel = error_level,
                                              .set_driver = set_driver,
                                              .free = free};

gsl_odeiv2_control *control_paper_new(double delta) {
  gsl_odeiv2_control *c = gsl_odeiv2_control_alloc(&paper);
  if (c && gsl_odeiv2_control_init(c, delta, 0, 0, 0) != GSL_SUCCESS) {
    gsl_odeiv2_control_free(c);
    return NULL;
  }
  return c;
}
