/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions that the verbs which measure a frame share. */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdbool.h>
#include "frames.h"
#include "geometry/region.h"
#include "program/command_line.h"
#include "model/scene.h"

/* Row of an option table: a box, into a struct option_list; without numbers
   until it is given. BASE_BOX: of verbs whose default is frame_base_box. */
/* clang-format off */
#define BOX_OPTION(b, help_)                                                   \
  {.name = "box", .type = OPTION_LIST, .value = &(b), .least = 6, .most = 6,   \
   .unit = "x0,x1,y0,y1,z0,z1 in m", .help = help_}
#define BASE_BOX "; else the bottom cube between the walls, or the unit cube"
/* clang-format on */

/* Exits with EXIT_USAGE if the box was given and has no volume (box_valid). */
void box_check(const struct option_list *box);

/* The scene of the frame just read, to be freed: its header's keys over
   settle's defaults, but for lmax, whose default is the mean radius, as it is
   in settle's bed. Exits with EXIT_INPUT on a bad key. */
struct scene frame_scene(const struct frames *f, const struct bed *b);

/* Warns if the frame's radius is not that of the dynamics, since forces then
   are not those that hold the bed. */
void frame_warn_rewritten(const struct frames *f);

/* Puts the faces of a box where the header has walls across an axis, and says
   of each face whether it has; the last of several walls counts. A list of
   other than six numbers is no wall. */
void header_walls(const struct bed_header *h, double box[6], bool walled[6]);

/* The bottom cube of the base that the header's walls enclose: on the floor,
   between side walls along x and y, as high as the shorter of the two is wide.
   Periodic sides are like walls; in an upright tube it is the square inscribed.
   The unit cube, and false, where there are not all of them. */
bool frame_base_box(const struct bed_header *h, double box[6]);

/* Puts in place of the spheres of a bed with periodic sides all their images
   that reach into any of the boxes, and no others: what fills them. Obstacles
   are spheres like others then. Exits with one line where they are too many. */
void frame_add_images(const struct frames *f, struct bed *b, size_t count,
                      const double (*boxes)[6]);

/* The box that was given; frame_base_box for one without numbers. */
void frame_choose_box(const struct frames *f, const struct option_list *given,
                      double box[6]);

/* Watches whether any sphere is in the boxes that are measured, since a share
   of a box somewhere else is no answer: reaches into it or, where the unit cube
   is only a guess, has its centre there. Begins as zeros. */
struct box_watch {
  const char *name; /* of the file */
  size_t looks;     /* boxes with spheres to look for */
  bool found;       /* a sphere in one of them */
  bool default_;  /* the last one is the unit cube for want of anything else */
  double box[6];  /* the first of the last frame's */
  double span[6]; /* of the spheres when it was looked at */
};
/* To be called for every frame; count boxes, at least one. from_base: they
   came from frame_choose_box without a box given. */
void box_watch_see(struct box_watch *w, const struct frames *f,
                   const struct bed *b, bool from_base, size_t count,
                   const double (*boxes)[6]);
/* After the last frame, and by itself after each bed: one line on standard
   error where no box ever had a sphere, or where the unit cube is only a guess
   and much wider than what the spheres take up. */
void box_watch_end(const struct box_watch *w);

/* The union's share of the box that was given or the frame's own, all images
   taken in, and the watch over that box. */
double frame_union(struct frames_part part, const struct option_list *given,
                   const struct bed *b, struct box_watch *watch);

/* Exits with EXIT_INPUT and one line: the input, the frame's time and why it
   cannot be measured. */
_Noreturn void frame_refuse(const struct frames *f, const struct bed *b,
                            const char *why);

/* Is the box so large beside a sphere that digits of a clipped volume are
   right? */
bool frame_box_resolved(const struct bed *b, const double box[6]);

/* Exits likewise if it is so small beside a sphere that no digits of the
   clipped volume would be right. */
void frame_check_box(const struct frames *f, const struct bed *b,
                     const double box[6]);

/* Exits with one line on a GSL status that is not success: no memory, or a
   frame that cannot be measured. */
void frame_check(const struct frames *f, const struct bed *b, int status);

/* The last cylinder among the walls, and how many there are; NULL for none. */
const struct wall *scene_tube(const struct scene *s, size_t *count);

/* Where centres are looked at: the box that was given, or all that the centres
   span, less margin (m) on every side: a box, with all of a periodic axis, or,
   of a bed in one tube without periodic sides, the inside of a cylinder. */
struct region frame_region(const struct frames *f, const struct bed *b,
                           const struct option_list *given, double margin);

void *measure_alloc(size_t count, size_t size); /* zeroed; exits without */

#endif
