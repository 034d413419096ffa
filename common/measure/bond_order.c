/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/bond_order.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_sf_coupling.h>
#include <gsl/gsl_sf_legendre.h>
#include "geometry/periodic.h"
#include "geometry/vec3.h"

/* Y_lm for m = 0 ... l, real and imaginary part, first of l = 4, then of 6;
   negative m follow by symmetry and l is even, so a bond is the same from
   either end. */
enum { FOUR = 0, SIX = 5, TERMS = 12 };
struct harmonics {
  double re[TERMS], im[TERMS];
};

static void add_bond(struct harmonics *to, const struct harmonics *y) {
  for (int k = 0; k < TERMS; k++) {
    to->re[k] += y->re[k];
    to->im[k] += y->im[k];
  }
}

/* Of the direction u; false if it has none. */
static bool find_harmonics(const double u[3], struct harmonics *y) {
  const double d = vec3_norm(u), phi = atan2(u[1], u[0]);
  if (!(d > 0))
    return false;
  const double cosine = GSL_MAX(-1, GSL_MIN(1, u[2] / d));
  for (int k = 0; k < TERMS; k++) {
    const int l = k < SIX ? 4 : 6, m = k < SIX ? k : k - SIX;
    const double p = gsl_sf_legendre_sphPlm(l, m, cosine);
    y->re[k] = p * cos(m * phi);
    y->im[k] = p * sin(m * phi);
  }
  return true;
}

/* sqrt(4 pi/(2l+1) sum over m of |q_lm|^2) */
static double invariant(const struct harmonics *q, int first, int l) {
  double sum = 0;
  for (int m = 0; m <= l; m++) {
    const double re = q->re[first + m], im = q->im[first + m];
    sum += (m ? 2 : 1) * (re * re + im * im);
  }
  return sqrt(4 * M_PI / (2 * l + 1) * sum);
}

static void divide(struct harmonics *q, size_t count) {
  for (int k = 0; k < TERMS && count; k++) {
    q->re[k] /= (double)count;
    q->im[k] /= (double)count;
  }
}

/* Wigner's 3j symbols (l l l; a b -a-b) for l = 4 and 6. */
struct couplings {
  double four[9][9], six[13][13];
};

static double coupling(int l, int a, int b) {
  return abs(a + b) > l ? 0
                        : gsl_sf_coupling_3j(2 * l, 2 * l, 2 * l, 2 * a, 2 * b,
                                             -2 * (a + b));
}

static void find_couplings(struct couplings *c) {
  for (int a = -6; a <= 6; a++)
    for (int b = -6; b <= 6; b++) {
      c->six[a + 6][b + 6] = coupling(6, a, b);
      if (abs(a) <= 4 && abs(b) <= 4)
        c->four[a + 4][b + 4] = coupling(4, a, b);
    }
}

/* q_lm for any m: q_l,-m = (-1)^m times the conjugate. */
static void component(const struct harmonics *q, int first, int m, double *re,
                      double *im) {
  const int k = first + abs(m), odd = m < 0 && m % 2;
  *re = odd ? -q->re[k] : q->re[k];
  *im = (m < 0) != odd ? -q->im[k] : q->im[k];
}

/* Sum of 3j q_la q_lb q_lc over a + b + c = 0 by (sum of |q_lm|^2)^(3/2). */
static double third_invariant(const struct harmonics *q, int first, int l,
                              const double *symbols) {
  double sum = 0, norm = 0;
  for (int a = -l; a <= l; a++) {
    double ar, ai;
    component(q, first, a, &ar, &ai);
    norm += ar * ar + ai * ai;
    for (int b = GSL_MAX(-l, -l - a); b <= GSL_MIN(l, l - a); b++) {
      double br, bi, cr, ci;
      component(q, first, b, &br, &bi);
      component(q, first, -a - b, &cr, &ci);
      sum += symbols[(a + l) * (2 * l + 1) + b + l] *
             ((ar * br - ai * bi) * cr - (ar * bi + ai * br) * ci);
    }
  }
  return norm > 0 ? sum / pow(norm, 1.5) : 0;
}

enum bond_class bond_order_class(const struct bond_order *o, double least) {
  if (!(o->qbar6 >= least))
    return BOND_DISORDERED;
  if (o->wbar6 >= 0)
    return BOND_BCC;
  return o->wbar4 < 0 ? BOND_FCC : BOND_HCP;
}

int bond_order_find(size_t n, const double *x, const double period[3],
                    double cutoff, const struct observer *observer,
                    struct bond_order *order) {
  struct periodic_pairs near = {0};
  struct harmonics *q = calloc(n + 1, sizeof *q);
  struct harmonics *mean = calloc(n + 1, sizeof *mean);
  size_t i, j;
  double u[3];
  int status = GSL_ENOMEM;
  if (!q || !mean)
    goto done;
  status = periodic_pairs_find(&near, n, x, cutoff, period);
  if (status != GSL_SUCCESS)
    goto done;
  const size_t pairs = near.near.count;
  for (i = 0; i < n; i++)
    order[i] = (struct bond_order){0};
  for (size_t p = 0; p < pairs; p++) {
    struct harmonics y;
    observer_tell(observer, p, pairs + n);
    if (!periodic_pair(&near, p, &i, &j, u))
      continue;
    if (!find_harmonics(u, &y)) {
      status = GSL_EDOM;
      goto done;
    }
    add_bond(&q[i], &y);
    add_bond(&q[j], &y);
    order[i].neighbours++;
    order[j].neighbours++;
  }
  for (i = 0; i < n; i++) {
    divide(&q[i], order[i].neighbours);
    mean[i] = q[i];
  }
  for (size_t p = 0; p < pairs; p++) {
    if (!periodic_pair(&near, p, &i, &j, u))
      continue;
    add_bond(&mean[i], &q[j]);
    add_bond(&mean[j], &q[i]);
  }
  struct couplings symbols;
  find_couplings(&symbols);
  for (i = 0; i < n; i++) {
    observer_tell(observer, pairs + i, pairs + n);
    divide(&mean[i], order[i].neighbours + 1);
    order[i].q4 = invariant(&q[i], FOUR, 4);
    order[i].q6 = invariant(&q[i], SIX, 6);
    order[i].qbar4 = invariant(&mean[i], FOUR, 4);
    order[i].qbar6 = invariant(&mean[i], SIX, 6);
    order[i].wbar4 = third_invariant(&mean[i], FOUR, 4, symbols.four[0]);
    order[i].wbar6 = third_invariant(&mean[i], SIX, 6, symbols.six[0]);
  }
done:
  periodic_pairs_free(&near);
  free(mean);
  free(q);
  return status;
}
