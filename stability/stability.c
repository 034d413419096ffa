/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stability: where methods fail. The first argument names a study. */
#include <stdio.h>
#include <string.h>
#include "verbs.h"
#include "program/version.h"

static const struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} verbs[] = {
    {"limits", "largest stable step of each method on two contacts",
     verb_limits},
    {"regions", "the methods' stability functions in the complex plane",
     verb_regions},
    {"tunnel", "fast spheres out of free flight: who misses a contact",
     verb_tunnel},
    {"drift", "energy over a thousand bounces, or in a closed box", verb_drift},
    {"creep", "what friction lets creep below the friction angle", verb_creep},
    {"cut", "the floor that the cut at lmax puts under the accuracy",
     verb_cut}};

enum { VERBS = sizeof verbs / sizeof *verbs };

void verb_begin(const struct program *p, int argc, char **argv) {
  char text[256];
  const int operand = options_parse(p, argc, argv);
  if (operand < argc)
    die(EXIT_USAGE, "'%s': expected options only", argv[operand]);
  printf("# program=stability\n# version=%s\n# verb=%s\n", DEM_VERSION,
         argv[0]);
  for (const struct option_spec *o = p->options; o->name; o++) {
    option_text(o, text, sizeof text);
    printf("# %s=%s\n", o->name, text);
  }
}

int main(int argc, char **argv) {
  for (size_t i = 0; argc > 1 && i < VERBS; i++)
    if (!strcmp(argv[1], verbs[i].name)) {
      const int code = verbs[i].run(argc - 1, argv + 1);
      finish_output();
      return code;
    }
  const bool help = argc > 1 && !strcmp(argv[1], "--help");
  FILE *out = help ? stdout : stderr;
  fputs("usage: stability VERB [OPTION...]; --help after a verb tells more\n",
        out);
  for (size_t i = 0; i < VERBS; i++)
    fprintf(out, "  %-8s %s\n", verbs[i].name, verbs[i].summary);
  if (help)
    finish_output();
  return help ? EXIT_DONE : EXIT_USAGE;
}
