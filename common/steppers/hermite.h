/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cubic Hermite interpolation over a step. Pure, safe in any thread. Tested in
   tests/test_integrate.c. */
#ifndef HERMITE_H
#define HERMITE_H

/* At the share s of a step of length h: 1 - end of the value at the start, end
   of that at the end, and end_slope and start_slope of the slopes. */
struct hermite {
  double end, start_slope, end_slope;
};

static inline struct hermite hermite_at(double s, double h) {
  return (struct hermite){.end = s * s * (3 - 2 * s),
                          .start_slope = h * s * (1 - s) * (1 - s),
                          .end_slope = -h * s * s * (1 - s)};
}

/* y0, y1: values, f0, f1: slopes, at start and end. */
static inline double hermite_value(const struct hermite *w, double y0,
                                   double f0, double y1, double f1) {
  return y0 + w->end * (y1 - y0) + w->start_slope * f0 + w->end_slope * f1;
}

#endif
