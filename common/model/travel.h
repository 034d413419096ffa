/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The time in which a body travels a given distance. Pure, safe in any thread.
   Tested in tests/test_dynamics.c. */
#ifndef TRAVEL_H
#define TRAVEL_H

#include <math.h>

/* Time (s) in which a body of speed v (m/s) that keeps its acceleration a
   (m/s^2) travels at most this far (m); infinite where it does not move. v, a
   >= 0, travel > 0. The root of v t + a t^2/2 = travel, written without a
   difference. */
static inline double travel_time(double v, double a, double travel) {
  return 2 * travel / (v + sqrt(v * v + 2 * a * travel));
}

#endif
