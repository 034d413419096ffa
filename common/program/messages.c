/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/messages.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>

static const char *name = "?", *verb; /* set once */

void message_name(const char *program, const char *verb_) {
  name = program;
  verb = verb_;
}

const char *program_name(void) {
  return name;
}

const char *program_verb(void) {
  return verb;
}

static bool status_shown;

void status_line(const char *format, ...) {
  va_list args;
  va_start(args, format);
  fprintf(stderr, "\r%s: ", name);
  vfprintf(stderr, format, args);
  fputs(" \033[K", stderr);
  va_end(args);
  fflush(stderr);
  status_shown = true;
}

void status_clear(void) {
  if (status_shown)
    fputs("\r\033[K", stderr);
  status_shown = false;
}

static void message(const char *format, va_list args) {
  status_clear();
  fflush(stdout); /* the rows before it, on a terminal */
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

void say_bytes(double bytes, char text[SAY_BYTES_SIZE]) {
  static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
  size_t k = 0;
  while (bytes >= 999.5 && k + 1 < sizeof units / sizeof *units) {
    bytes /= 1000;
    k++;
  }
  snprintf(text, SAY_BYTES_SIZE, "%.3g %s", bytes, units[k]);
}

void warn(const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(format, args);
  va_end(args);
  fputc('\n', stderr);
}

void finish_output(void) {
  status_clear();
  const bool failed = ferror(stdout);
  if (fflush(stdout) == 0 && !failed)
    return;
  if (errno == EPIPE)
    exit(EXIT_IO);
  die(EXIT_IO, "standard output: %s", strerror(errno));
}
