/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "steppers/predictive.h"

#include <math.h>
#include <gsl/gsl_math.h>

bool predictive_accepts(struct predictive *p, double error, unsigned order,
                        double *h) {
  const double power = 1. / (order + 1);
  if (!(error <= 1)) {
    p->after_rejection = true;
    *h *= error < INFINITY ? GSL_MAX(0.1, 0.8 * pow(error, -power)) : 0.1;
    return false;
  }
  error = GSL_MAX(error, 1e-8);
  double factor = 0.8 * pow(error, -power);
  if (p->last_error > 0)
    factor = GSL_MIN(factor, 0.8 * *h / p->last_step *
                                 pow(p->last_error / (error * error), power));
  factor = GSL_MIN(GSL_MAX(factor, 0.2), p->after_rejection ? 1 : 5);
  p->after_rejection = false;
  p->last_error = error;
  p->last_step = *h;
  *h *= factor;
  return true;
}
