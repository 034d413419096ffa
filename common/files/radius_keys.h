/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header's keys of a bed whose radius is not that of its dynamics: radius,
   what the dynamics had (radius_dynamics) and why (radius_keep). How such a
   radius is chosen: measure/radius.h. Safe in any thread. Tested in
   tests/test_radius.c. */
#ifndef RADIUS_KEYS_H
#define RADIUS_KEYS_H

#include "files/bed_io.h"

/* Gives all spheres of a bed the radius r (m) and notes that in its header's
   keys. why NULL: the dynamics' radius is back, and neither of the other two
   keys is needed. GSL_ENOMEM, which leaves the bed as it was. */
int radius_rewrite(struct bed *b, struct bed_header *h, double r,
                   const char *why);

/* The radius of the dynamics (m), if the bed was rewritten. 0: it was not;
   negative: the key holds something else than a number above 0. */
double radius_dynamics(const struct bed_header *h);

#endif
