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
#include "platform/system.h"
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

/* For as long as it is open; false if another process has it. */
static bool lock(int fd) {
  struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
  return fcntl(fd, F_SETLK, &whole) == 0 ||
         (errno != EACCES && errno != EAGAIN); /* nobody can lock it */
}

/* A new file that is litter until it has another name; -1 with errno. What that
   takes of memory is there before the file. */
static int make_litter(const char *path) {
  litter_hold();
  litter_add(path);
  int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0 && errno == EEXIST && unlink(path) == 0) /* long dead */
    fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0)
    litter_forget(path);
  litter_release();
  return fd;
}

/* Opens a new file beside the target, with the mode and owner of the one that
   is to be replaced. False with errno. */
static bool open_partial(struct output_file *f, const struct stat *old) {
  char ending[48] = ".partial"; /* of what is renewed: the next run's too */
  if (!f->renewed)
    snprintf(ending, sizeof ending, ".partial-%ld", (long)getpid());
  f->partial = joined(f->target, strlen(f->target), ending);
  const int fd = make_litter(f->partial);
  if (fd < 0)
    return false;
  if (old) {
    if (fchown(fd, old->st_uid, old->st_gid) != 0)
      errno = 0; /* only root may; then it becomes ours */
    if (fchmod(fd, old->st_mode & 0777) != 0) {
      close(fd);
      return false;
    }
  }
  lock(fd);
  f->stream = fdopen(fd, "w");
  if (!f->stream)
    close(fd);
  return f->stream != NULL;
}

/* Where it is to be, which is not in use; whether it is there already. */
static bool find_target(struct output_file *f, const char *path,
                        struct stat *st) {
  *f = (struct output_file){.path = path};
  if (!strcmp(path, "-"))
    die(EXIT_USAGE, "-: expected the name of a file, such as /dev/stderr");
  claim_standard_output();
  const bool there = stat(path, st) == 0;
  if (!there || S_ISREG(st->st_mode))
    f->target = follow(path);
  if (f->target) {
    char *real = canonical(f->target);
    free(f->target);
    f->target = real;
    claim((struct use){path, true, there ? st->st_dev : 0,
                       there ? st->st_ino : 0, f->target});
    f->others = there ? st->st_nlink - 1 : 0;
  }
  return there;
}

void output_open(struct output_file *f, const char *path) {
  struct stat st;
  const bool there = find_target(f, path, &st);
  if (!f->target)
    f->stream = fopen(path, "w");
  else if (!there || access(f->target, W_OK) == 0)
    open_partial(f, there ? &st : NULL);
  if (!f->stream)
    cannot_write(path);
}

bool output_is_regular(const struct output_file *f) {
  return f->target != NULL;
}

/* Has the disk keep the file, as far as there is a disk. */
static bool synchronize(FILE *stream) {
  return fsync(fileno(stream)) == 0 || errno == EINVAL || errno == ENOTSUP;
}

static void synchronize_directory(const char *path) {
  const size_t length = directory_length(path);
  char *directory = malloc(length + 2);
  if (!directory)
    return; /* the file has its name, which is no reason to end */
  memcpy(directory, path, length);
  strcpy(directory + length, ".");
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

void output_need_room(FILE *stream, const char *name, double bytes) {
  struct stat st;
  const int fd = fileno(stream);
  if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode))
    return;
  const struct system_room room = system_room(fd);
  if (bytes <= room.bytes)
    return;
  char takes[SAY_BYTES_SIZE], has[SAY_BYTES_SIZE];
  say_bytes(bytes, takes);
  say_bytes(room.bytes, has);
  die(EXIT_IO, "%s: takes %s, and %s has room for %s",
      name ? name : "standard output", takes, room.by, has);
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

/* --- files that a checkpoint refers to -------------------------------------*/

void output_mark_free(struct output_mark *m) {
  free(m->partial);
  *m = (struct output_mark){0};
}

/* Adds bytes of the file, from one place to another, to the sum. */
static bool add_bytes(int fd, size_t from, size_t to, struct checksum *sum) {
  char bytes[1 << 16];
  while (from < to) {
    const size_t some = to - from < sizeof bytes ? to - from : sizeof bytes;
    const ssize_t got = pread(fd, bytes, some, (off_t)from);
    if (got <= 0)
      return false;
    checksum_add(sum, bytes, (size_t)got);
    from += (size_t)got;
  }
  return true;
}

bool output_mark(struct output_file *f, struct output_mark *m) {
  if (fflush(f->stream) != 0 || output_failed(f) || !synchronize(f->stream))
    return false;
  const off_t end = ftello(f->stream);
  struct checksum sum = m->length ? m->sum : checksum_begin();
  if (end < 0 || !add_bytes(fileno(f->stream), m->length, (size_t)end, &sum))
    return false;
  if (!m->partial)
    m->partial = joined(f->partial, strlen(f->partial), "");
  m->length = (size_t)end;
  m->sum = sum;
  return true;
}

void output_keep(struct output_file *f) {
  litter_forget(f->partial);
}

void output_mark_store(struct output_mark *m, struct store *s) {
  store_part(s, "output");
  store_text(s, &m->partial);
  store_size(s, &m->length);
  store_bytes(s, &m->sum.rest, sizeof m->sum.rest);
}

/* Does the file begin with what was marked? */
static bool begins_as_marked(int fd, const struct output_mark *m) {
  struct checksum sum = checksum_begin();
  return add_bytes(fd, 0, m->length, &sum) &&
         (!m->length || sum.rest == m->sum.rest);
}

/* Opens the file that a killed process has left. */
static bool open_left(struct output_file *f, const struct output_mark *m) {
  const int fd = m->partial ? open(m->partial, O_RDWR | O_CLOEXEC) : -1;
  if (fd < 0)
    return false;
  if (!lock(fd))
    die(EXIT_USAGE, "%s: is being written by another run", m->partial);
  if (!begins_as_marked(fd, m) || ftruncate(fd, (off_t)m->length) != 0 ||
      lseek(fd, 0, SEEK_END) < 0) {
    close(fd);
    return false;
  }
  f->partial = joined(m->partial, strlen(m->partial), "");
  f->stream = fdopen(fd, "w");
  if (!f->stream)
    cannot_write(f->path);
  return true;
}

/* A copy of the part that a process has committed, to go on in another file;
   false if it is not there. */
static bool open_committed(struct output_file *f, const struct output_mark *m,
                           const struct stat *st) {
  const int fd = open(f->target, O_RDONLY | O_CLOEXEC);
  if (fd < 0 || !begins_as_marked(fd, m)) {
    if (fd >= 0)
      close(fd);
    return false;
  }
  bool good = open_partial(f, st);
  char bytes[1 << 16];
  for (size_t at = 0; good && at < m->length;) {
    const size_t left = m->length - at;
    const ssize_t got =
        pread(fd, bytes, left < sizeof bytes ? left : sizeof bytes, (off_t)at);
    good = got > 0 && fwrite(bytes, 1, (size_t)got, f->stream) == (size_t)got;
    at += good ? (size_t)got : 0;
  }
  if (!good)
    cannot_write(f->path);
  close(fd);
  return true;
}

void output_open_at(struct output_file *f, const char *path,
                    struct output_mark *m) {
  struct stat st;
  const bool there = find_target(f, path, &st);
  m->sum = (struct checksum){.rest = m->sum.rest};
  memcpy(m->sum.table, checksum_begin().table, sizeof m->sum.table);
  if (f->target && open_left(f, m))
    return;
  if (f->target && ((there && open_committed(f, m, &st)) || !m->length)) {
    if (!f->stream && !open_partial(f, NULL))
      cannot_write(path);
    free(m->partial); /* has another name from now on */
    m->partial = NULL;
    return;
  }
  die(EXIT_INPUT,
      "%s: expected to begin with the %zu bytes that it had at the checkpoint, "
      "or %s to do so",
      path, m->length, m->partial);
}

void output_reserve(struct output_file *f, const char *path) {
  struct stat st;
  find_target(f, path, &st);
  if (!f->target)
    die(EXIT_USAGE, "%s: expected a file that can be replaced", path);
  f->renewed = true;
}

bool output_renew(struct output_file *f) {
  f->stream = NULL;
  if (open_partial(f, NULL))
    return true;
  const int error = errno;
  unlink(f->partial); /* it is there, if there was no memory for more */
  litter_forget(f->partial);
  free(f->partial);
  f->partial = NULL;
  errno = error;
  return false;
}

/* The file is the one before as well, if it is there, until it is replaced: at
   no moment it is not. Where there are no hard links, none is kept. */
static bool keep_old(const struct output_file *f) {
  const size_t length = strlen(f->target);
  char *old = malloc(length + sizeof ".old");
  if (!old)
    return false;
  memcpy(old, f->target, length);
  strcpy(old + length, ".old");
  const bool gone = unlink(old) == 0 || errno == ENOENT;
  if (gone)
    link(f->target, old);
  free(old);
  return gone;
}

bool output_renewed(struct output_file *f, bool good) {
  good = fflush(f->stream) == 0 && !ferror(f->stream) && good &&
         synchronize(f->stream);
  int error = errno;
  if (fclose(f->stream) != 0 && good) {
    good = false;
    error = errno;
  }
  if (good && !(keep_old(f) && rename(f->partial, f->target) == 0)) {
    good = false;
    error = errno;
  }
  if (good)
    synchronize_directory(f->target);
  else
    unlink(f->partial);
  litter_forget(f->partial);
  free(f->partial);
  f->partial = NULL;
  errno = error;
  return good;
}

static char *path_in(const char *folder, const char *name) {
  char *with_slash = joined(folder, strlen(folder), "/");
  char *path = joined(with_slash, strlen(with_slash), name);
  free(with_slash);
  return path;
}

void output_folder(const char *path) {
  struct stat st;
  char *kept = joined(path, strlen(path), "");
  litter_hold();
  litter_add(kept); /* what is in it will not be littered */
  const bool made = mkdir(path, 0777) == 0;
  if (!made)
    litter_forget(kept);
  litter_release();
  if (made)
    return;
  free(kept);
  if (errno != EEXIST)
    cannot_write(path);
  if (stat(path, &st) == 0 && !S_ISDIR(st.st_mode))
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
