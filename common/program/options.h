/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options by name: tables that command lines (command_line.h), help (help.h)
   and the keys of a bed's header (scene_options.h) share. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include "files/numbers.h"
#include "model/similarity.h"
#include "platform/store.h"

enum option_type {
  OPTION_FLAG,   /* bool */
  OPTION_DOUBLE, /* double between least and most */
  OPTION_SIZE,   /* size_t between least and most */
  OPTION_TEXT,   /* const char *; one of choices where there are any */
  OPTION_LIST    /* struct option_list of between least and most numbers */
};

struct option_list {
  size_t count;
  double at[8];
};

struct option_spec {
  const char *name; /* without dashes */
  enum option_type type;
  void *value; /* holds the default until it is set */
  double least, most;
  /* NULL-terminated names; or those of a table of structs (OPTION_TABLE): bytes
     from one name to the next, and from a name to its help. */
  const char *const *choices;
  size_t choice_size, choice_help;
  const char *unit, *help;
  /* Text of --help for the default where the value is none; or NULL. */
  void (*unset)(char *text, size_t size);
  bool parameter; /* of the scene: stands in a bed's header */
  bool optional;  /* has no key in a header while it is 0 or without text */
  bool silent;    /* changes no byte of what is written: not in command_line */
  bool given;     /* set from the command line */
  /* Of a default that belongs to the paper's sphere: options_scale. */
  struct dimension dimension;
  /* For a repeatable option: called with every value instead of storing it. */
  int (*each)(const struct option_list *value, void *context);
  void *context;
};

/* Choices of an array of structs with members name and help, which ends with a
   NULL name. */
#define OPTION_TABLE(table)                                                    \
  .choices = &(table)->name, .choice_size = sizeof *(table),                   \
  .choice_help =                                                               \
      (size_t)((const char *)&(table)->help - (const char *)&(table)->name)

/* No limit: the largest count that an option can hold. */
#define OPTION_MANY NUMBER_MOST_WHOLE

/* Sets one option from text. NULL, or what was expected, in a static buffer of
   the calling thread's. */
const char *option_set(struct option_spec *o, const char *text);
struct option_spec *option_find(struct option_spec *options, const char *name);

/* The k-th choice's name, NULL after the last; and its help, NULL if there is
   none. */
const char *option_choice(const struct option_spec *o, size_t k);
const char *option_choice_help(const struct option_spec *o, size_t k);

/* Gives defaults with a dimension, of options that were not given, the value
   that they have for other spheres than the paper's. */
void options_scale(struct option_spec *options, const struct similarity *s);

/* Texts that options point to. */
struct option_texts {
  size_t count;
  char *at[32];
};
void option_texts_free(struct option_texts *t);

/* All values (platform/store.h), but for those with a function of their own
   (each). Options that were given stay as they are when the others are taken
   out; texts are then kept in t. */
void options_store(struct option_spec *options, struct option_texts *t,
                   struct store *s);

/* The value as text, as option_set reads it; numbers by number_format. */
void option_text(const struct option_spec *o, char *text, size_t size);
/* The default as --help shows it; empty if there is none to show. */
void option_default(const struct option_spec *o, char *text, size_t size);

#endif
