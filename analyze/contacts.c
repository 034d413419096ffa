/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contacts: coordination, rattlers, overlaps, fabric, loads on floor and walls;
   or the distributions, or the force network itself. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "geometry/periodic.h"
#include "measure/network.h"
#include "program/shared_options.h"
#include "tabulate.h"
#include "verbs.h"

/* Without friction it takes at least 4 contacts to hold a sphere from all
   sides; with friction 2 can suffice. */
enum { LEAST_SMOOTH = 4, LEAST_ROUGH = 2 };

struct contacts {
  struct option_list box;
  double gap, force, bin;
  size_t least;
  bool degrees, overlaps, network;
};

/* A frame and the quantities that are measured of it. */
struct measured {
  const struct contacts *set;
  const struct bed *bed;
  const struct scene *scene;
  struct network network;
  const double *box; /* NULL: everywhere */
  bool *inside, *rattler;
  size_t *degree, *with_spheres; /* of all; and without rattlers: */
  size_t *rigid, *rigid_spheres;
  double weight; /* of all spheres (N) */
};

static double total_weight(const struct scene *s, const struct bed *b) {
  double mass = 0;
  for (size_t i = 0; i < b->n; i++)
    mass += bed_is_fixed(b, i) ? 0 : b->m[i];
  return mass * vec3_norm(s->gravity);
}

static struct measured measure(const struct frames *f,
                               const struct contacts *set,
                               const struct scene *scene, const struct bed *b) {
  struct measured m = {.set = set,
                       .bed = b,
                       .scene = scene,
                       .box = set->box.count ? set->box.at : NULL,
                       .weight = total_weight(scene, b)};
  /* the pairs that can count, and all that overlap */
  const double reach = set->force > 0 ? scene->law.lmax : GSL_MAX(set->gap, 0);
  frame_check(f, b, network_find(&m.network, scene, b, reach));
  const double force = set->force * m.weight / (double)b->n;
  if (set->force > 0 && !(force > 0))
    frame_refuse(f, b,
                 "--force is a share of a sphere's weight, expected gravity");
  network_mark(&m.network, set->gap, force);
  m.inside = measure_alloc(b->n, sizeof *m.inside);
  m.rattler = measure_alloc(b->n, sizeof *m.rattler);
  m.degree = measure_alloc(4 * b->n, sizeof *m.degree);
  m.with_spheres = m.degree + b->n;
  m.rigid = m.degree + 2 * b->n;
  m.rigid_spheres = m.degree + 3 * b->n;
  for (size_t i = 0; i < b->n; i++)
    m.inside[i] =
        !bed_is_fixed(b, i) &&
        (!m.box || periodic_in_box(scene->period, m.box, b->x + 3 * i));
  const size_t least = set->least                  ? set->least
                       : scene_has_friction(scene) ? LEAST_ROUGH
                                                   : LEAST_SMOOTH;
  frame_check(f, b, network_rattlers(&m.network, least, b->fixed, m.rattler));
  network_degrees(&m.network, NULL, m.degree, m.with_spheres);
  network_degrees(&m.network, m.rattler, m.rigid, m.rigid_spheres);
  return m;
}

static void measured_free(struct measured *m) {
  network_free(&m->network);
  free(m->inside);
  free(m->rattler);
  free(m->degree);
}

static bool within(const struct measured *m, const struct network_contact *c) {
  double x[3];
  network_point(c, m->bed, x);
  return !m->box || periodic_in_box(m->scene->period, m->box, x);
}

/* In diameters: the mean of both, or the sphere's own at a wall. */
static double overlap(const struct measured *m,
                      const struct network_contact *c) {
  const double *r = m->bed->r;
  return -c->gap / (c->wall ? 2 * r[c->i] : r[c->i] + r[c->j]);
}

struct mean {
  size_t count;
  double sum, most;
};

static void add(struct mean *m, double x) {
  m->count++;
  m->sum += x;
  m->most = GSL_MAX(m->most, x);
}

static double mean(const struct mean *m) {
  return m->count ? m->sum / (double)m->count : GSL_NAN;
}

/* Shares of the weight that walls carry, by their force along gravity: the
   floor, where the normal is within 45 degrees of gravity, and all others. */
static void loads(const struct measured *m, double *floor, double *sides) {
  const struct scene *s = m->scene;
  const double g = vec3_norm(s->gravity);
  *floor = *sides = 0;
  for (size_t p = 0; p < m->network.count; p++) {
    const struct network_contact *c = &m->network.at[p];
    if (!c->wall || !(s->walls[c->j].radius > 0))
      continue; /* a plane's share is added up as a whole */
    double load[3] = {0};
    vec3_axpy(-c->normal, c->n, load);
    vec3_axpy(-1, c->friction, load);
    const double share = vec3_dot(load, s->gravity) / g / m->weight;
    if (-vec3_dot(c->n, s->gravity) > M_SQRT1_2 * g)
      *floor += share;
    else
      *sides += share;
  }
  for (size_t k = 0; k < s->walls_count; k++) {
    double load[3];
    if (s->walls[k].radius > 0)
      continue;
    network_wall_load(&m->network, k, load);
    const double share = vec3_dot(load, s->gravity) / g / m->weight;
    if (vec3_dot(s->walls[k].normal, s->gravity) > M_SQRT1_2 * g)
      *floor += share;
    else
      *sides += share;
  }
  if (!(m->weight > 0))
    *floor = *sides = GSL_NAN;
}

static void print_row(struct table *table, const struct measured *m) {
  struct mean z = {0}, z_spheres = {0}, rigid = {0}, rigid_spheres = {0};
  struct mean overlaps[2] = {{0}, {0}}; /* of pairs, at walls */
  size_t rattlers = 0, walls = 0;
  for (size_t i = 0; i < m->bed->n; i++) {
    if (!m->inside[i])
      continue;
    add(&z, (double)m->degree[i]);
    add(&z_spheres, (double)m->with_spheres[i]);
    rattlers += m->rattler[i];
    if (m->rattler[i])
      continue;
    add(&rigid, (double)m->rigid[i]);
    add(&rigid_spheres, (double)m->rigid_spheres[i]);
  }
  for (size_t p = 0; p < m->network.count; p++) {
    const struct network_contact *c = &m->network.at[p];
    if (!within(m, c))
      continue;
    walls += c->counts && c->wall;
    if (c->gap < 0)
      add(&overlaps[c->wall], overlap(m, c));
  }
  double fabric[6], floor, sides;
  const size_t pairs = network_fabric(&m->network, m->bed, m->box, fabric);
  loads(m, &floor, &sides);
  table_frame(
      table, TABLE_ROWS,
      "t\tspheres\tpairs\twall_contacts\tz\tz_spheres\trattlers\tz_rigid\t"
      "z_rigid_spheres\toverlap_mean\toverlap_max\twall_overlap_mean\t"
      "wall_overlap_max\tfloor\tsides\tfabric_xx\tfabric_yy\tfabric_zz\t"
      "fabric_xy\tfabric_xz\tfabric_yz\tanisotropy");
  table_number(table, m->bed->t);
  table_count(table, z.count);
  table_count(table, pairs);
  table_count(table, walls);
  table_number(table, mean(&z));
  table_number(table, mean(&z_spheres));
  table_count(table, rattlers);
  table_number(table, mean(&rigid));
  table_number(table, mean(&rigid_spheres));
  for (int k = 0; k < 2; k++) {
    table_number(table, overlaps[k].count ? mean(&overlaps[k]) : 0);
    table_number(table, overlaps[k].most);
  }
  table_number(table, floor);
  table_number(table, sides);
  for (int k = 0; k < 6; k++)
    table_number(table, pairs ? fabric[k] : GSL_NAN);
  table_number(table, pairs ? network_anisotropy(fabric) : GSL_NAN);
  table_end_row(table);
}

static void print_degrees(struct table *table, const struct measured *m) {
  size_t most = 0;
  for (size_t i = 0; i < m->bed->n; i++)
    most = GSL_MAX(most, m->degree[i]);
  size_t *count = measure_alloc(3 * (most + 1), sizeof *count);
  for (size_t i = 0; i < m->bed->n; i++)
    if (m->inside[i]) {
      count[3 * m->degree[i]]++;
      count[3 * m->with_spheres[i] + 1]++;
      count[3 * m->rigid[i] + 2] += !m->rattler[i];
    }
  table_frame(table, TABLE_BLOCKS,
              "t\tcontacts\tspheres\tspheres_by_spheres\tspheres_rigid");
  for (size_t c = 0; c <= most; c++) {
    table_number(table, m->bed->t);
    table_count(table, c);
    for (int k = 0; k < 3; k++)
      table_count(table, count[3 * c + (size_t)k]);
    table_end_row(table);
  }
  free(count);
}

/* Far outside of a wall an overlap has no end. */
enum { MOST_BINS = 1000000 };

/* Bin of an overlap, MOST_BINS beyond the last, or SIZE_MAX where there is
   none. */
static size_t overlap_bin(const struct measured *m,
                          const struct network_contact *c) {
  return c->gap < 0 && within(m, c)
             ? (size_t)GSL_MIN(overlap(m, c) / m->set->bin, MOST_BINS)
             : SIZE_MAX;
}

static void print_overlaps(struct table *table, const struct frames *f,
                           const struct measured *m) {
  const struct network *w = &m->network;
  size_t bins = 0;
  for (size_t p = 0; p < w->count; p++) {
    const size_t bin = overlap_bin(m, &w->at[p]);
    if (bin != SIZE_MAX)
      bins = GSL_MAX(bins, bin + 1);
  }
  if (bins > MOST_BINS)
    frame_refuse(f, m->bed,
                 "an overlap of more than a million bins, expected spheres "
                 "inside of their walls or a wider --bin");
  size_t *count = measure_alloc(2 * bins, sizeof *count);
  for (size_t p = 0; p < w->count; p++) {
    const size_t bin = overlap_bin(m, &w->at[p]);
    if (bin != SIZE_MAX)
      count[2 * bin + w->at[p].wall]++;
  }
  table_frame(table, TABLE_BLOCKS, "t\toverlap\tpairs\twall_contacts");
  for (size_t k = 0; k < bins; k++) {
    table_number(table, m->bed->t);
    table_number(table, ((double)k + 0.5) * m->set->bin);
    table_count(table, count[2 * k]);
    table_count(table, count[2 * k + 1]);
    table_end_row(table);
  }
  free(count);
}

static void print_network(struct table *table, struct frames *f,
                          const struct measured *m) {
  const struct bed *b = m->bed;
  table_frame(table, TABLE_BLOCKS,
              "t\ti\tj\twall\tx\ty\tz\tnormal\ttangential\tgap\tnx\tny\tnz");
  for (size_t p = 0; p < m->network.count; p++) {
    const struct network_contact *c = &m->network.at[p];
    double x[3];
    frames_tell(f, (double)p / (double)m->network.count);
    if (!c->counts || !within(m, c))
      continue;
    network_point(c, b, x);
    table_number(table, b->t);
    table_id(table, b->id[c->i]);
    table_id(table, b->id[c->wall ? c->i : c->j]);
    table_count(table, c->wall ? c->j + 1 : 0);
    for (int k = 0; k < 3; k++)
      table_number(table, x[k]);
    table_number(table, c->normal);
    table_number(table, vec3_norm(c->friction));
    table_number(table, c->gap);
    for (int k = 0; k < 3; k++)
      table_number(table, c->n[k]);
    table_end_row(table);
  }
}

static void print_frame(struct tabulation *t, const void *context) {
  const struct contacts *set = context;
  struct frames *f = &t->frames;
  struct scene scene = frame_scene(f, &t->bed);
  tabulation_see(t, &set->box);
  if (f->first)
    frame_warn_rewritten(f);
  struct measured m = measure(f, set, &scene, &t->bed);
  if (set->degrees)
    print_degrees(&t->table, &m);
  else if (set->overlaps)
    print_overlaps(&t->table, f, &m);
  else if (set->network)
    print_network(&t->table, f, &m);
  else
    print_row(&t->table, &m);
  measured_free(&m);
  scene_free(&scene);
}

int verb_contacts(int argc, char **argv) {
  struct contacts set = {.bin = 0.005};
  struct frames_options input = {.many = true, .scene = true};
  bool means = false;
  /* clang-format off */
  struct option_spec options[] = {
      NUMBER("gap", &set.gap, -OPTION_MANY, OPTION_MANY, "m",
             "surfaces no further apart are a contact"),
      NUMBER("force", &set.force, 0, OPTION_MANY,
             "mean weights of a sphere; 0: by --gap",
             "surfaces that push at least this hard are a contact"),
      {.name = "least", .type = OPTION_SIZE, .value = &set.least,
       .most = 100, .unit = "0: 4, or 2 with friction",
       .help = "fewest contacts of a sphere that is no rattler"},
      BOX_OPTION(set.box, "spheres by centre and contacts in a box only"),
      {.name = "degrees", .type = OPTION_FLAG, .value = &set.degrees,
       .help = "one block per frame: spheres by their number of contacts"},
      {.name = "overlaps", .type = OPTION_FLAG, .value = &set.overlaps,
       .help = "one block per frame: histogram of the overlaps"},
      NUMBER("bin", &set.bin, 1e-4, 1, "diameters", "width of its bins"),
      {.name = "network", .type = OPTION_FLAG, .value = &set.network,
       .help = "one block per frame: the contacts with their forces"},
      MEAN_OPTION(means),
      ORIGIN_OPTION(input),
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Contacts of the spheres, one row per frame. The model's repulsion\n"
          "has no end, so a contact has to be defined: by a gap of at most\n"
          "--gap, or by a normal force of at least --force.\n"
          "  t                    time (s)\n"
          "  spheres              spheres that are looked at: obstacles are\n"
          "                       none of them, but partners\n"
          "  pairs wall_contacts  contacts of two spheres, of sphere and wall\n"
          "  z z_spheres          mean contacts of a sphere, with walls and\n"
          "                       without\n"
          "  rattlers             spheres with fewer than --least contacts,\n"
          "                       walls included, and spheres that have\n"
          "                       fewer once those are taken out, and so on\n"
          "  z_rigid z_rigid_spheres  z of the others among themselves\n"
          "  overlap_mean overlap_max wall_overlap_mean wall_overlap_max\n"
          "                       of all that overlap, in diameters\n"
          "  floor sides          force along gravity on walls facing it\n"
          "                       within 45 degrees, and on all others, by\n"
          "                       the weight of all spheres: 1 in all at rest\n"
          "  fabric_xx ... fabric_yz  mean of n n over pairs, trace 1\n"
          "  anisotropy           sqrt(3/2 D:D) of its deviator D: 0 if\n"
          "                       isotropic, 1 if all point one way\n"
          "--network: t i j wall x y z normal tangential gap nx ny nz: ids\n"
          "(wall 0), or i = j and the wall's number; the point between the\n"
          "surfaces (m), forces (N), gap (m), unit vector to sphere i.\n"
          "--gap 0.1, the default lmax, lists all contacts of the model.\n"
          "Forces come from the parameters and walls in the bed's header. A\n"
          "bed without them has settle's defaults, the mean radius as lmax, "
          "and\nno walls.",
      .usage = "contacts [OPTION...] [FILE...]",
      .example = "settle --seed 3 | analyze contacts",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  box_check(&set.box);
  if (set.degrees + set.overlaps + set.network > 1)
    die(EXIT_USAGE, "expected one of --degrees, --overlaps and --network");
  return tabulate(&input, means, argc, argv, operand, print_frame, &set);
}
