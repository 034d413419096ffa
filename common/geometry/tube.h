/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volume of a ball within a piece of a cylinder; not in the paper. Lengths in
   m. Safe in any thread. Tested in tests/test_volume.c. */
#ifndef TUBE_H
#define TUBE_H

/* A ball of radius r whose centre is away >= 0 from the axis of a cylinder of
   radius R, between planes across the axis that are low and high from the
   centre (low <= high, infinite for none). An integral over lenses, within
   1e-11 r^3 as a rule and 1e-6 r^3 where the ball all but touches the mantle
   from within. */
double tube_ball_volume(double away, double R, double low, double high,
                        double r);

#endif
