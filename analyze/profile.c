/* SPDX-License-Identifier: GPL-3.0-or-later */
/* profile: solid fraction of planes across an axis, or of shells at a distance
   from side walls or from the axis of a cylinder, the bed's own tube among
   them; exact areas, as a sum and as a union. Rows are at the middles of equal
   parts, so that the mean of a column, weighed by the area, tends to the
   `fraction`. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/area.h"
#include "geometry/vec3.h"
#include "frames.h"
#include "program/command_line.h"
#include "tabulate.h"
#include "verbs.h"

static const char *const axes[] = {"x", "y", "z", NULL};

/* A cylinder: its radius (0: none), a point on its axis, and directions across
   it and along it. Ends are distances from the point along the axis. */
struct tube {
  double radius, point[3], turn[3][3], ends[2];
};

/* Where the profile is taken. */
struct where {
  int axis, across[2]; /* the others in ascending order */
  double box[6];
  struct tube tube; /* or the box */
  double wall;      /* largest distance from the wall; 0: no shells */
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

/* turned: room for three numbers per sphere. */
static void add_tube_shell(struct areas *areas, const struct frames *f,
                           const struct bed *b, const struct tube *tube,
                           double radius, double *turned) {
  const struct area_shell shell = {
      {0, 0}, radius, {tube->ends[0], tube->ends[1]}};
  for (size_t i = 0; i < b->n; i++) {
    double d[3];
    vec3_sub(b->x + 3 * i, tube->point, d);
    for (size_t k = 0; k < 3; k++)
      turned[3 * i + k] = vec3_dot(tube->turn[k], d);
  }
  frame_check(f, b,
              area_shell_covered(b->n, turned, b->r, &shell, &areas->sum,
                                 &areas->united));
  areas->all = 2 * M_PI * radius * (shell.z[1] - shell.z[0]);
}

static void print_profile(struct table *table, struct frames *f,
                          const struct bed *b, const struct where *w,
                          size_t points) {
  double *room = measure_alloc(b->n, 3 * sizeof *room);
  const double tube = w->tube.radius;
  const double low = w->wall > 0 || tube > 0 ? 0 : w->box[2 * w->axis];
  const double high = w->wall > 0 ? w->wall
                      : tube > 0  ? tube
                                  : w->box[2 * w->axis + 1];
  for (size_t k = 0; k < points; k++) {
    frames_tell(f, (double)k / (double)points);
    const double at = low + (high - low) * ((double)k + 0.5) / (double)points;
    struct areas areas = {0};
    if (tube > 0)
      add_tube_shell(&areas, f, b, &w->tube, w->wall > 0 ? tube - at : at,
                     room);
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
  double widest = w->tube.radius;
  if (!(widest > 0)) {
    widest = GSL_POSINF;
    for (int k = 0; k < 2; k++) {
      const double *face = w->box + 2 * w->across[k];
      widest = fmin(widest, (face[1] - face[0]) / 2);
    }
  }
  if (w->wall > widest)
    die(EXIT_USAGE, "--from-wall %g: expected at most %g, the middle", w->wall,
        widest);
}

/* The cylinder of --cylinder, which goes through the box along an axis of it.
 */
static struct tube tube_in_box(const struct where *w,
                               const double cylinder[3]) {
  struct tube tube = {.radius = cylinder[2]};
  const int axes_of[3] = {w->across[0], w->across[1], w->axis};
  for (int k = 0; k < 3; k++)
    tube.turn[k][axes_of[k]] = 1;
  for (int k = 0; k < 2; k++) {
    tube.point[w->across[k]] = cylinder[k];
    tube.ends[k] = w->box[2 * w->axis + k];
  }
  return tube;
}

/* Two directions across a third, and that one. */
static void make_turn(const double axis[3], double turn[3][3]) {
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(axis[k]) < fabs(axis[least]))
      least = k;
  double side[3] = {0};
  side[least] = 1;
  vec3_axpy(-axis[least], axis, side);
  const double length = vec3_norm(side);
  for (int k = 0; k < 3; k++) {
    turn[0][k] = side[k] / length;
    turn[2][k] = axis[k];
  }
  vec3_cross(axis, turn[0], turn[1]);
}

/* The bed's own. along: ends, or without numbers. */
static struct tube tube_of_bed(const struct frames *f, const struct bed *b,
                               const struct option_list *along) {
  struct scene s = frame_scene(f, b);
  size_t count;
  const struct wall *wall = scene_tube(&s, &count);
  if (count > 1)
    frame_refuse(f, b,
                 "--radial: the header has several cylinders, expected one");
  if (!wall)
    frame_refuse(f, b,
                 "--radial: the header has no cylinder, expected "
                 "--cylinder instead");
  struct tube tube = {.radius = wall->radius};
  memcpy(tube.point, wall->point, sizeof tube.point);
  make_turn(wall->normal, tube.turn);
  double box[6];
  if (along->count) {
    memcpy(tube.ends, along->at, sizeof tube.ends);
  } else {
    if (!frame_base_box(frames_header(f), box))
      frame_refuse(f, b,
                   "--radial: the tube does not stand on a floor, "
                   "expected --along");
    const double up = wall->normal[2] > 0 ? 1 : -1;
    for (int k = 0; k < 2; k++)
      tube.ends[up > 0 ? k : 1 - k] = up * (box[4 + k] - tube.point[2]);
  }
  scene_free(&s);
  return tube;
}

/* The box around a tube. */
static void box_of_tube(const struct tube *tube, double box[6]) {
  const double *axis = tube->turn[2];
  for (int k = 0; k < 3; k++) {
    const double side = tube->radius * sqrt(fmax(0, 1 - axis[k] * axis[k]));
    const double a = tube->point[k] + tube->ends[0] * axis[k];
    const double b = tube->point[k] + tube->ends[1] * axis[k];
    box[2 * k] = fmin(a, b) - side;
    box[2 * k + 1] = fmax(a, b) + side;
  }
}

int verb_profile(int argc, char **argv) {
  struct option_list box = {0}, cylinder = {0}, along = {0};
  bool radial = false;
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
      {.name = "radial", .type = OPTION_FLAG, .value = &radial,
       .help = "shells of the bed's own tube, whatever its direction"},
      {.name = "along", .type = OPTION_LIST, .value = &along, .least = 2,
       .most = 2, .unit = "m along the axis, from the point of `# cylinder=`",
       .help = "ends of --radial's shells; else, on a floor, those of the "
               "bottom cube"},
      {.name = "points", .type = OPTION_SIZE, .value = &points, .least = 1,
       .most = 1e8, .help = "rows per frame, at the middles of equal parts"},
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Solid fraction of planes across an axis of the box, or of shells "
          "about it:\ntime (s), place (m), sum of the spheres' areas and "
          "their union, each by the\narea. Exact. An empty line separates "
          "frames.\n"
          "The mean of planes is the fraction of the box; that of shells of a "
          "cylinder,\nweighed by the radius, the fraction of the cylinder.",
      .usage = "profile [OPTION...] [FILE...]",
      .example = "settle | analyze profile --from-wall 0.4",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&box);
  w.axis = axis[0] - 'x';
  w.across[0] = w.axis == 0 ? 1 : 0;
  w.across[1] = w.axis == 2 ? 1 : 2;
  if (cylinder.count && !(cylinder.at[2] > 0))
    die(EXIT_USAGE, "--cylinder: expected a radius above 0");
  if (radial &&
      (cylinder.count || box.count || option_find(options, "axis")->given))
    die(EXIT_USAGE,
        "--radial: expected no --cylinder, --box or --axis beside it");
  if (along.count && !radial)
    die(EXIT_USAGE, "--along: expected --radial beside it");
  if (along.count && !(along.at[0] < along.at[1]))
    die(EXIT_USAGE, "--along: expected the lower end first");
  char names[40];
  snprintf(names, sizeof names, "t\t%s\tsum\tunion",
           w.wall > 0                 ? "distance"
           : cylinder.count || radial ? "radius"
                                      : axis);
  struct tabulation t;
  tabulation_open(&t, &input, mean, argc, argv, operand);
  while (tabulation_next(&t)) {
    frame_choose_box(&t.frames, &box, w.box);
    if (cylinder.count)
      w.tube = tube_in_box(&w, cylinder.at);
    if (radial)
      w.tube = tube_of_bed(&t.frames, &t.bed, &along);
    if (w.tube.radius > 0)
      box_of_tube(&w.tube, w.box);
    check_wall(&w);
    frame_add_images(&t.frames, &t.bed, 1, (const double(*)[6])w.box);
    box_watch_see(&t.watch, &t.frames, &t.bed, !box.count && !radial, 1,
                  (const double(*)[6])w.box);
    table_frame(&t.table, TABLE_PARTS, names);
    print_profile(&t.table, &t.frames, &t.bed, &w, points);
  }
  return tabulation_close(&t);
}
