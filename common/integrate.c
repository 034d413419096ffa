#include "integrate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "control.h"
#include "dopri5.h"
#include "merson.h"
#include "rkc.h"
#include "verlet.h"

const char *const integrate_methods[] = {"merson", "dopri5", "rkf45",
                                         "rkck",   "rk8pd",  "rkc",
                                         "verlet", "msbdf",  NULL};
const char *const integrate_controls[] = {"paper", "standard", "predictive",
                                          NULL};

struct integrator {
  gsl_odeiv2_system system; /* first: the multistep methods point to it */
  gsl_odeiv2_driver
      driver; /* of GSL's struct, so that msbdf finds its control */
  gsl_odeiv2_step *step;
  gsl_odeiv2_control *control; /* NULL: fixed step */
  gsl_odeiv2_evolve *evolve;
  double (*step_limit)(const double y[], const double dydt[], void *params);
  double hmax, fixed;
  double t, h, last_step;
  struct integrate_counts counts;
  double y[];
};

static const gsl_odeiv2_step_type *find_method(const char *name) {
  const struct {
    const char *name;
    const gsl_odeiv2_step_type *type;
  } methods[] = {{"merson", merson},
                 {"dopri5", dopri5},
                 {"rkf45", gsl_odeiv2_step_rkf45},
                 {"rkck", gsl_odeiv2_step_rkck},
                 {"rk8pd", gsl_odeiv2_step_rk8pd},
                 {"rkc", rkc},
                 {"verlet", verlet},
                 {"msbdf", gsl_odeiv2_step_msbdf}};
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    if (!strcmp(name, methods[i].name))
      return methods[i].type;
  return NULL;
}

static gsl_odeiv2_control *make_control(const struct integrate_options *o,
                                        const double *scale, size_t dim) {
  if (!strcmp(o->control, "paper"))
    return control_paper_new(o->tol);
  const double abstol = o->abstol > 0 ? o->abstol : o->tol;
  if (!strcmp(o->control, "predictive"))
    return control_predictive_new(abstol, o->reltol, scale, dim);
  return gsl_odeiv2_control_scaled_new(abstol, o->reltol, 1, 0, scale, dim);
}

void integrate_free(struct integrator *it) {
  if (!it)
    return;
  if (it->evolve)
    gsl_odeiv2_evolve_free(it->evolve);
  if (it->control)
    gsl_odeiv2_control_free(it->control);
  if (it->step)
    gsl_odeiv2_step_free(it->step);
  free(it);
}

int integrate_alloc(struct integrator **out, const struct integrate_options *o,
                    const struct integrate_problem *problem, double t,
                    const double y[]) {
  const size_t dim = problem->system.dimension;
  const gsl_odeiv2_step_type *type = find_method(o->method);
  bool known = false;
  for (size_t i = 0; integrate_controls[i]; i++)
    known = known || !strcmp(o->control, integrate_controls[i]);
  if (!type || !known || !(o->step > 0 || o->hinit > 0) ||
      (type == verlet && !(o->step > 0 && problem->positions > 0)))
    return GSL_EINVAL;
  struct integrator *it = calloc(1, sizeof *it + dim * sizeof *y);
  if (!it)
    return GSL_ENOMEM;
  it->system = problem->system;
  it->step_limit = problem->step_limit;
  it->hmax = o->hmax > 0 ? o->hmax : GSL_POSINF;
  it->fixed = o->step;
  it->t = t;
  it->h = o->hinit;
  memcpy(it->y, y, dim * sizeof *y);
  it->step = gsl_odeiv2_step_alloc(type, dim);
  it->evolve = gsl_odeiv2_evolve_alloc(dim);
  if (!(o->step > 0)) /* msbdf asks for a tolerance whatever its step */
    it->control = make_control(o, problem->scale, dim);
  if (!it->step || !it->evolve || (!it->control && !(o->step > 0))) {
    integrate_free(it);
    return GSL_ENOMEM;
  }
  if (type == verlet)
    verlet_set_layout(it->step, problem->row, problem->positions);
  it->driver = (gsl_odeiv2_driver){
      .sys = &it->system, .s = it->step, .c = it->control, .e = it->evolve};
  gsl_odeiv2_step_set_driver(it->step, &it->driver);
  *out = it;
  return GSL_SUCCESS;
}

/* One attempt at an accepted step of at most h; a right-hand side that is not
   finite ends it at once. */
static int attempt(struct integrator *it, double *h) {
  gsl_odeiv2_evolve *e = it->evolve;
  const double t = it->t;
  const unsigned long failed = e->failed_steps;
  /* not apply_fixed_step, which evaluates the start of every step anew */
  const int status = gsl_odeiv2_evolve_apply(
      e, it->control, it->step, &it->system, &it->t, GSL_DBL_MAX, h, it->y);
  it->counts.rejected += e->failed_steps - failed;
  if (status != GSL_SUCCESS) {
    if (status == GSL_FAILURE && e->count > 0) /* y holds the rejected trial */
      memcpy(it->y, e->y0, it->system.dimension * sizeof *it->y);
    it->t = t;
    /* what evolve would take for the derivative may be half written */
    gsl_odeiv2_evolve_reset(e);
    gsl_odeiv2_step_reset(it->step);
  }
  return status;
}

int integrate_step(struct integrator *it) {
  double h = it->fixed > 0 ? it->fixed : GSL_MIN(it->h, it->hmax);
  if (it->step_limit && !(it->fixed > 0)) {
    const gsl_odeiv2_evolve *e = it->evolve;
    if (e->count == 0) { /* evolve has not evaluated it yet */
      const int status =
          GSL_ODEIV_FN_EVAL(&it->system, it->t, it->y, e->dydt_out);
      if (status != GSL_SUCCESS)
        return status;
    }
    h = GSL_MIN(h, it->step_limit(it->y, e->dydt_out, it->system.params));
  }
  const double start = it->t;
  /* Below this a step no longer moves t. */
  const double smallest = 4 * GSL_DBL_EPSILON * GSL_MAX(fabs(start), 1e-3);
  int status = attempt(it, &h);
  while (status == GSL_EBADFUNC && !(it->fixed > 0) && h > smallest) {
    it->counts.rejected++;
    h /= 4;
    status = attempt(it, &h);
  }
  if (status != GSL_SUCCESS)
    return status == GSL_EBADFUNC ? GSL_FAILURE : status;
  it->counts.accepted++;
  it->last_step = it->t - start;
  it->h = h;
  return GSL_SUCCESS;
}

double integrate_time(const struct integrator *it) {
  return it->t;
}

const double *integrate_state(const struct integrator *it) {
  return it->y;
}

double integrate_last_step(const struct integrator *it) {
  return it->last_step;
}

struct integrate_counts integrate_counts(const struct integrator *it) {
  return it->counts;
}

const double *integrate_derivative(const struct integrator *it) {
  return it->evolve->dydt_out;
}

int integrate_at(const struct integrator *it, double t, double y[]) {
  const size_t dim = it->system.dimension;
  const double h = it->last_step;
  if (h == 0 || t == it->t) {
    if (t != it->t)
      return GSL_EDOM;
    memcpy(y, it->y, dim * sizeof *y);
    return GSL_SUCCESS;
  }
  const double s = (t - (it->t - h)) / h;
  if (!(s >= -1e-9 && s <= 1 + 1e-9))
    return GSL_EDOM;
  const gsl_odeiv2_evolve *e = it->evolve;
  /* Hermite basis: 1 - w and w for values, p and q for slopes */
  const double w = s * s * (3 - 2 * s);
  const double p = h * s * (1 - s) * (1 - s), q = -h * s * s * (1 - s);
  for (size_t i = 0; i < dim; i++)
    y[i] = e->y0[i] + w * (it->y[i] - e->y0[i]) + p * e->dydt_in[i] +
           q * e->dydt_out[i];
  return GSL_SUCCESS;
}
