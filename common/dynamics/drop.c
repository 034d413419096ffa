/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/drop.h"

#include <math.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
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

int drop_alloc(struct integrator **out, struct drop *d,
               const struct integrate_options *o, double gap, double rate) {
  /* as dynamics_scale has it: gaps in 1/kappa, speeds in m/s */
  const double scale[2] = {1 / d->law.kappa, 1};
  return integrate_alloc(out, o,
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

double drop_energy(const struct drop *d, const double y[]) {
  return 0.5 * y[1] * y[1] + d->gravity * y[0] + contact_energy(&d->law, y[0]);
}

struct stiffness_mode drop_mode(const struct drop *d, const double y[]) {
  double slope[2];
  gsl_complex root[2];
  d->force(d, y[0], y[1], slope);
  gsl_poly_complex_solve_quadratic(1, -slope[1], -slope[0], &root[0], &root[1]);
  const size_t k = gsl_complex_abs(root[1]) > gsl_complex_abs(root[0]);
  const double angle = fabs(gsl_complex_arg(root[k]));
  return (struct stiffness_mode){gsl_complex_abs(root[k]),
                                 GSL_MAX(angle, M_PI_2)};
}
