/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "model/similarity.h"

#include <assert.h>
#include <math.h>
#include <gsl/gsl_math.h>

/* The paper's sphere, Tab. 4.2: m, kg, m/s^2. */
static const double paper_radius = 0.1, paper_mass = 1, paper_gravity = 9.81;

struct similarity similarity_of(double radius, double mass, double gravity) {
  assert(radius > 0 && mass > 0 && gravity >= 0);
  const double length = radius / paper_radius;
  const double g = gravity > 0 ? gravity / paper_gravity : 1;
  return (struct similarity){.length = length,
                             .time = sqrt(length / g),
                             .mass = mass / paper_mass,
                             .squared_time = length / g};
}

double similarity_scale(const struct similarity *s, struct dimension d) {
  return gsl_pow_int(s->length, d.length) *
         gsl_pow_int(s->squared_time, d.time / 2) *
         gsl_pow_int(s->time, d.time % 2) * gsl_pow_int(s->mass, d.mass);
}
