/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The help of a program, its man page and its completion, from the table of its
   options. Each prints to standard output and exits. Tested in
   tests/test_cli.sh and tests/test_install.sh. */
#ifndef HELP_H
#define HELP_H

#include "program/options.h"

struct program {
  const char *name, *summary, *usage, *example;
  struct option_spec *options; /* ends with a NULL name */
};

/* A program whose first argument names what it does (verbs.h). */
struct verb {
  const char *name, *summary;
  /* argv[0] is the verb; returns the exit status. */
  int (*run)(int argc, char **argv);
};

struct verbs {
  const char *program, *summary;
  const struct verb *at;          /* ends with a NULL name */
  int (*otherwise)(int, char **); /* without a verb; or NULL */
};

/* The verbs that the help names, of a program that has some. */
void help_verbs(const struct verbs *v);

_Noreturn void help_print(const struct program *p);
_Noreturn void help_print_version(const struct program *p);
/* For a program that does nothing without a verb: lists its verbs. */
_Noreturn void help_print_verbs(const struct verbs *v);
/* The man page of the program or of its verb, in roff. */
_Noreturn void help_print_man(const struct program *p);
/* Prints the words that a shell completes: for each option a line with
   "--NAME", its kind and its choices, separated by tabs; for a program with
   verbs also their names. */
_Noreturn void help_print_completion(const struct program *p);

#endif
