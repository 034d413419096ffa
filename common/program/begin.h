/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first thing that a program does. */
#ifndef BEGIN_H
#define BEGIN_H

/* Keeps the program's name for messages, and the verb that runs (NULL: none);
   switches GSL's error handler off; watches the program's end (litter.h); and
   opens closed standard streams, so that no file takes their place. May be
   called again. Both texts must live on. */
void program_begin(const char *name, const char *verb);

#endif
