/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/closed_forms.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

/* The root of f in [a, b], to the last bit or two. */
static int find_root(double (*f)(double, void *), void *params, double a,
                     double b, double *root) {
  gsl_function function = {f, params};
  gsl_root_fsolver *s = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!s)
    return GSL_ENOMEM;
  int status = gsl_root_fsolver_set(s, &function, a, b);
  for (int k = 0; k < 200 && status == GSL_SUCCESS; k++) {
    status = gsl_root_fsolver_iterate(s);
    if (status == GSL_SUCCESS &&
        gsl_root_test_interval(gsl_root_fsolver_x_lower(s),
                               gsl_root_fsolver_x_upper(s), 0,
                               2 * GSL_DBL_EPSILON) == GSL_SUCCESS)
      break;
  }
  if (status == GSL_SUCCESS)
    *root = gsl_root_fsolver_root(s);
  gsl_root_fsolver_free(s);
  return status;
}

/* Where rounding stops the quadrature early, its own error estimate decides. */
static int integral(double (*f)(double, void *), void *params, double a,
                    double b, double *result, double *error) {
  gsl_function function = {f, params};
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(1000);
  if (!w)
    return GSL_ENOMEM;
  const int status = gsl_integration_qag(&function, a, b, 0, 2e-14, 1000,
                                         GSL_INTEG_GAUSS31, w, result, error);
  gsl_integration_workspace_free(w);
  return status == GSL_EROUND && *error <= 1e-12 * fabs(*result) ? GSL_SUCCESS
                                                                 : status;
}

void closed_collision(double f0, double kappa, double v0, double tau,
                      double *gap, double *velocity) {
  const double x = kappa * v0 * tau / 2;
  /* ln cosh x without overflow */
  const double cosine = fabs(x) + log1p(exp(-2 * fabs(x))) - M_LN2;
  *gap = (2 * cosine - log(kappa * v0 * v0 / (2 * f0))) / kappa;
  *velocity = v0 * tanh(x);
}

/* --- restitution -----------------------------------------------------------*/

static double loading(double u, void *params) {
  return u / contact_rebound(params, u);
}

static double unloading(double u, void *params) {
  return u / contact_rebound(params, -u);
}

struct rebound {
  struct contact_law law;
  double spent;
};

static double rebound_rest(double v, void *params) {
  struct rebound *r = params;
  double sum = 0, error;
  if (v > 0 && integral(unloading, &r->law, 0, v, &sum, &error) != GSL_SUCCESS)
    return GSL_NAN;
  return sum - r->spent;
}

int closed_restitution(const struct contact_law *c, double v0, double *v1,
                       double *error) {
  struct rebound r = {*c, 0};
  double spent_error, v = 0;
  if (!(v0 > 0))
    return GSL_EDOM;
  int status = integral(loading, &r.law, 0, v0, &r.spent, &spent_error);
  /* equal at e = 1, up to rounding */
  if (status == GSL_SUCCESS)
    status = find_root(rebound_rest, &r, 0, v0 * (1 + 1e-6), &v);
  if (status != GSL_SUCCESS)
    return status;
  *v1 = v;
  /* the other integral is as good */
  *error = 2 * spent_error / unloading(v, &r.law);
  return GSL_SUCCESS;
}

/* --- rebound under gravity -------------------------------------------------*/

struct fall {
  double f0, kappa, gravity, height, energy, low;
};

static double fall_potential(double l, void *params) {
  const struct fall *f = params;
  return f->gravity * l + f->f0 / f->kappa * exp(-f->kappa * l) - f->energy;
}

/* dt/ds with l = low + s^2, exact in the difference of potentials, which
   vanishes as s^2 at the turning point */
static double fall_low(double s, void *params) {
  const struct fall *f = params;
  const double x = s * s;
  const double share =
      x > 0 ? -expm1(-f->kappa * x) / (f->kappa * x) : 1; /* to 1 at 0 */
  return 2 / sqrt(2 * (f->f0 * exp(-f->kappa * f->low) * share - f->gravity));
}

/* and with l = height - s^2, where the contact has vanished at 0 */
static double fall_high(double s, void *params) {
  const struct fall *f = params;
  const double x = s * s;
  const double push =
      x > 0 ? f->f0 * exp(-f->kappa * (f->height - x)) / (f->kappa * x) : 0;
  return 2 / sqrt(2 * (f->gravity - push));
}

int closed_rebound_time(double f0, double kappa, double gravity, double height,
                        double *time, double *error) {
  struct fall f = {f0,
                   kappa,
                   gravity,
                   height,
                   gravity * height + f0 / kappa * exp(-kappa * height),
                   0};
  const double split = 40 / kappa; /* where the contact begins */
  double below = 0, above = 0, below_error = 0, above_error = 0;
  if (!(height > split) || !(gravity > 0))
    return GSL_EDOM;
  /* e times as much energy as there is at the lower end */
  int status =
      find_root(fall_potential, &f, -(log(kappa * f.energy / f0) + 1) / kappa,
                split, &f.low);
  if (status == GSL_SUCCESS)
    status =
        integral(fall_low, &f, 0, sqrt(split - f.low), &below, &below_error);
  if (status == GSL_SUCCESS)
    status =
        integral(fall_high, &f, 0, sqrt(height - split), &above, &above_error);
  if (status != GSL_SUCCESS)
    return status;
  *time = 2 * (below + above);
  *error = 2 * (below_error + above_error);
  return GSL_SUCCESS;
}

/* --- friction --------------------------------------------------------------*/

double closed_rest_gap(const struct contact_law *c, double normal) {
  return log(c->f0 * contact_rebound(c, 0) / normal) / c->kappa;
}

double closed_slip_time(double s, double vmin, double rate) {
  return vmin / rate * (1 / (3 * s) - 2. / 9 * log(s / (3 - 2 * s)) - 1. / 3);
}

struct slip {
  double t, vmin, rate;
};

static double slip_rest(double s, void *params) {
  const struct slip *p = params;
  return closed_slip_time(s, p->vmin, p->rate) - p->t;
}

int closed_slip_share(double t, double vmin, double rate, double *s) {
  struct slip p = {t, vmin, rate};
  if (!(t >= 0))
    return GSL_EDOM;
  /* 1/(3 s) alone is less than the whole plus 1/3 */
  return find_root(slip_rest, &p, 1 / (3 * (t * rate / vmin + 1)), 1, s);
}

/* The indefinite integral of 1/rho(u) = (1 + q)/(1 + e^2 q), q = exp(-2 psi u):
   u - (1 - e^2)/(2 psi) ln(1 + e^2 q)/e^2. */
static double rebound_integral(const struct contact_law *c, double u) {
  const double e2 = c->restitution * c->restitution, x = -2 * c->psi * u;
  double part;
  if (x > 0 && e2 > 0) /* without overflow */
    part = (x + log(exp(-x) + e2)) / e2;
  else
    part = e2 > 0 ? log1p(e2 * exp(x)) / e2 : exp(x);
  return u - (1 - e2) / (2 * c->psi) * part;
}

double closed_impulse(const struct contact_law *c, double v0, double v1) {
  return rebound_integral(c, v0) - rebound_integral(c, -v1);
}

int closed_slip(double slip, double vmin, double braked, double *left) {
  double rest = braked - fmax(0, slip - vmin), share = 0;
  if (!(slip >= 0 && braked >= 0))
    return GSL_EDOM;
  if (rest <= 0 || slip == 0) {
    *left = slip > 0 ? slip - braked : 0;
    return GSL_SUCCESS;
  }
  if (slip < vmin)
    rest += closed_slip_time(slip / vmin, vmin, 1);
  const int status = closed_slip_share(rest, vmin, 1, &share);
  if (status == GSL_SUCCESS)
    *left = share * vmin;
  return status;
}

double closed_creep(double t, double vmin, double rate) {
  const double w = M_SQRT1_2 / 2 * exp(-1.5 * rate * t / vmin);
  return vmin * (0.5 + M_SQRT3 * w / sqrt(1 + 4 * w * w));
}
