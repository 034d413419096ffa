/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The binary output of `analyze export`, parsed here by the formats' own
   definitions: STL (a closed surface, its volume), VTK's appended data, voxels.
   Runs the program from the directory B, build by default. */
#define _POSIX_C_SOURCE 200809L
#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include "files/formats.h"
#include "check.h"
#include "geometry/solid.h"
#include "measure/network.h"
#include "geometry/volume.h"

static char bed_path[] = "/tmp/test_export.XXXXXX";

struct bytes {
  size_t count;
  unsigned char *at;
};

static struct bytes run(const char *options) {
  char command[512];
  const char *b = getenv("B");
  snprintf(command, sizeof command, "%s/analyze export --quiet %s %s",
           b ? b : "build", options, bed_path);
  struct bytes all = {0, malloc((1 << 24) + 1)};
  FILE *in = popen(command, "r");
  if (!CHECK(in && all.at))
    exit(check_done());
  all.count = fread(all.at, 1, 1 << 24, in);
  all.at[all.count] = 0;
  CHECK(pclose(in) == 0);
  return all;
}

/* Little-endian numbers by their definition, whatever the machine's order. */
static uint64_t whole_at(const struct bytes *b, size_t at, int size) {
  uint64_t x = 0;
  for (int k = 0; k < size && at + (size_t)k < b->count; k++)
    x |= (uint64_t)b->at[at + (size_t)k] << 8 * k;
  return x;
}

static double double_at(const struct bytes *b, size_t at) {
  const uint64_t bits = whole_at(b, at, 8);
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static float float_at(const struct bytes *b, size_t at) {
  const uint32_t bits = (uint32_t)whole_at(b, at, 4);
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* A floor, sides but for one, and a lid: points and normals. */
enum { WALLS = 5 };
static const double walls[WALLS][6] = {{0, 0, 0, 0, 0, -1},
                                       {0, 0, 0, -1, 0, 0},
                                       {1, 0, 0, 1, 0, 0},
                                       {0, 0, 0, 0, -1, 0},
                                       {0, 0, 1, 0, 0, 1}};

static struct bed make_bed(void) {
  struct bed b;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 1);
  CHECK(bed_alloc(&b, 12) == GSL_SUCCESS);
  b.t = 0.1;
  for (size_t i = 0; i < b.n; i++) {
    b.id[i] = (long)(3 * i + 5);
    b.r[i] = 0.1 + 0.15 * gsl_rng_uniform(rng);
    b.m[i] = 1 + gsl_rng_uniform(rng);
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
      b.x[k] = gsl_rng_uniform(rng);
      b.v[k] = gsl_rng_uniform(rng) - 0.5;
      b.w[k] = gsl_rng_uniform(rng) - 0.5;
    }
  }
  gsl_rng_free(rng);
  struct bed_header header = {0};
  CHECK(bed_header_add(&header, "format", "bed-1") == GSL_SUCCESS);
  /* what scene_default() has, which a bed of other spheres has not */
  static const char *const law[][2] = {{"f0", "10"},    {"kappa", "150"},
                                       {"psi", "10"},   {"vmin", "0.01"},
                                       {"lmax", "0.1"}, {"gravity", "9.81"}};
  for (size_t k = 0; k < sizeof law / sizeof *law; k++)
    CHECK(bed_header_add(&header, law[k][0], law[k][1]) == GSL_SUCCESS);
  for (size_t k = 0; k < WALLS; k++) {
    char text[80];
    snprintf(text, sizeof text, "%g %g %g %g %g %g", walls[k][0], walls[k][1],
             walls[k][2], walls[k][3], walls[k][4], walls[k][5]);
    CHECK(bed_header_add(&header, "wall", text) == GSL_SUCCESS);
  }
  const int fd = mkstemp(bed_path);
  FILE *out = fd < 0 ? NULL : fdopen(fd, "w");
  if (!CHECK(out))
    exit(check_done());
  bed_write_frame(out, &header, &b, true);
  bed_header_free(&header);
  bed_write_status(out, "ok");
  CHECK(fclose(out) == 0);
  return b;
}

/* --- STL -------------------------------------------------------------------
 */

/* A directed edge, its ends as the bytes of their coordinates. */
struct edge {
  unsigned char from[12], to[12];
};

static int compare_edges(const void *a, const void *b) {
  return memcmp(a, b, sizeof(struct edge));
}

/* Each edge is passed as often one way as the other. */
static bool closed(const struct bytes *s, size_t first, size_t count) {
  struct edge *e = calloc(3 * count, sizeof *e), *back;
  back = calloc(3 * count, sizeof *back);
  for (size_t f = 0; f < count; f++)
    for (size_t k = 0; k < 3; k++) {
      const unsigned char *vertex = s->at + 84 + 50 * (first + f) + 12;
      memcpy(e[3 * f + k].from, vertex + 12 * k, 12);
      memcpy(e[3 * f + k].to, vertex + 12 * ((k + 1) % 3), 12);
      memcpy(back[3 * f + k].from, e[3 * f + k].to, 12);
      memcpy(back[3 * f + k].to, e[3 * f + k].from, 12);
    }
  qsort(e, 3 * count, sizeof *e, compare_edges);
  qsort(back, 3 * count, sizeof *back, compare_edges);
  bool ok = true;
  for (size_t i = 0; i < 3 * count; i++)
    ok = ok && !memcmp(&e[i], &back[i], sizeof *e) &&
         (i == 0 || memcmp(&e[i], &e[i - 1], sizeof *e));
  free(back);
  free(e);
  return ok;
}

static void corner(const struct bytes *s, size_t facet, int k, double x[3]) {
  for (int c = 0; c < 3; c++)
    x[c] = float_at(s, 84 + 50 * facet + 12 + 12 * (size_t)k + 4 * (size_t)c);
}

/* Of the facets from `first` on, as seen from c: volume by the divergence
   theorem, least and largest distance of a corner; normals point outwards. */
static double facets_volume(const struct bytes *s, size_t first, size_t count,
                            const double c[3], double *least, double *most) {
  double six = 0;
  bool outwards = true;
  *least = HUGE_VAL;
  *most = 0;
  for (size_t f = first; f < first + count; f++) {
    double x[3][3], along = 0;
    for (int k = 0; k < 3; k++) {
      corner(s, f, k, x[k]);
      double d2 = 0;
      for (int a = 0; a < 3; a++) {
        x[k][a] -= c[a];
        d2 += x[k][a] * x[k][a];
      }
      *least = fmin(*least, sqrt(d2));
      *most = fmax(*most, sqrt(d2));
    }
    for (int a = 0; a < 3; a++) {
      const int p = (a + 1) % 3, q = (a + 2) % 3;
      six += x[0][a] * (x[1][p] * x[2][q] - x[1][q] * x[2][p]);
      along += float_at(s, 84 + 50 * f + 4 * (size_t)a) * x[0][a];
    }
    outwards = outwards && along > 0;
  }
  CHECK(outwards);
  return six / 6;
}

/* Share of the ball in `count` facets each; NaN if anything is amiss. */
static double stl_case(const struct bed *b, const char *options, size_t count,
                       bool on_sphere) {
  const struct bytes s = run(options);
  double share = 0;
  CHECK(whole_at(&s, 80, 4) == count * b->n);
  if (!CHECK(s.count == 84 + 50 * count * b->n))
    return GSL_NAN;
  for (size_t i = 0; i < b->n; i++) {
    double least, most;
    CHECK(closed(&s, i * count, count));
    const double volume =
        facets_volume(&s, i * count, count, b->x + 3 * i, &least, &most);
    share = volume / (4 * M_PI / 3 * gsl_pow_3(b->r[i]));
    /* coordinates of order 1 in single precision */
    CHECK_CLOSE(least, most, 4 * FLT_EPSILON);
    if (on_sphere)
      CHECK_CLOSE(most, b->r[i], 4 * FLT_EPSILON);
  }
  free(s.at);
  return share;
}

static void test_stl(const struct bed *b) {
  /* the icosahedron: 10 (3 + sqrt 5)/(3 (10 + 2 sqrt 5)^(3/2)) 8/(4 pi/3);
     its edge is 4/sqrt(10 + 2 sqrt 5) of the radius, its volume
     5 (3 + sqrt 5)/12 edge^3 */
  const double s5 = sqrt(5), edge = 4 / sqrt(10 + 2 * s5);
  const double want = 5 * (3 + s5) / 12 * gsl_pow_3(edge) / (4 * M_PI / 3);
  /* corners are rounded to single precision of coordinates about 1 */
  const double tol = 3 * 8 * FLT_EPSILON / 0.1;
  CHECK_CLOSE(stl_case(b, "--format stl --facets 20", 20, true), want, tol);
  const double s80 = stl_case(b, "--format stl --facets 21", 80, true);
  const double s320 = stl_case(b, "--format stl", 320, true);
  const double s1280 = stl_case(b, "--format stl --facets 1280", 1280, true);
  /* what is missing falls with the square of the edge; the subdivision's
     unevenness makes the factor a little less than 4 */
  CHECK((1 - s80) / (1 - s320) > 3.5 && (1 - s80) / (1 - s320) < 4.05);
  CHECK((1 - s320) / (1 - s1280) > 3.5 && (1 - s320) / (1 - s1280) < 4.05);
  stl_case(b, "--format stl --facets 81", 180, true);
  CHECK_CLOSE(stl_case(b, "--format stl --facets 80 --equal-volume", 80, false),
              1, tol);
}

/* One surface, all of it, and clipped: closed, of the union's volume. */
static void merged_case(const struct bed *b, const char *options,
                        const double *clip) {
  const struct bytes s = run(options);
  const size_t count = whole_at(&s, 80, 4);
  double whole[6], united = GSL_NAN, least = GSL_POSINF, longest = 0;
  for (int k = 0; k < 3; k++) {
    whole[2 * k] = GSL_POSINF;
    whole[2 * k + 1] = GSL_NEGINF;
    for (size_t i = 0; i < b->n; i++) {
      const double x = b->x[3 * i + (size_t)k];
      whole[2 * k] = fmin(whole[2 * k], x - b->r[i]);
      whole[2 * k + 1] = fmax(whole[2 * k + 1], x + b->r[i]);
      least = fmin(least, b->r[i]);
    }
  }
  const double *box = clip ? clip : whole;
  for (int k = 0; k < 3; k++)
    longest = fmax(longest, box[2 * k + 1] - box[2 * k]);
  CHECK(count > 1000 && s.count == 84 + 50 * count);
  CHECK(closed(&s, 0, count));
  CHECK(volume_union(b->n, b->x, b->r, box, &united) == GSL_SUCCESS);
  double volume = 0;
  for (size_t f = 0; f < count; f++) {
    double x[3][3];
    for (int k = 0; k < 3; k++)
      corner(&s, f, k, x[k]);
    for (int a = 0; a < 3; a++) {
      const int p = (a + 1) % 3, q = (a + 2) % 3;
      volume += x[0][a] * (x[1][p] * x[2][q] - x[1][q] * x[2][p]) / 6;
    }
  }
  const double step = longest / 50;
  CHECK_REL(volume, united, step * step / (least * least) / 3);
  free(s.at);
}

static void test_merged(const struct bed *b) {
  static const double box[6] = {-0.25, 1, 0, 1, 0.125, 1.25};
  merged_case(b, "--format stl --merged --cells 50", NULL);
  merged_case(
      b, "--format stl --merged --cells 50 --box -0.25,1,0,1,0.125,1.25", box);
}

/* Bridges and walls are bodies behind the spheres. */
static void test_bodies(const struct bed *b) {
  const struct bytes s =
      run("--format stl --facets 20 --bridge 0.05 --reach 0.05 --walls "
          "--box -0.25,1.5,-0.25,1,-0.25,1.25");
  const size_t spheres = 20 * b->n, sides = 8, prism = 4 * sides - 4;
  const size_t count = whole_at(&s, 80, 4);
  uint32_t(*ends)[2] = NULL;
  size_t bridges = 0;
  CHECK(solid_pairs(b->n, b->x, b->r, 0.05, &ends, &bridges) == GSL_SUCCESS);
  const struct solid solid = {.n = b->n,
                              .x = b->x,
                              .r = b->r,
                              .bridges = bridges,
                              .ends = (const uint32_t(*)[2])ends,
                              .bridge_radius = 0.05};
  bridges = solid_visible(&solid, ends);
  CHECK(bridges > 2 && count == spheres + prism * bridges + 12 * 5);
  for (size_t k = 0; k < bridges; k++) {
    const double *p = b->x + 3 * ends[k][0], *q = b->x + 3 * ends[k][1];
    double middle[3], length2 = 0, least, most;
    for (int a = 0; a < 3; a++) {
      middle[a] = (p[a] + q[a]) / 2;
      length2 += gsl_pow_2(q[a] - p[a]);
    }
    CHECK(closed(&s, spheres + prism * k, prism));
    const double volume =
        facets_volume(&s, spheres + prism * k, prism, middle, &least, &most);
    const double area =
        (double)sides * sin(2 * M_PI / (double)sides) / 2 * 0.05 * 0.05;
    CHECK_REL(volume, area * sqrt(length2), 1e-4);
    CHECK_CLOSE(most, sqrt(length2 / 4 + 0.05 * 0.05), 4 * FLT_EPSILON);
  }
  static const double plate[5] = {0.25 * 1.25 * 1.5, 0.5 * 1.25 * 1.5,
                                  0.25 * 1.75 * 1.5, 0.25 * 1.75 * 1.25,
                                  0.25 * 1.75 * 1.25};
  for (size_t k = 0; k < 5; k++) {
    const size_t first = spheres + prism * bridges + 12 * k;
    /* seen from its middle */
    double c[3] = {0}, least, most;
    for (size_t f = first; f < first + 12; f++)
      for (int v = 0; v < 3; v++) {
        double x[3];
        corner(&s, f, v, x);
        for (int a = 0; a < 3; a++)
          c[a] += x[a] / 36;
      }
    CHECK(closed(&s, first, 12));
    CHECK_REL(facets_volume(&s, first, 12, c, &least, &most), plate[k], 1e-6);
  }
  free(ends);
  free(s.at);
}

/* Far from the origin single precision runs out. As long as facets are written
   none is without area, surfaces are closed and volumes right; then it is said
   and nothing is written. The edge is a quarter of the radius of 0.1 and more,
   and 64 of the numbers' spacings must fit in: some 4 km. */
static void test_stl_far(const struct bed *b) {
  enum { COUNT = 320 };
  size_t written = 0, refused = 0;
  for (int k = 1; k < 30; k++) {
    const double far = ldexp(1, k);
    char options[160];
    snprintf(options, sizeof options, "--format stl --offset %.0f,%.0f,-%.0f",
             far, far / 2, far);
    char command[512];
    const char *build = getenv("B");
    snprintf(command, sizeof command,
             "%s/analyze export --quiet %s %s 2>&1 >/dev/null | "
             "grep -q '^analyze: .*single precision.*expected --offset'",
             build ? build : "build", options, bed_path);
    if (system(command) == 0) {
      refused++;
      CHECK(far > 1000);
      continue;
    }
    if (!CHECK(far < 10000))
      break;
    CHECK(!refused);
    written++;
    const struct bytes s = run(options);
    for (size_t i = 0; i < b->n; i++) {
      const double c[3] = {b->x[3 * i] + far, b->x[3 * i + 1] + far / 2,
                           b->x[3 * i + 2] - far};
      double least, most;
      CHECK(closed(&s, i * COUNT, COUNT));
      const double volume =
          facets_volume(&s, i * COUNT, COUNT, c, &least, &most);
      /* 0.966151 of a ball; the spacing moves corners by up to half of it */
      CHECK_CLOSE(volume / (4 * M_PI / 3 * gsl_pow_3(b->r[i])), 0.966151,
                  1e-6 + 3 * far * FLT_EPSILON / b->r[i]);
      CHECK_CLOSE(least, most, 4 * (1 + far) * FLT_EPSILON);
      for (size_t q = i * COUNT; q < (i + 1) * COUNT; q++)
        for (int e = 0; e < 3; e++) {
          double x[3], y[3];
          corner(&s, q, e, x);
          corner(&s, q, (e + 1) % 3, y);
          CHECK(x[0] != y[0] || x[1] != y[1] || x[2] != y[2]);
        }
    }
    free(s.at);
  }
  CHECK(written > 9 && refused > 10);
}

/* --- VTK -------------------------------------------------------------------
 */

/* Where the appended data begin, after the underscore. */
static size_t appended(const struct bytes *b) {
  static const char tag[] = "<AppendedData encoding=\"raw\">\n_";
  for (size_t i = 0; i + sizeof tag < b->count; i++)
    if (!memcmp(b->at + i, tag, sizeof tag - 1))
      return i + sizeof tag - 1;
  CHECK(!"appended data found");
  return 0;
}

/* The offset that the element of an array gives. */
static size_t offset_of(const struct bytes *b, const char *name) {
  char want[64];
  snprintf(want, sizeof want, "Name=\"%s\"", name);
  char *element = strstr((char *)b->at, want);
  char *offset = element ? strstr(element, "offset=\"") : NULL;
  CHECK(offset != NULL);
  return offset ? strtoull(offset + 8, NULL, 10) : 0;
}

/* Vectors have three components, all others one. */
static void check_components(const struct bytes *b) {
  size_t arrays = 0;
  const char *at = strstr((const char *)b->at, "<Piece ");
  CHECK(at != NULL);
  for (; at && (at = strstr(at, "<DataArray ")) != NULL; at++) {
    char type[20], name[40];
    size_t components = 0;
    CHECK(sscanf(at,
                 "<DataArray type=\"%19[^\"]\" Name=\"%39[^\"]\" "
                 "NumberOfComponents=\"%zu\"",
                 type, name, &components) == 3);
    const bool vector = !strcmp(name, "Points") || strstr(name, "velocity");
    if (!CHECK(components == (vector ? 3 : 1)))
      fprintf(stderr, "  %s\n", name);
    arrays++;
  }
  CHECK(arrays > 6);
}

static void doubles_case(const struct bytes *b, const char *name, size_t count,
                         const double *want) {
  const size_t at = appended(b) + offset_of(b, name);
  CHECK(whole_at(b, at, 8) == 8 * count);
  bool same = true;
  for (size_t i = 0; i < count; i++)
    same = same && double_at(b, at + 8 + 8 * i) == want[i];
  CHECK(same);
}

static void test_vtp(const struct bed *bed) {
  const struct bytes b = run("--format vtp");
  check_components(&b);
  doubles_case(&b, "Points", 3 * bed->n, bed->x);
  doubles_case(&b, "radius", bed->n, bed->r);
  doubles_case(&b, "mass", bed->n, bed->m);
  doubles_case(&b, "velocity", 3 * bed->n, bed->v);
  doubles_case(&b, "angular_velocity", 3 * bed->n, bed->w);
  for (size_t i = 0; i < bed->n; i++) {
    const size_t data = appended(&b) + 8 + 8 * i;
    CHECK(whole_at(&b, data + offset_of(&b, "id"), 8) == (uint64_t)bed->id[i]);
    CHECK(whole_at(&b, data + offset_of(&b, "connectivity"), 8) == i);
    CHECK(whole_at(&b, data + offset_of(&b, "offsets"), 8) == i + 1);
  }
  free(b.at);
}

/* Contacts as lines, in the order of the network. */
static void test_network(const struct bed *bed) {
  struct scene scene = scene_default();
  for (size_t k = 0; k < WALLS; k++)
    CHECK(scene_add_wall(&scene, walls[k], walls[k] + 3) == GSL_SUCCESS);
  struct network w = {0};
  CHECK(network_find(&w, &scene, bed, 0) == GSL_SUCCESS);
  network_mark(&w, 0, 0);
  const struct bytes b = run("--format vtp --network --scale 2");
  check_components(&b);
  size_t count = 0, feet = 0;
  double *normal = calloc(bed->n + w.count, sizeof *normal),
         *gap = calloc(bed->n + w.count, sizeof *gap);
  for (size_t p = 0; p < w.count; p++)
    if (w.at[p].counts) {
      normal[bed->n + count] = w.at[p].normal;
      gap[bed->n + count++] = 2 * w.at[p].gap;
      feet += w.at[p].wall;
    }
  CHECK(count > 10 && feet > 3);
  doubles_case(&b, "normal_force", bed->n + count, normal);
  doubles_case(&b, "gap", bed->n + count, gap);
  /* every line is as long as its bodies are apart, twice */
  char *lines = strstr((char *)b.at, "<Lines>");
  CHECK(lines != NULL);
  const struct bytes rest = {b.count - (size_t)(lines - (char *)b.at),
                             (unsigned char *)lines};
  const size_t at = appended(&b) + 8;
  const size_t from = at + offset_of(&rest, "connectivity");
  const size_t points = at + offset_of(&b, "Points");
  CHECK(whole_at(&b, from - 8, 8) == 16 * count);
  CHECK(whole_at(&b, points - 8, 8) == 24 * (bed->n + feet));
  for (size_t p = 0, line = 0; p < w.count; p++) {
    const struct network_contact *c = &w.at[p];
    if (!c->counts)
      continue;
    double d2 = 0;
    const size_t i = whole_at(&b, from + 16 * line, 8);
    const size_t j = whole_at(&b, from + 16 * line + 8, 8);
    CHECK(i == c->i && (c->wall ? j >= bed->n : j == c->j));
    for (size_t k = 0; k < 3; k++)
      d2 += gsl_pow_2(double_at(&b, points + 24 * i + 8 * k) -
                      double_at(&b, points + 24 * j + 8 * k));
    CHECK_CLOSE(sqrt(d2),
                2 * (c->gap + bed->r[i] + (c->wall ? 0 : bed->r[c->j])), 1e-14);
    line++;
  }
  free(gap);
  free(normal);
  free(b.at);
  network_free(&w);
  scene_free(&scene);
}

/* --- voxels ----------------------------------------------------------------
 */

static void test_voxels(const struct bed *bed) {
  static const double box[6] = {-0.25, 1, 0, 1, 0.125, 1.25};
#define GRID "--box -0.25,1,0,1,0.125,1.25 --cells 20,16,24 "
  enum { COUNT = 20 * 16 * 24 };
  const double whole = 1.25 * 1.125 / COUNT;
  const struct bytes f = run("--format raw " GRID);
  CHECK(f.count == 8 * COUNT);
  long double sum = 0;
  for (size_t i = 0; i < COUNT; i++)
    sum += double_at(&f, 8 * i);
  double united;
  CHECK(volume_union(bed->n, bed->x, bed->r, box, &united) == GSL_SUCCESS);
  CHECK_REL((double)sum * whole, united, 1e-12);
  /* each cell, x fastest; tolerance: volume_union's rounding of a ball */
  const double tol = 64 * DBL_EPSILON * gsl_pow_3(0.25) / whole;
  double worst = 0;
  for (size_t i = 0; i < COUNT; i++) {
    const size_t at[3] = {i % 20, i / 20 % 16, i / 320};
    static const double h[3] = {0.0625, 0.0625, 0.046875};
    double cell[6], part = GSL_NAN;
    for (int k = 0; k < 3; k++) {
      cell[2 * k] = box[2 * k] + h[k] * (double)at[k];
      cell[2 * k + 1] = cell[2 * k] + h[k];
    }
    CHECK(volume_union(bed->n, bed->x, bed->r, cell, &part) == GSL_SUCCESS);
    const double d = fabs(double_at(&f, 8 * i) - part / whole);
    worst = d <= worst ? worst : d; /* NaN stays */
  }
  CHECK_CLOSE(worst, 0, tol);

  const struct bytes image = run("--format vti " GRID);
  const size_t at = appended(&image);
  CHECK(whole_at(&image, at, 8) == f.count);
  CHECK(image.count > at + 8 + f.count &&
        !memcmp(image.at + at + 8, f.at, f.count));
  const struct bytes single = run("--format raw --type float32 " GRID);
  const struct bytes solid = run("--format raw --binary --threads 2 " GRID);
  const struct bytes distance = run("--format raw --distance " GRID);
  CHECK(single.count == 4 * COUNT && solid.count == COUNT &&
        distance.count == 8 * COUNT);
  bool rounded = true, agree = true, certain = true;
  for (size_t i = 0; i < COUNT; i++) {
    const double d = double_at(&distance, 8 * i), s = double_at(&f, 8 * i);
    rounded = rounded && float_at(&single, 4 * i) == (float)s;
    agree = agree && solid.at[i] == (d <= 0);
    /* further from the surface than a cell's half diagonal, below 0.08 */
    certain = certain && (d < 0.08 || s == 0) && (d > -0.08 || s == 1);
  }
  CHECK(rounded);
  CHECK(agree);
  CHECK(certain);
  free(distance.at);
  free(solid.at);
  free(single.at);
  free(image.at);
  free(f.at);
}

int main(void) {
  gsl_set_error_handler_off();
  struct bed b = make_bed();
  test_stl(&b);
  test_merged(&b);
  test_bodies(&b);
  test_stl_far(&b);
  test_vtp(&b);
  test_network(&b);
  test_voxels(&b);
  unlink(bed_path);
  bed_free(&b);
  return check_done();
}
