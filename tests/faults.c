/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls that fail, for tests/torture.sh, which has a program load this before
   the C library: FAULT=CALL:N lets the N-th call of that name fail, as on a
   full or broken disk or without memory, and FAULT_DONE names a file that is
   made then. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool fails(const char *call) {
  static long left = -1;
  const char *fault = getenv("FAULT"), *done = getenv("FAULT_DONE");
  const size_t length = strlen(call);
  if (!fault || strncmp(fault, call, length) || fault[length] != ':')
    return false;
  if (left < 0)
    left = atol(fault + length + 1);
  if (left == 0 || __atomic_sub_fetch(&left, 1, __ATOMIC_SEQ_CST) != 0)
    return false;
  if (done)
    close(open(done, O_WRONLY | O_CREAT, 0666));
  return true;
}

#define REAL(type, name, ...)                                                  \
  static type (*real)(__VA_ARGS__);                                            \
  if (!real)                                                                   \
  *(void **)&real = dlsym(RTLD_NEXT, name)

int fsync(int fd) {
  REAL(int, "fsync", int);
  if (!fails("fsync"))
    return real(fd);
  errno = EIO;
  return -1;
}

int rename(const char *from, const char *to) {
  REAL(int, "rename", const char *, const char *);
  if (!fails("rename"))
    return real(from, to);
  errno = EIO;
  return -1;
}

int link(const char *from, const char *to) {
  REAL(int, "link", const char *, const char *);
  if (!fails("link"))
    return real(from, to);
  errno = EPERM; /* as where there are no hard links */
  return -1;
}

int fclose(FILE *stream) {
  REAL(int, "fclose", FILE *);
  const int status = real(stream);
  if (!fails("close"))
    return status;
  errno = EIO;
  return EOF;
}

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size) {
  if (!fails("malloc"))
    return __libc_malloc(size);
  errno = ENOMEM;
  return NULL;
}

void *calloc(size_t count, size_t size) {
  if (!fails("malloc"))
    return __libc_calloc(count, size);
  errno = ENOMEM;
  return NULL;
}

void *realloc(void *old, size_t size) {
  if (!fails("malloc"))
    return __libc_realloc(old, size);
  errno = ENOMEM;
  return NULL;
}
