/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stability: where methods fail. The first argument names a study. */
#include <stdio.h>
#include "verbs.h"
#include "dynamics/dynamics.h"
#include "program/origin.h"
#include "program/verbs.h"

static const struct verb table[] = {
    {"limits", "largest stable step of each method on two contacts",
     verb_limits},
    {"regions", "the methods' stability functions in the complex plane",
     verb_regions},
    {"tunnel", "fast spheres out of free flight: who misses a contact",
     verb_tunnel},
    {"drift", "energy over a thousand bounces, or in a closed box", verb_drift},
    {"creep", "what friction lets creep below the friction angle", verb_creep},
    {"cut", "the floor that the cut at lmax puts under the accuracy", verb_cut},
    {"steps", "how many steps each sphere of a bed takes while it falls",
     verb_steps},
    {NULL, NULL, NULL}};

void verb_begin(const struct program *p, int argc, char **argv) {
  char text[256];
  const int operand = options_parse(p, argc, argv);
  if (operand < argc)
    die(EXIT_USAGE, "'%s': expected options only", argv[operand]);
  origin_write(stdout, &origin_comment, command_line(), NULL);
  origin_put(stdout, &origin_comment, "kernel", dynamics_machine());
  printf("# verb=%s\n", argv[0]);
  for (const struct option_spec *o = p->options; o->name; o++) {
    option_text(o, text, sizeof text);
    printf("# %s=%s\n", o->name, text);
  }
}

int main(int argc, char **argv) {
  const struct verbs verbs = {.program = "stability",
                              .summary = "Where methods fail, a verb a study.",
                              .at = table};
  const int code = verbs_run(&verbs, argc, argv);
  finish_output();
  return code;
}
