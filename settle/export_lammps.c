/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "export_lammps.h"

#include <math.h>
#include <gsl/gsl_math.h>
#include "files/lammps_data.h"
#include "files/numbers.h"
#include "program/files.h"
#include "program/origin.h"

/* LAMMPS counts spheres from 1. */
static long id_offset(const struct bed *b) {
  long least = b->id[0];
  for (size_t i = 1; i < b->n; i++)
    least = GSL_MIN(least, b->id[i]);
  return 1 - least;
}

/* The cell of periodic axes; else a box around all spheres, with a diameter to
   spare. */
static void box_of(const struct bed *b, const double period[3], double box[6]) {
  for (size_t k = 0; k < 3; k++) {
    if (period[k] > 0) {
      box[2 * k] = 0;
      box[2 * k + 1] = period[k];
      continue;
    }
    box[2 * k] = GSL_POSINF;
    box[2 * k + 1] = GSL_NEGINF;
    for (size_t i = 0; i < b->n; i++) {
      const double x = b->x[3 * i + k], margin = 2 * b->r[i];
      box[2 * k] = GSL_MIN(box[2 * k], x - margin);
      box[2 * k + 1] = GSL_MAX(box[2 * k + 1], x + margin);
    }
  }
}

/* A fixed step (s) of velocity Verlet that leaves the solid fraction of the
   paper's bed as it is: 2.5e-5 s (docs/precision.md). It scales as the fastest
   motions do: the slip of a contact, whose rate goes as phi F0/(m vmin), and
   its spring, as sqrt(kappa F0/m). */
static double fixed_step(const struct scene *s, const struct bed *b) {
  const struct scene paper = scene_default();
  double m = GSL_POSINF;
  for (size_t i = 0; i < b->n; i++)
    if (!bed_is_fixed(b, i))
      m = GSL_MIN(m, b->m[i]);
  const struct contact_law *l = &s->law, *p = &paper.law;
  double share = sqrt(p->kappa * p->f0 * m / (l->kappa * l->f0));
  if (scene_has_friction(s))
    share = GSL_MIN(share, p->friction * p->f0 / p->vmin * m * l->vmin /
                               (l->friction * l->f0));
  return 2.5e-5 * share;
}

static void put(FILE *out, size_t count, const double *x) {
  fputc(' ', out);
  numbers_write(out, ' ', count, x);
}

static const char *boundary(const struct scene *s, int axis) {
  return s->period[axis] > 0 ? "p" : "s";
}

static void write_scene(FILE *out, const struct settings *set,
                        const struct bed *b) {
  const struct scene *s = &set->scene;
  const struct contact_law *l = &s->law;
  const double step = fixed_step(s, b), skin = 4.5 * set->travel / l->kappa;
  const double g = sqrt(vec3_dot(s->gravity, s->gravity));
  const char *moving = b->fixed ? "moving" : "all";
  origin_write(out, &origin_comment, set->command, NULL);
  fprintf(out,
          "# Scene of start.tsv for settle-lammps, a LAMMPS with the contact "
          "law of the\n# paper: pair_style dem and fix dem/walls.\nunits "
          "si\natom_style sphere\n# each rank computes the "
          "pairs of its own spheres\nnewton off\n# columns: a bed is "
          "settled by gravity, and slices of it would fill one by one\n"
          "processors * * 1\n# periodic (p), else a box that follows the "
          "spheres and loses none\n"
          "boundary %s %s %s\ncomm_modify vel yes\nread_data bed.data\n"
          "# spheres may go half of this before pairs are looked for again\n"
          "neighbor",
          boundary(s, 0), boundary(s, 1), boundary(s, 2));
  put(out, 1, &skin);
  fprintf(out,
          " bin\nneigh_modify delay 0 every 1 check yes\n%s"
          "# model F0 kappa psi e phi vmin lmax rolling lever\n"
          "pair_style dem %s",
          b->fixed ? "group moving type 1\ngroup fixed type 2\n"
                     "neigh_modify exclude group fixed fixed\n"
                   : "",
          scene_models[s->model].name);
  put(out, 8,
      (double[]){l->f0, l->kappa, l->psi, l->restitution, l->friction, l->vmin,
                 l->lmax, l->rolling});
  fprintf(out,
          " %d\npair_coeff * *\n# px py pz nx ny nz r of each: a "
          "plane with its outward normal, or where r > 0\n# a cylinder "
          "with its axis\n"
          "fix walls %s dem/walls",
          l->lever == LEVER_CONTACT, moving);
  for (size_t k = 0; k < s->walls_count; k++) {
    put(out, 3, s->walls[k].point);
    put(out, 3, s->walls[k].normal);
    put(out, 1, &s->walls[k].radius);
  }
  fprintf(out, "\nfix gravity %s gravity", moving);
  put(out, 1, &g);
  fprintf(out, " vector");
  put(out, 3, g > 0 ? s->gravity : (double[]){0, 0, -1});
  fprintf(out,
          "\nfix move %s nve/sphere\n"
          "# The paper's bed keeps its solid fraction up to a fixed step of "
          "2.5e-5 s; at 1e-4 s\n# it is denser by 0.007, without a sign of it. "
          "The step scales as m vmin/(phi F0)\n# and sqrt(m/(kappa F0)), with "
          "the mass of the lightest sphere.\ntimestep",
          moving);
  put(out, 1, &step);
  /* read by the host */
  fprintf(out, "\n# start, end (s), tolerance (m/s), first step (s), longest "
               "travel in a step\n# (1/kappa), gravity (m/s^2), LAMMPS's ids "
               "less the bed's\nvariable dem_run string \"");
  numbers_write(out, ' ', 9,
                (double[]){b->t, set->time, set->integrate.tol,
                           set->integrate.hinit, set->travel, s->gravity[0],
                           s->gravity[1], s->gravity[2], (double)id_offset(b)});
  fprintf(out, "\"\n");
}

static void write_run(FILE *out, const struct settings *set,
                      const struct bed *b) {
  const double step = fixed_step(&set->scene, b);
  const double steps = ceil((set->time - b->t) / step);
  origin_write(out, &origin_comment, set->command, NULL);
  fprintf(
      out,
      "# The run with a fixed step by LAMMPS itself: settle-lammps --script "
      "in.run\ninclude in.scene\nthermo 10000\n"
      "dump last all custom %.0f dump.lammps id type x y z vx vy vz radius "
      "mass omegax omegay omegaz\n"
      "dump_modify last time yes sort id format float %%.17g\nrun %.0f\n",
      steps, steps);
}

void export_lammps(const char *folder, const struct settings *s,
                   const struct bed *b, const struct bed_header *header) {
  if (s->integrate.hmax > 0)
    die(EXIT_USAGE, "--hmax %g: expected none beside --export-lammps",
        s->integrate.hmax);
  if (!(s->travel > 0))
    die(EXIT_USAGE,
        "--travel 0: --export-lammps needs a limit, which tells how "
        "long a list of pairs holds");
  struct output_file file;
  output_folder(folder);
  output_open_in(&file, folder, "start.tsv");
  bed_write_frame(file.stream, header, b, scene_has_rotation(&s->scene));
  bed_write_status(file.stream, "ok");
  output_commit(&file);
  output_open_in(&file, folder, "bed.data");
  double box[6];
  box_of(b, s->scene.period, box);
  char by[80];
  origin_name(by, sizeof by);
  lammps_data_title(file.stream, by, "", b->t);
  origin_write(file.stream, &origin_short, s->command, NULL);
  lammps_data_write(file.stream, b, id_offset(b), box);
  output_commit(&file);
  output_open_in(&file, folder, "in.scene");
  write_scene(file.stream, s, b);
  output_commit(&file);
  output_open_in(&file, folder, "in.run");
  write_run(file.stream, s, b);
  output_commit(&file);
}
