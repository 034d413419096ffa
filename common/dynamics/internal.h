/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Members of struct dynamics, for the integrators of this room. */
#ifndef DYNAMICS_INTERNAL_H
#define DYNAMICS_INTERNAL_H

#include "dynamics/contact_list.h"
#include "dynamics/dynamics.h"
#include "dynamics/kernel.h"

struct dynamics {
  struct contact_list *list;
  const struct kernel *kernel;
  struct dynamics_options options;
  double evaluations; /* those of a part count as their share of contacts */
  double contacts;    /* evaluated */
};

#endif
