/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solid fractions. A sphere meets the cells of a row along x in one run and
   holds those of a shorter run whole, so that two roots tell where its surface
   is. The cells that a surface cuts take the time. */
#include "geometry/voxels.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/ball_cell.h"
#include "geometry/volume.h"

struct voxels {
  double box[6];
  size_t cells[3];
  size_t n;
  double *x, *r; /* of the spheres with a volume */
  size_t bridges;
  double (*bridge)[2][3], bridge_radius; /* from one point to another */
  bool walled;
  struct container container;
  double (*plane)[4]; /* its own */
  struct ball_cell rule;
  /* the layer in work: which spheres each of its rows meets */
  size_t rows_size, members_size;
  size_t *start; /* rows + 2 */
  uint32_t *member;
};

/* The contents of a cell: a sphere's number, or one of these. */
static const uint32_t NOTHING = UINT32_MAX, SOLID = UINT32_MAX - 1,
                      SEVERAL = UINT32_MAX - 2, BRIDGED = UINT32_MAX - 3,
                      SLANTED = UINT32_MAX - 4;

static bool grid_valid(const struct solid *s, const double box[6],
                       const size_t cells[3]) {
  for (int k = 0; k < 3; k++) {
    const double low = box[2 * k], high = box[2 * k + 1];
    const double step = (high - low) / (double)cells[k];
    /* more cells than numbers to tell them apart */
    if (!isfinite(low) || !isfinite(high) || !isfinite(high - low) ||
        cells[k] == 0 || !(low + step > low && high - step < high))
      return false;
  }
  for (size_t i = 0; i < s->n; i++)
    if (!isfinite(s->x[3 * i]) || !isfinite(s->x[3 * i + 1]) ||
        !isfinite(s->x[3 * i + 2]) || !isfinite(s->r[i]))
      return false;
  return s->n < SLANTED && s->bridges < SLANTED - s->n;
}

int voxels_open(struct voxels **out, const struct solid *s, const double box[6],
                const size_t cells[3]) {
  if (!grid_valid(s, box, cells))
    return GSL_EINVAL;
  struct voxels *v = calloc(1, sizeof *v);
  if (!v)
    return GSL_ENOMEM;
  memcpy(v->box, box, sizeof v->box);
  memcpy(v->cells, cells, sizeof v->cells);
  v->x = calloc(s->n + 1, 3 * sizeof *v->x);
  v->r = calloc(s->n + 1, sizeof *v->r);
  v->bridge = calloc(s->bridges + 1, sizeof *v->bridge);
  if (s->container) {
    v->walled = true;
    v->container = *s->container;
    v->plane = calloc(s->container->planes + 1, sizeof *v->plane);
    for (size_t k = 0; v->plane && k < s->container->planes; k++)
      memcpy(v->plane[k], s->container->plane[k], sizeof *v->plane);
    v->container.plane = (const double(*)[4])v->plane;
  }
  if (!v->x || !v->r || !v->bridge || (v->walled && !v->plane) ||
      ball_cell_init(&v->rule) != GSL_SUCCESS) {
    voxels_close(v);
    return GSL_ENOMEM;
  }
  for (size_t i = 0; i < s->n; i++)
    if (s->r[i] > 0) {
      memcpy(v->x + 3 * v->n, s->x + 3 * i, 3 * sizeof *v->x);
      v->r[v->n++] = s->r[i];
    }
  v->bridges = s->bridges;
  v->bridge_radius = s->bridge_radius;
  for (size_t b = 0; b < s->bridges; b++)
    for (int end = 0; end < 2; end++)
      memcpy(v->bridge[b][end], s->x + 3 * (size_t)s->ends[b][end],
             sizeof v->bridge[b][end]);
  *out = v;
  return GSL_SUCCESS;
}

void voxels_close(struct voxels *v) {
  if (!v)
    return;
  free(v->member);
  free(v->start);
  free(v->plane);
  free(v->bridge);
  free(v->r);
  free(v->x);
  free(v);
}

/* Face i of the cells along an axis; neighbours share it to the last bit. */
static double edge(const struct voxels *v, int axis, size_t i) {
  const double low = v->box[2 * axis], high = v->box[2 * axis + 1];
  if (i == v->cells[axis])
    return high;
  return low + (high - low) / (double)v->cells[axis] * (double)i;
}

/* As volume_sampled has it, so that both count the same points. */
static double midpoint(const struct voxels *v, int axis, size_t i) {
  const double low = v->box[2 * axis], high = v->box[2 * axis + 1];
  return low + ((double)i + 0.5) * ((high - low) / (double)v->cells[axis]);
}

/* The last face of those along an axis that is not above c, and the first that
   is not below it. */
static size_t edge_below(const struct voxels *v, int axis, double c) {
  const double low = v->box[2 * axis], high = v->box[2 * axis + 1];
  const size_t last = v->cells[axis];
  const double at = (c - low) / (high - low) * (double)last;
  size_t i = !(at > 0) ? 0 : at >= (double)last ? last : (size_t)at;
  while (i > 0 && edge(v, axis, i) > c)
    i--;
  while (i < last && edge(v, axis, i + 1) <= c)
    i++;
  return i;
}

static size_t edge_above(const struct voxels *v, int axis, double c) {
  const size_t i = edge_below(v, axis, c);
  return i < v->cells[axis] && edge(v, axis, i) < c ? i + 1 : i;
}

/* Squares of the nearest and the farthest distance from c to the interval from
   low to high. */
static double nearest2(double c, double low, double high) {
  const double d = fmax(0, fmax(low - c, c - high));
  return d * d;
}

static double farthest2(double c, double low, double high) {
  const double d = fmax(fabs(c - low), fabs(high - c));
  return d * d;
}

/* Runs of cells: *first <= i < *end. Empty runs have *first >= *end. */
static void cells_met(const struct voxels *v, int axis, double c, double reach,
                      size_t *first, size_t *end) {
  *first = edge_below(v, axis, c - reach);
  *end = edge_above(v, axis, c + reach);
}

static void cells_within(const struct voxels *v, int axis, double c,
                         double reach, size_t *first, size_t *end) {
  *first = edge_above(v, axis, c - reach);
  *end = edge_below(v, axis, c + reach);
}

static int grow(void **array, size_t *size, size_t want, size_t bytes) {
  if (want <= *size)
    return GSL_SUCCESS;
  want += want / 2 + 64;
  void *larger = want > SIZE_MAX / bytes ? NULL : realloc(*array, want * bytes);
  if (!larger)
    return GSL_ENOMEM;
  *array = larger;
  *size = want;
  return GSL_SUCCESS;
}

/* Extent of a bridge along an axis. */
static void bridge_extent(const struct voxels *v, size_t b, int axis,
                          double extent[2]) {
  const double p = v->bridge[b][0][axis], q = v->bridge[b][1][axis];
  extent[0] = fmin(p, q) - v->bridge_radius;
  extent[1] = fmax(p, q) + v->bridge_radius;
}

static bool bridge_rows_met(const struct voxels *v, size_t b, size_t k,
                            size_t j0, size_t j1, size_t *first, size_t *end) {
  double x[2], y[2], z[2];
  bridge_extent(v, b, 0, x);
  bridge_extent(v, b, 1, y);
  bridge_extent(v, b, 2, z);
  if (z[0] >= edge(v, 2, k + 1) || z[1] <= edge(v, 2, k) || x[0] >= v->box[1] ||
      x[1] <= v->box[0])
    return false;
  *first = GSL_MAX(edge_below(v, 1, y[0]), j0);
  *end = GSL_MIN(edge_above(v, 1, y[1]), j1);
  return *first < *end;
}

/* Whether the sphere, or the bridge whose number comes after those of all
   spheres, reaches into layer k, and into which of the rows. */
static bool rows_met(const struct voxels *v, size_t i, size_t k, size_t j0,
                     size_t j1, size_t *first, size_t *end) {
  if (i >= v->n)
    return bridge_rows_met(v, i - v->n, k, j0, j1, first, end);
  const double *c = v->x + 3 * i, r = v->r[i];
  const double z2 = nearest2(c[2], edge(v, 2, k), edge(v, 2, k + 1));
  if (z2 >= r * r || c[0] - r >= v->box[1] || c[0] + r <= v->box[0])
    return false;
  cells_met(v, 1, c[1], sqrt(r * r - z2), first, end);
  *first = GSL_MAX(*first, j0);
  *end = GSL_MIN(*end, j1);
  return *first < *end;
}

/* Lists the spheres of each row, in ascending order: member[start[j - j0]] to
   member[start[j - j0 + 1] - 1]. */
static int list_members(struct voxels *v, size_t k, size_t j0, size_t j1) {
  const size_t rows = j1 - j0;
  if (grow((void **)&v->start, &v->rows_size, rows + 2, sizeof *v->start) !=
      GSL_SUCCESS)
    return GSL_ENOMEM;
  memset(v->start, 0, (rows + 2) * sizeof *v->start);
  size_t first, end;
  for (size_t i = 0; i < v->n + v->bridges; i++)
    if (rows_met(v, i, k, j0, j1, &first, &end))
      for (size_t j = first; j < end; j++)
        v->start[j - j0 + 2]++;
  for (size_t j = 2; j < rows + 2; j++)
    v->start[j] += v->start[j - 1];
  if (grow((void **)&v->member, &v->members_size, v->start[rows + 1],
           sizeof *v->member) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t i = 0; i < v->n + v->bridges; i++)
    if (rows_met(v, i, k, j0, j1, &first, &end))
      for (size_t j = first; j < end; j++)
        v->member[v->start[j - j0 + 1]++] = (uint32_t)i;
  return GSL_SUCCESS;
}

/* One row and the scratch that a thread keeps for it: the spheres that the row
   meets, what its cells hold, and room for the spheres of a cell. */
struct row {
  const struct voxels *v;
  size_t count, bridges; /* spheres, and the bridges behind them */
  const uint32_t *member;
  double y[2], z[2];
  uint32_t *holds;
  double *x, *r;
  double (*cut)[2];
};

static double bridge_distance(const struct voxels *v, size_t b,
                              const double p[3]) {
  return solid_cylinder_distance(v->bridge[b][0], v->bridge[b][1],
                                 v->bridge_radius, p);
}

/* Of two spheres the one with the greater power everywhere in a cell,
   |x - c|^2 - r^2, has nothing in it that the other has not. Drops such ones;
   returns how many stay. *overlap tells whether any two of them overlap. */
static size_t drop_covered(struct row *w, size_t count, const double cell[6],
                           bool *overlap) {
  *overlap = false;
  for (size_t j = 1; j < count; j++)
    for (size_t i = 0; i < j; i++) {
      const double *a = w->x + 3 * i, *b = w->x + 3 * j;
      double d2 = 0, power = 0, swing = 0;
      for (int k = 0; k < 3; k++) {
        const double d = b[k] - a[k], twice = cell[2 * k] + cell[2 * k + 1];
        d2 += d * d;
        power += d * (twice - a[k] - b[k]);
        swing += fabs(d) * (cell[2 * k + 1] - cell[2 * k]);
      }
      const double touch = w->r[i] + w->r[j];
      if (d2 >= touch * touch)
        continue;
      power += (w->r[j] - w->r[i]) * touch; /* of i less that of j */
      if (power > -swing && power < swing) {
        *overlap = true;
        continue;
      }
      const size_t gone = power <= -swing ? j : i;
      memmove(w->x + 3 * gone, w->x + 3 * gone + 3,
              3 * (count - gone - 1) * sizeof *w->x);
      memmove(w->r + gone, w->r + gone + 1, (count - gone - 1) * sizeof *w->r);
      return drop_covered(w, count - 1, cell, overlap);
    }
  return count;
}

/* Gathers the spheres of the row that meet a cell; how many. */
static size_t gather(struct row *w, const double cell[6]) {
  size_t count = 0;
  for (size_t m = 0; m < w->count; m++) {
    const size_t i = w->member[m];
    double d2 = 0;
    for (size_t k = 0; k < 3; k++)
      d2 += nearest2(w->v->x[3 * i + k], cell[2 * k], cell[2 * k + 1]);
    if (d2 >= w->v->r[i] * w->v->r[i])
      continue;
    memcpy(w->x + 3 * count, w->v->x + 3 * i, 3 * sizeof *w->x);
    w->r[count++] = w->v->r[i];
  }
  return count;
}

/* A cell that several spheres meet; NaN without memory. */
static double several_volume(struct row *w, const double cell[6]) {
  size_t count = gather(w, cell);
  double sum = 0;
  bool overlap = true;
  if (count <= 16) /* for many spheres it costs more than it saves */
    count = drop_covered(w, count, cell, &overlap);
  if (overlap)
    return volume_union(count, w->x, w->r, cell, &sum) == GSL_SUCCESS ? sum
                                                                      : GSL_NAN;
  for (size_t i = 0; i < count; i++)
    sum += ball_cell_volume(&w->v->rule, w->x + 3 * i, w->r[i], cell);
  return sum;
}

/* Lines through a cell, along either side of its face. */
enum { LINES = 24 };

/* A cell that bridges or slanting walls meet, too. */
static double lines_volume(struct row *w, const double cell[6]) {
  const struct voxels *v = w->v;
  static const double along[3] = {1, 0, 0};
  const size_t count = gather(w, cell);
  const bool slants = v->walled && container_slants(&v->container);
  double sum = 0, p[3] = {0};
  for (int j = 0; j < LINES; j++)
    for (int k = 0; k < LINES; k++) {
      p[1] = cell[2] + (cell[3] - cell[2]) * (j + 0.5) / LINES;
      p[2] = cell[4] + (cell[5] - cell[4]) * (k + 0.5) / LINES;
      size_t cuts = 0;
      double within[2] = {cell[0], cell[1]}, t[2];
      if (slants) {
        const bool any = container_line(&v->container, p, along, t);
        within[0] = any ? fmin(fmax(cell[0], t[0]), cell[1]) : cell[1];
        within[1] = any ? fmax(fmin(cell[1], t[1]), within[0]) : cell[1];
        sum += cell[1] - cell[0] - (within[1] - within[0]);
      }
      for (size_t i = 0; i < count; i++)
        cuts += line_ball(w->x + 3 * i, w->r[i], p, along, w->cut[cuts]);
      for (size_t m = w->count; m < w->count + w->bridges; m++) {
        const size_t b = w->member[m] - v->n;
        cuts += solid_line_cylinder(v->bridge[b][0], v->bridge[b][1],
                                    v->bridge_radius, p, along, w->cut[cuts]);
      }
      sum += solid_covered(cuts, w->cut, within[0], within[1]);
    }
  return sum * (cell[3] - cell[2]) * (cell[5] - cell[4]) / (LINES * LINES);
}

/* Marks the cells of a row that a bridge meets, or fills. */
static void mark_bridge(struct row *w, size_t b) {
  const struct voxels *v = w->v;
  double x[2], half2 = 0;
  bridge_extent(v, b, 0, x);
  const double side[3] = {(v->box[1] - v->box[0]) / (double)v->cells[0],
                          w->y[1] - w->y[0], w->z[1] - w->z[0]};
  for (int k = 0; k < 3; k++)
    half2 += side[k] * side[k] / 4;
  const size_t end = edge_above(v, 0, x[1]);
  for (size_t q = edge_below(v, 0, x[0]); q < end; q++) {
    const double p[3] = {midpoint(v, 0, q), w->y[0] + side[1] / 2,
                         w->z[0] + side[2] / 2};
    const double d = bridge_distance(v, b, p);
    if (d * d >= half2 && d < 0)
      w->holds[q] = SOLID;
    else if (d * d < half2 && w->holds[q] != SOLID)
      w->holds[q] = BRIDGED;
  }
}

/* Marks the cells of a row that slanting walls meet, or fill. */
static void mark_slants(struct row *w) {
  const struct voxels *v = w->v;
  const double side[3] = {(v->box[1] - v->box[0]) / (double)v->cells[0],
                          w->y[1] - w->y[0], w->z[1] - w->z[0]};
  const double half = vec3_norm(side) / 2;
  for (size_t q = 0; q < v->cells[0]; q++) {
    const double p[3] = {midpoint(v, 0, q), w->y[0] + side[1] / 2,
                         w->z[0] + side[2] / 2};
    const double d = container_slant_distance(&v->container, p);
    if (d <= -half)
      w->holds[q] = SOLID;
    else if (d < half && w->holds[q] != SOLID)
      w->holds[q] = SLANTED;
  }
}

/* Marks what the cells of a row hold. */
static void mark(struct row *w) {
  const struct voxels *v = w->v;
  for (size_t i = 0; i < v->cells[0]; i++)
    w->holds[i] = NOTHING;
  for (size_t m = 0; m < w->count; m++) {
    const size_t i = w->member[m];
    const double *c = v->x + 3 * i, r2 = v->r[i] * v->r[i];
    const double near2 =
        nearest2(c[1], w->y[0], w->y[1]) + nearest2(c[2], w->z[0], w->z[1]);
    const double far2 =
        farthest2(c[1], w->y[0], w->y[1]) + farthest2(c[2], w->z[0], w->z[1]);
    size_t first, end, solid = 0, solid_end = 0;
    if (near2 >= r2)
      continue;
    cells_met(v, 0, c[0], sqrt(r2 - near2), &first, &end);
    if (far2 < r2)
      cells_within(v, 0, c[0], sqrt(r2 - far2), &solid, &solid_end);
    for (size_t q = first; q < end; q++)
      if (q >= solid && q < solid_end)
        w->holds[q] = SOLID;
      else if (w->holds[q] == NOTHING)
        w->holds[q] = w->member[m];
      else if (w->holds[q] != SOLID)
        w->holds[q] = SEVERAL;
  }
  for (size_t m = w->count; m < w->count + w->bridges; m++)
    mark_bridge(w, w->member[m] - v->n);
  if (v->walled && container_slants(&v->container))
    mark_slants(w);
}

/* Volume in a cell that holds this. */
static double held_volume(struct row *w, size_t held, const double cell[6]) {
  const struct voxels *v = w->v;
  if (held == SEVERAL)
    return several_volume(w, cell);
  if (held == BRIDGED || held == SLANTED)
    return lines_volume(w, cell);
  return ball_cell_volume(&v->rule, v->x + 3 * held, v->r[held], cell);
}

static bool fraction_row(struct row *w, double *value) {
  const struct voxels *v = w->v;
  bool complete = true;
  mark(w);
  for (size_t i = 0; i < v->cells[0]; i++) {
    const uint32_t held = w->holds[i];
    if (held == NOTHING || held == SOLID) {
      value[i] = held == SOLID;
      continue;
    }
    double cell[6] = {edge(v, 0, i), edge(v, 0, i + 1), w->y[0],
                      w->y[1],       w->z[0],           w->z[1]};
    if (v->walled) {
      cell[0] = fmax(cell[0], v->container.box[0]);
      cell[1] = fmin(cell[1], v->container.box[1]);
      if (!(cell[0] < cell[1])) {
        value[i] = 0;
        continue;
      }
    }
    const double whole =
        (cell[1] - cell[0]) * (cell[3] - cell[2]) * (cell[5] - cell[4]);
    const double volume = held_volume(w, held, cell);
    complete = complete && !isnan(volume);
    /* a sliver or a cell all but filled comes out as rounding has it */
    value[i] = GSL_MIN(GSL_MAX(volume / whole, 0), 1);
  }
  return complete;
}

/* Cuts a range to its part between walls, the share *share of it, which may be
   0. */
static void between_walls(const struct voxels *v, int axis, double range[2],
                          double *share) {
  const double side = range[1] - range[0];
  range[0] = fmax(range[0], v->container.box[2 * axis]);
  range[1] = fmin(range[1], v->container.box[2 * axis + 1]);
  *share = fmax(0, range[1] - range[0]) / side;
}

/* A row with walls: what is within the container, and the rest of each cell. */
static bool walled_row(struct row *w, double *value) {
  const struct voxels *v = w->v;
  double y, z, x;
  between_walls(v, 1, w->y, &y);
  between_walls(v, 2, w->z, &z);
  const bool any = y > 0 && z > 0;
  const bool complete = !any || fraction_row(w, value);
  for (size_t i = 0; i < v->cells[0]; i++) {
    double range[2] = {edge(v, 0, i), edge(v, 0, i + 1)};
    between_walls(v, 0, range, &x);
    const double share = x * y * z;
    if (share < 1)
      value[i] = 1 - share + (share > 0 ? share * value[i] : 0);
  }
  return complete;
}

static void midpoint_row(const struct row *w, double y, double z,
                         double *value) {
  const struct voxels *v = w->v;
  memset(value, 0, v->cells[0] * sizeof *value);
  for (size_t m = 0; m < w->count; m++) {
    const size_t i = w->member[m];
    const double *c = v->x + 3 * i, r2 = v->r[i] * v->r[i];
    const double dy = y - c[1], dz = z - c[2];
    size_t first, end;
    cells_met(v, 0, c[0], v->r[i], &first, &end);
    for (size_t q = first; q < end; q++) {
      const double dx = midpoint(v, 0, q) - c[0];
      if (dx * dx + dy * dy + dz * dz <= r2)
        value[q] = 1;
    }
  }
  for (size_t m = w->count; m < w->count + w->bridges; m++) {
    const size_t b = w->member[m] - v->n;
    double x[2];
    bridge_extent(v, b, 0, x);
    const size_t end = edge_above(v, 0, x[1]);
    for (size_t q = edge_below(v, 0, x[0]); q < end; q++)
      if (bridge_distance(v, b, (double[3]){midpoint(v, 0, q), y, z}) <= 0)
        value[q] = 1;
  }
  for (size_t i = 0; v->walled && i < v->cells[0]; i++)
    if (container_distance(&v->container,
                           (double[3]){midpoint(v, 0, i), y, z}) < 0)
      value[i] = 1;
}

static int by_row(struct voxels *v, enum voxels_value what, size_t k, size_t j0,
                  size_t j1, size_t threads, double *value) {
  (void)threads; /* without OpenMP */
  if (list_members(v, k, j0, j1) != GSL_SUCCESS)
    return GSL_ENOMEM;
  size_t most = 0;
  for (size_t j = 0; j < j1 - j0; j++)
    most = GSL_MAX(most, v->start[j + 1] - v->start[j]);
  int failed = 0;
#pragma omp parallel num_threads(threads) reduction(| : failed)
  {
    struct row w = {.v = v,
                    .holds = calloc(v->cells[0], sizeof *w.holds),
                    .x = calloc(most + 1, 3 * sizeof *w.x),
                    .r = calloc(most + 1, sizeof *w.r),
                    .cut = calloc(most + 1, sizeof *w.cut)};
    failed = !w.holds || !w.x || !w.r || !w.cut;
#pragma omp for schedule(dynamic, 4)
    for (size_t j = j0; j < j1; j++) {
      double *to = value + (j - j0) * v->cells[0];
      w.member = v->member + v->start[j - j0];
      w.bridges = v->start[j - j0 + 1] - v->start[j - j0];
      for (w.count = 0; w.bridges && w.member[w.count] < v->n; w.bridges--)
        w.count++;
      w.z[0] = edge(v, 2, k);
      w.z[1] = edge(v, 2, k + 1);
      w.y[0] = edge(v, 1, j);
      w.y[1] = edge(v, 1, j + 1);
      if (failed)
        continue;
      if (what == VOXELS_MIDPOINT)
        midpoint_row(&w, midpoint(v, 1, j), midpoint(v, 2, k), to);
      else
        failed |= !(v->walled ? walled_row : fraction_row)(&w, to);
    }
    free(w.cut);
    free(w.r);
    free(w.x);
    free(w.holds);
  }
  return failed ? GSL_ENOMEM : GSL_SUCCESS;
}

/* Distances. A block of midpoints is halved until it is small; on the way
   those spheres go that cannot be nearest to any of its points. The candidates
   are at the front of a list that is only ever permuted, so that the halves of
   a block find all of its own there. */
struct block {
  const struct voxels *v;
  size_t k, low[2], high[2]; /* low <= i < high along x and y */
  size_t j0;
  double *value; /* of cell 0 in row j0 */
};

enum { SMALL = 8 };

/* To a sphere, or to a bridge, whose number comes after those of all
   spheres. */
static double surface_distance(const struct voxels *v, size_t i,
                               const double p[3]) {
  if (i >= v->n)
    return bridge_distance(v, i - v->n, p);
  const double *c = v->x + 3 * i;
  const double dx = p[0] - c[0], dy = p[1] - c[1], dz = p[2] - c[2];
  return sqrt(dx * dx + dy * dy + dz * dz) - v->r[i];
}

/* Moves spheres that may be nearest somewhere in the block to the front;
   returns their number. */
static size_t sift(const struct block *b, uint32_t *candidate, size_t count) {
  const struct voxels *v = b->v;
  double p[3], half2 = 0;
  for (int a = 0; a < 2; a++) {
    const double low = midpoint(v, a, b->low[a]);
    const double high = midpoint(v, a, b->high[a] - 1);
    p[a] = low + (high - low) / 2;
    half2 += (high - low) * (high - low) / 4;
  }
  p[2] = midpoint(v, 2, b->k);
  double least = GSL_POSINF, scale = 0;
  for (size_t m = 0; m < count; m++) {
    const size_t i = candidate[m];
    least = fmin(least, surface_distance(v, i, p));
    scale = fmax(scale, i < v->n ? v->r[i] : v->bridge_radius);
  }
  /* a distance changes by no more than the way; and rounding */
  const double most =
      least + 2 * sqrt(half2) + 1e-14 * (scale + fabs(least) + sqrt(half2));
  size_t kept = 0;
  for (size_t m = 0; m < count; m++) {
    const size_t i = candidate[m];
    if (surface_distance(v, i, p) > most)
      continue;
    candidate[m] = candidate[kept];
    candidate[kept++] = (uint32_t)i;
  }
  return kept;
}

static void distances(struct block b, uint32_t *candidate, size_t count) {
  const struct voxels *v = b.v;
  const size_t nx = b.high[0] - b.low[0], ny = b.high[1] - b.low[1];
  if (count > 1)
    count = sift(&b, candidate, count);
  if (count > 1 && (nx > SMALL || ny > SMALL)) {
    const int axis = nx >= ny ? 0 : 1;
    const size_t middle = b.low[axis] + (b.high[axis] - b.low[axis]) / 2;
    struct block half = b;
    half.high[axis] = middle;
    distances(half, candidate, count);
    half = b;
    half.low[axis] = middle;
    distances(half, candidate, count);
    return;
  }
  double p[3] = {0, 0, midpoint(v, 2, b.k)};
  for (size_t j = b.low[1]; j < b.high[1]; j++) {
    double *row = b.value + (j - b.j0) * v->cells[0];
    p[1] = midpoint(v, 1, j);
    for (size_t i = b.low[0]; i < b.high[0]; i++) {
      p[0] = midpoint(v, 0, i);
      double least = GSL_POSINF;
      for (size_t m = 0; m < count; m++) {
        const size_t q = candidate[m];
        const double d = surface_distance(v, q, p);
        least = d < least ? d : least;
      }
      if (v->walled)
        least = fmin(least, container_distance(&v->container, p));
      row[i] = least;
    }
  }
}

static int by_block(const struct voxels *v, size_t k, size_t j0, size_t j1,
                    size_t threads, double *value) {
  /* strips of rows for the threads; the work is uneven */
  const size_t strips = threads > 1 ? GSL_MIN(4 * threads, j1 - j0) : 1;
  int failed = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)             \
    reduction(|                                                                \
              : failed)
  for (size_t s = 0; s < strips; s++) {
    const size_t all = v->n + v->bridges;
    uint32_t *candidate = calloc(all + 1, sizeof *candidate);
    failed |= !candidate;
    for (size_t i = 0; candidate && i < all; i++)
      candidate[i] = (uint32_t)i;
    const struct block b = {
        .v = v,
        .k = k,
        .low = {0, j0 + (j1 - j0) * s / strips},
        .high = {v->cells[0], j0 + (j1 - j0) * (s + 1) / strips},
        .j0 = j0,
        .value = value};
    if (candidate)
      distances(b, candidate, all);
    free(candidate);
  }
  return failed ? GSL_ENOMEM : GSL_SUCCESS;
}

int voxels_rows(struct voxels *v, enum voxels_value what, size_t k, size_t j0,
                size_t j1, size_t threads, double *value) {
  if (what == VOXELS_DISTANCE)
    return by_block(v, k, j0, j1, threads, value);
  return by_row(v, what, k, j0, j1, threads, value);
}
