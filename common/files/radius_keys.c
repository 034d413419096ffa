/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files/radius_keys.h"

#include <gsl/gsl_errno.h>
#include "files/numbers.h"

static const char dynamics_key[] = "radius_dynamics", why_key[] = "radius_keep";

int radius_rewrite(struct bed *b, struct bed_header *h, double r,
                   const char *why) {
  char text[NUMBER_SIZE];
  if (!why) {
    bed_header_remove(h, dynamics_key);
    bed_header_remove(h, why_key);
  } else {
    if (!bed_header_get(h, dynamics_key) && b->n) {
      number_format(b->r[0], text);
      if (bed_header_set(h, dynamics_key, text) != GSL_SUCCESS)
        return GSL_ENOMEM;
    }
    if (bed_header_set(h, why_key, why) != GSL_SUCCESS)
      return GSL_ENOMEM;
  }
  number_format(r, text);
  if (bed_header_set(h, "radius", text) != GSL_SUCCESS)
    return GSL_ENOMEM;
  for (size_t i = 0; i < b->n; i++)
    b->r[i] = r;
  return GSL_SUCCESS;
}

double radius_dynamics(const struct bed_header *h) {
  const char *text = bed_header_get(h, dynamics_key);
  double r;
  if (!text)
    return 0;
  return number_parse(text, &r) && r > 0 ? r : -1;
}
