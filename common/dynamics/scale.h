/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Units of the errors of a list's unknowns, per m/s of tolerance
   (dynamics_scale). Tested in tests/test_similarity.c. */
#ifndef SCALE_H
#define SCALE_H

#include "dynamics/contact_list.h"

/* rows * stride numbers. */
void contact_list_scale(const struct contact_list *l, double scale[]);

#endif
