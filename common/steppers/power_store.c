/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steppers/power_store.h"

void power_store(struct power *p, size_t dim, struct store *s) {
  store_flag(s, &p->known);
  store_double(s, &p->length);
  store_double(s, &p->radius);
  store_size(s, &p->evaluations);
  store_doubles(s, p->direction, dim);
}
