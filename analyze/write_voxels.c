/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Voxel grids: VTK XML ImageData, or the bare numbers, x fastest. Some rows at
   a time, so that memory does not grow with the grid. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/options.h"
#include "geometry/voxels.h"
#include "writers.h"

/* Numbers held at a time: 16 MB. */
enum { AT_ONCE = 1 << 21 };

struct progress {
  bool show;
  time_t start, shown;
};

static void show_progress(struct progress *p, size_t done, size_t all) {
  const time_t now = p->show ? time(NULL) : p->shown;
  if (now == p->shown)
    return;
  p->shown = now;
  const double share = (double)done / (double)all;
  fprintf(stderr, "\ranalyze: %3.0f %%  layer %zu of %zu  %.0f s left \033[K",
          100 * share, done, all,
          difftime(now, p->start) * (1 - share) / GSL_MAX(share, 1e-9));
}

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

static void write_cells(FILE *out, const struct write_frame *f,
                        const struct write_options *o) {
  const struct bed *b = f->bed;
  const enum voxels_value what = o->binary     ? VOXELS_MIDPOINT
                                 : o->distance ? VOXELS_DISTANCE
                                               : VOXELS_FRACTION;
  const size_t nx = o->cells[0], ny = o->cells[1], nz = o->cells[2];
  const size_t rows = GSL_MIN(ny, GSL_MAX(1, AT_ONCE / nx));
  struct voxels *v = NULL;
  double *value =
      nx > SIZE_MAX / rows ? NULL : calloc(nx * rows, sizeof *value);
  int status = value
                   ? voxels_open(&v, b->n, b->x, b->r, f->shape->box, o->cells)
                   : GSL_ENOMEM;
  struct progress progress = {.show = !o->quiet && isatty(STDERR_FILENO),
                              .start = time(NULL)};
  progress.shown = progress.start;
  for (size_t k = 0; k < nz && !status && !ferror(out); k++)
    for (size_t j = 0; j < ny && !status && !ferror(out); j += rows) {
      const size_t end = GSL_MIN(ny, j + rows);
      show_progress(&progress, k, nz);
      status = voxels_rows(v, what, k, j, end, o->threads, value);
      if (status)
        break;
      narrow(o, value, nx * (end - j));
      write_little_endian(out, value, number_size(o), nx * (end - j));
    }
  voxels_close(v);
  free(value);
  if (progress.shown != progress.start)
    fputs("\r\033[K", stderr);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory for rows of %zu cells", nx);
  if (status)
    die(EXIT_USAGE, "--cells: finer than numbers of the box's size resolve");
}

void write_raw(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  write_cells(out, f, o);
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
  write_vtk_start(out, "ImageData", attributes, f->bed->t);
  fprintf(out, "<Piece %s>\n<CellData Scalars=\"%s\">\n", extent, array.name);
  write_vtk_element(out, &array, &offset);
  fprintf(out, "</CellData>\n</Piece>\n</ImageData>\n"
               "<AppendedData encoding=\"raw\">\n_");
  write_little_endian(out, &bytes, sizeof bytes, 1);
  write_cells(out, f, o);
  fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
}
