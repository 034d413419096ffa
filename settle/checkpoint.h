/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run in a file, from which it goes on to the last bit as if it had not been
   stopped. docs/reliability.md describes the file: lines of text, which say
   what made it, then the memory of all modules (platform/store.h), then a
   checksum of all before. Tested in tests/test_checkpoint.sh. */
#ifndef CHECKPOINT_H
#define CHECKPOINT_H

#include "files/bed_io.h"
#include "platform/store.h"
#include "program/files.h"
#include "settings.h"

/* The parts of a run, beside its settings. */
struct setup {
  struct settings *set;
  struct option_spec *options;
  struct bed *bed;
  struct bed_header *header;
  size_t *order; /* of the rows, bed->n of them; taken out by malloc */
};

/* Puts a file in its place with a setup and what put adds. False with errno,
   and the last one is still there. */
bool checkpoint_write(struct output_file *f, double t, const char *kernel,
                      const struct setup *setup,
                      void (*put)(void *run, struct store *s), void *run);

/* A checkpoint that is read. Zero-initialise. */
struct checkpoint {
  FILE *stream; /* NULL: there is none */
  struct store store;
  char kernel[80];
  struct option_texts texts;
};

/* Opens one, looks whether it is whole and of this program, and takes the setup
   out. Exits with one line where it does not fit; what follows is in
   c->store. */
void checkpoint_open(struct checkpoint *c, const char *path,
                     const struct setup *setup, size_t **order);
/* After all is taken out; exits where that failed. */
void checkpoint_close(struct checkpoint *c, const char *path);

#endif
