/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "memory.h"

#include "dynamics/row.h"
#include "platform/system.h"
#include "program/messages.h"

/* Of a sphere in a bed, a contact list and a watch (bytes): measured, with 9
   contacts of it listed. What methods have beside that is in their table. */
static const double sphere_bytes = 300;

void memory_check(const struct settings *s, size_t spheres) {
  const struct integrate_method *m = integrate_method(s->integrate.method);
  const size_t stride = scene_has_rotation(&s->scene) ? ROW_SPIN : ROW_PLAIN;
  const double each =
      sphere_bytes + (double)(m->vectors * stride * sizeof(double));
  const double bytes = (double)spheres * each;
  const struct system_memory has = system_memory();
  char takes[SAY_BYTES_SIZE], may[SAY_BYTES_SIZE];
  say_bytes(bytes, takes);
  if (bytes > has.most) {
    say_bytes(has.most, may);
    die(EXIT_IO,
        "%zu spheres with --method %s take about %s of memory, %.2g kB each, "
        "and %s has %s: expected fewer spheres, or another method",
        spheres, m->name, takes, each / 1e3, has.by, may);
  }
  if (bytes > has.unused) {
    say_bytes(has.unused, may);
    warn("%zu spheres with --method %s take about %s of memory, and %s are "
         "free now: the run may be slow, or be ended",
         spheres, m->name, takes, may);
  }
}
