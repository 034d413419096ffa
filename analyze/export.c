/* SPDX-License-Identifier: GPL-3.0-or-later */
/* export: beds in the formats of other programs. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <gsl/gsl_math.h>
#include "platform/system.h"
#include "program/files.h"
#include "files/numbers.h"
#include "frames.h"
#include "measure.h"
#include "program/command_line.h"
#include "verbs.h"
#include "writers.h"

#define SOLID " bridge reach walls thickness"
#define VOXELS "box cells binary distance type threads" SOLID

/* The formats that can be written. */
static const struct format {
  const char *name, *help;
  const char *takes; /* options that not every format takes */
  write_function *write;
  write_files_function *write_files; /* or this, for several files */
  double sphere;     /* bytes of one, at least, where they are most of a file */
  double base;       /* its side, unless --scale says more */
  double cells;      /* that --cells has unless it is given */
  bool cells_along;  /* --cells is N, along the longest side */
  bool cells_merged; /* --cells needs --merged */
  bool binary;       /* nothing for a terminal */
  bool many;         /* frames in one file */
  bool series;       /* ParaView's .pvd lists such files */
  bool boxed;        /* it is what the box holds */
  bool filled;       /* spheres have copies across periodic sides */
  bool full;         /* is nothing without spheres */
} formats[] = {
    {.name = "positions",
     .help = "x y z of the centres, tab-separated, nothing else",
     .sphere = 30,
     .takes = "scale offset images",
     .write = write_positions},
    {.name = "csv",
     .help = "a row of names, one row per sphere, the first column t",
     .sphere = 100,
     .takes = "scale offset images",
     .write = write_csv,
     .many = true},
    {.name = "xyz",
     .help = "extended XYZ: OVITO, ASE",
     .sphere = 100,
     .takes = "scale offset box images",
     .write = write_xyz,
     .many = true},
    {.name = "lammps",
     .help = "text dump: OVITO, LAMMPS's read_dump and rerun",
     .sphere = 100,
     .takes = "scale offset box",
     .write = write_lammps,
     .many = true},
    {.name = "lammps-data",
     .help = "data file of atom style sphere",
     .sphere = 100,
     .takes = "scale offset box",
     .write = write_lammps_data},
    {.name = "vtp",
     .help = "VTK PolyData, one vertex per sphere: ParaView",
     .sphere = 100,
     .takes = "scale offset network images",
     .write = write_vtp,
     .binary = true,
     .series = true},
    {.name = "stl",
     .help = "surfaces of the spheres, binary",
     .takes = "scale offset box facets equal-volume merged cells" SOLID,
     .write = write_stl,
     .filled = true,
     .cells_merged = true,
     .binary = true},
    {.name = "vti",
     .help = "voxels as VTK ImageData: ParaView",
     .takes = "scale offset " VOXELS,
     .write = write_vti,
     .boxed = true,
     .binary = true,
     .series = true},
    {.name = "raw",
     .help = "voxels as bare numbers, x fastest, then y, then z",
     .takes = "scale offset " VOXELS,
     .write = write_raw,
     .boxed = true,
     .binary = true},
    {.name = "mhd",
     .help = "MetaImage beside raw: ITK, VTK, ParaView, Fiji",
     .takes = "scale offset " VOXELS,
     .write_files = write_mhd,
     .boxed = true},
    {.name = "palabos",
     .help = "voxels as text, 0 or 1, z fastest, then y, then x",
     .takes = "scale offset box cells threads" SOLID,
     .write = write_palabos,
     .boxed = true},
    {.name = "geo",
     .help = "gmsh script: the pore, a box less spheres, named surfaces",
     .sphere = 50,
     .takes = "scale offset box" SOLID,
     .write = write_geo,
     .boxed = true},
    {.name = "openfoam",
     .help = "folder for blockMesh and snappyHexMesh",
     .takes = "scale offset box cells facets" SOLID,
     .write_files = write_openfoam,
     .boxed = true,
     .cells = 40,
     .cells_along = true},
    {.name = "freezethaw",
     .help = "folder for the paper's solver: positions, a part of Params",
     .takes = "scale offset box",
     .write_files = write_freezethaw,
     .filled = true,
     .base = 0.03},
    {.name = "bed",
     .help = "our own format",
     .sphere = 100,
     .takes = "box",
     .write = write_bed,
     .full = true},
    {0}};
static const char *const frame_choices[] = {"last", "all", NULL};
static const char *const type_names[] = {"float64", "float32", NULL};

/* The command line. */
struct request {
  const struct format *format;
  const char *output; /* NULL: standard output */
  struct write_options write;
  struct shape_options shape;
  struct box_watch *watch;
  bool all, chosen;
  size_t frame; /* the one chosen */
};

static bool takes(const struct format *f, const char *option) {
  const size_t length = strlen(option);
  for (const char *at = f->takes; (at = strstr(at, option)); at += length)
    if ((at == f->takes || at[-1] == ' ') && strchr(" ", at[length]))
      return true;
  return false;
}

/* An option that some formats take is for no others. */
static void check_taken(const struct option_spec *options,
                        const struct format *format) {
  for (const struct option_spec *o = options; o->name; o++) {
    char list[160] = "";
    for (const struct format *f = formats; f->name; f++)
      if (takes(f, o->name)) {
        strcat(list, " ");
        strcat(list, f->name);
      }
    if (o->given && *list && !takes(format, o->name))
      die(EXIT_USAGE, "--%s: not for --format %s, only for%s", o->name,
          format->name, list);
  }
}

static bool given(struct option_spec *options, const char *name) {
  return option_find(options, name)->given;
}

/* Options that are right one by one and not together. */
static void check_together(struct option_spec *options, const struct request *q,
                           size_t cells) {
  const struct write_options *w = &q->write;
  if (given(options, "frame") && given(options, "frames"))
    die(EXIT_USAGE, "--frame and --frames: expected one of them");
  if (q->format->cells_along && cells > 1)
    die(EXIT_USAGE, "--cells: expected N, along the longest side");
  if (w->merged && (given(options, "facets") || w->equal_volume || cells > 1))
    die(EXIT_USAGE, "--merged: expected --cells N, no facets of spheres");
  if (q->format->cells_merged && !w->merged && given(options, "cells"))
    die(EXIT_USAGE, "--cells: expected --merged with it");
  if (given(options, "reach") && !(q->shape.bridge > 0))
    die(EXIT_USAGE, "--reach: expected --bridge with it");
  if (given(options, "thickness") && (!q->shape.walls || q->shape.box_given))
    die(EXIT_USAGE, "--thickness: expected --walls and no --box with it");
  if (w->network && q->shape.images)
    die(EXIT_USAGE, "--network: expected no --images with it");
  if (w->binary && w->distance)
    die(EXIT_USAGE, "--binary and --distance: expected one of them");
  if (w->binary && given(options, "type"))
    die(EXIT_USAGE, "--binary: is bytes, expected no --type");
  if (q->format->write_files && !q->output)
    die(EXIT_USAGE, "--format %s: expected --output for its files",
        q->format->name);
  if (q->format->binary && !q->output && isatty(STDOUT_FILENO))
    die(EXIT_USAGE, "--format %s: not for a terminal, expected > FILE",
        q->format->name);
}

/* Cells from one number or three. */
static void take_cells(const struct option_list *list, size_t cells[3]) {
  double bytes = 8;
  if (list->count == 2)
    die(EXIT_USAGE, "--cells: expected N or NX,NY,NZ");
  for (int k = 0; k < 3; k++) {
    const double x = list->at[list->count == 1 ? 0 : k];
    bytes *= x;
    if (!(x >= 1 && x <= OPTION_MANY) || x != floor(x))
      die(EXIT_USAGE, "--cells: expected whole numbers of at least 1");
    cells[k] = (size_t)x;
  }
  if (bytes > OPTION_MANY)
    die(EXIT_USAGE, "--cells: %g bytes, expected at most %g", bytes,
        OPTION_MANY);
}

/* Writes a frame, to out or under a name, as s, the shape to be freed. */
static void write_one(FILE *out, const char *name, const struct request *q,
                      const struct frames *frames, const struct bed *b,
                      size_t number, bool first, struct shape *s) {
  if (q->format->full && b->n == 0)
    frame_refuse(frames, b, "no spheres, which a bed has");
  shape_make(s, &q->shape, frames, b);
  if (q->format->boxed)
    box_watch_see(q->watch, frames, b, !q->shape.box_given, 1,
                  (const double(*)[6])s->source_box);
  struct write_frame f = {.shape = s,
                          .bed = &s->bed,
                          .name = name,
                          .number = number,
                          .first = first};
  long least = 1;
  for (size_t i = 0; i < b->n; i++)
    least = GSL_MIN(least, b->id[i]);
  f.id_offset = 1 - least;
  if (out)
    output_need_room(out, name, q->format->sphere * (double)b->n);
  if (q->format->write_files)
    q->format->write_files(name, &f, &q->write);
  else
    q->format->write(out, &f, &q->write);
}

/* Reports the written file: the last of several frames. */
static void say(const struct request *q, struct shape *s) {
  if (!q->write.quiet && s->frames)
    shape_say(s);
  shape_free(s);
}

/* Output names with a number: a %d or %04d, and no other %. */
struct pattern {
  const char *text;
  size_t head, tail; /* what stands before %, where it goes on after d */
  int width;
  bool zeros;
};

static struct pattern pattern_of(const char *text) {
  struct pattern p = {.text = text};
  const char *percent = text ? strchr(text, '%') : NULL;
  if (!percent)
    die(EXIT_USAGE,
        "--frames all: one file per frame, expected --output with a "
        "%%d or %%04d in its name");
  const char *at = percent + 1;
  p.head = (size_t)(percent - text);
  p.zeros = *at == '0';
  while (*at >= '0' && *at <= '9' && p.width < 100)
    p.width = 10 * p.width + (*at++ - '0');
  if (*at != 'd' || strchr(at, '%') || strchr(at, '/') || p.width > 19)
    die(EXIT_USAGE, "--output %s: expected one %%d or %%04d in the file's name",
        text);
  p.tail = (size_t)(at + 1 - text);
  return p;
}

static char *pattern_name(const struct pattern *p, size_t number) {
  const size_t size = strlen(p->text) + 48;
  char *name = malloc(size);
  if (!name)
    die(EXIT_IO, "out of memory");
  snprintf(name, size, p->zeros ? "%.*s%0*zu%s" : "%.*s%*zu%s", (int)p->head,
           p->text, p->width, number, p->text + p->tail);
  return name;
}

/* bed-%04d.vtp -> bed.pvd */
static char *series_name(const struct pattern *p) {
  const char *slash = strrchr(p->text, '/');
  const size_t folder = slash ? (size_t)(slash + 1 - p->text) : 0;
  size_t stem = p->head;
  while (stem > folder && strchr("-_.", p->text[stem - 1]))
    stem--;
  const size_t size = stem + 16;
  char *name = malloc(size);
  if (!name)
    die(EXIT_IO, "out of memory");
  snprintf(name, size, "%.*s%s.pvd", (int)stem, p->text,
           stem > folder ? "" : "frames");
  return name;
}

static const char *base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static void write_series(const struct request *q, struct frames *frames) {
  const struct pattern pattern = pattern_of(q->output);
  struct output_file out, list = {0};
  struct bed bed = {0};
  char *list_name = NULL;
  if (q->format->series) {
    list_name = series_name(&pattern);
    output_open(&list, list_name);
    fprintf(list.stream, "<?xml version=\"1.0\"?>\n");
    origin_write_xml(list.stream, NULL);
    fprintf(list.stream,
            "<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n");
  }
  for (size_t number = 0; frames_next(frames, &bed); number++) {
    char *name = pattern_name(&pattern, number);
    struct shape shape;
    if (q->format->write) {
      output_open(&out, name);
      write_one(out.stream, name, q, frames, &bed, number, true, &shape);
      output_commit(&out);
    } else {
      write_one(NULL, name, q, frames, &bed, number, true, &shape);
    }
    say(q, &shape);
    if (list_name) {
      fputs("<DataSet timestep=\"", list.stream);
      numbers_write(list.stream, ' ', 1, &bed.t);
      fprintf(list.stream, "\" file=\"%s\"/>\n", base_name(name));
    }
    free(name);
  }
  if (list_name) {
    fprintf(list.stream, "</Collection>\n</VTKFile>\n");
    output_commit(&list);
  }
  free(list_name);
}

/* The one frame chosen, or the last that has spheres if any has; its number. */
static size_t read_one(const struct request *q, struct frames *frames,
                       struct bed *b) {
  struct bed next = {0};
  size_t count = 0, number = 0;
  while (frames_next(frames, &next)) {
    if (q->chosen || next.n > 0 || b->n == 0) {
      const struct bed swap = *b;
      *b = next;
      next = swap;
      number = count;
    }
    if (count++ == q->frame && q->chosen)
      break;
  }
  bed_free(&next);
  if (count == 0)
    die(EXIT_INPUT, "expected at least one frame");
  if (q->chosen && count <= q->frame)
    die(EXIT_INPUT, "--frame %zu: there are %zu, numbered from 0", q->frame,
        count);
  return number;
}

static void write_stream(FILE *out, const struct request *q,
                         struct frames *frames, struct shape *shape) {
  struct bed bed = {0};
  if (q->format->many && q->all) {
    for (size_t k = 0; frames_next(frames, &bed) && !ferror(out); k++) {
      shape_free(shape);
      write_one(out, q->output, q, frames, &bed, k, k == 0, shape);
    }
  } else {
    const size_t number = read_one(q, frames, &bed);
    write_one(out, q->output, q, frames, &bed, number, true, shape);
  }
  bed_free(&bed);
}

static void export(const struct request *q, struct frames *frames) {
  struct shape shape = {0};
  if (q->all && !q->format->many) {
    write_series(q, frames);
  } else if (q->format->write_files) {
    write_stream(NULL, q, frames, &shape);
  } else if (q->output) {
    struct output_file out;
    output_open(&out, q->output);
    write_stream(out.stream, q, frames, &shape);
    output_commit(&out);
  } else {
    write_stream(stdout, q, frames, &shape);
    finish_output();
  }
  say(q, &shape);
}

int verb_export(int argc, char **argv) {
  struct frames_options input = {.may_be_empty = true};
  struct request q = {.write = {.facets = 320, .threads = 1},
                      .shape = {.scale = 1, .gap = GSL_NAN}};
  struct option_list box = {0}, cells = {1, {100}}, offset = {3, {0, 0, 0}};
  const char *format = NULL, *which = NULL, *type = "float64";
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "format", .type = OPTION_TEXT, .value = &format,
       OPTION_TABLE(formats), .help = "what to write; needed"},
      {.name = "output", .type = OPTION_TEXT, .value = &q.output,
       .unit = "else standard output",
       .help = "file that appears once it is complete"},
      {.name = "frames", .type = OPTION_TEXT, .value = &which,
       .choices = frame_choices, .unit = "else all for csv, xyz, lammps",
       .help = "frames to write"},
      {.name = "frame", .type = OPTION_SIZE, .value = &q.frame,
       .most = OPTION_MANY, .unit = "from 0", .help = "one frame"},
      {.name = "scale", .type = OPTION_DOUBLE, .value = &q.shape.scale,
       .least = DBL_MIN, .most = OPTION_MANY,
       .help = "lengths and speeds are multiplied by it, 1000: mm"},
      {.name = "offset", .type = OPTION_LIST, .value = &offset, .least = 3,
       .most = 3, .unit = "x,y,z, in the units written",
       .help = "added to places"},
      {.name = "box", .type = OPTION_LIST, .value = &box, .least = 6,
       .most = 6, .unit = "x0,x1,y0,y1,z0,z1 in m, else the base's cube",
       .help = "of voxels and fractions; of xyz and lammps, else by walls"},
      {.name = "gap", .type = OPTION_DOUBLE, .value = &q.shape.gap,
       .least = 0, .most = OPTION_MANY, .unit = "m",
       .help = "shrink all radii until no two spheres are nearer"},
      {.name = "bridge", .type = OPTION_DOUBLE, .value = &q.shape.bridge,
       .least = 0, .most = OPTION_MANY, .unit = "m",
       .help = "radius of cylinders that bridge contacts; 0: none"},
      {.name = "reach", .type = OPTION_DOUBLE, .value = &q.shape.reach,
       .least = 0, .most = OPTION_MANY, .unit = "m",
       .help = "gap of contacts to bridge, at the radius of the dynamics"},
      {.name = "walls", .type = OPTION_FLAG, .value = &q.shape.walls,
       .help = "the container's walls, also tubes, are solid, too"},
      {.name = "thickness", .type = OPTION_DOUBLE, .value = &q.shape.thickness,
       .least = 0, .most = OPTION_MANY,
       .unit = "m, 0: as the least radius; with --box: up to its faces",
       .help = "of walls"},
      {.name = "images", .type = OPTION_FLAG, .value = &q.shape.images,
       .help = "copies across periodic sides, too, as surfaces and voxels have"},
      {.name = "cells", .type = OPTION_LIST, .value = &cells, .least = 1,
       .most = 3, .unit = "N or NX,NY,NZ", .help = "voxels; of surfaces along the longest side, openfoam: 40"},
      {.name = "binary", .type = OPTION_FLAG, .value = &q.write.binary,
       .help = "voxels: 1 where the midpoint is solid, else 0; a byte each"},
      {.name = "distance", .type = OPTION_FLAG, .value = &q.write.distance,
       .help = "voxels: distance of the midpoint to the surface (m)"},
      {.name = "type", .type = OPTION_TEXT, .value = &type,
       .choices = type_names, .help = "of a voxel's number"},
      {.name = "threads", .type = OPTION_SIZE, .value = &q.write.threads,
       .most = 1024, .unit = "0: all cores", .help = "threads, for voxels",
       .silent = true},
      {.name = "facets", .type = OPTION_SIZE, .value = &q.write.facets,
       .least = 20, .most = 2e6, .unit = "the next of 20 k^2",
       .help = "of a sphere in stl"},
      {.name = "network", .type = OPTION_FLAG, .value = &q.write.network,
       .help = "vtp: contacts as lines, with their forces"},
      {.name = "merged", .type = OPTION_FLAG, .value = &q.write.merged,
       .help = "stl: one closed surface of the union, --cells along it"},
      {.name = "equal-volume", .type = OPTION_FLAG,
       .value = &q.write.equal_volume,
       .help = "stl: the volume of the spheres, corners outside of them"},
      FRAMES_OPTIONS(input),
      {0}};
  /* clang-format on */
  const struct program program = {
      .name = "analyze",
      .summary =
          "Writes a bed for another program, and says on standard error "
          "what\nthe exact solid fraction of it is.\n"
          "The value of a voxel is the solid fraction of its cell: the exact\n"
          "union of the spheres. Distances are exact outside of the solid;\n"
          "inside they are negative and, where spheres overlap, too small.\n"
          "Binary numbers are little-endian.\n"
          "csv, xyz and lammps hold all frames, the others one, the last; "
          "with\n"
          "--frames all they need an --output such as bed-%04d.vtp, and vtp\n"
          "and vti get a bed.pvd too.",
      .usage = "export --format NAME [OPTION...] [FILE]",
      .example = "settle | analyze export --format vtp > bed.vtp",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  if (!format)
    die(EXIT_USAGE, "--format: expected what to write; see --help");
  for (q.format = formats; strcmp(q.format->name, format);)
    q.format++;
  check_taken(options, q.format);
  box_check(&box);
  q.shape.box_given = box.count;
  q.shape.images = q.shape.images || q.format->boxed || q.format->filled;
  check_together(options, &q, cells.count);
  q.chosen = given(options, "frame");
  q.all = which ? !strcmp(which, "all") : q.format->many && !q.chosen;
  q.write.single = !strcmp(type, "float32");
  q.write.quiet = input.quiet;
  q.shape.gap_given = given(options, "gap");
  memcpy(q.shape.box, box.at, sizeof q.shape.box);
  memcpy(q.shape.offset, offset.at, sizeof q.shape.offset);
  if (q.format->cells > 0 && !given(options, "cells"))
    cells.at[0] = q.format->cells;
  take_cells(&cells, q.write.cells);
  q.write.threads = system_threads(q.write.threads);
  if (!given(options, "scale"))
    q.shape.base = q.format->base;

  struct frames frames;
  frames_open(&frames, &input, argc, argv, operand);
  struct box_watch watch = {0};
  q.watch = &watch;
  export(&q, &frames);
  box_watch_end(&watch);
  frames_close(&frames);
  return EXIT_DONE;
}
