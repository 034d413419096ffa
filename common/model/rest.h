/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When a bed is at rest: it hardly moves now, and it hardly settles any more.

   - For 10 sqrt(r/g) the mean kinetic energy of a sphere, spin included, was
     below 5e-5 m g r, that of 0.01 sqrt(g r), the paper's vmin. In such a time
     a sphere that nothing carries gains 50 m g r, so the contacts carry them
     all.
   - Within the last 50 sqrt(r/g) the bed lost less than 0.5 % of the energy
     that it has from the height of its centre over its lowest point. That is
     the energy of gravity and of contacts together: in a bed that was just
     made the contacts relax while the centre rises.

   Speeds alone do not tell: contacts with friction creep (2.8), so a bed goes
   on flowing for long, slowly and evenly, with an avalanche now and then. For
   the paper's sphere the times are 1 s and 5 s. Beds of 200 that this calls at
   rest have the fraction that they have at 40 s within 0.002 on average and
   0.004 in four of five seeds, with kappa r = 15 and 60 (docs/analysis.md). The
   criterion of settle --until-rest and of analyze rest. Not in the paper. Safe
   in any thread. Tested in tests/test_rest.c. */
#ifndef REST_H
#define REST_H

#include <stdbool.h>
#include <stddef.h>
#include "model/similarity.h"

enum { REST_SAMPLES = 10 }; /* of the energy, in the time of settling */

struct rest_watch {
  double quiet, settling; /* the two times (s) */
  double kinetic_limit;   /* J, of one sphere */
  double start;           /* what is seen begins here (s) */
  double since;           /* has been quiet from then on (s) */
  bool moved;             /* has not been quiet at some time */
  /* A ring of the energy: times (s) and values (J), count of them so far. */
  double t[REST_SAMPLES + 1], energy[REST_SAMPLES + 1];
  size_t count;
  double loss; /* share of the energy lost in the time of settling, or NaN */
};

/* From time t on, for spheres of that similarity to the paper's. */
struct rest_watch rest_watch_begin(double t, const struct similarity *s);

/* Takes note of the mean kinetic energy of a sphere at time t (s, J), where NaN
   is motion. Is a sample of the energy wanted? */
bool rest_watch_see(struct rest_watch *w, double t, double kinetic);

/* Takes the sample for the time t that was seen last: the energy of gravity and
   of contacts, and that of the centre's height over the lowest point, which is
   0 without gravity (J). */
void rest_watch_sample(struct rest_watch *w, double t, double energy,
                       double height_energy);

/* Both conditions hold, as of time t. */
bool rest_watch_rests(const struct rest_watch *w, double t);

/* The largest share that may be lost. */
double rest_watch_limit(void);

#endif
