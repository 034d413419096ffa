/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/options.h"

#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "program/help.h"
#include "program/suggest.h"

static const char *expected(const char *format, ...) {
  static _Thread_local char text[640];
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

/* Where the k-th choice's name is. */
static const char *const *choice(const struct option_spec *o, size_t k) {
  const size_t size = o->choice_size ? o->choice_size : sizeof *o->choices;
  return (const char *const *)((const char *)o->choices + k * size);
}

const char *option_choice(const struct option_spec *o, size_t k) {
  return *choice(o, k);
}

const char *option_choice_help(const struct option_spec *o, size_t k) {
  if (!o->choice_help)
    return NULL;
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
      char list[600] = "one of";
      const char *c;
      for (size_t k = 0; (c = option_choice(o, k)); k++) {
        if (!strcmp(c, text)) {
          *(const char **)o->value = c;
          return NULL;
        }
        strncat(list, " ", sizeof list - strlen(list) - 1);
        strncat(list, c, sizeof list - strlen(list) - 1);
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

void option_default(const struct option_spec *o, char *text, size_t size) {
  option_text(o, text, size);
  if (o->type == OPTION_FLAG ||
      (o->type == OPTION_DOUBLE && !in_range(o, *(const double *)o->value)))
    text[0] = 0;
  if (!*text && o->unset)
    o->unset(text, size);
}

enum { MOST_OPTIONS = 64, FIRST_OPTION = 1000 };

/* Why getopt_long did not take an argument, and what may have been meant. */
static _Noreturn void refuse(const struct option table[], char reason,
                             const char *argument) {
  if (reason == ':' || optopt >= FIRST_OPTION)
    die(EXIT_USAGE, "--%s: %s", table[optopt - FIRST_OPTION].name,
        reason == ':' ? "expected an argument" : "takes no argument");
  if (optopt)
    die(EXIT_USAGE, "-%c: no such option", optopt);
  const char *names[MOST_OPTIONS + 3];
  char word[64];
  size_t count = 0, begun = 0;
  snprintf(word, sizeof word, "%.*s", (int)strcspn(argument + 2, "="),
           argument + 2);
  for (; table[count].name; count++) {
    names[count] = table[count].name;
    begun += !strncmp(names[count], word, strlen(word));
  }
  if (begun > 1)
    die(EXIT_USAGE, "--%s: stands for several options", word);
  const char *meant = suggest(word, names, count);
  if (meant)
    die(EXIT_USAGE, "--%s: no such option; did you mean --%s?", word, meant);
  die(EXIT_USAGE, "--%s: no such option", word);
}

int options_parse(const struct program *p, int argc, char **argv) {
  struct option table[MOST_OPTIONS + 3] = {{0}};
  size_t count = 0;
  program_begin(p->name, program_verb());
  for (; p->options[count].name; count++) {
    if (count == MOST_OPTIONS)
      die(EXIT_IO, "internal error: more than %d options", MOST_OPTIONS);
    table[count] = (struct option){
        .name = p->options[count].name,
        .has_arg = p->options[count].type == OPTION_FLAG ? no_argument
                                                         : required_argument,
        .val = FIRST_OPTION + (int)count};
  }
  const int help = FIRST_OPTION + (int)count, version = help + 1;
  table[count] = (struct option){.name = "help", .val = help};
  table[count + 1] = (struct option){.name = "version", .val = version};
  if (argc > 1 && !strcmp(argv[argc - 1], "--man"))
    help_print_man(p);
  if (argc > 1 && !strcmp(argv[argc - 1], "--complete"))
    help_print_completion(p);
  opterr = 0;
  int found;
  while ((found = getopt_long(argc, argv, ":h", table, NULL)) != -1) {
    if (found == '?' || found == ':')
      refuse(table, (char)found, argv[optind - 1]);
    if (found == help || found == 'h')
      help_print(p);
    if (found == version)
      help_print_version(p);
    struct option_spec *o = &p->options[found - FIRST_OPTION];
    const char *want = option_set(o, optarg);
    if (want)
      die(EXIT_USAGE, "--%s %s: expected %s", o->name, optarg, want);
    o->given = true;
  }
  return optind;
}
