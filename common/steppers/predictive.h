/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The length of the next step from the last two errors (Gustafsson, ACM Trans.
   Math. Softw. 17 (1991) 533), so that a collision is met by steps that shrink
   ahead of it instead of by rejected ones. Not in the paper. One integration
   at a time. Tested in tests/test_steppers.c. */
#ifndef PREDICTIVE_H
#define PREDICTIVE_H

#include <stdbool.h>

/* Zeroed, there was no step. */
struct predictive {
  double last_error, last_step; /* of the last accepted step; 0: none */
  bool after_rejection;
};

/* Is a step of length *h by a method of this order accepted, whose error is
   given in units of the tolerance? *h becomes the length of the next one, or of
   the next attempt. An error that is NaN is too large. */
bool predictive_accepts(struct predictive *p, double error, unsigned order,
                        double *h);

#endif
