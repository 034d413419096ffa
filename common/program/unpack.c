/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two processes: one passes on what is packed, of which this program has read
   the first bytes already, and one unpacks. */
#define _XOPEN_SOURCE 700
#include "program/unpack.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "program/messages.h"

static const struct packing {
  const char *bytes, *program;
} packings[] = {{"\x1F\x8B", "gzip"},
                {"\xFD"
                 "7zXZ",
                 "xz"},
                {"\x28\xB5\x2F\xFD", "zstd"}};
enum { PACKINGS = sizeof packings / sizeof *packings };

/* Does the stream go on with these bytes? They stay in it. */
static bool goes_on(FILE *in, const char *bytes) {
  int read[8];
  size_t count = 0;
  bool same = true;
  while (same && bytes[count]) {
    const int c = getc(in);
    same = c == (unsigned char)bytes[count];
    if (c != EOF)
      read[count++] = c;
  }
  /* bytes that were just read go back into the buffer that they came from */
  while (count-- > 0)
    if (ungetc(read[count], in) == EOF)
      die(EXIT_IO, "internal error: ungetc");
  return same;
}

static int move(int from, int to) {
  if (from == to)
    return 0;
  return dup2(from, to) < 0 ? -1 : close(from);
}

static void make_pipe(int ends[2], const char *name) {
  if (pipe(ends) != 0)
    die(EXIT_IO, "%s: %s", name, strerror(errno));
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
}

static pid_t make_child(const char *name) {
  const pid_t child = fork();
  if (child < 0)
    die(EXIT_IO, "%s: %s", name, strerror(errno));
  if (child == 0) {
    const int signals[] = {SIGPIPE, SIGINT, SIGTERM, SIGHUP};
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
      signal(signals[k], SIG_DFL);
  }
  return child;
}

/* The feeding process: all that is left of the stream. */
static _Noreturn void feed(FILE *in, int out) {
  char bytes[1 << 14];
  size_t count;
  while ((count = fread(bytes, 1, sizeof bytes, in)) > 0)
    for (size_t done = 0; done < count;) {
      const ssize_t written = write(out, bytes + done, count - done);
      if (written < 0)
        _exit(1);
      done += (size_t)written;
    }
  _exit(ferror(in) ? 1 : 0);
}

/* The unpacking process; what keeps it from running goes to failed. Its own
   words on a broken file would stand around the one line that says so. */
static _Noreturn void run(const char *program, int in, int out, int failed) {
  if (move(in, STDIN_FILENO) == 0 && move(out, STDOUT_FILENO) == 0 &&
      move(open("/dev/null", O_WRONLY), STDERR_FILENO) == 0)
    execlp(program, program, "-dc", (char *)NULL);
  const int error = errno;
  if (write(failed, &error, sizeof error) < 0)
    _exit(126);
  _exit(127);
}

static void start(struct unpack *u, FILE *in) {
  int packed[2], plain[2], failed[2], error;
  make_pipe(packed, u->name);
  make_pipe(plain, u->name);
  make_pipe(failed, u->name);
  u->feeder = make_child(u->name);
  if (u->feeder == 0) {
    close(packed[0]);
    close(plain[0]);
    close(plain[1]);
    close(failed[0]);
    close(failed[1]);
    feed(in, packed[1]);
  }
  u->child = make_child(u->name);
  if (u->child == 0)
    run(u->program, packed[0], plain[1], failed[1]);
  close(packed[0]);
  close(packed[1]);
  close(plain[1]);
  close(failed[1]);
  const ssize_t size = read(failed[0], &error, sizeof error);
  close(failed[0]);
  if (size == sizeof error)
    die(EXIT_IO, "%s: is packed by %s, which cannot be run: %s", u->name,
        u->program, strerror(error));
  u->packed = in;
  u->stream = fdopen(plain[0], "r");
  if (!u->stream)
    die(EXIT_IO, "%s: %s", u->name, strerror(errno));
}

void unpack_open(struct unpack *u, FILE *in, const char *name) {
  *u = (struct unpack){.stream = in, .name = name};
  for (int k = 0; k < PACKINGS; k++)
    if (goes_on(in, packings[k].bytes)) {
      u->program = packings[k].program;
      start(u, in);
      return;
    }
}

static int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
  return status;
}

void unpack_close(struct unpack *u) {
  const bool whole = feof(u->stream) != 0;
  if (u->stream != stdin)
    fclose(u->stream);
  if (!u->packed)
    return;
  const int status = wait_for(u->child);
  wait_for(u->feeder);
  if (u->packed != stdin)
    fclose(u->packed);
  if (whole && status != 0)
    die(EXIT_INPUT,
        "%s: %s cannot unpack it whole: it is cut short or "
        "damaged",
        u->name, u->program);
}
