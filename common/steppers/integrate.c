/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/integrate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "steppers/control.h"
#include "steppers/dopri5.h"
#include "steppers/hermite.h"
#include "steppers/merson.h"
#include "steppers/verlet.h"

enum { PAPER, STANDARD, PREDICTIVE, LOCAL };

static double absolute_tolerance(const struct integrate_options *o) {
  return o->abstol > 0 ? o->abstol : o->tol;
}

static int paper_alloc(gsl_odeiv2_control **out,
                       const struct integrate_options *o, const double *scale,
                       size_t dim) {
  (void)scale;
  (void)dim;
  return control_paper_alloc(out, o->tol);
}

static int standard_alloc(gsl_odeiv2_control **out,
                          const struct integrate_options *o,
                          const double *scale, size_t dim) {
  gsl_odeiv2_control *c = gsl_odeiv2_control_scaled_new(
      absolute_tolerance(o), o->reltol, 1, 0, scale, dim);
  if (!c)
    return GSL_ENOMEM;
  *out = c;
  return GSL_SUCCESS;
}

static int predictive_alloc(gsl_odeiv2_control **out,
                            const struct integrate_options *o,
                            const double *scale, size_t dim) {
  return control_predictive_alloc(out, absolute_tolerance(o), o->reltol, scale,
                                  dim);
}

const struct integrate_control integrate_controls[] = {
    [PAPER] = {.name = "paper",
               .help = "the paper's: error per unit step",
               .tol = 0.1,
               .per_time = true,
               .alloc = paper_alloc},
    [STANDARD] = {.name = "standard",
                  .help = "GSL's: error of each unknown by its scale",
                  .tol = 5e-4,
                  .alloc = standard_alloc},
    [PREDICTIVE] = {.name = "predictive",
                    .help = "the same, the next step from the last two errors",
                    .tol = 5e-4,
                    .alloc = predictive_alloc,
                    .store = control_predictive_store},
    [LOCAL] = {.name = "local",
               .help = "each sphere's own step, for multirate",
               .tol = 2e-3},
    {0}};

static void prepare_rkc(gsl_odeiv2_step *s, const struct integrate_problem *p) {
  rkc_set_system(s, p->stage, p->threads, p->scale);
}

static void prepare_verlet(gsl_odeiv2_step *s,
                           const struct integrate_problem *p) {
  verlet_set_layout(s, p->row, p->positions);
}

const struct integrate_method integrate_methods[] = {
    {.name = "merson",
     .help = "Runge-Kutta-Merson, order 4: the paper's",
     .type = &merson,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .fixed = true,
     .vectors = 22},
    {.name = "dopri5",
     .help = "Dormand-Prince, order 5 (MATLAB's ode45)",
     .type = &dopri5,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .fixed = true,
     .vectors = 25},
    {.name = "rkf45",
     .help = "Runge-Kutta-Fehlberg, order 5",
     .type = &gsl_odeiv2_step_rkf45,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .fixed = true,
     .vectors = 25},
    {.name = "rkck",
     .help = "Runge-Kutta-Cash-Karp, order 5",
     .type = &gsl_odeiv2_step_rkck,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .fixed = true,
     .vectors = 25},
    {.name = "rk8pd",
     .help = "Prince-Dormand, order 8",
     .type = &gsl_odeiv2_step_rk8pd,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .fixed = true,
     .vectors = 30},
    {.name = "rkc",
     .help = "Runge-Kutta-Chebyshev, order 2, for stiff friction",
     .type = &rkc,
     .control = &integrate_controls[PREDICTIVE],
     .estimates = true,
     .fixed = true,
     .adapts = true,
     .prepare = prepare_rkc,
     .store = rkc_store,
     .vectors = 19},
    {.name = "multirate",
     .help = "rkc with a step for each sphere",
     .control = &integrate_controls[LOCAL],
     .estimates = true,
     .adapts = true,
     .vectors = 46},
    {.name = "verlet",
     .help = "velocity Verlet, needs a fixed --step",
     .type = &verlet,
     .control = &integrate_controls[PAPER],
     .fixed = true,
     .layout = true,
     .half = true,
     .prepare = prepare_verlet,
     .vectors = 17},
    {.name = "msbdf",
     .help = "backward differentiation, implicit, for few spheres",
     .type = &gsl_odeiv2_step_msbdf,
     .control = &integrate_controls[PAPER],
     .estimates = true,
     .jacobian = true,
     .adapts = true,
     .opaque = true},
    {0}};

const struct integrate_method *integrate_method(const char *name) {
  for (const struct integrate_method *m = integrate_methods; m->name; m++)
    if (name && !strcmp(name, m->name))
      return m;
  return NULL;
}

const struct integrate_control *integrate_control(const char *name) {
  for (const struct integrate_control *c = integrate_controls; c->name; c++)
    if (name && !strcmp(name, c->name))
      return c;
  return NULL;
}

struct integrator {
  gsl_odeiv2_system system; /* first: the multistep methods point to it */
  gsl_odeiv2_driver
      driver; /* of GSL's struct, so that msbdf finds its control */
  gsl_odeiv2_step *step;
  gsl_odeiv2_control *control; /* NULL: fixed step */
  const struct integrate_method *method;
  const struct integrate_control *controls; /* of which control is one */
  gsl_odeiv2_evolve *evolve;
  double (*step_limit)(const double y[], const double dydt[], void *params);
  double hmax, fixed, stop, h;
  struct integrate_counts counts;
  struct integrate_view now;
  const struct integrate_engine *engine; /* NULL: GSL's evolve takes steps */
  void *own;                             /* the engine's */
  /* The last step from start to y, for the interpolation; a failed attempt
     overwrites what evolve has of it. */
  double *start, *start_rate, *rate;
  double y[];
};

void integrate_defaults(struct integrate_options *o) {
  const struct integrate_method *m = integrate_method(o->method);
  if (!o->control && m)
    o->control = m->control->name;
  const struct integrate_control *c = integrate_control(o->control);
  if (o->tol == 0 && c)
    o->tol = c->tol;
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
  if (it->engine)
    it->engine->free(it->own);
  free(it);
}

static bool options_fit(const struct integrate_options *o,
                        const struct integrate_problem *p,
                        const struct integrate_method *m) {
  const bool fixed = o->step > 0;
  if ((fixed && !m->fixed) || (!fixed && !m->estimates) ||
      (m->jacobian && !p->system.jacobian) || (!m->type && !p->engine))
    return false;
  if (m->layout && !(p->positions > 0 && 2 * p->positions <= p->row &&
                     p->system.dimension % p->row == 0))
    return false;
  if (fixed)
    return true;
  const struct integrate_control *c = integrate_control(o->control);
  return c && !c->alloc == !m->type && o->hinit > 0 && gsl_finite(o->hinit) &&
         o->reltol >= 0 && (o->tol > 0 || (o->abstol > 0 && !c->per_time));
}

static int alloc_engine(struct integrator **out,
                        const struct integrate_options *o,
                        const struct integrate_problem *problem, double t,
                        const double y[]) {
  struct integrator *it = calloc(1, sizeof *it);
  if (!it)
    return GSL_ENOMEM;
  const int status =
      problem->engine->alloc(&it->own, o, t, y, problem->engine_params);
  if (status != GSL_SUCCESS) {
    free(it);
    return status;
  }
  it->engine = problem->engine;
  it->system = problem->system;
  it->stop = GSL_DBL_MAX;
  it->now = it->engine->view(it->own);
  *out = it;
  return GSL_SUCCESS;
}

int integrate_alloc(struct integrator **out, const struct integrate_options *o,
                    const struct integrate_problem *problem, double t,
                    const double y[]) {
  const size_t dim = problem->system.dimension;
  const struct integrate_method *m = integrate_method(o->method);
  if (!m || !options_fit(o, problem, m))
    return GSL_EINVAL;
  if (!m->type)
    return alloc_engine(out, o, problem, t, y);
  struct integrator *it = calloc(1, sizeof *it + 4 * dim * sizeof *y);
  if (!it)
    return GSL_ENOMEM;
  it->start = it->y + dim;
  it->start_rate = it->start + dim;
  it->rate = it->start_rate + dim;
  it->system = problem->system;
  it->step_limit = problem->step_limit;
  it->hmax = o->hmax > 0 ? o->hmax : GSL_POSINF;
  it->fixed = o->step;
  it->stop = GSL_DBL_MAX;
  it->now = (struct integrate_view){.t = t,
                                    .y = it->y,
                                    .rate = it->rate,
                                    .start = it->start,
                                    .start_rate = it->start_rate};
  it->h = o->hinit;
  memcpy(it->y, y, dim * sizeof *y);
  it->step = gsl_odeiv2_step_alloc(*m->type, dim);
  it->evolve = gsl_odeiv2_evolve_alloc(dim);
  int status = it->step && it->evolve ? GSL_SUCCESS : GSL_ENOMEM;
  it->method = m;
  it->controls = integrate_control(o->control);
  if (status == GSL_SUCCESS && !(o->step > 0))
    status = it->controls->alloc(&it->control, o, problem->scale, dim);
  if (status != GSL_SUCCESS) {
    integrate_free(it);
    return status;
  }
  if (m->prepare)
    m->prepare(it->step, problem);
  it->driver = (gsl_odeiv2_driver){
      .sys = &it->system, .s = it->step, .c = it->control, .e = it->evolve};
  gsl_odeiv2_step_set_driver(it->step, &it->driver);
  *out = it;
  return GSL_SUCCESS;
}

/* One attempt at an accepted step of at most h; on failure time and state are
   those before it. */
static int attempt(struct integrator *it, double *h) {
  gsl_odeiv2_evolve *e = it->evolve;
  const double t = it->now.t;
  const unsigned long failed = e->failed_steps;
  /* not apply_fixed_step, which evaluates the start of every step anew */
  int status = gsl_odeiv2_evolve_apply(e, it->control, it->step, &it->system,
                                       &it->now.t, it->stop, h, it->y);
  it->counts.rejected += e->failed_steps - failed;
  /* evolve shortens a fixed step that fails, and takes steps too short to move
     the time */
  if (status == GSL_SUCCESS &&
      (!(it->now.t > t) ||
       (it->fixed > 0 && e->last_step != it->fixed && it->now.t != it->stop)))
    status = GSL_FAILURE;
  if (status != GSL_SUCCESS) {
    memcpy(it->y, e->y0, it->system.dimension * sizeof *it->y);
    it->now.t = t;
    /* what evolve would take for the derivative may be half written */
    gsl_odeiv2_evolve_reset(e);
    gsl_odeiv2_step_reset(it->step);
  }
  return status;
}

/* The step to try first. */
static int first_trial(struct integrator *it, double *h) {
  gsl_odeiv2_evolve *e = it->evolve;
  *h = it->fixed > 0 ? it->fixed : GSL_MIN(it->h, it->hmax);
  if (!it->step_limit || it->fixed > 0)
    return GSL_SUCCESS;
  if (e->count == 0) { /* evolve has not evaluated it yet */
    const int status =
        GSL_ODEIV_FN_EVAL(&it->system, it->now.t, it->y, e->dydt_out);
    if (status != GSL_SUCCESS)
      return status;
  }
  *h = GSL_MIN(*h, it->step_limit(it->y, e->dydt_out, it->system.params));
  return GSL_SUCCESS;
}

int integrate_stop(struct integrator *it, double t) {
  if (!(t > it->now.t))
    return GSL_EINVAL;
  it->stop = t;
  return GSL_SUCCESS;
}

static int step_engine(struct integrator *it) {
  const int status = it->engine->step(it->own, it->stop, &it->counts);
  if (status == GSL_SUCCESS)
    it->now = it->engine->view(it->own);
  return status;
}

int integrate_step(struct integrator *it) {
  const gsl_odeiv2_evolve *e = it->evolve;
  const size_t bytes = it->system.dimension * sizeof *it->y;
  const double start = it->now.t;
  if (start == it->stop)
    return GSL_EDOM;
  if (it->engine)
    return step_engine(it);
  /* Below this a step no longer moves t. */
  const double smallest = 4 * GSL_DBL_EPSILON * GSL_MAX(fabs(start), 1e-3);
  double h;
  int status = first_trial(it, &h);
  if (status == GSL_SUCCESS) {
    status = attempt(it, &h);
    while (status == GSL_EBADFUNC && !(it->fixed > 0) && h > smallest) {
      it->counts.rejected++;
      h /= 4;
      status = attempt(it, &h);
    }
  }
  if (status == GSL_EFAULT)
    return GSL_ENOMEM;
  if (status != GSL_SUCCESS)
    return status == GSL_EBADFUNC ? GSL_FAILURE : status;
  assert(it->now.t > start && it->now.t <= it->stop);
  it->counts.accepted++;
  it->now.last_step = it->now.t - start;
  it->h = h;
  memcpy(it->start, e->y0, bytes);
  memcpy(it->start_rate, e->dydt_in, bytes);
  memcpy(it->rate, e->dydt_out, bytes);
  return GSL_SUCCESS;
}

double integrate_time(const struct integrator *it) {
  return it->now.t;
}

const double *integrate_state(const struct integrator *it) {
  return it->now.y;
}

double integrate_last_step(const struct integrator *it) {
  return it->now.last_step;
}

struct integrate_counts integrate_counts(const struct integrator *it) {
  return it->counts;
}

const double *integrate_derivative(const struct integrator *it) {
  return it->now.rate;
}

int integrate_limits(const char *method, struct stiffness_limits *l) {
  const struct integrate_method *m = integrate_method(method);
  if (!m || m->adapts)
    return GSL_EINVAL;
  if (!m->layout) /* a method for any system, such as the test equation */
    return stiffness_limits(*m->type, l);
  for (size_t k = 0; k < STIFFNESS_RAYS; k++)
    l->at[k] = 2;
  return GSL_SUCCESS;
}

struct integrate_view integrate_view(const struct integrator *it) {
  return it->now;
}

const void *integrate_engine(const struct integrator *it) {
  return it->own;
}

struct rkc_report integrate_rkc_report(const struct integrator *it) {
  if (it->engine)
    return it->engine->report(it->own);
  return it->step->type == rkc ? rkc_report(it->step) : (struct rkc_report){0};
}

int integrate_at(const struct integrator *it, double t, double y[]) {
  const struct integrate_view *v = &it->now;
  const size_t dim = it->system.dimension;
  const double h = v->last_step;
  if (t == v->t) {
    memcpy(y, v->y, dim * sizeof *y);
    return GSL_SUCCESS;
  }
  const double s = (t - (v->t - h)) / h;
  if (!(h > 0 && s >= -1e-9 && s <= 1 + 1e-9))
    return GSL_EDOM;
  const struct hermite w = hermite_at(s, h);
  for (size_t i = 0; i < dim; i++)
    y[i] =
        hermite_value(&w, v->start[i], v->start_rate[i], v->y[i], v->rate[i]);
  if (it->engine)
    it->engine->at(it->own, t, y);
  return GSL_SUCCESS;
}

/* Of GSL's evolve: the rates at the end of a step are those at the start of the
   next. */
static void store_evolve(gsl_odeiv2_evolve *e, struct store *s) {
  size_t count = e->count, failed = e->failed_steps;
  store_size(s, &count);
  store_size(s, &failed);
  store_double(s, &e->last_step);
  store_doubles(s, e->dydt_out, e->dimension);
  e->count = count;
  e->failed_steps = failed;
}

void integrate_store(struct integrator *it, struct store *s) {
  store_part(s, "integrator");
  store_double(s, &it->stop);
  store_size(s, &it->counts.accepted);
  store_size(s, &it->counts.rejected);
  if (it->engine) {
    it->engine->store(it->own, s);
    it->now = it->engine->view(it->own);
    return;
  }
  const size_t dim = it->system.dimension;
  if (it->method->opaque)
    store_fail(s, GSL_EINVAL);
  store_double(s, &it->now.t);
  store_double(s, &it->now.last_step);
  store_double(s, &it->h);
  store_doubles(s, it->y, dim);
  store_doubles(s, it->rate, dim);
  store_evolve(it->evolve, s);
  if (it->method->store)
    it->method->store(it->step, s);
  if (it->control && it->controls->store)
    it->controls->store(it->control, s);
}
