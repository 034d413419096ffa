/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "platform/checksum.h"

struct checksum checksum_begin(void) {
  struct checksum c = {.rest = UINT32_MAX};
  for (uint32_t k = 0; k < 256; k++) {
    uint32_t rest = k;
    for (int bit = 0; bit < 8; bit++)
      rest = rest & 1 ? rest >> 1 ^ 0xEDB88320u : rest >> 1;
    c.table[k] = rest;
  }
  return c;
}

void checksum_add(struct checksum *c, const void *bytes, size_t count) {
  const unsigned char *at = bytes;
  uint32_t rest = c->rest;
  for (size_t k = 0; k < count; k++)
    rest = rest >> 8 ^ c->table[(rest ^ at[k]) & 255];
  c->rest = rest;
}

uint32_t checksum_value(const struct checksum *c) {
  return ~c->rest;
}
