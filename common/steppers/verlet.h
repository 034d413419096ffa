/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Velocity Verlet, the field's standard, as a gsl_odeiv2 step type with a
   fixed step and one evaluation per step: L. Verlet, Phys. Rev. 159 (1967) 98;
   W. C. Swope et al., J. Chem. Phys. 76 (1982) 637. Forces that depend on
   velocity are evaluated with that of the half step, as molecular dynamics
   codes do, so friction is integrated to first order. It has no error
   estimate: yerr is zero. Not in the paper. Tested in tests/test_steppers.c. */
#ifndef VERLET_H
#define VERLET_H

#include <gsl/gsl_odeiv2.h>

extern const gsl_odeiv2_step_type *const verlet;

/* Unknowns come in rows of which the first are positions and the next as many
   their velocities, the rest (spins) being velocities too. To be called before
   the first step. */
void verlet_set_layout(gsl_odeiv2_step *s, size_t row, size_t positions);

#endif
