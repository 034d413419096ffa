/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a run starts: the paper's grid or the last frame of a file. */
#ifndef START_H
#define START_H

#include "files/bed_io.h"
#include "settings.h"

/* Fills the bed and completes the settings: a file's header sets what the
   command line did not, walls are the command line's, else the file's, else
   the box. header: the parameters as the output's header will have them. Exits
   with one line where the start cannot be used. */
void start_make(struct settings *s, struct option_spec *options, struct bed *b,
                struct bed_header *header);

#endif
