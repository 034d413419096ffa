/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions that the verbs which measure a frame share. */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdbool.h>
#include "frames.h"
#include "program/command_line.h"
#include "model/scene.h"

/* Row of an option table: a box, into a struct option_list; without numbers
   until it is given. */
/* clang-format off */
#define BOX_OPTION(b, help_)                                                   \
  {.name = "box", .type = OPTION_LIST, .value = &(b), .least = 6, .most = 6,   \
   .unit = "x0,x1,y0,y1,z0,z1 in m", .help = help_}
/* clang-format on */

/* Exits with EXIT_USAGE if the box was given and has no volume (box_valid). */
void box_check(const struct option_list *box);

/* The scene of the frame just read, to be freed: its header's keys over
   settle's defaults. Warns of a format that has no scene. Exits with EXIT_INPUT
   on a bad key. */
struct scene frame_scene(const struct frames *f, const struct bed *b);

/* Warns if the frame's radius is not that of the dynamics, since forces then
   are not those that hold the bed. */
void frame_warn_rewritten(const struct frames *f);

/* Puts the faces of a box where the header has walls across an axis, and says
   of each face whether it has; the last of several walls counts. What is not
   six numbers is no wall. */
void header_walls(const struct bed_header *h, double box[6], bool walled[6]);

/* The bottom cube of the base that the header's walls enclose: on the floor,
   between side walls along x and y, as high as the shorter of the two is wide.
   The unit cube where there are not all of them. */
void frame_base_box(const struct bed_header *h, double box[6]);

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

/* Box spanned by the centres less margin (m) on every side. */
void frame_box(const struct bed *b, double margin, double box[6]);

void *measure_alloc(size_t count, size_t size); /* zeroed; exits without */

#endif
