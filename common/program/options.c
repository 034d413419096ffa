/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/options.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "program/version.h"

static const char *program_name = "?"; /* set once, for messages */

static void message(const char *format, va_list args) {
  fprintf(stderr, "%s: ", program_name);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
}

void die(enum exit_code code, const char *format, ...) {
  va_list args;
  va_start(args, format);
  message(format, args);
  va_end(args);
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
}

static const char *expected(const char *format, ...) {
  static _Thread_local char text[256];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  return text;
}

static const char *range_text(const struct option_spec *o) {
  const char *kind = o->type == OPTION_SIZE ? "a whole number" : "a number";
  const bool positive = o->least > 0 && o->least < 1e-300;
  if (o->most >= OPTION_MANY && positive)
    return expected("%s above 0", kind);
  if (o->most >= OPTION_MANY && o->least <= -OPTION_MANY)
    return expected("%s", kind);
  if (o->most >= OPTION_MANY)
    return expected("%s of at least %g", kind, o->least);
  return expected("%s from %g to %g", kind, o->least, o->most);
}

static bool in_range(const struct option_spec *o, double x) {
  return (x >= o->least || o->least <= -OPTION_MANY) &&
         (x <= o->most || o->most >= OPTION_MANY);
}

/* Numbers separated by commas or white space, as in a bed's header. */
static bool parse_list(const char *text, struct option_list *list) {
  char word[64];
  list->count = 0;
  for (;;) {
    text += strspn(text, " \t");
    const size_t length = strcspn(text, ", \t");
    if (!length || length >= sizeof word ||
        list->count == sizeof list->at / sizeof *list->at)
      return false;
    memcpy(word, text, length);
    word[length] = 0;
    if (!number_parse(word, &list->at[list->count++]))
      return false;
    text += length;
    text += strspn(text, " \t");
    if (!*text)
      return true;
    if (*text == ',')
      text++;
  }
}

static const char *set_list(struct option_spec *o, const char *text) {
  struct option_list list;
  if (!parse_list(text, &list) || (double)list.count < o->least ||
      (double)list.count > o->most) {
    if (o->least == o->most)
      return expected("%g numbers separated by commas", o->least);
    return expected("%g to %g numbers separated by commas", o->least, o->most);
  }
  if (!o->each)
    *(struct option_list *)o->value = list;
  else {
    const int status = o->each(&list, o->context);
    if (status == GSL_ENOMEM)
      die(EXIT_IO, "out of memory");
    if (status != GSL_SUCCESS)
      return expected("%s", o->unit);
  }
  return NULL;
}

/* The k-th choice's name, NULL after the last. */
static const char *const *choice(const struct option_spec *o, size_t k) {
  const size_t size = o->choice_size ? o->choice_size : sizeof *o->choices;
  return (const char *const *)((const char *)o->choices + k * size);
}

static const char *choice_help(const struct option_spec *o, size_t k) {
  return *(const char *const *)((const char *)choice(o, k) + o->choice_help);
}

const char *option_set(struct option_spec *o, const char *text) {
  double x;
  switch (o->type) {
  case OPTION_FLAG:
    *(bool *)o->value = true;
    return NULL;
  case OPTION_DOUBLE:
    if (!number_parse(text, &x) || !in_range(o, x))
      return range_text(o);
    *(double *)o->value = x;
    return NULL;
  case OPTION_SIZE:
    if (!number_parse(text, &x) || !in_range(o, x) || x != floor(x))
      return range_text(o);
    *(size_t *)o->value = (size_t)x;
    return NULL;
  case OPTION_TEXT:
    if (o->choices) {
      char list[160] = "one of";
      const char *const *c;
      for (size_t k = 0; *(c = choice(o, k)); k++) {
        if (!strcmp(*c, text)) {
          *(const char **)o->value = *c;
          return NULL;
        }
        strncat(list, " ", sizeof list - strlen(list) - 1);
        strncat(list, *c, sizeof list - strlen(list) - 1);
      }
      return expected("%s", list);
    }
    *(const char **)o->value = text;
    return NULL;
  case OPTION_LIST:
    return set_list(o, text);
  }
  return "a known type of option";
}

struct option_spec *option_find(struct option_spec *options, const char *name) {
  for (struct option_spec *o = options; o->name; o++)
    if (!strcmp(o->name, name))
      return o;
  return NULL;
}

void option_text(const struct option_spec *o, char *text, size_t size) {
  char number[NUMBER_SIZE];
  text[0] = 0;
  switch (o->type) {
  case OPTION_FLAG:
    snprintf(text, size, "%s", *(const bool *)o->value ? "yes" : "no");
    break;
  case OPTION_DOUBLE:
    number_format(*(const double *)o->value, number);
    snprintf(text, size, "%s", number);
    break;
  case OPTION_SIZE:
    snprintf(text, size, "%zu", *(const size_t *)o->value);
    break;
  case OPTION_TEXT:
    if (*(const char *const *)o->value)
      snprintf(text, size, "%s", *(const char *const *)o->value);
    break;
  case OPTION_LIST: {
    if (o->each)
      break;
    const struct option_list *list = o->value;
    for (size_t i = 0; i < list->count; i++) {
      number_format(list->at[i], number);
      const size_t used = strlen(text);
      snprintf(text + used, size - used, i ? ",%s" : "%s", number);
    }
    break;
  }
  }
}

static void print_choices(const struct option_spec *o) {
  if (o->choice_help)
    for (size_t k = 0; *choice(o, k); k++)
      printf("  %-18s   %-10s %s\n", "", *choice(o, k), choice_help(o, k));
  else {
    printf("  %-18s one of", "");
    for (size_t k = 0; *choice(o, k); k++)
      printf(" %s", *choice(o, k));
    putchar('\n');
  }
}

static void print_help(const struct program *p) {
  printf("Usage: %s %s\n%s\n\nOptions (defaults in brackets):\n", p->name,
         p->usage, p->summary);
  for (const struct option_spec *o = p->options; o->name; o++) {
    char head[80], value[128];
    const char *metavar = o->type == OPTION_FLAG   ? ""
                          : o->type == OPTION_TEXT ? " NAME"
                          : o->type == OPTION_SIZE ? " N"
                          : o->type == OPTION_LIST ? " LIST"
                                                   : " X";
    snprintf(head, sizeof head, "--%s%s", o->name, metavar);
    printf("  %-18s %s", head, o->help);
    if (o->unit && *o->unit)
      printf(", %s", o->unit);
    option_text(o, value, sizeof value);
    const bool unset =
        o->type == OPTION_DOUBLE && !in_range(o, *(const double *)o->value);
    if (unset)
      *value = 0;
    if (!*value && o->unset)
      o->unset(value, sizeof value);
    if (o->type != OPTION_FLAG && *value)
      printf(" [%s]", value);
    putchar('\n');
    if (o->choices)
      print_choices(o);
  }
  printf("  %-18s this text\n  %-18s name and version\n", "--help",
         "--version");
  printf("\nExit status: 0 done, 1 input/output, 2 usage, 3 bad input,\n"
         "4 the integration failed, 5 a limit was reached first.\n"
         "\nExample:\n  %s\n",
         p->example);
}

void finish_output(void) {
  const bool failed = ferror(stdout);
  if (fflush(stdout) != 0 || failed)
    die(EXIT_IO, "standard output: %s", strerror(errno));
}

enum { MOST_OPTIONS = 64, HELP = 1000, VERSION };

int options_parse(const struct program *p, int argc, char **argv) {
  program_name = p->name;
  gsl_set_error_handler_off();
  signal(SIGPIPE, SIG_IGN);
  /* A closed standard stream would be given to the next file opened. Read-only,
     so that writing to it still fails. */
  int fd;
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0)
    close(fd);
  size_t count = 0;
  while (p->options[count].name)
    count++;
  struct option table[MOST_OPTIONS + 3] = {{0}};
  if (count > MOST_OPTIONS)
    die(EXIT_IO, "internal error: %zu options", count);
  for (size_t i = 0; i < count; i++)
    table[i] = (struct option){.name = p->options[i].name,
                               .has_arg = p->options[i].type == OPTION_FLAG
                                              ? no_argument
                                              : required_argument,
                               .val = (int)i};
  table[count] = (struct option){.name = "help", .val = HELP};
  table[count + 1] = (struct option){.name = "version", .val = VERSION};
  argv[0] = (char *)p->name; /* getopt's messages begin as ours do */
  int found;
  while ((found = getopt_long(argc, argv, "", table, NULL)) != -1) {
    if (found == '?')
      exit(EXIT_USAGE);
    if (found == HELP) {
      print_help(p);
      finish_output();
      exit(EXIT_DONE);
    }
    if (found == VERSION) {
      printf("%s %s\n", p->name, DEM_VERSION);
      finish_output();
      exit(EXIT_DONE);
    }
    struct option_spec *o = &p->options[found];
    const char *want = option_set(o, optarg);
    if (want)
      die(EXIT_USAGE, "--%s %s: expected %s", o->name, optarg, want);
    o->given = true;
  }
  return optind;
}
