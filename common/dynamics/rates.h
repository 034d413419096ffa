/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The right-hand side over a contact list, shared among its threads. Internal
   to the room. Tested in tests/test_dynamics.c. */
#ifndef RATES_H
#define RATES_H

#include "dynamics/contact_list.h"
#include "dynamics/kernel.h"
#include "steppers/stage.h"

/* Where the rates go: all into dydt, or a few rows at a time, while they are in
   the cache, into a linear combination. */
struct rates_to {
  double *dydt; /* NULL for the combination */
  const struct stage *stage;
  double *out;
};

/* Of a state y that the list holds for. GSL_SUCCESS, or GSL_EBADFUNC where not
   all rates are finite. */
int rates_evaluate(const struct contact_list *list, const struct kernel *kernel,
                   const double y[], const struct rates_to *to);

#endif
