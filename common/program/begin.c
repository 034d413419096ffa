/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/begin.h"

#include <fcntl.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include "program/litter.h"
#include "program/messages.h"

void program_begin(const char *name, const char *verb) {
  message_name(name, verb);
  gsl_set_error_handler_off();
  litter_watch();
  /* read-only, so that writing to it still fails */
  int fd;
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0)
    close(fd);
}
