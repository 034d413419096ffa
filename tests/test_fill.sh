#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# How settle fills a container: over an existing bed.
. tests/harness.sh

refused() { # STATUS WORDS COMMAND...: one line with these words, and no output
  "${@:3}" > "$T/out" 2> "$T/err"
  local status=$?
  check "status $status for $1: ${*:3}" [ "$status" -eq "$1" ]
  check "no '$2' in '$(head -n 1 "$T/err")': ${*:3}" grep -qF -- "$2" "$T/err"
  check "output without a bed: ${*:3}" [ ! -s "$T/out" ]
}
rows() { # of the first frame
  awk -F '\t' '/^id/ { on = 1; next } /^$/ { if (on) exit } /^#/ { next } on' "$1"
}
closest() { # the closest pair's distance by the sum of its radii; PX PY FILE:
  # periods, 0 for none
  rows "$3" | awk -v px="$1" -v py="$2" '
    { x[NR] = $2; y[NR] = $3; z[NR] = $4; r[NR] = $5 }
    function near(d, p) {
      if (d < 0) d = -d
      return p > 0 && d > p / 2 ? p - d : d
    }
    END { least = 99
      for (i = 1; i <= NR; i++)
        for (j = 1; j < i; j++) {
          d = sqrt(near(x[i] - x[j], px)^2 + near(y[i] - y[j], py)^2 + \
            (z[i] - z[j])^2) / (r[i] + r[j])
          if (d < least) least = d
        }
      print least }'
}
start="$B/settle --quiet --frames 2" # whose first frame is the start

# --- over an existing bed ----------------------------------------------------
$start --count 30 --time 1.5 --output "$T/frames.bed"
"$B/settle" --quiet --count 30 --time 1.5 > "$T/below.bed"
for from in below frames; do # the last frame of either
  $start --onto "$T/$from.bed" --count 20 --radius 0.08 --time 2 > "$T/onto.bed" \
    2> "$T/err"
  check "onto $from" [ $? -eq 0 ]
  check "onto $from: the old spheres as they were" cmp -s <(rows "$T/below.bed") \
    <(rows "$T/onto.bed" | head -n 30)
done
check 'time goes on' [ "$(grep -m 1 '^# t=' "$T/onto.bed")" = '# t=1.5' ]
check 'ids go on' cmp -s <(rows "$T/onto.bed" | cut -f 1) <(seq 0 49)
rows "$T/below.bed" | awk '{ if ($4 + $5 > top) top = $4 + $5 }
  END { printf "%.17g\n", top }' > "$T/top"
# the layers' lower edge is --drop above, 11 radii of the new ones
within 'new spheres are above the top' "$(rows "$T/onto.bed" | awk -v top="$(cat "$T/top")" \
  'NR > 30 { d = $4 - 1.25 * $5 - top; if (least == "" || d < least) least = d }
  END { print least }')" 0.88 0.9
check 'they are of one material' [ "$(rows "$T/onto.bed" | awk 'NR > 30 {
  d = $6 / ($5 / 0.1)^3 - 1; if (d < -1e-12 || d > 1e-12) n++ }
  END { print n + 0 }')" = 0 ]
within 'no overlaps of new ones' "$(closest 0 0 <(echo id; rows "$T/onto.bed" |
  tail -n 20))" 1 9
within '--drop is above the top' "$($start --onto "$T/below.bed" --count 1 --drop 0 \
  --jitter 0 --time 1.5 | awk -v top="$(cat "$T/top")" '$1 == 30 {
  print $4 - 1.25 * $5 - top; exit }')" -1e-12 1e-12
check 'walls and law go on' cmp -s \
  <(grep -E '^# (wall|base|model|kappa|f0)' "$T/below.bed") \
  <(sed '/^$/,$d' "$T/onto.bed" | grep -E '^# (wall|base|model|kappa|f0)')
check 'by default it has as long as a bed of its own' [ "$("$B/settle" --quiet \
  --onto "$T/below.bed" --count 1 --model basic | grep '^# t=')" = '# t=9.5' ]
"$B/settle" --quiet --scene "$T/onto.bed" --time 2.1 > /dev/null 2> "$T/err"
check 'it is a scene itself' [ $? -eq 0 ]
for walls in '--periodic xy --base 0.8,0.7' '--cylinder 0.3,0.2,0,0,0,1,0.35'; do
  # shellcheck disable=SC2086
  "$B/settle" --quiet $walls --count 20 --time 1 > "$T/below.bed"
  $start --onto "$T/below.bed" --count 25 --time 1.2 > "$T/onto.bed" 2> "$T/err"
  check "$walls: onto" [ $? -eq 0 ]
  check "$walls: walls go on" cmp -s <(grep -E '^# [wcpb].*=' "$T/below.bed" |
    grep -v count) <(sed '/^$/,$d' "$T/onto.bed" | grep -E '^# [wcpb].*=' |
    grep -v count)
done
# obstacles of a table without a header
printf 'x\ty\tz\tr\tfixed\n0.5\t0.5\t0.1\t0.1\t1\n0.2\t0.2\t0.1\t0.1\t0\n' > "$T/table.tsv"
$start --onto "$T/table.tsv" --base 0.6,0.6 --count 4 --wall 0,0,0,0,0,-1 --time 0.1 \
  > "$T/onto.bed" 2> "$T/err"
check 'onto obstacles: one stays' [ "$(awk '$NF == 1 && /^[0-9]/' "$T/onto.bed" |
  wc -l)" = 2 ]
refused 2 'no base=a,b in its header, expected --base' "$B/settle" --onto "$T/table.tsv"
refused 2 'has one, expected none beside --onto' "$B/settle" --onto "$T/below.bed" --base 1,1
refused 2 'expected no --scene beside it' "$B/settle" --onto "$T/below.bed" \
  --scene "$T/below.bed"
refused 2 'the start is at t=1 already' "$B/settle" --onto "$T/below.bed" --time 0.5
refused 2 'expected no --onto beside it' "$B/settle" --onto "$T/below.bed" \
  --target-fraction 0.6
refused 3 'no wider than a bead' "$B/settle" --onto "$T/below.bed" --radius 0.4
refused 2 'reaches up to' "$B/settle" --onto "$T/below.bed" --lid 1

check_done
