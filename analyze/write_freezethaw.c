/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's solver of freezing and thawing, PorousFreezeThaw. It opens
   data/spheres_positions.txt and scans three numbers at a time until that
   fails, for at most 1000 spheres: bare centres, those of a bed whose base has
   the side 1. The rest it takes from its file Params, lines of a name and an
   expression: places are beads_scaling times the number plus an offset, and all
   spheres have the same radius. Its solid is a phase field at cell centres, the
   largest over the spheres of (1 - tanh((|x - b| - r)/(2 xi_gl)))/2. */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "geometry/solid.h"
#include "measure.h"
#include "program/files.h"
#include "writers.h"

enum { MOST_BALLS = 1000 }; /* its MAX_BALLS_COUNT */

/* Its published cases: a domain twice as high as it is wide, with a lid above
   11/12 of that, and these widths of the profile. */
static const double height = 2, lid = 11. / 12;
static const int widths[] = {300, 500, 1000};
enum { WIDTHS = sizeof widths / sizeof *widths };

/* The largest change of the fraction by the profile that is suggested. */
static const double small = 0.01;

struct domain {
  double side[3];   /* of the domain (m) */
  double base;      /* of the bed's base, as it comes (m) */
  double scaling;   /* of the base, as it is handed over (m) */
  double corner[3]; /* of the base, as it is handed over (m) */
};

static struct domain domain_of(const struct shape *s) {
  struct domain d = {.base = s->source_box[1] - s->source_box[0],
                     .scaling = s->box[1] - s->box[0]};
  for (int k = 0; k < 3; k++)
    d.corner[k] = s->box[2 * k];
  /* walls as thick on the one side as on the other */
  d.side[0] = s->box[1] + d.corner[0];
  d.side[1] = s->box[3] + d.corner[1];
  d.side[2] = height * d.side[0];
  return d;
}

static void check(const struct shape *s, const struct domain *d) {
  const struct bed *b = &s->bed;
  char why[160];
  double top = GSL_NEGINF;
  for (size_t i = 0; i < b->n; i++) {
    if (b->r[i] != b->r[0])
      frame_refuse(s->frames, s->source,
                   "spheres of several radii; the solver has one");
    top = fmax(top, b->x[3 * i + 2] + b->r[i]);
  }
  if (b->n > MOST_BALLS) {
    snprintf(why, sizeof why, "%zu spheres; the solver drops those after %d",
             b->n, MOST_BALLS);
    frame_refuse(s->frames, s->source, why);
  }
  for (int k = 0; k < 3; k++)
    if (d->corner[k] < 0)
      die(EXIT_USAGE,
          "--offset: the base begins below 0 of %c, and the "
          "solver's domain at 0",
          "xyz"[k]);
  if (top > lid * d->side[2]) {
    snprintf(why, sizeof why,
             "the bed reaches to z = %g m, above the solver's lid at %g m", top,
             lid * d->side[2]);
    frame_refuse(s->frames, s->source, why);
  }
}

/* A file Params of somebody else is more than this part of one. */
static void check_params(const char *folder) {
  /* until version 0.2.0: # analyze export */
  static const char *const ours[] = {"# program=analyze", "# analyze export"};
  char *path = measure_alloc(strlen(folder) + 16, 1), line[32] = "";
  snprintf(path, strlen(folder) + 16, "%s/Params", folder);
  FILE *in = fopen(path, "r");
  const bool any = in && fgets(line, sizeof line, in);
  if (in && !(any && (!strncmp(line, ours[0], strlen(ours[0])) ||
                      !strncmp(line, ours[1], strlen(ours[1])))))
    die(EXIT_USAGE,
        "--output %s: its Params is not of analyze export, expected "
        "another folder",
        folder);
  if (in)
    fclose(in);
  free(path);
}

static void write_numbers(FILE *out, const struct shape *s,
                          const struct domain *d) {
  const struct bed *b = s->source;
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < 3; k++) {
      char text[NUMBER_SIZE];
      number_format((b->x[3 * i + k] - s->source_box[2 * k]) / d->base, text);
      fprintf(out, k < 2 ? "%s\t" : "%s\n", text);
    }
}

static void put_line(FILE *out, const char *name, double value,
                     const char *rest) {
  char text[NUMBER_SIZE];
  number_format(value, text);
  fprintf(out, "%-15s %s%s\n", name, text, rest);
}

static void write_params(FILE *out, const struct write_frame *f,
                         const struct domain *d) {
  struct shape *s = f->shape;
  const struct bed *b = &s->bed;
  int suggested = widths[WIDTHS - 1];
  write_origin(out, &origin_comment, f);
  fprintf(out, "# a part of Params for data/spheres_positions.txt\n# %s\n",
          s->statement);
  fprintf(out, "# Mean of the phase field over the same box:\n");
  for (int i = WIDTHS; i-- > 0;) {
    double mean;
    frame_check(
        s->frames, s->source,
        solid_diffuse(b->n, b->x, b->r, s->box, d->side[2] / widths[i], &mean));
    fprintf(out, "#   xi_gl L3/%-4d %.4f, %+.4f\n", widths[i], mean,
            mean - s->fraction);
    if (fabs(mean - s->fraction) <= small)
      suggested = widths[i];
  }
  put_line(out, "L1", d->side[0], "");
  put_line(out, "L2", d->side[1], "");
  put_line(out, "L3", d->side[2], "");
  put_line(out, "beads_scaling", d->scaling, "");
  put_line(out, "ball_radius", b->n ? s->source->r[0] / d->base : 0,
           "*beads_scaling");
  put_line(out, "beads_offset_x", d->corner[0], "");
  put_line(out, "beads_offset_y", d->corner[1], "");
  put_line(out, "beads_offset_z", d->corner[2], "");
  fprintf(out, "%-15s L3/%d\n", "xi_gl", suggested);
}

void write_freezethaw(const char *folder, const struct write_frame *f,
                      const struct write_options *o) {
  (void)o;
  struct shape *s = f->shape;
  const struct domain d = domain_of(s);
  check(s, &d);
  shape_measure(s);
  struct output_file positions, params;
  check_params(folder);
  output_folder(folder);
  output_open_in(&positions, folder, "spheres_positions.txt");
  output_open_in(&params, folder, "Params");
  write_numbers(positions.stream, s, &d);
  write_params(params.stream, f, &d);
  output_commit(&positions);
  output_commit(&params);
}
