/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/integration.h"

#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "files/numbers.h"
#include "program/messages.h"

/* Most spheres for a method with a dense Jacobian: the cost of solving its
   system grows as n^3. */
enum { DENSE_SPHERES = 64 };

/* The control of most methods, then the methods that differ. */
void integration_control_unset(char *text, size_t size) {
  const struct integrate_control *usual = integrate_methods->control;
  size_t used = (size_t)snprintf(text, size, "%s", usual->name);
  for (const struct integrate_method *m = integrate_methods; m->name; m++)
    if (m->control != usual && used < size)
      used += (size_t)snprintf(text + used, size - used, "; %s for %s",
                               m->control->name, m->name);
}

void integration_tol_unset(char *text, size_t size) {
  char number[NUMBER_SIZE];
  size_t used = 0;
  for (const struct integrate_control *c = integrate_controls; c->name; c++)
    if (used < size) {
      number_format(c->tol, number);
      used += (size_t)snprintf(text + used, size - used, "%s%s for %s",
                               used ? "; " : "", number, c->name);
    }
}

void integration_check(const struct integrate_options *o, size_t spheres) {
  const struct integrate_method *m = integrate_method(o->method);
  const struct integrate_control *c = integrate_control(o->control);
  if (!m->type && c != m->control)
    die(EXIT_USAGE, "--method %s: expected --control %s", m->name,
        m->control->name);
  if (m->type && !c->alloc && !(o->step > 0))
    die(EXIT_USAGE, "--control %s: not for --method %s", c->name, m->name);
  if (!m->type && o->reltol > 0)
    die(EXIT_USAGE, "--method %s: has no relative tolerance", m->name);
  if (!m->fixed && o->step > 0)
    die(EXIT_USAGE, "--method %s: has no fixed step", m->name);
  if (m->jacobian && spheres > DENSE_SPHERES)
    die(EXIT_USAGE,
        "--method %s: %zu spheres, expected at most %d (each step solves a "
        "dense system)",
        m->name, spheres, DENSE_SPHERES);
  if (!m->estimates && !(o->step > 0))
    die(EXIT_USAGE, "--method %s: expected a fixed --step", m->name);
}

const char *integration_error(const struct integrate_options *o, int status) {
  if (status == GSL_ENOMEM)
    return "out of memory";
  if (status != GSL_FAILURE)
    return gsl_strerror(status);
  return o->step > 0 ? "forces overflow with this --step"
                     : "no step is short enough for the tolerance";
}
