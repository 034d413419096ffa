/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mixture: a bed of several sizes class by class: shares, solid fraction,
   height, segregation and contacts; or the profile of the fraction along z. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "geometry/periodic.h"
#include "geometry/volume.h"
#include "measure/close_packing.h"
#include "measure/mixture.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

struct set {
  struct option_list box, edges;
  double gap;
  size_t slabs;
  bool close;
};

/* Volume of a class' clipped spheres in a box. x, r: room for all spheres. */
static double class_volume(const struct bed *b, const struct mixture *m,
                           size_t k, const double box[6], double *x,
                           double *r) {
  size_t n = 0;
  for (size_t i = 0; i < b->n; i++)
    if (mixture_find(m, b->r[i]) == k) {
      memcpy(x + 3 * n, b->x + 3 * i, 3 * sizeof *x);
      r[n++] = b->r[i];
    }
  return volume_sum(n, x, r, box);
}

static void print_classes(struct table *table, const struct bed *b,
                          const struct mixture *m, const double box[6],
                          double *room) {
  for (size_t k = 0; k < m->count; k++) {
    const struct mixture_class *c = &m->at[k];
    const double v = class_volume(b, m, k, box, room, room + 3 * b->n);
    table_number(table, b->t);
    table_number(table, c->radius);
    table_number(table, c->low);
    table_number(table, c->high);
    table_count(table, c->spheres);
    table_number(table, c->share);
    table_number(table, v / box_volume(box));
    table_number(table, c->height);
    table_number(table, c->segregation);
    table_number(table, c->z);
    table_number(table, c->z_own);
    table_number(table, c->z_walls);
    table_end_row(table);
  }
}

static void print_profile(struct table *table, const struct bed *b,
                          const struct mixture *m, const double box[6],
                          size_t slabs, double *room) {
  double slab[6];
  memcpy(slab, box, sizeof slab);
  for (size_t s = 0; s < slabs; s++) {
    const double height = box[5] - box[4];
    slab[4] = box[4] + height * (double)s / (double)slabs;
    slab[5] = box[4] + height * ((double)s + 1) / (double)slabs;
    for (size_t k = 0; k < m->count; k++) {
      const double v = class_volume(b, m, k, slab, room, room + 3 * b->n);
      table_number(table, b->t);
      table_number(table, 0.5 * (slab[4] + slab[5]));
      table_number(table, m->at[k].radius);
      table_number(table, v / box_volume(slab));
      table_end_row(table);
    }
  }
}

/* Of the spheres that are looked at. room: as many radii. */
static void print_close(struct tabulation *t, const struct bed *b,
                        const bool *inside, double *room) {
  double rods = GSL_NAN, deviation, skewness;
  size_t n = 0;
  for (size_t i = 0; i < b->n; i++)
    if (inside[i])
      room[n++] = b->r[i];
  if (n)
    frame_check(&t->frames, b, close_packing_rods(n, room, &rods));
  close_packing_spread(n, room, &deviation, &skewness);
  table_number(&t->table, b->t);
  table_count(&t->table, n);
  table_number(&t->table, deviation);
  table_number(&t->table, skewness);
  table_number(&t->table, rods);
  table_number(&t->table,
               n ? close_packing_spread_fraction(deviation, skewness) : rods);
  table_end_row(&t->table);
}

/* A frame. */
static void measure(struct tabulation *t, const void *context) {
  const struct set *set = context;
  const struct bed *b = &t->bed;
  struct scene scene = frame_scene(&t->frames, b);
  struct network w = {0};
  struct mixture m;
  double box[6];
  frame_choose_box(&t->frames, &set->box, box);
  box_watch_see(&t->watch, &t->frames, b, !set->box.count, 1,
                (const double(*)[6])box);
  frame_check_box(&t->frames, b, box);
  if (set->edges.count)
    m = mixture_of_edges(set->edges.count, set->edges.at);
  else
    frame_check(&t->frames, b, mixture_of_radii(b, &m));
  bool *inside = measure_alloc(b->n, sizeof *inside);
  for (size_t i = 0; i < b->n; i++)
    inside[i] =
        !bed_is_fixed(b, i) &&
        (!set->box.count || periodic_in_box(scene.period, box, b->x + 3 * i));
  frame_check(&t->frames, b, network_find(&w, &scene, b, GSL_MAX(set->gap, 0)));
  network_mark(&w, set->gap, 0);
  mixture_measure(&m, b, inside, &w);
  if (!set->close) /* volumes are those of all images */
    frame_add_images(&t->frames, &t->bed, 1, (const double(*)[6])box);
  double *room = measure_alloc(b->n, 4 * sizeof *room);
  if (set->close) {
    table_frame(&t->table, TABLE_ROWS,
                "t\tspheres\tdeviation\tskewness\trods\tspread");
    print_close(t, b, inside, room);
  } else if (set->slabs) {
    table_frame(&t->table, TABLE_PARTS, "t\tz\tradius\tsum");
    print_profile(&t->table, b, &m, box, set->slabs, room);
  } else {
    table_frame(&t->table, TABLE_PARTS,
                "t\tradius\tlow\thigh\tspheres\tshare\tsum\theight\t"
                "segregation\tz\tz_own\tz_walls");
    print_classes(&t->table, b, &m, box, room);
  }
  free(room);
  free(inside);
  network_free(&w);
  scene_free(&scene);
}

int verb_mixture(int argc, char **argv) {
  struct set set = {0};
  struct frames_options input = {.many = true, .scene = true};
  bool means = false;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "classes", .type = OPTION_LIST, .value = &set.edges,
       .least = 1, .most = MIXTURE_MOST - 1,
       .unit = "m; else each radius, or 4 of equal volume",
       .help = "radii that classes of sizes meet at"},
      NUMBER("gap", &set.gap, -OPTION_MANY, OPTION_MANY, "m",
             "surfaces no further apart are a contact"),
      BOX_OPTION(set.box, "where the fraction is taken, and with it the "
                          "spheres, by centre" BASE_BOX ", and all spheres"),
      {.name = "profile", .type = OPTION_SIZE, .value = &set.slabs,
       .most = 1e6, .unit = "slabs of the box; 0: none",
       .help = "fraction of each class along z instead"},
      {.name = "close", .type = OPTION_FLAG, .value = &set.close,
       .help = "random close packing that others expect of the sizes instead"},
      MEAN_OPTION(means),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "A bed of several sizes, one row for each class of radii.\n"
          "  t                time (s)\n"
          "  radius           mean of the class (m)\n"
          "  low high         its radii, low <= r < high (m)\n"
          "  spheres          that are looked at\n"
          "  share            of the volume of all of them\n"
          "  sum              of its clipped spheres, by the volume of the\n"
          "                   box; the classes' add up to that of `fraction`\n"
          "  height           mean z of the centres, by volume (m)\n"
          "  segregation      1: the class lies on all others, -1: below\n"
          "                   them, 0: mixed; its mean height less that of\n"
          "                   all, by (1 - share) sqrt(3) of the standard\n"
          "                   deviation of all heights\n"
          "  z z_own z_walls  mean contacts of a sphere: all, with its own\n"
          "                   class, with walls\n"
          "--profile: t z radius sum, a row for each slab and class. An empty\n"
          "line separates frames.\n"
          "--close: t spheres deviation skewness rods spread: of the radii, "
          "the\n"
          "standard deviation by the mean; what Farr and Groot (2009) expect "
          "of\n"
          "hard spheres of these radii without friction, and, for deviations\n"
          "up to 0.4, Desmond and Weeks (2014).",
      .usage = "mixture [OPTION...] [FILE...]",
      .example = "settle --sizes 'mix:0.1*0.3,0.05*0.7' | analyze mixture",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&set.box);
  if (set.close && set.slabs)
    die(EXIT_USAGE, "expected one of --close and --profile");
  for (size_t k = 0; k < set.edges.count; k++)
    if (!(set.edges.at[k] > (k ? set.edges.at[k - 1] : 0)))
      die(EXIT_USAGE, "--classes: expected ascending radii above 0");
  return tabulate(&input, means, argc, argv, operand, measure, &set);
}
