/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/allpairs.h"

#include <math.h>

/* How the two of a contact turn; a wall has no radius and does not. */
struct turning {
  double ri, rj, reduced;     /* m */
  const double *spin, *other; /* rad/s */
};
static const double no_spin[3];

/* Adds what the contact does to the sphere: force, and n x friction force by
   the arm in radii. */
static void add_contact(const struct contact_law *law,
                        const struct contact_features has, const double n[3],
                        double gap, const double w[3], const struct turning *q,
                        double force[3], double torque[3]) {
  if (gap > law->lmax)
    return;
  double s[3] = {0}, t[3], f[3], nxf[3];
  if (has.rotation) {
    vec3_axpy(contact_arm(law, q->ri, gap), q->spin, s);
    vec3_axpy(contact_arm(law, q->rj, gap), q->other, s);
  }
  const double rate = contact_tangent(n, w, s, t);
  vec3_axpy(contact_normal(law, gap, rate), n, force);
  if (!has.friction)
    return;
  contact_friction(law, gap, t, f);
  vec3_axpy(1, f, force);
  if (!has.rotation)
    return;
  vec3_cross(n, f, nxf);
  vec3_axpy(contact_arm(law, q->ri, gap) / q->ri, nxf, torque);
  if (!has.rolling)
    return;
  double rolls[3], roll[3];
  vec3_sub(q->spin, q->other, rolls);
  contact_roll(law, gap, q->reduced, n, rolls, roll);
  vec3_axpy(-1 / q->ri, roll, torque);
}

bool allpairs_rates(const struct contact_list *list, const double *y,
                    double *dydt, size_t from, size_t to) {
  const size_t stride = list->stride;
  const bool spin = list->has.rotation;
  double checksum = 0;
  for (size_t i = from; i < to; i++) {
    const double *p = y + i * stride;
    const double ri = list->radius[i];
    double force[3] = {0}, torque[3] = {0};
    for (size_t j = 0; j < list->rows; j++) {
      if (j == i)
        continue;
      const double *q = y + j * stride;
      const double rj = list->radius[j];
      double u[3], w[3];
      vec3_sub(p, q, u);
      periodic_nearest(list->period, u);
      const double d = vec3_norm(u);
      if (d - ri - rj > list->law.lmax)
        continue;
      for (int c = 0; c < 3; c++)
        u[c] /= d;
      vec3_sub(p + ROW_V, q + ROW_V, w);
      const struct turning turning = {ri, rj, contact_reduced(ri, rj),
                                      spin ? p + ROW_W : no_spin,
                                      spin ? q + ROW_W : no_spin};
      add_contact(&list->law, list->has, u, d - ri - rj, w, &turning, force,
                  torque);
    }
    for (size_t m = 0; m < list->walls_count; m++) {
      const struct wall *wall = &list->walls[m];
      const struct turning turning = {ri, 0, ri, spin ? p + ROW_W : no_spin,
                                      no_spin};
      double normal[3];
      const double distance = wall_nearest(wall, p, normal);
      for (int c = 0; c < 3; c++)
        normal[c] = -normal[c];
      add_contact(&list->law, list->has, normal, distance - ri, p + ROW_V,
                  &turning, force, torque);
    }
    double *rate = dydt + i * stride;
    for (int c = 0; c < 3; c++) {
      rate[c] = p[ROW_V + c];
      rate[ROW_V + c] = list->gravity[c] + force[c] / list->mass[i];
      checksum += rate[c] + rate[ROW_V + c] + 0 * p[c];
    }
    if (spin)
      for (int c = 0; c < 3; c++) {
        rate[ROW_W + c] = -2.5 * torque[c] / (list->mass[i] * ri);
        checksum += rate[ROW_W + c] + 0 * p[ROW_W + c]; /* free spins too */
      }
  }
  return isfinite(checksum);
}
