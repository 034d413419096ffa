/* SPDX-License-Identifier: GPL-3.0-or-later */
/* settle: integrates a bed of spheres, from the paper's start or from a file,
   and writes its frames. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "dynamics/dynamics.h"
#include "platform/system.h"
#include "export_lammps.h"
#include "memory.h"
#include "run.h"
#include "program/integration.h"
#include "program/shared_options.h"
#include "program/size_options.h"
#include "start.h"
#include "target.h"

enum { CELLS, ALL };
static const char *const pair_searches[] = {
    [CELLS] = "cells", [ALL] = "all", NULL};

static void shares_unset(char *text, size_t size) {
  snprintf(text, size, "%s; a sieve's are by %s", size_shares[SHARES_NUMBER],
           size_shares[SHARES_VOLUME]);
}

static void no_lid(char *text, size_t size) {
  snprintf(text, size, "none");
}

static void fill_unset(char *text, size_t size) {
  snprintf(text, size, "%s", fill_ways[FILL_GRID].name);
}

static void by_kappa(char *text, size_t size) {
  snprintf(text, size, "by --kappa and --f0");
}

static void by_friction(char *text, size_t size) {
  snprintf(text, size, "by --friction");
}

static void by_vmin(char *text, size_t size) {
  snprintf(text, size, "by --vmin");
}

static void best_kernel(char *text, size_t size) {
  snprintf(text, size, "the best that the machine has");
}

/* As start.c chooses it. */
static void method_unset(char *text, size_t size) {
  snprintf(text, size,
           "multirate; rkc with --step, --reltol, --pairs all or "
           "another --control");
}

/* All others are in the checkpoint. */
static void check_resume(const struct option_spec *options) {
  static const char *const names[] = {"resume", "threads", "quiet", NULL};
  for (const struct option_spec *o = options; o->name; o++) {
    bool may = !o->given;
    for (size_t k = 0; names[k]; k++)
      may = may || !strcmp(o->name, names[k]);
    if (!may)
      die(EXIT_USAGE,
          "--%s: --resume goes on with the options of its file, expected none "
          "but --threads and --quiet",
          o->name);
  }
}

/* settle-lammps takes rkc's steps with its usual control, and has options of
   its own for what a run writes. */
static void take_method_of_export(struct settings *s,
                                  struct option_spec *options) {
  static const char *const others[] = {
      "frames", "log",    "stats",  "output",     "checkpoint",
      "every",  "resume", "abstol", "reltol",     "control",
      "step",   "pairs",  "kernel", "until-rest", NULL};
  for (const char *const *name = others; *name; name++)
    if (option_find(options, *name)->given)
      die(EXIT_USAGE, "--%s: expected none beside --export-lammps", *name);
  struct option_spec *method = option_find(options, "method");
  if (!method->given)
    s->integrate.method = "rkc";
  else if (strcmp(s->integrate.method, "rkc"))
    die(EXIT_USAGE,
        "--method %s: --export-lammps is for settle-lammps, whose method is "
        "rkc",
        s->integrate.method);
  method->given = true; /* as a scene's own is not for it */
}

static void check_log(const struct settings *s) {
  if (s->origin && !s->log)
    die(EXIT_USAGE, "--origin: expected --log beside it; beds and statistics "
                    "say it anyway");
}

static void check_checkpoint(const struct settings *s,
                             struct option_spec *options) {
  if (!s->checkpoint) {
    if (option_find(options, "every")->given)
      die(EXIT_USAGE, "--every: expected --checkpoint beside it");
    return;
  }
  if (!s->output)
    die(EXIT_USAGE, "--checkpoint: expected --output beside it, a file that "
                    "--resume can go on with");
  if (integrate_method(s->integrate.method)->opaque)
    die(EXIT_USAGE,
        "--checkpoint: not for --method %s, whose memory cannot be stored",
        s->integrate.method);
}

int main(int argc, char **argv) {
  struct settings s = {.fill = {.count = 200,
                                .radius = 0.1,
                                .mass = 1,
                                .drop = 1.1,
                                .jitter = 0.25,
                                .seed = 1},
                       .scene = scene_default(),
                       .words = scene_words_default(),
                       .integrate = {.hinit = 0.1},
                       .travel = 1,
                       .time = 8,
                       .pairs = pair_searches[CELLS],
                       .frames = 1,
                       .every = 600,
                       .threads = 1};
  /* clang-format off */
  struct option_spec options[] = {
      {.name = "scene", .type = OPTION_TEXT, .value = &s.scene_file,
       .unit = "- for standard input",
       .help = "bed whose last frame is the start; any format that analyze "
               "reads"},
      {.name = "onto", .type = OPTION_TEXT, .value = &s.onto,
       .unit = "- for standard input",
       .help = "bed whose last frame the new spheres start above"},
      {.name = "count", .type = OPTION_SIZE, .value = &s.fill.count,
       .least = 1, .most = 1e8, .help = "spheres", .parameter = true},
      POSITIVE("radius", &s.fill.radius, "m",
               "radius of the spheres, which defaults follow"),
      POSITIVE("mass", &s.fill.mass, "kg",
               "of one sphere, or of that with the mean radius, which defaults "
               "follow"),
      {.name = "density", .type = OPTION_DOUBLE, .value = &s.density,
       .most = OPTION_MANY, .unit = "kg/m^3; 0: --mass",
       .help = "of the spheres, instead of --mass"},
      {.name = "sizes", .type = OPTION_TEXT, .value = &s.sizes,
       .unit = "uniform:R1,R2, normal:MEAN,SD, lognormal:MEDIAN,SIGMA, "
               "mix:R1*SHARE,R2*SHARE,... or sieve:FILE",
       .help = "radii (m) by a distribution",
       .parameter = true, .optional = true},
      {.name = "shares", .type = OPTION_TEXT, .value = &s.shares,
       .choices = size_shares, .unset = shares_unset,
       .help = "what the shares of --sizes are of", .parameter = true,
       .optional = true},
      {.name = "base", .type = OPTION_LIST, .value = &s.words.base, .least = 2,
       .most = 2, .unit = "m", .help = "sides of the box", .parameter = true,
       .dimension = {.length = 1}},
      {.name = "lid", .type = OPTION_DOUBLE, .value = &s.lid,
       .least = -OPTION_MANY, .most = OPTION_MANY, .unit = "m",
       .unset = no_lid, .help = "a wall above, at this height"},
      SIMILAR("drop", &s.fill.drop, 0, "m",
              "height that the spheres start above; with --onto above its top",
              1, 0, 0),
      NUMBER("jitter", &s.fill.jitter, 0, 0.5, "radii",
             "random displacement at the start"),
      {.name = "fill", .type = OPTION_TEXT, .value = &s.fill_way,
       OPTION_TABLE(fill_ways), .unset = fill_unset,
       .help = "how spheres start", .parameter = true, .optional = true},
      {.name = "rate", .type = OPTION_DOUBLE, .value = &s.fill.rate,
       .most = OPTION_MANY, .unit = "1/s; 0: that with the slowest arrival",
       .help = "spheres of the rain that arrive",
       .parameter = true, .optional = true},
      SEED_OPTION(&s.fill.seed, "of the random start"),
      SCENE_OPTIONS(s.scene, s.words),
      {.name = "overlap", .type = OPTION_DOUBLE, .value = &s.overlap,
       .least = 1e-6, .most = 0.25, .unit = "diameters",
       .unset = by_kappa, .help = "mean static overlap at the floor; kappa, f0 "
                                  "and lmax follow from the load"},
      {.name = "creep", .type = OPTION_DOUBLE, .value = &s.creep,
       .least = 1e-9, .most = OPTION_MANY, .unit = "radii",
       .unset = by_vmin, .help = "how far a contact with half of its friction "
                                 "creeps by the end; vmin follows"},
      {.name = "target-fraction", .type = OPTION_DOUBLE, .value = &s.target,
       .least = 1e-3, .most = 1, .unit = "union in the bottom cube",
       .unset = by_friction,
       .help = "friction is found by up to ten trial beds"},
      SIMILAR("time", &s.time, 0, "s", "end of the run", 0, 1, 0),
      INTEGRATION_OPTIONS(s.integrate, s.travel),
      {.name = "pairs", .type = OPTION_TEXT, .value = &s.pairs,
       .choices = pair_searches, .help = "how pairs are found"},
      {.name = "kernel", .type = OPTION_TEXT, .value = &s.kernel,
       .choices = dynamics_kernels, .unset = best_kernel,
       .help = "instruction set of the forces, which the last bits depend on"},
      {.name = "until-rest", .type = OPTION_FLAG, .value = &s.until_rest,
       .help = "end once the bed hardly moves or settles any more; --time is "
               "then the longest"},
      {.name = "frames", .type = OPTION_SIZE, .value = &s.frames, .least = 1,
       .most = 1e9, .unit = "1: the last state",
       .help = "states written, evenly from start to end"},
      STATS_OPTION(s.stats),
      {.name = "log", .type = OPTION_TEXT, .value = &s.log,
       .help = "file for one row per accepted step"},
      {.name = "origin", .type = OPTION_FLAG, .value = &s.origin,
       .help = "the log begins with lines # that say what made it"},
      {.name = "output", .type = OPTION_TEXT, .value = &s.output,
       .help = "file for the bed, instead of standard output"},
      {.name = "checkpoint", .type = OPTION_TEXT, .value = &s.checkpoint,
       .help = "file that --resume goes on from, beside --output"},
      {.name = "every", .type = OPTION_DOUBLE, .value = &s.every,
       .most = OPTION_MANY, .unit = "s on the clock",
       .help = "between checkpoints; at signals too"},
      {.name = "resume", .type = OPTION_TEXT, .value = &s.resume,
       .help = "goes on from a checkpoint, to the last bit as if it had not "
               "stopped"},
      {.name = "export-lammps", .type = OPTION_TEXT, .value = &s.lammps,
       .help = "folder to write the start to instead of a run, for "
               "settle-lammps (docs/beyond-one-machine.md)"},
      {.name = "threads", .type = OPTION_SIZE, .value = &s.threads,
       .most = 1024, .unit = "0: all cores", .help = "threads"},
      {.name = "allow-partial", .type = OPTION_FLAG,
       .value = &s.allow_partial,
       .help = "take a scene that is cut short or marked as failed"},
      QUIET_OPTION(s.quiet),
      {0}};
  /* clang-format on */
  option_find(options, "method")->unset = method_unset;
  /* the end belongs to a run, not to a scene */
  option_find(options, "time")->parameter = false;
  const struct program program = {
      .name = "settle",
      .summary = "Settles a bed of soft spheres and writes it to standard "
                 "output.",
      .usage = "[OPTION...] > bed.tsv",
      .example = "settle --model basic --seed 3 | analyze",
      .options = options};
  s.command = command_words(argc, argv); /* before they are put in order */
  const int operand = options_parse(&program, argc, argv);
  if (operand < argc)
    die(EXIT_USAGE, "'%s': expected options only", argv[operand]);

  struct bed bed = {0};
  struct bed_header header = {0};
  s.all_pairs = !strcmp(s.pairs, pair_searches[ALL]);
  struct checkpoint from = {0};
  struct setup setup = {&s, options, &bed, &header, NULL};
  if (s.lammps)
    take_method_of_export(&s, options);
  if (s.resume) {
    check_resume(options);
    checkpoint_open(&from, s.resume, &setup, &setup.order);
    memory_check(&s, bed.n);
    s.all_pairs = !strcmp(s.pairs, pair_searches[ALL]);
  } else {
    start_make(&s, options, &bed, &header);
    check_log(&s);
    check_checkpoint(&s, options);
  }
  integration_check(&s.integrate, bed.n);
  if (!integrate_method(s.integrate.method)->type && s.all_pairs)
    die(EXIT_USAGE, "--pairs %s: not for --method %s", s.pairs,
        s.integrate.method);
  if (s.time < bed.t)
    die(EXIT_USAGE, "--time %g: the start is at t=%g already", s.time, bed.t);
  s.threads = system_threads(s.threads);
  if (!s.resume)
    target_take(&s, options, &bed, &header);
  int status = EXIT_DONE;
  if (s.lammps)
    export_lammps(s.lammps, &s, &bed, &header);
  else {
    status = run(&setup, &from);
    if (status == EXIT_DONE)
      target_tell(&s, &bed);
  }
  free(setup.order);
  free(s.command);
  option_texts_free(&from.texts);
  bed_free(&bed);
  bed_header_free(&header);
  scene_free(&s.scene);
  return status;
}
