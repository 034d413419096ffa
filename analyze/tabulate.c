/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulate.h"

#include "program/messages.h"

void tabulation_open(struct tabulation *t, const struct frames_options *o,
                     bool mean, int argc, char **argv, int first) {
  *t = (struct tabulation){0};
  frames_open(&t->frames, o, argc, argv, first);
  table_open(&t->table, &t->frames, mean);
}

bool tabulation_next(struct tabulation *t) {
  return frames_next(&t->frames, &t->bed);
}

void tabulation_see(struct tabulation *t, const struct option_list *given) {
  if (given->count)
    box_watch_see(&t->watch, &t->frames, &t->bed, false, 1,
                  (const double(*)[6])given->at);
}

int tabulate(const struct frames_options *o, bool mean, int argc, char **argv,
             int first, void (*measure)(struct tabulation *t, const void *set),
             const void *set) {
  struct tabulation t;
  tabulation_open(&t, o, mean, argc, argv, first);
  while (tabulation_next(&t))
    measure(&t, set);
  return tabulation_close(&t);
}

int tabulation_close(struct tabulation *t) {
  table_close(&t->table);
  box_watch_end(&t->watch);
  frames_close(&t->frames);
  finish_output();
  return EXIT_DONE;
}
