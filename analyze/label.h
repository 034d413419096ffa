/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What made a picture, in the picture: as text chunk of a PNG, comment of a
   GIF, or instruction of an SVG, where viewers show it as a property or not at
   all. Tested in tests/test_provenance.sh. */
#ifndef LABEL_H
#define LABEL_H

#include <stdio.h>

/* Copies a picture and adds what origin_text says of it; files of other kinds
   are copied as they are. Errors stay in ferror of both. */
void label_copy(FILE *in, FILE *out, const char *text);

#endif
