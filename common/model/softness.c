/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/softness.h"

#include <math.h>

/* See the header; fraction times contacts of a sphere, shares, kappa times the
   overlap at the floor. */
static const double fraction_contacts = 0.6 * 5.5, geometric_share = 0.57,
                    floor_overlap = 1.47;

double softness_f0(const struct softness_load *load, double restitution) {
  const double pressure = load->weight / (2 * load->area);
  const double force =
      6 * pressure * load->volume / (fraction_contacts * load->diameter);
  const double at_rest = 0.5 * (1 + restitution * restitution);
  return geometric_share * force / at_rest;
}

double softness_kappa(double overlap) {
  return floor_overlap / overlap;
}

double softness_lmax(double kappa) {
  return 15 / kappa; /* Tab. 4.2: 150 times 0.1 */
}

double softness_vmin(double distance, double time) {
  return 2 * distance / time;
}

double softness_creep(double vmin, double time) {
  return 0.5 * vmin * time;
}

double softness_error(double kappa_radius) {
  return 1.2 / kappa_radius;
}

double softness_creep_error(double radii) {
  return 0.025 * fmin(1, radii / 0.4);
}
