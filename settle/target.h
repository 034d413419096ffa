/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The option --target-fraction of settle: the friction with which a start
   settles to a fraction. Tested in tests/test_target.sh. */
#ifndef TARGET_H
#define TARGET_H

#include "files/bed_io.h"
#include "settings.h"

/* Looks for it by trial beds of the start b, sets it in the scene and in the
   header h, and says what was found. The fraction is the union in the bottom
   cube between the walls, as of analyze, at the end of the run. Exits with a
   message where options stand against it, no friction reaches it, or a trial
   fails. */
void target_take(struct settings *s, struct option_spec *options,
                 const struct bed *b, struct bed_header *h);

/* Says what the bed that was made has. */
void target_tell(const struct settings *s, const struct bed *b);

#endif
