/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/base_box.h"

#include <string.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"

void base_faces(const struct scene *s, double box[6], bool walled[6]) {
  memset(walled, 0, 6 * sizeof *walled);
  for (size_t i = 0; i < s->walls_count; i++) {
    const struct wall *w = &s->walls[i];
    for (int k = 0; k < 3; k++)
      if (!(w->radius > 0) && w->normal[k] != 0 &&
          w->normal[(k + 1) % 3] == 0 && w->normal[(k + 2) % 3] == 0) {
        const int face = 2 * k + (w->normal[k] > 0);
        box[face] = w->point[k];
        walled[face] = true;
      }
  }
}

bool base_box(const struct scene *s, double box[6]) {
  double faces[6] = {0};
  bool sided[6];
  base_faces(s, faces, sided);
  for (int k = 0; k < 2; k++)
    if (s->period[k] > 0) {
      faces[2 * k] = 0;
      faces[2 * k + 1] = s->period[k];
      sided[2 * k] = sided[2 * k + 1] = true;
    }
  for (size_t i = 0; i < s->walls_count; i++) {
    const struct wall *w = &s->walls[i];
    if (!(w->radius > 0) || w->normal[0] != 0 || w->normal[1] != 0)
      continue;
    for (int face = 0; face < 4; face++)
      if (!sided[face]) {
        faces[face] =
            w->point[face / 2] + (face % 2 ? 1 : -1) * w->radius * M_SQRT1_2;
        sided[face] = true;
      }
  }
  faces[5] = faces[4] + GSL_MIN(faces[1] - faces[0], faces[3] - faces[2]);
  for (int face = 0; face < 5; face++)
    if (!sided[face])
      return false;
  if (!box_valid(faces))
    return false;
  memcpy(box, faces, sizeof faces);
  return true;
}
