/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene and its start for LAMMPS with the paper's law, instead of a run. */
#ifndef EXPORT_LAMMPS_H
#define EXPORT_LAMMPS_H

#include "files/bed_io.h"
#include "settings.h"

/* Writes into the folder: start.tsv, the bed; bed.data, the same for read_data;
   in.scene, input that sets the scene up, and in.run, input that runs it with
   a fixed step. Exits with one line where travel has no limit or a file cannot be
   written. */
void export_lammps(const char *folder, const struct settings *s,
                   const struct bed *b, const struct bed_header *header);

#endif
