/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the system tells of a process that does known things. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
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
  test_program(argv[0]);
  return check_done();
}
