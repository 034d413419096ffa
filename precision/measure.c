#include "measure.h"

#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

const char measure_ok[] = "ok";

const char *measure_step(struct integrator *it, size_t most) {
  if (integrate_step(it) != GSL_SUCCESS)
    return "gave_up";
  return integrate_counts(it).accepted > most ? "too_long" : measure_ok;
}

const char *measure_until(struct integrator *it, double t, size_t most) {
  const char *word = measure_ok;
  if (integrate_time(it) < t && integrate_stop(it, t) != GSL_SUCCESS)
    return "gave_up";
  while (integrate_time(it) < t && word == measure_ok)
    word = measure_step(it, most);
  return word;
}

const char *measure_event(struct integrator *it,
                          double (*ahead)(const double y[], const double dydt[],
                                          void *params),
                          void *params, size_t most) {
  for (;;) {
    const char *word = measure_step(it, most);
    if (word != measure_ok)
      return word;
    const double t = integrate_time(it);
    const double left =
        ahead(integrate_state(it), integrate_derivative(it), params);
    if (isnan(left))
      return "nan";
    if (left <= 4 * GSL_DBL_EPSILON * t)
      return measure_ok;
    if (integrate_stop(it, GSL_MIN(t + left, GSL_DBL_MAX)) != GSL_SUCCESS)
      return "gave_up";
  }
}

void measure_add(struct precision_result *r, const struct integrator *it,
                 size_t evaluations, const double error[], size_t errors) {
  const struct integrate_counts counts = integrate_counts(it);
  r->runs++;
  r->evaluations += evaluations;
  r->accepted += counts.accepted;
  r->rejected += counts.rejected;
  for (size_t e = 0; e < errors; e++)
    r->error[e] += error[e] * error[e];
}

void measure_mean(struct precision_result *r) {
  const double runs = (double)r->runs;
  r->evaluations = (size_t)lround((double)r->evaluations / runs);
  r->accepted = (size_t)lround((double)r->accepted / runs);
  r->rejected = (size_t)lround((double)r->rejected / runs);
  for (size_t e = 0; e < PRECISION_ERRORS; e++)
    r->error[e] = sqrt(r->error[e] / runs);
}

void measure_counts(const struct motion *m, struct precision_result *r) {
  const struct integrate_counts counts = integrate_counts(m->integrator);
  r->evaluations = dynamics_counts(m->dynamics).evaluations;
  r->accepted = counts.accepted;
  r->rejected = counts.rejected;
}
