/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "dynamics/scale.h"

#include "model/similarity.h"

void contact_list_scale(const struct contact_list *l, double scale[]) {
  const double g = vec3_norm(l->gravity);
  for (size_t i = 0; i < l->rows; i++) {
    const struct similarity s = similarity_of(l->radius[i], 1, g);
    const double speed = s.length / s.time;
    for (size_t c = 0; c < l->stride; c++)
      scale[i * l->stride + c] = c < ROW_V   ? 1 / (l->law.kappa * speed)
                                 : c < ROW_W ? 1
                                             : 1 / l->radius[i];
  }
}
