/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hard: the fraction that beds of soft contacts would have with hard ones. */
#include <assert.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "measure/hard.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

/* Standard deviation of the union of one bed of 200 over seeds
   (docs/softness.md); that of others by the root of their number. */
static const double bed_deviation = 0.006, bed_spheres = 200;

/* From here on the law holds. */
static const double least_kr = 29;

struct beds {
  size_t count, size;
  double *kr, *share;
  double spheres;          /* of the last one */
  struct bed_header first; /* of the first bed */
  const char *differs;     /* a key of others that is not the first's */
};

static void *grown(void *p, size_t count) {
  p = realloc(p, count * sizeof(double));
  if (!p)
    die(EXIT_IO, "out of memory");
  return p;
}

/* Parameters that must not differ, since the law is one of kappa alone. */
static const char *const same[] = {"model", "friction", "restitution",
                                   "f0",    "vmin",     NULL};

static void compare(struct beds *s, const struct frames *f) {
  for (size_t k = 0; same[k] && !s->differs; k++) {
    const char *a = bed_header_get(&s->first, same[k]);
    const char *b = bed_header_get(frames_header(f), same[k]);
    if (a && b && strcmp(a, b))
      s->differs = same[k];
  }
}

/* The last frame of a bed counts: each takes the place of the one before. */
static void take(struct beds *s, struct tabulation *t,
                 const struct option_list *given) {
  struct frames *f = &t->frames;
  const struct bed *b = &t->bed;
  if (f->first && s->count++ == s->size) {
    s->size = 2 * s->count;
    s->kr = grown(s->kr, s->size);
    s->share = grown(s->share, s->size);
  }
  if (f->first && s->count == 1)
    s->first = frames_copy_header(f);
  compare(s, f);
  struct scene scene = frame_scene(f, b);
  assert(s->kr && s->count);
  s->kr[s->count - 1] = scene.law.kappa * bed_mean(b, b->r);
  s->share[s->count - 1] =
      frame_union((struct frames_part){f, 0, 1}, given, b, &t->watch);
  s->spheres = (double)b->n;
  scene_free(&scene);
}

static void print(struct tabulation *t, const struct beds *s,
                  const struct hard_limit *h) {
  assert(s->kr && s->count);
  double softest = s->kr[0], hardest = s->kr[0];
  for (size_t k = 1; k < s->count; k++) {
    softest = GSL_MIN(softest, s->kr[k]);
    hardest = GSL_MAX(hardest, s->kr[k]);
  }
  if (softest < least_kr)
    warn("kappa r = %.3g: the law holds from 30 on", softest);
  if (s->differs)
    warn("the beds differ in %s too, expected in kappa alone", s->differs);
  t->table.file = false; /* a row of all of them */
  table_frame(&t->table, TABLE_ROWS,
              "beds\tsoftest\thardest\tunion\tlow\thigh\tslope\tdeviation");
  table_count(&t->table, s->count);
  table_number(&t->table, softest);
  table_number(&t->table, hardest);
  table_number(&t->table, h->value);
  table_number(&t->table, h->low);
  table_number(&t->table, h->high);
  table_number(&t->table, h->slope);
  table_number(&t->table, h->deviation);
  table_end_row(&t->table);
}

int verb_hard(int argc, char **argv) {
  struct option_list given = {0};
  struct frames_options input = {.many = true, .scene = true};
  double deviation = 0;
  /* clang-format off */
  struct option_spec options[] = {
      BOX_OPTION(given, "for the fraction" BASE_BOX),
      {.name = "deviation", .type = OPTION_DOUBLE, .value = &deviation,
       .most = 1, .unit = "0: 0.006 by the root of spheres by 200",
       .help = "standard deviation of one bed, for two beds"},
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "The solid fraction that beds of soft contacts would have with hard\n"
          "ones, by union = U + c/(kappa r) through beds that differ in "
          "kappa:\n"
          "one row for all files, of each of which the last frame counts.\n"
          "  beds       how many\n"
          "  softest    least kappa r\n"
          "  hardest    largest kappa r\n"
          "  union      U\n"
          "  low, high  its 95 % interval\n"
          "  slope      c\n"
          "  deviation  standard deviation of a bed from the law; of two "
          "beds,\n"
          "             which have none, that of --deviation\n"
          "The law holds from kappa r = 30 on, for beds with the same F0, at\n"
          "the same time and in the same box. Several seeds of each kappa\n"
          "make the interval narrower.",
      .usage = "hard [OPTION...] FILE FILE...",
      .example = "analyze hard soft.tsv hard.tsv",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&given);
  struct beds beds = {0};
  struct tabulation t;
  tabulation_open(&t, &input, false, argc, argv, operand);
  while (tabulation_next(&t))
    take(&beds, &t, &given);
  if (!(deviation > 0))
    deviation = bed_deviation * sqrt(bed_spheres / beds.spheres);
  struct hard_limit h;
  const int status =
      hard_limit_fit(beds.count, beds.kr, beds.share, deviation, &h);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (status == GSL_EDOM)
    die(EXIT_INPUT, "all beds have kappa r = %g, expected different ones",
        beds.kr[0]);
  if (status != GSL_SUCCESS)
    die(EXIT_USAGE, "%zu bed, expected two or more of different kappa r",
        beds.count);
  print(&t, &beds, &h);
  bed_header_free(&beds.first);
  free(beds.kr);
  free(beds.share);
  return tabulation_close(&t);
}
