/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options --overlap and --creep of settle: softness and creep as choices
   (model/softness.h). Tested in tests/test_softness.sh. */
#ifndef SOFT_H
#define SOFT_H

#include "files/bed_io.h"
#include "settings.h"

/* Gives the scene of a bed, at its start, the kappa, F0 and lmax or the vmin
   that the options ask for, and says the cost; exits with a message where they
   cannot be had. h: the header of the scene's file, of a start one without
   keys. */
void soft_take(struct settings *s, struct option_spec *options,
               const struct bed *b, const struct bed_header *h);

#endif
