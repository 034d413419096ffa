/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/rest.h"

#include <gsl/gsl_math.h>

/* Of the paper's sphere, for which sqrt(r/g) is 0.1 s: the times (s), the speed
   whose energy is that of a quiet sphere (m/s). */
static const double quiet_time = 1, settling_time = 5, quiet_speed = 0.01;

/* Measured, seeds 1 to 5 of the paper's bed and of one with kappa r = 60 until
   rest: the fraction differs from that at 40 s by 0.0006 and 0.004 on average.
   With half of it beds without friction take as long, those with friction half
   as long again. */
static const double largest_loss = 0.005;

struct rest_watch rest_watch_begin(double t, const struct similarity *s) {
  const double speed = quiet_speed;
  return (struct rest_watch){
      .quiet = quiet_time * s->time,
      .settling = settling_time * s->time,
      .kinetic_limit = 0.5 * speed * speed *
                       similarity_scale(s, (struct dimension){2, -2, 1}),
      .start = t,
      .since = t,
      .loss = GSL_NAN};
}

static size_t place(size_t k) {
  return k % (REST_SAMPLES + 1);
}

bool rest_watch_see(struct rest_watch *w, double t, double kinetic) {
  if (!(kinetic < w->kinetic_limit)) {
    w->since = t;
    w->moved = true;
  }
  return !w->count ||
         t - w->t[place(w->count - 1)] >= w->settling / REST_SAMPLES;
}

void rest_watch_sample(struct rest_watch *w, double t, double energy,
                       double height_energy) {
  w->t[place(w->count)] = t;
  w->energy[place(w->count)] = energy;
  w->count++;
  /* the latest sample that is old enough, or else the oldest */
  const size_t held = GSL_MIN(w->count, REST_SAMPLES + 1);
  size_t k = w->count - held;
  while (k + 1 < w->count && t - w->t[place(k + 1)] >= w->settling)
    k++;
  const double passed = t - w->t[place(k)];
  const double lost = w->energy[place(k)] - energy;
  if (passed > 0)
    w->loss =
        (height_energy > 0 ? lost / height_energy : 0) * w->settling / passed;
}

bool rest_watch_rests(const struct rest_watch *w, double t) {
  return t - w->start >= w->settling && t - w->since >= w->quiet &&
         w->loss < largest_loss;
}

double rest_watch_limit(void) {
  return largest_loss;
}
