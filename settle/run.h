/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The run: steps, frames, log, progress and what is said at its end. */
#ifndef RUN_H
#define RUN_H

#include "checkpoint.h"

/* Integrates and writes frames; returns the program's exit status. from: what
   it goes on from, if that has a stream. */
int run(struct setup *setup, struct checkpoint *from);

#endif
