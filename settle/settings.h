/* What settle was asked to do. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include "fill.h"
#include "integrate.h"
#include "options.h"
#include "scene.h"

struct settings {
  struct fill fill;
  struct option_list base, gravity;
  struct scene scene;
  struct integrate_options integrate;
  double travel, time;
  const char *model, *pairs, *scene_file, *stats, *log;
  size_t frames, threads;
  bool until_rest, allow_partial, quiet;
};

#endif
