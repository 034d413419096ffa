/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta-Chebyshev of order 2 with a variable number of stages, for
   stiff systems whose fast modes are damped: B. P. Sommeijer, L. F. Shampine,
   J. G. Verwer, J. Comput. Appl. Math. 88 (1998) 315. s stages reach about
   0.65 s^2 on the negative real axis (chebyshev.h), so that a step costs as the
   square root of its stiffness. Not in the paper.

   The stage number of each step follows from an estimate of the spectral
   radius of df/dy by nonlinear power iteration, which begins along f and goes
   on from the vector it had. A fast mode that f has no part of and nothing
   couples to is not found; step control then shortens the steps. Tested in
   tests/test_rkc.c. */
#ifndef RKC_H
#define RKC_H

#include <gsl/gsl_odeiv2.h>
#include "platform/store.h"
#include "steppers/rkc_step.h"

extern const gsl_odeiv2_step_type *const rkc;

/* Findings of a stepper of this type so far. */
struct rkc_report rkc_report(const gsl_odeiv2_step *s);

/* A system's own stage function, which a step then calls instead of the
   right-hand side followed by a sum over vectors, or NULL, the default; the two
   differ by rounding. The threads that share the vectors of a large system; 1,
   the default, for less than that. And the unit of each unknown, dimension
   numbers that are copied, or NULL, the default, for 1: vectors of unknowns of
   several kinds have lengths only in their units. */
void rkc_set_system(gsl_odeiv2_step *s, stage_function *stage, int threads,
                    const double *scale);

/* Its memory (platform/store.h). */
void rkc_store(gsl_odeiv2_step *stepper, struct store *s);

#endif
