/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The memory of a struct power (platform/store.h), apart from its file, which
   other programs take with them. Tested in tests/test_checkpoint.sh. */
#ifndef POWER_STORE_H
#define POWER_STORE_H

#include "platform/store.h"
#include "steppers/power.h"

/* Of dim unknowns. */
void power_store(struct power *p, size_t dim, struct store *s);

#endif
