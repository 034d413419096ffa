/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Input that is packed by gzip, xz or zstd, told by its first bytes and read
   through the system's program for it. Tested in tests/test_unpack.sh. */
#ifndef UNPACK_H
#define UNPACK_H

#include <stdio.h>
#include <sys/types.h>

struct unpack {
  FILE *stream; /* what is to be read */
  FILE *packed; /* what it is made from; NULL: nothing is packed */
  const char *name, *program;
  pid_t feeder, child;
};

/* Looks at the first bytes of a stream, a pipe too. Exits with EXIT_IO if the
   program is not there. name is for messages. */
void unpack_open(struct unpack *u, FILE *in, const char *name);

/* Closes both streams but standard input. Exits with EXIT_INPUT if the packed
   data were read to their end and are not whole. */
void unpack_close(struct unpack *u);

#endif
