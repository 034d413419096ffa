/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Voxel grids: VTK XML ImageData, the bare numbers, x fastest, MetaImage, and
   text for Palabos. Some rows at
   a time, so that memory does not grow with the grid. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/command_line.h"
#include "geometry/voxels.h"
#include "geometry/parts.h"
#include "measure.h"
#include "program/files.h"
#include "program/progress.h"
#include "writers.h"

/* Numbers held at a time: 16 MB. */
enum { AT_ONCE = 1 << 21 };

static size_t number_size(const struct write_options *o) {
  return o->binary ? 1 : o->single ? 4 : 8;
}

/* Turns the numbers into what is written, in their own place. */
static void narrow(const struct write_options *o, double *value, size_t count) {
  if (o->binary)
    for (size_t i = 0; i < count; i++)
      ((unsigned char *)value)[i] = value[i] != 0;
  else if (o->single)
    for (size_t i = 0; i < count; i++)
      ((float *)value)[i] = (float)value[i];
}

/* The values of a grid, as they are written. */
struct told {
  struct parts *parts;
  bool *solid; /* of a row */
  double sum;  /* of the cells' values, or of the solid cells */
};

static int tell_row(struct told *t, const struct write_options *o, size_t nx,
                    const double *value) {
  for (size_t i = 0; i < nx; i++) {
    t->solid[i] = o->distance ? value[i] <= 0 : value[i] >= 0.5;
    t->sum += o->distance ? t->solid[i] : value[i];
  }
  return parts_row(t->parts, t->solid);
}

static void tell(const struct told *t, const struct write_frame *f,
                 const struct write_options *o) {
  const size_t *cells = o->cells;
  const bool *around = f->shape->around;
  size_t count[2];
  parts_count(t->parts, count);
  shape_add(f->shape,
            "%zu x %zu x %zu cells, %s %.12g; cells that share a face%s make "
            "%zu solid part%s and %zu pore part%s",
            cells[0], cells[1], cells[2],
            o->binary || o->distance ? "solid share of midpoints"
                                     : "mean solid fraction",
            t->sum / (double)cells[0] / (double)cells[1] / (double)cells[2],
            around[0] || around[1] ? ", also across periodic sides," : "",
            count[true], count[true] == 1 ? "" : "s", count[false],
            count[false] == 1 ? "" : "s");
}

typedef void write_row(FILE *out, const struct write_options *o, size_t nx,
                       double *value);

static void write_numbers(FILE *out, const struct write_options *o, size_t nx,
                          double *value) {
  narrow(o, value, nx);
  write_little_endian(out, value, number_size(o), nx);
}

/* Writes the rows of a grid over a box, x fastest, then y, then z; around: axes
   along which its ends meet. */
static void write_grid(FILE *out, const struct write_frame *f,
                       const struct write_options *o, const struct solid *solid,
                       const double box[6], const size_t cells[3],
                       const bool around[3], write_row *row) {
  const enum voxels_value what = o->binary     ? VOXELS_MIDPOINT
                                 : o->distance ? VOXELS_DISTANCE
                                               : VOXELS_FRACTION;
  const size_t nx = cells[0], ny = cells[1], nz = cells[2];
  const size_t rows = GSL_MIN(ny, GSL_MAX(1, AT_ONCE / nx));
  struct voxels *v = NULL;
  struct told told = {.solid = calloc(nx, sizeof *told.solid)};
  double *value =
      nx > SIZE_MAX / rows ? NULL : calloc(nx * rows, sizeof *value);
  int status = value && told.solid ? parts_open(&told.parts, nx, ny, around)
                                   : GSL_ENOMEM;
  if (!status)
    status = voxels_open(&v, solid, box, cells);
  struct progress progress = progress_begin(o->quiet);
  for (size_t k = 0; k < nz && !status && !ferror(out); k++)
    for (size_t j = 0; j < ny && !status && !ferror(out); j += rows) {
      const size_t end = GSL_MIN(ny, j + rows);
      progress_name(&progress, "layer %zu of %zu", k + 1, nz);
      progress_tell(&progress,
                    ((double)k + (double)j / (double)ny) / (double)nz);
      status = voxels_rows(v, what, k, j, end, o->threads, value);
      for (size_t r = j; r < end && !status; r++) {
        status = tell_row(&told, o, nx, value + nx * (r - j));
        row(out, o, nx, value + nx * (r - j));
      }
    }
  voxels_close(v);
  free(value);
  progress_end(&progress);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory for rows of %zu cells", nx);
  if (status)
    die(EXIT_USAGE, "--cells: finer than numbers of the box's size resolve");
  tell(&told, f, o);
  parts_close(told.parts);
  free(told.solid);
}

/* What the numbers take is known before the first. */
static void need_room(FILE *out, const char *name,
                      const struct write_options *o, size_t each) {
  output_need_room(out, name,
                   (double)o->cells[0] * (double)o->cells[1] *
                       (double)o->cells[2] * (double)each);
}

static void write_cells(FILE *out, const struct write_frame *f,
                        const struct write_options *o) {
  need_room(out, f->name, o, number_size(o));
  write_grid(out, f, o, &f->shape->solid, f->shape->box, o->cells,
             f->shape->around, write_numbers);
}

void write_raw(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  write_cells(out, f, o);
}

/* MetaIO 9.1 of VTK ends the program for a comment of 255 characters or more.
   Keys of our own it passes over, as ITK and Fiji do. */
static void put_comment(FILE *out, const struct write_frame *f) {
  static const struct origin_style comment = {"", " = ", "\n", 254};
  static const struct origin_style key = {"", " = ", "\n", 490};
  const char *statement = f->shape->statement;
  origin_put(out, &comment, "Comment", statement);
  if (strlen(statement) > (size_t)comment.most)
    origin_put(out, &key, "solid", statement);
  write_origin(out, &key, f);
}

/* MetaImage: a header of a few lines, and the numbers in a file beside it. The
   place of an image is that of its first midpoint. */
void write_mhd(const char *path, const struct write_frame *f,
               const struct write_options *o) {
  const double *box = f->shape->box;
  const size_t stem = strlen(path) - strlen(".mhd");
  if (strlen(path) <= strlen(".mhd") || strcmp(path + stem, ".mhd"))
    die(EXIT_USAGE, "--output %s: expected a name that ends in .mhd", path);
  char *raw = measure_alloc(strlen(path) + 1, 1);
  memcpy(raw, path, stem);
  memcpy(raw + stem, ".raw", sizeof ".raw");
  const char *slash = strrchr(raw, '/');
  struct output_file header, numbers;
  output_open(&numbers, raw);
  output_open(&header, path);
  write_cells(numbers.stream, f, o);
  shape_measure(f->shape);
  fprintf(header.stream, "ObjectType = Image\nNDims = 3\n");
  put_comment(header.stream, f);
  fprintf(header.stream, "BinaryData = True\nBinaryDataByteOrderMSB = False\n"
                         "CompressedData = False\n"
                         "TransformMatrix = 1 0 0 0 1 0 0 0 1\n");
  const char *const words[] = {"Offset", "ElementSpacing"};
  for (int word = 0; word < 2; word++) {
    fprintf(header.stream, "%s =", words[word]);
    for (int k = 0; k < 3; k++) {
      const double step = (box[2 * k + 1] - box[2 * k]) / (double)o->cells[k];
      fprintf(header.stream, " %.17g", word ? step : box[2 * k] + step / 2);
    }
    fputc('\n', header.stream);
  }
  fprintf(header.stream,
          "DimSize = %zu %zu %zu\nElementType = MET_%s\n"
          "ElementDataFile = %s\n",
          o->cells[0], o->cells[1], o->cells[2],
          o->binary   ? "UCHAR"
          : o->single ? "FLOAT"
                      : "DOUBLE",
          slash ? slash + 1 : raw);
  output_commit(&numbers);
  output_commit(&header);
  free(raw);
}

static void write_flags(FILE *out, const struct write_options *o, size_t nx,
                        double *value) {
  (void)o;
  for (size_t i = 0; i < nx; i++) {
    fputc(value[i] != 0 ? '1' : '0', out);
    fputc(i + 1 < nx ? ' ' : '\n', out);
  }
}

/* x and z change places. */
static void turn(const double from[3], double to[3]) {
  for (int k = 0; k < 3; k++)
    to[k] = from[2 - k];
}

static void turn_container(const struct container *from, struct container *to,
                           double (*plane)[4]) {
  *to = *from;
  for (int k = 0; k < 6; k++)
    to->box[k] = from->box[2 * (2 - k / 2) + k % 2];
  turn(from->point, to->point);
  turn(from->axis, to->axis);
  for (size_t k = 0; k < from->planes; k++) {
    turn(from->plane[k], plane[k]);
    plane[k][3] = from->plane[k][3];
  }
  to->plane = (const double(*)[4])plane;
}

/* Palabos reads whole numbers as text, x slowest, then y, then z: the rows of
   the grid that is turned so that x and z change places. */
void write_palabos(FILE *out, const struct write_frame *f,
                   const struct write_options *o) {
  const struct solid *s = &f->shape->solid;
  const double *box = f->shape->box;
  const double turned[6] = {box[4], box[5], box[2], box[3], box[0], box[1]};
  const size_t cells[3] = {o->cells[2], o->cells[1], o->cells[0]};
  need_room(out, f->name, o, sizeof "0 " - 1);
  double *x = measure_alloc(3 * s->n, sizeof *x);
  for (size_t i = 0; i < s->n; i++)
    turn(s->x + 3 * i, x + 3 * i);
  struct container container;
  double(*plane)[4] =
      measure_alloc(s->container ? s->container->planes : 0, sizeof *plane);
  struct solid solid = *s;
  solid.x = x;
  if (s->container) {
    turn_container(s->container, &container, plane);
    solid.container = &container;
  }
  struct write_options flags = *o;
  flags.binary = true;
  const bool *along = f->shape->around;
  const bool around[3] = {along[2], along[1], along[0]};
  write_grid(out, f, &flags, &solid, turned, cells, around, write_flags);
  free(plane);
  free(x);
}

void write_vti(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  const double *box = f->shape->box;
  const uint64_t count = (uint64_t)o->cells[0] * o->cells[1] * o->cells[2];
  const uint64_t bytes = count * number_size(o);
  const struct vtk_array array = {.name = o->binary     ? "solid"
                                          : o->distance ? "distance"
                                                        : "solid_fraction",
                                  .type = o->binary   ? "UInt8"
                                          : o->single ? "Float32"
                                                      : "Float64",
                                  .components = 1,
                                  .size = number_size(o),
                                  .count = count};
  uint64_t offset = 0;
  char extent[80], attributes[320];
  snprintf(extent, sizeof extent, "Extent=\"0 %zu 0 %zu 0 %zu\"", o->cells[0],
           o->cells[1], o->cells[2]);
  snprintf(attributes, sizeof attributes,
           " Whole%s Origin=\"%.17g %.17g %.17g\" "
           "Spacing=\"%.17g %.17g %.17g\"",
           extent, box[0], box[2], box[4],
           (box[1] - box[0]) / (double)o->cells[0],
           (box[3] - box[2]) / (double)o->cells[1],
           (box[5] - box[4]) / (double)o->cells[2]);
  write_vtk_start(out, "ImageData", attributes, f);
  fprintf(out, "<Piece %s>\n<CellData Scalars=\"%s\">\n", extent, array.name);
  write_vtk_element(out, &array, &offset);
  fprintf(out, "</CellData>\n</Piece>\n</ImageData>\n"
               "<AppendedData encoding=\"raw\">\n_");
  write_little_endian(out, &bytes, sizeof bytes, 1);
  write_cells(out, f, o);
  fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}
