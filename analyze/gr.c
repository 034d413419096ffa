/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gr: pair correlation g(r) of the centres. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "measure/correlation.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

struct gr {
  struct option_list box;
  double rmax, margin;
  size_t bins;
};

static void print_frame(struct tabulation *t, const void *context) {
  const struct gr *set = context;
  struct frames *f = &t->frames;
  struct table *table = &t->table;
  struct bed *b = &t->bed;
  double radius = 0;
  for (size_t i = 0; i < b->n; i++)
    radius += b->r[i];
  radius /= (double)b->n;
  tabulation_see(t, &set->box);
  const struct region region =
      frame_region(f, b, &set->box, set->margin * 2 * radius);
  if (!region_valid(&region))
    frame_refuse(f, b, "the centres span no volume, expected a box by --box");
  if (set->box.count) /* which may be larger than a periodic cell */
    frame_add_images(f, b, 1, (const double(*)[6])region.box);
  double *x = measure_alloc(3 * b->n, sizeof *x);
  double *pairs = measure_alloc(2 * set->bins, sizeof *pairs);
  double *expected = pairs + set->bins;
  size_t n = 0;
  for (size_t i = 0; i < b->n; i++)
    if (region_holds(&region, b->x + 3 * i))
      memcpy(x + 3 * n++, b->x + 3 * i, 3 * sizeof *x);
  const double rmax = set->rmax * 2 * radius;
  struct frames_part part = {f, 0, 1};
  const struct observer told = frames_observer(&part);
  frame_check(f, b,
              correlation_count(n, x, &region, rmax, set->bins, &told, pairs,
                                expected));
  table_frame(table, TABLE_BLOCKS, "t\tr\tg\tpairs\texpected\tcoordination");
  double around = 0;
  for (size_t k = 0; k < set->bins; k++) {
    const double width = rmax / (double)set->bins;
    const double g = expected[k] > 0 ? pairs[k] / expected[k] : GSL_NAN;
    const double shell = 4 * M_PI / 3 *
                         (gsl_pow_3((double)k + 1) - gsl_pow_3((double)k)) *
                         gsl_pow_3(width);
    around += g * shell * ((double)n - 1) / region_volume(&region);
    table_number(table, b->t);
    table_number(table, ((double)k + 0.5) * set->rmax / (double)set->bins);
    table_number(table, g);
    table_number(table, pairs[k]);
    table_number(table, expected[k]);
    table_number(table, around);
    table_end_row(table);
  }
  free(pairs);
  free(x);
}

int verb_gr(int argc, char **argv) {
  struct gr set = {.rmax = 3, .bins = 150};
  struct frames_options input = {.many = true};
  bool mean = false;
  /* clang-format off */
  struct option_spec options[] = {
      BOX_OPTION(set.box, "centres in a box; else all of them"),
      NUMBER("margin", &set.margin, 0, OPTION_MANY, "diameters",
             "less on every side, without --box"),
      POSITIVE("rmax", &set.rmax, "diameters", "largest distance"),
      {.name = "bins", .type = OPTION_SIZE, .value = &set.bins, .least = 1,
       .most = 1e6, .help = "of equal width from 0 to rmax"},
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Pair correlation of the centres, one block of rows per frame.\n"
          "  t             time (s)\n"
          "  r             middle of the bin (mean diameters)\n"
          "  g             pairs/expected\n"
          "  pairs         pairs in the bin, both centres in the box\n"
          "  expected      pairs if the partners of each were strewn evenly\n"
          "                over the box: shares of shells that stick\n"
          "                out of it are exact\n"
          "  coordination  mean number of partners up to the bin's end\n"
          "Add pairs and expected of several beds to average their g. Without\n"
          "--box it is the box that the centres span or, in a tube, the\n"
          "cylinder; periodic sides are none of its faces, and images count "
          "as\n"
          "partners. A box should hold all centres or lie well inside: one\n"
          "that cuts off the layer at a wall finds too few spheres at its\n"
          "faces, and a g that is too large.",
      .usage = "gr [OPTION...] [FILE...]",
      .example = "settle --model basic | analyze gr > gr.tsv",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&set.box);

  return tabulate(&input, mean, argc, argv, operand, print_frame, &set);
}
