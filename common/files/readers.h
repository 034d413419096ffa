/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The readers, each in the file of its name, for the table in formats.c. */
#ifndef READERS_H
#define READERS_H

#include "files/bed_reader.h"

extern const struct bed_format format_bed, format_table, format_lammps,
    format_lammps_data, format_xyz;

#endif
