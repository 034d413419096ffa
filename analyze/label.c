/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "label.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "platform/checksum.h"

/* Copies at most count bytes. */
static void copy(FILE *in, FILE *out, size_t count) {
  char part[1 << 14];
  size_t n = 1;
  for (; count > 0 && n > 0 && !ferror(out); count -= n) {
    n = fread(part, 1, count < sizeof part ? count : sizeof part, in);
    fwrite(part, 1, n, out);
  }
}

static void put_number(FILE *out, uint32_t x) { /* most significant first */
  for (int k = 24; k >= 0; k -= 8)
    fputc((int)(x >> k & 255), out);
}

/* PNG, "tEXt": a keyword, a zero, the text. Behind the header, IHDR. */
enum { PNG_HEAD = 8 + 12 + 13 };

static void put_png(FILE *out, const char *text) {
  static const char head[] = "tEXtComment"; /* and the zero */
  struct checksum sum = checksum_begin();
  checksum_add(&sum, head, sizeof head);
  checksum_add(&sum, text, strlen(text));
  put_number(out, (uint32_t)(sizeof head - 4 + strlen(text)));
  fwrite(head, 1, sizeof head, out);
  fputs(text, out);
  put_number(out, checksum_value(&sum));
}

/* GIF: an extension of parts of at most 255 bytes, behind the screen and its
   colours. */
enum { GIF_SCREEN = 13, GIF_PART = 255 };

static size_t gif_colours(const unsigned char *screen) {
  const int flags = screen[10];
  return flags & 0x80 ? (size_t)3 << ((flags & 7) + 1) : 0;
}

static void put_gif(FILE *out, const char *text) {
  fputs("\x21\xfe", out);
  for (size_t left = strlen(text), n; left > 0; left -= n, text += n) {
    n = left < GIF_PART ? left : GIF_PART;
    fputc((int)n, out);
    fwrite(text, 1, n, out);
  }
  fputc(0, out);
}

/* SVG: an instruction of XML, behind the line that says so. What is quoted as
   command_words does cannot end it. */
static void put_svg(FILE *out, const char *text) {
  fprintf(out, "<?origin\n%s?>\n", text);
}

static void copy_line(FILE *in, FILE *out) {
  for (int c = 0; c != '\n' && (c = fgetc(in)) != EOF;)
    fputc(c, out);
}

void label_copy(FILE *in, FILE *out, const char *text) {
  unsigned char head[GIF_SCREEN] = {0};
  const size_t got = fread(head, 1, sizeof head, in);
  fwrite(head, 1, got, out);
  if (!memcmp(head, "\x89PNG\r\n\x1a\n", 8)) {
    copy(in, out, PNG_HEAD - got);
    put_png(out, text);
  } else if (!memcmp(head, "GIF89a", 6)) {
    copy(in, out, gif_colours(head));
    put_gif(out, text);
  } else if (!memcmp(head, "<?xml ", 6)) {
    copy_line(in, out);
    put_svg(out, text);
  }
  copy(in, out, SIZE_MAX);
}
