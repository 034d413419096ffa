/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What no bed is: spheres put outside of walls and into each other by known
   amounts. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "model/bed_check.h"

enum { N = 30 };

/* A row of spheres that touch, in a box around them. */
static void make(struct scene *s, struct bed *b) {
  *s = scene_default();
  CHECK(scene_add_box(s, 0.2 * N, 1) == GSL_SUCCESS);
  CHECK(bed_alloc(b, N) == GSL_SUCCESS);
  for (size_t i = 0; i < N; i++) {
    b->r[i] = 0.1;
    b->x[3 * i] = 0.2 * (double)i + 0.1;
    b->x[3 * i + 1] = 0.5;
    b->x[3 * i + 2] = 0.1;
  }
}

static void test_outsiders(void) {
  struct scene s;
  struct bed b;
  make(&s, &b);
  CHECK(bed_find_outsiders(&s, &b).count == 0);
  b.x[3 * 4 + 2] = 1e-300; /* in, if only just */
  CHECK(bed_find_outsiders(&s, &b).count == 0);
  b.x[3 * 4 + 2] = 0; /* a centre on a wall is not inside */
  struct bed_outsiders o = bed_find_outsiders(&s, &b);
  CHECK(o.count == 1 && o.sphere == 4 && o.wall == 0 && o.distance == 0);
  b.x[3 * 7 + 1] = -0.5; /* wall 4 (from 1) is y = 0 */
  b.x[3 * 7 + 2] = -0.25;
  o = bed_find_outsiders(&s, &b);
  CHECK(o.count == 2 && o.sphere == 7 && o.wall == 3 && o.distance == -0.5);
  b.x[3 * 9 + 1] = 1.625; /* y = 1: the furthest */
  o = bed_find_outsiders(&s, &b);
  CHECK(o.count == 3 && o.sphere == 9 && o.wall == 4 && o.distance == -0.625);
  b.x[3 * 2] = GSL_NAN;
  b.x[3 * 29 + 2] = -GSL_DBL_MAX;
  o = bed_find_outsiders(&s, &b);
  CHECK(o.count == 5 && o.sphere == 2 && isnan(o.distance));
  scene_free(&s); /* without walls everywhere is inside */
  CHECK(bed_find_outsiders(&s, &b).count == 0);
  bed_free(&b);
}

static void test_crowd(void) {
  struct scene s;
  struct bed b;
  struct bed_crowd c = {.pairs = 99};
  make(&s, &b);
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 0);
  b.x[3 * 10] = b.x[3 * 11] - 0.0801; /* 0.4 of 0.2 is 0.08 */
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 0);
  b.x[3 * 10] = b.x[3 * 11] - 0.0799;
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 1);
  CHECK(c.i == 10 && c.j == 11);
  CHECK_REL(c.distance, 0.0799, 1e-12);
  CHECK_REL(c.expected, 0.08, 1e-12);
  /* closer, but not by the radii: 0.03 of 0.06 */
  b.r[20] = b.r[21] = 0.03;
  b.x[3 * 20] = b.x[3 * 21] - 0.03;
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 1 &&
        c.i == 10);
  b.x[3 * 20] = b.x[3 * 21] - 0.003;
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 2);
  CHECK(c.i == 20 && c.j == 21);
  CHECK_REL(c.expected, 0.024, 1e-12);
  /* of two that are as close the first, to the last bit */
  b.r[24] = b.r[25] = b.r[26] = b.r[27] = 0.125;
  b.x[3 * 24] = 32;
  b.x[3 * 25] = b.x[3 * 24] + 0x1p-9;
  b.x[3 * 26] = 64;
  b.x[3 * 27] = b.x[3 * 26] + 0x1p-9;
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_SUCCESS && c.pairs == 4);
  CHECK(c.i == 24 && c.j == 25 && c.distance == 0x1p-9);
  b.x[3 * 3] = GSL_NAN;
  c.pairs = 99;
  CHECK(bed_find_crowd((double[3]){0}, &b, &c) == GSL_EINVAL && c.pairs == 99);
  bed_free(&b);
  scene_free(&s);
}

int main(void) {
  gsl_set_error_handler_off();
  test_outsiders();
  test_crowd();
  return check_done();
}
