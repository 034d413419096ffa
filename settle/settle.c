/* settle: integrates a bed of spheres, from the paper's start or from a file,
   and writes its frames. */
#include <float.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#ifdef _OPENMP
#include <omp.h>
#endif
#include "run.h"
#include "shared_options.h"
#include "start.h"

static const char *const models[] = {"basic", "friction", "rotation", NULL};
static const char *const pair_searches[] = {"cells", "all", NULL};

/* An implicit step solves a dense system, at a cost that grows as n^3. */
enum { MSBDF_SPHERES = 64 };

static int add_wall(const struct option_list *v, void *scene) {
  return scene_add_wall(scene, v->at, v->at + 3);
}

/* What single options cannot tell. */
static void check(const struct settings *s, const struct bed *b) {
  const struct integrate_options *o = &s->integrate;
  if (!strcmp(o->method, "msbdf") && b->n > MSBDF_SPHERES)
    die(EXIT_USAGE,
        "--method msbdf: %zu spheres, expected at most %d (each step solves a "
        "dense system)",
        b->n, MSBDF_SPHERES);
  if (!strcmp(o->method, "msbdf") && o->step > 0)
    die(EXIT_USAGE, "--method msbdf: has no fixed step");
  if (!strcmp(o->method, "verlet") && !(o->step > 0))
    die(EXIT_USAGE, "--method verlet: expected a fixed --step");
  if (s->time < b->t)
    die(EXIT_USAGE, "--time %g: the start is at t=%g already", s->time, b->t);
}

int main(int argc, char **argv) {
  struct settings s = {.fill = {.count = 200,
                                .radius = 0.1,
                                .drop = 1.1,
                                .jitter = 0.25,
                                .seed = 1},
                       .base = {2, {1, 1}},
                       .gravity = {1, {9.81}},
                       .scene = scene_default(),
                       .integrate = {.method = "merson",
                                     .control = "paper",
                                     .tol = 0.1,
                                     .hinit = 0.1},
                       .travel = 1,
                       .time = 8,
                       .model = "rotation",
                       .pairs = "cells",
                       .frames = 1,
                       .threads = 1};
  struct contact_law *law = &s.scene.law;
  struct option_spec options[] = {
      {"scene", OPTION_TEXT, &s.scene_file, 0, 0, NULL, "- for standard input",
       "bed whose last frame is the start", false, false, NULL, NULL},
      {"count", OPTION_SIZE, &s.fill.count, 1, 1e8, NULL, "", "spheres", true,
       false, NULL, NULL},
      {"radius", OPTION_DOUBLE, &s.fill.radius, DBL_MIN, OPTION_MANY, NULL, "m",
       "radius of the spheres", true, false, NULL, NULL},
      {"base", OPTION_LIST, &s.base, 2, 2, NULL, "m", "sides of the box", true,
       false, NULL, NULL},
      {"drop", OPTION_DOUBLE, &s.fill.drop, 0, OPTION_MANY, NULL, "m",
       "height that the spheres start above", true, false, NULL, NULL},
      {"jitter", OPTION_DOUBLE, &s.fill.jitter, 0, 0.5, NULL, "radii",
       "random displacement at the start", true, false, NULL, NULL},
      {"seed", OPTION_SIZE, &s.fill.seed, 0, 4294967295.0, NULL, "",
       "of the random start", true, false, NULL, NULL},
      {"model", OPTION_TEXT, &s.model, 0, 0, models, "", "variant", true, false,
       NULL, NULL},
      {"restitution", OPTION_DOUBLE, &law->restitution, 0, 1, NULL, "",
       "coefficient of restitution e", true, false, NULL, NULL},
      {"friction", OPTION_DOUBLE, &law->friction, 0, OPTION_MANY, NULL, "",
       "friction coefficient phi", true, false, NULL, NULL},
      {"gravity", OPTION_LIST, &s.gravity, 1, 3, NULL,
       "m/s^2, downwards, or gx,gy,gz", "gravity", true, false, NULL, NULL},
      {"f0", OPTION_DOUBLE, &law->f0, DBL_MIN, OPTION_MANY, NULL, "N",
       "repulsion at touch F0", true, false, NULL, NULL},
      {"kappa", OPTION_DOUBLE, &law->kappa, DBL_MIN, OPTION_MANY, NULL, "1/m",
       "stiffness exponent", true, false, NULL, NULL},
      {"psi", OPTION_DOUBLE, &law->psi, DBL_MIN, OPTION_MANY, NULL, "s/m",
       "dissipation focusing", true, false, NULL, NULL},
      {"vmin", OPTION_DOUBLE, &law->vmin, DBL_MIN, OPTION_MANY, NULL, "m/s",
       "slip speed of full friction", true, false, NULL, NULL},
      {"lmax", OPTION_DOUBLE, &law->lmax, DBL_MIN, OPTION_MANY, NULL, "m",
       "gap beyond which contacts are skipped", true, false, NULL, NULL},
      {"wall", OPTION_LIST, NULL, 6, 6, NULL,
       "px,py,pz,nx,ny,nz with a normal of positive length",
       "plane by a point and outward normal; replaces the box; repeatable",
       true, false, add_wall, &s.scene},
      {"time", OPTION_DOUBLE, &s.time, 0, OPTION_MANY, NULL, "s",
       "end of the run", false, false, NULL, NULL},
      INTEGRATION_OPTIONS(s.integrate, s.travel),
      {"pairs", OPTION_TEXT, &s.pairs, 0, 0, pair_searches, "",
       "how pairs are found", false, false, NULL, NULL},
      {"until-rest", OPTION_FLAG, &s.until_rest, 0, 0, NULL, "",
       "end once all surfaces were slower than vmin for 0.1 s", false, false,
       NULL, NULL},
      {"frames", OPTION_SIZE, &s.frames, 1, 1e9, NULL, "",
       "states written, evenly from start to end; 1: the last", false, false,
       NULL, NULL},
      {"stats", OPTION_TEXT, &s.stats, 0, 0, NULL, "",
       "file for the solver's statistics", false, false, NULL, NULL},
      {"log", OPTION_TEXT, &s.log, 0, 0, NULL, "",
       "file for one row per accepted step", false, false, NULL, NULL},
      {"threads", OPTION_SIZE, &s.threads, 0, 1024, NULL, "0: all cores",
       "threads", false, false, NULL, NULL},
      {"allow-partial", OPTION_FLAG, &s.allow_partial, 0, 0, NULL, "",
       "take a scene that is cut short or marked as failed", false, false, NULL,
       NULL},
      {"quiet", OPTION_FLAG, &s.quiet, 0, 0, NULL, "", "no progress", false,
       false, NULL, NULL},
      {0}};
  const struct program program = {
      .name = "settle",
      .summary = "Settles a bed of soft spheres and writes it to standard "
                 "output.",
      .usage = "[OPTION...] > bed.tsv",
      .example = "settle --model basic --seed 3 | analyze",
      .options = options};
  const int operand = options_parse(&program, argc, argv);
  if (operand < argc)
    die(EXIT_USAGE, "'%s': expected options only", argv[operand]);

  struct bed bed = {0};
  struct bed_header header = {0};
  start_make(&s, options, &bed, &header);
  check(&s, &bed);
#ifdef _OPENMP
  if (s.threads == 0)
    s.threads = (size_t)omp_get_num_procs();
#else
  s.threads = 1;
#endif
  const int status = run(&s, &bed, &header);
  bed_free(&bed);
  bed_header_free(&header);
  scene_free(&s.scene);
  return status;
}
