#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What cppcheck, clang-tidy and gcc -fanalyzer find in the library and the
# programs, less what was looked at and is right (below and in .clang-tidy, each
# with its reason). A finding that is not listed fails, and so does an entry of
# the list that nothing finds any more. Run from the root by `make tidy`.
set -u
T=$(mktemp -d) || exit 1
trap 'rm -rf "$T"' EXIT
sources=$(ls common/*/*.c {analyze,bounce,settle,precision,stability}/*.c)
flags='-std=c11 -Icommon -fopenmp'

# TOOL CHECK FILE: why it is right
cat >"$T/right" <<'END'
cppcheck invalidPointerCast analyze/write_voxels.c: one buffer, of either type
cppcheck IOWithoutPositioning common/platform/store.c: a stream has one direction
clang-tidy clang-analyzer-unix.Malloc settle/checkpoint.c: a store that saves fills nothing
fanalyzer -Wanalyzer-malloc-leak settle/checkpoint.c: a store that saves fills nothing
fanalyzer -Wanalyzer-malloc-leak common/program/files.c: litter keeps the name of a folder
clang-tidy clang-analyzer-core.NullDereference analyze/hard.c: that status is of two beds or more
fanalyzer -Wanalyzer-null-dereference analyze/hard.c: that status is of two beds or more
cppcheck legacyUninitvar common/dynamics/rates.c: an array that a call fills
cppcheck uninitvar analyze/measure.c: an array that a call fills
cppcheck uninitvar common/program/unpack.c: is filled up to its count
cppcheck memleak common/files/bed_reader.c: the text is kept with its line
clang-tidy bugprone-integer-division common/model/fill.c: a column of a grid is a whole number
clang-tidy bugprone-sizeof-expression common/files/formats.c: a table of pointers
clang-tidy bugprone-sizeof-expression precision/precision.c: a table of pointers
clang-tidy clang-analyzer-core.CallAndMessage analyze/export.c: each format has one of two functions
clang-tidy clang-analyzer-core.UndefinedBinaryOperatorResult common/files/bed_reader.c: is set where the call before succeeds
clang-tidy clang-analyzer-core.uninitialized.Assign common/geometry/volume.c: is set where a cell has an edge
clang-tidy misc-no-recursion common/geometry/area.c: by size of sphere, as deep as sizes differ
clang-tidy misc-no-recursion common/geometry/clearance.c: halves boxes down to a level
clang-tidy clang-analyzer-unix.Malloc common/program/files.c: litter keeps the name of a folder
clang-tidy misc-no-recursion common/geometry/voxels.c: halves boxes of voxels down to one
fanalyzer -Wanalyzer-malloc-leak common/files/bed_io.c: the texts are kept in a key of the header
fanalyzer -Wanalyzer-malloc-leak analyze/table.c: the text is kept in a cell
fanalyzer -Wanalyzer-null-dereference common/steppers/integrate.c: the name was checked at the entry
fanalyzer -Wanalyzer-double-free common/geometry/parts.c: two members of a struct
clang-tidy bugprone-not-null-terminated-result analyze/write_voxels.c: an ending with its zero comes after it
END

run_cppcheck() {
  # null pointers are left to the others: this one does not know that die() does
  # not return
  # shellcheck disable=SC2086 # several files
  cppcheck -q -j 2 --enable=warning,performance,portability --std=c11 -Icommon \
    --library=posix $(printf " --suppress=nullPointer%s" "" RedundantCheck \
      Arithmetic ArithmeticRedundantCheck) \
    --template='{file}:{line}: {message} [{id}]' \
    --suppress=missingIncludeSystem $sources 2>&1
}
run_clang_tidy() {
  # an index of an axis times 3 is no overflow; one of a sphere may be
  # shellcheck disable=SC2086
  xargs -n 4 -P 2 sh -c 'clang-tidy --quiet "$@" -- '"$flags"' 2>/dev/null' - \
    <<<"$sources" | sed -nE "s|^$PWD/||; s/ warning://p; s/ error:/&/p" |
    grep -v "type 'int'.*implicit-widening"
}
run_fanalyzer() {
  # it does not follow loops that fill arrays, so not uninitialized values
  # shellcheck disable=SC2016 # for sh
  xargs -n 1 -P 2 sh -c 'gcc '"$flags"' -O2 -Wno-psabi -fanalyzer \
    -Wno-analyzer-use-of-uninitialized-value -S -o /dev/null "$1" 2>&1' - \
    <<<"$sources" | sed -nE 's/ warning://p; s/ error:/&/p'
}

found=0 tools=0
for tool in cppcheck clang-tidy fanalyzer; do
  if [[ $tool != fanalyzer ]] && ! command -v $tool >/dev/null; then
    echo "$tool: not installed"
    found=$((found + 1))
    continue
  fi
  tools=$((tools + 1))
  "run_${tool/-/_}" | sort -u >"$T/said"
  # TOOL CHECK FILE of each, where the check's name is the last in brackets
  while read -r line; do
    check=$(grep -oE '\[[^][]*\]$' <<<"$line" | tr -d '[]')
    place="$tool ${check%%,*} ${line%%:*}:"
    if grep -Fq "$place" "$T/right"; then
      grep -F "$place" "$T/right" >>"$T/met"
    else
      echo "$tool: $line"
      found=$((found + 1))
    fi
  done <"$T/said"
done
if ((tools == 3)); then
  sort -u "$T/met" >"$T/met.sorted"
  while read -r line; do
    echo "found no more, to be taken from the list: $line"
    found=$((found + 1))
  done < <(sort "$T/right" | comm -23 - "$T/met.sorted")
fi
echo "$tools tools, $found findings"
((found == 0))
