/* What the scenes have in common. */
#ifndef MEASURE_H
#define MEASURE_H

#include "motion.h"
#include "scenes.h"

/* Steps until t exactly. The word for precision_result.status: "ok", "gave_up"
   where the integrator fails, "too_long" after most steps. */
const char *measure_until(struct integrator *it, double t, size_t most);

/* Copies the counts of a run into r. */
void measure_counts(const struct motion *m, struct precision_result *r);

#endif
