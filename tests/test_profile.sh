#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# analyze fraction with many boxes, profile and radius as their users meet them.
# Run from the root of the repository; B is the directory of the programs.
. tests/harness.sh

run() { # PROGRAM ARGUMENT...: into $T/out, $T/err and $status
  local program=$1
  shift
  timeout 20 "$B/$program" "$@" >"$T/out" 2>"$T/err" </dev/null
  status=$?
}

refuse() { # NAME STATUS PATTERN ARGUMENT...: one line of analyze's, no result
  local name=$1 code=$2 pattern=$3
  run analyze "${@:4}"
  refused() {
    [[ $status == "$code" && ! -s $T/out && $(wc -l <"$T/err") == 1 ]] &&
      grep -Eq -e "^analyze: .*$pattern" "$T/err"
  }
  check "$name: status $status, expected $code and '$pattern'" refused
}

is() { # EXPRESSION: of awk's, over the rows of $T/out by their columns' names;
       # $T/out's last row is in r, the sums of columns in s, their number in n
  awk -F '\t' -v OFS='\t' '
    function near(a, b, tol) {
      return a != "" && a !~ /nan|inf/ && a - b <= tol && b - a <= tol}
    /^#/ || !NF {next}
    /^[a-z]/ {for (k = 1; k <= NF; k++) name[k] = $k; next}
    {n++; for (k = 1; k <= NF; k++) {r[name[k]] = $k; s[name[k]] += $k
       if (n == 1) first[name[k]] = $k}}
    END {pi = atan2(0, -1); exit !('"$1"')}' "$T/out"
}
names() { # LINE: the names of columns
  [[ $(head -n 1 "$T/out") == "$(printf '%b' "$1")" ]]
}

spheres() { # FILE RADIUS: a bed of the centres on standard input
  { printf '# format=bed-1\n# radius=%s\nx\ty\tz\n' "$2"
    cat
    echo '# status=ok'
  } >"$1"
}
lattice() { # simple cubic, 4^3 in the unit box
  awk 'BEGIN {OFS = "\t"; for (i = 0; i < 64; i++)
    print i % 4 / 4 + 1/8, int(i / 4) % 4 / 4 + 1/8, int(i / 16) / 4 + 1/8}'
}

lattice | spheres "$T/lattice" 0.125
printf '0.5\t0.5\t0.5\n' | spheres "$T/one" 0.3
printf '0.5\t0.5\t0.4\n0.5\t0.5\t0.6\n' | spheres "$T/two" 0.2
printf '0.5\t0.5\t0.5\n' >"$T/row"
{ printf '# format=bed-1\nx\ty\tz\tr\n0.2\t0.5\t0.5\t0.1\n'
  printf '0.6\t0.5\t0.5\t0.2\n# status=ok\n'; } >"$T/radii"
"$B/settle" --quiet --time 1 --frames 2 >"$T/bed" || exit 1
awk '/^# t=1$/ {last = 1} last' "$T/bed" >"$T/tail"
sed -n '/^# t=/q; p' "$T/bed" | cat - "$T/tail" >"$T/last" # the last frame alone

# --- fraction -------------------------------------------------------------------
printf '# two boxes\n0 1 0 1 0 1\n\n\t.25 0.75 0 1  0 0.5 # half\r\n' >"$T/boxes"
run analyze --boxes "$T/boxes" --void "$T/lattice"
check "boxes: status" test "$status" = 0
check "boxes: columns" names 't\tx0\tx1\ty0\ty1\tz0\tz1\tsum\tunion\tvoid'
check "boxes: rows" is 'n == 2 && r["x0"] == 0.25 && r["z1"] == 0.5'
check "boxes: lattice" is 'near(s["sum"], pi / 3, 1e-14) &&
  near(s["union"], pi / 3, 1e-14) && near(s["void"], 2 - pi / 3, 1e-14)'
run analyze --boxes "$T/boxes" "$T/bed"
check "boxes: a row each frame and box" is 'n == 4'
check "boxes: frames are apart" test "$(grep -c '^$' "$T/out")" = 1
run analyze --until 0.9 --slab 0.25 "$T/lattice"
check "slabs" is 'n == 4 && r["z0"] == 0.75 && r["z1"] == 0.9'
check "slabs: of a lattice" is 'near(first["sum"], pi / 6, 1e-14)'
run analyze --until 1.5 --slab 0.1 "$T/last"
check "slabs: no sliver" is 'n == 15 && r["z1"] == 1.5'
# quotients that rounding has above a whole number: 7.000000000000001 and so on
for cut in 2.1/0.3/7 2.1/0.7/3 2.7/0.3/9; do
  IFS=/ read -r until slab want <<<"$cut"
  run analyze --until "$until" --slab "$slab" "$T/last"
  check "slabs of $slab up to $until" is "n == $want && r[\"z1\"] == $until"
done
run analyze --until 1.5 --slab 0.1 "$T/last"
slabs=$(awk 'NR > 1 {s += $8; u += $9} END {printf "%.17g %.17g", s/15, u/15}' "$T/out")
run analyze --until 1.5 "$T/last"
check "slabs: add up" is "near(r[\"sum\"], ${slabs% *}, 1e-13) &&
  near(r[\"union\"], ${slabs#* }, 1e-13)"
run analyze --void --sampled 10 "$T/one"
check "void beside sampled" names 't\tsum\tunion\tvoid\tsampled_sum\tsampled_union'

boxes() { printf '%b' "$1" >"$T/bad"; }
boxes '0 1 0 1 0 1\n0 1 0 1 0\n'
printf 'x,y,z,r\n0.5,0.5,0.5,1e9\n' > "$T/huge"
refuse "a sphere too large for the box" 3 'too small' "$T/huge"
# six digits are left where the box is 1e-9 of r^3
printf 'x,y,z,r\n-989.5,0.5,0.5,990\n' >"$T/large"
run analyze --box 0,1,0,1,0,1 "$T/large"
# up to x = 0.5 and the little that the sphere bends away: (1/12 + 1/12) / 2r
check "a sphere that is just not too large" is 'near(r["union"], 0.5 - 1 / 12 / 990,
  1e-6)'
printf 'x,y,z,r\n-1009.5,0.5,0.5,1010\n' >"$T/large"
refuse "a sphere that is just too large" 3 'too small' "$T/large"
refuse "boxes: five numbers" 3 'bad:2: expected six' --boxes "$T/bad" "$T/one"
boxes '0 1 0 1 0 1 1\n'
refuse "boxes: seven numbers" 3 'bad:1: expected six' --boxes "$T/bad" "$T/one"
boxes '#\n0 1 0 1 0 x\n'
refuse "boxes: text" 3 'bad:2: expected six' --boxes "$T/bad" "$T/one"
boxes '0 1 0 1 0 nan\n'
refuse "boxes: nan" 3 'bad:1: expected six' --boxes "$T/bad" "$T/one"
boxes '0 1 0 1 1 0\n'
refuse "boxes: turned" 3 'bad:1: expected x0 < x1' --boxes "$T/bad" "$T/one"
boxes '# none\n'
refuse "boxes: none" 3 'bad: no boxes' --boxes "$T/bad" "$T/one"
refuse "boxes: no file" 1 'nowhere' --boxes "$T/nowhere" "$T/one"
refuse "boxes beside box" 2 '--boxes' --boxes "$T/boxes" --slab 1 "$T/one"
refuse "until below" 2 'z0 < z1' --until -1 "$T/one"
run analyze --slab 1e12 "$T/last"
check "slabs: one taller than the box" is 'n == 1 && r["z0"] == 0 && r["z1"] == 1'
refuse "too many slabs" 2 'at most' --slab 1e-9 "$T/one"

# --- profile --------------------------------------------------------------------
run analyze profile --points 4 "$T/lattice"
check "profile: columns" names 't\tz\tsum\tunion'
# the planes through 1/8, 3/8, ... are those of the centres
check "profile: lattice" is 'n == 4 && first["z"] == 0.125 &&
  near(s["sum"] / 4, pi / 4, 1e-14) && near(s["union"] / 4, pi / 4, 1e-14)'
for axis in x y z; do
  run analyze profile --axis $axis --points 2 "$T/one"
  check "profile: one sphere, $axis" is 'near(r["sum"],
    pi * (0.09 - 0.0625), 1e-15) && r["'$axis'"] == 0.75'
done
run analyze profile --points 1 "$T/two" # two circles of equal size in one place
check "profile: two spheres" is 'near(r["sum"], 2 * pi * 0.03, 1e-15) &&
  near(r["union"], pi * 0.03, 1e-15)'
run analyze profile --axis x --points 1 "$T/two" # a lens less
check "profile: two spheres overlap" is 'near(r["sum"], 0.08 * pi, 1e-15) &&
  near(r["union"], 0.08 * pi - 2 * (0.04 * pi / 3 - 0.1 * sqrt(0.03)), 1e-15)'

# The mean of the rows is the midpoint rule. A sphere's area has the second
# derivative -2 pi over its length of 2 r, where it ends its slope jumps by
# 2 pi r: together at most 2 pi r h^2 (1/12 + 2/8) for each of the 200.
run analyze "$T/last"
sum=$(awk 'NR == 2 {print $2}' "$T/out") union=$(awk 'NR == 2 {print $3}' "$T/out")
for axis in x y z; do
  run analyze profile --axis $axis --points 400 "$T/last"
  check "profile: integrates to the fraction, $axis" is "near(s[\"sum\"] / n, $sum, 200 * 0.2 * pi / 3 / 160000) &&
    near(s[\"union\"] / n, $union, 200 * 0.2 * pi / 3 / 160000)"
done
run analyze profile --from-wall 0.5 --points 400 "$T/last"
awk -F '\t' -v OFS='\t' 'NR == 1 {print; next} # by the perimeter of the shell
  {w = 4 * (1 - 2 * $2) / 2; print $1, $2, $3 * w, $4 * w}' "$T/out" >"$T/w"
check "profile: columns of shells" names 't\tdistance\tsum\tunion'
mv "$T/w" "$T/out"
check "profile: shells integrate to the fraction" is "near(s[\"sum\"] / n, $sum, 2e-4) && near(s[\"union\"] / n, $union, 2e-4)"
run analyze profile --cylinder 0.5,0.5,0.3 --points 3 "$T/one"
check "profile: columns of a cylinder" names 't\tradius\tsum\tunion'
# the line on the cylinder of radius a is 2 sqrt(r^2 - a^2) long all around
check "profile: sphere in a cylinder" is 'n == 3 && near(r["radius"], 0.25, 1e-15) &&
  near(r["sum"], 2 * sqrt(0.0275), 1e-14) && r["union"] == r["sum"]'
run analyze profile --cylinder 0.5,0.5,0.3 --from-wall 0.1 --points 1 "$T/one"
check "profile: distance from the mantle" is 'near(r["distance"], 0.05, 1e-15) &&
  near(r["sum"], 2 * sqrt(0.0275), 1e-14)'
printf 'x,y,z\n0.2,0.5,0.5\n' >"$T/csv"
run analyze profile --axis x --cylinder 0.5,0.5,0.1 --points 1 --radius 0.2 "$T/csv"
check "profile: cylinder along x" is 'near(r["sum"], 2 * sqrt(0.0375), 1e-14)'
run analyze profile --points 3 "$T/bed"
check "profile: frames are apart" test "$(grep -c '^$' "$T/out")" = 1
# The bed's own tube: three spheres, of which two overlap, in an upright tube and
# turned with it, by the rotation that takes z to (1, 2, 2)/3.
spheres='0.1 0 1 0.2
0.25 0.05 1.1 0.15
-0.3 0.1 1.6 0.1'
upright() { # the bed, by rows of spheres
  printf '%b' '# format=bed-1\n# cylinder=0 0 0 0 0 1 0.5\nx\ty\tz\tr\n'
  awk -v OFS='\t' '{ print $1, $2, $3, $4 }' <<<"$spheres"
  echo '# status=ok'
}
upright >"$T/upright"
{
  printf '%b' '# format=bed-1\n# cylinder=4 5 6 1 2 2 0.5\nx\ty\tz\tr\n'
  # (2, 1, -2)/3, (-2, 2, -1)/3 and (1, 2, 2)/3 are the turned axes
  awk -v OFS='\t' '{ printf "%.17g\t%.17g\t%.17g\t%s\n",
    4 + (2 * $1 - 2 * $2 + $3) / 3, 5 + ($1 + 2 * $2 + 2 * $3) / 3,
    6 + (-2 * $1 - $2 + 2 * $3) / 3, $4 }' <<<"$spheres"
  echo '# status=ok'
} >"$T/turned"
run analyze profile --radial --along 0,2 --points 1000 "$T/turned"
check "radial: columns" names 't\tradius\tsum\tunion'
cp "$T/out" "$T/w"
run analyze profile --cylinder 0,0,0.5 --box=-1,1,-1,1,0,2 --points 1000 "$T/upright"
check "radial: an inclined tube is like an upright one" awk 'function abs(x) {
    return x < 0 ? -x : x }
  NR == FNR { sum[FNR] = $3; union[FNR] = $4; next }
  FNR > 1 && !(abs(sum[FNR] - $3) < 1e-12 && abs(union[FNR] - $4) < 1e-12) { bad = 1 }
  END { exit bad || FNR != 1001 }' "$T/out" "$T/w"
# what the shells have is what the spheres are: midpoints of square-root edges
volumes=$(awk '{ v += 4 / 3 * atan2(0, -1) * $4 ^ 3 } END { printf "%.17g", v }' \
  <<<"$spheres")
run analyze --box=-1,1,-1,1,0,2 "$T/upright"
united=$(awk 'NR == 2 { printf "%.17g", 8 * $3 }' "$T/out")
awk 'NR > 1 { h = 0.5 / 1000; s += 2 * atan2(0, -1) * $2 * 2 * $3 * h
  u += 2 * atan2(0, -1) * $2 * 2 * $4 * h } END { printf "%.17g %.17g\n", s, u }' \
  "$T/w" >"$T/integral"
check "radial: the sum is conserved: $(cat "$T/integral"), $volumes" awk -v v="$volumes" \
  '{ d = $1 / v - 1; exit !(d < 3e-5 && d > -3e-5) }' "$T/integral"
check "radial: the union is conserved: $united" awk -v v="$united" \
  '{ d = $2 / v - 1; exit !(d < 3e-5 && d > -3e-5) }' "$T/integral"
run analyze profile --radial --from-wall 0.25 --along 0,2 --points 500 "$T/turned"
check "radial: from the wall" awk 'NR == FNR { sum[FNR] = $3; next }
  FNR > 1 && !(sum[1003 - FNR] - $3 < 1e-12 && $3 - sum[1003 - FNR] < 1e-12) { bad = 1 }
  END { exit bad || FNR != 501 }' "$T/w" "$T/out"
# on a floor: the bottom cube on the square inscribed in the tube
sed 's/^# cylinder=.*/&\n# wall=0 0 0 0 0 -1/' "$T/upright" >"$T/floor"
run analyze profile --radial --points 10 "$T/floor"
cp "$T/out" "$T/w"
run analyze profile --cylinder 0,0,0.5 --points 10 "$T/floor"
check "radial: on a floor" cmp -s "$T/w" "$T/out"
sed 's/^# cylinder=.*/# cylinder=0 0 7 0 0 -1 0.5/' "$T/floor" >"$T/down"
run analyze profile --radial --points 10 "$T/down"
check "radial: an axis that points down" awk 'NR == FNR { u[FNR] = $4; next }
  FNR > 1 && !(u[FNR] - $4 < 1e-12 && $4 - u[FNR] < 1e-12) { bad = 1 }
  END { exit bad || FNR != 11 }' "$T/w" "$T/out"
refuse "radial: no floor" 3 'expected --along' profile --radial "$T/turned"
refuse "radial: no tube" 3 'no cylinder' profile --radial "$T/one"
sed 's/^# cylinder=.*/&\n&/' "$T/turned" >"$T/twice"
refuse "radial: two tubes" 3 'several cylinders' profile --radial "$T/twice"
refuse "radial: and a cylinder" 2 'no --cylinder' profile --radial --cylinder 0,0,1 "$T/one"
refuse "radial: along what" 2 'expected --radial' profile --along 0,1 "$T/one"

refuse "from-wall beyond the middle" 2 '--from-wall 0.6: expected at most 0.5' \
  profile --from-wall 0.6 "$T/one"
refuse "from-wall beyond the axis" 2 '--from-wall 0.3: expected at most 0.2' \
  profile --cylinder 0.5,0.5,0.2 --from-wall 0.3 "$T/one"
refuse "cylinder of no radius" 2 '--cylinder' profile --cylinder 0,0,0 "$T/one"
refuse "no axis" 2 'one of x y z' profile --axis w "$T/one"
refuse "empty box" 2 '--box' profile --box 0,1,0,1,1,1 "$T/one"

is_line() { # PATTERN: the one line on standard error
  [ "$(wc -l <"$T/err")" = 1 ] && grep -Eq -e "$1" "$T/err"
}
nowhere() { ! grep -q "$@"; }

# --- radius -----------------------------------------------------------------------
run analyze radius --report "$T/two"
check "radius: columns" names \
  't\tkeep\tradius\tsum\tunion\toverlaps\tmean_overlap\tlargest_overlap'
awk -F '\t' '$2 == "touching"' "$T/out" >"$T/w"
check "radius: two spheres touch" is 'n == 4'
check "radius: at 0.1" test "$(cut -f 3 "$T/w")" = 0.09999999999999998
run analyze radius --report --keep fraction=0.1 --of sum "$T/one"
check "radius: of a sum" is 'near(r["radius"], exp(log(0.075 / pi) / 3), 1e-15) &&
  r["keep"] == "fraction=0.1"'
check "radius: no contacts, no radius" grep -q "contact-mean	nan" "$T/out"
for keep in contact-mean touching fraction=0.6; do
  run analyze radius --keep $keep "$T/last"
  check "radius: $keep: status" test "$status" = 0
  check "radius: $keep: says so in one line" test "$(wc -l <"$T/err")" = 1
  check "radius: $keep: noted" grep -q "^# radius_keep=$keep" "$T/out"
  check "radius: $keep: the dynamics' is kept" grep -qx '# radius_dynamics=0.1' "$T/out"
  check "radius: $keep: in header and rows" is "$(sed -n \
    's/^# radius=/1 * r["r"] == 1 * /p' "$T/out")"
  cp "$T/out" "$T/re"
  run analyze radius --keep nominal --quiet "$T/re"
  check "radius: $keep: there and back" cmp -s "$T/out" "$T/last"
  check "radius: quiet" test ! -s "$T/err"
done
run analyze --box 0,1,0,1,0,1 "$T/re" # fraction=0.6
check "radius: the fraction is there" is 'near(r["union"], 0.6, 1e-13)'
run analyze radius --quiet --keep touching "$T/bed"
check "radius: every frame" test "$(grep -c '^# radius_keep' "$T/out")" = 2
run settle --quiet --scene "$T/last" --time 1.01
cp "$T/out" "$T/w"
run settle --quiet --scene "$T/re" --time 1.01
check "restart from a rewritten bed goes on from the dynamics' radius" \
  cmp -s "$T/out" "$T/w"
check "restart says so" grep -q '^settle: .*radius_dynamics=0.1' "$T/err"
unsealed "$T/re" | sed 's/^# radius_dynamics=.*/# radius_dynamics=no/' >"$T/bad"
run settle --quiet --scene "$T/bad" --time 1.01
check "restart: a bad key" test "$status" = 3
refuse "radius: a bad key" 3 'radius_dynamics: expected' radius "$T/bad"
refuse "radius: of two sizes" 3 'one radius' radius "$T/radii"
for keep in touching contact-mean; do
  run analyze radius --keep $keep "$T/one"
  check "radius: no $keep in any frame" [ "$status" = 3 ]
  check "radius: no $keep: says so in one line" is_line "t=0: there is no radius for --keep $keep\$"
  check "radius: no $keep: what was written is marked" nowhere '^# status=ok' "$T/out"
done
# a film that begins without contacts, and whose first frame cannot fill a half
printf '# format=bed-1\n# radius=0.1\n# t=0\nx\ty\tz\n.2\t.5\t3\n.5\t.5\t3\n\n
# t=1\nx\ty\tz\n.2\t.5\t.5\n.38\t.5\t.5\n# status=ok\n' >"$T/film"
run analyze radius --keep contact-mean --quiet "$T/film"
check "radius: frames without contacts keep theirs" is_line \
  't=0: there is no radius for --keep contact-mean, nominal is kept$'
check "radius: all of the film" test "$status" = 0
check "radius: radii of the film" test \
  "$(sed -n 's/^# radius=//p' "$T/out" | tr '\n' ' ')" = '0.1 0.09 '
refuse "radius: unknown" 2 '--keep loose: expected nominal' radius --keep loose "$T/one"
refuse "radius: all of it" 2 'below 1' radius --keep fraction=1 "$T/one"
refuse "radius: nothing" 2 'above 0' radius --keep fraction=0 "$T/one"
refuse "radius: no number" 2 'fraction=F' radius --keep fraction=x "$T/one"
sed '$d' "$T/last" >"$T/cut"
refuse "radius: of a cut file" 3 'cut short' radius --report "$T/cut"
run analyze radius --allow-partial --quiet --keep touching "$T/cut"
check "radius: a cut file stays marked" grep -qx '# status=cut' "$T/out"
run analyze radius --quiet --keep touching --radius 0.2 "$T/csv"
check "radius: a table of one sphere has none" test "$status" = 3
printf 'x,y,z\n0.2,0.5,0.5\n0.5,0.5,0.5\n' >"$T/csv"
run analyze radius --quiet --keep touching --radius 0.2 "$T/csv"
check "radius: a table becomes a bed" is 'near(r["r"], 0.15, 1e-15)'
check "radius: a bed of its own" grep -qx '# format=bed-1' "$T/out"
cp "$T/out" "$T/re"
run analyze "$T/re"
check "radius: read again" is 'near(r["sum"], 8 * pi / 3 * 0.15 ^ 3, 1e-14)'

check_done
