/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _XOPEN_SOURCE 700
#include "program/files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "program/litter.h"
#include "program/messages.h"

static void *need(void *memory) {
  if (!memory)
    die(EXIT_IO, "out of memory");
  return memory;
}

/* Files in use: the regular ones by device and inode, outputs by the path that
   they will have as well. */
struct use {
  const char *name; /* as the user has it; NULL: over */
  bool output;
  dev_t device;
  ino_t inode; /* 0: not there yet */
  const char *path;
};
static struct use *uses;
static size_t use_count;

static bool same(const struct use *a, const struct use *b) {
  return (a->inode && a->inode == b->inode && a->device == b->device) ||
         (a->path && b->path && !strcmp(a->path, b->path));
}

/* Exits if the file is in use, unless by others that read it as well. */
static void claim(struct use new) {
  struct use *place = NULL;
  for (struct use *u = uses; u < uses + use_count; u++)
    if (!u->name)
      place = u;
    else if (same(u, &new) && (u->output || new.output))
      die(EXIT_USAGE, "%s: expected another file, this one is %s%s", new.name,
          u->output ? "written to" : "read from",
          !strcmp(u->name, new.name) ? " already" : " as well");
  if (!place) {
    uses = need(realloc(uses, (use_count + 1) * sizeof *uses));
    place = &uses[use_count++];
  }
  *place = new;
}

static void claim_stream(const char *name, FILE *stream, bool output) {
  struct stat st;
  if (fstat(fileno(stream), &st) == 0 && S_ISREG(st.st_mode))
    claim((struct use){name, output, st.st_dev, st.st_ino, NULL});
}

/* Takes the file of standard output as written, before another is opened. */
static void claim_standard_output(void) {
  static bool claimed;
  if (!claimed)
    claim_stream("standard output", stdout, true);
  claimed = true;
}

static void unclaim(const char *path) {
  for (struct use *u = uses; u < uses + use_count; u++)
    if (u->path == path)
      *u = (struct use){0};
}

/* Where a path's directory ends: the length with the last slash. */
static size_t directory_length(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash - path) + 1 : 0;
}

/* The first length characters of a and b, in memory of its own. */
static char *joined(const char *a, size_t length, const char *b) {
  char *text = need(malloc(length + strlen(b) + 1));
  memcpy(text, a, length);
  strcpy(text + length, b);
  return text;
}

/* A path through links down to what is there, or may be there; NULL if it is a
   door to an open file (/dev/stderr), which has no place to put another. */
static char *follow(const char *path) {
  enum { MOST_LINKS = 40 };
  char *at = joined(path, strlen(path), ""), to[4096];
  for (int k = 0;; k++) {
    const ssize_t length = readlink(at, to, sizeof to - 1);
    if (length < 0)
      return at;
    if (k == MOST_LINKS)
      die(EXIT_IO, "%s: %s", path, strerror(ELOOP));
    to[length] = 0;
    char *next = joined(at, *to == '/' ? 0 : directory_length(at), to);
    free(at);
    at = next;
    if (!strncmp(at, "/proc/", 6) || !strncmp(at, "/dev/fd/", 8)) {
      free(at);
      return NULL;
    }
  }
}

/* With its directory written in the one way that is without links. */
static char *canonical(const char *path) {
  const size_t length = directory_length(path);
  char *directory = joined(path, length, length ? "." : "./");
  char *real = realpath(directory, NULL);
  free(directory);
  if (!real) /* opening it will say why */
    return joined(path, strlen(path), "");
  char *with_slash = joined(real, strlen(real), "/");
  char *whole = joined(with_slash, strlen(with_slash), path + length);
  free(real);
  free(with_slash);
  return whole;
}

static _Noreturn void cannot_write(const char *path) {
  die(EXIT_IO, "%s: %s", path, strerror(errno));
}

/* Opens a new file beside the target, with the mode and owner of the one that
   is to be replaced. */
static void open_partial(struct output_file *f, const struct stat *old) {
  char ending[48];
  snprintf(ending, sizeof ending, ".partial-%ld", (long)getpid());
  f->partial = joined(f->target, strlen(f->target), ending);
  int fd = open(f->partial, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0 && errno == EEXIST && unlink(f->partial) == 0) /* long dead */
    fd = open(f->partial, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0)
    cannot_write(f->path);
  litter_add(f->partial);
  if (old) {
    if (fchown(fd, old->st_uid, old->st_gid) != 0)
      errno = 0; /* only root may; then it becomes ours */
    if (fchmod(fd, old->st_mode & 0777) != 0)
      cannot_write(f->path);
  }
  f->stream = fdopen(fd, "w");
}

void output_open(struct output_file *f, const char *path) {
  struct stat st;
  *f = (struct output_file){.path = path};
  if (!strcmp(path, "-"))
    die(EXIT_USAGE, "-: expected the name of a file, such as /dev/stderr");
  claim_standard_output();
  const bool there = stat(path, &st) == 0;
  if (!there || S_ISREG(st.st_mode))
    f->target = follow(path);
  if (!f->target) {
    f->stream = fopen(path, "w");
  } else {
    char *real = canonical(f->target);
    free(f->target);
    f->target = real;
    claim((struct use){path, true, there ? st.st_dev : 0, there ? st.st_ino : 0,
                       f->target});
    f->others = there ? st.st_nlink - 1 : 0;
    if (!there || access(f->target, W_OK) == 0)
      open_partial(f, there ? &st : NULL);
  }
  if (!f->stream)
    cannot_write(path);
}

/* Has the disk keep the file, as far as there is a disk. */
static bool synchronize(FILE *stream) {
  return fsync(fileno(stream)) == 0 || errno == EINVAL || errno == ENOTSUP;
}

static void synchronize_directory(const char *path) {
  char *directory = joined(path, directory_length(path), ".");
  const int fd = open(directory, O_RDONLY);
  if (fd >= 0) {
    fsync(fd); /* the file is whole with its old or its new name */
    close(fd);
  }
  free(directory);
}

bool output_failed(struct output_file *f) {
  if (!f->error && ferror(f->stream))
    f->error = errno;
  return f->error != 0;
}

void output_commit(struct output_file *f) {
  const bool failed = ferror(f->stream);
  bool done = fflush(f->stream) == 0 && !failed &&
              (!f->partial || synchronize(f->stream));
  const int error = f->error ? f->error : errno;
  if (fclose(f->stream) != 0 && !f->error)
    done = false;
  else if (!done)
    errno = error;
  if (!done || (f->partial && rename(f->partial, f->target) != 0))
    cannot_write(f->path);
  if (!f->partial) {
    free(f->joined);
    return;
  }
  litter_forget(f->partial);
  synchronize_directory(f->target);
  if (f->others)
    warn("%s: is a new file; %ju other name%s of the old one keep%s it",
         f->path, f->others, f->others > 1 ? "s" : "",
         f->others > 1 ? "" : "s");
  unclaim(f->target);
  free(f->partial);
  free(f->target);
  free(f->joined);
}

static char *path_in(const char *folder, const char *name) {
  char *with_slash = joined(folder, strlen(folder), "/");
  char *path = joined(with_slash, strlen(with_slash), name);
  free(with_slash);
  return path;
}

void output_folder(const char *path) {
  struct stat st;
  if (mkdir(path, 0777) == 0) /* what is in it will not be littered */
    litter_add(joined(path, strlen(path), ""));
  else if (errno != EEXIST)
    cannot_write(path);
  else if (stat(path, &st) == 0 && !S_ISDIR(st.st_mode))
    die(EXIT_IO, "%s: is not a folder", path);
}

char *output_folder_in(const char *folder, const char *name) {
  char *path = path_in(folder, name);
  output_folder(path);
  return path;
}

void output_open_in(struct output_file *f, const char *folder,
                    const char *name) {
  char *path = path_in(folder, name);
  output_open(f, path);
  f->joined = path;
}

void input_open(struct input *in, const char *path) {
  FILE *stream = stdin;
  in->name = "standard input";
  claim_standard_output();
  if (path && strcmp(path, "-")) {
    struct stat st;
    in->name = path;
    stream = fopen(path, "r");
    if (!stream)
      die(EXIT_IO, "%s: %s", path, strerror(errno));
    if (fstat(fileno(stream), &st) == 0 && S_ISDIR(st.st_mode))
      die(EXIT_IO, "%s: is a directory", path);
  }
  claim_stream(in->name, stream, false);
  unpack_open(&in->unpack, stream, in->name);
  in->stream = in->unpack.stream;
}

void input_close(struct input *in) {
  unpack_close(&in->unpack);
}
