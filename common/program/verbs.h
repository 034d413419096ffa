/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program whose first argument names what it does. */
#ifndef PROGRAM_VERBS_H
#define PROGRAM_VERBS_H

#include "program/help.h"

/* Runs the verb that argv[1] names, or the function for no verb. `PROGRAM help
   VERB` is the verb's --help. A word that is neither a verb nor a file, but is
   spelled like a verb, exits with EXIT_USAGE. */
int verbs_run(const struct verbs *v, int argc, char **argv);

#endif
