/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/options.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "program/messages.h"

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
  struct option_list list = {0}; /* it goes into checkpoints as a whole */
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

/* The same but for blanks: headers have periodic=x y for xy. */
static bool is_choice(const char *choice, const char *text) {
  for (;; choice++, text++) {
    text += strspn(text, " ");
    if (*choice != *text || !*choice)
      return *choice == *text;
  }
}

static const char *set_choice(struct option_spec *o, const char *text) {
  char list[600] = "one of";
  const char *c;
  for (size_t k = 0; (c = option_choice(o, k)); k++) {
    if (is_choice(c, text)) {
      *(const char **)o->value = c;
      return NULL;
    }
    strncat(list, " ", sizeof list - strlen(list) - 1);
    strncat(list, c, sizeof list - strlen(list) - 1);
  }
  return expected("%s", list);
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
    if (o->choices)
      return set_choice(o, text);
    *(const char **)o->value = text;
    return NULL;
  case OPTION_LIST:
    return set_list(o, text);
  }
  return "a known type of option";
}

void options_scale(struct option_spec *options, const struct similarity *s) {
  for (struct option_spec *o = options; o->name; o++) {
    if (o->given)
      continue;
    const double factor = similarity_scale(s, o->dimension);
    if (o->type == OPTION_DOUBLE)
      *(double *)o->value *= factor;
    if (o->type == OPTION_LIST && o->value)
      for (size_t k = 0; k < ((struct option_list *)o->value)->count; k++)
        ((struct option_list *)o->value)->at[k] *= factor;
  }
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

void option_texts_free(struct option_texts *t) {
  for (size_t k = 0; k < t->count; k++)
    free(t->at[k]);
  t->count = 0;
}

/* A text that points to nothing is one that is not there. */
static void store_text_option(const struct option_spec *o, const char **value,
                              struct option_texts *t, struct store *s) {
  char *text = s->loads || !*value ? NULL : strdup(*value);
  if (!s->loads && *value && !text)
    store_fail(s, GSL_ENOMEM);
  store_text(s, &text);
  if (s->loads && store_status(s) == GSL_SUCCESS && text) {
    if (t->count == sizeof t->at / sizeof *t->at)
      store_fail(s, GSL_EINVAL);
    else
      t->at[t->count++] = text;
    struct option_spec choice = *o; /* one of the table's, not of the file's */
    choice.value = value;
    if (option_set(&choice, text))
      store_fail(s, GSL_EINVAL);
    return;
  }
  free(text);
}

/* Into a value of its own where the command line has one. */
static void store_option(const struct option_spec *o, struct option_texts *t,
                         struct store *s) {
  struct option_list list;
  double x;
  size_t n;
  bool flag;
  const char *text = NULL;
  const bool skip = s->loads && o->given;
  switch (o->type) {
  case OPTION_DOUBLE:
    store_double(s, skip ? &x : o->value);
    break;
  case OPTION_SIZE:
    store_size(s, skip ? &n : o->value);
    break;
  case OPTION_FLAG:
    store_flag(s, skip ? &flag : o->value);
    break;
  case OPTION_LIST:
    store_plain(s, skip ? &list : o->value, sizeof list);
    break;
  case OPTION_TEXT:
    store_text_option(o, skip ? &text : o->value, t, s);
    break;
  }
}

void options_store(struct option_spec *options, struct option_texts *t,
                   struct store *s) {
  store_part(s, "options");
  for (struct option_spec *o = options; o->name; o++)
    if (!o->each && o->value) {
      store_part(s, o->name);
      store_option(o, t, s);
    }
}
