/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pair correlation g(r) of points in a region, with the edge correction exact;
   not in the paper. Tested in tests/test_structure.c. */
#ifndef CORRELATION_H
#define CORRELATION_H

#include <stddef.h>
#include "geometry/observer.h"
#include "geometry/region.h"

/* For bins of equal width from 0 to rmax (m): pairs[k], the number of
   pairs of points at a distance in [k, k + 1) rmax/bins, and expected[k], the
   number that there would be were each point's partners strewn evenly over the
   region: half of (n-1)/V times the sum, over the points, of the volume of the
   bin's shell around each that lies within the region. g = pairs/expected; for
   independent random points its mean is 1 in every bin. Across periodic axes
   all images are partners, however many lie within rmax, but no point is a
   partner of its own images, which are there for certain. x: 3n, all within the
   region. Returns GSL_SUCCESS, GSL_EINVAL for a coordinate that is not finite,
   GSL_ENOMEM. Safe in any thread. */
int correlation_count(size_t n, const double *x, const struct region *region,
                      double rmax, size_t bins, const struct observer *observer,
                      double *pairs, double *expected);

#endif
