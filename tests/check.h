/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests' one harness. A failed check prints where and what and the program
   goes on; check_done() prints how many sites (places in the source) checked
   something, then the line "N passed, N failed", and gives the exit status. NaN
   never passes. With CHECK_FIRST in the environment one failure ends it. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t check_passed, check_failed, check_sites;

/* Counts a site the first time that it checks something. */
static inline void check_site(const char *file, int line) {
  enum { MOST = 4096 };
  static struct {
    const char *file;
    int line;
  } seen[MOST];
  size_t at = (size_t)line % MOST;
  for (; seen[at].file; at = (at + 1) % MOST)
    if (seen[at].line == line && !strcmp(seen[at].file, file))
      return;
  if (check_sites + 1 == MOST) /* the last place ends the search */
    abort();
  seen[at].file = file;
  seen[at].line = line;
  check_sites++;
}

static inline int check_report(bool ok, const char *file, int line,
                               const char *what) {
  check_site(file, line);
  if (ok)
    check_passed++;
  else {
    check_failed++;
    fprintf(stderr, "%s:%d: failed: %s\n", file, line, what);
    if (getenv("CHECK_FIRST"))
      exit(1);
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
  printf("%zu sites\n%zu passed, %zu failed\n", check_sites, check_passed,
         check_failed);
  return check_failed ? 1 : 0;
}

#endif
