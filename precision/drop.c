/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "drop.h"

#include <gsl/gsl_errno.h>
#include "model/travel.h"

double drop_contact(const struct drop *d, double gap, double rate,
                    double slope[2]) {
  const struct contact_law *c = &d->law;
  const double force = contact_normal(c, gap, rate);
  if (slope) {
    slope[0] = -c->kappa * force;
    slope[1] = -contact_repulsion(c, gap) * contact_rebound_slope(c, -rate);
  }
  return force;
}

static int rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  struct drop *d = params;
  d->evaluations++;
  dydt[0] = y[1];
  dydt[1] = d->force(d, y[0], y[1], NULL) - d->gravity;
  return isfinite(dydt[0]) && isfinite(dydt[1]) ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[],
                    void *params) {
  (void)t;
  const struct drop *d = params;
  dfdy[0] = 0;
  dfdy[1] = 1;
  d->force(d, y[0], y[1], dfdy + 2);
  dfdt[0] = dfdt[1] = 0;
  return GSL_SUCCESS;
}

static double step_limit(const double y[], const double dydt[], void *params) {
  const double travel = ((const struct drop *)params)->travel;
  return travel_time(fabs(y[1]), fabs(dydt[1]), travel);
}

int drop_start(struct drop *d, struct integrator **it,
               const struct integrate_options *o, double gap, double rate) {
  /* as dynamics_scale has it */
  const double scale[2] = {1 / d->law.kappa, 1};
  return integrate_alloc(it, o,
                         &(struct integrate_problem){
                             .system = {.function = rhs,
                                        .jacobian = jacobian,
                                        .dimension = 2,
                                        .params = d},
                             .scale = scale,
                             .row = 2,
                             .positions = 1,
                             .step_limit = d->travel > 0 ? step_limit : NULL},
                         0, (const double[]){gap, rate});
}
