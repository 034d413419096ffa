/* SPDX-License-Identifier: GPL-3.0-or-later */
/* regions: |R(z)| of each method on a grid of the complex plane, R by applying
   the stepper itself to y' = lambda y as a real system of two. One block per
   method, upper half plane only: R of the conjugate is the conjugate. */
#include <math.h>
#include <stdio.h>
#include <gsl/gsl_errno.h>
#include "program/shared_options.h"
#include "stepper.h"
#include "verbs.h"

int verb_regions(int argc, char **argv) {
  size_t points = 241;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "points", .type = OPTION_SIZE, .value = &points, .least = 2,
       .most = 10000, .help = "of the grid in each direction"},
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "stability",
      .summary =
          "|R(z)| of each method on a grid, one block per method: re, im, "
          "modulus.",
      .usage = "regions [OPTION...]",
      .example = "stability regions > regions.tsv",
      .options = options};
  verb_begin(&program, argc, argv);
  static const struct {
    struct stepper_kind kind;
    double left, right, top;
  } grids[] = {{{"merson", 0}, -6, 2, 6}, {{"dopri5", 0}, -6, 2, 6},
               {{"rkf45", 0}, -6, 2, 6},  {{"rkck", 0}, -6, 2, 6},
               {{"rk8pd", 0}, -6, 2, 6},  {{"rkc", 5}, -70, 5, 15},
               {{"rkc", 10}, -70, 5, 15}};
  for (size_t g = 0; g < sizeof grids / sizeof *grids; g++) {
    char name[32];
    stepper_name(grids[g].kind, name);
    printf("%smethod\tre\tim\tmodulus\n", g ? "\n\n" : "");
    for (size_t j = 0; j < points; j++) {
      const double im = grids[g].top * (double)j / (double)(points - 1);
      for (size_t i = 0; i < points; i++) {
        const double re = grids[g].left + (grids[g].right - grids[g].left) *
                                              (double)i / (double)(points - 1);
        double r[2];
        const int status = stepper_factor(grids[g].kind, re, im, r);
        if (status != GSL_SUCCESS)
          die_status(status, "%s", name);
        printf("%s\t%.6g\t%.6g\t%.6g\n", name, re, im, hypot(r[0], r[1]));
      }
      if (j + 1 < points)
        putchar('\n');
    }
  }
  return EXIT_DONE;
}
