/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rest: how near a bed is to rest: energies, unbalanced force, speeds, and
   settle's criterion. */
#include <stdio.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_statistics.h>
#include "dynamics/dynamics.h"
#include "measure/network.h"
#include "model/rest.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

/* Mean net force on a sphere by the mean force of a contact; a contact is what
   touches. */
static double unbalanced(const struct frames *f, const struct scene *s,
                         const struct bed *b) {
  struct network w = {0};
  frame_check(f, b, network_find(&w, s, b, s->law.lmax));
  network_mark(&w, 0, 0);
  double *force = measure_alloc(3 * b->n, sizeof *force);
  double net = 0, contact = 0;
  size_t count = 0;
  network_net_force(&w, s, b, force);
  for (size_t i = 0; i < b->n; i++)
    net += vec3_norm(force + 3 * i) / (double)b->n;
  for (size_t p = 0; p < w.count; p++)
    if (w.at[p].counts) {
      contact += hypot(w.at[p].normal, vec3_norm(w.at[p].friction));
      count++;
    }
  free(force);
  network_free(&w);
  return count ? net / (contact / (double)count) : GSL_NAN;
}

struct energies {
  double kinetic, potential, height; /* J per sphere */
  double fastest;                    /* m/s */
};

static struct energies energies(const struct frames *f, const struct scene *s,
                                const struct bed *b) {
  struct dynamics *d = NULL;
  frame_check(
      f, b, dynamics_alloc(&d, s, b, &(struct dynamics_options){.threads = 1}));
  double *y = measure_alloc(dynamics_dimension(d), sizeof *y);
  dynamics_pack(d, b, y);
  struct survey survey;
  frame_check(f, b, dynamics_survey(d, y, &survey));
  const struct energies e = {dynamics_kinetic(d, y) / (double)b->n,
                             (survey.gravity + survey.stored) / (double)b->n,
                             survey.height / (double)b->n,
                             dynamics_fastest(d, y)};
  free(y);
  dynamics_free(d);
  return e;
}

/* State kept from one frame to the next of its file. */
struct seen {
  struct rest_watch watch;
  double t, share; /* of the frame before */
};

static void see_first(struct seen *seen, const struct scene *s,
                      const struct bed *b) {
  const struct similarity spheres =
      similarity_of(gsl_stats_mean(b->r, 1, b->n),
                    gsl_stats_mean(b->m, 1, b->n), vec3_norm(s->gravity));
  seen->watch = rest_watch_begin(b->t, &spheres);
  seen->t = seen->share = GSL_NAN;
}

static bool see(struct rest_watch *w, double t, const struct energies *e) {
  if (rest_watch_see(w, t, e->kinetic))
    rest_watch_sample(w, t, e->potential, e->height);
  return rest_watch_rests(w, t);
}

static void print_frame(struct table *table, struct frames *f,
                        const struct option_list *given, const struct bed *b,
                        struct box_watch *boxes, struct seen *seen) {
  struct scene scene = frame_scene(f, b);
  if (f->first)
    frame_warn_rewritten(f);
  const double share =
      frame_union((struct frames_part){f, 0, 0.7}, given, b, boxes);
  const struct energies e = energies(f, &scene, b);
  const double net = unbalanced(f, &scene, b);
  if (f->first)
    see_first(seen, &scene, b);
  const double vmin = scene.law.vmin, passed = b->t - seen->t;
  const bool at_rest = see(&seen->watch, b->t, &e);
  scene_free(&scene);
  table_frame(table, TABLE_ROWS,
              "t\tkinetic\tpotential\tunbalanced\tfastest\tunion\trate\t"
              "at_rest");
  table_number(table, b->t);
  table_number(table, e.kinetic);
  table_number(table, e.potential);
  table_number(table, net);
  table_number(table, e.fastest / vmin);
  table_number(table, share);
  table_number(table, passed != 0 ? (share - seen->share) / passed : GSL_NAN);
  table_number(table, at_rest ? 1 : seen->watch.moved ? 0 : GSL_NAN);
  table_end_row(table);
  seen->t = b->t;
  seen->share = share;
}

int verb_rest(int argc, char **argv) {
  struct option_list given = {0};
  struct frames_options input = {.many = true, .scene = true};
  bool mean = false;
  /* clang-format off */
  struct option_spec options[] = {
      BOX_OPTION(given, "for the fraction" BASE_BOX),
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "How near a bed is to rest, one row per frame.\n"
          "  t           time (s)\n"
          "  kinetic     kinetic energy, spin included, per sphere (J)\n"
          "  potential   that of gravity, from the origin, and of contacts,\n"
          "              per sphere (J)\n"
          "  unbalanced  mean net force on a sphere by the mean force of the\n"
          "              contacts that touch (gap <= 0); 0 in balance\n"
          "  fastest     largest speed of a surface, |v| or r |w|, in vmin\n"
          "  union       solid fraction of the box\n"
          "  rate        its change since the last frame by the time (1/s)\n"
          "  at_rest     1: yes, 0: no, nan: too short a time was seen\n"
          "At rest, as for `settle --until-rest`: for 10 sqrt(r/g) (1 s for\n"
          "the paper's spheres) the mean kinetic energy was below that of\n"
          "0.01 sqrt(g r), and within 50 sqrt(r/g) (5 s) the bed lost less\n"
          "than 0.5 % of the energy of its height. A bed with friction never\n"
          "stops altogether: below vmin its contacts creep. settle looks at\n"
          "every step, this at the frames there are: have them less than\n"
          "5 sqrt(r/g) apart.",
      .usage = "rest [OPTION...] [FILE...]",
      .example = "settle --frames 161 | analyze rest",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&given);

  struct tabulation t;
  struct seen seen = {0};
  tabulation_open(&t, &input, mean, argc, argv, operand);
  t.table.kernel = dynamics_machine();
  while (tabulation_next(&t))
    print_frame(&t.table, &t.frames, &given, &t.bed, &t.watch, &seen);
  return tabulation_close(&t);
}
