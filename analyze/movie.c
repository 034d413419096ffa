/* SPDX-License-Identifier: GPL-3.0-or-later */
/* movie: all frames as an animation of one view and one scale of colours. A
   GIF is put together by gnuplot, any other kind by ffmpeg. */
#include <stdlib.h>
#include <string.h>
#include "frames.h"
#include "picture.h"
#include "verbs.h"

/* Frames read, each in a file "K.tsv" of the scratch directory. */
static size_t read_frames(struct frames *frames, struct picture *picture) {
  struct bed bed = {0};
  size_t count = 0;
  while (frames_next(frames, &bed)) {
    char name[32];
    snprintf(name, sizeof name, "%zu.tsv", count++);
    picture_measure(picture, &bed, frames_header(frames));
    picture_write(picture, &bed, name);
  }
  return count;
}

static void draw_frames(struct picture *picture, size_t count) {
  progress_restart(&picture->progress);
  for (size_t k = 0; k < count; k++) {
    char data[32], name[32];
    snprintf(data, sizeof data, "%zu.tsv", k);
    snprintf(name, sizeof name, "%zu.png", k);
    const char *drawn = picture_path(picture, name);
    progress_name(&picture->progress, "frame %zu of %zu", k + 1, count);
    picture->done = (double)k / ((double)count + 1);
    picture_draw(picture, data, drawn);
  }
  picture->done = (double)count / ((double)count + 1);
}

int verb_movie(int argc, char **argv) {
  struct picture picture = {
      .color = "height", .view = {2, {30, 72}}, .facets = 40000};
  struct frames_options input = {0};
  const char *output = NULL;
  double rate = 25;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "output", .type = OPTION_TEXT, .value = &output,
       .help = "animation to write, .gif, .mp4 or .webm",
       .unit = "GIF to standard output without it"},
      {.name = "rate", .type = OPTION_DOUBLE, .value = &rate, .least = 1,
       .most = 100, .unit = "1/s", .help = "pictures per second"},
      PICTURE_OPTIONS(picture),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Draws all frames of a file as an animation, a GIF by gnuplot, "
          "the others by ffmpeg.",
      .usage = "movie [OPTION...] [FILE]",
      .example = "settle --frames 81 | analyze movie --output bed.gif",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  const bool gif = !output || ends_in(output, ".gif");
  if (!gif && !ends_in(output, ".mp4") && !ends_in(output, ".webm"))
    die(EXIT_USAGE,
        "--output %s: expected a name that ends in .gif, .mp4 or .webm",
        output);
  picture.half_size = gif;
  picture_begin(&picture, output, input.quiet);

  if (!gif) { /* say so before the work */
    const char *const version[] = {"ffmpeg", "-version", NULL};
    picture_run(&picture, "ffmpeg", version);
  }
  struct frames frames;
  frames_open(&frames, &input, argc, argv, operand);
  const size_t count = read_frames(&frames, &picture);
  picture_of(&picture, &frames);
  frames_close(&frames);
  draw_frames(&picture, count);

  const char *made =
      picture_path(&picture, gif                       ? "movie.gif"
                             : ends_in(output, ".mp4") ? "movie.mp4"
                                                       : "movie.webm");
  char number[32], numbers[32];
  if (gif) {
    char *script = picture_script("movie.gp");
    snprintf(number, sizeof number, "%zu", count);
    snprintf(numbers, sizeof numbers, "%.0f", 100 / rate);
    const char *const argv_gif[] = {
        "gnuplot", "-d",    "-c", script, picture.scratch,
        number,    numbers, made, NULL};
    picture_run(&picture, "gnuplot-nox", argv_gif);
    free(script);
  } else {
    const char *pictures = picture_path(&picture, "%d.png");
    snprintf(number, sizeof number, "%.9g", rate);
    const size_t size = strlen(picture.origin) + 16;
    char *const comment = malloc(size);
    if (!comment)
      die(EXIT_IO, "out of memory");
    snprintf(comment, size, "comment=%s", picture.origin);
    const char *const argv_video[] = {
        "ffmpeg", "-v",       "error",   "-framerate", number, "-i", pictures,
        "-pix_fmt", "yuv420p", "-metadata", comment,   made,   NULL};
    picture_run(&picture, "ffmpeg", argv_video);
    free(comment);
  }
  progress_end(&picture.progress);
  picture_deliver(&picture, made);
  return EXIT_DONE;
}
