/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/command_line.h"

#include <assert.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "program/begin.h"
#include "program/suggest.h"

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

static char *command; /* of the last options_parse */

const char *command_line(void) {
  return command ? command : program_name();
}

/* Words of a command line, less those that change no byte of what is written;
   getopt puts argv in order, these stay as they were given. */
struct words {
  int count;
  char **at;
};

static struct words keep_words(int argc, char **argv) {
  struct words w = {argc, malloc(((size_t)argc + 1) * sizeof *w.at)};
  if (!w.at)
    die(EXIT_IO, "out of memory");
  memcpy(w.at, argv, (size_t)argc * sizeof *w.at);
  return w;
}

static void leave_out(struct words *w, const char *word) {
  int kept = 0;
  for (int k = 0; k < w->count; k++)
    if (w->at[k] != word)
      w->at[kept++] = w->at[k];
  w->count = kept;
}

/* The program by its name instead of its path, then the verb. */
static void keep_command(struct words *w) {
  const int path = program_verb() ? 0 : 1;
  char *const rest = command_words(w->count - path, w->at + path);
  const size_t size = strlen(program_name()) + strlen(rest) + 2;
  free(command);
  command = malloc(size);
  if (!command)
    die(EXIT_IO, "out of memory");
  snprintf(command, size, "%s%s%s", program_name(), *rest ? " " : "", rest);
  free(rest);
  free(w->at);
}

int options_parse(const struct program *p, int argc, char **argv) {
  struct option table[MOST_OPTIONS + 3] = {{0}};
  size_t count = 0;
  program_begin(p->name, program_verb());
  for (; p->options[count].name; count++) {
    assert(count < MOST_OPTIONS);
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
  struct words words = keep_words(argc, argv);
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
    if (o->silent) {
      if (optarg && optarg == argv[optind - 1]) /* --name value */
        leave_out(&words, argv[optind - 2]);
      leave_out(&words, argv[optind - 1]);
    }
  }
  keep_command(&words);
  return optind;
}

/* As bash reads it back, in printable ASCII and without a quotation mark ("),
   whatever the word has: a line stays one, and any format can carry it. */
static char *quote(char *to, const char *word) {
  const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                       "0123456789-_=./,:+%@";
  const char special[] = "\"'\\?"; /* ?> would end an XML instruction */
  bool quoted = !*word, escaped = false;
  for (const char *c = word; *c; c++) {
    quoted = quoted || !strchr(plain, *c);
    escaped = escaped || *c < ' ' || *c > '~' || strchr(special, *c);
  }
  if (escaped)
    *to++ = '$';
  if (quoted)
    *to++ = '\'';
  for (; *word; word++) {
    if (*word < ' ' || *word > '~' || strchr(special, *word))
      to += sprintf(to, "\\%03o", (unsigned)(unsigned char)*word);
    else
      *to++ = *word;
  }
  if (quoted)
    *to++ = '\'';
  *to = 0;
  return to;
}

char *command_words(int argc, char *const argv[]) {
  size_t length = 1;
  for (int k = 0; k < argc; k++)
    length += 4 * strlen(argv[k]) + 4;
  char *const words = malloc(length), *at = words;
  if (!words)
    die(EXIT_IO, "out of memory");
  *at = 0;
  for (int k = 0; k < argc; k++) {
    if (k)
      *at++ = ' ';
    at = quote(at, argv[k]);
  }
  return words;
}
