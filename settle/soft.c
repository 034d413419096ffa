/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "soft.h"

#include <math.h>
#include <gsl/gsl_math.h>
#include "model/softness.h"

/* Evaluations grow with this power of the stiffness of friction, with methods
   that adapt to it: four to six times as many for ten times (measured,
   docs/softness.md).
 */
static const double stiff_cost = 0.7;

static void refuse_beside(struct option_spec *options, const char *one,
                          const char *other) {
  if (option_find(options, other)->given)
    die(EXIT_USAGE, "--%s: follows from --%s, expected one of the two", other,
        one);
}

/* Area that carries the bed (m^2): of the upright cylinder or of the box. */
static double base_area(const struct settings *s) {
  for (size_t k = 0; k < s->scene.walls_count; k++) {
    const struct wall *w = &s->scene.walls[k];
    if (w->radius > 0 && fabs(w->normal[2]) < 1 - 1e-9)
      die(EXIT_USAGE, "--overlap: the load follows from the base, expected "
                      "--kappa and --f0 beside a cylinder that leans");
    if (w->radius > 0)
      return M_PI * gsl_pow_2(w->radius);
  }
  return s->words.base.at[0] * s->words.base.at[1];
}

static void take_overlap(struct settings *s, struct option_spec *options,
                         const struct bed *b, const struct bed_header *h) {
  struct contact_law *c = &s->scene.law;
  const double *g = s->scene.gravity;
  refuse_beside(options, "overlap", "kappa");
  refuse_beside(options, "overlap", "f0");
  if (!(g[2] < 0 && g[0] == 0 && g[1] == 0))
    die(EXIT_USAGE, "--overlap: needs a load, expected gravity downwards");
  /* a scene with other walls has no base that is known */
  if (option_find(options, "wall")->given ||
      (s->scene_file && !bed_header_get(h, "base")))
    die(EXIT_USAGE, "--overlap: the load follows from the base of a box, "
                    "expected --kappa and --f0 beside other walls");
  double mass = 0, cubes = 0, count = 0;
  for (size_t i = 0; i < b->n; i++)
    if (!bed_is_fixed(b, i)) {
      mass += b->m[i];
      cubes += gsl_pow_3(b->r[i]);
      count++;
    }
  const double diameter = 2 * bed_mean(b, b->r);
  const struct softness_load load = {.weight = mass * -g[2],
                                     .area = base_area(s),
                                     .volume = 4 * M_PI / 3 * cubes / count,
                                     .diameter = diameter};
  c->f0 = softness_f0(&load, c->restitution);
  c->kappa = softness_kappa(s->overlap * diameter);
  if (!option_find(options, "lmax")->given)
    c->lmax = softness_lmax(c->kappa);
}

static void take_creep(struct settings *s, struct option_spec *options,
                       const struct bed *b) {
  refuse_beside(options, "creep", "vmin");
  if (!scene_has_friction(&s->scene))
    die(EXIT_USAGE, "--creep: nothing creeps without friction, expected "
                    "--friction above 0 and another model than basic");
  if (!(s->time > b->t))
    die(EXIT_USAGE, "--creep: no time to creep in, expected --time above %g",
        b->t);
  const double before = s->scene.law.vmin;
  s->scene.law.vmin =
      softness_vmin(s->creep * bed_mean(b, b->r), s->time - b->t);
  const double ratio = before / s->scene.law.vmin;
  if (ratio > 1)
    warn("--creep %g: vmin is %.3g m/s, so friction is %.2g times as stiff: "
         "some %.2g times the evaluations",
         s->creep, s->scene.law.vmin, ratio,
         pow(ratio,
             integrate_method(s->integrate.method)->adapts ? stiff_cost : 1));
}

void soft_take(struct settings *s, struct option_spec *options,
               const struct bed *b, const struct bed_header *h) {
  if (option_find(options, "overlap")->given)
    take_overlap(s, options, b, h);
  if (option_find(options, "creep")->given)
    take_creep(s, options, b);
}
