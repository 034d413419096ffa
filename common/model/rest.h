/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When a bed is at rest: no surface was faster than vmin, the speed below which
   the model's own friction lets a loaded contact creep, for 0.1 s, the time
   sqrt(r/g) of the paper's sphere, and as much of its own for another
   (similarity.h). This is the criterion of settle --until-rest and of analyze
   rest. Not in the paper. Safe in any thread. Tested in
   tests/test_analyze_structure.sh and tests/test_cli.sh. */
#ifndef REST_H
#define REST_H

#include <stdbool.h>
#include "model/similarity.h"

static const double rest_time = 0.1; /* s, of the paper's sphere */

struct rest_watch {
  double since;  /* seen slow at all times from then on (s) */
  bool moved;    /* has been seen to move at all */
  double wanted; /* how long it has to be slow (s) */
};

static inline struct rest_watch rest_watch_begin(double t,
                                                 const struct similarity *s) {
  return (struct rest_watch){.since = t, .wanted = rest_time * s->time};
}

/* Takes note of the largest speed of any surface at time t, where NaN is
   motion (s, m/s); is the bed at rest? */
static inline bool rest_watch_see(struct rest_watch *w, double t,
                                  double fastest, double vmin) {
  if (!(fastest < vmin)) {
    w->since = t;
    w->moved = true;
  }
  return t - w->since >= w->wanted;
}

#endif
