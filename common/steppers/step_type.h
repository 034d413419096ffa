/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions that a gsl_odeiv2 step or control type has to have and ours do
   without: GSL calls both unchecked and keeps its own empty versions private.
 */
#ifndef STEP_TYPE_H
#define STEP_TYPE_H

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static inline int step_no_driver(void *state, const gsl_odeiv2_driver *d) {
  (void)state;
  (void)d;
  return GSL_SUCCESS;
}

static inline int step_no_reset(void *state, size_t dim) {
  (void)state;
  (void)dim;
  return GSL_SUCCESS;
}

#endif
