/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/messages.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include "program/litter.h"

static const char *name = "?", *verb; /* set once */

void program_begin(const char *name_, const char *verb_) {
  name = name_;
  verb = verb_;
  gsl_set_error_handler_off();
  litter_watch();
  /* A closed standard stream would be given to the next file opened. Read-only,
     so that writing to it still fails. */
  int fd;
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0)
    close(fd);
}

const char *program_name(void) {
  return name;
}

const char *program_verb(void) {
  return verb;
}

static void message(const char *format, va_list args) {
  fprintf(stderr, "%s: ", name);
  vfprintf(stderr, format, args);
}

void die(enum exit_code code, const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(format, args);
  va_end(args);
  if (code == EXIT_USAGE)
    fprintf(stderr, " (try '%s%s%s --help')", name, verb ? " " : "",
            verb ? verb : "");
  fputc('\n', stderr);
  exit((int)code);
}

void die_status(int status, const char *format, ...) {
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  char what[256];
  va_list args;
  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  die(status == GSL_EINVAL ? EXIT_USAGE : EXIT_IO, "%s: %s", what,
      gsl_strerror(status));
}

void warn(const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(format, args);
  va_end(args);
  fputc('\n', stderr);
}

void finish_output(void) {
  const bool failed = ferror(stdout);
  if (fflush(stdout) == 0 && !failed)
    return;
  if (errno == EPIPE)
    exit(EXIT_IO);
  die(EXIT_IO, "standard output: %s", strerror(errno));
}
