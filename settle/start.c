/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_statistics.h>
#include "geometry/periodic.h"
#include "program/files.h"
#include "model/bed_check.h"
#include "model/relax.h"
#include "files/formats.h"
#include "files/numbers.h"
#include "files/radius_keys.h"
#include "program/size_options.h"
#include "program/version.h"
#include "memory.h"
#include "soft.h"

static void check_memory(int status) {
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
}

/* The spheres that a frame should have: by the header, or as the one before it.
   0: nobody knows. */
static size_t expected_spheres(const struct bed_reader *reader,
                               const struct bed *before) {
  const char *count = bed_header_get(bed_reader_header(reader), "count");
  double n;
  return count && number_parse(count, &n) && n > 0 && number_is_whole(n)
             ? (size_t)n
             : before->n;
}

/* The frame in the place of the one before it, unless the file is cut within
   it. */
static void take_frame(const struct bed_reader *reader, const char *name,
                       struct bed *b, struct bed *frame) {
  const size_t expected = expected_spheres(reader, b);
  if (bed_reader_is_cut(reader) && frame->n < expected) {
    if (!b->n)
      die(EXIT_INPUT,
          "%s: the frame of t=%g has %zu of %zu spheres and there is none "
          "before it: expected a whole frame",
          name, frame->t, frame->n, expected);
    warn("%s: the frame of t=%g is left out, it has %zu of %zu spheres; the "
         "start is the one before it, of t=%g",
         name, frame->t, frame->n, expected, b->t);
    bed_free(frame);
  } else if (frame->n) {
    bed_free(b);
    *b = *frame;
  } else {
    bed_free(frame);
  }
}

/* The file that the spheres or some of them come from, NULL: none. */
static const char *file_of_start(const struct settings *s) {
  return s->scene_file ? s->scene_file : s->onto;
}

/* The last whole frame with spheres of that file, of any format; a bed's keys
   go into the header. radius: of spheres that come without one. */
static void read_scene(const struct settings *s, double radius, struct bed *b,
                       struct bed_header *h, const char **name) {
  struct input in;
  input_open(&in, file_of_start(s));
  *name = in.name;
  const struct bed_reader_options options = {.allow_partial = s->allow_partial,
                                             .may_be_empty = true,
                                             .radius = radius};
  struct bed_reader *reader;
  check_memory(bed_reader_open(&reader, in.stream, *name, &options));
  struct bed frame;
  int status;
  while ((status = bed_reader_next(reader, &frame)) == GSL_SUCCESS) {
    if (bed_reader_note(reader))
      warn("%s", bed_reader_note(reader));
    take_frame(reader, *name, b, &frame);
  }
  check_memory(status);
  if (status != GSL_EOF) {
    input_close(&in); /* has a better reason if it cannot be unpacked */
    die(EXIT_INPUT, "%s", bed_reader_error(reader));
  }
  if (bed_reader_note(reader))
    warn("%s", bed_reader_note(reader));
  if (!b->n)
    die(EXIT_INPUT, "%s: no frame has spheres", *name);
  const struct bed_header *keys = bed_reader_header(reader);
  for (size_t k = 0; k < keys->count; k++)
    check_memory(bed_header_add(h, keys->at[k].name, keys->at[k].value));
  if (!bed_reader_is_bed(reader) && !s->scene.walls_count)
    warn("%s: has no walls, expected --wall if there should be any", *name);
  bed_reader_close(reader);
  input_close(&in);
  const double r = radius_dynamics(h);
  if (r < 0)
    die(EXIT_INPUT, "%s: radius_dynamics=%s: expected a number above 0", *name,
        bed_header_get(h, "radius_dynamics"));
  if (r > 0) { /* forces at another radius are another bed's */
    warn("%s: the radius was rewritten; going on with radius_dynamics=%g",
         *name, r);
    check_memory(radius_rewrite(b, h, r, NULL));
  }
}

static bool is_one_of(const struct option_spec *o, const char *const names[]) {
  for (size_t i = 0; names[i]; i++)
    if (!strcmp(o->name, names[i]))
      return true;
  return false;
}

/* Belongs to a method: another one does not inherit it. */
static bool is_step_control(const struct option_spec *o) {
  static const char *const names[] = {"control", "tol",  "abstol",
                                      "reltol",  "step", NULL};
  return is_one_of(o, names);
}

/* Whether an option describes the making of a start: a scene has been made
   already. */
static bool is_of_start(const struct option_spec *o) {
  static const char *const names[] = {"count", "sizes",  "shares", "base",
                                      "drop",  "jitter", "seed",   "fill",
                                      "rate",  NULL};
  return is_one_of(o, names);
}

/* Of new spheres over a bed, whose base goes on. */
static bool is_of_new_spheres(const struct option_spec *o) {
  static const char *const names[] = {"radius", "mass", NULL};
  return is_one_of(o, names) || (is_of_start(o) && strcmp(o->name, "base"));
}

/* The same where another method goes on. */
static bool is_not_of_run_below(const struct option_spec *o) {
  return is_of_new_spheres(o) || is_step_control(o);
}

static void refuse_options_of_start(const struct option_spec *options) {
  for (const struct option_spec *o = options; o->name; o++)
    if (o->given && is_of_start(o))
      die(EXIT_USAGE, "--%s: makes a start, expected none beside --scene",
          o->name);
}

/* Either the spheres have it or they have none of their own. */
static void check_radius(const struct settings *s,
                         const struct option_spec *option, const struct bed *b,
                         const char *name) {
  for (size_t i = 0; option->given && i < b->n; i++)
    if (b->r[i] != s->fill.radius)
      die(EXIT_USAGE, "--radius %g: sphere %ld of %s has a radius of %g m",
          s->fill.radius, b->id[i], name, b->r[i]);
}

/* The same of masses, by --mass or --density. */
static void check_masses(const struct settings *s, struct option_spec *options,
                         const struct bed *b, const char *name) {
  if (option_find(options, "density")->given)
    die(EXIT_USAGE, "--density: expected --mass beside --scene");
  for (size_t i = 0; option_find(options, "mass")->given && i < b->n; i++)
    if (b->m[i] != s->fill.mass)
      die(EXIT_USAGE, "--mass %g: sphere %ld of %s has a mass of %g kg",
          s->fill.mass, b->id[i], name, b->m[i]);
}

static void check_walls(const struct scene *scene, const struct bed *b,
                        const char *name) {
  const struct bed_outsiders o = bed_find_outsiders(scene, b);
  const double *x = b->x + 3 * o.sphere;
  if (o.count)
    die(EXIT_INPUT,
        "%s: sphere %ld at (%g, %g, %g) has its centre outside wall %zu%s",
        name, b->id[o.sphere], x[0], x[1], x[2], o.wall + 1,
        scene->walls[o.wall].radius > 0 ? ", a cylinder" : "");
}

/* Whether settle made the file with the law that now holds: contacts as deep as
   falling spheres make them are no fault then. */
static bool is_own_bed(const struct bed_header *h,
                       const struct contact_law *law) {
  const char *program = bed_header_get(h, "program");
  const char *f0 = bed_header_get(h, "f0");
  const char *kappa = bed_header_get(h, "kappa");
  double was[2];
  return program && !strcmp(program, program_name()) && f0 && kappa &&
         number_parse(f0, &was[0]) && number_parse(kappa, &was[1]) &&
         was[0] == law->f0 && was[1] == law->kappa;
}

/* Energies of a contact (m g r): settled beds have up to 3 and spheres that
   fall from x radii up to x, or more where others fall on them. With 1 on all
   its contacts a sphere hops by a few radii. */
static const struct relax_limits relax_others = {
    .deep = 10, .enough = 1, .passes = 20000};
static const struct relax_limits relax_own = {
    .deep = 1000, .enough = 1, .passes = 20000};

/* Spheres that would fly apart are pushed apart, and that is said and written
   into the header. */
static void part_overlaps(const struct settings *s, struct bed *b,
                          struct bed_header *h, const char *name) {
  struct relax_report r;
  const int status = relax_bed(
      &s->scene, &s->similarity,
      is_own_bed(h, &s->scene.law) ? &relax_own : &relax_others, b, &r);
  check_memory(status);
  if (status == GSL_EINVAL)
    die(EXIT_INPUT, "%s: a coordinate is not finite", name);
  if (r.pairs + r.walls == 0)
    return;
  char what[160];
  snprintf(what, sizeof what,
           "%zu contacts between spheres and %zu with walls are too deep for a "
           "start, by up to %.3g m (sphere %ld)",
           r.pairs, r.walls, r.depth, b->id[r.sphere]);
  if (status != GSL_SUCCESS)
    die(EXIT_INPUT,
        "%s: %s; after spheres were pushed apart %zu times %zu still are: "
        "expected room for all spheres",
        name, what, r.passes, r.left);
  warn("%s: %s; spheres were pushed apart, which moved %zu of them by up to "
       "%.3g m; such a bed is denser than one that falls (docs/containers.md, "
       "\"Starts that overlap\")",
       name, what, r.moved, r.furthest);
  snprintf(what, sizeof what, "%zu", r.pairs + r.walls);
  check_memory(bed_header_set(h, "relaxed", what));
}

/* Obstacles stay where they are. */
static void check_fixed(const struct bed *b, const char *name) {
  size_t moving = 0;
  for (size_t i = 0; i < b->n; i++) {
    moving += !bed_is_fixed(b, i);
    if (bed_is_fixed(b, i) &&
        vec3_norm(b->v + 3 * i) + vec3_norm(b->w + 3 * i) > 0)
      die(EXIT_INPUT,
          "%s: sphere %ld is fixed, expected no velocity and no spin", name,
          b->id[i]);
  }
  if (!moving)
    die(EXIT_INPUT, "%s: all spheres are fixed, expected one that moves", name);
}

/* Asked for, and the spheres of this scene have no use for it. */
static void check_turning(const struct scene *scene,
                          const struct option_spec *options) {
  static const char *const names[] = {"rolling", "lever", NULL};
  for (const struct option_spec *o = options; o->name; o++)
    if (o->given && is_one_of(o, names) && !scene_has_rotation(scene))
      die(EXIT_USAGE,
          "--%s: nothing turns, expected --model rotation and friction",
          o->name);
}

/* The mass by --density. */
static void take_density(struct settings *s, struct option_spec *options) {
  if (!(s->density > 0))
    return;
  if (option_find(options, "mass")->given)
    die(EXIT_USAGE, "--density: expected no --mass beside it");
  s->fill.mass = s->density * 4 / 3 * M_PI * gsl_pow_3(s->fill.radius);
}

/* Mass that a sphere of this radius has if it is made of what the bed's are. */
static double mass_of_material(const struct bed *bed, double radius) {
  double *mass = malloc(bed->n * sizeof *mass);
  if (!mass)
    die(EXIT_IO, "out of memory");
  for (size_t i = 0; i < bed->n; i++)
    mass[i] = bed->m[i] * gsl_pow_3(radius / bed->r[i]);
  const double mean = bed_mean(bed, mass);
  free(mass);
  return mean;
}

/* The spheres of a start, and those that its defaults follow: of the mean
   radius and mass. Over a bed below they are like its spheres. */
static void make_spheres(struct settings *s, struct option_spec *options,
                         const struct bed *below, struct bed *b) {
  if (s->shares && !s->sizes)
    die(EXIT_USAGE, "--shares: expected --sizes beside it");
  if (s->sizes && option_find(options, "radius")->given)
    die(EXIT_USAGE, "--radius: expected no --sizes beside it");
  if (below->n && !option_find(options, "radius")->given)
    s->fill.radius = bed_mean(below, below->r);
  check_memory(bed_alloc(b, s->fill.count));
  for (size_t i = 0; i < b->n; i++)
    b->r[i] = s->fill.radius;
  if (s->sizes) {
    struct sizes *sizes = sizes_of_options(s->sizes, s->shares);
    check_memory(sizes_draw(sizes, s->fill.seed, b->n, b->r));
    sizes_free(sizes);
    s->fill.radius = bed_mean(b, b->r);
  }
  take_density(s, options);
  if (below->n && !option_find(options, "mass")->given && !(s->density > 0))
    s->fill.mass = mass_of_material(below, s->fill.radius);
  sizes_masses(b->n, b->r, s->fill.radius, s->fill.mass, b->m);
}

/* Settings beyond multirate ask for rkc. */
static const char *usual_method(const struct settings *s) {
  const struct integrate_options *o = &s->integrate;
  const struct integrate_method *usual = integrate_method("multirate");
  const bool other = o->control && strcmp(o->control, usual->control->name);
  return o->step > 0 || o->reltol > 0 || s->all_pairs || other ? "rkc"
                                                               : usual->name;
}

/* A tolerance that neither options nor a scene had is by similarity too. */
static void take_defaults(struct settings *s) {
  if (!s->integrate.method)
    s->integrate.method = usual_method(s);
  const bool open = s->integrate.tol == 0;
  integrate_defaults(&s->integrate);
  if (open)
    s->integrate.tol *= similarity_scale(
        &s->similarity, integrate_control(s->integrate.control)->per_time
                            ? (struct dimension){1, -2, 0}
                            : (struct dimension){1, -1, 0});
}

/* A bead that is wider than the tube has no place in it. */
static void check_tubes(const struct settings *s, const struct bed *b,
                        const char *name) {
  double widest = 0;
  for (size_t i = 0; i < b->n; i++)
    if (!bed_is_fixed(b, i))
      widest = GSL_MAX(widest, b->r[i]);
  for (size_t k = 0; k < s->scene.walls_count; k++) {
    const double radius = s->scene.walls[k].radius;
    if (radius > 0 && radius <= widest)
      die(file_of_start(s) ? EXIT_INPUT : EXIT_USAGE,
          "%s: a tube of radius %g m is no wider than a bead of radius %g m",
          file_of_start(s) ? name : "--cylinder", radius, widest);
  }
}

/* A sphere is to meet one image of another at most, and none of its own. */
static void check_periods(struct settings *s, const struct bed *b,
                          const struct bed_header *h, const char *name) {
  const double *period = s->scene.period;
  if (!periodic_any(period))
    return;
  if (file_of_start(s) && !bed_header_get(h, "base"))
    die(EXIT_USAGE, "--periodic: %s has no base=a,b in its header", name);
  const double widest = gsl_stats_max(b->r, 1, b->n);
  const double least = 2 * GSL_MAX(3 * widest, 2 * widest + s->scene.law.lmax);
  for (int k = 0; k < 2; k++)
    if (period[k] > 0 && period[k] < least * (1 - 1e-9))
      die(file_of_start(s) ? EXIT_INPUT : EXIT_USAGE,
          "%s: a periodic side of %g m is too short, expected at least %g m: "
          "three diameters, and twice the reach of a contact",
          file_of_start(s) ? name : "--periodic", period[k], least);
  if (period[0] > 0 && period[1] > 0) /* as it stands in a header */
    s->words.periodic = "x y";
}

/* The one upright tube that is all there is of side walls, or NULL. */
static const struct wall *upright_tube(const struct scene *s) {
  const struct wall *found = NULL;
  for (size_t k = 0; k < s->walls_count; k++) {
    const struct wall *w = &s->walls[k];
    if (w->radius > 0 && w->normal[0] == 0 && w->normal[1] == 0 &&
        (!found || w->radius < found->radius))
      found = w;
  }
  return found;
}

/* Whether a wall of the box with this normal goes along a cylinder, which then
   is there instead. */
static bool is_replaced(const struct scene *s, const double normal[3]) {
  for (size_t k = 0; k < s->walls_count; k++)
    if (s->walls[k].radius > 0 &&
        fabs(vec3_dot(s->walls[k].normal, normal)) < 1e-12)
      return true;
  return false;
}

/* The walls of a start of its own, and what of it is to be filled. A bed below
   has its walls. */
static void make_container(struct settings *s, struct option_spec *options,
                           const struct bed_header *h) {
  const bool known =
      option_find(options, "base")->given || bed_header_get(h, "base");
  const bool own_walls = s->onto || option_find(options, "wall")->given;
  const struct wall *tube = upright_tube(&s->scene);
  double *base = s->words.base.at;
  if (s->onto && !tube && !known)
    die(EXIT_USAGE, "--onto: %s has no base=a,b in its header, expected --base",
        s->onto);
  if (tube && !known)
    base[0] = base[1] = 2 * tube->radius;
  if (!(base[0] > 0 && base[1] > 0))
    die(EXIT_USAGE, "--base: expected two numbers above 0");
  for (int k = 0; k < 2; k++) {
    s->fill.origin[k] = tube ? tube->point[k] - tube->radius : 0;
    s->fill.base[k] = tube ? 2 * tube->radius : base[k];
  }
  s->fill.centred = tube != NULL;
  struct scene box = {0};
  check_memory(scene_add_box(&box, base[0], base[1]));
  for (size_t k = 0; k < box.walls_count && !own_walls; k++) {
    const struct wall *w = &box.walls[k];
    if (!is_replaced(&s->scene, w->normal) &&
        !(w->normal[0] != 0 && s->scene.period[0] > 0) &&
        !(w->normal[1] != 0 && s->scene.period[1] > 0))
      check_memory(scene_add_wall(&s->scene, w->point, w->normal));
  }
  scene_free(&box);
}

/* Upper end of the spheres; minus infinity for none. */
static double top_of(const struct bed *b) {
  double top = GSL_NEGINF;
  for (size_t i = 0; i < b->n; i++)
    top = GSL_MAX(top, b->x[3 * i + 2] + b->r[i]);
  return top;
}

static enum fill_way way_of(const struct settings *s) {
  int way = FILL_GRID;
  while (s->fill_way && strcmp(fill_ways[way].name, s->fill_way))
    way++;
  return (enum fill_way)way;
}

/* Options that not all ways of filling have a use for. */
static bool way_uses(enum fill_way way, const char *option) {
  static const struct {
    const char *name;
    bool used[3];
  } uses[] = {{"jitter", {[FILL_GRID] = true}},
              {"drop", {[FILL_GRID] = true, [FILL_RANDOM] = true}},
              {"rate", {[FILL_RAIN] = true}}};
  for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
    if (!strcmp(uses[k].name, option))
      return uses[k].used[way];
  return true;
}

static void check_way(const struct settings *s,
                      const struct option_spec *options) {
  const enum fill_way way = way_of(s);
  for (const struct option_spec *o = options; o->name; o++)
    if (o->given && !way_uses(way, o->name))
      die(EXIT_USAGE, "--%s: has no use with --fill %s", o->name,
          fill_ways[way].name);
}

/* Rain that would pass through the floor: the contact of a centre that is as
   deep as the floor stores less than the sphere brings. */
static void check_rain(const struct settings *s, const struct bed *b) {
  const struct contact_law *c = &s->scene.law;
  for (size_t i = 0; i < b->n; i++) {
    const double energy =
        0.5 * b->m[i] * gsl_pow_2(b->v[3 * i + 2]) -
        b->m[i] * s->scene.gravity[2] * fmax(0, b->x[3 * i + 2] - b->r[i]);
    if (!(energy <= contact_energy(c, -b->r[i])))
      die(EXIT_USAGE,
          "--rate %g: spheres would arrive with %.3g m/s and pass through the "
          "floor, expected a rate nearer to that of --rate 0, or fewer spheres",
          s->fill.rate, sqrt(2 * energy / b->m[i]));
  }
}

/* below: the bed that the new spheres are put over; may be empty. */
static void fill(const struct settings *s, const struct bed *below,
                 struct bed *b) {
  static int (*const fills[])(const struct fill *, const struct scene *,
                              struct bed *) = {[FILL_GRID] = fill_grid_of,
                                               [FILL_RANDOM] = fill_random,
                                               [FILL_RAIN] = fill_rain};
  const enum fill_way way = way_of(s);
  struct fill f = s->fill;
  if (way == FILL_RAIN)
    f.drop = 0;
  if (below->n)
    f.drop += top_of(below);
  const int status = fills[way](&f, &s->scene, b);
  check_memory(status);
  if (status == GSL_SUCCESS)
    return;
  if (status == GSL_EDOM)
    die(EXIT_USAGE, "--fill rain: expected gravity downwards");
  const double widest = gsl_stats_max(b->r, 1, b->n);
  if (way != FILL_GRID)
    die(EXIT_USAGE,
        "--count %zu: not so many spheres of radius %g found places between "
        "the walls with --fill %s",
        s->fill.count, widest, fill_ways[way].name);
  if (s->fill.base[0] < 2.5 * widest || s->fill.base[1] < 2.5 * widest)
    die(EXIT_USAGE,
        "%s: not one sphere of radius %g fits into %g by %g m with --jitter %g",
        s->fill.centred ? "--cylinder" : "--base", widest, s->fill.base[0],
        s->fill.base[1], s->fill.jitter);
  die(EXIT_USAGE,
      "--count %zu: not so many spheres of radius %g fit between the walls "
      "above --drop %g with --jitter %g",
      s->fill.count, widest, s->fill.drop, s->fill.jitter);
}

/* The bed below and then the new spheres, with the ids that come next; the
   parts are freed. */
static void join(struct bed *below, struct bed *b) {
  struct bed all;
  const size_t n = below->n, vectors = 3 * n;
  check_memory(bed_alloc(&all, n + b->n));
  if (below->fixed)
    check_memory(bed_fix_none(&all));
  all.t = below->t;
  long last = LONG_MIN;
  for (size_t i = 0; i < n; i++) {
    all.id[i] = below->id[i];
    last = GSL_MAX(last, below->id[i]);
    if (below->fixed)
      all.fixed[i] = below->fixed[i];
  }
  if (last > LONG_MAX - (long)b->n)
    die(EXIT_INPUT, "id %ld: expected room for %zu larger ones", last, b->n);
  for (size_t i = 0; i < b->n; i++)
    all.id[n + i] = last + 1 + (long)i;
  memcpy(all.x, below->x, vectors * sizeof *all.x);
  memcpy(all.v, below->v, vectors * sizeof *all.v);
  memcpy(all.w, below->w, vectors * sizeof *all.w);
  memcpy(all.r, below->r, n * sizeof *all.r);
  memcpy(all.m, below->m, n * sizeof *all.m);
  memcpy(all.x + vectors, b->x, 3 * b->n * sizeof *all.x);
  memcpy(all.v + vectors, b->v, 3 * b->n * sizeof *all.v);
  memcpy(all.r + n, b->r, b->n * sizeof *all.r);
  memcpy(all.m + n, b->m, b->n * sizeof *all.m);
  bed_free(below);
  bed_free(b);
  *b = all;
}

/* A wall above, which a start of its own is to be below as a whole. */
static void add_lid(struct settings *s, const struct bed *b) {
  const double point[3] = {0, 0, s->lid}, up[3] = {0, 0, 1};
  const double top = top_of(b);
  if (!s->scene_file && top > s->lid)
    die(EXIT_USAGE,
        "--lid %g: the start reaches up to %g m, expected a lid above it",
        s->lid, top);
  check_memory(scene_add_wall(&s->scene, point, up));
}

/* The parameters as they now stand, then the keys of a file that we do not
   know. The making of a scene's start is described by its file alone. */
static void write_header(struct settings *s, const struct option_spec *options,
                         const struct bed *b, struct bed_header *h) {
  char text[1024];
  s->fill.count = b->n;
  s->fill.radius = bed_mean(b, b->r);
  s->fill.mass = bed_mean(b, b->m);
  bed_header_remove(h, "wall");
  bed_header_remove(h, "cylinder");
  bed_header_remove(h, "status");
  bed_header_remove(h, "build"); /* the run's */
  bed_header_remove(h, "kernel");
  check_memory(bed_header_set(h, "format", "bed-1"));
  check_memory(bed_header_set(h, "program", "settle"));
  check_memory(bed_header_set(h, "version", DEM_VERSION));
  for (const struct option_spec *o = options; o->name; o++) {
    const bool of_file =
        s->scene_file && is_of_start(o) && o->value != &s->fill.count;
    if (!o->parameter || o->each || of_file)
      continue;
    if (!s->scene_file && !way_uses(way_of(s), o->name)) {
      bed_header_remove(h, o->name);
      continue;
    }
    option_text(o, text, sizeof text);
    if (strlen(text) + 1 == sizeof text)
      die(EXIT_USAGE, "--%s: expected fewer than %zu characters", o->name,
          sizeof text - 1);
    if (o->optional && (!*text || !strcmp(text, "0")))
      bed_header_remove(h, o->name);
    else
      check_memory(bed_header_set(h, o->name, text));
  }
  for (size_t k = 0; k < s->scene.walls_count; k++) {
    const struct wall *w = &s->scene.walls[k];
    const double *p = w->point, *n = w->normal;
    const double wall[] = {p[0], p[1], p[2], n[0], n[1], n[2], w->radius};
    const bool round = w->radius > 0;
    size_t used = 0;
    for (int c = 0; c < (round ? 7 : 6); c++) {
      char number[NUMBER_SIZE];
      number_format(wall[c], number);
      used += (size_t)snprintf(text + used, sizeof text - used,
                               c ? " %s" : "%s", number);
    }
    check_memory(bed_header_add(h, round ? "cylinder" : "wall", text));
  }
}

/* A whole start from a file. */
static void take_scene(struct settings *s, struct option_spec *options,
                       struct bed *b, struct bed_header *header,
                       const char **name) {
  struct option_spec *radius = option_find(options, "radius");
  refuse_options_of_start(options);
  read_scene(s, radius->given ? s->fill.radius : 0, b, header, name);
  check_radius(s, radius, b, *name);
  check_masses(s, options, b, *name);
}

/* A bed from a file that new spheres are put over. */
static void take_below(struct settings *s, struct option_spec *options,
                       struct bed *below, struct bed_header *header,
                       const char **name) {
  if (s->scene_file)
    die(EXIT_USAGE, "--onto: expected no --scene beside it");
  struct option_spec *radius = option_find(options, "radius");
  read_scene(s, radius->given ? s->fill.radius : 0, below, header, name);
  if (option_find(options, "base")->given && bed_header_get(header, "base"))
    die(EXIT_USAGE, "--base: %s has one, expected none beside --onto", *name);
}

void start_make(struct settings *s, struct option_spec *options, struct bed *b,
                struct bed_header *header) {
  const char *name = "start";
  struct bed below = {0};
  if (s->onto)
    take_below(s, options, &below, header, &name);
  if (s->scene_file)
    take_scene(s, options, b, header, &name);
  else
    make_spheres(s, options, &below, b);
  s->similarity = header_similarity(header, options, &s->words,
                                    bed_mean(b, b->r), bed_mean(b, b->m));
  if (file_of_start(s)) {
    const bool other_method = option_find(options, "method")->given;
    const char *bad = header_options(
        header, options,
        s->onto        ? other_method ? is_not_of_run_below : is_of_new_spheres
        : other_method ? is_step_control
                       : NULL);
    if (bad)
      die(EXIT_INPUT, "%s: %s", name, bad);
  }
  take_defaults(s);
  const char *wrong = scene_finish(&s->scene, &s->words);
  /* options are checked one by one, but for the numbers of gravity */
  if (wrong && file_of_start(s) && !option_find(options, "gravity")->given)
    die(EXIT_INPUT, "%s: %s", name, wrong);
  if (wrong)
    die(EXIT_USAGE, "--%s", wrong);
  check_turning(&s->scene, options);
  if (!s->lammps)
    memory_check(s, b->n + below.n);
  check_tubes(s, b, name);
  check_periods(s, b, header, name);
  if (s->onto)
    check_periods(s, &below, header, name);
  if (!s->scene_file) {
    check_way(s, options);
    make_container(s, options, header);
    fill(s, &below, b);
  }
  if (s->onto) {
    join(&below, b);
    if (!option_find(options, "time")->given)
      s->time += b->t;
  }
  if (option_find(options, "lid")->given)
    add_lid(s, b);
  check_fixed(b, name);
  check_walls(&s->scene, b, name);
  soft_take(s, options, b, header);
  if (!s->scene_file && way_of(s) == FILL_RAIN)
    check_rain(s, b);
  if (file_of_start(s))
    part_overlaps(s, b, header, name);
  write_header(s, options, b, header);
}
