/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fraction: share of boxes that the spheres fill, as the sum of the clipped
   spheres (the paper's count) and as their union. Exact; --sampled adds the
   paper's count on midpoints. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "program/files.h"
#include "frames.h"
#include "program/command_line.h"
#include "tabulate.h"
#include "verbs.h"
#include "geometry/volume.h"

struct boxes {
  size_t count, size;
  double (*at)[6];
};

static void boxes_add(struct boxes *boxes, const double box[6]) {
  if (boxes->count == boxes->size) {
    boxes->size = 2 * boxes->size + 16;
    boxes->at = realloc(boxes->at, boxes->size * sizeof *boxes->at);
    if (!boxes->at)
      die(EXIT_IO, "out of memory");
  }
  memcpy(boxes->at[boxes->count++], box, 6 * sizeof *box);
}

/* Six numbers per line; # begins a comment. */
static void read_boxes(struct boxes *boxes, const char *path) {
  struct input in;
  input_open(&in, path);
  char *line = NULL;
  size_t size = 0, number = 0;
  while (getline(&line, &size, in.stream) >= 0) {
    double box[6];
    int words = 0;
    bool numbers = true;
    number++;
    line[strcspn(line, "#\r\n")] = 0;
    char *rest = line;
    for (char *word; (word = strtok_r(rest, " \t", &rest)); words++)
      numbers = numbers && words < 6 && number_parse(word, &box[words]);
    if (words == 0)
      continue;
    if (!numbers || words != 6)
      die(EXIT_INPUT, "%s:%zu: expected six numbers x0 x1 y0 y1 z0 z1", in.name,
          number);
    if (!box_valid(box))
      die(EXIT_INPUT, "%s:%zu: expected x0 < x1, y0 < y1, z0 < z1", in.name,
          number);
    boxes_add(boxes, box);
  }
  if (ferror(in.stream))
    die(EXIT_IO, "%s: read error", in.name);
  if (!boxes->count)
    die(EXIT_INPUT, "%s: no boxes, expected lines of x0 x1 y0 y1 z0 z1",
        in.name);
  free(line);
  input_close(&in);
}

enum { MOST_SLABS = 1000000 };

/* Cuts a box into slabs of a height, the last one lower where it must be. */
static void cut_slabs(struct boxes *boxes, const double box[6], double height) {
  /* a rounding error of the quotient is no slab */
  const double slabs = fmax(1, ceil((box[5] - box[4]) / height - 1e-9));
  if (!(slabs <= MOST_SLABS))
    die(EXIT_USAGE, "--slab %g: expected at most %d slabs", height, MOST_SLABS);
  double slab[6];
  memcpy(slab, box, sizeof slab);
  for (size_t k = 0; k < (size_t)slabs; k++) {
    slab[4] = box[4] + (double)k * height;
    slab[5] =
        k + 1 < (size_t)slabs ? box[4] + (double)(k + 1) * height : box[5];
    boxes_add(boxes, slab);
  }
}

/* The columns of a row besides the time. */
struct shown {
  bool box, empty; /* the box's faces, the void fraction */
  size_t sampled;
};

static void set_names(const struct shown *c, char *names, size_t size) {
  snprintf(names, size, "t%s\tsum\tunion%s%s",
           c->box ? "\tx0\tx1\ty0\ty1\tz0\tz1" : "", c->empty ? "\tvoid" : "",
           c->sampled ? "\tsampled_sum\tsampled_union" : "");
}

/* Box k of count. */
static void print_row(struct table *table, struct frames *f,
                      const struct bed *bed, size_t k, size_t count,
                      const double box[6], const struct shown *c) {
  const double volume = box_volume(box);
  double united, sampled_sum, sampled_union;
  /* marks take the time where there are any */
  const double from = (double)k / (double)count, step = 1 / (double)count;
  const double middle = from + (c->sampled ? 0.2 : 1) * step;
  struct frames_part exact = {f, from, middle},
                     marks = {f, middle, from + step};
  const struct observer told = frames_observer(&exact),
                        marked = frames_observer(&marks);
  int status = volume_union_told(bed->n, bed->x, bed->r, box, &told, &united);
  if (status == GSL_SUCCESS && c->sampled)
    status = volume_sampled(bed->n, bed->x, bed->r, box, c->sampled, &marked,
                            &sampled_sum, &sampled_union);
  frame_check(f, bed, status);
  table_number(table, bed->t);
  for (int face = 0; face < 6 && c->box; face++)
    table_number(table, box[face]);
  table_number(table, volume_sum(bed->n, bed->x, bed->r, box) / volume);
  table_number(table, united / volume);
  if (c->empty)
    table_number(table, 1 - united / volume);
  if (c->sampled) {
    table_number(table, sampled_sum / volume);
    table_number(table, sampled_union / volume);
  }
  table_end_row(table);
}

static size_t smallest(const struct boxes *boxes) {
  size_t least = 0;
  for (size_t k = 1; k < boxes->count; k++)
    if (box_volume(boxes->at[k]) < box_volume(boxes->at[least]))
      least = k;
  return least;
}

/* The boxes of a frame by options: the whole box or slabs of it. */
static void choose_boxes(struct boxes *boxes, const struct frames *f,
                         const struct option_list *given, double until,
                         double slab) {
  double box[6];
  frame_choose_box(f, given, box);
  if (!isnan(until))
    box[5] = until;
  if (!box_valid(box))
    die(EXIT_USAGE, "--until %g: expected z0 < z1, and z0 is %g", until,
        box[4]);
  boxes->count = 0;
  if (slab > 0)
    cut_slabs(boxes, box, slab);
  else
    boxes_add(boxes, box);
}

int verb_fraction(int argc, char **argv) {
  struct option_list box = {0};
  struct shown columns = {0};
  const char *boxes_file = NULL;
  double until = GSL_NAN, slab = 0;
  struct frames_options input = {.may_be_empty = true, .many = true};
  bool mean = false;
  /* clang-format off */
  struct option_spec options[] = {
      BOX_OPTION(box, "where" BASE_BOX),
      {.name = "boxes", .type = OPTION_TEXT, .value = &boxes_file,
       .unit = "one row per box, with its faces",
       .help = "file of boxes instead, lines of x0 x1 y0 y1 z0 z1 in m"},
      {.name = "until", .type = OPTION_DOUBLE, .value = &until,
       .least = -1e12, .most = 1e12, .unit = "m",
       .help = "the box ends at this height instead of z1"},
      {.name = "slab", .type = OPTION_DOUBLE, .value = &slab, .least = 0,
       .most = OPTION_MANY, .unit = "m; 0: whole",
       .help = "cut the box into slabs of this height, one row per slab"},
      {.name = "void", .type = OPTION_FLAG, .value = &columns.empty,
       .help = "add the void fraction, 1 - union"},
      {.name = "sampled", .type = OPTION_SIZE, .value = &columns.sampled,
       .most = 4096, .unit = "0: none",
       .help = "count N^3 midpoints as well"},
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  char summary[1200], formats[800];
  frames_formats(formats, sizeof formats);
  snprintf(
      summary, sizeof summary,
      "Share of a box that the spheres fill, one row per frame: time (s),\n"
      "sum of the volumes of the clipped spheres and volume of their\n"
      "union, each divided by that of the box. With many boxes or slabs\n"
      "an empty line separates frames. All verbs read, by content:%s\n"
      "packed by gzip, xz or zstd, too.",
      formats);
  const struct program program = {.name = "analyze",
                                  .summary = summary,
                                  .usage = "[fraction] [OPTION...] [FILE...]",
                                  .example =
                                      "settle --model basic --seed 3 | analyze",
                                  .options = options};
  const int operand = options_parse(&program, argc, argv);
  if (boxes_file && (option_find(options, "box")->given ||
                     option_find(options, "until")->given ||
                     option_find(options, "slab")->given))
    die(EXIT_USAGE, "--boxes: expected no --box, --until or --slab beside it");
  if (box.count && !isnan(until))
    box.at[5] = until;
  box_check(&box);
  struct boxes boxes = {0};
  if (boxes_file)
    read_boxes(&boxes, boxes_file);
  columns.box = boxes_file || slab > 0;

  char names[120];
  set_names(&columns, names, sizeof names);
  struct tabulation t;
  tabulation_open(&t, &input, mean, argc, argv, operand);
  while (tabulation_next(&t)) {
    if (!boxes_file)
      choose_boxes(&boxes, &t.frames, &box, until, slab);
    frame_add_images(&t.frames, &t.bed, boxes.count,
                     (const double(*)[6])boxes.at);
    box_watch_see(&t.watch, &t.frames, &t.bed, !boxes_file && !box.count,
                  boxes.count, (const double(*)[6])boxes.at);
    frame_check_box(&t.frames, &t.bed, boxes.at[smallest(&boxes)]);
    table_frame(&t.table, columns.box ? TABLE_PARTS : TABLE_ROWS, names);
    for (size_t k = 0; k < boxes.count; k++)
      print_row(&t.table, &t.frames, &t.bed, k, boxes.count, boxes.at[k],
                &columns);
  }
  free(boxes.at);
  return tabulation_close(&t);
}
