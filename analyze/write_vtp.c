/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK XML PolyData: one vertex per sphere, with its radius and motion as point
   data; raw appended, so that numbers are exact and files small. */
#include <stdlib.h>
#include "program/command_line.h"
#include "writers.h"

enum {
  POINTS,
  ID,
  RADIUS,
  MASS,
  VELOCITY,
  SPIN,
  CONNECTIVITY,
  OFFSETS,
  ARRAYS
};

void write_vtp(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  (void)o;
  const struct bed *b = f->bed;
  const size_t n = b->n;
  int64_t *id = calloc(n + 1, sizeof *id),
          *count = calloc(n + 1, sizeof *count);
  if (!id || !count)
    die(EXIT_IO, "out of memory");
  for (size_t i = 0; i <= n; i++)
    count[i] = (int64_t)i;
  for (size_t i = 0; i < n; i++)
    id[i] = b->id[i];
  const struct vtk_array arrays[ARRAYS] = {
      [POINTS] = {"Points", "Float64", 3, 8, 3 * n, b->x},
      [ID] = {"id", "Int64", 1, 8, n, id},
      [RADIUS] = {"radius", "Float64", 1, 8, n, b->r},
      [MASS] = {"mass", "Float64", 1, 8, n, b->m},
      [VELOCITY] = {"velocity", "Float64", 3, 8, 3 * n, b->v},
      [SPIN] = {"angular_velocity", "Float64", 3, 8, 3 * n, b->w},
      [CONNECTIVITY] = {"connectivity", "Int64", 1, 8, n, count},
      [OFFSETS] = {"offsets", "Int64", 1, 8, n, count + 1}};
  uint64_t offset = 0;
  write_vtk_start(out, "PolyData", "", shape_note(f->shape), b->t);
  fprintf(out,
          "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
          "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
          "<Points>\n",
          n, n);
  write_vtk_element(out, &arrays[POINTS], &offset);
  fprintf(out, "</Points>\n<PointData Scalars=\"radius\" "
               "Vectors=\"velocity\">\n");
  for (int a = ID; a <= SPIN; a++)
    write_vtk_element(out, &arrays[a], &offset);
  fprintf(out, "</PointData>\n<Verts>\n");
  write_vtk_element(out, &arrays[CONNECTIVITY], &offset);
  write_vtk_element(out, &arrays[OFFSETS], &offset);
  fprintf(out, "</Verts>\n</Piece>\n</PolyData>\n"
               "<AppendedData encoding=\"raw\">\n_");
  for (int a = 0; a < ARRAYS; a++) {
    const uint64_t bytes = (uint64_t)arrays[a].size * arrays[a].count;
    write_little_endian(out, &bytes, sizeof bytes, 1);
    write_little_endian(out, arrays[a].data, arrays[a].size, arrays[a].count);
  }
  fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
  free(count);
  free(id);
}
