/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "dynamics/rates.h"

#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

/* Puts rows [from, to) of obstacles back to where they are, at rest. */
static void keep_still(const struct contact_list *l, size_t from, size_t to,
                       const double *y, double *few,
                       const struct rates_to *rates) {
  const size_t at = from * l->stride, count = (to - from) * l->stride;
  memset(few, 0, count * sizeof *few);
  if (!rates->dydt)
    memcpy(rates->out + at, y + at, count * sizeof *y);
}

/* A part a few rows at a time, each finished while it is in the cache: a row's
   pairs as second partner belong to rows before it. */
static bool evaluate_part(const struct contact_list *l,
                          const struct kernel *kernel, size_t p,
                          const double *y, const struct rates_to *to) {
  const struct contact_part *part = &l->part[p];
  const size_t in = l->incoming[p], incoming = l->incoming[p + 1] - in;
  if (incoming)
    kernel->add_pairs(l, y, l->in_i + in, l->in_j + in, incoming, part);
  bool finite = true;
  double few[CONTACT_CHUNK * ROW_SPIN];
  for (size_t i = part->from; i < part->to; i += CONTACT_CHUNK) {
    const size_t end = GSL_MIN(i + CONTACT_CHUNK, part->to);
    const size_t at = i * l->stride;
    const size_t first = l->near.first[i], last = l->near.first[end];
    double *rates = to->dydt ? to->dydt + at : few;
    kernel->add_pairs(l, y, l->near.i + first, l->near.j + first, last - first,
                      part);
    kernel->add_walls(l, y, i, end, part);
    finite = kernel->finish(l, y, rates, i, end, part) && finite;
    if (!to->dydt)
      stage_combine(to->stage, at, (end - i) * l->stride, y, rates, to->out);
    if (end > l->moving) {
      const size_t first_fixed = GSL_MAX(i, l->moving);
      keep_still(l, first_fixed, end, y, rates + (first_fixed - i) * l->stride,
                 to);
    }
  }
  return finite;
}

int rates_evaluate(const struct contact_list *list, const struct kernel *kernel,
                   const double y[], const struct rates_to *to) {
  const int threads = (int)list->threads;
  bool finite = true;
  if (threads == 1)
    finite = evaluate_part(list, kernel, 0, y, to);
  else {
#pragma omp parallel for num_threads(threads) schedule(static, 1)              \
    reduction(&& : finite)
    for (int p = 0; p < threads; p++)
      finite = evaluate_part(list, kernel, (size_t)p, y, to) && finite;
  }
  return finite ? GSL_SUCCESS : GSL_EBADFUNC;
}
