/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of a part of the contacts of another list: of some of its rows, with
   their partners as ghosts, or of those contacts of all rows that are near. Not
   in the paper. Tested in tests/test_subset.c. */
#ifndef CONTACT_SUBSET_H
#define CONTACT_SUBSET_H

#include "dynamics/contact_list.h"

/* Contacts that come nearer than gap (m) within the time h (s) from the state
   y, whose rows are those of the list, ghosts included. Speeds are taken to
   grow by up to 30 % on the way. */
struct contact_reach {
  const double *y;
  double h, gap;
};

/* An empty list for parts of whole, or of its parts. GSL_SUCCESS,
   GSL_ENOMEM. */
int contact_subset_alloc(struct contact_list **out,
                         const struct contact_list *whole);

/* Whether rows i and j come within reach. */
bool contact_subset_within(const struct contact_list *l, size_t i, size_t j,
                           const struct contact_reach *reach);

/* Makes each part a list of count rows of from, ascending, and of those
   contacts of theirs within its reach that are in no part before it; walls that
   are within none are in the last. Partners that are not among the rows, ghosts
   of from too, become ghosts. The partners of from are to be listed.
   GSL_SUCCESS, GSL_ENOMEM. */
int contact_subset_rows(struct contact_list *const part[], size_t parts,
                        const struct contact_list *from, const uint32_t rows[],
                        size_t count, const struct contact_reach reach[]);

/* Gives the contacts of from within reach to near and the others to far, both
   with all rows and ghosts of from. GSL_SUCCESS, GSL_ENOMEM. */
int contact_subset_split(struct contact_list *near, struct contact_list *far,
                         const struct contact_list *from,
                         const struct contact_reach *reach);

#endif
