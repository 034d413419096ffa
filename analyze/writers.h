/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writers of export, one file per format, write_*.c. Each writes one frame
   to an open stream and leaves errors in ferror(out). Binary numbers are
   little-endian, text reads back the same. */
#ifndef WRITERS_H
#define WRITERS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include "program/origin.h"
#include "shape.h"

struct write_options {
  size_t cells[3]; /* voxels along x, y, z */
  bool binary, distance, single, equal_volume, merged, network, quiet;
  bool apart; /* stl: walls are somewhere else */
  size_t facets, threads;
};

struct write_frame {
  struct shape *shape;
  const struct bed *bed; /* the shape's */
  const char *name;      /* of the output, NULL: standard output */
  size_t number;         /* of the frame in its input, from 0 */
  bool first;            /* in its file */
  long id_offset;        /* for formats whose numbers begin at 1 */
};

typedef void write_function(FILE *out, const struct write_frame *f,
                            const struct write_options *o);

write_function write_bed, write_positions, write_csv, write_xyz, write_lammps,
    write_lammps_data, write_vtp, write_stl, write_vti, write_raw,
    write_palabos, write_geo;

/* Formats of several files: path is what --output says, a folder or a file.
   They exit with one line where something cannot be written. */
typedef void write_files_function(const char *path, const struct write_frame *f,
                                  const struct write_options *o);

write_files_function write_freezethaw, write_mhd, write_openfoam;

/* What made the file (program/origin.h), and which bed it is of. */
void write_origin(FILE *out, const struct origin_style *s,
                  const struct write_frame *f);

/* count numbers of size bytes each, little-endian. */
void write_little_endian(FILE *out, const void *data, size_t size,
                         size_t count);

/* Exits with EXIT_INPUT and one line where coordinates in single precision are
   too far from the origin for edges of a length: the numbers next to the
   largest coordinate must lie at least 64 to an edge, so that triangles keep
   their shape and a sphere of a thousand facets its volume to 1e-4. */
void write_check_single(const struct shape *s, double edge);

/* One data array of a VTK XML file, kept in its appended part. */
struct vtk_array {
  const char *name, *type;        /* Float64, Int64, ... */
  size_t components, size, count; /* of the bytes of a number; of numbers */
  const void *data;
};

/* The start of a VTK XML file: what made it, the opening tag of its kind of
   data set, with attributes, the shape's note, and the time as field data. */
void write_vtk_start(FILE *out, const char *kind, const char *attributes,
                     const struct write_frame *f);

/* An array's element; its data come at *offset, which moves on. */
void write_vtk_element(FILE *out, const struct vtk_array *a, uint64_t *offset);

#endif
