/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by formats: what made a file, byte order, the frame of VTK's XML. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "program/command_line.h"
#include "writers.h"

static bool little_endian(void) {
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 1;
}

void write_little_endian(FILE *out, const void *data, size_t size,
                         size_t count) {
  if (little_endian()) {
    fwrite(data, size, count, out);
    return;
  }
  const unsigned char *bytes = data;
  for (size_t i = 0; i < count && !ferror(out); i++)
    for (size_t b = size; b-- > 0;)
      fputc(bytes[i * size + b], out);
}

/* How far the next number is in single precision; infinite beyond the last. */
static double float_spacing(double x) {
  const float at = (float)fabs(x);
  return isinf(at) ? HUGE_VAL : (double)nextafterf(at, HUGE_VALF) - (double)at;
}

static const double least_edge = 64; /* spacings */

void write_check_single(const struct shape *s, double edge) {
  const struct bed *b = &s->bed;
  double low[3], high[3], farthest = 0, widest = 0;
  for (int k = 0; k < 3; k++) {
    low[k] = HUGE_VAL;
    high[k] = -HUGE_VAL;
    for (size_t i = 0; i < b->n; i++) {
      low[k] = fmin(low[k], b->x[3 * i + (size_t)k] - b->r[i]);
      high[k] = fmax(high[k], b->x[3 * i + (size_t)k] + b->r[i]);
    }
    farthest = fmax(farthest, fmax(fabs(low[k]), fabs(high[k])));
    widest = fmax(widest, high[k] - low[k]);
  }
  if (!b->n || edge >= least_edge * float_spacing(farthest))
    return;
  const double *moved = s->offset;
  char remedy[120] = "coarser facets, or fewer spheres";
  if (edge >= least_edge * float_spacing(widest / 2))
    snprintf(remedy, sizeof remedy, "--offset %.6g,%.6g,%.6g or the like",
             moved[0] - (low[0] + high[0]) / 2,
             moved[1] - (low[1] + high[1]) / 2,
             moved[2] - (low[2] + high[2]) / 2);
  die(EXIT_INPUT,
      "t=%g: single precision cannot hold facets with edges of %.3g m at "
      "%.6g m from the origin, where its numbers are %.3g m apart: expected "
      "%s",
      b->t, edge, farthest, float_spacing(farthest), remedy);
}

void write_origin(FILE *out, const struct origin_style *s,
                  const struct write_frame *f) {
  char *const bed = frames_origin(f->shape->frames);
  origin_write(out, s, command_line(), bed);
  free(bed);
}

void write_vtk_start(FILE *out, const char *kind, const char *attributes,
                     const struct write_frame *f) {
  const char *note = shape_note(f->shape);
  fprintf(out, "<?xml version=\"1.0\"?>\n");
  char *const bed = frames_origin(f->shape->frames);
  origin_write_xml(out, bed);
  free(bed);
  fprintf(out,
          "<!-- lengths in m, t in s -->\n"
          "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"LittleEndian\" "
          "header_type=\"UInt64\">\n",
          kind);
  if (note)
    fprintf(out, "<!-- %s -->\n", note);
  fprintf(out,
          "<%s%s>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
          "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n"
          "</FieldData>\n",
          kind, attributes, f->bed->t);
}

void write_vtk_element(FILE *out, const struct vtk_array *a, uint64_t *offset) {
  fprintf(out,
          "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
          "format=\"appended\" offset=\"%llu\"/>\n",
          a->type, a->name, a->components, (unsigned long long)*offset);
  *offset += sizeof(uint64_t) + (uint64_t)a->size * a->count;
}
