/* SPDX-License-Identifier: GPL-3.0-or-later */
/* order: bond-orientational order of the spheres, and which lattice they
   resemble. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "measure/bond_order.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

struct order {
  struct option_list box;
  double cutoff, margin, least;
  bool spheres;
};

static const char *const class_names[] = {[BOND_DISORDERED] = "disordered",
                                          [BOND_FCC] = "fcc",
                                          [BOND_HCP] = "hcp",
                                          [BOND_BCC] = "bcc"};

static void print_spheres(struct table *table, struct frames *f,
                          const struct order *set, const struct bed *b,
                          const struct region *region,
                          const struct bond_order *o) {
  table_frame(table, TABLE_BLOCKS,
              "t\tid\tx\ty\tz\tr\tneighbours\tq4\tq6\tqbar4\tqbar6\twbar4\t"
              "wbar6\tclass\tlike");
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i;
    frames_tell(f, 0.7 + 0.3 * (double)i / (double)b->n);
    if (bed_is_fixed(b, i) || !region_holds(region, x))
      continue;
    const double numbers[] = {o[i].q4,    o[i].q6,    o[i].qbar4,
                              o[i].qbar6, o[i].wbar4, o[i].wbar6};
    const enum bond_class class = bond_order_class(&o[i], set->least);
    table_number(table, b->t);
    table_id(table, b->id[i]);
    for (int k = 0; k < 3; k++)
      table_number(table, x[k]);
    table_number(table, b->r[i]);
    table_count(table, o[i].neighbours);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
      table_number(table, numbers[k]);
    table_count(table, (size_t) class);
    table_text(table, class_names[class]);
    table_end_row(table);
  }
}

static void print_row(struct table *table, const struct order *set,
                      const struct bed *b, const struct region *region,
                      const struct bond_order *o) {
  size_t n = 0, class[4] = {0};
  double sum[5] = {0};
  for (size_t i = 0; i < b->n; i++) {
    if (bed_is_fixed(b, i) || !region_holds(region, b->x + 3 * i))
      continue;
    n++;
    class[bond_order_class(&o[i], set->least)]++;
    sum[0] += (double)o[i].neighbours;
    sum[1] += o[i].q4;
    sum[2] += o[i].q6;
    sum[3] += o[i].qbar4;
    sum[4] += o[i].qbar6;
  }
  table_frame(table, TABLE_ROWS,
              "t\tspheres\tneighbours\tq4\tq6\tqbar4\tqbar6\tfcc\thcp\tbcc\t"
              "disordered");
  table_number(table, b->t);
  table_count(table, n);
  for (int k = 0; k < 5; k++)
    table_number(table, n ? sum[k] / (double)n : GSL_NAN);
  const enum bond_class columns[] = {BOND_FCC, BOND_HCP, BOND_BCC,
                                     BOND_DISORDERED};
  for (int k = 0; k < 4; k++)
    table_number(table, n ? (double)class[columns[k]] / (double)n : GSL_NAN);
  table_end_row(table);
}

static void print_frame(struct tabulation *t, const void *context) {
  const struct order *set = context;
  struct frames *f = &t->frames;
  const struct bed *b = &t->bed;
  struct bond_order *o = measure_alloc(b->n, sizeof *o);
  double diameter = 0;
  for (size_t i = 0; i < b->n; i++)
    diameter += 2 * b->r[i];
  diameter /= (double)b->n;
  tabulation_see(t, &set->box);
  struct frames_part part = {f, 0, set->spheres ? 0.7 : 1};
  const struct observer told = frames_observer(&part);
  const struct region region =
      frame_region(f, b, &set->box, set->margin * diameter);
  struct scene scene = frame_scene(f, b);
  frame_check(f, b,
              bond_order_find(b->n, b->x, scene.period, set->cutoff * diameter,
                              &told, o));
  scene_free(&scene);
  if (set->spheres)
    print_spheres(&t->table, f, set, b, &region, o);
  else
    print_row(&t->table, set, b, &region, o);
  free(o);
}

int verb_order(int argc, char **argv) {
  struct order set = {.cutoff = 1.2, .margin = 0.5, .least = 0.4};
  struct frames_options input = {.many = true};
  bool mean = false;
  /* clang-format off */
  struct option_spec options[] = {
      POSITIVE("cutoff", &set.cutoff, "mean diameters",
               "neighbours are no further apart, by their centres"),
      NUMBER("least", &set.least, 0, 1, "",
             "qbar6 from which a sphere is ordered"),
      BOX_OPTION(set.box, "spheres with their centre in a box"),
      NUMBER("margin", &set.margin, 0, OPTION_MANY, "diameters",
             "without --box: centres this far inside the box, or in a tube "
             "the cylinder, that they span; periodic sides are no faces"),
      {.name = "spheres", .type = OPTION_FLAG, .value = &set.spheres,
       .help = "one block per frame: one row per sphere"},
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Bond-orientational order, one row per frame: means over spheres.\n"
          "  t            time (s)\n"
          "  spheres      spheres that are counted; those at walls and\n"
          "               surface, whose neighbourhood is cut, are left out,\n"
          "               and obstacles, which are neighbours only\n"
          "  neighbours   spheres within --cutoff of each\n"
          "  q4 q6        of Steinhardt, Nelson and Ronchetti (1983)\n"
          "  qbar4 qbar6  of Lechner and Dellago (2008): q_lm averaged over a\n"
          "               sphere and its neighbours\n"
          "  fcc hcp bcc disordered  shares of the spheres: disordered with a\n"
          "               qbar6 below --least, else by the signs of wbar6 and\n"
          "               wbar4: bcc +, fcc - -, hcp - +\n"
          "An ideal lattice has (q4, q6) = fcc 0.191, 0.575; hcp 0.097, "
          "0.485;\n"
          "bcc 0.036, 0.511 (14 neighbours); sc 0.764, 0.354. A random bed's\n"
          "spheres have a qbar6 of 0.1 to 0.3. --spheres: t id x y z r\n"
          "neighbours q4 q6 qbar4 qbar6 wbar4 wbar6 class like: the class as\n"
          "a number, 0 disordered, 1 fcc, 2 hcp, 3 bcc, and as its name.",
      .usage = "order [OPTION...] [FILE...]",
      .example = "settle --model basic | analyze order",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&set.box);

  return tabulate(&input, mean, argc, argv, operand, print_frame, &set);
}
