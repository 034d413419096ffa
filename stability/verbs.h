/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verbs of stability: each a study in a file of its own. argv[0] is the
   verb; returns the program's exit status. */
#ifndef STABILITY_VERBS_H
#define STABILITY_VERBS_H

#include "program/command_line.h"

int verb_limits(int argc, char **argv);
int verb_regions(int argc, char **argv);
int verb_tunnel(int argc, char **argv);
int verb_drift(int argc, char **argv);
int verb_creep(int argc, char **argv);
int verb_cut(int argc, char **argv);
int verb_steps(int argc, char **argv);

/* Parses the options of a verb, which takes no operand, and prints what a file
   of data begins with. */
void verb_begin(const struct program *p, int argc, char **argv);

#endif
