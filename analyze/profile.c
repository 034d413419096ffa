/* SPDX-License-Identifier: GPL-3.0-or-later */
/* profile: solid fraction of planes across an axis, or of shells at a distance
   from side walls or from the axis of a cylinder; exact areas, as a sum and as
   a union. Rows are at the middles of equal parts, so that the mean of a column
   tends to the `fraction` of the box. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/area.h"
#include "frames.h"
#include "program/command_line.h"
#include "tabulate.h"
#include "verbs.h"

static const char *const axes[] = {"x", "y", "z", NULL};

/* Where the profile is taken. */
struct where {
  int axis, across[2]; /* the others in ascending order */
  double box[6];
  const double *cylinder; /* centre and radius, or NULL for the box */
  double wall;            /* largest distance from the wall; 0: no shells */
};

/* Areas covered, and of what. */
struct areas {
  double sum, united, all;
};

/* Adds the plane at `at` across an axis, within the box. discs: room for three
   numbers per sphere. */
static void add_plane(struct areas *areas, const struct frames *f,
                      const struct bed *b, int axis, double at,
                      const double box[6], double *discs) {
  const int p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
  const double rectangle[4] = {box[2 * p], box[2 * p + 1], box[2 * q],
                               box[2 * q + 1]};
  double *c = discs, *r = discs + 2 * b->n, united;
  size_t n = 0;
  for (size_t i = 0; i < b->n; i++) {
    const double *x = b->x + 3 * i, d = fabs(x[axis] - at);
    if (d >= b->r[i])
      continue;
    c[2 * n] = x[p];
    c[2 * n + 1] = x[q];
    r[n++] = sqrt((b->r[i] - d) * (b->r[i] + d));
  }
  frame_check(f, b, area_union(n, c, r, rectangle, &united));
  areas->sum += area_sum(n, c, r, rectangle);
  areas->united += united;
  areas->all += (rectangle[1] - rectangle[0]) * (rectangle[3] - rectangle[2]);
}

/* The side faces of the box once it has shrunk by the distance. */
static void add_box_shell(struct areas *areas, const struct frames *f,
                          const struct bed *b, const struct where *w,
                          double distance, double *discs) {
  double box[6];
  memcpy(box, w->box, sizeof box);
  for (int k = 0; k < 2; k++) {
    box[2 * w->across[k]] += distance;
    box[2 * w->across[k] + 1] -= distance;
  }
  for (int k = 0; k < 2; k++)
    for (int side = 0; side < 2; side++)
      add_plane(areas, f, b, w->across[k], box[2 * w->across[k] + side], box,
                discs);
}

/* rotated: room for three numbers per sphere. */
static void add_cylinder_shell(struct areas *areas, const struct frames *f,
                               const struct bed *b, const struct where *w,
                               double radius, double *rotated) {
  const struct area_shell shell = {
      {w->cylinder[0], w->cylinder[1]},
      radius,
      {w->box[2 * w->axis], w->box[2 * w->axis + 1]}};
  for (size_t i = 0; i < b->n; i++) {
    rotated[3 * i] = b->x[3 * i + (size_t)w->across[0]];
    rotated[3 * i + 1] = b->x[3 * i + (size_t)w->across[1]];
    rotated[3 * i + 2] = b->x[3 * i + (size_t)w->axis];
  }
  frame_check(f, b,
              area_shell_covered(b->n, rotated, b->r, &shell, &areas->sum,
                                 &areas->united));
  areas->all = 2 * M_PI * radius * (shell.z[1] - shell.z[0]);
}

static void print_profile(struct table *table, struct frames *f,
                          const struct bed *b, const struct where *w,
                          size_t points) {
  double *room = measure_alloc(b->n, 3 * sizeof *room);
  const double low = w->wall > 0 || w->cylinder ? 0 : w->box[2 * w->axis];
  const double high = w->wall > 0   ? w->wall
                      : w->cylinder ? w->cylinder[2]
                                    : w->box[2 * w->axis + 1];
  for (size_t k = 0; k < points; k++) {
    frames_tell(f, (double)k / (double)points);
    const double at = low + (high - low) * ((double)k + 0.5) / (double)points;
    struct areas areas = {0};
    if (w->cylinder)
      add_cylinder_shell(&areas, f, b, w,
                         w->wall > 0 ? w->cylinder[2] - at : at, room);
    else if (w->wall > 0)
      add_box_shell(&areas, f, b, w, at, room);
    else
      add_plane(&areas, f, b, w->axis, at, w->box, room);
    table_number(table, b->t);
    table_number(table, at);
    table_number(table, areas.sum / areas.all);
    table_number(table, areas.united / areas.all);
    table_end_row(table);
  }
  free(room);
}

/* --from-wall ends in the middle. */
static void check_wall(const struct where *w) {
  double widest = w->cylinder ? w->cylinder[2] : GSL_POSINF;
  for (int k = 0; k < 2 && !w->cylinder; k++) {
    const double *face = w->box + 2 * w->across[k];
    widest = fmin(widest, (face[1] - face[0]) / 2);
  }
  if (w->wall > widest)
    die(EXIT_USAGE, "--from-wall %g: expected at most %g, the middle", w->wall,
        widest);
}

/* All that reaches into what is measured, across periodic sides. */
static void add_images(struct tabulation *t, const struct where *w) {
  double box[6];
  memcpy(box, w->box, sizeof box);
  for (int k = 0; k < 2 && w->cylinder; k++) {
    box[2 * w->across[k]] = w->cylinder[k] - w->cylinder[2];
    box[2 * w->across[k] + 1] = w->cylinder[k] + w->cylinder[2];
  }
  frame_add_images(&t->frames, &t->bed, 1, (const double(*)[6])box);
}

int verb_profile(int argc, char **argv) {
  struct option_list box = {0}, cylinder = {0};
  const char *axis = "z";
  size_t points = 100;
  struct frames_options input = {.may_be_empty = true, .many = true};
  bool mean = false;
  struct where w = {0};
  /* clang-format off */
  struct option_spec options[] = {
      BOX_OPTION(box, "where" BASE_BOX),
      {.name = "axis", .type = OPTION_TEXT, .value = &axis, .choices = axes,
       .help = "axis along which, or around which, the profile is taken"},
      {.name = "from-wall", .type = OPTION_DOUBLE, .value = &w.wall,
       .least = 0, .most = OPTION_MANY, .unit = "m; 0: none",
       .help = "shells around the axis, up to this distance from the side "
               "walls"},
      {.name = "cylinder", .type = OPTION_LIST, .value = &cylinder,
       .least = 3, .most = 3, .unit = "m; across the axis, x before y before z",
       .help = "cx,cy,R of a cylinder, whose shells are taken from its axis "
               "to R"},
      {.name = "points", .type = OPTION_SIZE, .value = &points, .least = 1,
       .most = 1e8, .help = "rows per frame, at the middles of equal parts"},
      MEAN_OPTION(mean),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Solid fraction of planes across an axis of the box, or of shells "
          "about it:\ntime (s), place (m), sum of the spheres' areas and "
          "their union, each by the\narea. Exact. An empty line separates "
          "frames.",
      .usage = "profile [OPTION...] [FILE...]",
      .example = "settle | analyze profile --from-wall 0.4",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&box);
  w.axis = axis[0] - 'x';
  w.across[0] = w.axis == 0 ? 1 : 0;
  w.across[1] = w.axis == 2 ? 1 : 2;
  w.cylinder = cylinder.count ? cylinder.at : NULL;
  if (w.cylinder && !(w.cylinder[2] > 0))
    die(EXIT_USAGE, "--cylinder: expected a radius above 0");
  char names[40];
  snprintf(names, sizeof names, "t\t%s\tsum\tunion",
           w.wall > 0   ? "distance"
           : w.cylinder ? "radius"
                        : axis);
  struct tabulation t;
  tabulation_open(&t, &input, mean, argc, argv, operand);
  while (tabulation_next(&t)) {
    frame_choose_box(&t.frames, &box, w.box);
    check_wall(&w);
    add_images(&t, &w);
    box_watch_see(&t.watch, &t.frames, &t.bed, !box.count, 1,
                  (const double(*)[6])w.box);
    table_frame(&t.table, TABLE_PARTS, names);
    print_profile(&t.table, &t.frames, &t.bed, &w, points);
  }
  return tabulation_close(&t);
}
