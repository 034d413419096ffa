/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How an integration is asked for and what is said where it fails, in the same
   words by every program. Tested in tests/test_cli.sh. */
#ifndef INTEGRATION_H
#define INTEGRATION_H

#include "steppers/integrate.h"

/* What --help says of --control and --tol where they are left open: the
   defaults of steppers/integrate.h's tables. */
void integration_control_unset(char *text, size_t size);
void integration_tol_unset(char *text, size_t size);

/* Exits with EXIT_USAGE where options do not fit together that are right one
   by one: a method without an error estimate and no fixed step, one that takes
   none, or one that is too expensive for so many spheres. */
void integration_check(const struct integrate_options *o, size_t spheres);

/* What stopped a run, by the code of integrate_step. */
const char *integration_error(const struct integrate_options *o, int status);

#endif
