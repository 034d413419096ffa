/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a run of settle. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include "model/fill.h"
#include "steppers/integrate.h"
#include "program/command_line.h"
#include "program/scene_options.h"

struct settings {
  struct fill fill;
  struct scene scene;
  struct scene_words words;
  struct integrate_options integrate;
  double lid;                   /* m, if given */
  double density;               /* kg/m^3, 0: by fill.mass */
  double overlap, creep;        /* diameters, radii; if given */
  double target;                /* fraction; 0: by friction as given */
  const char *fill_way;         /* of fill_ways, NULL: the first */
  const char *onto;             /* file of the bed below, NULL: none */
  const char *sizes, *shares;   /* NULL: equal spheres; not given */
  struct similarity similarity; /* of the spheres to the paper's */
  double travel, time;
  const char *kernel; /* NULL: the best */
  char *command;      /* words of the command line, for --stats */
  const char *pairs, *scene_file, *stats, *log;
  const char *output;              /* NULL: standard output */
  const char *checkpoint, *resume; /* files, or NULL */
  double every;                    /* between checkpoints, on the wall (s) */
  const char *lammps; /* folder to write the scene to instead of a run */
  size_t frames, threads;
  bool all_pairs; /* by pairs */
  bool until_rest, allow_partial, quiet;
  bool origin; /* in the log */
};

#endif
