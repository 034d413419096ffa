/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A bed of several sizes, class by class: shares, heights, segregation and
   contacts. Not in the paper. Safe in any thread. Tested in
   tests/test_mixture.c. */
#ifndef MIXTURE_H
#define MIXTURE_H

#include "measure/network.h"

/* The most classes; and their number without edges given: a class for each
   radius if these are no more than MIXTURE_MOST, else MIXTURE_PARTS of equal
   volume. */
enum { MIXTURE_MOST = 9, MIXTURE_PARTS = 4 };

struct mixture_class {
  double low, high;         /* its radii: low <= r < high (m) */
  size_t spheres;           /* that are looked at */
  double radius;            /* their mean (m) */
  double share;             /* of the volume of all of them */
  double height;            /* mean z of their centres, weighed by volume (m) */
  double segregation;       /* see mixture_measure */
  double z, z_own, z_walls; /* contacts of a sphere: all, within the class, with
                               walls */
};

struct mixture {
  size_t count;
  struct mixture_class at[MIXTURE_MOST];
};

/* Classes between ascending edges (m): one more than there are edges, at most
   MIXTURE_MOST, the first from 0, the last without an end. */
struct mixture mixture_of_edges(size_t edges, const double edge[]);
/* Classes by the radii themselves, as above. GSL_SUCCESS, GSL_ENOMEM. */
int mixture_of_radii(const struct bed *b, struct mixture *m);

size_t mixture_find(const struct mixture *m, double radius);

/* Fills in the classes from the spheres with inside[i], or all for NULL, and,
   unless w is NULL, the contacts that count. The segregation of a class is
     (z_class - z_all) / ((1 - share) sqrt(3) s),
   with heights and their standard deviation s weighed by volume. In a column of
   even density s is its height over sqrt(12), so this is 1 where the whole
   class lies on all others, -1 where it lies below, 0 where it is mixed; NaN
   for a class without spheres or without others. */
void mixture_measure(struct mixture *m, const struct bed *b, const bool *inside,
                     const struct network *w);

#endif
