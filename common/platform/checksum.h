/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The CRC-32 of gzip, zlib and PNG (ISO 3309): it tells any change of up to 32
   bits in a row, and all but one in 2^32 of others. Safe in any thread. Tested
   in tests/test_store.c. */
#ifndef CHECKSUM_H
#define CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

struct checksum {
  uint32_t table[256]; /* of each byte */
  uint32_t rest;
};

struct checksum checksum_begin(void);
void checksum_add(struct checksum *c, const void *bytes, size_t count);
/* Of all bytes so far. */
uint32_t checksum_value(const struct checksum *c);

#endif
