/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/suggest.h"

#include <string.h>

enum { LONGEST = 32 };

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

/* Letters left out, added, changed or exchanged with the next one (optimal
   string alignment). */
static size_t mistakes(const char *a, const char *b) {
  const size_t n = strlen(a), m = strlen(b);
  size_t d[LONGEST + 1][LONGEST + 1];
  for (size_t i = 0; i <= n; i++)
    for (size_t j = 0; j <= m; j++) {
      if (!i || !j) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = least(least(d[i - 1][j], d[i][j - 1]) + 1,
                      d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

const char *suggest(const char *word, const char *const names[], size_t count) {
  const size_t length = strlen(word);
  const char *best = NULL;
  size_t fewest = 3;
  for (size_t k = 0; k < count && length <= LONGEST; k++) {
    if (strlen(names[k]) > LONGEST)
      continue;
    size_t wrong = mistakes(word, names[k]);
    if (length >= 3 && !strncmp(word, names[k], length))
      wrong = least(wrong, 1);
    if (wrong < fewest && 2 * wrong < strlen(names[k])) {
      fewest = wrong;
      best = names[k];
    }
  }
  return best;
}
