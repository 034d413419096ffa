/* fraction: share of a box that the spheres fill, as the sum of the clipped
   spheres (the paper's count) and as their union. Exact; --sampled adds the
   paper's count on midpoints. */
#include <stdio.h>
#include <gsl/gsl_errno.h>
#include "frames.h"
#include "options.h"
#include "verbs.h"
#include "volume.h"

int verb_fraction(int argc, char **argv) {
  struct option_list box = {6, {0, 1, 0, 1, 0, 1}};
  size_t sampled = 0;
  struct frames_options input = {.may_be_empty = true};
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "box", .type = OPTION_LIST, .value = &box, .least = 6,
       .most = 6, .unit = "m", .help = "x0,x1,y0,y1,z0,z1"},
      {.name = "sampled", .type = OPTION_SIZE, .value = &sampled,
       .most = 4096, .unit = "0: none",
       .help = "count N^3 midpoints as well"},
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Volume fraction of spheres in a box, one row a frame: time (s),\n"
          "sum of the clipped spheres and their union, each by the box.\n"
          "Verbs: fraction, contacts, rest, gr, order; analyze VERB --help.",
      .usage = "[fraction] [OPTION...] [FILE]",
      .example = "settle --model basic --seed 3 | analyze",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  const double *b = box.at;
  const double volume = (b[1] - b[0]) * (b[3] - b[2]) * (b[5] - b[4]);
  if (!(b[1] > b[0] && b[3] > b[2] && b[5] > b[4]) || !(volume > 0))
    die(EXIT_USAGE, "--box: expected x0 < x1, y0 < y1, z0 < z1");

  struct frames frames;
  struct bed bed = {0};
  frames_open(&frames, &input, argc, argv, operand);
  for (bool first = true; frames_next(&frames, &bed); first = false) {
    double united, sampled_sum, sampled_union;
    if (volume_union(bed.n, bed.x, bed.r, b, &united) != GSL_SUCCESS)
      die(EXIT_IO, "t=%g: out of memory", bed.t);
    if (sampled && volume_sampled(bed.n, bed.x, bed.r, b, sampled, &sampled_sum,
                                  &sampled_union) != GSL_SUCCESS)
      die(EXIT_IO, "t=%g: out of memory", bed.t);
    if (first)
      printf("t\tsum\tunion%s\n",
             sampled ? "\tsampled_sum\tsampled_union" : "");
    printf("%.17g\t%.17g\t%.17g", bed.t,
           volume_sum(bed.n, bed.x, bed.r, b) / volume, united / volume);
    if (sampled)
      printf("\t%.17g\t%.17g", sampled_sum / volume, sampled_union / volume);
    putchar('\n');
  }
  frames_close(&frames);
  finish_output();
  return EXIT_DONE;
}
