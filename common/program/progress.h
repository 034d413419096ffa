/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far long work has got: a line on standard error, if that is a terminal,
   with the share done and the time left. Work tells what it has done as often
   as it likes; twice a second the line is written anew, rows on standard output
   are passed on, and a reader of them that has gone away ends the program. Of
   one thread. Tested in tests/test_progress.sh. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>

struct progress {
  bool shows;           /* a terminal, and not quiet */
  double begun, looked; /* on the wall's clock (s) */
  char what[80];        /* the work's own words */
};

/* Begins the clock. Before any row is written: where rows go to a terminal too
   they are kept until the line has made room for them. */
struct progress progress_begin(bool quiet);

/* Is it time to look again? For work that tells often and has much to say. */
bool progress_due(const struct progress *p);

/* Sets the activity that the line names; valid until the next call. */
void progress_name(struct progress *p, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The share done, from 0 to 1; negative where nobody knows, and the line has
   the time taken instead. */
void progress_tell(struct progress *p, double done);

/* The clock begins anew, for other work. */
void progress_restart(struct progress *p);

/* From now on USR1 does not end the program: it asks for one line of what is
   done, on standard error. */
void progress_listen(void);
/* Whether it was asked for since the last call. */
bool progress_asked(void);

/* The line goes, until there is more to tell. */
void progress_end(struct progress *p);

#endif
