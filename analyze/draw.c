/* SPDX-License-Identifier: GPL-3.0-or-later */
/* draw: one frame as shaded balls in their box, by gnuplot. */
#include <math.h>
#include "frames.h"
#include "picture.h"
#include "verbs.h"

int verb_draw(int argc, char **argv) {
  struct picture picture = {.color = "height", .view = {2, {30, 72}}};
  struct frames_options input = {0};
  const char *output = NULL;
  double wanted = -1;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "output", .type = OPTION_TEXT, .value = &output,
       .help = "picture to write, .png or .svg",
       .unit = "PNG to standard output without it"},
      {.name = "frame", .type = OPTION_DOUBLE, .value = &wanted,
       .most = OPTION_MANY, .unit = "counted from 0",
       .help = "frame to draw, the last one without it"},
      PICTURE_OPTIONS(picture),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary = "Draws one frame of a bed through gnuplot: shaded balls in "
                 "their box, which is\nthe walls along the axes or else what "
                 "the balls take up.",
      .usage = "draw [OPTION...] [FILE]",
      .example = "settle | analyze draw --output bed.png",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  const bool svg = output && ends_in(output, ".svg");
  if (output && !svg && !ends_in(output, ".png"))
    die(EXIT_USAGE, "--output %s: expected a name that ends in .png or .svg",
        output);
  if (wanted != floor(wanted))
    die(EXIT_USAGE, "--frame %g: expected a whole number", wanted);
  picture.facets = svg ? 30000 : 120000;
  picture_begin(&picture, output, input.quiet);

  struct frames frames;
  struct bed bed = {0}, next = {0};
  size_t count = 0;
  frames_open(&frames, &input, argc, argv, operand);
  while ((double)count != wanted + 1 || wanted < 0) {
    if (!frames_next(&frames, &next))
      break;
    bed_free(&bed);
    bed = next;
    next = (struct bed){0};
    count++;
  }
  if (wanted >= 0 && (double)count != wanted + 1)
    die(EXIT_INPUT, "--frame %g: there are frames 0 to %zu", wanted, count - 1);
  picture_measure(&picture, &bed, frames_header(&frames));
  picture_write(&picture, &bed, "bed.tsv");
  bed_free(&bed);
  picture_of(&picture, &frames);
  frames_close(&frames);

  const char *drawn = picture_path(&picture, svg ? "bed.svg" : "bed.png");
  progress_name(&picture.progress, "gnuplot draws");
  picture_draw(&picture, "bed.tsv", drawn);
  progress_end(&picture.progress);
  picture_deliver(&picture, drawn);
  return EXIT_DONE;
}
