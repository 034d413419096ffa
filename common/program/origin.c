/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "program/origin.h"

#include <stdbool.h>
#include <string.h>
#include "platform/system.h"
#include "program/command_line.h"
#include "program/messages.h"
#include "program/version.h"

const struct origin_style origin_comment = {"# ", "=", "\n", 0};
const struct origin_style origin_short = {"# ", "=", "\n", 230};
const struct origin_style origin_slashes = {"// ", "=", "\n", 0};
const struct origin_style origin_statistic = {"", "\t", "\n", 0};
const struct origin_style origin_attribute = {" ", "=\"", "\"", 0};

void origin_put(FILE *out, const struct origin_style *s, const char *name,
                const char *value) {
  const bool all = !s->most || strlen(value) <= (size_t)s->most;
  fprintf(out, "%s%s%s%.*s%s%s", s->before, name, s->between,
          all ? -1 : s->most - 3, value, all ? "" : "...", s->after);
}

void origin_write(FILE *out, const struct origin_style *s, const char *command,
                  const char *bed) {
  char build[SYSTEM_BUILD_SIZE];
  system_build(build);
  origin_put(out, s, "program", program_name());
  origin_put(out, s, "version", DEM_VERSION);
  origin_put(out, s, "build", build);
  origin_put(out, s, "command", command);
  if (bed)
    origin_put(out, s, "bed", bed);
}

void origin_write_xml(FILE *out, const char *bed) {
  fputs("<?origin", out);
  origin_write(out, &origin_attribute, command_line(), bed);
  fputs("?>\n", out);
}

char *origin_text(const char *bed) {
  static const struct origin_style line = {"", "=", "\n", 0};
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (out)
    origin_write(out, &line, command_line(), bed);
  if (!out || fclose(out) != 0)
    die(EXIT_IO, "out of memory");
  return text;
}

void origin_name(char *text, size_t size) {
  const char *verb = program_verb();
  snprintf(text, size, "%s%s%s " DEM_VERSION, program_name(), verb ? " " : "",
           verb ? verb : "");
}
