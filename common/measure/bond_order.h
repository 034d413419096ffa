/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bond-orientational order of each point's neighbourhood, from spherical
   harmonics of the directions to its neighbours; not in the paper. Tested in
   tests/test_structure.c. */
#ifndef BOND_ORDER_H
#define BOND_ORDER_H

#include <stddef.h>
#include "geometry/observer.h"

struct bond_order {
  size_t neighbours;
  double q4, q6; /* P. J. Steinhardt, D. R. Nelson, M. Ronchetti, Phys. Rev. B
                    28 (1983) 784 */
  /* of the mean of q_lm over the point and its neighbours: W. Lechner, C.
     Dellago, J. Chem. Phys. 129 (2008) 114707; wbar by the power of the norm
     that makes it independent of qbar, 0 where qbar is 0 */
  double qbar4, qbar6, wbar4, wbar6;
};

/* The order of a neighbourhood. The averages of an ideal lattice are

                qbar4   qbar6   wbar4     wbar6
     fcc        0.1909  0.5745  -0.1593  -0.0132
     hcp        0.0972  0.4848   0.1341  -0.0124
     bcc        0.0364  0.5107   0.1593   0.0132
     sc         0.7638  0.3536   0.1593   0.0132

   (14 neighbours of bcc; W. Mickel et al., J. Chem. Phys. 138 (2013) 044501,
   has more). Random beds stay below a qbar6 of 0.35 or so. A neighbourhood is
   ordered if its qbar6 is at least `least`, and the signs of wbar tell which
   lattice it resembles. */
enum bond_class { BOND_DISORDERED, BOND_FCC, BOND_HCP, BOND_BCC };
enum bond_class bond_order_class(const struct bond_order *o, double least);

/* Neighbours are the points within cutoff (m), and images of points, across
   periodic axes (geometry/periodic.h). x: 3n. A point without any has zeros.
   Returns GSL_SUCCESS, GSL_EINVAL for a coordinate that is not finite,
   GSL_EDOM where two points are one, GSL_ENOMEM. Safe in any thread. */
int bond_order_find(size_t n, const double *x, const double period[3],
                    double cutoff, const struct observer *observer,
                    struct bond_order *order);

#endif
