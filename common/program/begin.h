/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first thing that a program does. */
#ifndef BEGIN_H
#define BEGIN_H

/* Its name for messages, and the verb that runs, NULL without one; GSL's error
   handler off; what goes with it when it ends (litter.h); standard streams that
   are closed kept from being the next file that is opened. May be called again.
   Both texts must live on. */
void program_begin(const char *name, const char *verb);

#endif
