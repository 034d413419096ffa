/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/litter.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include "program/messages.h"

/* A signal handler may read the list at any moment, so places are added in one
   store of a pointer and never freed: one without a path is used again. */
struct place {
  const char *_Atomic path;
  struct place *next; /* older */
};
static struct place *_Atomic places;
static atomic_long helper; /* pid */
static atomic_bool deferred;
static atomic_int asked;
static sigset_t held; /* what was blocked before */

/* Calls only functions that a signal handler may call. */
static void remove_all(void) {
  const long child = atomic_exchange(&helper, 0);
  if (child > 0) {
    kill((pid_t)child, SIGTERM);
    while (waitpid((pid_t)child, NULL, 0) < 0 && errno == EINTR)
      ;
  }
  for (struct place *p = places; p; p = p->next)
    if (p->path)
      unlink(p->path);
  for (struct place *p = places; p; p = p->next)
    if (p->path)
      rmdir(p->path); /* no more than fails of what was a file */
}

static void end_by(int number) {
  if (deferred && !asked && number != SIGQUIT && number != SIGABRT) {
    asked = number;
    return;
  }
  remove_all();
  signal(number, SIG_DFL);
  raise(number); /* comes when this handler returns */
}

static void end_by_pipe(int number) {
  (void)number;
  const int error = errno;
  struct pollfd out = {.fd = STDOUT_FILENO};
  if (poll(&out, 1, 0) == 1 && out.revents & (POLLERR | POLLHUP)) {
    remove_all();
    _exit(EXIT_IO);
  }
  errno = error;
}

static void go_on(int number) {
  (void)number;
}

/* Signals that end a process. */
static const int ends[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGABRT};
static bool caught[sizeof ends / sizeof *ends]; /* not ignored from the start */

static bool catch_signal(int number, void (*handler)(int)) {
  struct sigaction old, new = {.sa_handler = handler, .sa_flags = SA_RESTART};
  sigemptyset(&new.sa_mask);
  const bool always = number == SIGPIPE || number == SIGXFSZ;
  /* not SIG_IGN for those two: programs that we start would inherit it */
  return sigaction(number, NULL, &old) == 0 &&
         (always || old.sa_handler != SIG_IGN) &&
         sigaction(number, &new, NULL) == 0;
}

void litter_watch(void) {
  static bool watched;
  if (watched)
    return;
  watched = true;
  atexit(remove_all);
  for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
    caught[k] = catch_signal(ends[k], end_by);
  catch_signal(SIGPIPE, end_by_pipe);
  catch_signal(SIGXFSZ, go_on);
}

void litter_hold(void) {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &held);
}

void litter_release(void) {
  sigprocmask(SIG_SETMASK, &held, NULL);
}

void litter_add(const char *path) {
  for (struct place *p = places; p; p = p->next)
    if (!p->path) {
      p->path = path;
      return;
    }
  struct place *p = malloc(sizeof *p);
  if (!p)
    die(EXIT_IO, "out of memory");
  p->path = path;
  p->next = places;
  places = p;
}

void litter_forget(const char *path) {
  for (struct place *p = places; p; p = p->next)
    if (p->path == path)
      p->path = NULL;
}

/* No signal comes between the fork and the knowledge of it; the child goes by
   the default until it is another program. */
pid_t litter_fork(void) {
  litter_hold();
  const pid_t child = fork();
  if (child > 0)
    helper = child;
  if (child == 0)
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
      if (caught[k])
        signal(ends[k], SIG_DFL);
  litter_release();
  return child;
}

void litter_forked(void) {
  helper = 0;
}

void litter_defer(void) {
  deferred = true;
}

int litter_asked(void) {
  return asked;
}
