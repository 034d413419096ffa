/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program's command line, by its table of options. Tested in
   tests/test_cli.sh and tests/test_habits.sh. */
#ifndef COMMAND_LINE_H
#define COMMAND_LINE_H

#include "program/help.h"
#include "program/messages.h"
#include "program/options.h"

/* Sets up a program (program_begin) and parses its command line; --help, -h and
   --version print and exit, and so do two that are not listed and must come
   last: --man, the page for man, and --complete, what a shell may complete. A
   mistake exits with EXIT_USAGE. Returns the index of the first operand. */
int options_parse(const struct program *p, int argc, char **argv);

/* The command line that options_parse read, as a shell reads it back, for files
   that say what made them: the program's name without its path, the verb, and
   all words as they were given but options that are silent (options.h). */
const char *command_line(void);

/* The words of a command line in one line of memory of its own, in quotes where
   the shell needs those, and in printable ASCII without a quotation mark (").
   Exits without memory. */
char *command_words(int argc, char *const argv[]);

#endif
