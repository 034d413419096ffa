/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Softness and creep by choice, against closed forms: a column of spheres at
   rest, F(l) (1 + e^2)/2 = k m g at its k-th contact from above, and a contact
   that carries half of its friction. */
#include <float.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "model/contact.h"
#include "model/scene.h"
#include "model/softness.h"
#include "sample.h"

/* A column on its own square: the recipe's load is a bed's, of solid fraction
   0.6 and 5.5 contacts, a column's pi/6 and 2; what it gives is near. */
static void test_column(gsl_rng *rng) {
  for (int k = 0; k < 50; k++) {
    const size_t n = 1 + gsl_rng_uniform_int(rng, 60);
    const double r = pow(10, uniform(rng, -4, 0)),
                 m = pow(10, uniform(rng, -6, 3)),
                 g = pow(10, uniform(rng, -1, 2)), d = 2 * r,
                 share = pow(10, uniform(rng, -4, -1));
    struct contact_law c = scene_default().law;
    c.restitution = uniform(rng, 0, 1);
    c.f0 = softness_f0(&(struct softness_load){.weight = (double)n * m * g,
                                               .area = d * d,
                                               .volume = M_PI / 6 * d * d * d,
                                               .diameter = d},
                       c.restitution);
    c.kappa = softness_kappa(share * d);
    /* the gap at which the floor carries them all, by bisection on (2.3) */
    double low = -5 * share * d, high = 5 * share * d;
    for (int i = 0; i < 200; i++) {
      const double l = 0.5 * (low + high);
      *(contact_normal(&c, l, 0) > (double)n * m * g ? &low : &high) = l;
    }
    CHECK_CLOSE(-low / (share * d), 1, 0.15);
    /* half of its columns' contacts overlap and half do not, nearly: the median
       load is n/2 */
    const double median = contact_normal(&c, 0, 0) / ((double)n * m * g);
    CHECK_CLOSE(median, 0.3, 0.1);
  }
}

static void test_cut(void) {
  const struct contact_law paper = scene_default().law;
  CHECK_REL(softness_lmax(paper.kappa), paper.lmax, 4 * DBL_EPSILON);
}

/* (2.8) is 1/2 at half of vmin, and back again. */
static void test_creep(gsl_rng *rng) {
  for (int k = 0; k < 20; k++) {
    struct contact_law c = scene_default().law;
    const double way = pow(10, uniform(rng, -6, 1)),
                 time = pow(10, uniform(rng, -2, 3));
    c.vmin = softness_vmin(way, time);
    CHECK_CLOSE(contact_limiter(&c, way / time), 0.5, 8 * DBL_EPSILON);
    CHECK_REL(softness_creep(c.vmin, time), way, 4 * DBL_EPSILON);
  }
}

/* Errors fall with hardness, as its inverse, and vanish without creep. */
static void test_errors(void) {
  CHECK_REL(softness_error(15), 2 * softness_error(30), 4 * DBL_EPSILON);
  CHECK(softness_creep_error(0) == 0);
  CHECK(softness_creep_error(0.1) > softness_creep_error(0.05));
  CHECK(softness_creep_error(1e9) < 0.1); /* no denser than without friction */
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  test_column(rng);
  test_cut();
  test_creep(rng);
  test_errors();
  gsl_rng_free(rng);
  return check_done();
}
