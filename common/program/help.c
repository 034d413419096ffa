/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/help.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "program/messages.h"
#include "program/version.h"

static const struct {
  enum exit_code code;
  const char *means;
} statuses[] = {{EXIT_DONE, "done"},
                {EXIT_IO, "input, output or memory failed"},
                {EXIT_USAGE, "a mistake in the use"},
                {EXIT_INPUT, "bad input"},
                {EXIT_INTEGRATION, "the integration failed"},
                {EXIT_LIMIT, "a limit was reached first"}};

enum { STATUSES = sizeof statuses / sizeof *statuses };

static const struct verbs *verbs; /* set once */

void help_verbs(const struct verbs *v) {
  verbs = v;
}

static _Noreturn void done(void) {
  finish_output();
  exit(EXIT_DONE);
}

/* Whether this is the help of a program with verbs and not of one of them. */
static bool of_all_verbs(void) {
  return verbs && !program_verb();
}

/* The word that stands for the value. */
static const char *placeholder(const struct option_spec *o) {
  switch (o->type) {
  case OPTION_FLAG:
    return "";
  case OPTION_TEXT:
    return " NAME";
  case OPTION_SIZE:
    return " N";
  case OPTION_LIST:
    return " LIST";
  case OPTION_DOUBLE:
    break;
  }
  return " X";
}

/* --help. */

enum { HEAD = 18 }; /* columns of the options' names */

static void print_verb_list(void) {
  for (const struct verb *v = verbs->at; v->name; v++)
    printf("  %-*s %s\n", HEAD, v->name, v->summary);
}

static void print_option(const struct option_spec *o) {
  char head[80], value[128];
  snprintf(head, sizeof head, "--%s%s", o->name, placeholder(o));
  printf("  %-*s %s", HEAD, head, o->help);
  if (o->unit && *o->unit)
    printf(", %s", o->unit);
  option_default(o, value, sizeof value);
  if (*value)
    printf(" [%s]", value);
  putchar('\n');
  if (!o->choices)
    return;
  if (!o->choice_help)
    printf("  %-*s one of", HEAD, "");
  for (size_t k = 0; option_choice(o, k); k++)
    if (o->choice_help)
      printf("  %-*s   %-10s %s\n", HEAD, "", option_choice(o, k),
             option_choice_help(o, k));
    else
      printf(" %s", option_choice(o, k));
  if (!o->choice_help)
    putchar('\n');
}

void help_print(const struct program *p) {
  printf("Usage: %s %s\n%s\n", p->name, p->usage, p->summary);
  if (of_all_verbs()) {
    puts("\nVerbs, each with a --help of its own:");
    print_verb_list();
  }
  puts("\nOptions (defaults in brackets):");
  for (const struct option_spec *o = p->options; o->name; o++)
    print_option(o);
  printf("  %-*s this text\n  %-*s name and version\n\nExit status:", HEAD,
         "-h, --help", HEAD, "--version");
  for (size_t k = 0; k < STATUSES; k++)
    printf("%s %d %s", k ? k % 3 ? "," : ",\n " : "", (int)statuses[k].code,
           statuses[k].means);
  printf(".\n\nExample:\n  %s\n", p->example);
  done();
}

void help_print_version(const struct program *p) {
  printf("%s %s\n", p->name, DEM_VERSION);
  done();
}

void help_print_verbs(const struct verbs *v) {
  printf("Usage: %s VERB [OPTION...]\n%s\n\n"
         "Verbs, each with a --help of its own:\n",
         v->program, v->summary);
  print_verb_list();
  done();
}

/* The page for man. */

/* Text in which characters that mean something to roff are escaped. */
static void put_roff(const char *text, size_t length) {
  for (size_t k = 0; k < length; k++)
    switch (text[k]) {
    case '\\':
      fputs("\\e", stdout);
      break;
    case '-':
      fputs("\\-", stdout);
      break;
    case '\'':
      fputs("\\(aq", stdout);
      break;
    case '^':
      fputs("\\(ha", stdout);
      break;
    case '~':
      fputs("\\(ti", stdout);
      break;
    case '.':
      fputs(k ? "." : "\\&.", stdout);
      break;
    default:
      putchar(text[k]);
    }
}

static void put_text(const char *text) {
  put_roff(text, strlen(text));
}

/* Lines that are indented stay as they are, others are filled. */
static void put_paragraphs(const char *text) {
  bool kept = false;
  while (*text) {
    const size_t length = strcspn(text, "\n");
    if ((text[0] == ' ') != kept)
      puts(kept ? ".fi" : ".PP\n.nf");
    kept = text[0] == ' ';
    put_roff(text, length);
    putchar('\n');
    text += length + (text[length] == '\n');
  }
  if (kept)
    puts(".fi");
}

static void put_title(const char *program, const char *verb) {
  fputs(".TH ", stdout);
  for (const char *c = program; *c; c++)
    putchar(toupper((unsigned char)*c));
  if (verb)
    putchar('-');
  for (const char *c = verb ? verb : ""; *c; c++)
    putchar(toupper((unsigned char)*c));
  printf(" 1 \"\" \"dem %s\" \"Beds of settled spheres\"\n", DEM_VERSION);
}

/* One line: all up to the first full stop. */
static void put_first_sentence(const char *text) {
  for (; *text && !(text[0] == '.' && strchr(" \n", text[1])); text++)
    put_roff(*text == '\n' ? " " : text, 1);
}

static const char *verb_summary(void) {
  for (const struct verb *v = verbs->at; v->name; v++)
    if (!strcmp(v->name, program_verb()))
      return v->summary;
  return "";
}

static void put_option(const struct option_spec *o) {
  char value[128];
  fputs(".TP\n\\fB\\-\\-", stdout);
  put_text(o->name);
  printf("\\fR\\fI%s\\fR\n", placeholder(o));
  put_text(o->help);
  if (o->unit && *o->unit) {
    fputs(", ", stdout);
    put_text(o->unit);
  }
  option_default(o, value, sizeof value);
  if (*value) {
    fputs(". Default: ", stdout);
    put_text(value);
  }
  fputs(".\n", stdout);
  if (!o->choices)
    return;
  fputs(o->choice_help ? ".RS\n" : "One of", stdout);
  for (size_t k = 0; option_choice(o, k); k++) {
    fputs(o->choice_help ? ".IP \\fB" : k ? ", " : " ", stdout);
    put_text(option_choice(o, k));
    if (o->choice_help) {
      fputs("\\fR 11\n", stdout);
      put_text(option_choice_help(o, k));
      putchar('\n');
    }
  }
  fputs(o->choice_help ? ".RE\n" : ".\n", stdout);
}

void help_print_man(const struct program *p) {
  const char *verb = program_verb();
  put_title(p->name, verb);
  puts(".SH NAME");
  put_text(p->name);
  if (verb) {
    fputs("\\-", stdout);
    put_text(verb);
  }
  fputs(" \\- ", stdout);
  put_first_sentence(verb             ? verb_summary()
                     : of_all_verbs() ? verbs->summary
                                      : p->summary);
  printf("\n.SH SYNOPSIS\n\\fB%s\\fR ", p->name);
  put_text(p->usage);
  puts("\n.SH DESCRIPTION");
  put_paragraphs(p->summary);
  if (of_all_verbs()) {
    puts(".SH VERBS\nEach has a page of its own.");
    for (const struct verb *v = verbs->at; v->name; v++) {
      printf(".TP\n.BR %s\\-%s (1)\n", p->name, v->name);
      put_text(v->summary);
      putchar('\n');
    }
  }
  puts(".SH OPTIONS");
  for (const struct option_spec *o = p->options; o->name; o++)
    put_option(o);
  puts(
      ".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nThe options and their defaults.\n"
      ".TP\n\\fB\\-\\-version\\fR\nName and version.\n.SH EXIT STATUS");
  for (size_t k = 0; k < STATUSES; k++)
    printf(".TP\n%d\n%s\n", (int)statuses[k].code, statuses[k].means);
  puts(".SH EXAMPLE\n.nf");
  put_text(p->example);
  puts("\n.fi\n.SH SEE ALSO\n.BR bounce (1),\n.BR settle (1),\n"
       ".BR analyze (1)");
  done();
}

/* For a shell. */

void help_print_completion(const struct program *p) {
  if (of_all_verbs())
    for (const struct verb *v = verbs->at; v->name; v++)
      puts(v->name);
  for (const struct option_spec *o = p->options; o->name; o++) {
    static const char *const kinds[] = {[OPTION_FLAG] = "flag",
                                        [OPTION_DOUBLE] = "number",
                                        [OPTION_SIZE] = "number",
                                        [OPTION_TEXT] = "text",
                                        [OPTION_LIST] = "numbers"};
    printf("--%s\t%s\t", o->name, kinds[o->type]);
    for (size_t k = 0; o->choices && option_choice(o, k); k++)
      printf("%s%s", k ? " " : "", option_choice(o, k));
    putchar('\n');
  }
  puts("--help\tflag\t\n--version\tflag\t");
  done();
}
