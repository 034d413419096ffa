/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes of the work-precision charts, each in a file of its own and with an
   exact or independent reference. The main program runs a scene with one method
   over a ladder of tolerances or steps and prints one row per run. */
#ifndef SCENES_H
#define SCENES_H

#include "steppers/integrate.h"
#include "model/scene.h"

enum { PRECISION_ERRORS = 4 };

/* One run: the scene and how to integrate it. */
struct precision_case {
  const struct integrate_options *integrate;
  struct contact_law law;
  double gravity; /* m/s^2 */
  double travel;  /* m, 0: no limit */
  double time;    /* s */
  double speed;   /* m/s */
  size_t count;   /* spheres */
  size_t seed;
};

struct precision_result {
  double error[PRECISION_ERRORS]; /* as precision_scene.errors names them */
  size_t evaluations, accepted, rejected;
  double cpu_seconds; /* of the integration; 0: main times the whole run */
  double started;     /* by measure_start */
  size_t runs;        /* over which the numbers are means; 0 is one */
  /* One word: "ok", or how it failed; "lost" where an error is as large as
     what is computed. */
  const char *status;
};

struct precision_scene {
  const char *name, *summary;
  /* columns: error_SOMETHING, NULL-terminated */
  const char *errors[PRECISION_ERRORS + 1];
  /* Sets the scene's own defaults, before the command line is read. */
  void (*defaults)(struct precision_case *c);
  /* Computes the reference of the runs into *reference, which run gets and
     free() takes, and its own uncertainty; NULL where there is nothing to
     prepare. */
  int (*prepare)(const struct precision_case *c, void **reference,
                 double reference_error[]);
  /* One run. GSL_SUCCESS also where the method fails: then status says how;
     another code ends the program. */
  int (*run)(const struct precision_case *c, const void *reference,
             struct precision_result *r);
};

extern const struct precision_scene scene_bounce, scene_collision,
    scene_restitution, scene_toda_open, scene_toda_closed, scene_rolling,
    scene_transition, scene_slope, scene_exponential, scene_spring,
    scene_walton_braun, scene_trajectory;
extern const struct precision_scene scene_impacts[8];

#endif
