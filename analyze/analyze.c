/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analyze: measures beds of spheres. The first argument may name a verb. */
#include <string.h>
#include "verbs.h"

#define VERB_ROW(name, what) {#name, verb_##name},

static const struct {
  const char *name;
  int (*run)(int argc, char **argv);
} verbs[] = {VERBS(VERB_ROW)};

int main(int argc, char **argv) {
  if (argc > 1)
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++)
      if (!strcmp(argv[1], verbs[i].name))
        return verbs[i].run(argc - 1, argv + 1);
  return verb_fraction(argc, argv);
}
