/* SPDX-License-Identifier: GPL-2.0-or-later */
/* exp for loops that are vectorised: glibc's libmvec has vector variants of it,
   which math.h declares to gcc only under -ffast-math. clang is told of them by
   a flag (probe.sh); another C library has none. */
#ifndef VECTOR_EXP_H
#define VECTOR_EXP_H

#include <math.h>

#if defined __x86_64__ && defined __GLIBC__ && defined __GNUC__ &&             \
    !defined __clang__
#pragma omp declare simd notinbranch
double exp(double);
#endif

#endif
