/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Pairs of spheres close to each other, found with a cell grid for each class
   of sizes in O(n + pairs), whatever sizes are mixed. */
#ifndef NEIGHBORS_H
#define NEIGHBORS_H

#include <stddef.h>
#include <stdint.h>

/* Pair p joins spheres i[p] < j[p]; pairs are sorted by (i, j). Sphere i's
   pairs as the first partner are first[i] <= p < first[i+1]. Zero-initialise;
   neighbors_find grows the arrays and reuses them; the same pairs for any
   number of threads. */
struct neighbors {
  size_t count, size; /* pairs held, pairs there is room for */
  uint32_t *i, *j;    /* count */
  size_t *first;      /* spheres + 1 */
  size_t spheres_size;
  size_t tested;            /* pairs whose distance the search looked at */
  void *scratch;            /* of the cell grids */
  size_t scratch_size;      /* bytes */
  size_t threads;           /* that share large searches; 0: one */
  struct neighbors *helper; /* of the threads beside the first */
  size_t helpers;
};

/* Lists every pair whose gap |x_i - x_j| - r_i - r_j is at most reach (m).
   x: n rows, stride doubles apart, that begin with x, y, z; radius: n.
   Returns GSL_SUCCESS, GSL_EINVAL for a coordinate that is not finite or n
   over 2^32 - 2, GSL_ENOMEM; then the list is empty. One list per thread.
   Tested in tests/test_neighbors.c against all pairs. */
int neighbors_find(struct neighbors *nb, size_t n, const double *x,
                   size_t stride, const double *radius, double reach);

/* The pair list of n spheres turned into each one's partners: sphere i's are
   partner[start[i]] ... partner[start[i+1] - 1], ascending. start: n + 2,
   partner: twice as many as pairs. Returns the most partners of a sphere. */
size_t neighbors_partners(const struct neighbors *nb, size_t n, size_t *start,
                          uint32_t *partner);

void neighbors_free(struct neighbors *nb);

#endif
