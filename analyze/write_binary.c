/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What binary formats share: byte order and the frame of VTK's XML. */
#include <string.h>
#include "program/version.h"
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

void write_vtk_start(FILE *out, const char *kind, const char *attributes,
                     const char *note, double t) {
  fprintf(out,
          "<?xml version=\"1.0\"?>\n"
          "<!-- analyze export " DEM_VERSION "; lengths in m, t in s -->\n"
          "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"LittleEndian\" "
          "header_type=\"UInt64\">\n",
          kind);
  if (note)
    fprintf(out, "<!-- %s -->\n", note);
  fprintf(out,
          "<%s%s>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
          "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n"
          "</FieldData>\n",
          kind, attributes, t);
}

void write_vtk_element(FILE *out, const struct vtk_array *a, uint64_t *offset) {
  fprintf(out,
          "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
          "format=\"appended\" offset=\"%llu\"/>\n",
          a->type, a->name, a->components, (unsigned long long)*offset);
  *offset += sizeof(uint64_t) + (uint64_t)a->size * a->count;
}
