/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A state vector has one row per sphere: {x, y, z, vx, vy, vz} and, only where
   the scene has friction and rotation, {wx, wy, wz}. */
#ifndef ROW_H
#define ROW_H

enum {
  ROW_X = 0, /* where each kind of unknown begins */
  ROW_V = 3,
  ROW_W = 6,
  ROW_PLAIN = 6, /* doubles in a row, without spin and with it */
  ROW_SPIN = 9
};

#endif
