/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests' one harness. A failed check prints where and what and the program
   goes on; check_done() prints the line "N passed, N failed" and gives the
   exit status. NaN never passes. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static size_t check_passed, check_failed;

static inline int check_report(bool ok, const char *file, int line,
                               const char *what) {
  if (ok)
    check_passed++;
  else {
    check_failed++;
    fprintf(stderr, "%s:%d: failed: %s\n", file, line, what);
  }
  return ok;
}

static inline int check_close(double got, double want, double tol,
                              const char *file, int line, const char *what) {
  const bool ok = fabs(got - want) <= tol;
  if (!check_report(ok, file, line, what))
    fprintf(stderr, "  got %.17g, want %.17g, |difference| %.3g > %.3g\n", got,
            want, fabs(got - want), tol);
  return ok;
}

#define CHECK(condition)                                                       \
  check_report((condition), __FILE__, __LINE__, #condition)
/* |got - want| <= tol */
#define CHECK_CLOSE(got, want, tol)                                            \
  check_close((got), (want), (tol), __FILE__, __LINE__,                        \
              #got " ~ " #want " within " #tol)
/* |got - want| <= tol |want| */
#define CHECK_REL(got, want, tol)                                              \
  check_close((got), (want), (tol)*fabs(want), __FILE__, __LINE__,             \
              #got " ~ " #want " within " #tol " relative")

static inline int check_done(void) {
  printf("%zu passed, %zu failed\n", check_passed, check_failed);
  return check_failed ? 1 : 0;
}

#endif
