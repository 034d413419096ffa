/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The spectral radius of df/dy by power iteration over differences of f: it
   begins along f and goes on from the direction that it had. A fast mode that f
   has no part of and nothing couples to is not found. Not in the paper. Safe in
   any thread. Tested in tests/test_rkc.c. */
#ifndef POWER_H
#define POWER_H

#include <stdbool.h>
#include <stddef.h>

/* A state, its rates and how to get others. */
struct power_problem {
  size_t dim;
  double t, h;          /* the step that the radius is for (s) */
  const double *y, *f;  /* f(t, y) */
  const double *weight; /* 1 by the unit of each unknown */
  double least;         /* h times radius below which it is of no interest */
  /* f(t, y) into f; y has room for what the system needs beside it. */
  int (*rates)(double t, double y[], double f[], void *params);
  /* The sum over all processes that share the state, or NULL for one. */
  double (*total)(double part, void *params);
  void *params;
  double *trial, *slope; /* scratch */
};

/* State kept from one estimate to the next; zeroed, there is none. */
struct power {
  bool known;
  double length;      /* of the last iteration (1/s) */
  double radius;      /* the estimate, somewhat larger than it looks (1/s) */
  double *direction;  /* dim */
  size_t evaluations; /* so far */
};

/* Finds the radius. GSL_SUCCESS, or the error of rates. */
int power_estimate(struct power *p, const struct power_problem *q);

#endif
