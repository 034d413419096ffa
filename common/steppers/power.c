/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "steppers/power.h"

#include <math.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "platform/multiversion.h"
#include "steppers/stage.h"

/* The estimate grows towards the spectral radius from below. */
static const double safety = 1.2;

/* Two iterations that differ by less end the search. Contacts that form can
   make the radius several times larger within a step; a step that was too long
   for it is rejected. */
static const double agreement = 0.1;

/* Lengths that swing by more than this are of complex eigenvalues. */
static const double swing = 3;

/* Iterations at most when nothing is known and when something is. */
enum { FIRST_ITERATIONS = 50, NEXT_ITERATIONS = 8 };

MULTIVERSION
static double square_of(size_t dim, const double *restrict x,
                        const double *restrict weight) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (size_t i = 0; i < dim; i++)
    sum += weight[i] * x[i] * (weight[i] * x[i]);
  return sum;
}

/* Of a vector of unknowns or rates, each in its unit. */
static double norm(const struct power_problem *q, const double *x) {
  const double square = square_of(q->dim, x, q->weight);
  return sqrt(q->total ? q->total(square, q->params) : square);
}

/* A direction along all unknowns. */
static void any_direction(struct power *p, const struct power_problem *q) {
  for (size_t i = 0; i < q->dim; i++)
    p->direction[i] = (i % 2 ? 1 : -1) / q->weight[i];
}

/* One iteration: direction <- (f(y + small direction) - f(y)) / small; its
   length is the estimate. */
static int iterate(struct power *p, const struct power_problem *q,
                   double *radius) {
  const double length = norm(q, p->direction);
  const double small = sqrt(GSL_DBL_EPSILON) * GSL_MAX(norm(q, q->y), 1e-3);
  stage_move(q->dim, small / length, q->y, p->direction, q->trial);
  const int status = q->rates(q->t, q->trial, q->slope, q->params);
  p->evaluations++;
  if (status != GSL_SUCCESS)
    return status;
  for (size_t i = 0; i < q->dim; i++)
    p->direction[i] = q->slope[i] - q->f[i];
  *radius = norm(q, p->direction) / small;
  if (!(*radius > 0)) /* f does not change along it: try another */
    any_direction(p, q);
  return GSL_SUCCESS;
}

/* Where a pair of complex eigenvalues is the fastest, as of contacts with
   little damping, positions and velocities take turns: the lengths swing about
   |lambda| by the ratio of their units, as w^2, 1, w^2, ... for +-i w, and the
   geometric mean of two in a row is |lambda|. length: the last three, the
   latest first. */
static bool turns(const double length[3]) {
  return (length[1] < length[0]) == (length[1] < length[2]);
}

static bool swings(const double length[3]) {
  const double up = GSL_MIN(length[0], length[2]) / length[1];
  const double down = length[1] / GSL_MAX(length[0], length[2]);
  const double now = sqrt(length[0] * length[1]),
               before = sqrt(length[1] * length[2]);
  return GSL_MAX(up, down) > swing && fabs(now - before) <= agreement * now;
}

int power_estimate(struct power *p, const struct power_problem *q) {
  size_t most = NEXT_ITERATIONS;
  if (!p->known) {
    most = FIRST_ITERATIONS;
    memcpy(p->direction, q->f, q->dim * sizeof *q->f);
    if (!(norm(q, q->f) > 0))
      any_direction(p, q);
    p->length = 0;
  }
  double length[3] = {p->length}, radius = 0;
  for (size_t k = 0; k < most; k++) {
    length[2] = length[1];
    length[1] = length[0];
    const int status = iterate(p, q, &length[0]);
    if (status != GSL_SUCCESS)
      return status;
    radius = length[0];
    if ((length[1] > 0 || k) && fabs(radius - length[1]) <= agreement * radius)
      break;
    /* nothing to find out where the fewest stages do for either */
    if (k < 2 || !turns(length) ||
        fabs(q->h) * safety * GSL_MAX(length[0], length[1]) <= q->least)
      continue;
    radius = sqrt(length[0] * length[1]);
    if (swings(length))
      break;
  }
  p->length = length[0];
  p->radius = safety * radius;
  p->known = true;
  return GSL_SUCCESS;
}
