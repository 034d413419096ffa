/* What settle was asked to do. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include "fill.h"
#include "integrate.h"
#include "options.h"
#include "scene_options.h"

struct settings {
  struct fill fill;
  struct option_list base;
  struct scene scene;
  struct scene_words words;
  struct integrate_options integrate;
  double travel, time;
  const char *pairs, *scene_file, *stats, *log;
  size_t frames, threads;
  bool until_rest, allow_partial, quiet;
};

#endif
