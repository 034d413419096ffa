#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The house: rooms of common/ use the rooms below them and no others, nothing
# goes in circles, and only programs and their room print or exit.
. tests/harness.sh

# From the bottom up; rooms of one line do not know each other.
order='platform
geometry steppers
model
dynamics files measure
program'
rooms=$(tr '\n' ' ' <<<"$order")
check 'every room has its place' test \
  "$(ls common | sort | tr '\n' ' ')" = \
  "$(tr ' ' '\n' <<<"$rooms" | sed '/^$/d' | sort | tr '\n' ' ')"

# include lines as FILE LINE INCLUDED
includes() { # FILE...
  awk '/^#include "/ {split($0, part, "\""); print FILENAME, FNR, part[2]}' "$@"
}
upward() { # FILE...: what is included from above, from beside, or without a room
  includes "$@" | awk -v order="$order" '
    BEGIN {
      levels = split(order, level, "\n")
      for (k = 1; k <= levels; k++) {
        n = split(level[k], name, " ")
        for (i = 1; i <= n; i++) height[name[i]] = k
      }
    }
    {split($1, at, "/"); from = at[2]
     to = $3; if (!sub("/.*", "", to)) to = "no room"
     if (from != to && !(height[to] && height[to] < height[from]))
       print $1 ":" $2 ": " from " includes " $3}'
}
silent() { # NAME OUTPUT: there is none
  check "$1: $2" test -z "$2"
}
silent 'common' "$(upward common/*/*.[ch])"
# the same on rooms that are wrong
mkdir -p "$T/common/model" "$T/common/files"
echo '#include "files/bed_io.h"' >"$T/common/model/a.c"
echo '#include "measure/radius.h"' >"$T/common/files/b.h"
echo '#include "c.h"' >"$T/common/files/c.c"
echo '#include "geometry/box.h"' >"$T/common/files/d.c"
check 'upward, beside and without a room are found' test \
  "$(cd "$T" && upward common/*/*.[ch] | wc -l)" = 3

# A module is NAME.c and NAME.h; a room's internal.h is of the module with the
# room's name. tsort says where there is a circle.
circles() { # FILE...
  includes "$@" | awk '{
    from = $1; sub("^common/", "", from); sub(/\.[ch]$/, "", from)
    to = $3; sub(/\.h$/, "", to)
    if (sub("/internal$", "", from)) from = from "/" from
    if (sub("/internal$", "", to)) to = to "/" to
    if (from != to) print from, to}' |
    tsort 2>&1 >/dev/null
}
silent 'circles' "$(circles common/*/*.[ch])"
mkdir "$T/common/x"
echo '#include "x/b.h"' >"$T/common/x/a.h"
echo '#include "x/c.h"' >"$T/common/x/b.c"
echo '#include "x/a.h"' >"$T/common/x/c.h"
check 'a circle through a source is found' test -n \
  "$(cd "$T" && circles common/x/*)"

# Programs use rooms and themselves.
silent 'from program to program' "$(includes {analyze,bounce,settle}/*.[ch] \
  {precision,stability}/*.[ch] | awk -v rooms="$rooms" '
  {n = split($3, part, "/"); split($1, at, "/")
   if (n == 1) {file = at[1] "/" $3; if ((getline line < file) < 0) print
                close(file)}
   else if (index(" " rooms, " " part[1] " ") == 0) print}')"

# Each header says all that it needs.
alone=$(for header in common/*/*.h; do
  printf '#include "%s"\ntypedef int nothing;\n' "${header#common/}" >"$T/h.c"
  ${CC:-gcc} -std=c11 -Icommon -Werror -fsyntax-only "$T/h.c" 2>&1 | head -n 1
done)
silent 'headers by themselves' "$alone"

# What a library must not do, by the symbols of its objects: end the process,
# use its streams, or how it ends.
forbidden='exit|_exit|_Exit|quick_exit|abort|atexit|stdin|stdout|stderr'
forbidden+='|(__)?v?printf(_chk)?|puts|putchar|perror|v?(err|warn)x?'
forbidden+='|signal|sigaction|raise'
used() { # ROOM...: forbidden symbols of its objects
  local room source objects=()
  for room; do
    for source in common/$room/*.c; do
      [[ -e $B/obj/${source%.c}.o ]] && objects+=("$B/obj/${source%.c}.o")
    done
    [[ $room != dynamics ]] || objects+=("$B/obj/common/dynamics/kernel_"*.o)
  done
  nm -A -u "${objects[@]}" | awk -v bad="^_?($forbidden)(@.*)?\$" '
    $NF ~ bad {print $1, $NF}'
}
library=${rooms/program/}
# shellcheck disable=SC2086 # several words
silent 'prints or exits' "$(used $library)"
check 'that of the programs does both' test \
  "$(used program | awk '{print $NF}' | sort -u |
    grep -cE '^_?(exit|stderr|puts|putchar)')" -ge 3
# shellcheck disable=SC2086
check 'every room has its objects' test \
  "$(for room in $rooms; do ls "$B/obj/common/$room/"*.o; done |
    wc -l)" -ge "$(ls common/*/*.c | wc -l)"

silent 'no SPDX line' "$(grep -L -m 1 SPDX-License-Identifier Makefile .ci/run \
  $(find {common,analyze,bounce,settle,precision,stability,sweep,plots,tests}/ -name \
    '*.[ch]' -o -name '*.sh' -o -name '*.awk' -o -name '*.gp' -o -name '*.mk'))"

# Headers say where they are tested.
missing() { # FILE...: tests that are named and not there
  grep -ohE 'tests/[a-z_0-9]+\.(c|sh)' "$@" | sort -u | while read -r test; do
    [[ -e $test ]] || echo "$test"
  done
}
silent 'a test that is named is there' "$(missing README.md CONTRIBUTING.md \
  docs/*.md Makefile {analyze,bounce,settle,precision,stability}/*.[ch] \
  common/*/*.[ch])"
echo '/* Tested in tests/test_none.c. */' >"$T/h.h"
check 'one that is not is found' test "$(missing "$T/h.h")" = tests/test_none.c
check_done
