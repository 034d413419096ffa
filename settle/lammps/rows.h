/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The forces on the spheres of one rank by our kernel: rows of its own, then
   ghosts, which are spheres of other ranks that its own touch. Tested in
   tests/test_lammps.sh. */
#ifndef ROWS_H
#define ROWS_H

#include <stddef.h>
#include <stdint.h>
#include "dynamics/row.h"
#include "model/scene.h"
#include "steppers/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rows;

/* The scene is copied. equal: all radii are. GSL_SUCCESS, GSL_ENOMEM. */
int rows_alloc(struct rows **out, const struct scene *s, bool equal);
void rows_free(struct rows *r);

size_t rows_stride(const struct rows *r);

/* The spheres: count rows and ghosts after them, and pairs i < j by i, row i's
   from first[i] on (count + 1), of which rows_near takes some. Copied. Walls
   within skin beyond lmax are looked for; x: three numbers for each row. The
   rows in fixed, ascending, are obstacles: their rates are zero, and walls do
   not matter to them. GSL_SUCCESS, GSL_ENOMEM. */
struct rows_layout {
  size_t count, ghosts;
  const double *x, *radius, *mass;
  const uint32_t *i, *j;
  const size_t *first;
  const uint32_t *fixed;
  size_t fixed_count;
  double skin;
};
int rows_set(struct rows *r, const struct rows_layout *layout);

/* Of these pairs those within skin beyond lmax are computed from now on; y:
   rows and ghosts. */
void rows_near(struct rows *r, const double y[], double skin);

/* Pairs and walls that an evaluation computes. */
size_t rows_contacts(const struct rows *r);

/* Rates of y, rows and ghosts, into f; or with a stage its sum into out.
   GSL_SUCCESS, GSL_EBADFUNC where a rate is not finite. */
int rows_rates(const struct rows *r, const double y[], double f[]);
int rows_stage(const struct rows *r, const double y[],
               const struct stage *stage, double out[]);

/* 1 by the unit of each row's unknowns as dynamics_scale has it: weight and
   stride * count numbers. */
void rows_weights(const struct rows *r, double weight[]);

#ifdef __cplusplus
}
#endif

#endif
