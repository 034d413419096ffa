/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "frames.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/files.h"
#include "program/command_line.h"

static double bytes_of(FILE *in) {
  struct stat st;
  return fstat(fileno(in), &st) == 0 && S_ISREG(st.st_mode) ? (double)st.st_size
                                                            : 0;
}

static void open_next(struct frames *f) {
  const struct frames_options *o = &f->options;
  const char *file = f->count ? f->files[f->next] : "-";
  if (!strcmp(file, "-") && isatty(STDIN_FILENO))
    die(EXIT_USAGE, "expected a bed on standard input or a file; see --help");
  input_open(&f->in, file);
  f->next++;
  f->name = f->in.name;
  f->part = SIZE_MAX;
  f->any = false;
  f->size = bytes_of(f->in.stream);
  f->to = (double)(f->next - 1) / (double)GSL_MAX(f->count, 1);
  const struct bed_reader_options options = {.allow_partial = o->allow_partial,
                                             .may_be_empty = true,
                                             .radius = o->radius,
                                             .largest = 1e100,
                                             .columns = o->columns ? &f->columns
                                                                   : NULL};
  if (bed_reader_open(&f->reader, f->in.stream, f->name, &options) !=
      GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
}

void frames_open(struct frames *f, const struct frames_options *o, int argc,
                 char **argv, int first) {
  *f = (struct frames){
      .options = *o, .files = argv + first, .count = (size_t)(argc - first)};
  if (f->count > 1 && !o->many)
    die(EXIT_USAGE, "'%s' after '%s': expected one file", argv[first + 1],
        argv[first]);
  if (o->columns && columns_of_list(&f->columns, o->columns) != GSL_SUCCESS)
    die(EXIT_USAGE, "--columns %s: %s", o->columns, f->columns.wrong);
  f->progress = progress_begin(o->quiet);
  open_next(f);
}

bool frames_several(const struct frames *f) {
  return f->count > 1;
}

bool frames_are_beds(const struct frames *f) {
  return bed_reader_is_bed(f->reader);
}

void frames_formats(char *text, size_t size) {
  size_t used = 0;
  text[0] = 0;
  for (size_t k = 0; bed_format_name(k) && used < size; k++)
    used += (size_t)snprintf(text + used, size - used, "\n  %-12s %s",
                             bed_format_name(k), bed_format_help(k));
}

void frames_tell(struct frames *f, double done) {
  progress_tell(&f->progress,
                f->size > 0 ? f->from + (f->to - f->from) * done : done);
}

static void tell_part(void *context, double done) {
  const struct frames_part *part = context;
  frames_tell(part->frames, part->from + (part->to - part->from) * done);
}

struct observer frames_observer(struct frames_part *part) {
  return (struct observer){tell_part, part};
}

/* A frame has come: of a file the share is known; of a pipe each frame has a
   clock of its own. */
static void begin_frame(struct frames *f) {
  f->read++;
  f->from = f->to;
  if (f->size > 0) {
    const double share = fmin(1, (double)ftello(f->in.stream) / f->size);
    f->to = ((double)(f->next - 1) + share) / (double)GSL_MAX(f->count, 1);
    progress_name(&f->progress, "frame %zu", f->read);
  } else {
    progress_restart(&f->progress);
    progress_name(&f->progress, "of frame %zu", f->read);
  }
  frames_tell(f, 0);
}

/* The next frame of the file that is open, an empty one too. */
static bool read_frame(struct frames *f, struct bed *b) {
  bed_free(b);
  const int status = bed_reader_next(f->reader, b);
  const char *note = bed_reader_note(f->reader);
  if (status == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (status == GSL_EINVAL) {
    input_close(&f->in); /* has a better reason if it cannot be unpacked */
    die(EXIT_INPUT, "%s", bed_reader_error(f->reader));
  }
  if (note)
    warn("%s", note);
  return status == GSL_SUCCESS;
}

bool frames_next(struct frames *f, struct bed *b) {
  for (;;) {
    if (read_frame(f, b)) {
      if (!b->n && !f->options.may_be_empty)
        continue;
      f->any = true;
      f->first = f->part != bed_reader_part(f->reader);
      f->part = bed_reader_part(f->reader);
      begin_frame(f);
      return true;
    }
    if (!f->any)
      die(EXIT_INPUT, "%s: no frame has spheres", f->name);
    if (f->next >= f->count)
      return false;
    frames_close(f);
    open_next(f);
  }
}

const struct bed_header *frames_header(const struct frames *f) {
  return bed_reader_header(f->reader);
}

struct bed_header frames_copy_header(const struct frames *f) {
  const struct bed_header *from = frames_header(f);
  struct bed_header h = {0};
  int status = GSL_SUCCESS;
  if (!bed_header_get(from, "format"))
    status = bed_header_add(&h, "format", "bed-1");
  for (size_t k = 0; k < from->count && status == GSL_SUCCESS; k++)
    status = bed_header_add(&h, from->at[k].name, from->at[k].value);
  if (status != GSL_SUCCESS)
    die(EXIT_IO, "out of memory");
  return h;
}

const char *frames_status(const struct frames *f) {
  const struct bed_header *h = frames_header(f);
  const char *status = bed_header_get(h, "status");
  return status ? status : bed_reader_is_cut(f->reader) ? "cut" : "ok";
}

char *frames_origin(const struct frames *f) {
  static const char between[] = ", checksum ";
  char name[strlen(f->name) + 1];
  strcpy(name, f->name);
  char *const word = command_words(1, (char *[]){name});
  const char *sum = bed_reader_sum(f->reader);
  const size_t size = strlen(word) + sizeof between + (sum ? strlen(sum) : 0);
  char *text = realloc(word, size);
  if (!text)
    die(EXIT_IO, "out of memory");
  if (sum)
    strcat(strcat(text, between), sum);
  return text;
}

void frames_close(struct frames *f) {
  if (f->options.scene && !frames_are_beds(f))
    warn("%s: has no walls and no parameters; without walls, and with the "
         "parameters that settle has by default",
         f->name);
  bed_reader_close(f->reader);
  input_close(&f->in);
}
