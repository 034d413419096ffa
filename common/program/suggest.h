/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The word that a mistyped one may have meant. */
#ifndef SUGGEST_H
#define SUGGEST_H

#include <stddef.h>

/* The name that the fewest mistakes turn into the word: a letter left out,
   added or changed, or two exchanged; at most two, and less than half of the
   letters. Three letters and more that begin a name are one mistake. NULL if
   there is none. Tested in tests/test_habits.sh. */
const char *suggest(const char *word, const char *const names[], size_t count);

#endif
