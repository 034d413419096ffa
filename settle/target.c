/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A fraction falls with friction, steeply at first, so we look for the root s
   of the friction, friction = s^2, by bisection from 0 to 1. Beds of one
   friction differ by chance, so bisection ends where the fractions of its two
   ends do not tell them apart; a straight line through trials around there
   gives the friction, and the line's slope makes chance in the fraction an
   interval of it. */
#include "target.h"

#include <math.h>
#include <stdio.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include "dynamics/motion.h"
#include "files/numbers.h"
#include "geometry/box.h"
#include "geometry/periodic.h"
#include "geometry/volume.h"
#include "model/base_box.h"
#include "model/rest.h"
#include "program/integration.h"

/* The most trials, and those that the line is laid through. */
enum { TRIALS = 10, NEAR = 5 };

/* Standard deviation of a bed of 200 over seeds (docs/softness.md). */
static const double bed_deviation = 0.006, bed_spheres = 200;

struct trial {
  double root, fraction;
};

struct search {
  const struct settings *set;
  const struct bed *bed; /* the start */
  struct trial at[TRIALS];
  size_t count;
  double deviation;
  double densest, loosest; /* without friction and with the most */
};

/* Of the bottom cube between the walls, as analyze has it, with images. */
static double fraction_of(const struct settings *s, const struct bed *b) {
  double box[6], united;
  struct periodic_images images = {0};
  base_box(&s->scene, box); /* refuse_options looked */
  int status =
      periodic_images_in_box(&images, b->n, b->x, b->r, s->scene.period, box);
  if (status == GSL_SUCCESS)
    status = volume_union(images.count, images.x, images.radius, box, &united);
  periodic_images_free(&images);
  if (status != GSL_SUCCESS)
    die_status(status, "--target-fraction");
  return united / box_volume(box);
}

static bool rests(struct rest_watch *w, const struct motion *m,
                  const struct bed *b) {
  const double t = integrate_time(m->integrator);
  const double *y = integrate_state(m->integrator);
  struct survey v;
  if (rest_watch_see(w, t, dynamics_kinetic(m->dynamics, y) / (double)b->n) &&
      dynamics_survey(m->dynamics, y, &v) == GSL_SUCCESS)
    rest_watch_sample(w, t, v.gravity + v.stored, v.height);
  return rest_watch_rests(w, t);
}

/* Settles the bed, from its start, with a friction; its fraction. */
static double settle(const struct search *q, double friction) {
  const struct settings *s = q->set;
  struct scene scene = s->scene;
  struct bed b;
  struct motion *m;
  scene.law.friction = friction;
  if (bed_copy(&b, q->bed) != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
  int status =
      motion_alloc(&m, &scene, &b, &s->integrate,
                   &(struct dynamics_options){.all_pairs = s->all_pairs,
                                              .threads = (int)s->threads,
                                              .kernel = s->kernel},
                   s->travel / scene.law.kappa);
  if (status != GSL_SUCCESS)
    die_status(status, "method %s", s->integrate.method);
  struct rest_watch rest = rest_watch_begin(b.t, &s->similarity);
  while (status == GSL_SUCCESS && integrate_time(m->integrator) < s->time &&
         !(s->until_rest && rests(&rest, m, &b)))
    status = integrate_step(m->integrator);
  if (status != GSL_SUCCESS)
    die(EXIT_INTEGRATION, "--target-fraction: with friction %g, t=%.6g: %s",
        friction, integrate_time(m->integrator),
        integration_error(&s->integrate, status));
  dynamics_unpack(m->dynamics, integrate_state(m->integrator), &b);
  const double fraction = fraction_of(s, &b);
  motion_free(m);
  bed_free(&b);
  return fraction;
}

static double try(struct search *q, double root) {
  const double fraction = settle(q, root * root);
  q->at[q->count++] = (struct trial){root, fraction};
  return fraction;
}

/* Slope and place of the line through the trials that are nearest to a root. */
static void line_near(struct search *q, double root, double *intercept,
                      double *slope) {
  struct trial *at = q->at;
  for (size_t i = 1; i < q->count; i++) /* by distance, few */
    for (size_t j = i;
         j > 0 && fabs(at[j].root - root) < fabs(at[j - 1].root - root); j--) {
      const struct trial t = at[j];
      at[j] = at[j - 1];
      at[j - 1] = t;
    }
  double xx, xy, yy, squares;
  gsl_fit_linear(&at[0].root, 2, &at[0].fraction, 2, GSL_MIN(NEAR, q->count),
                 intercept, slope, &xx, &xy, &yy, &squares);
}

static void refuse_options(const struct settings *s,
                           struct option_spec *options) {
  static const char *const others[] = {"scene", "onto", "friction"};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    if (option_find(options, others[k])->given)
      die(EXIT_USAGE, "--target-fraction: expected no --%s beside it",
          others[k]);
  double box[6];
  if (!base_box(&s->scene, box))
    die(EXIT_USAGE,
        "--target-fraction: needs a bottom cube, expected a floor "
        "and sides along x and y, periodic ones or an upright tube");
  if (!scene_has_friction(&s->scene))
    die(EXIT_USAGE, "--target-fraction: is reached by friction, expected "
                    "another model than basic");
  if (s->integrate.step > 0)
    die(EXIT_USAGE, "--target-fraction: needs a tolerance, expected no --step "
                    "beside it");
}

void target_take(struct settings *s, struct option_spec *options,
                 const struct bed *b, struct bed_header *h) {
  if (!option_find(options, "target-fraction")->given)
    return;
  refuse_options(s, options);
  struct search q = {.set = s, .bed = b};
  q.deviation = bed_deviation * sqrt(bed_spheres / (double)b->n);
  double low = 0, high = 1;
  double most = try(&q, low), least = try(&q, high);
  q.densest = most;
  q.loosest = least;
  if (!(s->target <= most + q.deviation && s->target >= least - q.deviation))
    die(EXIT_LIMIT,
        "--target-fraction %g: not reachable with this softness and box: %.3f "
        "to %.3f",
        s->target, least, most);
  while (q.count < TRIALS && most - least > 2 * q.deviation) {
    const double middle = 0.5 * (low + high), fraction = try(&q, middle);
    if (fraction > s->target) {
      low = middle;
      most = fraction;
    } else {
      high = middle;
      least = fraction;
    }
  }
  double intercept, slope;
  line_near(&q, 0.5 * (low + high), &intercept, &slope);
  /* chance may tilt a line: then the bracket is all that is known */
  const bool falls = slope < 0;
  const double root = falls ? fmin(1, fmax(0, (s->target - intercept) / slope))
                            : 0.5 * (low + high);
  const double half =
      falls ? fmax(0.5 * (high - low), -q.deviation / slope) : high - low;
  s->scene.law.friction = root * root;
  warn("--target-fraction %g: friction %.3g (%.2g to %.2g) by %zu trial beds, "
       "of %.3f without friction to %.3f with 1",
       s->target, root * root, gsl_pow_2(fmax(0, root - half)),
       gsl_pow_2(root + half), q.count, q.densest, q.loosest);
  char text[NUMBER_SIZE];
  number_format(s->scene.law.friction, text);
  if (bed_header_set(h, "friction", text) != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
}

void target_tell(const struct settings *s, const struct bed *b) {
  if (s->target > 0)
    warn("--target-fraction %g: the bed fills %.4f", s->target,
         fraction_of(s, b));
}
