/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Right-hand side of the equations of motion (2.13)-(2.15) as a gsl_odeiv2
   system.

   The state vector has one row per sphere (row.h): 6n or 9n unknowns; those of
   obstacles (struct bed) have the rate zero. Beds of
   1024 spheres and more have their rows in the order of space. One
   struct dynamics serves one integration at a time; the evaluation itself is
   parallel with OpenMP and gives the same bits for any number of threads.
   Tested in tests/test_dynamics.c. */
#ifndef DYNAMICS_H
#define DYNAMICS_H

#include <stdbool.h>
#include <stddef.h>
#include "dynamics/row.h"
#include "dynamics/survey.h"
#include "model/bed.h"
#include "model/scene.h"
#include "platform/store.h"
#include "steppers/stage.h"

struct dynamics;

struct dynamics_options {
  bool all_pairs; /* visit every pair twice, as the paper does; a baseline */
  int threads;    /* at least 1 */
  /* Of the rows: the spheres, as dynamics_order had them; NULL: by places. */
  const size_t *order;
  const char *kernel; /* one of dynamics_kernels; NULL: the best here */
};

/* Names of kernels, by instruction set, and NULL: the same one rounds in the
   same way. */
extern const char *const *const dynamics_kernels;
/* The best of them here. Libraries round by it too, whatever kernel is taken.
 */
const char *dynamics_machine(void);

struct dynamics_counts {
  /* Of the right-hand side, where that of a part of the bed counts by its share
     of the contacts; of the pair list. */
  size_t evaluations, builds;
  size_t contacts;           /* in the list now: pairs and walls */
  double contacts_evaluated; /* so far; 0 for all pairs */
};

/* Prepares a scene and its spheres; keeps no pointer to either. GSL_EINVAL if
   there is no sphere that moves, more than 2^32 - 2 of them, or a radius or
   mass is not positive; GSL_EUNSUP for a kernel that this machine does not
   have; GSL_ENOMEM. Tested in tests/test_memory.c too. */
int dynamics_alloc(struct dynamics **out, const struct scene *s,
                   const struct bed *b, const struct dynamics_options *o);
void dynamics_free(struct dynamics *d);

size_t dynamics_stride(const struct dynamics *d);    /* a row's, row.h */
size_t dynamics_dimension(const struct dynamics *d); /* stride * n */
struct dynamics_counts dynamics_counts(const struct dynamics *d);
const char *dynamics_kernel(const struct dynamics *d); /* instruction set */

/* Between a bed and a state vector of dynamics_dimension doubles. unpack
   leaves the spins of a bed without rotation as they are, and obstacles. */
void dynamics_pack(const struct dynamics *d, const struct bed *b, double y[]);
void dynamics_unpack(const struct dynamics *d, const double y[], struct bed *b);

/* dydt = f(y), for gsl_odeiv2_system with params a struct dynamics. Returns
   GSL_SUCCESS, GSL_EBADFUNC where the result is not finite, GSL_ENOMEM. */
int dynamics_rhs(double t, const double y[], double dydt[], void *params);

/* The same within a stage of a method, in one pass over the memory. Not for all
   pairs. */
stage_function dynamics_stage;

/* df/dy, dense, row by row, dimension^2 doubles; dfdt is 0. Errors as above. */
int dynamics_jacobian(double t, const double y[], double *dfdy, double dfdt[],
                      void *params);

/* Longest step (s) in which no sphere moves further than travel (m), were it
   to keep the acceleration it has in dydt. GSL_POSINF where nothing moves. */
double dynamics_step_limit(const struct dynamics *d, const double y[],
                           const double dydt[], double travel);

/* Units of the errors of the unknowns, per m/s of tolerance: gaps in
   1/kappa for the speed that similar spheres have where the paper's have 1 m/s,
   velocities in m/s, spins in m/s of the surface. dimension doubles. */
void dynamics_scale(const struct dynamics *d, double scale[]);

/* Kinetic energy with that of spin, and potential energy of gravity (from the
   origin) and contacts, (J). The latter may rebuild the pair list. */
double dynamics_kinetic(const struct dynamics *d, const double y[]);
double dynamics_potential(struct dynamics *d, const double y[]);

/* Surveys the contacts of a state. May rebuild the pair list. GSL_SUCCESS, or
   an error as of dynamics_rhs. */
int dynamics_survey(struct dynamics *d, const double y[], struct survey *s);

/* The sphere in each row. */
const size_t *dynamics_order(const struct dynamics *d);

/* Its memory (platform/store.h), for dynamics of the same scene, spheres and
   order. */
void dynamics_store(struct dynamics *d, struct store *s);

/* Largest speed of any sphere's surface, |v| or r |w| (m/s). */
double dynamics_fastest(const struct dynamics *d, const double y[]);

#endif
