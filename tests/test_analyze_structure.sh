#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# analyze contacts, rest, gr and order on beds whose numbers are known.
. tests/harness.sh

near() { # GOT WANT TOLERANCE; NaN and nothing are never near
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
    d = a - b
    exit !(a ~ /^[-+.0-9]/ && d <= t && -d <= t)}'
}

is() { # NAME GOT WANT [TOLERANCE]
  if [[ ${4:-} ]]; then
    check "$1: got '$2', want '$3'" near "$2" "$3" "$4"
  else
    check "$1: got '$2', want '$3'" test "$2" = "$3"
  fi
}

value() { # COLUMN [ROW [FILE]]: of the table in FILE, $T/out
  awk -F '\t' -v name="$1" -v row="${2:-1}" '
    NR == 1 {for (k = 1; k <= NF; k++) if ($k == name) c = k; next}
    NR == row + 1 {print $c}' "${3:-$T/out}"
}

total() { # COLUMN [CONDITION]: sum over all rows
  awk -F '\t' -v name="$1" "
    NR == 1 {for (k = 1; k <= NF; k++) {at[\$k] = k; if (\$k == name) c = k}
             next}
    ${2:-1} {s += \$c} END {printf \"%.17g\\n\", s}" "$T/out"
}

measure() { # ARGUMENT...: into $T/out
  timeout 60 "$B/analyze" "$@" >"$T/out" 2>"$T/err" </dev/null
  status=$?
  [[ $status == 0 && ! -s $T/err ]] || {
    echo "analyze $*: exit status $status" >&2
    cat "$T/err" >&2
  }
}

refuse() { # NAME STATUS PATTERN ARGUMENT...: one line that says so
  timeout 60 "$B/analyze" "${@:4}" >"$T/out" 2>"$T/err" </dev/null
  is "$1: exit status" $? "$2"
  check "$1: says '$3'" grep -Eq -e "^analyze: .*$3" "$T/err"
  is "$1: lines" "$(wc -l <"$T/err")" 1
}

# A column at rest, F(l) (1 + e^2)/2 = k weights at the k-th contact from
# above: frames at t = 0 and 5, and one that moves at 5.2.
awk 'BEGIN {
  n = 10; m = 2; r = 0.1; g = 9.81
  for (f = 0; f < 3; f++) {
    if (f) print "\n"
    else print "# format=bed-1\n# f0=10\n# restitution=0.4\n# wall=0 0 0 0 0 -1\n" \
      "# wall=0 0 0 -1 0 0"
    printf "# t=%g\n", f < 2 ? f * 5 : 5.2
    print "id\tx\ty\tz\tr\tm\tvx\tvy\tvz"
    z = 0
    for (i = 0; i < n; i++) {
      z += -log((n - i) * m * g / (10 * 0.58)) / 150 + (i ? 2 : 1) * r
      printf "%d\t0.5\t0.5\t%.17g\t%g\t%g\t%g\t0\t0\n", i + 7, z, r, m,
        f == 2 ? 0.02 : 0
    }
  }
  print "# status=ok"}' >"$T/column"
measure contacts "$T/column"
is 'column: rows' "$(wc -l <"$T/out")" 4
is 'column: t of the second row' "$(value t 2)" 5
is 'column: floor' "$(value floor)" 1 1e-9
is 'column: sides' "$(value sides)" 0 0
is 'column: pairs' "$(value pairs)" 9
is 'column: wall contacts' "$(value wall_contacts)" 1
is 'column: z' "$(value z)" 1.9 1e-12
is 'column: z of spheres' "$(value z_spheres)" 1.8 1e-12
is 'column: all rattle, friction' "$(value rattlers)" 10
is 'column: nobody is left' "$(value z_rigid)" nan
is 'column: anisotropy' "$(value anisotropy)" 1 1e-12
want=$(awk 'BEGIN {printf "%.17g", log(20 * 9.81 / 5.8) / 150 / 0.2}')
is 'column: overlap at the floor' "$(value wall_overlap_max)" "$want" 1e-12
measure contacts --least 1 "$T/column"
is 'column: --least 1' "$(value rattlers)" 0
# the uppermost of the contacts carries one weight, the next two
measure contacts --force 2.5 "$T/column"
is 'column: --force 2.5 of pairs' "$(value pairs)" 7
measure contacts --network "$T/column"
is 'network: normal force of the top' \
  "$(awk -F '\t' '$2 == 15 && $3 == 16 {print $8; exit}' "$T/out")" 19.62 1e-7
is 'network: floor' \
  "$(awk -F '\t' '$4 == 1 {print $2, $3, $13; exit}' "$T/out")" "7 7 1"
check 'network: blocks for gnuplot' gnuplot -e \
  "stats '$T/out' skip 1 using 8 nooutput; exit status STATS_blocks != 3"
measure contacts --degrees "$T/column"
is 'degrees: spheres of all frames' "$(total spheres)" 30
is 'degrees: spheres with one contact' "$(value spheres 2)" 1
is 'degrees: spheres with two contacts' "$(value spheres 3)" 9
measure contacts --overlaps --bin 0.01 "$T/column"
is 'overlaps: pairs of all frames' "$(total pairs)" 27
is 'overlaps: middle of the first bin' "$(value overlap)" 0.005 1e-15

measure rest "$T/column"
is 'rest: first frame' "$(value at_rest 1)" nan
is 'rest: second frame' "$(value at_rest 2)" 1
is 'rest: moving' "$(value at_rest 3)" 0
is 'rest: unbalanced' "$(value unbalanced)" 0 1e-9
is 'rest: fastest' "$(value fastest 3)" 2 1e-12
is 'rest: kinetic' "$(value kinetic 3)" 4e-4 1e-12
is 'rest: rate' "$(value rate 2)" 0 1e-12
# contacts store F/kappa: sums of k weights; gravity from the origin
want=$(awk '/^[0-9]/ && n++ < 10 {u += 2 * 9.81 * $4}
  END {for (k = 1; k <= 10; k++) u += k * 19.62 / 0.58 / 150
       printf "%.17g", u / 10}' "$T/column")
# and pairs and the wall beyond it that are not neighbours: none within lmax
is 'rest: potential' "$(value potential)" "$want" 1e-9

# One sphere at rest on the floor, one in free flight: half a weight of net
# force on each, one contact of a weight.
awk 'BEGIN {
  print "# format=bed-1\n# model=basic\n# wall=0 0 0 0 0 -1\nx\ty\tz\tr"
  printf "0\t0\t%.17g\t0.1\n1\t1\t1\t0.1\n# status=ok\n",
    0.1 - log(9.81 / 5.8) / 150}' >"$T/half"
measure rest "$T/half"
is 'rest: half is unbalanced' "$(value unbalanced)" 0.5 1e-12

# Lattices: blocks of 6^3 cells, the inside by a box.
lattice() { # NAME CELL ATOMS: edges of the cell, coordinates in edges
  awk -v cell="$2" -v atoms="$3" 'BEGIN {
    split(cell, a); n = split(atoms, p)
    print "x\ty\tz\tr"
    for (c = 0; c < 216; c++)
      for (k = 1; k < n; k += 3)
        printf "%.17g\t%.17g\t%.17g\t0.5\n", a[1] * (int(c / 36) + p[k]),
          a[2] * (int(c / 6) % 6 + p[k + 1]), a[3] * (c % 6 + p[k + 2])
    print "# status=ok"}' >"$T/$1"
}
lattice sc '1 1 1' '0 0 0'
lattice bcc '1.1547005383792517 1.1547005383792517 1.1547005383792517' \
  '0 0 0 .5 .5 .5'
lattice fcc '1.4142135623730951 1.4142135623730951 1.4142135623730951' \
  '0 0 0 0 .5 .5 .5 0 .5 .5 .5 0'
lattice hcp '1 1.7320508075688772 1.6329931618554521' \
  '0 0 0 .5 .5 0 0 .33333333333333333 .5 .5 .83333333333333333 .5'
while read -r name margin z q4 q6; do
  measure contacts --gap 1e-9 --box 1.3,3.7,1.3,3.7,1.3,3.7 "$T/$name"
  is "$name: z" "$(value z)" "$z" 1e-12
  is "$name: floor without walls" "$(value floor)" 0 0
  measure order --margin "$margin" "$T/$name"
  is "$name: q4" "$(value q4)" "$q4" 5e-4
  is "$name: q6" "$(value q6)" "$q6" 5e-4
  is "$name: qbar6" "$(value qbar6)" "$q6" 5e-4
  like=$name
  [[ $name == sc ]] && like=disordered
  is "$name: class" "$(value "$like")" 1
  measure order --spheres --margin "$margin" "$T/$name"
  is "$name: class of a sphere" "$(value like)" "$like"
done <<'END'
sc 1.9 6 0.764 0.354
bcc 2.3 8 0.036 0.511
fcc 2.3 12 0.191 0.575
hcp 2.3 12 0.097 0.485
END
# 6^3 points of the simple cubic lattice have 3 36 5 bonds
measure gr --rmax 1.15 --bins 10 "$T/sc"
is 'gr: pairs' "$(total pairs)" 540
is 'gr: in the bin of the bonds' "$(value pairs 9)" 540
# a box that holds all distances: 216 215/2 pairs, found and expected
measure gr --rmax 9 --bins 90 "$T/sc"
is 'gr: all pairs' "$(total pairs)" 23220
is 'gr: all expected' "$(total expected)" 23220 1e-8
is 'gr: all partners but for noise' "$(value r 1)" 0.05 1e-12

# A settled bed: walls carry the weight, and the network has it all.
"$B/settle" --quiet --count 60 --base 0.6,0.6 --time 100 --until-rest \
  --seed 5 >"$T/bed" || echo "settle failed" >&2
measure contacts "$T/bed"
floor=$(value floor)
# at rest the force that is left is far below 1 % of the weight
is 'bed: floor and sides' \
  "$(awk -v a="$floor" -v b="$(value sides)" 'BEGIN {print a + b}')" 1 1e-2
# -0.31 to 0.03 over 16 beds
check 'bed: the sides carry a small part' near "$(value sides)" 0 0.4
check 'bed: not none' test "$(value sides)" != 0
measure contacts --network --gap 0.1 "$T/bed"
# (the floor is the first wall of the header)
is 'bed: floor by the network' "$(total normal '$4 == 1')" \
  "$(awk -v f="$floor" 'BEGIN {printf "%.17g", f * 60 * 9.81}')" 1e-8
measure rest "$T/bed"
check 'bed: slower than vmin on average' near "$(value kinetic)" 0 5e-5
check 'bed: nearly balanced' near "$(value unbalanced)" 0 0.02
"$B/settle" --quiet --model basic --count 60 --base 0.6,0.6 >"$T/smooth"
measure contacts --network "$T/smooth"
is 'frictionless: no tangential force' "$(total tangential)" 0
"$B/settle" --quiet --count 60 --base 0.6,0.6 --time 0.5 --frames 3 |
  "$B/analyze" contacts >"$T/out"
is 'a pipe of three frames' "$(wc -l <"$T/out")" 4

# What is refused.
printf '# format=bed-1\nx\ty\tz\tr\n1\t1\t1\t.1\n1\t1\t1\t.1\n# %s\n' status=ok >"$T/same"
printf '# format=bed-1\n# kappa=-1\nx\ty\tz\n1\t1\t1\n# status=ok\n' >"$T/kappa"
printf '# format=bed-1\n# gravity=0\nx\ty\tz\n1\t1\t1\n# status=ok\n' \
  >"$T/weightless"
refuse 'two tables' 2 'one of --degrees' contacts --network --degrees "$T/sc"
refuse 'an empty box' 2 'x0 < x1' contacts --box 1,0,0,1,0,1 "$T/sc"
refuse 'an empty box' 2 'x0 < x1' gr --box 1,0,0,1,0,1 "$T/sc"
printf '%b' '# format=bed-1\n# wall=0 0 0 0 0 -1\nid\tx\ty\tz\n' \
  '0\t0.5\t0.5\t-1e60\n# status=ok\n' \
  >"$T/outside"
refuse 'overlaps without end' 3 'more than a million bins' contacts --overlaps \
  "$T/outside"
tiny=0,1e-200,0,1e-200,0,1e-200 huge=-1e200,1e200,-1e200,1e200,-1e200,1e200
for verb in fraction profile contacts rest gr order radius; do
  refuse "$verb: a box whose volume vanishes" 2 'x0 < x1' $verb --box=$tiny \
    "$T/sc"
  refuse "$verb: a box whose volume overflows" 2 'x0 < x1' $verb --box=$huge \
    "$T/sc"
done
refuse 'no bins' 2 'bins' gr --bins 0 "$T/sc"
refuse 'no cutoff' 2 'cutoff' order --cutoff 0 "$T/sc"
refuse 'a second file' 2 'one file' radius "$T/sc" "$T/sc"
refuse 'a verb that is none' 2 "'fractoin'.*did you mean" fractoin "$T/sc"
for verb in contacts rest; do
  printf '# format=bed-1\n# radius=0.09\n# radius_dynamics=0.1\nx\ty\tz
1\t1\t1\n# %s\n' \
    status=ok >"$T/rewritten"
  "$B/analyze" $verb "$T/rewritten" >/dev/null 2>"$T/err"
  is "$verb: a rewritten radius: exit status" $? 0
  check "$verb: a rewritten radius" grep -q 'radius_dynamics=0.1,' "$T/err"
done
for verb in contacts rest order; do
  refuse "$verb: one place twice" 3 'same: t=0: .*same centre' $verb "$T/same"
done
refuse 'no volume' 3 'no volume' gr "$T/same"
refuse 'a bad key' 3 'kappa: t=0: kappa=-1.*above 0' contacts "$T/kappa"
refuse 'a bad key' 3 'kappa: t=0: kappa=-1.*above 0' rest "$T/kappa"
refuse 'a share of no weight' 3 'gravity' contacts --force 1 "$T/weightless"
measure contacts "$T/weightless"
is 'no weight to carry' "$(value floor)" nan
# --- what a contact, a rattler, a floor is --------------------------------------
scene() { # KEY=VALUE...: a bed of the rows "x y z r [vx]" on standard input
  printf '# format=bed-1\n# t=0\n'
  printf '# %s\n' "$@"
  printf 'x\ty\tz\tr\tvx\tvy\tvz\n'
  awk -v OFS='\t' '{print $1, $2, $3, $4, $5 + 0, 0, 0}'
  echo '# status=ok'
}
# each of three has two contacts, each of six (an octahedron) four
ring() { printf '0 0 0 0.5\n1 0 0 0.5\n0.5 0.8660254 0 0.5\n'; }
octahedron() {
  for x in '1 0 0' '-1 0 0' '0 1 0' '0 -1 0' '0 0 1' '0 0 -1'; do
    echo "$x 0.70710679"
  done
}
ring | scene model=friction friction=0.2 >"$T/ring"
measure contacts "$T/ring"
is 'friction: two contacts hold' "$(value rattlers)" 0
ring | scene model=basic >"$T/ring"
measure contacts "$T/ring"
is 'no friction: two do not' "$(value rattlers)" 3
octahedron | scene model=basic >"$T/octahedron"
measure contacts "$T/octahedron"
is 'no friction: four contacts hold' "$(value rattlers)" 0
is 'no friction: four contacts' "$(value z)" 4
# walls that face gravity within 45 degrees are floors
for degrees in 40 44 46 50; do
  normal=$(awk -v a=$degrees 'BEGIN {a *= atan2(0, -1) / 180
    printf "%.17g 0 %.17g", sin(a), -cos(a)}')
  at=$(awk -v a=$degrees 'BEGIN {a *= atan2(0, -1) / 180
    printf "%.17g 0 %.17g 0.1", -0.1 * sin(a), 0.1 * cos(a)}')
  scene "wall=0 0 0 $normal" <<<"$at" >"$T/slope"
  measure contacts "$T/slope"
  other=$([[ $degrees -lt 45 ]] && echo sides || echo floor)
  is "a wall at $degrees degrees: no $other" "$(value $other)" 0
  check "a wall at $degrees degrees carries" test "$(value floor)" != \
    "$(value sides)"
  # a tube along y, 0.4 around its axis
  at=$(awk -v a=$degrees 'BEGIN {a *= atan2(0, -1) / 180
    printf "%.17g 0 %.17g 0.1", 0.4 * sin(a), -0.4 * cos(a)}')
  scene 'cylinder=0 0 0 0 1 0 0.5' <<<"$at" >"$T/slope"
  measure contacts "$T/slope"
  is "a tube at $degrees degrees: no $other" "$(value $other)" 0
  check "a tube at $degrees degrees carries" test "$(value floor)" != \
    "$(value sides)"
done
# an overlap is one whether or not the pair counts, and a gap is none though it
# does: pairs at an overlap of 0.02 (0.1 diameters) and a gap of 0.05
printf '0 0 0 0.1\n0.18 0 0 0.1\n5 0 0 0.1\n5.25 0 0 0.1\n' |
  scene gravity=0,0,0 model=basic >"$T/pairs"
for gap in -0.05 0 0.06; do
  measure contacts --gap $gap "$T/pairs"
  is "--gap $gap: mean overlap" "$(value overlap_mean)" 0.1 1e-12
  is "--gap $gap: largest overlap" "$(value overlap_max)" 0.1 1e-12
done
is '--gap 0.06: pairs' "$(value pairs)" 2
# touching exactly counts
printf '0 0 0 0.125\n0.25 0 0 0.125\n' | scene model=basic >"$T/touch"
measure contacts "$T/touch"
is 'spheres that touch' "$(value pairs)" 1
# unbalanced: the mean force on a sphere, (N + N e^(-150 0.07))/2, by that of the
# contacts that touch, N
measure rest --box -1,6,-1,1,-1,1 "$T/pairs"
is 'only what touches is a contact' "$(value unbalanced)" \
  "$(awk 'BEGIN {printf "%.17g", (1 + exp(-150 * 0.07)) / 2}')" 1e-12
# both have the force of their one contact, friction and all
printf '0 0 0 0.1 0.005\n0 0 0.19 0.1 -0.005\n' |
  scene gravity=0,0,0 model=friction friction=0.5 >"$T/sliding"
measure rest --box -1,1,-1,1,-1,1 "$T/sliding"
is "a contact's force has its friction" "$(value unbalanced)" 1 1e-12
measure contacts --network "$T/sliding"
check 'which is not small' awk -v t="$(value tangential)" -v n="$(value normal)" \
  'BEGIN {exit !(t > 0.2 * n)}'

# coordination: up to the end each of two has one partner, of three two
for n in 2 3; do
  awk -v n=$n 'BEGIN {print "x,y,z,r"
    for (i = 0; i < n; i++) print 0.5 + 0.01 * i ",0.5,0.5,0.1"}' >"$T/few.csv"
  measure gr --box 0,1,0,1,0,1 --rmax 2 --bins 40 "$T/few.csv"
  is "coordination of $n" "$(value coordination 40)" $((n - 1)) 1e-12
done

for verb in contacts rest gr order; do
  "$B/analyze" $verb "$T/sc" >/dev/full 2>"$T/err"
  is "$verb: a full disk" $? 1
  "$B/analyze" $verb --help >"$T/out"
  check "$verb: help" grep -q "^Usage: analyze $verb " "$T/out"
  check "$verb: help fits" awk 'length > 99 && /^  [a-z]/ {exit 1}' "$T/out"
done

check_done
