/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A bed as a data file of LAMMPS, atom style sphere, which read_data takes.
   Tested in tests/test_export.sh and tests/test_lammps.sh. */
#ifndef LAMMPS_DATA_H
#define LAMMPS_DATA_H

#include <stdio.h>
#include "model/bed.h"

/* The first line, which is anybody's; note may be empty. Lines of comment may
   follow, that begin with # and have fewer than 256 characters. */
void lammps_data_title(FILE *out, const char *by, const char *note, double t);

/* All behind that. ids are those of the bed plus id_offset, for LAMMPS counts
   from 1; box: x0 x1 y0 y1 z0 z1 (m). Spheres are of type 1, those that are
   fixed of type 2. Errors stay in ferror(out). */
void lammps_data_write(FILE *out, const struct bed *b, long id_offset,
                       const double box[6]);

#endif
