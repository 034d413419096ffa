/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of an integration, and the messages where it fails: the same in
   every program. Tested in tests/test_cli.sh. */
#ifndef INTEGRATION_H
#define INTEGRATION_H

#include "steppers/integrate.h"

/* Text of --help for --control and --tol where they are left open: the
   defaults of steppers/integrate.h's tables. */
void integration_control_unset(char *text, size_t size);
void integration_tol_unset(char *text, size_t size);

/* Exits with EXIT_USAGE if options are right one by one but do not fit
   together: a method without an error estimate that has no fixed step, a fixed
   step for a method that takes none, or a method that is too expensive for this
   many spheres. */
void integration_check(const struct integrate_options *o, size_t spheres);

/* The reason why a run stopped, by the code of integrate_step. */
const char *integration_error(const struct integrate_options *o, int status);

#endif
