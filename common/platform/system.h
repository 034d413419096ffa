/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facts that each operating system and compiler's runtime tells in a way of its
   own. Safe from any thread. Tested in tests/test_platform.c. */
#ifndef SYSTEM_H
#define SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

/* The number of threads for a wish: itself, all cores for 0; 1 where the
   programs were built without OpenMP. */
size_t system_threads(size_t wanted);

/* The number of the calling thread among those that share a loop, from 0. */
size_t system_thread(void);

/* The most memory that this process has had (kB), or -1 where the system does
   not tell. */
long system_peak_memory(void);

/* What the system lets this process have of memory (bytes), and what says so:
   the least of ulimit -v, of the control groups that it is in, and of what the
   machine has with its swap; and how much of it nobody uses now. Infinite where
   the system does not tell. */
struct system_memory {
  double most, unused;
  const char *by;
};
struct system_memory system_memory(void);

/* How much an open file may grow (bytes), and what says so: its file system or
   ulimit -f; infinite where the system does not tell. */
struct system_room {
  double bytes;
  const char *by;
};
struct system_room system_room(int fd);

/* Compiler, C library and GSL of this program, in one line. Other ones may
 * round otherwise. */
enum { SYSTEM_BUILD_SIZE = 256 };
void system_build(char text[SYSTEM_BUILD_SIZE]);

/* The path of the running program's file, without links. False where the
   system does not tell or it does not fit. */
bool system_program(char *path, size_t size);

#endif
