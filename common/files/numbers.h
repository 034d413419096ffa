/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Numbers as text: parsed whole or not at all, and written so that they read
   back the same. Safe in any thread. Tested in tests/test_numbers.c. */
#ifndef NUMBERS_H
#define NUMBERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* 2^53: up to here a double holds every whole number. */
#define NUMBER_MOST_WHOLE 9007199254740992.0

/* Is x whole, and of a magnitude at which doubles still hold all of them? */
bool number_is_whole(double x);

/* The whole text as a finite number, without blanks around it. False, with
 *value untouched, if it is none. */
bool number_parse(const char *text, double *value);

enum { NUMBER_SIZE = 32 }; /* bytes that hold any number as text */

/* The fewest digits that read back as the same number: 0.4, not
   0.40000000000000002 as %.17g has it. */
void number_format(double x, char text[NUMBER_SIZE]);
/* The same of several to a stream, with a separator between them; errors stay
   in ferror(out). */
void numbers_write(FILE *out, char separator, size_t count, const double *x);

#endif
