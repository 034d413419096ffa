/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/files.h"

#include <stdbool.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "program/options.h"

/* Files begun and not committed go when the program does. */
static char *begun[8];

/* A folder that was made: no more than empty, it goes too. */
static const char *made;

static void remove_begun(void) {
  for (size_t i = 0; i < sizeof begun / sizeof *begun; i++)
    if (begun[i])
      unlink(begun[i]);
  if (made)
    rmdir(made);
}

static void remember(char *path) {
  static bool registered;
  if (!registered)
    atexit(remove_begun);
  registered = true;
  for (size_t i = 0; i < sizeof begun / sizeof *begun; i++)
    if (!begun[i]) {
      begun[i] = path;
      return;
    }
}

static void forget(const char *path) {
  for (size_t i = 0; i < sizeof begun / sizeof *begun; i++)
    if (begun[i] == path)
      begun[i] = NULL;
}

void output_open(struct output_file *f, const char *path) {
  struct stat st;
  *f = (struct output_file){.path = path};
  if (stat(path, &st) == 0 && !S_ISREG(st.st_mode)) {
    f->stream = fopen(path, "w");
  } else {
    const size_t size = strlen(path) + 32;
    f->partial = malloc(size);
    if (!f->partial)
      die(EXIT_IO, "out of memory");
    snprintf(f->partial, size, "%s.partial-%ld", path, (long)getpid());
    f->stream = fopen(f->partial, "w");
  }
  if (!f->stream)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  if (f->partial)
    remember(f->partial);
}

void output_commit(struct output_file *f) {
  const int failed = ferror(f->stream);
  const int closed = fclose(f->stream);
  int error = errno;
  if (!failed && closed == 0 &&
      (!f->partial || rename(f->partial, f->path) == 0)) {
    forget(f->partial);
    free(f->partial);
    free(f->joined);
    return;
  }
  if (!failed && closed == 0)
    error = errno;
  die(EXIT_IO, "%s: %s", f->path, strerror(error));
}

void output_folder(const char *path) {
  struct stat st;
  if (mkdir(path, 0777) == 0)
    made = path;
  else if (errno != EEXIST)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  else if (stat(path, &st) == 0 && !S_ISDIR(st.st_mode))
    die(EXIT_IO, "%s: is not a folder", path);
}

void output_open_in(struct output_file *f, const char *folder,
                    const char *name) {
  const size_t size = strlen(folder) + strlen(name) + 2;
  char *path = malloc(size);
  if (!path)
    die(EXIT_IO, "out of memory");
  snprintf(path, size, "%s/%s", folder, name);
  output_open(f, path);
  f->joined = path;
}

FILE *input_open(const char *path, const char **name) {
  if (!path || !strcmp(path, "-")) {
    *name = "standard input";
    return stdin;
  }
  *name = path;
  FILE *in = fopen(path, "r");
  struct stat st;
  if (in && fstat(fileno(in), &st) == 0 && S_ISDIR(st.st_mode))
    die(EXIT_IO, "%s: is a directory", path);
  if (!in)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  return in;
}
