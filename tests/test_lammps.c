/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of random beds by settle-lammps, by its kernel over owned rows and
   ghosts and by its pair style and walls, on one and several ranks, against
   dynamics_rhs. The host is built by make lammps; tests/test_lammps.sh builds
   it where LAMMPS is. */
#define _POSIX_C_SOURCE 200809L
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "dynamics/dynamics.h"
#include "files/bed_io.h"
#include "check.h"
#include "sample.h"

enum { SIDE = 5, N = SIDE * SIDE * SIDE };

static char folder[64], programs[512];

/* Spheres on a grid, shaken so that neighbours overlap or are apart by up to
   0.03 m, in motion. */
static void shake(struct bed *b, gsl_rng *rng, bool equal) {
  for (size_t i = 0; i < N; i++) {
    const size_t place[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
    b->r[i] = equal ? 0.1 : uniform(rng, 0.07, 0.1);
    b->m[i] = equal ? 1 : gsl_pow_3(b->r[i] / 0.1);
    for (size_t k = 0; k < 3; k++) {
      b->x[3 * i + k] =
          0.1 + 0.2 * (double)place[k] + uniform(rng, -0.015, 0.015);
      b->v[3 * i + k] = uniform(rng, -0.5, 0.5) * (i % 2 ? 1 : 0.01);
      b->w[3 * i + k] = uniform(rng, -5, 5) * (i % 3 ? 1 : 0.001);
    }
  }
}

/* Every seventh sphere at rest for good. */
static void make_obstacles(struct bed *b) {
  CHECK(bed_fix_none(b) == GSL_SUCCESS);
  for (size_t i = 0; i < N; i += 7) {
    b->fixed[i] = true;
    for (size_t k = 0; k < 3; k++)
      b->v[3 * i + k] = b->w[3 * i + k] = 0;
  }
}

static bool runs(const char *command) {
  const bool done = system(command) == 0;
  if (!done)
    fprintf(stderr, "failed: %s\n", command);
  return done;
}

/* Reads rates as they are written, by id. */
static bool read_rates(size_t stride, double *rates) {
  char path[128];
  snprintf(path, sizeof path, "%s/rates", folder);
  FILE *in = fopen(path, "r");
  size_t rows = 0;
  double id;
  while (in && fscanf(in, "%lf", &id) == 1 && id >= 0 && id < N) {
    rows++;
    for (size_t k = 0; k < stride; k++)
      if (fscanf(in, "%lf", &rates[(size_t)id * stride + k]) != 1)
        rows = N + 1;
  }
  if (in)
    fclose(in);
  return rows == N;
}

static void compare(struct scene *s, const struct bed *b, const char *options) {
  struct dynamics *d = NULL;
  char command[2048];
  CHECK(dynamics_alloc(&d, s, b, &(struct dynamics_options){.threads = 1}) ==
        GSL_SUCCESS);
  const size_t stride = dynamics_stride(d);
  double *y = numbers(N * stride), *f = numbers(N * stride),
         *got = numbers(N * stride);
  struct bed places = {0};
  CHECK(bed_copy(&places, b) == GSL_SUCCESS);
  dynamics_pack(d, b, y);
  CHECK(dynamics_rhs(0, y, f, d) == GSL_SUCCESS);
  /* rows to spheres, by the way that states go */
  dynamics_unpack(d, f, &places);

  snprintf(command, sizeof command,
           "%s/settle --quiet --scene %s/bed --time 1 --export-lammps "
           "%s/scene %s",
           programs, folder, folder, options);
  CHECK(runs(command));
  /* one rank without mpirun, which takes most of the time */
  for (int ranks = 1; ranks <= 4; ranks *= 2)
    for (int by_lammps = 0; by_lammps < (ranks == 2 ? 1 : 2); by_lammps++) {
      char launcher[128] = "";
      if (ranks > 1)
        snprintf(launcher, sizeof launcher,
                 "mpirun --allow-run-as-root --oversubscribe --mca "
                 "mpi_yield_when_idle 1 -np %d",
                 ranks);
      snprintf(command, sizeof command,
               "rm -f %s/rates; timeout 120 %s %s/settle-lammps --rates "
               "%s/rates %s %s/scene",
               folder, launcher, programs, folder, by_lammps ? "--lammps" : "",
               folder);
      CHECK(runs(command) && read_rates(stride, got));
      double worst = 0, most[3] = {0};
      for (size_t i = 0; i < N; i++)
        for (size_t k = 0; k < stride; k++) {
          const double *of = k < 3 ? places.x : k < 6 ? places.v : places.w;
          const double want = bed_is_fixed(b, i) ? 0 : of[3 * i + k % 3];
          most[k / 3] = GSL_MAX(most[k / 3], fabs(want));
          worst = GSL_MAX(worst,
                          fabs(got[stride * i + k] - want) / (1 + fabs(want)));
        }
      /* sums in another order, and masses by way of a density */
      CHECK_CLOSE(worst, 0, 1e-10);
      CHECK(most[1] > 10 && (stride == 6 || most[2] > 10));
    }
  bed_free(&places);
  free(y);
  free(f);
  free(got);
  dynamics_free(d);
}

static void write_bed(const struct bed *b) {
  char path[128];
  snprintf(path, sizeof path, "%s/bed", folder);
  FILE *out = fopen(path, "w");
  struct bed_header h = {0};
  CHECK(bed_header_add(&h, "format", "bed-1") == GSL_SUCCESS);
  CHECK(bed_header_add(&h, "base", "1,1") == GSL_SUCCESS);
  bed_write_frame(out, &h, b, true);
  bed_write_status(out, "ok");
  CHECK(fclose(out) == 0);
  bed_header_free(&h);
}

int main(void) {
  const char *b = getenv("B");
  snprintf(programs, sizeof programs, "%s", b ? b : "build");
  char host[600];
  snprintf(host, sizeof host, "%s/settle-lammps", programs);
  if (access(host, X_OK) != 0 || system("mpirun --version >/dev/null 2>&1")) {
    puts("skipped: settle-lammps (make lammps, which needs liblammps-dev)");
    CHECK(true);
    return check_done();
  }
  strcpy(folder, "/tmp/test_lammps.XXXXXX");
  if (!mkdtemp(folder))
    return 1;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  static const struct {
    enum scene_model model;
    bool equal;
    enum contact_lever lever;
    double rolling;
    bool around; /* x and y are periodic, and some spheres are obstacles */
    const char *options;
  } cases[] = {{SCENE_ROTATION, true, LEVER_PAPER, 0, false,
                "--model rotation"},
               {SCENE_ROTATION, false, LEVER_CONTACT, 0.1, false,
                "--model rotation --lever contact --rolling 0.1"},
               {SCENE_FRICTION, false, LEVER_PAPER, 0, true,
                "--model friction --periodic xy"},
               {SCENE_BASIC, false, LEVER_PAPER, 0, false, "--model basic"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    struct bed bed = {0};
    struct scene s = scene_default();
    gsl_rng_set(rng, 100 + c);
    CHECK(bed_alloc(&bed, N) == GSL_SUCCESS);
    shake(&bed, rng, cases[c].equal);
    if (cases[c].around) {
      make_obstacles(&bed);
      s.period[0] = s.period[1] = 1;
    }
    s.model = cases[c].model;
    s.law.lever = cases[c].lever;
    s.law.rolling = cases[c].rolling;
    /* a floor, a wall and a cylinder that lean, as on the command line */
    CHECK(scene_add_wall(&s, (double[]){0, 0, 0}, (double[]){0, 0, -1}) ==
          GSL_SUCCESS);
    CHECK(scene_add_wall(&s, (double[]){1.15, 0, 0.5},
                         (double[]){1, 0.1, 0.1}) == GSL_SUCCESS);
    CHECK(scene_add_cylinder(&s, (double[]){0.5, 0.5, 0}, (double[]){0.1, 0, 1},
                             0.8) == GSL_SUCCESS);
    write_bed(&bed);
    char options[256];
    snprintf(options, sizeof options,
             "--kappa 150 --f0 10 --psi 10 --vmin 0.01 --lmax 0.1 %s --wall "
             "0,0,0,0,0,-1 --wall 1.15,0,0.5,1,0.1,0.1 --cylinder "
             "0.5,0.5,0,0.1,0,1,0.8",
             cases[c].options);
    compare(&s, &bed, options);
    scene_free(&s);
    bed_free(&bed);
  }
  gsl_rng_free(rng);
  char command[128];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  CHECK(runs(command));
  return check_done();
}
