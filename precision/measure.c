#include "measure.h"

#include <gsl/gsl_errno.h>

const char *measure_until(struct integrator *it, double t, size_t most) {
  const size_t before = integrate_counts(it).accepted;
  if (integrate_stop(it, t) != GSL_SUCCESS)
    return "gave_up";
  while (integrate_time(it) < t) {
    if (integrate_step(it) != GSL_SUCCESS)
      return "gave_up";
    if (integrate_counts(it).accepted - before > most)
      return "too_long";
  }
  return "ok";
}

void measure_counts(const struct motion *m, struct precision_result *r) {
  const struct integrate_counts counts = integrate_counts(m->integrator);
  r->evaluations = dynamics_counts(m->dynamics).evaluations;
  r->accepted = counts.accepted;
  r->rejected = counts.rejected;
}
