/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The hot loop: contact forces of a list of contacts, added up by sphere. The
   same source, kernel.c, is compiled for several instruction sets;
   kernel_select gives one that this machine has. Internal to rates.c.

   A pair is evaluated once and added to both its spheres, in the order of the
   list: first what a sphere gets as second partner, then as first, then from
   walls. That order does not depend on who computes it, so a range of rows can
   be given to a thread together with every pair that touches it, and the sums
   have the same bits for any number of threads. */
#ifndef KERNEL_H
#define KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "dynamics/contact_list.h"

struct kernel {
  const char *name; /* of the instruction set */
  /* Adds count pairs to the sums of those partners that are in the part. */
  void (*add_pairs)(const struct contact_list *list, const double *y,
                    const uint32_t *i, const uint32_t *j, size_t count,
                    const struct contact_part *part);
  /* Adds the contacts of rows [from, to) with walls. */
  void (*add_walls)(const struct contact_list *list, const double *y,
                    size_t from, size_t to, const struct contact_part *part);
  /* Turns the sums of rows [from, to) into rates, the first at rates[0], and
     zeroes them; false if not all rates are finite. */
  bool (*finish)(const struct contact_list *list, const double *y,
                 double *rates, size_t from, size_t to,
                 const struct contact_part *part);
};

/* The kernels of this build, the least first, and NULL. */
extern const char *const kernel_names[];

/* The one of that name, NULL: the best that this machine has. NULL if this
   machine does not have it. DEM_ISA, in the environment, asks for less in place
   of the best: for tests. */
const struct kernel *kernel_select(const char *name);

#endif
