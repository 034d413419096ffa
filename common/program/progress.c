/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/progress.h"

#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#include "program/messages.h"

static const double every = 0.5; /* s */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct progress progress_begin(bool quiet) {
  struct progress p = {.shows = !quiet && isatty(STDERR_FILENO),
                       .begun = now()};
  p.looked = p.begun;
  /* more than is written, and read, until the line is looked at again */
  static char rows[1 << 20];
  if (p.shows && isatty(STDOUT_FILENO))
    setvbuf(stdout, rows, _IOFBF, sizeof rows);
  return p;
}

bool progress_due(const struct progress *p) {
  return now() >= p->looked + every;
}

void progress_restart(struct progress *p) {
  p->begun = now();
}

void progress_name(struct progress *p, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(p->what, sizeof p->what, format, args);
  va_end(args);
}

/* Rows go to whoever waits for them; if nobody does any more, all is done. */
static void pass_on(void) {
  struct pollfd out = {.fd = STDOUT_FILENO};
  status_clear();
  if (ferror(stdout) || fflush(stdout) != 0)
    finish_output(); /* does not return */
  if (poll(&out, 1, 0) == 1 && out.revents & POLLERR)
    exit(EXIT_IO);
}

static void show(const struct progress *p, double done, double elapsed) {
  const char *separator = *p->what ? "  " : "";
  if (done > 0)
    status_line("%3.0f %%%s%s  %.0f s left", 100 * done, separator, p->what,
                elapsed * (1 - done) / done);
  else
    status_line("%s%s%.0f s", p->what, separator, elapsed);
}

void progress_tell(struct progress *p, double done) {
  if (!progress_due(p))
    return;
  const double t = p->looked = now();
  pass_on();
  if (p->shows)
    show(p, done, t - p->begun);
}

static volatile sig_atomic_t asked;

static void ask(int number) {
  (void)number;
  asked = 1;
}

void progress_listen(void) {
  struct sigaction new = {.sa_handler = ask, .sa_flags = SA_RESTART};
  sigemptyset(&new.sa_mask);
  sigaction(SIGUSR1, &new, NULL);
}

bool progress_asked(void) {
  const bool was = asked;
  asked = 0;
  return was;
}

void progress_end(struct progress *p) {
  (void)p;
  status_clear();
}
