#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What the compiler, its target and the libraries offer, as variables of make:
#   CC=gcc CFLAGS=... common/platform/probe.sh FILE
# writes FILE anew if the compiler, its flags or this script have changed since.
# Everything is asked of the compiler, nothing of the machine that this runs on,
# so that a cross compiler gets what fits its target. What is not there is left
# out and the build goes on without it.
set -u
file=$1
CC=${CC:-cc} CPPFLAGS=${CPPFLAGS:-} CFLAGS=${CFLAGS:-} LDFLAGS=${LDFLAGS:-}
version=$($CC --version 2>/dev/null | head -n 1)
key="# $CC ($version) $CPPFLAGS $CFLAGS $LDFLAGS"
# shellcheck disable=SC3013 # what every sh has
[ "$file" -nt "$0" ] && [ "$(head -n 1 "$file")" = "$key" ] && exit
if [ -z "$version" ]; then
  echo "$CC: no compiler by this name, expected one in CC" >&2
fi
mkdir -p "$(dirname "$file")"
T=$(mktemp -d) || exit 1
trap 'rm -rf "$T"' EXIT

links() { # FLAG...: a program of nothing, or the one in $source
  printf %s "$source" >"$T/a.c"
  # shellcheck disable=SC2086 # flags are words
  $CC $CPPFLAGS $CFLAGS -Werror "$T/a.c" -o "$T/a" $LDFLAGS "$@" \
    >/dev/null 2>&1
}
nothing="int main(void) { return 0; }"
source=$nothing
first() { # the first of some lists of flags that the compiler takes
  for flags in "$@"; do
    # shellcheck disable=SC2086
    if links $flags; then
      echo "$flags"
      return
    fi
  done
}

# Instruction sets that the kernel is compiled for, each with its flags; older
# compilers know the levels' parts only.
# shellcheck disable=SC2086
target=$($CC $CFLAGS -dumpmachine 2>/dev/null)
kernels=native v3='' v4=''
case $target in
x86_64-* | amd64-*)
  parts='-mavx2 -mbmi -mbmi2 -mf16c -mfma -mlzcnt -mmovbe'
  kernels='x86_64 x86_64_v3 x86_64_v4'
  v3=$(first -march=x86-64-v3 "$parts")
  v4=$(first '-march=x86-64-v4 -mprefer-vector-width=512' \
    "$parts -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl")
  ;;
esac

# OpenMP: threads; without it the loops' vector pragmas alone.
source="#include <omp.h>
int main(void) { return omp_get_num_procs() < 1; }"
openmp=$(first -fopenmp)
# It may link and not load (a compiler for another C library, musl-gcc). That is
# seen where programs of this compiler run at all.
if [ -n "$openmp" ] && ! "$T/a" >/dev/null 2>&1; then
  source=$nothing
  links && "$T/a" >/dev/null 2>&1 && openmp=
fi
source=$nothing
simd=$(first -fopenmp-simd -Wno-unknown-pragmas)
# glibc's vector exponential, which gcc finds by its declaration, clang by name
libmvec='' veclib=''
source='#include <stdlib.h>
#ifndef __GLIBC__
#error "another C library"
#endif
int main(void) { return 0; }'
if links -lmvec; then
  libmvec=-lmvec
  [ "$kernels" = native ] || veclib=$(first -fveclib=libmvec)
fi
source=$nothing quiet=
for flag in -Wno-psabi -Wno-pass-failed -Wno-string-conversion; do
  [ "$kernels" = native ] && [ $flag = -Wno-psabi ] && continue
  # gcc takes any -Wno-; -W tells
  links "-W${flag#-Wno-}" && quiet="$quiet $flag"
done

# GSL, from whoever knows where it is
gsl_cflags='' gsl_libs='-lgsl -lgslcblas -lm'
if ${PKG_CONFIG:-pkg-config} --exists gsl >/dev/null 2>&1; then
  gsl_cflags=$(${PKG_CONFIG:-pkg-config} --cflags gsl)
  gsl_libs=$(${PKG_CONFIG:-pkg-config} --libs gsl)
elif command -v gsl-config >/dev/null 2>&1; then
  gsl_cflags=$(gsl-config --cflags)
  gsl_libs=$(gsl-config --libs)
fi

cat >"$file" <<END
$key
KERNELS := $kernels
MARCH_x86_64 := -march=x86-64
MARCH_x86_64_v3 := $v3
MARCH_x86_64_v4 := $v4
LIBMVEC := $libmvec
VECLIB := $veclib
FOUND_QUIET :=$quiet
FOUND_OPENMP := $openmp
FOUND_SIMD := $simd
FOUND_GSL_CFLAGS := $gsl_cflags
FOUND_GSL_LIBS := $gsl_libs
END
