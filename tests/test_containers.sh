#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Containers and starts of settle, and what analyze makes of them. The forces are
# tested in tests/test_containers.c.
. tests/harness.sh

row() { # of a table: column NAME of the first row
  awk -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k }
    NR == 2 { print $at[name] }' "$2"
}

# --- a lid and obstacles -----------------------------------------------------
refused 2 'reaches up to' "$B/settle" --count 200 --lid 2
"$B/settle" --quiet --count 16 --lid 1.5 --time 0.01 > "$T/lid.bed"
check 'a lid is a wall of the header' grep -qx '# wall=0 0 1.5 0 0 1' "$T/lid.bed"
# upwards: spheres end under it
"$B/settle" --quiet --scene "$T/lid.bed" --gravity 0,0,9.81 --time 2 |
  "$B/analyze" contacts --box 0,1,0,1,1.3,1.5 > "$T/tsv"
within 'spheres under the lid' "$(row spheres "$T/tsv")" 16 16
within 'the lid carries them' "$(row floor "$T/tsv")" 0.9 1.1

# a rough floor: overlapping obstacles across the floor of the box
awk 'BEGIN { print "# format=bed-1\n# model=rotation\n# radius=0.1"
  print "# wall=0 0 0 -1 0 0\n# wall=1 0 0 1 0 0\n# wall=0 0 0 0 -1 0"
  print "# wall=0 1 0 0 1 0\n# t=0\nid\tx\ty\tz\tr\tm\tfixed"
  for (i = 0; i < 49; i++)
    print i "\t" (i % 7) / 6 "\t" int(i / 7) / 6 "\t0\t0.1\t1\t1"
  for (i = 0; i < 48; i++)
    print 49 + i "\t" 0.13 + 0.24 * (i % 4) "\t" 0.14 + 0.24 * (int(i / 4) % 4) \
      "\t" 0.4 + 0.25 * int(i / 16) "\t0.1\t1\t0"
  print "# status=ok" }' > "$T/rough.bed"
for method in rkc multirate; do
  "$B/settle" --quiet --scene "$T/rough.bed" --method $method --time 3 \
    > "$T/$method.bed" 2> "$T/err"
  check "$method over obstacles" [ $? -eq 0 ]
  check "$method: obstacles are written as they were" cmp -s \
    <(awk '$NF == 1 { print $1, $2, $3, $4, $5, $6 }' "$T/$method.bed") \
    <(awk '$NF == 1 { print $1, $2, $3, $4, $5, $6 }' "$T/rough.bed")
  within "$method: they hold the spheres" "$(awk '$NF == 0 && /^[0-9]/ {
    if (least == "" || $4 < least) least = $4 } END { print least }' \
    "$T/$method.bed")" 0.1 0.21
  "$B/analyze" contacts --gap 0.002 "$T/$method.bed" > "$T/tsv"
  within "$method: spheres that are looked at" "$(row spheres "$T/tsv")" 48 48
done
"$B/analyze" order --margin 0 "$T/rkc.bed" > "$T/tsv"
within 'order looks at spheres that are no obstacles' "$(row spheres "$T/tsv")" 48 48
# the volume of all that stand apart, obstacles too
awk 'BEGIN { print "x\ty\tz\tr\tfixed\n0\t0\t0\t1\t1\n9\t0\t0\t1\t0" }' |
  "$B/analyze" --box -9,19,-9,9,-9,9 > "$T/tsv"
within 'fraction counts obstacles' "$(awk -v f="$(row union "$T/tsv")" \
  'BEGIN { print f * 28 * 18 * 18 / (8 / 3 * atan2(0, -1)) - 1 }')" -1e-12 1e-12
"$B/analyze" export --format bed "$T/rkc.bed" 2> "$T/err" > "$T/again.bed"
check 'export keeps obstacles' [ "$(awk '$NF == 1' "$T/again.bed" | wc -l)" = 49 ]
unsealed "$T/rough.bed" | sed 's/\t0$/\t2/' > "$T/bad.bed"
refused 3 'fixed 2: expected 0 or 1' "$B/settle" --scene "$T/bad.bed"
unsealed "$T/rough.bed" | sed 's/\t0$/\t1/' > "$T/bad.bed"
refused 3 'all spheres are fixed' "$B/settle" --scene "$T/bad.bed"
printf 'x\ty\tz\tr\tvx\tfixed\n0\t0\t0\t0.1\t1\t1\n1\t1\t1\t0.1\t0\t0\n' \
  > "$T/bad.tsv"
refused 3 'is fixed, expected no velocity' "$B/settle" --scene "$T/bad.tsv"

# --- tubes -------------------------------------------------------------------
tube=0.3,0.2,0,0,0,1,0.35
refused 2 'no wider than a bead' "$B/settle" --cylinder 0,0,0,0,0,1,0.1
refused 2 'expected px,py,pz,ax,ay,az,R' "$B/settle" --cylinder 0,0,0,0,0,0,1
refused 2 'not so many spheres' "$B/settle" --cylinder 0,0,0,1,0,0,0.5
refused 2 'cylinder: not one sphere of radius 0.1 fits into 0.22 by 0.22 m with' "$B/settle" \
  --cylinder 0.11,0.11,0,0,0,1,0.11
for method in rkc multirate merson; do
  "$B/settle" --quiet --cylinder $tube --count 30 --method $method --time 1.2 \
    > "$T/$method.bed" 2> "$T/err"
  check "$method in a tube" [ $? -eq 0 ]
  within "$method: furthest from the axis" "$(awk '/^[0-9]/ {
    d = sqrt(($2 - 0.3)^2 + ($3 - 0.2)^2); if (d > most) most = d }
    END { print most }' "$T/$method.bed")" 0.24 0.27
done
unsealed "$T/rkc.bed" | grep '^# [wc].*=' > "$T/keys"
check 'its header' cmp -s <(grep -v count "$T/keys" | grep -v control) - << 'END'
# wall=0 0 0 0 0 -1
# cylinder=0.3 0.2 0 0 0 1 0.35
END
"$B/settle" --quiet --scene "$T/rkc.bed" --time 6 > "$T/rest.bed"
check 'going on keeps it' cmp -s <(unsealed "$T/rest.bed" |
  grep '^# [wc].*=') "$T/keys"
"$B/analyze" contacts "$T/rest.bed" > "$T/tsv"
within 'floor and tube carry the weight' "$(awk -v f="$(row floor "$T/tsv")" \
  -v s="$(row sides "$T/tsv")" 'BEGIN { print f + s }')" 0.95 1.05
check 'contacts names the tube as wall 2' [ "$("$B/analyze" contacts --network \
  "$T/rest.bed" | awk '$4 == 2' | wc -l)" -gt 5 ]
unsealed "$T/rest.bed" | sed 's/0.3 0.2 0 0 0 1 0.35/0.3 0.2 0 0 0 1 0.2/' > "$T/bad.bed"
refused 3 'outside wall 2, a cylinder' "$B/settle" --scene "$T/bad.bed" --time 9
# walls of the box along the tube go, those across it stay
"$B/settle" --quiet --cylinder 0,0.4,0.4,1,0,0,0.4 --base 1,0.8 --drop 0 \
  --count 10 --time 0.01 > "$T/flat.bed"
check 'ends of a horizontal tube' cmp -s <(grep '^# wall' "$T/flat.bed") - << 'END'
# wall=0 0 0 -1 0 0
# wall=1 0 0 1 0 0
END

# --- periodic sides ----------------------------------------------------------
refused 2 'too short, expected at least 0.6 m' "$B/settle" --periodic x --base 0.5,1
refused 2 'one of x y xy (' "$B/settle" --periodic z
check 'help says each way once' [ "$("$B/settle" --help | grep -c 'one of x y xy$')" = 1 ]
for sides in xy 'x y'; do
  check "periodic: $sides" [ "$("$B/settle" --periodic "$sides" --count 1 --time 0 |
    grep '^# periodic=')" = '# periodic=x y' ]
done
"$B/settle" --quiet --periodic xy --base 0.8,0.7 --count 60 --time 3 \
  > "$T/periodic.bed"
check 'periodic sides in the header' cmp -s \
  <(grep -E '^# (periodic|base|wall)=' "$T/periodic.bed") - << 'END'
# base=0.8,0.7
# periodic=x y
# wall=0 0 0 0 0 -1
END
within 'places are in the cell' "$(awk '/^[0-9]/ && ($2 < 0 || $2 >= 0.8 ||
  $3 < 0 || $3 >= 0.7) { n++ } END { print n + 0 }' "$T/periodic.bed")" 0 0
"$B/analyze" contacts "$T/periodic.bed" > "$T/tsv"
within 'the floor carries all of it' "$(row floor "$T/tsv")" 0.98 1.02
"$B/settle" --quiet --scene "$T/periodic.bed" --time 3.2 > "$T/on.bed"
check 'going on keeps periodic sides' cmp -s <(grep '^# [pbw].*=' "$T/on.bed") \
  <(grep '^# [pbw].*=' "$T/periodic.bed")
"$B/settle" --quiet --periodic x --base 0.8,0.7 --count 20 --time 0.1 > "$T/x.bed"
check 'one side: walls across the other' [ "$(grep -c '^# wall' "$T/x.bed")" = 3 ]
unsealed "$T/periodic.bed" | sed 's/^# base=0.8,0.7/# base=0.4,0.7/' > "$T/bad.bed"
refused 3 'a periodic side of 0.4 m is too short' "$B/settle" --scene "$T/bad.bed"
unsealed "$T/periodic.bed" | grep -v '^# base' > "$T/bad.bed"
refused 3 'periodic' "$B/analyze" contacts "$T/bad.bed"
# all volume is in a cell that holds the bed, wherever it begins
for x in 0,0.8 0.33,1.13 -5,-4.2; do
  "$B/analyze" --box $x,-0.1,0.6,-1,9 "$T/periodic.bed" > "$T/tsv"
  within "volume in $x" "$(awk -v f="$(row sum "$T/tsv")" 'BEGIN {
    print f * 0.8 * 0.7 * 10 / (60 * 4e-3 / 3 * atan2(0, -1)) - 1 }')" -1e-12 1e-12
  row union "$T/tsv" >> "$T/unions"
done
within 'its union is the same' "$(awk 'NR == 1 { a = $1 } { d = a - $1
  if (d < 0) d = -d; if (d > most) most = d } END { print most }' "$T/unions")" 0 1e-13
check 'default box of periodic sides' cmp -s <("$B/analyze" "$T/periodic.bed") \
  <("$B/analyze" --box 0,0.8,0,0.7,0,0.7 "$T/periodic.bed")
"$B/analyze" profile --points 50 --box 0.2,1,0.1,0.8,-1,9 "$T/periodic.bed" > "$T/a.tsv"
"$B/analyze" profile --points 50 --box 0,0.8,0,0.7,-1,9 "$T/periodic.bed" > "$T/b.tsv"
within 'profile across periodic sides' "$(paste "$T/a.tsv" "$T/b.tsv" | awk '
  NR > 1 { d = $3 - $7; if (d < 0) d = -d; if (d > most) most = d }
  END { print most }')" 0 1e-12
"$B/analyze" export --format raw --cells 4 --output "$T/raw" "$T/periodic.bed" 2> "$T/err"
check 'export states the fraction of the cell' grep -q \
  "fraction $("$B/analyze" "$T/periodic.bed" | awk 'NR == 2 {
    print substr($3, 1, 10) }')" "$T/err"
# a sphere on a corner of the cell is one part, also where the sides are short, and
# one in the middle is another
for base in 0.8,0.7 1.6,1.4; do
  printf '%b' "# format=bed-1\n# base=$base\n# periodic=x y\n" \
    'x\ty\tz\tr\n0\t0\t0.35\t0.2\n0.4\t0.35\t0.35\t0.2\n# status=ok\n' > "$T/corner.bed"
  "$B/analyze" export --format raw --cells 16 --box "0,${base/,/,0,},0,0.7" \
    --output "$T/raw" "$T/corner.bed" 2> "$T/err"
  check "a sphere on a corner of $base" grep -q \
    'also across periodic sides, make 2 solid parts and 1 pore part' "$T/err"
done
# the same bed, moved by any vector across its periodic sides: places and box
moved() { # DX DY: the bed, wrapped by its reader alone
  unsealed "$T/periodic.bed" | awk -v dx="$1" -v dy="$2" -v OFS='\t' '/^[0-9]/ {
    $2 = sprintf("%.17g", $2 + dx); $3 = sprintf("%.17g", $3 + dy) } { print }'
}
same() { # TOLERANCE: two tables, every number, times the larger of it and 1
  awk -v tol="$1" 'NR == FNR { row[FNR] = $0; n = FNR; next }
    { if (split(row[FNR], a) != NF) exit 1
      for (k = 1; k <= NF; k++) {
        d = a[k] - $k; if (d < 0) d = -d
        if ($k == a[k]) continue
        if ($k !~ /^[-+.0-9]/ || !(d <= tol * ($k > 1 || $k < -1 ? ($k < 0 ? -$k : $k) : 1))) exit 1
      } }
    END { if (FNR != n || n < 2) exit 1 }' "$T/a.tsv" "$T/b.tsv"
}
moved 0.37 -2.11 > "$T/moved.bed"
while read -r verb; do
  "$B/analyze" $verb "$T/periodic.bed" 2> "$T/err" > "$T/a.tsv"
  "$B/analyze" $verb "$T/moved.bed" 2>> "$T/err" > "$T/b.tsv"
  check "$verb: of a bed that was moved" same 1e-9
  check "$verb: without a word" [ ! -s "$T/err" ]
done << 'END'
fraction --box 0,0.8,0,0.7,0,0.5
gr
gr --rmax 5.3
order
order --cutoff 2.9
contacts
contacts --degrees
contacts --overlaps
rest
mixture --classes 0.05
mixture --profile 3
radius --report --keep fraction=0.5
END
for verb in contacts mixture order gr rest; do # a box that moves along
  "$B/analyze" $verb --box 0,0.35,0,0.4,0,0.5 "$T/periodic.bed" > "$T/a.tsv"
  "$B/analyze" $verb --box 0.37,0.72,-2.11,-1.71,0,0.5 "$T/moved.bed" > "$T/b.tsv"
  check "$verb: in a box that moves along" same 1e-9
done
check 'rest takes the union of all images' [ "$("$B/analyze" rest "$T/periodic.bed" |
  awk 'NR == 2 { print $6 }')" = "$("$B/analyze" "$T/periodic.bed" |
  awk 'NR == 2 { print $3 }')" ]
"$B/analyze" mixture --classes 0.05,0.2 "$T/periodic.bed" > "$T/tsv"
within 'classes add up to the fraction of all images' "$(awk \
  -v f="$("$B/analyze" "$T/periodic.bed" | awk 'NR == 2 { print $2 }')" '
  NR > 1 { s += $7 } END { print s / f - 1 }' "$T/tsv")" -1e-12 1e-12
# fcc without side walls: every sphere within the lattice has 12 neighbours
awk 'BEGIN { a = 0.2 * sqrt(2)
  printf "# format=bed-1\n# base=%.17g,%.17g\n# periodic=x y\n", 3 * a, 3 * a
  print "# radius=0.1\nx\ty\tz"
  for (i = 0; i < 6; i++) for (j = 0; j < 6; j++) for (k = 0; k < 8; k++)
    if ((i + j + k) % 2 == 0)
      printf "%.17g\t%.17g\t%.17g\n", i * a / 2, j * a / 2, 0.1 + k * a / 2
  print "# status=ok" }' > "$T/fcc.bed"
"$B/analyze" order --margin 1.3 "$T/fcc.bed" > "$T/tsv"
within 'fcc: spheres but for two layers above and below' "$(row spheres "$T/tsv")" 72 72
within 'fcc: neighbours' "$(row neighbours "$T/tsv")" 12 12
within 'fcc: all of them' "$(row fcc "$T/tsv")" 1 1
within 'fcc: q4' "$(row q4 "$T/tsv")" 0.190940653 0.190940654
within 'fcc: q6' "$(row q6 "$T/tsv")" 0.574524259 0.574524260
# pairs of neighbours: 4 within each of 8 layers by 2, 4 to each next layer
"$B/analyze" gr --rmax 1.1 --bins 11 "$T/fcc.bed" > "$T/tsv"
within 'fcc: pairs that touch' "$(awk '{ n += $4 } END { print n }' "$T/tsv")" \
  $((18 * (8 * 2 + 7 * 4))) $((18 * (8 * 2 + 7 * 4)))
"$B/analyze" radius --report "$T/fcc.bed" > "$T/tsv"
within 'fcc: the radius at which spheres touch' \
  "$(awk '$2 == "touching" { print $3 }' "$T/tsv")" 0.0999999999 0.1000000001
# a tube has no corners: the centres of the bed are in the cylinder they span, of
# which all pairs are found and expected
"$B/analyze" gr --rmax 20 --bins 100 "$T/rest.bed" > "$T/tsv"
within 'gr of a tube: all pairs' "$(awk 'NR > 1 { n += $4 } END { print n }' \
  "$T/tsv")" 435 435
within 'gr of a tube: all expected' "$(awk 'NR > 1 { n += $5 } END { print n }' \
  "$T/tsv")" 434.999 435.001
# pairs within a thousandth of a diameter: by that share of the cylinder's volume, of
# which three of the centres, on its surface, have half
"$B/analyze" gr --rmax 1e-3 --bins 1 "$T/rest.bed" > "$T/tsv"
within 'gr of a tube: what the centres span' "$(awk -v pi=3.14159265358979 '
  FNR == NR { if (FNR == 2) shell = $5; next }
  /^[0-9]/ { a = ($2 - 0.3)^2 + ($3 - 0.2)^2; if (a > most) most = a
    if (!n++ || $4 < low) low = $4; if ($4 > high) high = $4 }
  END { volume = 4 / 3 * pi * 0.0002^3 * 14.5 * (30 - 1.5) / shell
    print volume / (pi * most * (high - low)) - 1 }' "$T/tsv" "$T/rest.bed")" -1e-3 1e-3
"$B/analyze" order --margin 0 "$T/rest.bed" > "$T/tsv"
within 'order of a tube: none is left out' "$(row spheres "$T/tsv")" 30 30
"$B/analyze" order --margin 0.6 "$T/rest.bed" > "$T/tsv"
within 'order of a tube: those that are not at the wall' "$(row spheres "$T/tsv")" \
  "$(awk '/^[0-9]/ { a = sqrt(($2 - 0.3)^2 + ($3 - 0.2)^2); z[n] = $4; r[n++] = a
    if (a > most) most = a; if (n == 1 || $4 < low) low = $4; if ($4 > high) high = $4 }
    END { for (k = 0; k < n; k++) if (r[k] <= most - 0.12 && z[k] >= low + 0.12 &&
      z[k] <= high - 0.12) in_++; print in_ + 0 }' "$T/rest.bed")" 20
# the square inscribed in a tube
half=$(awk 'BEGIN { printf "%.17g", 0.35 * sqrt(0.5) }')
"$B/analyze" "$T/rest.bed" > "$T/a.tsv"
"$B/analyze" --box "$(awk -v h="$half" 'BEGIN { printf "%.17g,%.17g,%.17g,%.17g,0,%.17g",
  0.3 - h, 0.3 + h, 0.2 - h, 0.2 + h, 2 * h }')" "$T/rest.bed" > "$T/b.tsv"
within 'default box of a tube' "$(awk -v a="$(row union "$T/a.tsv")" \
  -v b="$(row union "$T/b.tsv")" 'BEGIN { print a - b }')" -1e-9 1e-9
# a checkpoint goes on to the last bit
for walls in '--periodic xy' "--cylinder $tube"; do
  "$B/settle" --quiet $walls --count 20 --time 0.3 --output "$T/whole.bed"
  "$B/settle" --quiet $walls --count 20 --time 0.3 --output "$T/two.bed" \
    --checkpoint "$T/state" --every 0
  check "$walls: with checkpoints" cmp -s "$T/whole.bed" "$T/two.bed"
  "$B/settle" --quiet --resume "$T/state"
  check "$walls: from a checkpoint" cmp -s "$T/whole.bed" "$T/two.bed"
done

check_done
