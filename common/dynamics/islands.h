/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Groups of marked rows of a contact list that act on each other, directly or
   through other marked rows. Not in the paper. Tested in
   tests/test_subset.c. */
#ifndef ISLANDS_H
#define ISLANDS_H

#include "dynamics/contact_subset.h"

/* Island k has the rows row[q], begin[k] <= q < begin[k + 1], ascending; the
   islands are in the order of their first rows. Zero-initialise. */
struct islands {
  size_t count, *begin;
  uint32_t *row;
  bool *seen;
  size_t room; /* rows that there is room for */
};

/* Finds the islands of the marked rows of l, between which there is no contact
   within reach; may list l's partners. GSL_SUCCESS, GSL_ENOMEM. */
int islands_find(struct islands *s, struct contact_list *l, const bool marked[],
                 const struct contact_reach *reach);
void islands_free(struct islands *s);

#endif
