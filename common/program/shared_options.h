/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of option tables that programs share. */
#ifndef SHARED_OPTIONS_H
#define SHARED_OPTIONS_H

#include <float.h>
#include <stdint.h>
#include "program/command_line.h"

/* clang-format off */

/* A number with a name, where it goes, and its range. */
#define NUMBER(name_, value_, least_, most_, unit_, help_)                     \
  {.name = name_, .type = OPTION_DOUBLE, .value = value_, .least = least_,     \
   .most = most_, .unit = unit_, .help = help_, .parameter = true}
#define POSITIVE(name_, value_, unit_, help_)                                  \
  NUMBER(name_, value_, DBL_MIN, OPTION_MANY, unit_, help_)
/* The same with a dimension {length, time, mass}: the default is the paper's
   sphere's, and settle's follows its own spheres. */
#define SIMILAR(name_, value_, least_, unit_, help_, length_, time_, mass_)    \
  {.name = name_, .type = OPTION_DOUBLE, .value = value_, .least = least_,     \
   .most = OPTION_MANY, .unit = unit_, .help = help_, .parameter = true,       \
   .dimension = {length_, time_, mass_}}

/* Integration, into a struct integrate_options o and the travel limit. */
#define INTEGRATION_OPTIONS(o, travel)                                         \
  {.name = "method", .type = OPTION_TEXT, .value = &(o).method,                \
   OPTION_TABLE(integrate_methods), .help = "stepper", .parameter = true},     \
  {.name = "control", .type = OPTION_TEXT, .value = &(o).control,              \
   OPTION_TABLE(integrate_controls), .help = "step control",                   \
   .parameter = true, .unset = integration_control_unset},                     \
  {.name = "tol", .type = OPTION_DOUBLE, .value = &(o).tol, .least = DBL_MIN,  \
   .most = OPTION_MANY, .unit = "m/s, or m/s^2 for paper control",             \
   .help = "tolerance", .parameter = true, .unset = integration_tol_unset},    \
  NUMBER("abstol", &(o).abstol, 0, OPTION_MANY, "m/s; 0: as --tol",            \
         "absolute tolerance but for paper control"),                          \
  NUMBER("reltol", &(o).reltol, 0, OPTION_MANY, "",                            \
         "relative tolerance but for paper control"),                          \
  SIMILAR("hinit", &(o).hinit, DBL_MIN, "s", "first trial step", 0, 1, 0),     \
  NUMBER("hmax", &(o).hmax, 0, OPTION_MANY, "s; 0: none", "longest step"),     \
  NUMBER("step", &(o).step, 0, OPTION_MANY, "s; 0: adaptive", "fixed step"),   \
  NUMBER("travel", &(travel), 0, OPTION_MANY, "in 1/kappa; 0: no limit",       \
         "furthest a sphere may go in a step")

/* The seed of a random start, a size_t that GSL's generators take. */
#define SEED_OPTION(value_, help_)                                             \
  {.name = "seed", .type = OPTION_SIZE, .value = value_, .most = UINT32_MAX,   \
   .help = help_, .parameter = true}

/* The solver's statistics, and silence. */
#define STATS_OPTION(value_)                                                   \
  {.name = "stats", .type = OPTION_TEXT, .value = &(value_),                   \
   .help = "file for the solver's statistics"}
#define QUIET_OPTION(value_)                                                   \
  {.name = "quiet", .type = OPTION_FLAG, .value = &(value_),                   \
   .help = "no progress", .silent = true}

/* The contact law, but for friction, into a struct contact_law c. */
#define LAW_OPTIONS(c)                                                         \
  NUMBER("restitution", &(c).restitution, 0, 1, "",                            \
         "coefficient of restitution e"),                                      \
  SIMILAR("f0", &(c).f0, DBL_MIN, "N", "repulsion at touch F0", 1, -2, 1),     \
  SIMILAR("kappa", &(c).kappa, DBL_MIN, "1/m", "stiffness exponent", -1, 0,    \
          0),                                                                  \
  SIMILAR("psi", &(c).psi, DBL_MIN, "s/m", "dissipation focusing", -1, 1, 0)

/* A scene, into a struct scene s and a struct scene_words w; scene_finish
   completes it. */
#define SCENE_OPTIONS(s, w)                                                    \
  {.name = "model", .type = OPTION_TEXT, .value = &(w).model,                  \
   OPTION_TABLE(scene_models), .help = "variant", .parameter = true},          \
  LAW_OPTIONS((s).law),                                                        \
  NUMBER("friction", &(s).law.friction, 0, OPTION_MANY, "",                    \
         "friction coefficient phi"),                                          \
  {.name = "rolling", .type = OPTION_DOUBLE, .value = &(s).law.rolling,        \
   .most = OPTION_MANY, .help = "coefficient of rolling resistance",           \
   .parameter = true, .optional = true},                                       \
  {.name = "lever", .type = OPTION_TEXT, .value = &(w).lever,                  \
   OPTION_TABLE(scene_levers), .help = "lever arms of friction",               \
   .parameter = true, .optional = true, .unset = scene_lever_unset},           \
  {.name = "periodic", .type = OPTION_TEXT, .value = &(w).periodic,            \
   .choices = scene_periodic, .unset = scene_no_periodic,                      \
   .help = "sides of the base that are periodic instead of walls",             \
   .parameter = true, .optional = true},                                       \
  SIMILAR("vmin", &(s).law.vmin, DBL_MIN, "m/s",                               \
          "slip speed of full friction", 1, -1, 0),                            \
  SIMILAR("lmax", &(s).law.lmax, DBL_MIN, "m",                                 \
          "gap beyond which contacts are skipped", 1, 0, 0),                   \
  {.name = "gravity", .type = OPTION_LIST, .value = &(w).gravity,              \
   .least = 1, .most = 3, .unit = "m/s^2, downwards, or gx,gy,gz",             \
   .help = "gravity", .parameter = true},                                      \
  {.name = "wall", .type = OPTION_LIST, .least = 6, .most = 6,                 \
   .unit = "px,py,pz,nx,ny,nz with a normal of positive length",               \
   .help = "plane by a point and outward normal, repeatable; replaces "        \
           "the box",                                                          \
   .parameter = true, .each = scene_wall_option, .context = &(s)},             \
  {.name = "cylinder", .type = OPTION_LIST, .least = 7, .most = 7,             \
   .unit = "px,py,pz,ax,ay,az,R with an axis and R of positive length",        \
   .help = "inside of a cylinder, repeatable; replaces the box's walls along " \
           "its axis",                                                         \
   .parameter = true, .each = scene_cylinder_option, .context = &(s)}

/* clang-format on */

#endif
