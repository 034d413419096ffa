/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Branch and bound. No distance changes by more than the way, so a block whose
   middle has the distance d has none above d + half its diagonal. Blocks are
   halved along all axes until that is no more than the best found and 1 %; on
   the way those bodies go that cannot be nearest anywhere in the block. The
   candidates are at the front of a list that is only ever permuted, so that the
   parts of a block find all of theirs there. Each pass goes one level deeper
   than the one before, so that a coarse look all over comes before a fine one.
 */
#include "geometry/clearance.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"

struct search {
  const struct solid *s;
  const double *box;
  double best, point[3], least; /* the least that counts as free */
  size_t blocks;                /* that may still be looked at */
  int levels;                   /* of this pass */
  bool cut;                     /* are there more? */
};

/* A flat box has equally deep points all over. */
enum { MOST_BLOCKS = 1000000 };

/* To a sphere, or to a bridge, whose number comes after those of all
   spheres. */
static double body_distance(const struct solid *s, size_t m,
                            const double p[3]) {
  if (m < s->n)
    return solid_ball_distance(s->x + 3 * m, s->r[m], p);
  const uint32_t *ends = s->ends[m - s->n];
  return solid_cylinder_distance(s->x + 3 * (size_t)ends[0],
                                 s->x + 3 * (size_t)ends[1], s->bridge_radius,
                                 p);
}

/* Which of the eight parts of a block to look at first. */
struct part {
  double middle[3], distance;
};

static int compare_parts(const void *a, const void *b) {
  const struct part *p = a, *q = b;
  return (p->distance < q->distance) - (p->distance > q->distance);
}

static double look(const struct search *q, const double p[3],
                   const uint32_t *candidate, size_t count) {
  double least = box_distance(q->box, p);
  if (q->s->container)
    least = fmin(least, container_distance(q->s->container, p));
  for (size_t m = 0; m < count; m++)
    least = fmin(least, body_distance(q->s, candidate[m], p));
  return least;
}

static void deepen(struct search *q, const double middle[3], double distance,
                   const double half[3], uint32_t *candidate, size_t count,
                   int level) {
  const double reach = vec3_norm(half);
  if (distance > q->best) {
    q->best = distance;
    memcpy(q->point, middle, sizeof q->point);
  }
  if (distance + reach <= fmax(1.01 * q->best, q->least) || !q->blocks)
    return;
  if (level == q->levels) {
    q->cut = true;
    return;
  }
  q->blocks--;
  /* what is nearest somewhere in the block is so near to its middle */
  size_t kept = 0;
  for (size_t m = 0; m < count; m++) {
    const uint32_t i = candidate[m];
    if (body_distance(q->s, i, middle) > distance + 2 * reach)
      continue;
    candidate[m] = candidate[kept];
    candidate[kept++] = i;
  }
  const double quarter[3] = {half[0] / 2, half[1] / 2, half[2] / 2};
  struct part part[8];
  for (int c = 0; c < 8; c++) {
    for (int k = 0; k < 3; k++)
      part[c].middle[k] = middle[k] + (c >> k & 1 ? quarter[k] : -quarter[k]);
    part[c].distance = look(q, part[c].middle, candidate, kept);
  }
  qsort(part, 8, sizeof *part, compare_parts);
  for (int c = 0; c < 8; c++)
    deepen(q, part[c].middle, part[c].distance, quarter, candidate, kept,
           level + 1);
}

int clearance_deepest(const struct solid *s, const double box[6],
                      double point[3], double *clearance) {
  if (!box_valid(box) || s->n > UINT32_MAX - s->bridges)
    return GSL_EINVAL;
  const size_t all = s->n + s->bridges;
  uint32_t *candidate = calloc(all + 1, sizeof *candidate);
  if (!candidate)
    return GSL_ENOMEM;
  for (size_t m = 0; m < all; m++)
    candidate[m] = (uint32_t)m;
  double middle[3], half[3];
  for (int k = 0; k < 3; k++) {
    half[k] = (box[2 * k + 1] - box[2 * k]) / 2;
    middle[k] = box[2 * k] + half[k];
  }
  struct search q = {.s = s,
                     .box = box,
                     .best = GSL_NEGINF,
                     .least = 1e-6 * vec3_norm(half),
                     .blocks = MOST_BLOCKS};
  const double distance = look(&q, middle, candidate, all);
  do {
    q.cut = false;
    q.levels++;
    deepen(&q, middle, distance, half, candidate, all, 0);
  } while (q.cut && q.blocks);
  free(candidate);
  if (!(q.best > 0))
    return GSL_EDOM;
  memcpy(point, q.point, sizeof q.point);
  *clearance = q.best;
  return GSL_SUCCESS;
}
