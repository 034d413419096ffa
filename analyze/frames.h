/* What every verb does with its operand: read frames until the end. */
#ifndef FRAMES_H
#define FRAMES_H

#include "bed_io.h"

struct frames {
  FILE *in;
  struct bed_reader *reader;
};

/* Opens the one operand from argv[first], or standard input. Exits with one
   line on an error. */
void frames_open(struct frames *f, int argc, char **argv, int first,
                 bool allow_partial);

/* The next frame, which takes the place of b's last one. False at the end;
   exits with one line on bad input. */
bool frames_next(struct frames *f, struct bed *b);

void frames_close(struct frames *f);

#endif
