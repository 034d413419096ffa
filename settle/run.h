/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The run: steps, frames, log, progress and what is said at its end. */
#ifndef RUN_H
#define RUN_H

#include "files/bed_io.h"
#include "settings.h"

/* Integrates and writes frames to standard output; returns the program's exit
   status. */
int run(const struct settings *s, struct bed *b,
        const struct bed_header *header);

#endif
