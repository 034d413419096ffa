/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analyze: measures beds of spheres. The first argument may name a verb. */
#include <stddef.h>
#include "program/verbs.h"
#include "verbs.h"

#define VERB_ROW(name, what) {#name, what, verb_##name},

static const struct verb table[] = {VERBS(VERB_ROW){NULL, NULL, NULL}};

int main(int argc, char **argv) {
  const struct verbs verbs = {
      .program = "analyze",
      .summary = "measures beds of spheres, and writes them for others",
      .at = table,
      .otherwise = verb_fraction};
  return verbs_run(&verbs, argc, argv);
}
