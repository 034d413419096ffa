/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "platform/system.h"

#include <limits.h> /* says which C library this is */
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>
#include <gsl/gsl_version.h>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#include <stdint.h>
#endif

size_t system_threads(size_t wanted) {
#ifdef _OPENMP
  return wanted ? wanted : (size_t)omp_get_num_procs();
#else
  (void)wanted;
  return 1;
#endif
}

size_t system_thread(void) {
#ifdef _OPENMP
  return (size_t)omp_get_thread_num();
#else
  return 0;
#endif
}

long system_peak_memory(void) {
  struct rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) != 0)
    return -1;
#ifdef __APPLE__
  return (long)(usage.ru_maxrss / 1024); /* bytes there, kB elsewhere */
#else
  return (long)usage.ru_maxrss;
#endif
}

void system_build(char text[SYSTEM_BUILD_SIZE]) {
#ifdef __clang__
  const char compiler[] = "clang " __clang_version__;
#elif defined __GNUC__
  const char compiler[] = "gcc " __VERSION__;
#else
  const char compiler[] = "another compiler";
#endif
#ifdef __GLIBC__
  const char *const library = gnu_get_libc_version();
#else
  const char *const library = "another";
#endif
  snprintf(text, SYSTEM_BUILD_SIZE, "%.100s, C library %.40s, GSL %.40s",
           compiler, library, gsl_version);
}

bool system_program(char *path, size_t size) {
#ifdef __APPLE__
  uint32_t room = (uint32_t)size;
  return _NSGetExecutablePath(path, &room) == 0;
#else
  /* Linux; the BSDs where /proc is mounted */
  static const char *const links[] = {"/proc/self/exe", "/proc/curproc/file"};
  for (size_t k = 0; k < sizeof links / sizeof *links; k++) {
    const ssize_t length = readlink(links[k], path, size);
    if (length > 0 && (size_t)length < size) {
      path[length] = 0;
      return true;
    }
  }
  return false;
#endif
}
