/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/dynamics.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/allpairs.h"
#include "dynamics/internal.h"
#include "dynamics/jacobian.h"
#include "dynamics/rates.h"
#include "dynamics/scale.h"
#include "model/travel.h"

const char *const *const dynamics_kernels = kernel_names;

const char *dynamics_machine(void) {
  const char *const *best = kernel_names;
  for (const char *const *name = kernel_names; *name; name++)
    if (kernel_select(*name))
      best = name;
  return *best;
}

void dynamics_free(struct dynamics *d) {
  if (!d)
    return;
  contact_list_free(d->list);
  free(d);
}

int dynamics_alloc(struct dynamics **out, const struct scene *s,
                   const struct bed *b, const struct dynamics_options *o) {
  assert(o->threads > 0);
  struct dynamics *d = calloc(1, sizeof *d);
  if (!d)
    return GSL_ENOMEM;
  d->options = *o;
  d->kernel = kernel_select(o->kernel);
  int status = d->kernel ? GSL_SUCCESS : GSL_EUNSUP;
  if (status == GSL_SUCCESS)
    status = contact_list_alloc(&d->list, s, b, (size_t)o->threads, o->order);
  if (status != GSL_SUCCESS) {
    dynamics_free(d);
    return status;
  }
  *out = d;
  return GSL_SUCCESS;
}

size_t dynamics_stride(const struct dynamics *d) {
  return d->list->stride;
}

size_t dynamics_dimension(const struct dynamics *d) {
  return d->list->stride * d->list->rows;
}

struct dynamics_counts dynamics_counts(const struct dynamics *d) {
  const struct contact_list *l = d->list;
  return (struct dynamics_counts){.evaluations = (size_t)(d->evaluations + 0.5),
                                  .contacts_evaluated = d->contacts,
                                  .builds = l->builds,
                                  .contacts = contact_list_size(l)};
}

const char *dynamics_kernel(const struct dynamics *d) {
  return d->options.all_pairs ? "all pairs" : d->kernel->name;
}

void dynamics_pack(const struct dynamics *d, const struct bed *b, double y[]) {
  const struct contact_list *l = d->list;
  for (size_t i = 0; i < l->rows; i++)
    for (size_t c = 0; c < 3; c++) {
      double *row = y + i * l->stride;
      const size_t at = 3 * l->order[i] + c;
      row[ROW_X + c] = b->x[at];
      row[ROW_V + c] = b->v[at];
      if (l->has.rotation)
        row[ROW_W + c] = b->w[at];
    }
}

void dynamics_unpack(const struct dynamics *d, const double y[],
                     struct bed *b) {
  const struct contact_list *l = d->list;
  for (size_t i = 0; i < l->moving; i++)
    for (size_t c = 0; c < 3; c++) {
      const double *row = y + i * l->stride;
      const size_t at = 3 * l->order[i] + c;
      b->x[at] = row[ROW_X + c];
      b->v[at] = row[ROW_V + c];
      if (l->has.rotation)
        b->w[at] = row[ROW_W + c];
    }
}

static int evaluate_all_pairs(const struct dynamics *d, const double *y,
                              double *dydt) {
  bool finite = true;
#pragma omp parallel for num_threads(d->options.threads) schedule(static)      \
    reduction(&& : finite)
  for (size_t i = 0; i < d->list->moving; i++)
    finite = allpairs_rates(d->list, y, dydt, i, i + 1) && finite;
  const size_t from = d->list->moving * d->list->stride;
  memset(dydt + from, 0, (dynamics_dimension(d) - from) * sizeof *dydt);
  return finite ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int evaluate_list(struct dynamics *d, const double *y,
                         const struct rates_to *to) {
  const int status = contact_list_update(d->list, y);
  if (status != GSL_SUCCESS)
    return status;
  d->list->age++;
  d->contacts += (double)contact_list_size(d->list);
  return rates_evaluate(d->list, d->kernel, y, to);
}

int dynamics_rhs(double t, const double y[], double dydt[], void *params) {
  (void)t;
  struct dynamics *d = params;
  d->evaluations++;
  return d->options.all_pairs
             ? evaluate_all_pairs(d, y, dydt)
             : evaluate_list(d, y, &(struct rates_to){.dydt = dydt});
}

int dynamics_stage(double t, const double y[], const struct stage *stage,
                   double out[], void *params) {
  (void)t;
  struct dynamics *d = params;
  assert(!d->options.all_pairs);
  d->evaluations++;
  return evaluate_list(d, y, &(struct rates_to){.stage = stage, .out = out});
}

int dynamics_jacobian(double t, const double y[], double *dfdy, double dfdt[],
                      void *params) {
  (void)t;
  struct dynamics *d = params;
  const int status = contact_list_update(d->list, y);
  if (status != GSL_SUCCESS)
    return status;
  const size_t dim = dynamics_dimension(d);
  memset(dfdt, 0, dim * sizeof *dfdt);
  jacobian_dense(d->list, y, dfdy);
  double checksum = 0; /* 0 times a number that is not finite is NaN */
  for (size_t i = 0; i < dim; i++)
    checksum += 0 * y[i];
  for (size_t i = 0; i < dim * dim; i++)
    checksum += 0 * dfdy[i];
  return checksum == 0 ? GSL_SUCCESS : GSL_EBADFUNC;
}

double dynamics_step_limit(const struct dynamics *d, const double y[],
                           const double dydt[], double travel) {
  const struct contact_list *l = d->list;
  double least = GSL_POSINF;
  for (size_t i = 0; i < l->rows; i++) {
    const double v = vec3_norm(y + i * l->stride + ROW_V);
    const double a = vec3_norm(dydt + i * l->stride + ROW_V);
    least = GSL_MIN(least, travel_time(v, a, travel));
  }
  return least;
}

void dynamics_scale(const struct dynamics *d, double scale[]) {
  contact_list_scale(d->list, scale);
}

double dynamics_kinetic(const struct dynamics *d, const double y[]) {
  const struct contact_list *l = d->list;
  double sum = 0;
  for (size_t i = 0; i < l->rows; i++) {
    const double *row = y + i * l->stride;
    double twice = vec3_dot(row + ROW_V, row + ROW_V);
    if (l->has.rotation)
      twice += 0.4 * l->radius[i] * l->radius[i] *
               vec3_dot(row + ROW_W, row + ROW_W);
    sum += 0.5 * l->mass[i] * twice;
  }
  return sum;
}

int dynamics_survey(struct dynamics *d, const double y[], struct survey *s) {
  const int status = contact_list_update(d->list, y);
  if (status != GSL_SUCCESS)
    return status;
  survey_take(d->list, y, s);
  return GSL_SUCCESS;
}

double dynamics_potential(struct dynamics *d, const double y[]) {
  struct survey s;
  return dynamics_survey(d, y, &s) == GSL_SUCCESS ? s.gravity + s.stored
                                                  : GSL_NAN;
}

double dynamics_fastest(const struct dynamics *d, const double y[]) {
  const struct contact_list *l = d->list;
  double fastest = 0;
  for (size_t i = 0; i < l->rows; i++)
    fastest = GSL_MAX(fastest, contact_list_speed(l, i, y + i * l->stride));
  return fastest;
}

const size_t *dynamics_order(const struct dynamics *d) {
  return d->list->order;
}

void dynamics_store(struct dynamics *d, struct store *s) {
  store_part(s, "dynamics");
  store_double(s, &d->evaluations);
  store_double(s, &d->contacts);
  contact_list_store(d->list, s);
}
