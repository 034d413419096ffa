/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "platform/system.h"
#include "program/version.h"

static const char magic[] = "# format=settle-checkpoint-1\n";

/* The lines of the head: what has to be the same for the same bits. */
enum { VERSION, BUILD, KERNEL, TIME, LINES };
static const char *const names[LINES] = {
    [VERSION] = "version",
    [BUILD] = "build",
    [KERNEL] = "kernel",
    [TIME] = "t",
};

static void store_setup(const struct setup *setup, size_t **order,
                        struct option_texts *texts, struct store *s) {
  struct settings *set = setup->set;
  options_store(setup->options, texts, s);
  if (s->loads) { /* the one that began the run */
    free(set->command);
    set->command = NULL;
  }
  store_text(s, &set->command);
  store_part(s, "similarity");
  store_plain(s, &set->similarity, sizeof set->similarity);
  bed_header_store(setup->header, s);
  scene_store(&set->scene, s);
  bed_store(setup->bed, s);
  store_part(s, "order");
  if (s->loads && store_status(s) == GSL_SUCCESS &&
      !(*order = calloc(setup->bed->n + 1, sizeof **order)))
    store_fail(s, GSL_ENOMEM);
  if (store_status(s) == GSL_SUCCESS)
    store_sizes(s, *order, setup->bed->n);
}

/* --- writing ---------------------------------------------------------------*/

static void put_head(double t, const char *kernel, struct store *s) {
  char build[SYSTEM_BUILD_SIZE], number[NUMBER_SIZE], line[512];
  system_build(build);
  number_format(t, number);
  const char *const values[LINES] = {DEM_VERSION, build, kernel, number};
  strcpy(line, magic);
  store_bytes(s, line, strlen(line));
  for (int k = 0; k < LINES; k++) {
    snprintf(line, sizeof line, "# %s=%s\n", names[k], values[k]);
    store_bytes(s, line, strlen(line));
  }
  strcpy(line, "\n");
  store_bytes(s, line, 1);
}

bool checkpoint_write(struct output_file *f, double t, const char *kernel,
                      const struct setup *setup,
                      void (*put)(void *run, struct store *s), void *run) {
  size_t *order = setup->order;
  if (!output_renew(f))
    return false;
  struct store s = store_saving(f->stream);
  put_head(t, kernel, &s);
  store_setup(setup, &order, NULL, &s);
  put(run, &s);
  uint32_t sum = checksum_value(&s.sum);
  store_bytes(&s, &sum, sizeof sum);
  return output_renewed(f, store_status(&s) == GSL_SUCCESS);
}

/* --- reading ---------------------------------------------------------------*/

static _Noreturn void refuse(const char *path, const char *why) {
  die(EXIT_INPUT, "%s: %s", path, why);
}

/* Whether the file ends with the checksum of what comes before. */
static bool is_whole(FILE *in) {
  struct checksum sum = checksum_begin();
  unsigned char bytes[(1 << 16) + sizeof(uint32_t)];
  const size_t end = sizeof(uint32_t);
  uint32_t last;
  size_t count = fread(bytes, 1, end, in), got;
  if (count < end)
    return false;
  while ((got = fread(bytes + end, 1, sizeof bytes - end, in)) > 0) {
    checksum_add(&sum, bytes, got);
    memmove(bytes, bytes + got, end);
  }
  memcpy(&last, bytes, end);
  return !ferror(in) && last == checksum_value(&sum);
}

/* The value of a line of the head, of less than 512 characters. */
static void take_line(struct checkpoint *c, const char *path, const char *name,
                      char value[512]) {
  char line[640], begin[64];
  snprintf(begin, sizeof begin, "# %s=", name);
  const size_t length = strlen(begin);
  if (!fgets(line, 600, c->stream) || strncmp(line, begin, length))
    die(EXIT_INPUT, "%s: expected a line '%s...'", path, begin);
  checksum_add(&c->store.sum, line, strlen(line));
  line[strcspn(line, "\n")] = 0;
  snprintf(value, 512, "%.511s", line + length);
}

static void take_head(struct checkpoint *c, const char *path) {
  char line[sizeof magic] = "", value[LINES][512], build[SYSTEM_BUILD_SIZE];
  if (!fgets(line, sizeof line, c->stream) || strcmp(line, magic))
    refuse(path, "is no checkpoint of this version of settle");
  for (int k = 0; k < LINES; k++)
    take_line(c, path, names[k], value[k]);
  if (fgetc(c->stream) != '\n')
    refuse(path, "expected a blank line behind the head");
  system_build(build);
  if (strcmp(value[VERSION], DEM_VERSION))
    die(EXIT_INPUT,
        "%s: was made by version %s, this is %s: expected the same, for the "
        "same bits",
        path, value[VERSION], DEM_VERSION);
  if (strcmp(value[BUILD], build))
    die(EXIT_INPUT,
        "%s: was made by a build with %s, this one is with %s: expected the "
        "same, for the same bits",
        path, value[BUILD], build);
  snprintf(c->kernel, sizeof c->kernel, "%.79s", value[KERNEL]);
}

static void check(const struct store *s, const char *path) {
  if (store_status(s) == GSL_ENOMEM)
    die(EXIT_IO, "out of memory");
  if (store_status(s) != GSL_SUCCESS)
    die(EXIT_INPUT, "%s: does not fit this program in part '%s'", path,
        s->part);
}

void checkpoint_open(struct checkpoint *c, const char *path,
                     const struct setup *setup, size_t **order) {
  c->stream = fopen(path, "rb");
  if (!c->stream)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  c->store = store_loading(c->stream);
  take_head(c, path);
  const long begin = ftell(c->stream);
  rewind(c->stream);
  if (!is_whole(c->stream))
    refuse(path, "is cut short or damaged: its checksum does not fit");
  clearerr(c->stream);
  if (begin < 0 || fseek(c->stream, begin, SEEK_SET) != 0)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  store_setup(setup, order, &c->texts, &c->store);
  check(&c->store, path);
}

void checkpoint_close(struct checkpoint *c, const char *path) {
  check(&c->store, path);
  fclose(c->stream);
  c->stream = NULL;
}
