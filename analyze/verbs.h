/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verbs of analyze: each a filter in a file of its own, VERB.c, with a
   function verb_VERB. argv[0] is the verb, the rest its options and operand;
   returns the program's exit status. */
#ifndef VERBS_H
#define VERBS_H

/* clang-format off */
#define VERBS(VERB)                                                            \
  VERB(fraction, "share of boxes that the spheres fill, the default")          \
  VERB(profile, "solid fraction along an axis, from a wall or of shells")      \
  VERB(contacts, "coordination, overlaps, forces, weight on walls, fabric")    \
  VERB(mixture, "sizes class by class: fraction, contacts, segregation")        \
  VERB(rest, "energies, unbalanced force, largest speed")                      \
  VERB(gr, "pair correlation")                                                 \
  VERB(order, "bond order q4 and q6: fcc, hcp, bcc or none")                        \
  VERB(hard, "the fraction with hard contacts, from beds of soft ones")         \
  VERB(radius, "the geometry's radius, and the bed with another one")          \
  VERB(export, "the bed for other programs, or as voxels")                     \
  VERB(draw, "a picture of one frame, PNG or SVG")                             \
  VERB(movie, "an animation of all frames, GIF, MP4 or WebM")
/* clang-format on */

#define VERB_FUNCTION(name, what) int verb_##name(int argc, char **argv);
VERBS(VERB_FUNCTION)

#endif
