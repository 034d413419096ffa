/* SPDX-License-Identifier: GPL-2.0-or-later */
/* settle-lammps: one bed on many machines. LAMMPS shares the spheres among MPI
   ranks, hands ghosts on and lists pairs; our kernel computes the forces, and
   our rkc takes the steps. The scene is a folder by settle --export-lammps, the
   result a bed. docs/beyond-one-machine.md is its page, tests/test_lammps.sh
   tests it. */
#include <algorithm>
#include <climits>
#include <csignal>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <new>
#include <string>
#include <unistd.h>
#include <vector>
#include <mpi.h>
#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "force.h"
#include "input.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "styles.h"
#include "update.h"
#include "variable.h"
extern "C" {
#include "files/numbers.h"
#include "files/sheet.h"
#include "model/travel.h"
#include "rows.h"
#include "steppers/predictive.h"
#include "steppers/rkc_step.h"
}
#include <gsl/gsl_errno.h>

using LAMMPS_NS::Atom;
using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::NeighList;

enum { DONE, IO, USAGE, INPUT, INTEGRATION, LIMIT }; /* exit status */

enum { MOVING = 1, FIXED }; /* types of spheres in bed.data */

enum { WIDTH = 13 }; /* numbers of a sphere in the result */

/* Steps that the kernel's pairs serve. Choosing them costs a fourth of an
   evaluation; they are few if they serve few. */
enum { NEAR_SERVES = 4 };

static int rank;
static bool finished; /* LAMMPS ends a process where it meets an error */
static FILE *said;    /* what it says on other ranks than the first */
static bool shown;    /* a line of progress is on the terminal */

static volatile sig_atomic_t asked_to_end;

static void end_soon(int) {
  asked_to_end = 1;
}

static void clear_line() {
  if (shown)
    fputs("\r\033[K", stderr);
  shown = false;
}

/* An error that one rank meets is in its own messages only. */
static void tell_error() {
  FILE *log = rank ? said : fopen("log.lammps", "r");
  char line[512], error[512] = "log.lammps says why";
  if (log)
    rewind(log);
  while (log && fgets(line, sizeof line, log))
    if (strncmp(line, "ERROR", 5) == 0) {
      line[strcspn(line, "\n")] = 0;
      strcpy(error, line);
    }
  fprintf(stderr, "settle-lammps: LAMMPS: %s\n", error);
}

static void ended_by_lammps() {
  if (!finished && rank == 0)
    tell_error();
}

/* LAMMPS calls it where one rank meets an error, and nothing else then runs on
   any rank. */
extern "C" int MPI_Abort(MPI_Comm world, int code) {
  if (!finished)
    tell_error();
  finished = true;
  return PMPI_Abort(world, code);
}

/* The same on all ranks, which all come here. */
[[noreturn]] static void die(int status, const std::string &message) {
  finished = true;
  clear_line();
  if (rank == 0)
    fprintf(stderr, "settle-lammps: %s\n", message.c_str());
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
  exit(status);
}

/* Others may have some. */
[[noreturn]] static void no_memory() {
  finished = true;
  fprintf(stderr, "settle-lammps: out of memory on rank %d\n", rank);
  PMPI_Abort(MPI_COMM_WORLD, IO);
  exit(IO);
}

/* What in.scene says to us. */
struct plan {
  double start, end, tol, hinit, travel, gravity[3], id_offset;
};

struct counts {
  size_t evaluations, accepted, rejected, builds, near_builds, sums;
  double ghosts, contacts; /* summed over evaluations */
};

/* What is kept of a run, and shown of it. */
struct keeping {
  std::string output;     /* file for the bed; empty: standard output */
  double every, last;     /* s between beds, 0: none; when the last one was */
  double begun, progress; /* when the run began, when it was shown last (s) */
  bool quiet;
};

/* What some rank wants after a step, the most urgent last. */
enum { GO_ON, SAVE, END };

class Bed {
public:
  Bed(LAMMPS *lammps, const plan &p, const keeping &k);
  ~Bed();
  /* Whether it came to the end. */
  bool integrate();
  void save(const std::string &status);
  std::string interrupted() const;
  void rates_at_start(const char *path, bool by_lammps);
  void write_stats(const char *path, double wall_seconds, double cpu_seconds);

  double t;
  counts count;

private:
  LAMMPS *lammps;
  const plan &set;
  keeping keep;
  double wished; /* by the last accepted step */
  PairDem *pair;
  FixDemRows *carried;
  struct rows *rows;
  struct scene scene;
  size_t stride;
  double skin, cap; /* cap: longest way in a step (m) */
  bool ghosts;      /* some rank may have some */
  struct rkc_step step;
  struct predictive control;
  /* of own rows; filled: with ghosts */
  std::vector<double> y, start, f0, f1, error, weight, direction, work, filled,
      reference;
  /* The pairs that the kernel computes are those of LAMMPS within near (m), a
     smaller skin, of the places in near_reference, which are up to apart (m)
     from the reference. */
  std::vector<double> near_reference;
  double near, apart;
  double furthest2; /* that a stage was from near_reference (m^2) */
  /* Of the state on all ranks: 1 by the longest step that the cap allows (1/s),
     the longest way from the reference and from near_reference (m). */
  double ahead[3];

  size_t own() const {
    return static_cast<size_t>(lammps->atom->nlocal);
  }
  size_t dim() const {
    return stride * own();
  }
  void resize();
  void to_lammps(const double *from);
  void from_lammps(double *to) const;
  void list();
  void list_near(const double *from, double wanted);
  const double *fill(const double *from);
  void relay();
  const double *with_ghosts(const double *from);
  rkc_problem problem();
  void look_ahead(double most[3]) const;
  void largest(double values[], int n);
  bool attempt(double h, double *next);
  double wish() const;
  void show(double h);
  void gather(FILE *out, const std::string &status);
  bool runs_away(double way, double h, double *next);
  std::vector<double> gathered(size_t width, const std::vector<double> &mine);

  static int rates(double t, const double y[], double f[], void *bed);
  static int stage(double t, const double y[], const struct stage *s,
                   double out[], void *bed);
  static double total(double part, void *bed);
};

Bed::Bed(LAMMPS *l, const plan &p, const keeping &k)
    : t(p.start), count(), lammps(l), set(p), keep(k), wished(GO_ON),
      rows(nullptr), scene(), stride(0), step(), control(), near(0), apart(0),
      furthest2(0), ahead() {
  lammps->input->one("fix dem_rows all dem/rows");
  lammps->input->one("run 0 post no");
  pair = dynamic_cast<PairDem *>(lammps->force->pair);
  const int f = lammps->modify->find_fix("dem_rows");
  carried = dynamic_cast<FixDemRows *>(lammps->modify->fix[f]);
  if (!pair || !carried || lammps->force->newton_pair)
    die(INPUT, "in.scene: expected pair_style dem and newton off");
  scene = pair->scene;
  std::copy(set.gravity, set.gravity + 3, scene.gravity);
  std::vector<struct wall> walls;
  for (int k = 0; k < lammps->modify->nfix; k++)
    if (auto w = dynamic_cast<FixDemWalls *>(lammps->modify->fix[k]))
      walls.insert(walls.end(), w->walls.begin(), w->walls.end());
  scene.walls_count = walls.size();
  scene.walls = walls.data();
  skin = lammps->neighbor->skin;
  ghosts = lammps->comm->nprocs > 1 || lammps->domain->xperiodic ||
           lammps->domain->yperiodic;
  cap = set.travel / scene.law.kappa;
  if (!(set.travel > 0) || skin < 4 * cap)
    die(INPUT, "in.scene: the skin of neighbor must be 4 travels of a step");
  if (rows_alloc(&rows, &scene, pair->equal) != GSL_SUCCESS)
    no_memory();
  stride = rows_stride(rows);
  if (lammps->atom->natoms > INT_MAX / WIDTH)
    die(INPUT, "bed.data: expected at most " + std::to_string(INT_MAX / WIDTH) +
                   " spheres, which one rank gathers");
  resize();
  if (rkc_step_init(&step, direction.data()) != GSL_SUCCESS)
    no_memory();
  from_lammps(y.data());
  list();
  list_near(y.data(), skin);
}

Bed::~Bed() {
  rkc_step_free(&step);
  rows_free(rows);
}

/* Room for the rows that this rank has now. */
void Bed::resize() {
  const size_t n = dim() + 1;
  for (auto *v : {&y, &start, &f0, &f1, &error, &weight, &direction})
    v->resize(n);
  work.resize(5 * n);
  reference.resize(3 * own() + 1);
  near_reference.resize(3 * own() + 1);
  step.power.direction = direction.data();
}

void Bed::to_lammps(const double *from) {
  const Atom *a = lammps->atom;
  for (size_t i = 0; i < own(); i++, from += stride) {
    std::copy(from + ROW_X, from + ROW_X + 3, a->x[i]);
    std::copy(from + ROW_V, from + ROW_V + 3, a->v[i]);
    if (stride == ROW_SPIN)
      std::copy(from + ROW_W, from + ROW_W + 3, a->omega[i]);
  }
}

/* A sphere of LAMMPS as a row. */
static void take_row(const Atom *a, size_t i, size_t stride, double *to) {
  std::copy(a->x[i], a->x[i] + 3, to + ROW_X);
  std::copy(a->v[i], a->v[i] + 3, to + ROW_V);
  if (stride == ROW_SPIN)
    std::copy(a->omega[i], a->omega[i] + 3, to + ROW_W);
}

void Bed::from_lammps(double *to) const {
  for (size_t i = 0; i < own(); i++)
    take_row(lammps->atom, i, stride, to + i * stride);
}

/* After LAMMPS has listed pairs: the same as a choice for the kernel. */
void Bed::list() {
  const Atom *a = lammps->atom;
  const NeighList *l = pair->pairs();
  const size_t n = own();
  std::vector<uint32_t> i, j, fixed;
  std::vector<size_t> first(n + 1, 0);
  for (int k = 0; k < l->inum; k++)
    first[static_cast<size_t>(l->ilist[k]) + 1] =
        static_cast<size_t>(l->numneigh[l->ilist[k]]);
  for (size_t k = 0; k < n; k++)
    first[k + 1] += first[k];
  i.resize(first[n]);
  j.resize(first[n]);
  for (int k = 0; k < l->inum; k++) {
    const int s = l->ilist[k];
    const size_t at = first[static_cast<size_t>(s)];
    for (int c = 0; c < l->numneigh[s]; c++) {
      i[at + static_cast<size_t>(c)] = static_cast<uint32_t>(s);
      j[at + static_cast<size_t>(c)] =
          static_cast<uint32_t>(l->firstneigh[s][c] & NEIGHMASK);
    }
  }
  for (size_t k = 0; k < n; k++)
    if (a->type[k] == FIXED)
      fixed.push_back(static_cast<uint32_t>(k));
  struct rows_layout layout = {};
  layout.count = n;
  layout.ghosts = static_cast<size_t>(a->nghost);
  layout.x = n ? a->x[0] : nullptr;
  layout.radius = a->radius;
  layout.mass = a->rmass;
  layout.i = i.data();
  layout.j = j.data();
  layout.first = first.data();
  layout.fixed = fixed.data();
  layout.fixed_count = fixed.size();
  layout.skin = skin;
  if (rows_set(rows, &layout) != GSL_SUCCESS)
    no_memory();
  rows_weights(rows, weight.data());
  filled.resize((n + layout.ghosts) * stride + 1);
  for (size_t k = 0; k < n; k++)
    std::copy(a->x[k], a->x[k] + 3, &reference[3 * k]);
  count.builds++;
  std::fill(ahead + 1, ahead + 3, 0);
  near = -1; /* there is none */
}

/* The pairs near these own rows and the ghosts that LAMMPS has. */
void Bed::list_near(const double *from, double wanted) {
  apart = ahead[1];
  near = std::min(wanted, skin - 2 * apart);
  rows_near(rows, fill(from), near);
  for (size_t i = 0; i < own(); i++)
    std::copy(from + i * stride + ROW_X, from + i * stride + ROW_X + 3,
              &near_reference[3 * i]);
  ahead[2] = 0;
  count.near_builds++;
}

/* Between steps: spheres go to the rank that they are in, which gets new ghosts
   and pairs. Their rates and their share of rkc's direction go with them. */
void Bed::relay() {
  Atom *a = lammps->atom;
  to_lammps(y.data());
  for (size_t i = 0; i < own(); i++) {
    std::copy(&direction[i * stride], &direction[i * stride] + stride,
              carried->row[i]);
    std::copy(&f1[i * stride], &f1[i * stride] + stride,
              carried->row[i] + ROW_SPIN);
  }
  lammps->domain->pbc();
  if (lammps->domain->box_change) {
    lammps->domain->reset_box();
    lammps->comm->setup();
    if (lammps->neighbor->style)
      lammps->neighbor->setup_bins();
  }
  lammps->comm->exchange();
  if (a->sortfreq > 0 && count.builds % 20 == 0)
    a->sort();
  lammps->comm->borders();
  lammps->neighbor->build(1);
  bigint here = a->nlocal, all;
  MPI_Allreduce(&here, &all, 1, MPI_LMP_BIGINT, MPI_SUM, MPI_COMM_WORLD);
  if (all != a->natoms)
    die(INTEGRATION, "t=" + std::to_string(t) + ": " +
                         std::to_string(a->natoms - all) + " of " +
                         std::to_string(a->natoms) + " spheres were lost");
  resize();
  from_lammps(y.data());
  for (size_t i = 0; i < own(); i++) {
    std::copy(carried->row[i], carried->row[i] + stride,
              &direction[i * stride]);
    std::copy(carried->row[i] + ROW_SPIN, carried->row[i] + ROW_SPIN + stride,
              &f1[i * stride]);
  }
  list();
}

/* Own rows, with those of the ghosts after them as LAMMPS has them. */
const double *Bed::fill(const double *from) {
  if (!ghosts)
    return from;
  const size_t n = own(), all = n + static_cast<size_t>(lammps->atom->nghost);
  std::copy(from, from + dim(), filled.begin());
  for (size_t i = n; i < all; i++)
    take_row(lammps->atom, i, stride, &filled[i * stride]);
  return filled.data();
}

/* Own rows, with those of the ghosts after them as they are by now. */
const double *Bed::with_ghosts(const double *from) {
  for (size_t i = 0; i < own(); i++) {
    double way[3];
    vec3_sub(from + i * stride + ROW_X, &near_reference[3 * i], way);
    furthest2 = std::max(furthest2, vec3_dot(way, way));
  }
  count.contacts += static_cast<double>(rows_contacts(rows));
  if (!ghosts)
    return from;
  to_lammps(from);
  lammps->comm->forward_comm();
  const size_t n = own(), more = static_cast<size_t>(lammps->atom->nghost);
  count.ghosts += static_cast<double>(more);
  std::copy(from, from + dim(), filled.begin());
  for (size_t i = n; i < n + more; i++)
    take_row(lammps->atom, i, stride, &filled[i * stride]);
  return filled.data();
}

/* A rate that is not finite makes the error of the step so, on all ranks. */
int Bed::rates(double, const double y[], double f[], void *params) {
  Bed *b = static_cast<Bed *>(params);
  b->count.evaluations++;
  rows_rates(b->rows, b->with_ghosts(y), f);
  return GSL_SUCCESS;
}

int Bed::stage(double, const double y[], const struct stage *s, double out[],
               void *params) {
  Bed *b = static_cast<Bed *>(params);
  b->count.evaluations++;
  rows_stage(b->rows, b->with_ghosts(y), s, out);
  return GSL_SUCCESS;
}

double Bed::total(double part, void *params) {
  static_cast<Bed *>(params)->count.sums++;
  MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return part;
}

/* Over all ranks; what is not a number is infinite, as MPI_MAX drops it. */
void Bed::largest(double values[], int n) {
  count.sums++;
  for (int k = 0; k < n; k++)
    if (std::isnan(values[k]))
      values[k] = INFINITY;
  MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
}

/* This rank's part of ahead. */
void Bed::look_ahead(double most[3]) const {
  std::fill(most, most + 3, 0);
  for (size_t i = 0; i < own(); i++) {
    const double *row = &y[i * stride];
    double way[3];
    most[0] = std::max(
        most[0], 1 / travel_time(vec3_norm(row + ROW_V),
                                 vec3_norm(&f1[i * stride] + ROW_V), cap));
    vec3_sub(row + ROW_X, &reference[3 * i], way);
    most[1] = std::max(most[1], vec3_norm(way));
    vec3_sub(row + ROW_X, &near_reference[3 * i], way);
    most[2] = std::max(most[2], vec3_norm(way));
  }
}

rkc_problem Bed::problem() {
  rkc_problem p = {};
  p.dim = dim();
  p.rates = rates;
  p.stage = stage;
  p.params = this;
  p.weight = weight.data();
  p.total = total;
  p.threads = 1;
  return p;
}

/* Whether a stage went further than the list holds: contacts may lack there, so
   that the error means nothing. way: the furthest (m); next: the step to try.
 */
bool Bed::runs_away(double way, double h, double *next) {
  if (way <= near / 2)
    return false;
  if (2 * way <= skin - 2 * apart) {
    *next = h;
    with_ghosts(start.data());
    list_near(start.data(), 3 * way);
  } else {
    *next = h / 10;
    step.power.known = false;
  }
  return true;
}

/* A step of length h; if it is not good enough y is what it was. next: the
   length to go on with. */
bool Bed::attempt(double h, double *next) {
  const rkc_problem p = problem();
  furthest2 = 0;
  *next = h;
  if (rkc_step_try(&step, &p, t, h, y.data(), error.data(), f0.data(),
                   f1.data(), work.data()) != GSL_SUCCESS) {
    *next = h / 2;
    return false;
  }
  double worst[6] = {0, furthest2}; /* one reduction for all */
  look_ahead(worst + 2);
  worst[5] = wish();
  for (size_t i = 0; i < p.dim; i++) {
    const double e = std::fabs(error[i]) * weight[i] / set.tol;
    if (!(e <= worst[0]) && !std::isnan(worst[0]))
      worst[0] = e;
  }
  largest(worst, 6);
  if (runs_away(std::sqrt(worst[1]), h, next))
    return false;
  if (!predictive_accepts(&control, worst[0], 2, next))
    return false;
  std::copy(worst + 2, worst + 5, ahead);
  wished = worst[5];
  return true;
}

double Bed::wish() const {
  if (asked_to_end)
    return END;
  return rank == 0 && keep.every > 0 && MPI_Wtime() - keep.last >= keep.every
             ? SAVE
             : GO_ON;
}

/* Once a second, on a terminal. */
void Bed::show(double h) {
  const double now = MPI_Wtime(),
               share = (t - set.start) / (set.end - set.start);
  if (keep.quiet || rank || now - keep.progress < 1)
    return;
  keep.progress = now;
  shown = true;
  fprintf(stderr,
          "\r%3.0f %%  t=%.4g s  h=%.2g s  %zu evaluations  %.0f s left\033[K",
          100 * share, t, h, count.evaluations,
          (now - keep.begun) * (1 - share) / share);
}

std::string Bed::interrupted() const {
  char text[64];
  snprintf(text, sizeof text, "interrupted at t=%.6g", t);
  return text;
}

bool Bed::integrate() {
  double next = set.hinit;
  rates(t, y.data(), f1.data(), this);
  look_ahead(ahead);
  largest(ahead, 3);
  while (t < set.end) {
    double h = std::min(next, 1 / ahead[0]), done;
    if (ahead[1] + 1.5 * cap > skin / 2)
      relay();
    /* the way that the fastest sphere may go */
    const double way = 1.5 * cap * h * ahead[0];
    const double wanted = 2 * NEAR_SERVES * way;
    if (near < 0 || ahead[2] + way > near / 2 || near > 2 * wanted)
      list_near(y.data(), wanted);
    std::copy(y.begin(), y.end(), start.begin());
    std::copy(f1.begin(), f1.end(), f0.begin());
    for (;;) {
      done = std::min(h, set.end - t);
      if (attempt(done, &h))
        break;
      std::copy(start.begin(), start.end(), y.begin());
      count.rejected++;
      if (!(h > 1e-14 * std::max(1., std::fabs(t))))
        die(INTEGRATION,
            "t=" + std::to_string(t) + ": no step is short enough");
    }
    count.accepted++;
    if (done < set.end - t) {
      t += done;
      next = h;
    } else
      t = set.end;
    show(done);
    if (wished == END)
      break;
    if (wished == SAVE && t < set.end)
      save(interrupted());
  }
  clear_line();
  return t == set.end;
}

/* The bed so far, at once under its name; the run may go on. */
void Bed::save(const std::string &status) {
  const std::string beside = keep.output + ".partial";
  FILE *out = stdout;
  int written = 1;
  if (rank == 0 && !keep.output.empty())
    out = fopen(beside.c_str(), "w");
  to_lammps(y.data());
  lammps->domain->pbc(); /* as settle writes its places */
  if (rank == 0 && !out)
    written = 0;
  MPI_Bcast(&written, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (written)
    gather(out, status);
  if (rank == 0 && written) {
    written = fflush(out) == 0 && !ferror(out);
    if (!keep.output.empty())
      written = fclose(out) == 0 && written &&
                rename(beside.c_str(), keep.output.c_str()) == 0;
  }
  MPI_Bcast(&written, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (!written) {
    if (rank == 0 && !keep.output.empty())
      remove(beside.c_str());
    die(IO, (keep.output.empty() ? "standard output" : keep.output) +
                ": it could not be written");
  }
  keep.last = MPI_Wtime();
}

/* One number of width columns for each sphere of all ranks, at the root, by the
   first column. */
std::vector<double> Bed::gathered(size_t width,
                                  const std::vector<double> &mine) {
  std::vector<int> size(static_cast<size_t>(lammps->comm->nprocs)),
      at(size.size());
  const int here = static_cast<int>(mine.size());
  MPI_Gather(&here, 1, MPI_INT, size.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  int all = 0;
  for (size_t k = 0; k < size.size(); k++) {
    at[k] = all;
    all += size[k];
  }
  std::vector<double> rows_of(rank ? 0 : static_cast<size_t>(all)), sorted;
  MPI_Gatherv(mine.data(), here, MPI_DOUBLE, rows_of.data(), size.data(),
              at.data(), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  std::vector<size_t> order(rows_of.size() / width);
  for (size_t k = 0; k < order.size(); k++)
    order[k] = k;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return rows_of[a * width] < rows_of[b * width];
  });
  for (size_t k : order)
    sorted.insert(sorted.end(), &rows_of[k * width],
                  &rows_of[k * width] + width);
  return sorted;
}

/* The bed: the keys of start.tsv with the time that was reached. */
void Bed::gather(FILE *out, const std::string &status) {
  const Atom *a = lammps->atom;
  std::vector<double> mine;
  for (int i = 0; i < a->nlocal; i++) {
    mine.push_back(static_cast<double>(a->tag[i]) - set.id_offset);
    mine.insert(mine.end(), a->x[i], a->x[i] + 3);
    mine.push_back(a->radius[i]);
    mine.push_back(a->rmass[i]);
    mine.insert(mine.end(), a->v[i], a->v[i] + 3);
    mine.insert(mine.end(), a->omega[i], a->omega[i] + 3);
    mine.push_back(a->type[i] == FIXED);
  }
  const std::vector<double> all = gathered(WIDTH, mine);
  if (rank)
    return;
  std::ifstream head("start.tsv");
  std::string line;
  struct sheet sheet = sheet_begin(out);
  while (std::getline(head, line) && line[0] == '#') {
    if (line.compare(0, 11, "# checksum=") == 0)
      continue;
    if (line.compare(0, 4, "# t=") == 0) {
      sheet_end(&sheet);
      sheet = sheet_begin(out);
      sheet_text(&sheet, "# t");
      sheet_numbers(&sheet, '=', 1, &t);
    } else
      sheet_text(&sheet, line.c_str());
    sheet_text(&sheet, "\n");
  }
  sheet_text(&sheet, (line + '\n').c_str()); /* columns */
  const bool spin = line.find("wx") != std::string::npos;
  const bool fixed = line.find("fixed") != std::string::npos;
  for (size_t k = 0; k < all.size(); k += WIDTH) {
    char id[32];
    snprintf(id, sizeof id, "%.0f", all[k]);
    sheet_text(&sheet, id);
    sheet_numbers(&sheet, '\t', spin ? WIDTH - 2 : WIDTH - 5, &all[k + 1]);
    if (fixed)
      sheet_numbers(&sheet, '\t', 1, &all[k + WIDTH - 1]);
    sheet_text(&sheet, "\n");
  }
  sheet_end(&sheet);
  fprintf(out, "# status=%s\n", status.c_str());
}

/* id and rates of each sphere, for tests: by the kernel, or by the pair style
   and the fixes. */
void Bed::rates_at_start(const char *path, bool by_lammps) {
  const Atom *a = lammps->atom;
  const size_t width = stride + 1;
  rates(t, y.data(), f1.data(), this);
  std::vector<double> mine;
  for (size_t i = 0; i < own(); i++) {
    const double m = a->rmass[i], r = a->radius[i];
    mine.push_back(static_cast<double>(a->tag[i]) - set.id_offset);
    for (size_t c = 0; c < stride; c++)
      mine.push_back(!by_lammps || c < ROW_V || a->type[i] == FIXED
                         ? f1[i * stride + c]
                     : c < ROW_W ? a->f[i][c - ROW_V] / m
                                 : a->torque[i][c - ROW_W] / (0.4 * m * r * r));
  }
  const std::vector<double> all = gathered(width, mine);
  if (rank)
    return;
  FILE *out = fopen(path, "w");
  if (!out)
    return;
  for (size_t k = 0; k < all.size(); k += width) {
    numbers_write(out, '\t', width, &all[k]);
    fputc('\n', out);
  }
  fclose(out);
}

void Bed::write_stats(const char *path, double wall_seconds,
                      double cpu_seconds) {
  double ghosts = count.ghosts / static_cast<double>(count.evaluations), most;
  MPI_Reduce(&ghosts, &most, 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  const double contacts = total(count.contacts, this);
  if (rank)
    return;
  /* each rank exchanges with its neighbours in x, then in y */
  const int *grid = lammps->comm->procgrid;
  const int *around = lammps->domain->periodicity;
  int messages = 0;
  for (int k = 0; k < 3; k++)
    messages += grid[k] > 1 ? (grid[k] > 2 || around[k] ? 2 : 1) : 0;
  FILE *out = fopen(path, "w");
  if (!out)
    die(IO, std::string(path) + ": cannot be written");
  fprintf(out, "method\trkc\nranks\t%d\nspheres\t%ld\nt_end\t",
          lammps->comm->nprocs, static_cast<long>(lammps->atom->natoms));
  numbers_write(out, '\t', 1, &t);
  fprintf(out,
          "\nrhs_evaluations\t%zu\npower_evaluations\t%zu\n"
          "steps_accepted\t%zu\nsteps_rejected\t%zu\npair_list_builds\t%zu\n"
          "near_list_builds\t%zu\ncontact_evaluations\t%.0f\n"
          "reductions\t%zu\nmost_ghosts\t%.0f\n"
          "messages_per_evaluation\t%d\nbytes_per_evaluation\t%.0f\n"
          "wall_seconds\t%g\ncpu_seconds\t%g\n",
          count.evaluations, step.report.power_evaluations, count.accepted,
          count.rejected, count.builds, count.near_builds, contacts, count.sums,
          most, messages, most * ROW_SPIN * sizeof(double), wall_seconds,
          cpu_seconds);
  fclose(out);
}

static const char help[] =
    "Usage: [mpirun -np N] settle-lammps [OPTION...] FOLDER > bed.tsv\n"
    "Settles the bed that settle --export-lammps FOLDER has written, on N\n"
    "ranks, by Runge-Kutta-Chebyshev with LAMMPS for everything else.\n"
    "\n"
    "Options:\n"
    "  --time X           end of the run, s; else that of settle\n"
    "  --tol X            tolerance, m/s; else that of settle\n"
    "  --output NAME      file for the bed, instead of standard output\n"
    "  --every X          write the bed so far there every X s of the clock\n"
    "  --stats NAME       file for the solver's statistics; CPU time of a "
    "rank\n"
    "  --quiet            no progress on a terminal\n"
    "  --script NAME      run this input of LAMMPS in the folder instead, "
    "such\n"
    "                     as in.run, the same bed by a fixed step\n"
    "  --rates NAME       write the rates at the start instead\n"
    "  --lammps           the rates by the pair style, not by the kernel\n"
    "  -h, --help         this text\n"
    "  --version          name and version\n"
    "\n"
    "Exit status: 0 done, 1 input, output or LAMMPS failed, 2 a mistake in the "
    "use,\n  3 bad input, 4 the integration failed, 5 interrupted: by SIGINT, "
    "SIGTERM\n"
    "  or SIGUSR1, which mpirun hands on; the bed is that of this time then.\n";

struct options {
  double time = NAN, tol = NAN;
  double every = 0;
  std::string folder, script, rates, stats, output;
  bool lammps = false, quiet = false;
};

static double positive(const std::string &name, const std::string &word) {
  double x;
  if (!number_parse(word.c_str(), &x) || !(x > 0))
    die(USAGE, name + " " + word + ": expected a number above 0");
  return x;
}

static options parse(int argc, char **argv) {
  options o;
  for (int k = 1; k < argc; k++) {
    std::string word = argv[k], value;
    const size_t equals = word.find('=');
    if (word == "--help" || word == "-h" || word == "--version") {
      if (rank == 0)
        fputs(word == "--version" ? "settle-lammps " DEM_VERSION "\n" : help,
              stdout);
      const bool written = fflush(stdout) == 0;
      finished = true;
      MPI_Finalize();
      exit(written ? DONE : IO);
    }
    if (word[0] != '-') {
      if (!o.folder.empty())
        die(USAGE, "'" + word + "': expected one folder");
      o.folder = word;
      continue;
    }
    if (word == "--lammps" || word == "--quiet") {
      (word == "--lammps" ? o.lammps : o.quiet) = true;
      continue;
    }
    if (equals != std::string::npos) {
      value = word.substr(equals + 1);
      word = word.substr(0, equals);
    } else if (++k < argc)
      value = argv[k];
    else
      die(USAGE, word + ": expected a value, or it is no option");
    if (word == "--time")
      o.time = positive(word, value);
    else if (word == "--tol")
      o.tol = positive(word, value);
    else if (word == "--every")
      o.every = positive(word, value);
    else if (word == "--output")
      o.output = value;
    else if (word == "--stats")
      o.stats = value;
    else if (word == "--script")
      o.script = value;
    else if (word == "--rates")
      o.rates = value;
    else
      die(USAGE, word + ": no such option (try 'settle-lammps --help')");
  }
  if (o.folder.empty())
    die(USAGE, "expected a folder by settle --export-lammps (try "
               "'settle-lammps --help')");
  if (o.every > 0 && o.output.empty())
    die(USAGE, "--every: expected --output beside it");
  char *here = getcwd(nullptr, 0);
  for (std::string *path :
       {&o.stats, &o.rates, &o.output}) /* LAMMPS works in the folder */
    if (!path->empty() && (*path)[0] != '/')
      *path = std::string(here) + "/" + *path;
  free(here);
  return o;
}

/* What settle has left in in.scene for us. */
static plan plan_of(LAMMPS *lammps, const options &o) {
  char name[] = "dem_run";
  const char *text = lammps->input->variable->find(name) < 0
                         ? nullptr
                         : lammps->input->variable->retrieve(name);
  plan p;
  if (!text || sscanf(text, "%lg %lg %lg %lg %lg %lg %lg %lg %lg", &p.start,
                      &p.end, &p.tol, &p.hinit, &p.travel, &p.gravity[0],
                      &p.gravity[1], &p.gravity[2], &p.id_offset) != 9)
    die(INPUT, o.folder +
                   "/in.scene: expected the variable dem_run that settle "
                   "--export-lammps writes");
  if (!std::isnan(o.time))
    p.end = o.time;
  if (!std::isnan(o.tol))
    p.tol = o.tol;
  if (p.end < p.start)
    die(USAGE, "--time: the start is later");
  return p;
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const options o = parse(argc, argv);
  if (chdir(o.folder.c_str()) != 0 || access("in.scene", R_OK) != 0)
    die(INPUT, o.folder + ": no folder with in.scene, as settle "
                          "--export-lammps writes it");
  atexit(ended_by_lammps);
  std::set_new_handler(no_memory);
  char words[][16] = {"settle-lammps", "-log", "log.lammps",
                      "-screen",       "none", "-nocite"};
  char *arguments[] = {words[0], words[1], words[2],
                       words[3], words[4], words[5]};
  LAMMPS *lammps = new LAMMPS(6, arguments, MPI_COMM_WORLD);
  if (rank)
    lammps->screen = said = tmpfile();
  styles_add(lammps);
  lammps->input->file(o.script.empty() ? "in.scene" : o.script.c_str());
  if (o.script.empty()) {
    const plan p = plan_of(lammps, o);
    const double begun = MPI_Wtime();
    Bed bed(lammps, p,
            {o.output, o.every, begun, begun, begun, o.quiet || !isatty(2)});
    if (!o.rates.empty())
      bed.rates_at_start(o.rates.c_str(), o.lammps);
    else {
      for (int number : {SIGINT, SIGTERM, SIGUSR1})
        signal(number, end_soon);
      const clock_t worked = clock();
      const bool reached = bed.integrate();
      const double wall = MPI_Wtime() - begun;
      const double cpu = static_cast<double>(clock() - worked) / CLOCKS_PER_SEC;
      bed.save(reached ? "ok" : bed.interrupted());
      if (!o.stats.empty())
        bed.write_stats(o.stats.c_str(), wall, cpu);
      if (!reached)
        die(LIMIT, bed.interrupted());
    }
  }
  delete lammps;
  finished = true;
  MPI_Finalize();
  if (fflush(stdout) != 0 || ferror(stdout)) {
    fprintf(stderr,
            "settle-lammps: standard output: it could not be written\n");
    return IO;
  }
  return DONE;
}
