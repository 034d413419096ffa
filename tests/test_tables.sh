#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tables of analyze: several files, beds one behind the other, mean and
# standard error against awk's, numbers that are short and read back the same.
# Run from the root of the repository; B is the directory of the programs.
. tests/harness.sh

for seed in 1 2 3; do
  "$B/settle" --count 60 --base 0.8,0.8 --model basic --time 0.3 --frames 2 \
    --seed $seed --quiet >"$T/$seed"
done
cat "$T"/[123] >"$T/all"

verbs=('fraction' 'fraction --slab 0.2' 'profile --points 5' 'contacts'
  'contacts --degrees' 'contacts --network --gap 0.01' 'rest' 'gr --bins 20'
  'order' 'order --spheres' 'radius --report' 'mixture' 'mixture --profile 3' 'mixture --close')
for verb in "${verbs[@]}"; do
  # several files: the rows of each, behind its name
  for f in 1 2 3; do
    "$B/analyze" $verb "$T/$f" 2>/dev/null |
      awk -v f="$T/$f" '!/^t/ && NF {print f "\t" $0}'
  done >"$T/want"
  "$B/analyze" $verb "$T"/[123] >"$T/got" 2>"$T/err"
  check "$verb: three files: status $?" test $? = 0
  check "$verb: rows of three files" cmp -s "$T/want" \
    <(grep -v '^file' "$T/got" | grep .)
  check "$verb: a column file first" test "$(head -c 7 "$T/got")" = $'file\tt\t'
  # the same in one: three beds
  "$B/analyze" $verb "$T/all" 2>/dev/null | awk '!/^t/ && NF' >"$T/got"
  check "$verb: beds one behind the other" cmp -s <(cut -f 2- "$T/want") \
    "$T/got"
done

# two frames: one table, parts with an empty line between them, or blocks with
# names of their own and two empty lines, which gnuplot calls an index
while read -r names gaps verb; do
  # shellcheck disable=SC2086
  "$B/analyze" $verb "$T/1" 2>/dev/null >"$T/got"
  check "$verb: names in $names places" test "$(grep -c '^t' "$T/got")" = "$names"
  check "$verb: $gaps empty lines" test "$(grep -c '^$' "$T/got")" = "$gaps"
done <<'END'
1 0 fraction
1 0 contacts
1 1 fraction --slab 0.2
1 1 profile --points 5
2 2 contacts --degrees
2 2 gr --bins 20
END

# mean and standard error: the k-th rows of all beds
mean() { # VERB: from the table without --mean; rows of beds that have as many
  awk -F '\t' '
    /^file/ {columns = NF; next}
    NF {if ($1 != file) {file = $1; row = 0; beds++}
      row++
      for (c = 2; c <= NF; c++) x[row, c, beds] = $c}
    function word(s) {return s ~ /^[a-z]/ && s != "nan"}
    function se(r, c,  b, m, s) {
      for (b = 1; b <= beds; b++) m += x[r, c, b] / beds
      for (b = 1; b <= beds; b++) s += (x[r, c, b] - m) ^ 2
      average = m
      return sqrt(s / (beds - 1) / beds)}
    END {
      for (r = 1; r <= row; r++) {
        line = "mean"
        for (c = 2; c <= columns; c++) {se(r, c)
          line = line "\t" (word(x[r, c, 1]) ? x[r, c, 1] : average)}
        print line}
      for (r = 1; r <= row; r++) {
        line = "standard_error"
        for (c = 2; c <= columns; c++)
          line = line "\t" (word(x[r, c, 1]) ? x[r, c, 1] : se(r, c))
        print line}
    }' OFMT=%.17g CONVFMT=%.17g
}
alike() { # FILE FILE: words alike, numbers to rounding of sums
  paste "$1" "$2" | awk -F '\t' '
    {if (NF % 2) bad = 1
     for (c = 1; c <= NF / 2; c++) {a = $c; b = $(c + NF / 2)
      if (a == b) continue
      if (a !~ /^[-+0-9]/ || b !~ /^[-+0-9]/) {bad = 1; continue}
      d = a - b; d = d < 0 ? -d : d
      s = (a < 0 ? -a : a) + (b < 0 ? -b : b)
      if (!(d <= 1e-9 * s + 1e-13)) bad = 1}}
    END {exit bad || !NR}'
}
for verb in 'fraction' 'fraction --slab 0.2' 'profile --points 5' 'gr --bins 20' \
  'order' 'order --spheres --margin 0' 'radius --report'; do
  "$B/analyze" $verb "$T"/[123] 2>/dev/null | mean | sed 's/-nan/nan/g' \
    >"$T/want"
  "$B/analyze" $verb --mean "$T"/[123] >"$T/got" 2>"$T/err"
  check "$verb --mean: status $?" test $? = 0
  grep -E '^(mean|standard_error)' "$T/got" >"$T/rows"
  check "$verb --mean" alike "$T/want" "$T/rows"
  "$B/analyze" $verb --mean "$T/all" 2>/dev/null |
    grep -E '^(mean|standard_error)' >"$T/rows"
  check "$verb --mean of beds in one file" alike "$T/want" "$T/rows"
done
# of one bed: over its frames
"$B/analyze" --mean "$T/1" >"$T/got" 2>/dev/null
check '--mean of one bed' awk '
  NR == 2 {a = $4} NR == 3 {b = $4}
  $1 == "mean" {m = $4} $1 == "standard_error" {s = $4}
  END {d = m - (a + b) / 2; e = s - (a > b ? a - b : b - a) / 2
    exit !(NR == 5 && d < 1e-15 && -d < 1e-15 && e < 1e-15 && -e < 1e-15)}' \
  "$T/got"
printf 'x,y,z,r\n.5,.5,.5,.1\n' >"$T/one"
"$B/analyze" --mean "$T/one" >"$T/got" 2>/dev/null
check 'one frame has no error' grep -q $'^standard_error\tnan\tnan\tnan$' \
  "$T/got"
"$B/analyze" --mean "$T/1" "$T/one" >"$T/got" 2>"$T/err"
check "beds of different length: status $?" test $? = 3 -a \
  "$(grep -c 'mean: beds differ' "$T/err")" = 1

# several files: errors name theirs, and a file is read once
"$B/analyze" "$T/1" "$T/none" >"$T/got" 2>"$T/err"
check "a file that is not there: status $?" test $? = 1 -a \
  "$(grep -c "$T/none: No such file" "$T/err")" = 1
head -n -1 "$T/2" >"$T/cut"
"$B/analyze" "$T/1" "$T/cut" >"$T/got" 2>"$T/err"
check "a file that is cut: status $?" test $? = 3 -a \
  "$(grep -c "$T/cut:.*status=ok" "$T/err")" = 1
# a cut bed with others behind it is found as well
cat "$T/1" "$T/cut" "$T/3" >"$T/some"
"$B/analyze" "$T/some" >"$T/got" 2>"$T/err"
check "a cut bed among others: status $?" test $? = 3 -a \
  "$(grep -c "$T/some:.*status=ok" "$T/err")" = 1
"$B/analyze" --allow-partial "$T/some" >"$T/got" 2>"$T/err"
check "allowed: status $?" test $? = 0 -a "$(wc -l <"$T/got")" = 7 -a \
  "$(grep -c 'cut short: 60 spheres of the last frame' "$T/err")" = 1
for verb in export draw movie radius; do
  "$B/analyze" $verb --format csv "$T/1" "$T/2" >"$T/got" 2>"$T/err"
  check "$verb: one file: status $?" test $? = 2
done

# short numbers
"$B/analyze" --slab 0.1 "$T/one" >"$T/got"
check 'no 0.30000000000000004 for a height' test \
  "$(sed -n 4p "$T/got" | cut -f 6,7)" = $'0.2\t0.30000000000000004'
check 'a bed has 0.1' grep -q $'\t0.1\t1\t' "$T/1"
check 'no number is longer than it must be' awk '
  {for (k = 1; k <= NF; k++) if ($k ~ /^[-+0-9.e]+$/) {
    if (length($k) > 24 || $k ~ /\.[0-9]*0$/) bad = 1}} END {exit bad}' "$T/1"
check_done
