/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/survey.h"

#include <math.h>
#include <gsl/gsl_math.h>

/* Adds a contact of gap l, with a radius to measure its overlap by. */
static void add_contact(const struct contact_law *law, double l, double radius,
                        size_t row, struct dynamics_survey *s) {
  if (!(l <= law->lmax))
    return;
  s->contacts++;
  s->stored += contact_energy(law, l);
  if (-l > s->overlap * radius) {
    s->overlap = -l / radius;
    s->sphere = row;
  }
}

void survey_take(const struct kernel_data *k, size_t n, const double *y,
                 struct dynamics_survey *s) {
  const size_t stride = k->stride;
  *s = (struct dynamics_survey){.inside = GSL_POSINF};
  for (size_t i = 0; i < n; i++)
    s->gravity -= k->mass[i] * vec3_dot(k->gravity, y + i * stride);
  for (size_t p = 0; p < k->pairs; p++) {
    const size_t i = k->i[p], j = k->j[p];
    double u[3];
    vec3_sub(y + i * stride, y + j * stride, u);
    const double ri = k->radius[i], rj = k->radius[j];
    const double squared = vec3_dot(u, u), reach = ri + rj + k->law.lmax;
    if (squared <= (1 + 1e-9) * reach * reach) /* two fifths are further */
      add_contact(&k->law, sqrt(squared) - ri - rj, GSL_MIN(ri, rj), i, s);
  }
  for (size_t p = 0; p < k->wall_contacts; p++) {
    const size_t i = k->wall_sphere[p], m = k->wall_id[p];
    const double d = wall_distance(&k->walls[m], y + i * stride);
    add_contact(&k->law, d - k->radius[i], k->radius[i], i, s);
    if (d < s->inside) {
      s->inside = d;
      s->outsider = i;
      s->wall = m;
    }
  }
}
