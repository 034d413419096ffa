/* SPDX-License-Identifier: GPL-3.0-or-later */
/* radius: rewrites a bed with another radius of the geometry, or reports the
   fractions and overlaps that each choice gives. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/box.h"
#include "frames.h"
#include "measure.h"
#include "program/command_line.h"
#include "files/radius_keys.h"
#include "measure/radius.h"
#include "table.h"
#include "verbs.h"

static const char *const measures[] = {"union", "sum", NULL};

enum choice { NOMINAL, CONTACT_MEAN, TOUCHING, FRACTION, CHOICES };

struct settings {
  enum choice keep;
  const char *keep_text;
  double fraction, box[6];
  bool sum;
};

/* The quantities that are measured of a frame at one radius. */
struct measured {
  double r, sum, united;
  struct radius_overlaps overlaps;
};

static void set_keep(struct settings *s) {
  const char *const names[] = {"nominal", "contact-mean", "touching"};
  const char *text = s->keep_text;
  for (s->keep = NOMINAL; s->keep < FRACTION; s->keep++)
    if (!strcmp(text, names[s->keep]))
      return;
  if (strncmp(text, "fraction=", 9) || !number_parse(text + 9, &s->fraction) ||
      !(s->fraction > 0) || (!s->sum && s->fraction >= 1))
    die(EXIT_USAGE,
        "--keep %s: expected nominal, contact-mean, touching or fraction=F "
        "with F above 0%s",
        text, s->sum ? "" : " and below 1");
}

/* The radius of a choice; NaN if there is none. */
static double choose(const struct settings *s, struct frames_part part,
                     enum choice choice, const struct scene *walls,
                     const struct bed *b, double nominal) {
  const struct observer told = frames_observer(&part);
  double r = GSL_NAN;
  int status = GSL_SUCCESS;
  if (choice == NOMINAL)
    r = nominal;
  else if (choice == TOUCHING)
    status = radius_touching(walls, b->n, b->x, &r);
  else if (choice == CONTACT_MEAN)
    status = radius_contact_mean(walls, b->n, b->x, nominal, &r);
  else
    status = radius_of_fraction(walls, b->n, b->x, s->box, s->fraction, s->sum,
                                &told, &r);
  if (status != GSL_EDOM)
    frame_check(part.frames, b, status);
  return r;
}

static struct measured measure(const struct settings *s,
                               struct frames_part part,
                               const struct scene *walls, const struct bed *b,
                               double r) {
  const struct frames *f = part.frames;
  const struct observer told = frames_observer(&part);
  struct measured m = {.r = r};
  const double *box = s->box, volume = box_volume(box);
  frame_check(
      f, b, radius_volume(walls, b->n, b->x, box, r, false, &told, &m.united));
  frame_check(f, b,
              radius_volume(walls, b->n, b->x, box, r, true, NULL, &m.sum));
  frame_check(f, b, radius_overlaps(walls, b->n, b->x, r, &m.overlaps));
  m.sum /= volume;
  m.united /= volume;
  return m;
}

static void print_report(struct table *table, const struct settings *s,
                         struct frames *f, const struct scene *walls,
                         const struct bed *b, double nominal) {
  char last[40];
  snprintf(last, sizeof last, "fraction=%g", s->fraction);
  const char *const names[CHOICES] = {"nominal", "contact-mean", "touching",
                                      last};
  for (enum choice c = 0; c < CHOICES; c++) {
    /* the root that a fraction is takes most of the time */
    const double from = 0.05 * (int)c, found = c == FRACTION ? 0.95 : from;
    const double r =
        choose(s, (struct frames_part){f, from, found}, c, walls, b, nominal);
    table_number(table, b->t);
    table_text(table, names[c]);
    struct measured m = {.r = GSL_NAN};
    if (!isnan(r))
      m = measure(s, (struct frames_part){f, found, found + 0.05}, walls, b, r);
    const double numbers[] = {m.r,
                              m.sum,
                              m.united,
                              (double)m.overlaps.count,
                              m.overlaps.mean,
                              m.overlaps.largest};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
      table_number(table, isnan(r) ? GSL_NAN : numbers[k]);
    table_end_row(table);
  }
}

/* Rewrites the frame and reports the effect. False where the frame has no such
   radius, as one without contacts: it stays nominal. */
static bool rewrite(const struct settings *s, struct frames *f,
                    const struct scene *walls, struct bed *b,
                    struct bed_header *h, double nominal, bool quiet) {
  const double was = b->r[0];
  double r =
      choose(s, (struct frames_part){f, 0, 0.9}, s->keep, walls, b, nominal);
  const bool found = !isnan(r);
  if (!found)
    r = nominal;
  /* said in every frame, since keys stay until they are changed */
  const char *why = s->keep == NOMINAL ? NULL
                    : found            ? s->keep_text
                                       : "nominal";
  if (radius_rewrite(b, h, r, why) != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
  if (quiet || !found)
    return found;
  const struct measured m =
      measure(s, (struct frames_part){f, 0.9, 1}, walls, b, r);
  warn("t=%g: radius %g m, was %g; sum %.5f, union %.5f; %zu overlaps, mean "
       "%.3g and largest %.3g diameters",
       b->t, r, was, m.sum, m.united, m.overlaps.count, m.overlaps.mean,
       m.overlaps.largest);
  return found;
}

/* Frames that have no such radius. */
struct lacking {
  size_t frames, all;
  double first; /* t */
};

static void lacking_end(const struct lacking *l, const struct settings *s,
                        const char *name) {
  if (!l->frames)
    return;
  char others[60] = "";
  if (l->frames > 1)
    snprintf(others, sizeof others, " and %zu frames more", l->frames - 1);
  if (l->frames == l->all)
    die(EXIT_INPUT, "%s: t=%g%s: there is no radius for --keep %.40s", name,
        l->first, others, s->keep_text);
  warn("%s: t=%g%s: there is no radius for --keep %.40s, nominal is kept", name,
       l->first, others, s->keep_text);
}

/* The radius that the dynamics had, all spheres of one. */
static double nominal_radius(const struct frames *f, const struct bed *b) {
  for (size_t i = 1; i < b->n; i++)
    if (b->r[i] != b->r[0])
      frame_refuse(f, b, "spheres of several radii, expected one radius");
  const double r = radius_dynamics(frames_header(f));
  if (r < 0)
    frame_refuse(f, b, "radius_dynamics: expected a number above 0");
  return r > 0 ? r : b->r[0];
}

static bool turns(const struct bed *b) {
  for (size_t i = 0; i < 3 * b->n; i++)
    if (b->w[i] != 0)
      return true;
  return false;
}

int verb_radius(int argc, char **argv) {
  struct option_list box = {0};
  struct settings s = {.keep_text = "nominal", .fraction = 0.64};
  const char *of = "union";
  struct lacking lacking = {0};
  bool report = false;
  struct frames_options input = {0};
  bool mean = false;
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "keep", .type = OPTION_TEXT, .value = &s.keep_text,
       .unit = "contact-mean, touching or fraction=F",
       .help = "what decides the radius: nominal"},
      {.name = "of", .type = OPTION_TEXT, .value = &of, .choices = measures,
       .help = "fraction that fraction=F sets"},
      BOX_OPTION(box, "of fractions" BASE_BOX),
      {.name = "report", .type = OPTION_FLAG, .value = &report,
       .help = "a table of the effect of each choice, instead of the bed"},
      MEAN_OPTION(mean),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Rewrites a bed with another radius of its geometry, each frame with "
          "its own:\n"
          "  nominal       the radius of the dynamics\n"
          "  contact-mean  the mean gap of pairs and walls that overlap at the "
          "nominal\n"
          "                radius is 0\n"
          "  touching      the largest without any overlap, walls included\n"
          "  fraction=F    the spheres fill F of the box\n"
          "A frame without such a radius, as one without contacts, keeps its "
          "nominal one.\n"
          "The dynamics' radius stays in the header as radius_dynamics; settle "
          "goes on\n"
          "from that. Overlaps are in diameters.",
      .usage = "radius [OPTION...] [FILE]",
      .example = "settle | analyze radius --keep contact-mean > geometry.tsv",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&box);
  s.sum = !strcmp(of, "sum");
  set_keep(&s);

  struct frames frames;
  struct bed bed = {0};
  struct box_watch watch = {0};
  if (mean && !report)
    die(EXIT_USAGE, "--mean: expected --report beside it");
  input.many = report;
  frames_open(&frames, &input, argc, argv, operand);
  struct table table;
  table_open(&table, &frames, mean);
  for (bool first = true; frames_next(&frames, &bed); first = false) {
    struct bed_header header = frames_copy_header(&frames);
    struct scene walls = frame_scene(&frames, &bed);
    const double nominal = nominal_radius(&frames, &bed);
    frame_choose_box(&frames, &box, s.box);
    box_watch_see(&watch, &frames, &bed, !box.count, 1,
                  (const double(*)[6])s.box);
    frame_check_box(&frames, &bed, s.box);
    if (report) {
      table_frame(&table, TABLE_PARTS,
                  "t\tkeep\tradius\tsum\tunion\toverlaps\tmean_overlap\t"
                  "largest_overlap");
      print_report(&table, &s, &frames, &walls, &bed, nominal);
    } else {
      lacking.all++;
      if (!rewrite(&s, &frames, &walls, &bed, &header, nominal, input.quiet) &&
          lacking.frames++ == 0)
        lacking.first = bed.t;
      if (!first)
        bed_write_gap(stdout);
      bed_write_frame(stdout, &header, &bed, turns(&bed));
    }
    scene_free(&walls);
    bed_header_free(&header);
  }
  table_close(&table);
  lacking_end(&lacking, &s, frames.name);
  if (!report)
    bed_write_status(stdout, frames_status(&frames));
  box_watch_end(&watch);
  frames_close(&frames);
  finish_output();
  return EXIT_DONE;
}
