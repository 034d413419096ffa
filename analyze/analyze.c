/* analyze: measures beds of spheres. The first argument may name a verb. */
#include <string.h>
#include "verbs.h"

static const struct {
  const char *name;
  int (*run)(int argc, char **argv);
} verbs[] = {{"fraction", verb_fraction},
             {"profile", verb_profile},
             {"radius", verb_radius}};

int main(int argc, char **argv) {
  if (argc > 1)
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++)
      if (!strcmp(argv[1], verbs[i].name))
        return verbs[i].run(argc - 1, argv + 1);
  return verb_fraction(argc, argv);
}
