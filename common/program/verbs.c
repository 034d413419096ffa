/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/verbs.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "program/help.h"
#include "program/begin.h"
#include "program/messages.h"
#include "program/suggest.h"

enum { MOST_VERBS = 32 };

static const struct verb *find(const struct verbs *v, const char *name) {
  for (const struct verb *k = v->at; k->name; k++)
    if (!strcmp(k->name, name))
      return k;
  return NULL;
}

/* The one that may have been meant. */
static const char *nearest(const struct verbs *v, const char *word) {
  const char *names[MOST_VERBS];
  size_t count = 0;
  for (const struct verb *k = v->at; k->name && count < MOST_VERBS; k++)
    names[count++] = k->name;
  return suggest(word, names, count);
}

static _Noreturn void no_verb(const struct verbs *v, const char *word,
                              const char *expected) {
  const char *meant = nearest(v, word);
  die(EXIT_USAGE, "'%s': expected %s%s%s%s", word, expected,
      meant ? "; did you mean " : "", meant ? meant : "", meant ? "?" : "");
}

static int run(const struct verbs *v, const struct verb *verb, int argc,
               char **argv) {
  program_begin(v->program, verb->name);
  return verb->run(argc, argv);
}

int verbs_run(const struct verbs *v, int argc, char **argv) {
  const char *word = argc > 1 ? argv[1] : "";
  program_begin(v->program, NULL);
  help_verbs(v);
  if (!strcmp(word, "help")) {
    const struct verb *verb = argc > 2 ? find(v, argv[2]) : NULL;
    if (argc > 2 && !verb)
      no_verb(v, argv[2], "a verb");
    char *arguments[] = {verb ? argv[2] : argv[0], (char[]){"--help"}, NULL};
    if (verb)
      return run(v, verb, 2, arguments);
    if (v->otherwise)
      return v->otherwise(2, arguments);
    help_print_verbs(v);
  }
  const struct verb *verb = find(v, word);
  if (verb)
    return run(v, verb, argc - 1, argv + 1);
  if (v->otherwise) {
    if (*word && *word != '-' && access(word, F_OK) != 0 && nearest(v, word))
      no_verb(v, word, "a verb or a file");
    return v->otherwise(argc, argv);
  }
  if (!strcmp(word, "--help") || !strcmp(word, "-h"))
    help_print_verbs(v);
  no_verb(v, word, "a verb");
}
