/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The parts of a bed that LAMMPS lacks: the contact law between spheres and at
   walls (common/model/contact.h), and room for what travels with a sphere. */
#ifndef STYLES_H
#define STYLES_H

#include <vector>
#include "fix.h"
#include "lammps.h"
#include "pair.h"
extern "C" {
#include "model/scene.h"
}

/* pair_style dem MODEL F0 KAPPA PSI E PHI VMIN LMAX ROLLING LEVER */
class PairDem : public LAMMPS_NS::Pair {
public:
  explicit PairDem(LAMMPS_NS::LAMMPS *lammps);
  ~PairDem() override;
  void settings(int count, char **words) override;
  void coeff(int count, char **words) override;
  void init_style() override;
  double init_one(int i, int j) override;
  void compute(int energy, int virial) override;

  struct scene scene; /* without walls */
  bool equal;         /* all radii are */
  const LAMMPS_NS::NeighList *pairs() const {
    return list;
  }

private:
  double largest; /* radius (m) */
};

/* fix ID GROUP dem/walls PX PY PZ NX NY NZ R ...: planes, and cylinders of the
   radius R; the law is that of the pair style. */
class FixDemWalls : public LAMMPS_NS::Fix {
public:
  FixDemWalls(LAMMPS_NS::LAMMPS *lammps, int count, char **words);
  int setmask() override;
  void setup(int flag) override;
  void post_force(int flag) override;

  std::vector<struct wall> walls;
};

/* fix ID all dem/rows: numbers of each sphere that go with it to another
   rank. */
class FixDemRows : public LAMMPS_NS::Fix {
public:
  enum { WIDTH = 18 }; /* two rows */
  FixDemRows(LAMMPS_NS::LAMMPS *lammps, int count, char **words);
  ~FixDemRows() override;
  int setmask() override {
    return 0;
  }
  void grow_arrays(int n) override;
  void copy_arrays(int from, int to, int deleted) override;
  int pack_exchange(int i, double *to) override;
  int unpack_exchange(int i, double *from) override;

  double **row;
};

/* Makes them known. */
void styles_add(LAMMPS_NS::LAMMPS *lammps);

#endif
