/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verbs that print a table: their operands frame by frame, the rows, and
   the watch over the boxes that they measure. Tested in tests/test_tables.sh.
 */
#ifndef TABULATE_H
#define TABULATE_H

#include "measure.h"
#include "table.h"

struct tabulation {
  struct frames frames;
  struct bed bed; /* the frame just read */
  struct table table;
  struct box_watch watch;
};

/* As frames_open and table_open. */
void tabulation_open(struct tabulation *t, const struct frames_options *o,
                     bool mean, int argc, char **argv, int first);

/* As frames_next, into t->bed. */
bool tabulation_next(struct tabulation *t);

/* As box_watch_see for one box, if it was given: without it the verb takes one
   that has spheres. */
void tabulation_see(struct tabulation *t, const struct option_list *given);

/* All that a verb does with its operands: each frame is measured, with the
   verb's own set of options; returns EXIT_DONE. */
int tabulate(const struct frames_options *o, bool mean, int argc, char **argv,
             int first, void (*measure)(struct tabulation *t, const void *set),
             const void *set);

/* Ends the table and the output; returns EXIT_DONE. */
int tabulation_close(struct tabulation *t);

#endif
