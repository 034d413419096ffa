/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Told of how much of a long computation is done, from 0 to 1, so that a
   library need not print. Pure inline functions. */
#ifndef OBSERVER_H
#define OBSERVER_H

#include <stddef.h>

struct observer {
  void (*tell)(void *context, double done);
  void *context;
};

/* done of all; NULL: nobody looks. */
static inline void observer_tell(const struct observer *o, size_t done,
                                 size_t all) {
  if (o)
    o->tell(o->context, (double)done / (double)all);
}

#endif
