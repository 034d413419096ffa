#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Packed files are read as what they hold: by name, from standard input, from a
# pipe, whatever they are called; and what is not whole is not taken. Run from
# the root of the repository; B is the directory of the programs.
. tests/harness.sh

"$B/settle" --count 300 --base 1,1 --time 0.1 --frames 3 --quiet >"$T/bed"
"$B/analyze" "$T/bed" >"$T/want"
"$B/settle" --scene "$T/bed" --time 0.12 --quiet >"$T/later"

for program in gzip xz zstd; do
  if ! command -v $program >/dev/null; then
    echo "skipped: $program is not installed"
    continue
  fi
  $program -qc "$T/bed" >"$T/packed"
  check "$program: packed" test "$(wc -c <"$T/packed")" -lt \
    "$(wc -c <"$T/bed")"
  "$B/analyze" "$T/packed" >"$T/got" 2>"$T/err"
  check "$program: a file" cmp -s "$T/want" "$T/got"
  "$B/analyze" <"$T/packed" >"$T/got" 2>"$T/err"
  check "$program: standard input" cmp -s "$T/want" "$T/got"
  cat "$T/packed" | "$B/analyze" - >"$T/got" 2>"$T/err"
  check "$program: a pipe" cmp -s "$T/want" "$T/got"
  { head -c 2 "$T/packed"; sleep 0.1; tail -c +3 "$T/packed"; } |
    "$B/analyze" >"$T/got" 2>"$T/err"
  check "$program: a slow pipe" cmp -s "$T/want" "$T/got"
  "$B/settle" --scene "$T/packed" --time 0.12 --quiet >"$T/got" 2>"$T/err"
  check "$program: a scene" cmp -s "$T/later" "$T/got"
  "$B/analyze" export --format positions --frame 0 "$T/packed" >"$T/got" \
    2>"$T/err"
  check "$program: one frame of it: status $?" test $? = 0 -a \
    "$(wc -l <"$T/got")" = 300
  # half of it: what is left out must not go without a word
  head -c $(($(wc -c <"$T/packed") / 2)) "$T/packed" >"$T/half"
  "$B/analyze" "$T/half" >"$T/got" 2>"$T/err"
  check "$program: half: status $?" test $? = 3 -a "$(wc -l <"$T/err")" = 1
  "$B/analyze" --allow-partial "$T/half" >"$T/got" 2>"$T/err"
  check "$program: half, allowed: status $?" test $? = 3
  check "$program: half: who says so" grep -q \
    "^analyze: $T/half: $program cannot unpack it whole" "$T/err"
  # a table has no end that is marked: its packing tells
  printf 'x,y,z,r\n%s' "$(yes '0.5,0.5,0.5,0.1' | head -n 9999)" |
    sed '$a\' | $program -qc >"$T/packed"
  head -c -6 "$T/packed" >"$T/half"
  "$B/analyze" "$T/half" >"$T/got" 2>"$T/err"
  check "$program: a table less its end: status $?" test $? = 3 -a \
    "$(wc -l <"$T/err")" = 1
  # not there
  PATH="$T" "$B/analyze" "$T/packed" >"$T/got" 2>"$T/err"
  check "$program: not installed: status $?" test $? = 1 -a ! -s "$T/got" -a \
    "$(grep -c "packed by $program, which cannot be run: No such" "$T/err")" = 1
done

# what only begins like a packed file, and what cannot be unpacked
printf '(x) y z r\n0 0 0 1\n' >"$T/round"
"$B/analyze" "$T/round" >"$T/got" 2>"$T/err"
check "a bracket first: status $?" test $? = 0
printf '\x28\xb5/\n' >"$T/almost"
"$B/analyze" "$T/almost" >"$T/got" 2>"$T/err"
check "three bytes of four: status $?" test $? = 3 -a \
  "$(LC_ALL=C grep -ac "$T/almost:1: .*expected a bed" "$T/err")" = 1
for bytes in '\x1f' '(' '(\xb5/'; do
  printf "$bytes" >"$T/short"
  "$B/analyze" "$T/short" >"$T/got" 2>"$T/err"
  check "a file of less bytes than a packed one: status $?" test $? = 3 -a \
    "$(LC_ALL=C grep -ac "$T/short:1: .*no end" "$T/err")" = 1
done
printf '\x1f\x8bnothing of the kind\n' >"$T/wrong"
timeout 20 "$B/analyze" "$T/wrong" >"$T/got" 2>"$T/err"
check "no gzip in spite of its bytes: status $?" test $? = 3
for bytes in 'PK\x03\x04 zip' 'BZh bzip2' '\xff\xfe UTF-16'; do
  printf "${bytes% *}\n" >"$T/other"
  "$B/analyze" "$T/other" >"$T/got" 2>"$T/err"
  check "${bytes#* }: status $?" test $? = 3 -a \
    "$(grep -c "$T/other:1: this is ${bytes#* }.*expected" "$T/err")" = 1
done
"$B/analyze" </dev/null >"$T/got" 2>"$T/err"
check "nothing: status $?" test $? = 3
check_done
