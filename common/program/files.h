/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that appear whole or not at all, and never over one in use. Tested in
   tests/test_files.sh. */
#ifndef FILES_H
#define FILES_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include "platform/checksum.h"
#include "platform/store.h"
#include "program/unpack.h"

/* Written beside its final name and renamed when complete; what is not a
   regular file (a pipe, /dev/null) is written directly. A symbolic link stays,
   and what it points to is written; mode and, where we may, owner stay. A file
   with several names (hard links) is replaced under this name only; the others
   keep the old contents, and a message says so. */
struct output_file {
  const char *path; /* as the user has it */
  char *target;     /* where that leads to; NULL where written directly */
  char *partial;    /* what is written */
  uintmax_t others; /* names of the file that is replaced */
  char *joined;     /* the path, where it is the file's own */
  FILE *stream;
  bool renewed; /* output_reserve */
  int error; /* errno of the first write that failed, if that was looked for */
};

/* Both exit on failure with one line that names the file: with EXIT_IO, or with
   EXIT_USAGE if it is an input, another output not yet complete or what
   standard output goes to. A complete file is on the disk before it has its
   name. */
void output_open(struct output_file *f, const char *path);
void output_commit(struct output_file *f);

/* Has a write failed? For work that goes on for long before its commit; to be
   called after each write. */
bool output_failed(struct output_file *f);

/* Exits with EXIT_IO where a file is to grow by more bytes than its file system
   has left for us, or than ulimit -f lets it; before hours are spent on it.
   Does nothing for what is no regular file. name: NULL for standard output. */
void output_need_room(FILE *stream, const char *name, double bytes);

/* Makes a folder for several files unless it exists; it is removed at the end
   if it is still empty. Exits likewise. */
void output_folder(const char *path);

/* The same within a folder. Returns its path, to be freed. */
char *output_folder_in(const char *folder, const char *name);

/* output_open of a file in a folder. */
void output_open_in(struct output_file *f, const char *folder,
                    const char *name);

/* Of an output that goes on for hours and from a checkpoint: what it has by
   then. Zero-initialise. */
struct output_mark {
  char *partial; /* where it is written */
  size_t length;
  struct checksum sum; /* of all its bytes */
};
void output_mark_free(struct output_mark *m);

/* Marks what is written so far, which is then on the disk. False with errno,
   and the mark is as it was. A mark of its own for each output, from its
   beginning on. */
bool output_mark(struct output_file *f, struct output_mark *m);
/* From now on it stays if the program ends before its commit. */
void output_keep(struct output_file *f);
/* All of it (platform/store.h). */
void output_mark_store(struct output_mark *m, struct store *s);

/* As output_open, for a file that was marked, to go on from there: what was
   written later is cut off. Exits with EXIT_INPUT where its beginning is no
   longer what it was, with EXIT_USAGE while another process writes it. */
void output_open_at(struct output_file *f, const char *path,
                    struct output_mark *m);

/* A file that is written again and again while the program works, each time as
   a whole, and of which the last two are kept, the one before as path.old,
   where there are hard links. The first call is as output_open, but for a
   stream, and for a file that is not regular, which is EXIT_USAGE; the second
   gives the stream, the third puts the file in its place unless the stream or
   the caller failed. Both return false with errno, and the last file is still
   there. */
void output_reserve(struct output_file *f, const char *path);
bool output_renew(struct output_file *f);
bool output_renewed(struct output_file *f, bool good);

/* Whether it is a regular file, or is to be one: written beside its name. */
bool output_is_regular(const struct output_file *f);

struct input {
  const char *name; /* what messages call it */
  FILE *stream;
  struct unpack unpack;
};

/* Opens FILE for reading, or standard input for "-" or NULL; what is packed by
   gzip, xz or zstd is unpacked. Exits with EXIT_IO if it cannot be read, with
   EXIT_USAGE if it is being written as above. */
void input_open(struct input *in, const char *path);
/* Exits with EXIT_INPUT if it was packed and is not whole. */
void input_close(struct input *in);

#endif
