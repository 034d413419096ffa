/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "measure.h"

#include <math.h>
#include <time.h>
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

struct integrate_options measure_variant(const struct integrate_options *o,
                                         size_t k) {
  struct integrate_options variant = *o;
  variant.step /= 1 + 0.1 * (double)k / MEASURE_STARTS;
  return variant;
}

double measure_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void measure_start(struct precision_result *r) {
  r->started = measure_clock();
}

void measure_stop(struct precision_result *r) {
  r->cpu_seconds += measure_clock() - r->started;
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
  r->cpu_seconds /= runs;
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
