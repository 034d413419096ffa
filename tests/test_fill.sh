#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# How settle fills a container: over an existing bed, at random, by rain.
. tests/harness.sh

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
  check "$walls: walls go on" cmp -s <(unsealed "$T/below.bed" |
    grep -E '^# [wcpb].*=' | grep -v count) <(sed '/^$/,$d' "$T/onto.bed" |
    unsealed | grep -E '^# [wcpb].*=' | grep -v count)
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

# --- at random and by rain ----------------------------------------------------
outside() { # how many spheres are not within the walls; HALF A B: of a tube about
  # (A, B), if HALF is 0 of a box of sides A and B, PX PY: which are periodic
  rows "$T/a.bed" | awk -v half="$1" -v a="$2" -v b="$3" -v px="${4:-0}" \
    -v py="${5:-0}" '
    function far(x, side, p) { return p ? x < 0 || x >= side : x < $5 || x > side - $5 }
    $4 < $5 { n++; next }
    half > 0 { if (sqrt(($2 - a)^2 + ($3 - b)^2) > half - $5 * (1 - 1e-8)) n++; next }
    far($2, a, px) || far($3, b, py) { n++ }
    END { print n + 0 }'
}
sizes=lognormal:0.05,0.4
for fill in random rain; do
  while IFS='|' read -r periods walls options; do
    # shellcheck disable=SC2086
    $start --fill $fill $options --time 1e-4 > "$T/a.bed" 2> "$T/err"
    check "$fill $options" [ $? -eq 0 ]
    # shellcheck disable=SC2086
    within "$fill $options: closest" "$(closest $periods "$T/a.bed")" 1 1.5
    # shellcheck disable=SC2086
    within "$fill $options: outside" "$(outside $walls)" 0 0
    # shellcheck disable=SC2086
    check "$fill $options: another seed" [ "$($start --fill $fill $options --time 1e-4 \
      --seed 7 | grep -m 1 -A 1 '^id')" != "$(grep -m 1 -A 1 '^id' "$T/a.bed")" ]
  done << END
0 0|0 1 1|--count 150
0.8 0.7|0 0.8 0.7 1 1|--count 120 --periodic xy --base 0.8,0.7
0.8 0|0 0.8 0.4 1 0|--count 60 --periodic x --base 0.8,0.4
0 0|0.35 0.3 0.2|--count 60 --cylinder 0.3,0.2,0,0,0,1,0.35
0 0|0.15 0 0|--count 20 --cylinder 0,0,0,0,0,1,0.15
0 0|0 0.5 0.5|--count 150 --base 0.5,0.5 --sizes $sizes
0 0|0 0.3 0.3|--count 60 --base 0.3,0.3
END
  $start --fill $fill --count 50 --time 1e-4 > "$T/a.bed"
  check "$fill: the same bits again" cmp -s "$T/a.bed" <($start --fill $fill \
    --count 50 --time 1e-4)
  check "$fill: lengths by 4" cmp -s <(rows "$T/a.bed" | awk '{ printf "%.17g\n%.17g\n%.17g\n",
    4 * $2, 4 * $3, 4 * $4 }') <($start --fill $fill --count 50 --time 1e-4 --radius 0.4 |
    rows /dev/stdin | awk '{ printf "%.17g\n%.17g\n%.17g\n", $2, $3, $4 }')
  check "$fill in the header" [ "$(grep -c "^# fill=$fill" "$T/a.bed")" = 1 ]
  check "$fill: nothing in the header that it has no use for" [ "$(grep -cE \
    '^# jitter=' "$T/a.bed")" = 0 ]
  "$B/settle" --quiet --fill $fill --count 50 --time 4 > "$T/below.bed" 2> "$T/err"
  check "$fill settles" [ $? -eq 0 ]
  "$B/analyze" contacts "$T/below.bed" > "$T/tsv"
  within "$fill: the floor carries it" "$(awk 'NR == 1 { for (k = 1; k <= NF; k++)
    at[$k] = k } NR == 2 { print $at["floor"] }' "$T/tsv")" 0.8 1.1
  "$B/settle" --quiet --scene "$T/below.bed" --time 4.01 > "$T/on.bed"
  check "$fill: the header goes on" [ "$(grep '^# fill=' "$T/on.bed")" = "# fill=$fill" ]
  $start --onto "$T/below.bed" --fill $fill --count 30 --time 4.01 > "$T/a.bed" 2> "$T/err"
  check "$fill onto a bed" [ $? -eq 0 ]
  check "$fill: the old spheres as they were" cmp -s <(rows "$T/below.bed") \
    <(rows "$T/a.bed" | head -n 50)
  within "$fill onto a bed: above" "$(rows "$T/a.bed" | awk '
    NR <= 50 && $4 + $5 > top { top = $4 + $5 }
    NR > 50 && (least == "" || $4 - $5 - top < least) { least = $4 - $5 - top }
    END { print least }')" 0 3
  refused 2 'found places between the walls' "$B/settle" --fill $fill --base 0.15,1
  refused 2 'found places between the walls' "$B/settle" --fill $fill --count 900 \
    --cylinder 0,0.5,2,1,0,0,0.5
  refused 2 "--jitter: has no use with --fill $fill" "$B/settle" --fill $fill --jitter 0.1
  refused 2 'makes a start, expected none beside --scene' "$B/settle" --fill $fill \
    --scene "$T/below.bed"
done
check 'no key that was not asked for' [ "$("$B/settle" --quiet --count 1 --time 0.1 |
  grep -cE '^# (fill|rate)=')" = 0 ]
check 'the grid by name is the grid' cmp -s \
  <("$B/settle" --quiet --count 9 --time 0.1 | unsealed) \
  <("$B/settle" --quiet --count 9 --time 0.1 --fill grid | unsealed |
    grep -v '^# fill=grid')
# the share of volume of the region
within 'share of random places' "$($start --fill random --count 400 --time 1e-4 |
  rows /dev/stdin | awk '{ z = $4; if (low == "" || z < low) low = z
    if (z > high) high = z; v += 4.18879 * $5^3 } END { print v / (high - low + 0.2) }')" \
  0.17 0.22

# rain: free fall from the start frame, by its own closed form
arrivals() { # FILE RATE LEVEL: errors of k / rate and of the one speed
  rows "$1" | awk -v rate="$2" -v level="${3:-0}" 'BEGIN { g = 9.81 }
    { h = $4 - $5 - level; u = -$9; v = sqrt(u * u + 2 * g * h); t = (v - u) / g
      d = t - NR / rate; if (d < 0) d = -d; if (d > late) late = d
      if (u < 0) up++
      if (NR == 1) first = v
      d = v - first; if (d < 0) d = -d; if (d > off) off = d }
    END { print (late < 1e-12 && off < 1e-11 && !up) ? "fine" : late " " off " " up }'
}
$start --fill rain --rate 90 --count 100 --time 1e-4 > "$T/a.bed"
check 'columns are those that are meant' grep -q \
  "^id	x	y	z	r	m	vx	vy	vz" "$T/a.bed"
check "rain at its rate: $(arrivals "$T/a.bed" 90)" [ "$(arrivals "$T/a.bed" 90)" = fine ]
check 'the rate in the header' grep -qx '# rate=90' "$T/a.bed"
# by default as slow as can be: rate^2 = g n / d, d = 4/3 pi r^3 / 0.2
$start --fill rain --count 100 --time 1e-4 > "$T/a.bed"
rate=$(awk 'BEGIN { printf "%.17g", sqrt(9.81 * 100 / (4 / 3 * atan2(0, -1) * 1e-3 / 0.2)) }')
check "the default rate: $(arrivals "$T/a.bed" "$rate")" \
  [ "$(arrivals "$T/a.bed" "$rate")" = fine ]
# in a tube the area is the tube's
$start --fill rain --count 100 --cylinder 0,0,0,0,0,1,0.6 --time 1e-4 > "$T/a.bed"
rate=$(awk 'BEGIN { printf "%.17g", sqrt(9.81 * 100 / (4 / 3 * 1e-3 / 0.36 / 0.2)) }')
check "the default rate in a tube: $(arrivals "$T/a.bed" "$rate")" \
  [ "$(arrivals "$T/a.bed" "$rate")" = fine ]
# over a bed it arrives at its top, from the bed's time on
$start --onto "$T/below.bed" --fill rain --rate 70 --count 30 --time 4.01 > "$T/a.bed"
(echo id; rows "$T/a.bed" | tail -n 30) > "$T/new.tsv"
top=$(rows "$T/below.bed" | awk '{ if ($4 + $5 > top) top = $4 + $5 }
  END { printf "%.17g", top }')
check "rain onto a bed: $(arrivals "$T/new.tsv" 70 "$top")" \
  [ "$(arrivals "$T/new.tsv" 70 "$top")" = fine ]
# the run does as the start says: at 0.19 s the first is 0.01 s before the floor,
# at 0.25 s it has bounced
for at in 0.19 0.25; do
  "$B/settle" --quiet --fill rain --rate 5 --count 4 --base 4,4 --model basic \
    --time $at > "$T/a.bed"
  within "at $at s: when they arrive" "$(rows "$T/a.bed" | awk -v at=$at '{ u = -$9
    t = (sqrt(u * u + 2 * 9.81 * ($4 - $5)) - u) / 9.81
    d = t - (NR / 5 - at); if (d < 0) d = -d
    if (NR / 5 > at && d > most) most = d } END { print most + 0 }')" 0 1e-4
done
within 'the first has bounced' "$(rows "$T/a.bed" | awk 'NR == 1 { print $9 }')" 1 9
: > "$T/err"
refused 2 '--rate: has no use with --fill grid' "$B/settle" --rate 10
refused 2 '--drop: has no use with --fill rain' "$B/settle" --fill rain --drop 1
refused 2 'expected gravity downwards' "$B/settle" --fill rain --gravity 1,0,-9
refused 2 'found places' "$B/settle" --fill rain --rate 1e-300
for rate in 1e-30 1 1e9; do # the paper's spheres pass with 661 m/s
  refused 2 'm/s and pass through the floor' "$B/settle" --fill rain --rate $rate
done
"$B/settle" --quiet --fill rain --rate 5 --time 0 > "$T/a.bed" 2> "$T/err"
check 'rain that is not too fast' [ $? -eq 0 ]
check 'rain has no drop in its header' [ "$("$B/settle" --fill rain --time 0 |
  grep -cE '^# drop=')" = 0 ]
refused 2 'one of grid random rain' "$B/settle" --fill snow
refused 2 'makes a start, expected none beside --scene' "$B/settle" --rate 9 \
  --scene "$T/below.bed"

# a checkpoint goes on to the last bit, and needs neither the file nor the places
cp "$T/below.bed" "$T/gone.bed"
"$B/settle" --quiet --onto "$T/gone.bed" --fill rain --rate 200 --count 10 --time 4.2 \
  --output "$T/whole.bed"
"$B/settle" --quiet --onto "$T/gone.bed" --fill rain --rate 200 --count 10 --time 4.2 \
  --output "$T/two.bed" --checkpoint "$T/state" --every 0
rm "$T/gone.bed"
"$B/settle" --quiet --resume "$T/state" 2> "$T/err"
check 'resumed' [ $? -eq 0 ]
check 'from a checkpoint' cmp -s "$T/whole.bed" "$T/two.bed"

check_done
