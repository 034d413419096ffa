/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that appear whole or not at all. */
#ifndef FILES_H
#define FILES_H

#include <stdio.h>

/* Written beside its final name and renamed when complete; a path that is not
   a regular file (a pipe, /dev/null) is written directly. */
struct output_file {
  const char *path;
  char *partial; /* NULL where written directly */
  char *joined;  /* the path, where it is the file's own */
  FILE *stream;
};

/* Both exit with EXIT_IO and one line that names the file on failure. */
void output_open(struct output_file *f, const char *path);
void output_commit(struct output_file *f);

/* A folder for several files, made if there is none; it goes again if nothing
   comes to be in it. Exits likewise. */
void output_folder(const char *path);

/* output_open of a file in a folder, at most 8 at a time. */
void output_open_in(struct output_file *f, const char *folder,
                    const char *name);

/* Opens FILE for reading, or standard input for "-" or NULL; exits with
   EXIT_IO if it cannot be read. name becomes what messages call it. */
FILE *input_open(const char *path, const char **name);

#endif
