/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the system tells of a process that does known things. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include "check.h"
#include "platform/system.h"

static void test_threads(void) {
  const long online = sysconf(_SC_NPROCESSORS_ONLN);
#ifdef _OPENMP
  CHECK(system_threads(3) == 3);
  /* no more than there are; fewer where the process may not use all */
  CHECK(system_threads(0) >= 1 && (long)system_threads(0) <= online);
#else
  CHECK(system_threads(3) == 1);
  CHECK(system_threads(0) == 1);
  CHECK(online >= 1);
#endif
}

/* 64 MB that are written to are in the peak, in kB: neither bytes nor pages.
   What there was before may be of the shell that became this program. */
static void test_memory(void) {
  const size_t size = (size_t)64 << 20;
  const long before = system_peak_memory();
  volatile char *block = malloc(size);
  CHECK(block != NULL);
  if (!block)
    return;
  for (size_t k = 0; k < size; k += 512)
    block[k] = 1;
  const long after = system_peak_memory();
  CHECK(before > 0 && before < 60 << 10);
  CHECK(after > 64 << 10 && after < before + (80 << 10));
  free((void *)block);
}

/* The least limit counts, and says which it is. */
static void test_limits(void) {
  struct rlimit all, own = {0};
  const struct system_memory m = system_memory();
  const double machine =
      (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
  CHECK(getrlimit(RLIMIT_AS, &all) == 0);
  CHECK(m.most > 1e6 && m.by);
  if (!strcmp(m.by, "the machine")) /* with its swap */
    CHECK(m.most >= machine && m.unused <= machine);
  own = all;
  own.rlim_cur = 100000000;
  if (CHECK(setrlimit(RLIMIT_AS, &own) == 0)) {
    const struct system_memory less = system_memory();
    CHECK(less.most == 1e8 && !strcmp(less.by, "ulimit -v"));
    CHECK(setrlimit(RLIMIT_AS, &all) == 0);
  }
  CHECK(system_memory().most == m.most);
}

/* What a file may grow by: less by what it has. */
static void test_room(void) {
  FILE *file = tmpfile();
  struct rlimit all, own;
  if (!CHECK(file != NULL))
    return;
  CHECK(system_room(fileno(file)).bytes > 0);
  CHECK(getrlimit(RLIMIT_FSIZE, &all) == 0);
  own = all;
  own.rlim_cur = 3000;
  CHECK(setrlimit(RLIMIT_FSIZE, &own) == 0);
  fputs("1234567890", file);
  fflush(file);
  const struct system_room room = system_room(fileno(file));
  CHECK(room.bytes == 2990 && !strcmp(room.by, "ulimit -f"));
  CHECK(setrlimit(RLIMIT_FSIZE, &all) == 0);
  CHECK(system_room(fileno(file)).bytes > 2990);
  fclose(file);
}

static void test_program(const char *name) {
  char path[4096], small[4];
  struct stat told, real;
  CHECK(system_program(path, sizeof path));
  CHECK(path[0] == '/' && stat(path, &told) == 0 && stat(name, &real) == 0 &&
        told.st_ino == real.st_ino && told.st_dev == real.st_dev);
  CHECK(!system_program(small, sizeof small)); /* does not fit */
}

int main(int argc, char **argv) {
  (void)argc;
  test_threads();
  test_memory();
  test_limits();
  test_room();
  test_program(argv[0]);
  return check_done();
}
