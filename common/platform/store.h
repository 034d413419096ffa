/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The memory of a computation from one step to the next, put into a file and
   taken out of it again to the last bit, so that it goes on as if it had never
   stopped. One function of each module does both,

     void thing_store(struct thing *t, struct store *s) {
       store_part(s, "thing");
       store_double(s, &t->x);
     }

   so that what is taken out is what was put in. It saves all that a later step
   reads before it writes it, and nothing that can be made again.

   The file has the bytes of the numbers as this machine has them. A part begins
   with its name, an array with its length, and both have to be the same when
   they are taken out. After the first failure nothing happens any more, and
   store_status tells; what was to be taken out is then not to be used. Not in
   the paper. One store per thread. Tested in tests/test_store.c. */
#ifndef STORE_H
#define STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include "platform/checksum.h"

struct store {
  FILE *stream;
  bool loads; /* takes out; else it puts in */
  int status;
  const char *part; /* that it is in */
  struct checksum sum;
};

/* Puts into the stream, or takes out of it, from where it is. It stays the
   caller's. */
struct store store_saving(FILE *stream);
struct store store_loading(FILE *stream);

/* GSL_SUCCESS; GSL_EFAILED where the stream failed or ended; GSL_EINVAL for
   what does not fit, in the part that s->part names; GSL_ENOMEM. */
int store_status(const struct store *s);
/* Makes it fail, unless it has already. */
void store_fail(struct store *s, int status);

/* name: a literal of less than 64 characters. */
void store_part(struct store *s, const char *name);

void store_bytes(struct store *s, void *bytes, size_t count);
/* A struct without pointers, which has its size in the file. */
void store_plain(struct store *s, void *plain, size_t size);
void store_double(struct store *s, double *x);
void store_size(struct store *s, size_t *n);
void store_flag(struct store *s, bool *flag);
/* Arrays of count, which the file has too. */
void store_doubles(struct store *s, double x[], size_t count);
void store_sizes(struct store *s, size_t n[], size_t count);
void store_flags(struct store *s, bool flag[], size_t count);
/* A text that malloc gave, or NULL; taken out it is new, and the caller frees
   it. At most 1 MiB. */
void store_text(struct store *s, char **text);

#endif
