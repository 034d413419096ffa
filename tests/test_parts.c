/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Connected parts of grids: against a flood of the whole grid, and shapes whose
   parts are known. */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include "check.h"
#include "geometry/parts.h"

static size_t flood(const size_t n[3], const bool around[3], const bool *solid,
                    bool kind) {
  const size_t all = n[0] * n[1] * n[2];
  bool *seen = calloc(all, sizeof *seen);
  size_t *stack = calloc(all, sizeof *stack), parts = 0;
  for (size_t start = 0; start < all; start++) {
    if (seen[start] || solid[start] != kind)
      continue;
    size_t count = 0;
    stack[count++] = start;
    seen[start] = true;
    parts++;
    while (count) {
      const size_t q = stack[--count];
      const size_t at[3] = {q % n[0], q / n[0] % n[1], q / n[0] / n[1]};
      const size_t step[3] = {1, n[0], n[0] * n[1]};
      for (int k = 0; k < 6; k++) {
        const int axis = k / 2;
        const bool last = k % 2 ? at[axis] + 1 == n[axis] : at[axis] == 0;
        if (last && !around[axis])
          continue;
        const size_t way = step[axis] * (last ? n[axis] - 1 : 1);
        const size_t next = (k % 2 != last) ? q + way : q - way;
        if (!seen[next] && solid[next] == kind) {
          seen[next] = true;
          stack[count++] = next;
        }
      }
    }
  }
  free(stack);
  free(seen);
  return parts;
}

static void grid(const size_t n[3], const bool around[3], const bool *solid,
                 size_t count[2]) {
  struct parts *p = NULL;
  CHECK(parts_open(&p, n[0], n[1], around) == GSL_SUCCESS);
  for (size_t row = 0; row < n[1] * n[2]; row++)
    CHECK(parts_row(p, solid + row * n[0]) == GSL_SUCCESS);
  parts_count(p, count);
  parts_close(p);
}

int main(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  size_t most = 0;
  static const bool open[3];
  for (int m = 0; m < 600; m++) {
    const bool around[3] = {m >> 0 & 1, m >> 1 & 1, m >> 2 & 1};
    const size_t n[3] = {1 + gsl_rng_uniform_int(rng, 12),
                         1 + gsl_rng_uniform_int(rng, 12),
                         1 + gsl_rng_uniform_int(rng, 12)};
    const double share = gsl_rng_uniform(rng);
    bool solid[12 * 12 * 12];
    for (size_t q = 0; q < n[0] * n[1] * n[2]; q++)
      solid[q] = gsl_rng_uniform(rng) < share;
    size_t count[2];
    grid(n, around, solid, count);
    CHECK(count[true] == flood(n, around, solid, true));
    CHECK(count[false] == flood(n, around, solid, false));
    most = count[true] > most ? count[true] : most;
  }
  CHECK(most > 100);
  /* a spiral in the plane x = 0 of one solid and one empty part, which joins
     only at its end */
  static const char spiral[] = "1111111"
                               "0000001"
                               "1111101"
                               "1000101"
                               "1011101"
                               "1000001"
                               "1111111";
  bool cells[49];
  for (int q = 0; q < 49; q++)
    cells[q] = spiral[q] == '1';
  const size_t flat[3][3] = {{7, 7, 1}, {7, 1, 7}, {1, 7, 7}};
  for (int k = 0; k < 3; k++) {
    size_t count[2];
    grid(flat[k], open, cells, count);
    CHECK(count[true] == 1 && count[false] == 1);
  }
  gsl_rng_free(rng);
  return check_done();
}
