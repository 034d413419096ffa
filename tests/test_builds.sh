#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The questions of make to the compiler, and its use of variables that a user
# sets. Nothing is built here: `make -n` tells, and compilers are scripts that
# answer.
. tests/harness.sh

plan() { # ARGUMENT...: what make would do, in a place of its own
  rm -rf "$T/b"
  env -u MAKEFLAGS -u MAKELEVEL make -n B="$T/b" "$@" 2>"$T/err" ||
    fail "make -n $*" >&2
}
probed() { # VARIABLE: what was found
  sed -n "s/^$1 := *//p" "$T/b/config.mk"
}
# a compiler for another machine: it says so, and links anything
compiler() { # NAME TARGET REFUSED: a pattern of what it does not know
  printf '#!/bin/sh\ncase "$*" in --version) echo %s; exit;;\n*-dumpmachine*)
echo %s; exit;;\n%s) exit 1;; esac\n' "$1" "$2" "$3" >"$T/$1"
  chmod +x "$T/$1"
}

plan CC='my-cc -x' AR=my-ar CPPFLAGS=-DPRE CFLAGS=-O7 LDFLAGS=-Wl,post \
  GSL_CFLAGS=-Igsl GSL_LIBS=-Lgsl >"$T/plan"
objects=$(grep -c -e '-MD -MP\|-MMD -MP' "$T/plan")
check 'CC, CPPFLAGS, CFLAGS, GSL_CFLAGS in every compilation' test \
  "$(tr -d '\\\n' <"$T/plan" | grep -o 'my-cc -x [^;]*' | wc -l)" -ge 1 -a \
  "$(grep -c '^my-cc -x -std=.* -Igsl .*-DPRE -O7' "$T/plan")" -ge "$objects"
check 'LDFLAGS and GSL_LIBS where programs are linked' test \
  "$(grep -c -e '^my-cc .*-DPRE -O7 -Wl,post .*libdem.a -Lgsl' "$T/plan")" = 3
check 'AR makes the library' test "$(grep -c '^my-ar rcs' "$T/plan")" = 1
check 'no other compiler' test -z "$(grep -E '^(gcc|cc|ar|clang) ' "$T/plan")"
check 'CC of the environment' test \
  "$(CC=env-cc plan | grep -c '^env-cc .*-c ')" -gt 30
check 'OPENMP= has no threads' test \
  "$(plan OPENMP= | grep -c -e '-fopenmp ')" = 0

# The target decides, not the machine, nor a variable that others use.
for target in x86_64-linux-gnu amd64-unknown-freebsd14; do
  compiler cross "$target" '*nothing*'
  plan CC="$T/cross" ARCH=amd64 >"$T/plan"
  check "$target: three kernels" test "$(probed KERNELS)" = \
    'x86_64 x86_64_v3 x86_64_v4'
done
compiler old x86_64-linux-gnu '*x86-64-v*|*-lmvec*|*-fopenmp*'
plan CC="$T/old" >"$T/plan"
check 'a compiler without levels: their parts' test \
  "$(grep -c -e '-mavx2 .*KERNEL_ISA=x86_64_v[34]' "$T/plan")" = 2
check 'neither OpenMP nor libmvec where they are missing' test \
  "$(grep -c -e -fopenmp -e lmvec "$T/plan")" = 0
compiler arm aarch64-linux-gnu '*nothing*'
plan CC="$T/arm" ARCH=x86_64 >"$T/plan"
check 'another processor: one kernel' test "$(probed KERNELS)" = native -a \
  "$(grep -c 'KERNEL_ISA=' "$T/plan")" = 1
check 'and no flags of x86-64' test "$(grep -c -e -march= "$T/plan")" = 0

# GSL where pkg-config says, or gsl-config, or the compiler.
mkdir "$T/bin"
for tool in bash sh env make mktemp cat dirname mkdir head rm sed cmp echo \
  find expand awk gcc as ld tr chmod printf basename; do
  path=$(command -v $tool) && [[ $path == /* ]] && ln -s "$path" "$T/bin/$tool"
done
# shellcheck disable=SC2016 # for the script to expand
printf '#!/bin/sh\necho "-from-$(basename $0)$1"\n' \
  >"$T/gsl-config"
cp "$T/gsl-config" "$T/pkg-config"
chmod +x "$T/gsl-config" "$T/pkg-config"
PATH=$T/bin plan >/dev/null
check 'GSL without anybody who knows' test "$(probed FOUND_GSL_LIBS)" = \
  '-lgsl -lgslcblas -lm'
cp "$T/gsl-config" "$T/bin"
PATH=$T/bin plan >/dev/null
check 'GSL by gsl-config' test "$(probed FOUND_GSL_CFLAGS)" = \
  '-from-gsl-config--cflags'
cp "$T/pkg-config" "$T/bin"
PATH=$T/bin plan >/dev/null
check 'GSL by pkg-config, which goes first' grep -q -e '-from-pkg-config--libs' \
  "$T/b/config.mk"

# make 3.81 has no grouped targets, assignments by a shell, files or guile
# shellcheck disable=SC2046 # several files
check 'makefiles for make 3.81' test -z "$(grep -nE \
  '&:|::?:=|!=|\$\((file|guile|intcmp|let) |^\.ONESHELL' Makefile \
  $(find . -path ./build -prune -o -name '*.mk' -print))"
plan check-quick >"$T/plan"
check 'check-quick is without the long ones' test \
  "$(grep -c 'tests/run.sh.*test_cli' "$T/plan")" = 1 -a -z \
  "$(grep -E 'test_(figures|settling)\.sh' "$T/plan")"
check 'a target for help that needs no compiler' test \
  "$(plan help CC=/nonexistent | wc -l)" -gt 0 -a ! -e "$T/b/config.mk"
check_done
