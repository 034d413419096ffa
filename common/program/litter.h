/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Litter is what must not be left behind: half-written files, scratch files and
   directories, a program that works for this one. All of it is removed when the
   process exits or is ended by a signal (HUP, INT, QUIT, TERM, XCPU, ABRT). The
   process then dies of that signal as if it had not been caught.

   A reader of standard output that has gone away ends the process at once and
   without a word, exit status EXIT_IO; a reader of anything else is an error of
   the write, as is a file that grows too large (XFSZ). Signals that are ignored
   from the start, as nohup does with HUP, stay ignored.

   A program that has something worth keeping may ask for time (litter_defer):
   the first HUP, INT, TERM or XCPU then waits for it, the next one does not.

   Not to be called by more than one thread at a time. Tested in
   tests/test_litter.sh. */
#ifndef LITTER_H
#define LITTER_H

#include <sys/types.h>

/* Watches the exits of this process; further calls do nothing. */
void litter_watch(void);

/* No signal comes between the two: in there a file is made and added, and none is
   left by a signal that comes as it is made. */
void litter_hold(void);
void litter_release(void);

/* A file, or a directory that holds nothing but files added as well. The
   text stays the caller's and must live until it is forgotten. */
void litter_add(const char *path);
/* It is complete, or gone. */
void litter_forget(const char *path);

/* fork for a child that is to end with this process, and has no litter of its
   own; in this one until litter_forked, once the child was waited for. */
pid_t litter_fork(void);
void litter_forked(void);

/* From now on the first of those signals is only noted. */
void litter_defer(void);
/* Its number, 0 if there was none. */
int litter_asked(void);

#endif
