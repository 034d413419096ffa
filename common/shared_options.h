/* Rows of option tables that programs share. */
#ifndef SHARED_OPTIONS_H
#define SHARED_OPTIONS_H

#include <float.h>
#include "integrate.h"
#include "options.h"

/* Integration, into a struct integrate_options o and the travel limit. */
#define INTEGRATION_OPTIONS(o, travel)                                           \
  {"method", OPTION_TEXT, &(o).method, 0,     0,    integrate_methods,           \
   "",       "stepper",   true,        false, NULL, NULL},                       \
      {"control", OPTION_TEXT,    &(o).control, 0,     0,    integrate_controls, \
       "",        "step control", true,         false, NULL, NULL},              \
      {"tol",                                                                    \
       OPTION_DOUBLE,                                                            \
       &(o).tol,                                                                 \
       DBL_MIN,                                                                  \
       OPTION_MANY,                                                              \
       NULL,                                                                     \
       "m/s, m/s^2 (paper) or m/s (standard)",                                   \
       "tolerance",                                                              \
       true,                                                                     \
       false,                                                                    \
       NULL,                                                                     \
       NULL},                                                                    \
      {"abstol",                                                                 \
       OPTION_DOUBLE,                                                            \
       &(o).abstol,                                                              \
       0,                                                                        \
       OPTION_MANY,                                                              \
       NULL,                                                                     \
       "m/s; 0: as --tol",                                                       \
       "absolute tolerance of standard control",                                 \
       true,                                                                     \
       false,                                                                    \
       NULL,                                                                     \
       NULL},                                                                    \
      {"reltol",    OPTION_DOUBLE,                                               \
       &(o).reltol, 0,                                                           \
       OPTION_MANY, NULL,                                                        \
       "",          "relative tolerance of standard control",                    \
       true,        false,                                                       \
       NULL,        NULL},                                                       \
      {"hinit", OPTION_DOUBLE,      &(o).hinit, DBL_MIN, OPTION_MANY, NULL,      \
       "s",     "first trial step", true,       false,   NULL,        NULL},     \
      {"hmax",       OPTION_DOUBLE,  &(o).hmax, 0,     OPTION_MANY, NULL,        \
       "s; 0: none", "longest step", true,      false, NULL,        NULL},       \
      {"step",           OPTION_DOUBLE, &(o).step, 0,     OPTION_MANY, NULL,     \
       "s; 0: adaptive", "fixed step",  true,      false, NULL,        NULL},    \
  {                                                                              \
    "travel", OPTION_DOUBLE, &(travel), 0, OPTION_MANY, NULL,                    \
        "in 1/kappa; 0: no limit", "furthest a sphere may go in a step", true,   \
        false, NULL, NULL                                                        \
  }

#endif
