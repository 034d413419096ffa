/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK XML PolyData: one vertex per sphere, with its radius and motion as point
   data, and with --network one line per contact, with its forces as cell data;
   raw appended, so that numbers are exact and files small. */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/radius_keys.h"
#include "measure.h"
#include "measure/network.h"
#include "program/command_line.h"
#include "writers.h"

/* The places of arrays in the file. */
enum {
  POINTS,
  ID, /* point data from here */
  RADIUS,
  MASS,
  VELOCITY,
  SPIN,
  CONNECTIVITY,
  OFFSETS,
  LINES, /* what follows is of contacts */
  LINE_OFFSETS,
  NORMAL, /* cell data from here */
  FRICTION,
  GAP,
  ARRAYS
};

/* Lines from centre to centre, or from a centre to a point of its own, behind
   those of the spheres: its foot on a wall, or the copy of the other centre
   across a periodic side. */
struct lines {
  size_t count, feet, walls;
  double *points; /* 3 for each sphere and foot */
  int64_t *ends, *offsets;
  double *normal, *friction, *gap; /* of vertices and lines */
};

/* All contacts at the radius that the bed settled with. */
static void find_contacts(const struct shape *s, struct network *w) {
  struct bed b;
  frame_check(s->frames, s->source, bed_copy(&b, s->source));
  const double dynamics = radius_dynamics(s->header);
  for (size_t i = 0; i < b.n && dynamics > 0; i++)
    b.r[i] = dynamics;
  struct scene scene = frame_scene(s->frames, s->source);
  frame_check(s->frames, s->source, network_find(w, &scene, &b, 0));
  network_mark(w, 0, 0);
  scene_free(&scene);
  bed_free(&b);
}

static double radius_of(const struct shape *s, size_t i) {
  const double dynamics = radius_dynamics(s->header);
  return dynamics > 0 ? dynamics : s->source->r[i];
}

/* From centre i to the other end of its line (m). */
static double way(const struct shape *s, const struct network_contact *c) {
  return radius_of(s, c->i) + c->gap + (c->wall ? 0 : radius_of(s, c->j));
}

/* Does the line end at a point of its own? */
static bool has_foot(const struct shape *s, const struct network_contact *c) {
  if (c->wall)
    return true;
  double d[3];
  vec3_sub(s->source->x + 3 * c->i, s->source->x + 3 * c->j, d);
  vec3_axpy(-way(s, c), c->n, d);
  return vec3_norm(d) > radius_of(s, c->i);
}

static struct lines make_lines(const struct shape *s) {
  const struct bed *b = &s->bed;
  struct network w = {0};
  find_contacts(s, &w);
  struct lines l = {0};
  for (size_t p = 0; p < w.count; p++) {
    l.count += w.at[p].counts;
    l.feet += w.at[p].counts && has_foot(s, &w.at[p]);
    l.walls += w.at[p].counts && w.at[p].wall;
  }
  const size_t cells = b->n + l.count;
  l.points = measure_alloc(3 * (b->n + l.feet), sizeof *l.points);
  l.ends = measure_alloc(2 * l.count, sizeof *l.ends);
  l.offsets = measure_alloc(l.count, sizeof *l.offsets);
  l.normal = measure_alloc(cells, sizeof *l.normal);
  l.friction = measure_alloc(cells, sizeof *l.friction);
  l.gap = measure_alloc(cells, sizeof *l.gap);
  memcpy(l.points, b->x, 3 * b->n * sizeof *l.points);
  size_t line = 0, foot = b->n;
  for (size_t p = 0; p < w.count; p++) {
    const struct network_contact *c = &w.at[p];
    if (!c->counts)
      continue;
    const bool own = has_foot(s, c);
    l.ends[2 * line] = (int64_t)c->i;
    l.ends[2 * line + 1] = (int64_t)(own ? foot : c->j);
    l.offsets[line] = 2 * (int64_t)(line + 1);
    l.normal[b->n + line] = c->normal;
    l.friction[b->n + line] = vec3_norm(c->friction);
    l.gap[b->n + line] = s->scale * c->gap;
    line++;
    if (!own)
      continue;
    memcpy(l.points + 3 * foot, b->x + 3 * c->i, 3 * sizeof *l.points);
    vec3_axpy(-s->scale * way(s, c), c->n, l.points + 3 * foot);
    foot++;
  }
  network_free(&w);
  return l;
}

static void lines_free(struct lines *l) {
  free(l->points);
  free(l->ends);
  free(l->offsets);
  free(l->normal);
  free(l->friction);
  free(l->gap);
}

/* A sphere's numbers with zeros behind them for the feet. */
static double *padded(const double *x, size_t count, size_t feet) {
  double *all = measure_alloc(count + feet, sizeof *all);
  memcpy(all, x, count * sizeof *all);
  return all;
}

void write_vtp(FILE *out, const struct write_frame *f,
               const struct write_options *o) {
  const struct bed *b = f->bed;
  struct lines l = {0};
  if (o->network)
    l = make_lines(f->shape);
  const size_t n = b->n, points = n + l.feet;
  int64_t *id = measure_alloc(points, sizeof *id),
          *count = measure_alloc(n + 1, sizeof *count);
  for (size_t i = 0; i <= n; i++)
    count[i] = (int64_t)i;
  for (size_t i = 0; i < points; i++)
    id[i] = i < n ? b->id[i] : -1;
  double *r = padded(b->r, n, l.feet), *m = padded(b->m, n, l.feet);
  double *v = padded(b->v, 3 * n, 3 * l.feet);
  double *w = padded(b->w, 3 * n, 3 * l.feet);
  const struct vtk_array arrays[ARRAYS] = {
      [POINTS] = {"Points", "Float64", 3, 8, 3 * points,
                  l.points ? l.points : b->x},
      [ID] = {"id", "Int64", 1, 8, points, id},
      [RADIUS] = {"radius", "Float64", 1, 8, points, r},
      [MASS] = {"mass", "Float64", 1, 8, points, m},
      [VELOCITY] = {"velocity", "Float64", 3, 8, 3 * points, v},
      [SPIN] = {"angular_velocity", "Float64", 3, 8, 3 * points, w},
      [CONNECTIVITY] = {"connectivity", "Int64", 1, 8, n, count},
      [OFFSETS] = {"offsets", "Int64", 1, 8, n, count + 1},
      [LINES] = {"connectivity", "Int64", 1, 8, 2 * l.count, l.ends},
      [LINE_OFFSETS] = {"offsets", "Int64", 1, 8, l.count, l.offsets},
      [NORMAL] = {"normal_force", "Float64", 1, 8, n + l.count, l.normal},
      [FRICTION] = {"friction_force", "Float64", 1, 8, n + l.count, l.friction},
      [GAP] = {"gap", "Float64", 1, 8, n + l.count, l.gap}};
  const int last = o->network ? ARRAYS : LINES;
  uint64_t offset = 0;
  write_vtk_start(out, "PolyData", "", f);
  fprintf(out,
          "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
          "NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
          "<Points>\n",
          points, n, l.count);
  write_vtk_element(out, &arrays[POINTS], &offset);
  fprintf(out, "</Points>\n<PointData Scalars=\"radius\" "
               "Vectors=\"velocity\">\n");
  for (int a = ID; a <= SPIN; a++)
    write_vtk_element(out, &arrays[a], &offset);
  fprintf(out, "</PointData>\n<Verts>\n");
  write_vtk_element(out, &arrays[CONNECTIVITY], &offset);
  write_vtk_element(out, &arrays[OFFSETS], &offset);
  fprintf(out, "</Verts>\n");
  if (o->network) {
    fprintf(out, "<Lines>\n");
    write_vtk_element(out, &arrays[LINES], &offset);
    write_vtk_element(out, &arrays[LINE_OFFSETS], &offset);
    fprintf(out, "</Lines>\n<CellData>\n");
    for (int a = NORMAL; a < ARRAYS; a++)
      write_vtk_element(out, &arrays[a], &offset);
    fprintf(out, "</CellData>\n");
    shape_add(
        f->shape,
        "%zu contacts as lines, %zu of them to walls, %zu across periodic "
        "sides, at the radius of the dynamics",
        l.count, l.walls, l.feet - l.walls);
  }
  fprintf(out, "</Piece>\n</PolyData>\n"
               "<AppendedData encoding=\"raw\">\n_");
  for (int a = 0; a < last; a++) {
    const uint64_t bytes = (uint64_t)arrays[a].size * arrays[a].count;
    write_little_endian(out, &bytes, sizeof bytes, 1);
    write_little_endian(out, arrays[a].data, arrays[a].size, arrays[a].count);
  }
  fprintf(out, "\n</AppendedData>\n</VTKFile>\n");
  free(w);
  free(v);
  free(m);
  free(r);
  free(count);
  free(id);
  lines_free(&l);
}
