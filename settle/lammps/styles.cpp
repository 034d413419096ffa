/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "styles.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include "atom.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"

using namespace LAMMPS_NS;

static double number(Error *error, const char *word) {
  char *end;
  const double x = strtod(word, &end);
  if (end == word || *end || !std::isfinite(x))
    error->all(FLERR, std::string("dem: expected a number: ") + word);
  return x;
}

/* A body: a sphere, or a wall at rest. */
struct body {
  const double *v, *w;
  double r; /* 0: a wall */
};

/* Force on a, and torques on a and b, of a contact with the gap l and the
   normal n from b to a. */
static void contact_between(const struct scene *s, const double n[3], double l,
                            const body &a, const body &b, double f[3],
                            double on_a[3], double on_b[3]) {
  static const double still[3] = {0, 0, 0};
  const struct contact_law *law = &s->law;
  const bool turns = scene_has_rotation(s);
  const double *va = a.v, *vb = b.r > 0 ? b.v : still;
  const double arm_a = contact_arm(law, a.r, l);
  const double arm_b = b.r > 0 ? contact_arm(law, b.r, l) : 0;
  const double *wb = b.r > 0 ? b.w : still;
  double w[3], spin[3] = {0, 0, 0}, t[3], g[3] = {0, 0, 0}, turn[3];
  vec3_sub(va, vb, w);
  if (turns)
    for (int k = 0; k < 3; k++)
      spin[k] = arm_a * a.w[k] + arm_b * wb[k];
  const double rate = contact_tangent(n, w, spin, t);
  if (scene_has_friction(s))
    contact_friction(law, l, t, g);
  const double normal = contact_normal(law, l, rate);
  for (int k = 0; k < 3; k++)
    f[k] = normal * n[k] + g[k];
  vec3_cross(n, g, turn);
  for (int k = 0; k < 3; k++) {
    on_a[k] = turns ? -arm_a * turn[k] : 0;
    on_b[k] = turns ? -arm_b * turn[k] : 0;
  }
  if (scene_has_rolling(s)) {
    double rolls[3], torque[3];
    vec3_sub(a.w, wb, rolls);
    contact_roll(law, l, b.r > 0 ? contact_reduced(a.r, b.r) : a.r, n, rolls,
                 torque);
    for (int k = 0; k < 3; k++) {
      on_a[k] += torque[k];
      on_b[k] -= torque[k];
    }
  }
}

/* --- pairs
 * ------------------------------------------------------------------*/

PairDem::PairDem(LAMMPS *lammps)
    : Pair(lammps), scene(), equal(true), largest(0) {
  single_enable = restartinfo = 0;
  no_virial_fdotr_compute = 1;
}

PairDem::~PairDem() {
  if (allocated) {
    memory->destroy(setflag);
    memory->destroy(cutsq);
  }
}

void PairDem::settings(int count, char **words) {
  if (count != 10)
    error->all(FLERR, std::string(
                          "pair_style dem: expected a model and nine numbers"));
  if (scene_model_named(words[0], &scene.model) != 0)
    error->all(FLERR, std::string("pair_style dem: no such model"));
  struct contact_law *l = &scene.law;
  double *const places[] = {&l->f0,       &l->kappa, &l->psi,  &l->restitution,
                            &l->friction, &l->vmin,  &l->lmax, &l->rolling};
  for (int k = 0; k < 8; k++)
    *places[k] = number(error, words[k + 1]);
  l->lever = number(error, words[9]) != 0 ? LEVER_CONTACT : LEVER_PAPER;
  const char *wrong = scene_check(&scene);
  if (wrong)
    error->all(FLERR, std::string("pair_style dem: ") + wrong);
}

void PairDem::coeff(int, char **) {
  const int n = atom->ntypes;
  if (!allocated) {
    allocated = 1;
    memory->create(setflag, n + 1, n + 1, "dem:setflag");
    memory->create(cutsq, n + 1, n + 1, "dem:cutsq");
  }
  for (int i = 1; i <= n; i++)
    for (int j = 1; j <= n; j++)
      setflag[i][j] = 1;
}

void PairDem::init_style() {
  if (!atom->sphere_flag)
    error->all(FLERR,
               std::string("pair_style dem: expected atom_style sphere"));
  double size[2] = {0, 0}; /* largest radius, less the smallest */
  for (int i = 0; i < atom->nlocal; i++) {
    size[0] = fmax(size[0], atom->radius[i]);
    size[1] = i ? fmax(size[1], -atom->radius[i]) : -atom->radius[i];
  }
  if (!atom->nlocal)
    size[1] = -INFINITY;
  MPI_Allreduce(MPI_IN_PLACE, size, 2, MPI_DOUBLE, MPI_MAX, world);
  largest = size[0];
  equal = size[0] == -size[1];
  neighbor->request(this, instance_me);
}

double PairDem::init_one(int, int) {
  return 2 * largest + scene.law.lmax;
}

void PairDem::compute(int, int) {
  double **x = atom->x, **f = atom->f, **q = atom->torque;
  const double *r = atom->radius;
  const int own = atom->nlocal;
  for (int k = 0; k < list->inum; k++) {
    const int i = list->ilist[k];
    for (int c = 0; c < list->numneigh[i]; c++) {
      const int j = list->firstneigh[i][c] & NEIGHMASK;
      double n[3], on[3], on_i[3], on_j[3];
      vec3_sub(x[i], x[j], n);
      const double d = vec3_norm(n), gap = d - r[i] - r[j];
      if (gap > scene.law.lmax)
        continue;
      for (double &component : n)
        component /= d;
      contact_between(&scene, n, gap, {atom->v[i], atom->omega[i], r[i]},
                      {atom->v[j], atom->omega[j], r[j]}, on, on_i, on_j);
      vec3_axpy(1, on, f[i]);
      vec3_axpy(1, on_i, q[i]);
      if (j < own || force->newton_pair) {
        vec3_axpy(-1, on, f[j]);
        vec3_axpy(1, on_j, q[j]);
      }
    }
  }
}

/* --- walls
 * ------------------------------------------------------------------*/

FixDemWalls::FixDemWalls(LAMMPS *lammps, int count, char **words)
    : Fix(lammps, count, words) {
  if ((count - 3) % 7)
    error->all(
        FLERR,
        std::string(
            "fix dem/walls: expected a point, a normal and a radius for each"));
  for (int k = 3; k < count; k += 7) {
    struct wall w;
    for (int c = 0; c < 3; c++) {
      w.point[c] = number(error, words[k + c]);
      w.normal[c] = number(error, words[k + 3 + c]);
    }
    w.radius = number(error, words[k + 6]);
    const double length = vec3_norm(w.normal);
    if (!(length > 0))
      error->all(FLERR, std::string("fix dem/walls: a normal has no length"));
    for (double &component : w.normal)
      component /= length;
    walls.push_back(w);
  }
}

int FixDemWalls::setmask() {
  return FixConst::POST_FORCE;
}

void FixDemWalls::setup(int flag) {
  post_force(flag);
}

void FixDemWalls::post_force(int) {
  const PairDem *pair = dynamic_cast<PairDem *>(force->pair);
  if (!pair)
    error->all(FLERR, std::string("fix dem/walls: expected pair_style dem"));
  for (int i = 0; i < atom->nlocal; i++)
    for (const struct wall &w : walls) {
      if (!(atom->mask[i] & groupbit))
        break;
      const double r = atom->radius[i];
      double n[3], on_sphere[3], turn[3], other[3];
      const double gap = wall_nearest(&w, atom->x[i], n) - r;
      if (gap > pair->scene.law.lmax)
        continue;
      for (double &component : n) /* inward, to the sphere */
        component = -component;
      contact_between(&pair->scene, n, gap, {atom->v[i], atom->omega[i], r},
                      {nullptr, nullptr, 0}, on_sphere, turn, other);
      vec3_axpy(1, on_sphere, atom->f[i]);
      vec3_axpy(1, turn, atom->torque[i]);
    }
}

/* --- what travels
 * -----------------------------------------------------------*/

FixDemRows::FixDemRows(LAMMPS *lammps, int count, char **words)
    : Fix(lammps, count, words), row(nullptr) {
  maxexchange = WIDTH;
  FixDemRows::grow_arrays(atom->nmax);
  atom->add_callback(Atom::GROW);
  for (int i = 0; i < atom->nlocal; i++)
    memset(row[i], 0, WIDTH * sizeof(double));
}

FixDemRows::~FixDemRows() {
  atom->delete_callback(id, Atom::GROW);
  memory->destroy(row);
}

void FixDemRows::grow_arrays(int n) {
  memory->grow(row, n, static_cast<int>(WIDTH), "dem:rows");
}

void FixDemRows::copy_arrays(int from, int to, int) {
  memcpy(row[to], row[from], WIDTH * sizeof(double));
}

int FixDemRows::pack_exchange(int i, double *to) {
  memcpy(to, row[i], WIDTH * sizeof(double));
  return WIDTH;
}

int FixDemRows::unpack_exchange(int i, double *from) {
  memcpy(row[i], from, WIDTH * sizeof(double));
  return WIDTH;
}

/* --- names
 * ------------------------------------------------------------------*/

static Pair *make_pair(LAMMPS *lammps) {
  return new PairDem(lammps);
}

static Fix *make_walls(LAMMPS *lammps, int count, char **words) {
  return new FixDemWalls(lammps, count, words);
}

static Fix *make_rows(LAMMPS *lammps, int count, char **words) {
  return new FixDemRows(lammps, count, words);
}

void styles_add(LAMMPS *lammps) {
  (*lammps->force->pair_map)["dem"] = &make_pair;
  (*lammps->modify->fix_map)["dem/walls"] = &make_walls;
  (*lammps->modify->fix_map)["dem/rows"] = &make_rows;
}
