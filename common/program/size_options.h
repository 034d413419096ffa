/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sizes as the options --sizes and --shares name them. Tested in
   tests/test_sizes.sh. */
#ifndef SIZE_OPTIONS_H
#define SIZE_OPTIONS_H

#include "model/sizes.h"

enum { SHARES_NUMBER, SHARES_VOLUME };
extern const char *const size_shares[]; /* names of them, then NULL */

/* uniform:R1,R2, normal:MEAN,SD, lognormal:MEDIAN,SIGMA,
   mix:R1*SHARE,R2*SHARE,... in radii (m), or sieve:FILE. A sieve's file has two
   numbers in a line: the mesh, a diameter (m), and what stays on it as a share
   of the volume; that lies between it and the next larger. Lines that begin
   with # and one line of names are skipped. shares: one of size_shares, NULL if
   not given. To be freed by sizes_free. Exits with one line that says what is
   wrong, with EXIT_USAGE or, in a file, EXIT_INPUT. */
struct sizes *sizes_of_options(const char *text, const char *shares);

#endif
