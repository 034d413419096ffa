/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "platform/system.h"

#include <limits.h> /* says which C library this is */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
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

static void limit(struct system_memory *m, double bytes, const char *by) {
  if (bytes < m->most) {
    m->most = bytes;
    m->by = by;
  }
}

#ifndef __APPLE__
/* The number behind a name in lines of "NAME: NUMBER kB", in bytes; infinite:
   there is none. */
static double kilobytes_of(const char *path, const char *name) {
  char line[256];
  double kilobytes = INFINITY;
  const size_t length = strlen(name);
  FILE *in = fopen(path, "r");
  if (!in)
    return kilobytes;
  while (fgets(line, sizeof line, in))
    if (!strncmp(line, name, length) && line[length] == ':')
      kilobytes = strtod(line + length + 1, NULL);
  fclose(in);
  return 1024 * kilobytes;
}

/* A number that is a file, "max" for none. */
static double number_of(const char *path) {
  char line[64], *end;
  FILE *in = fopen(path, "r");
  if (!in)
    return INFINITY;
  const bool read = fgets(line, sizeof line, in) != NULL;
  fclose(in);
  const double x = read ? strtod(line, &end) : 0;
  return read && end > line ? x : INFINITY;
}

/* Of the group at path below a root and of all above it. */
static void limit_by_group(struct system_memory *m, const char *root,
                           char *path, const char *file) {
  char name[4608];
  for (;;) {
    snprintf(name, sizeof name, "%s%s/%s", root, path, file);
    limit(m, number_of(name), "its control group");
    char *slash = strrchr(path, '/');
    if (!slash)
      return;
    *slash = 0;
  }
}

/* /proc/self/cgroup has a line NUMBER:NAMES:PATH for each hierarchy, without
   names for version 2. */
static void limit_by_groups(struct system_memory *m) {
  char line[4352];
  FILE *in = fopen("/proc/self/cgroup", "r");
  if (!in)
    return;
  while (fgets(line, sizeof line, in)) {
    line[strcspn(line, "\n")] = 0;
    char *names = strchr(line, ':');
    char *path = names ? strchr(names + 1, ':') : NULL;
    if (!path)
      continue;
    *path++ = 0;
    if (!names[1])
      limit_by_group(m, "/sys/fs/cgroup", path, "memory.max");
    else if (!strcmp(names + 1, "memory"))
      limit_by_group(m, "/sys/fs/cgroup/memory", path, "memory.limit_in_bytes");
  }
  fclose(in);
}
#endif

struct system_memory system_memory(void) {
  struct system_memory m = {INFINITY, INFINITY, NULL};
  struct rlimit r;
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
  double machine =
      pages > 0 && size > 0 ? (double)pages * (double)size : INFINITY;
#ifndef __APPLE__
  const char info[] = "/proc/meminfo";
  const double swap = kilobytes_of(info, "SwapTotal");
  machine += isfinite(swap) ? swap : 0;
  m.unused = kilobytes_of(info, "MemAvailable");
  limit_by_groups(&m);
#endif
  limit(&m, machine, "the machine");
  if (getrlimit(RLIMIT_AS, &r) == 0 && r.rlim_cur != RLIM_INFINITY)
    limit(&m, (double)r.rlim_cur, "ulimit -v");
  return m;
}

struct system_room system_room(int fd) {
  struct system_room room = {INFINITY, NULL};
  struct statvfs st;
  struct rlimit r;
  if (fstatvfs(fd, &st) == 0 && st.f_blocks > 0) {
    room.bytes = (double)st.f_bavail * (double)st.f_frsize;
    room.by = "its file system";
  }
  const off_t end = lseek(fd, 0, SEEK_CUR);
  if (end >= 0 && getrlimit(RLIMIT_FSIZE, &r) == 0 &&
      r.rlim_cur != RLIM_INFINITY &&
      (double)r.rlim_cur - (double)end < room.bytes) {
    room.bytes = fmax(0, (double)r.rlim_cur - (double)end);
    room.by = "ulimit -f";
  }
  return room;
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
