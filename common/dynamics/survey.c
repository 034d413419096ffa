/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/survey.h"

#include <math.h>
#include <gsl/gsl_math.h>
#include "dynamics/contact_list.h"

/* Adds a contact of gap l, with a radius to measure its overlap by. */
static void add_contact(const struct contact_law *law, double l, double radius,
                        size_t row, struct survey *s) {
  if (!(l <= law->lmax))
    return;
  s->contacts++;
  s->stored += contact_energy(law, l);
  if (-l > s->overlap * radius) {
    s->overlap = -l / radius;
    s->sphere = row;
  }
}

void survey_take(const struct contact_list *list, const double y[],
                 struct survey *s) {
  const size_t stride = list->stride;
  *s = (struct survey){.inside = GSL_POSINF};
  const double g = vec3_norm(list->gravity);
  double mass = 0, lowest = GSL_POSINF; /* kg, J/kg */
  for (size_t i = 0; i < list->moving; i++) {
    const double potential = -vec3_dot(list->gravity, y + i * stride);
    s->gravity += list->mass[i] * potential;
    mass += list->mass[i];
    lowest = GSL_MIN(lowest, potential - g * list->radius[i]);
  }
  s->height = s->gravity - mass * lowest;
  for (size_t p = 0; p < list->near.count; p++) {
    const size_t i = list->near.i[p], j = list->near.j[p];
    double u[3];
    vec3_sub(y + i * stride, y + j * stride, u);
    periodic_nearest(list->period, u);
    const double ri = list->radius[i], rj = list->radius[j];
    const double squared = vec3_dot(u, u), reach = ri + rj + list->law.lmax;
    if (squared <= (1 + 1e-9) * reach * reach) /* two fifths are further */
      add_contact(&list->law, sqrt(squared) - ri - rj, GSL_MIN(ri, rj), i, s);
  }
  for (size_t p = 0; p < list->wall_contacts; p++) {
    const size_t i = list->wall_row[p], m = list->wall_id[p];
    const double d = wall_distance(&list->walls[m], y + i * stride);
    add_contact(&list->law, d - list->radius[i], list->radius[i], i, s);
    if (d < s->inside) {
      s->inside = d;
      s->outsider = i;
      s->wall = m;
    }
  }
  s->sphere = list->order[s->sphere]; /* rows so far */
  s->outsider = list->order[s->outsider];
}
