/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Half-spaces {x: n.x <= h} seen from the centre of a ball or disc, and how one
   restricts the boundary of another, for volume.c and area.c. Unit normals n;
   offsets h from the centre (m). Pure inline functions, safe in any thread.
   Tested in tests/test_volume.c and tests/test_area.c. */
#ifndef HALFSPACE_H
#define HALFSPACE_H

#include <stdbool.h>

/* Sines below this are rounding errors of equal normals: unequal ones differ
   by an ulp of a component, and their difference is exact. */
#define HALFSPACE_PARALLEL 1e-28

/* Stands for an offset of 0, in units of the ball's radius or the boundary's
   own offset. On a boundary shadows depend on the way there. Being outside of
   each boundary by an immeasurable distance is one way, and the one that gives
   empty intersections through the centre no faces at all. */
static inline double halfspace_off_zero(double offset, double scale) {
  return offset == 0 ? -1e-30 * scale : offset;
}

/* Half-space b within the boundary of half-space a, in dim dimensions. With
   c = na.nb, returns hb - ha c, which is b's offset from the foot of the origin
   on the boundary times the sine of the angle; the normal there, times the
   sine, is the component of d = nb - sign na along the boundary, sign = +-1
   that of c. */
static inline double halfspace_restricted(int dim, const double *na, double ha,
                                          const double *nb, double hb,
                                          double *d, double *sign) {
  double c = 0, d2 = 0;
  for (int k = 0; k < dim; k++)
    c += na[k] * nb[k];
  *sign = c < 0 ? -1 : 1;
  for (int k = 0; k < dim; k++) {
    d[k] = nb[k] - *sign * na[k];
    d2 += d[k] * d[k];
  }
  return (hb - *sign * ha) + *sign * ha * d2 / 2;
}

/* Whether half-space b leaves nothing of a's boundary when the two are
   parallel. Of equals the first stays. */
static inline bool halfspace_hidden(double ha, double hb, double sign,
                                    bool b_first) {
  if (sign > 0)
    return hb < ha || (hb == ha && b_first);
  return ha + hb < 0;
}

#endif
