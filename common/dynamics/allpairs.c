/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/allpairs.h"

#include <math.h>

/* Adds what the contact does to the sphere: force and n x friction force. */
static void add_contact(const struct contact_law *law,
                        const struct kernel_features has, const double n[3],
                        double gap, const double w[3], const double s[3],
                        double force[3], double torque[3]) {
  if (gap > law->lmax)
    return;
  double t[3], f[3], nxf[3];
  const double rate = contact_tangent(n, w, s, t);
  vec3_axpy(contact_normal(law, gap, rate), n, force);
  if (!has.friction)
    return;
  contact_friction(law, gap, t, f);
  vec3_axpy(1, f, force);
  if (!has.rotation)
    return;
  vec3_cross(n, f, nxf);
  vec3_axpy(1, nxf, torque);
}

bool allpairs_rates(const struct kernel_data *k, size_t walls, size_t n,
                    const double *y, double *dydt, size_t from, size_t to) {
  const size_t stride = k->stride;
  const bool spin = k->has.rotation;
  double checksum = 0;
  for (size_t i = from; i < to; i++) {
    const double *p = y + i * stride;
    const double ri = k->radius[i];
    double force[3] = {0}, torque[3] = {0};
    for (size_t j = 0; j < n; j++) {
      if (j == i)
        continue;
      const double *q = y + j * stride;
      const double rj = k->radius[j];
      double u[3], w[3], s[3] = {0};
      vec3_sub(p, q, u);
      const double d = vec3_norm(u);
      if (d - ri - rj > k->law.lmax)
        continue;
      for (int c = 0; c < 3; c++)
        u[c] /= d;
      vec3_sub(p + 3, q + 3, w);
      if (spin) {
        vec3_axpy(ri, p + 6, s);
        vec3_axpy(rj, q + 6, s);
      }
      add_contact(&k->law, k->has, u, d - ri - rj, w, s, force, torque);
    }
    for (size_t m = 0; m < walls; m++) {
      const struct wall *wall = &k->walls[m];
      double normal[3], s[3] = {0};
      for (int c = 0; c < 3; c++)
        normal[c] = -wall->normal[c];
      if (spin)
        vec3_axpy(ri, p + 6, s);
      add_contact(&k->law, k->has, normal, wall_distance(wall, p) - ri, p + 3,
                  s, force, torque);
    }
    double *rate = dydt + i * stride;
    for (int c = 0; c < 3; c++) {
      rate[c] = p[3 + c];
      rate[3 + c] = k->gravity[c] + force[c] / k->mass[i];
      checksum += rate[c] + rate[3 + c] + 0 * p[c];
    }
    if (spin)
      for (int c = 0; c < 3; c++) {
        rate[6 + c] = -2.5 * torque[c] / (k->mass[i] * ri);
        checksum += rate[6 + c] + 0 * p[6 + c]; /* free spins too */
      }
  }
  return isfinite(checksum);
}
