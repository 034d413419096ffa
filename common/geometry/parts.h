/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many connected parts a grid of solid and empty cells has: cells of one
   kind are connected where they share a face. Row by row, with memory for the
   runs of equal cells in a few layers, so that a grid may be of any height; not
   in the paper. One grid per thread. Tested in tests/test_parts.c. */
#ifndef PARTS_H
#define PARTS_H

#include <stdbool.h>
#include <stddef.h>

struct parts;

/* Layers of ny rows of nx cells, both at least 1. around[k]: along axis k the
   last cells meet the first ones again, as at periodic sides. GSL_ENOMEM. */
int parts_open(struct parts **p, size_t nx, size_t ny, const bool around[3]);

/* The next row; after ny of them comes the next layer. GSL_ENOMEM. */
int parts_row(struct parts *p, const bool *solid);

/* Parts of the whole layers so far, of which the last one then is the last of
   the grid: count[true] of solid cells, count[false] of empty ones. */
void parts_count(struct parts *p, size_t count[2]);

void parts_close(struct parts *p);

#endif
