#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files as others write them, in tests/cases: read with the right value, or
# refused with a message that says what is missing. A sphere of radius 1 fills
# a = pi/6000 of the box that is used here. Run from the root of the repository;
# B is the directory of the programs.
. tests/harness.sh

cases=tests/cases
box=--box=-10,10,-10,10,-10,10
a=5.2359877559829887e-4

reads() { # FILE ROWS OPTION...: a row each "t spheres", by their volume
  local rows=$2
  "$B/analyze" $box "${@:3}" "$cases/$1" >"$T/out" 2>"$T/err"
  check "$1: exit status $?" test $? = 0
  awk -v a=$a 'NR > 1 {printf "%s %.9g\n", $1, $2 / a}' "$T/out" >"$T/got"
  check "$1: '$(tr '\n' ';' <"$T/got")', expected '$rows'" \
    test "$(paste -s -d ';' "$T/got")" = "$rows"
}

says() { # FILE PATTERN: the last one read was read with this remark
  check "$1: says $2" grep -q "^analyze: $cases/$1:$2" "$T/err"
}

refuses() { # FILE PATTERN OPTION...
  "$B/analyze" $box "${@:3}" "$cases/$1" >"$T/out" 2>"$T/err"
  local status=$?
  check "$1: exit status $status" test $status = 3
  check "$1: one line, '$2'" test "$(wc -l <"$T/err")" = 1 -a \
    "$(grep -c "^analyze: $cases/$1:$2" "$T/err")" = 1
}

# --- columns that are not what they look like ---------------------------------
reads temperature.csv '0 3'
reads temperature-falls.csv '0 3'
reads temperature-kelvin.tsv '0 3'
refuses temperature-or-time.csv "1: column 'T' .*time or a temperature.*expected"
reads temperature-or-time.csv '1 2;2 1' --columns id,x,y,z,r,t
reads temperature-or-time.csv '0 3' --columns -,x,y,z,r,-
reads steps.csv '0 2;100 1'
reads colours.csv '0 2'
refuses colours-only.csv "1: .*no radius: 'R' beside 'G' and 'B' is a colour"
reads colours-only.csv '0 2' --radius 1
reads radial-and-diameter.csv '0 0.054'
refuses r-against-diameter.csv "2: column 'r' is 5 and column 'diameter' is 0.6"
reads r-against-diameter.csv '0 0.054' --columns id,x,y,z,-,d
reads r-and-diameter.csv '0 0.036926037'
refuses radial.csv "1: column 'r' .*'theta' is there.*expected"
reads radial.csv '0 2' --columns x,y,z,-,- --radius 1
refuses two-places.csv "1: columns 'x' and 'pos_x' both may be x: expected one"
reads two-places.csv '0 1' --columns -,-,-,r,x,y,z
reads keys-of-others.csv '0 2'
reads keys-of-others.tsv '0 1'
# one that looks like ours is told why it does not count
for key in radius=0.25 ' radius=0.25' radios=0.25; do
  printf '#%s\nx,y,z\n0,0,0\n' "$key" >"$T/key"
  ! "$B/analyze" "$T/key" >"$T/out" 2>"$T/err"
  check "#$key: refused" [ $? -eq 0 ]
  check "#$key: why" [ "$(grep -c "no radius: a key counts only under '# format" \
    "$T/err")" = "$([[ $key == radios* ]] && echo 0 || echo 1)" ]
done
reads number-first.xyz '0 2'
"$B/analyze" export --format positions --radius 0.5 $cases/number-first.xyz \
  >"$T/out"
check 'number-first.xyz: x y z come first' cmp -s "$T/out" \
  <(printf '1.5\t2.5\t3.5\n-4.25\t0.5\t1.25\n')
refuses number-first-whole.xyz "4: '-4.25 0.5.*expected a name" \
  --radius 1
reads no-names.xyz '0 2' --radius 1
reads quoted.xyz '2 1'
reads quoted-last.xyz '2 1'
refuses hex.csv "2: column x is '0x10': expected a decimal number"
refuses infinite.csv "2: column r is 'infinity'"

refuses half-units.csv "2: column 'x .mm.' has a unit and column 'r' has none"
reads half-units.csv '0 1' --columns 'x [mm],y [mm],z [mm],r [m]'
refuses colours.dump "9: .*no radius: 'r' beside 'g' and 'b' is a colour"
reads colours.dump '0 1' --radius 1
refuses radial.dump "9: column 'r' .*'theta' is there.*expected"
refuses colours.xyz "2: .*no radius: 'r' beside 'g' and 'b' is a colour"
reads colours.xyz '0 1' --radius 1
reads colours-and-radius.xyz '0 1'
refuses two-behind.xyz '3: .*no radius: --columns says what is behind z'
reads two-behind.xyz '0 1' --columns -,x,y,z,-,r
reads radius-later.xyz '0 0;1 1'
says radius-later.xyz '5: the column behind z is taken as the radius'

# --- what is right though it looks odd ----------------------------------------
reads quoted-semicolon.csv '0 1'
reads name-with-comma.tsv '0 1'
reads quoted-comma.csv '0 1'
reads doubled-quotes.csv '0 2'
reads quoted-line-ends.csv '0 2'
reads paraview.csv '0 2'
reads paraview-new.csv '0 2'
reads position-dots.csv '0 2'
reads millimetres.csv '0 2'
reads title-and-units.csv '0 2'
reads excel.csv '0 2'
reads text-ids.csv '0 2'
reads r-write-csv.csv '0 2'
reads r-write-table.txt '0 2'
reads r-row-names.txt '0 2'
refuses one-more.txt '2: more than the 4 columns named'
reads one-more.txt '0 2' --columns -,x,y,z,r
reads positions.txt '0 2' --radius 1
refuses positions.txt '1: .*no radius: expected'
reads positions.csv '0 2' --radius 1
refuses cylindrical.txt '1: three columns, but not x, y and z: expected' \
  --radius 1
refuses four-columns.txt '1: 4 columns without names: expected --columns'
reads four-columns.txt '0 2' --columns x,y,z,r
reads five-columns.txt '0 2' --columns -,x,y,z,d
reads matlab.txt '0 2'
reads slashes.txt '0 2'
reads names-again.csv '0 2;0 1'
reads runs.csv '0 1;1 2;0 1;1 1'
refuses time-falls.csv '4: time 0 after 1: expected rows sorted by time'
reads radius-fifth.xyz '0 9'
says radius-fifth.xyz '3: the column behind z is taken as the radius'
refuses charge-fifth.xyz '4: radius -1: expected'
reads charge-fifth.xyz '0 2' --radius 1
reads general-triclinic.dump '0 1'
reads general-triclinic-scaled.dump '0 1'
"$B/analyze" export --format positions $cases/general-triclinic-scaled.dump \
  >"$T/out"
check 'the middle of a general triclinic box' cmp -s "$T/out" \
  <(printf '1.75\t-0.375\t-0.5\n') # origin and half of each edge
reads empty-first.dump '0 0;100 1'
reads empty-first.xyz '0 0;1 1'
for f in empty-first.dump empty-first.xyz; do
  for verb in contacts rest order; do
    "$B/analyze" $verb $cases/$f >"$T/out" 2>"$T/err"
    check "$f: $verb of the frame that has a sphere: status $?" test $? = 0 -a \
      "$(wc -l <"$T/out")" = 2
  done
done

# one frame is the last one that has spheres, for export as for draw and settle
reads empty-last.xyz '0 1;1 1;2 0'
"$B/analyze" export --format positions $cases/empty-last.xyz >"$T/out" 2>/dev/null
check 'empty-last.xyz: positions' cmp -s "$T/out" <(printf '0\t0\t3\n')
"$B/analyze" export --format bed $cases/empty-last.xyz 2>/dev/null |
  "$B/analyze" $box >"$T/out" 2>/dev/null
check 'empty-last.xyz: a bed that is one' awk -v a=$a '
  NR == 2 {good = $1 == 1 && $3 / a - 1 < 1e-12 && 1 - $3 / a < 1e-12}
  END {exit !good || NR != 2}' "$T/out"
"$B/analyze" export --format bed --frame 2 $cases/empty-last.xyz >"$T/out" \
  2>"$T/err"
check "a bed of no spheres: status $?" test $? = 3 -a ! -s "$T/out" -a \
  "$(grep -c 't=2: no spheres' "$T/err")" = 1

# --- data files of LAMMPS -----------------------------------------------------
reads sphere.data '0 2'
"$B/analyze" export --format csv $cases/sphere.data >"$T/out"
check 'sphere.data: mass, velocity and spin' awk -F , '
  $2 == 1 {good = $7 - 4 * atan2(0, -1) < 1e-12 && $7 - 4 * atan2(0, -1) > -1e-12
    for (k = 8; k <= 13; k++) good = good && $k == k - 7}
  END {exit !good}' "$T/out"
reads atomic.data '0 2' --radius 1
refuses atomic.data '14: .*no radius'
"$B/analyze" export --format csv --radius 1 $cases/atomic.data >"$T/out"
check 'atomic.data: the mass of the type' \
  test "$(tail -n 1 "$T/out" | cut -d , -f 7)" = 7
# the type is the second word or the third
while read -r style row; do
  printf '%s\n' 'LAMMPS data file' '' '1 atoms' '2 atom types' '' Masses '' '1 2.5' \
    '2 7' '' "Atoms # $style" '' "$row" >"$T/type"
  "$B/analyze" export --quiet --format csv --radius 1 "$T/type" >"$T/out"
  check "the type of style $style" \
    test "$(tail -n 1 "$T/out" | cut -d , -f 2-7)" = 1,3,4,5,1,7
done <<'END'
atomic 1 2 3 4 5
charge 1 2 0.5 3 4 5
bond 1 9 2 3 4 5
molecular 1 9 2 3 4 5
angle 1 9 2 3 4 5
full 1 9 2 0.5 3 4 5
END
# without a style by the number of words, three of which may be images
for row in '1 2 2.5 2 3 4 5' '1 2 2.5 2 3 4 5 0 0 0' '1 2 3 4 5' '1 2 3 4 5 0 0 0'; do
  printf '%s\n' 'LAMMPS data file' '' '1 atoms' '2 atom types' '' Atoms '' "$row" \
    >"$T/style"
  radius=() r=1.25
  [[ $row == *2.5* ]] || radius=(--radius 1) r=1
  "$B/analyze" export --quiet --format csv "${radius[@]}" "$T/style" >"$T/out"
  check "no style: $row" test "$(tail -n 1 "$T/out" | cut -d , -f 2-6)" = 1,3,4,5,$r
done
reads no-style.data '0 3.90625'
refuses full-or-sphere.data '8: 7 fields, and no atom style: expected'
reads full-or-sphere.data '0 2' --columns id,-,d,-,x,y,z
refuses ellipsoid.data "6: atom style 'ellipsoid': expected sphere"
refuses cut.data '13: .*another velocity is expected'
reads cut.data '0 2' --allow-partial
says cut.data '13: cut short: 2 of 2 spheres'

# --- scenes: any format, and what it has not is said ----------------------------
scene() { # FILE OPTION...: two spheres, 5 apart, fall freely for 0.1 s
  "$B/settle" --quiet --time 0.1 --scene "$cases/$1" "${@:2}" >"$T/out" \
    2>"$T/err"
  check "$1: a scene: status $?" test $? = 0
  check "$1: a scene: both fell" awk -F '\t' '
    /^id/ {for (k = 1; k <= NF; k++) at[$k] = k; next}
    /^[0-9]/ {n++; d = $at["z"] + 0.5 * 9.81 * 0.01
      if (d > 1e-9 || -d > 1e-9 || $at["r"] != 1) bad = 1}
    END {exit bad || n != 2}' "$T/out"
  check "$1: a scene: no walls, and that is said" grep -q \
    "^settle: $cases/$1: has no walls" "$T/err"
}
for f in paraview.csv title-and-units.csv excel.csv text-ids.csv; do
  scene $f
done
scene positions.txt --radius 1
"$B/settle" --time 0.1 --scene $cases/positions.txt >"$T/out" 2>"$T/err"
check "a scene without a radius: status $?" test $? = 3
"$B/settle" --quiet --time 0.1 --scene $cases/sphere.data --wall 0,0,-5,0,0,-1 \
  >"$T/out" 2>"$T/err"
check "a scene with --wall: status $?" test $? = 0 -a ! -s "$T/err"
check 'a scene with --wall: it is in the header' grep -qx '# wall=0 0 -5 0 0 -1' \
  "$T/out"
for verb in contacts rest; do
  "$B/analyze" $verb $cases/paraview.csv >"$T/out" 2>"$T/err"
  check "$verb: no walls" test "$(grep -c 'paraview.csv: has no walls' \
    "$T/err")" = 1
done
"$B/analyze" export --format bed --quiet $cases/paraview.csv >"$T/bed" \
  2>"$T/err"
check 'export --format bed: no walls' grep -q 'paraview.csv: has no walls' \
  "$T/err"
check 'a bed of it' test "$("$B/analyze" $box "$T/bed" | tail -n 1)" = \
  "$("$B/analyze" $box $cases/paraview.csv | tail -n 1)"
printf '# format=bed-1\n# t=0\nx\ty\tz\tr\n0\t0\t0\t1\n# status=ok\n' \
  >"$T/none"
"$B/analyze" contacts "$T/none" >"$T/out" 2>"$T/err"
check 'our own without walls: as it says' test ! -s "$T/err"
printf 'x,y,z,r\n0,0,0,1\n0,0,0,1\n' >"$T/same"
"$B/analyze" contacts "$T/same" >"$T/out" 2>"$T/err"
check 'an error is one line still' test $? = 3 -a "$(wc -l <"$T/err")" = 1

# --- columns that the user names, in every format -----------------------------
reads radius-fifth.xyz '0 1.125' --columns -,x,y,z,d
reads quoted.xyz '2 0.125' --columns -,x,y,z,d
reads general-triclinic.dump '0 0.125' --columns id,x,y,z,d
reads sphere.data '0 16' --columns id,-,r,-,x,y,z
reads sphere.data '0 16' --columns -,-,r,-,x,y,z
refuses keys-of-others.csv "6: 'x,y,z,r': expected rows of numbers in 5 col" \
  --columns x,y,z,-,r
"$B/analyze" --columns x,y,z,r "$T/none" >"$T/out" 2>"$T/err"
check "--columns for a bed: status $?" test $? = 3 -a \
  "$(grep -c "$T/none:3: --columns: a bed has names" "$T/err")" = 1

# --- options ------------------------------------------------------------------
for list in x,y x,y,z,q x,y,z,T x,x,y,z ''; do
  "$B/analyze" --columns "$list" $cases/positions.txt >"$T/out" 2>"$T/err"
  check "--columns '$list': status $?" test $? = 2 -a "$(wc -l <"$T/err")" = 1
done
for number in 0x10 nan inf 1e999 '1 2' 1,5 ''; do
  for option in --radius --until --slab; do
    "$B/analyze" $option "$number" $cases/positions.txt >"$T/out" 2>"$T/err"
    check "$option '$number': status $?" test $? = 2
  done
done
# --- a message has an end ----------------------------------------------------
printf '# format=bed-1\n# t=x%0900d\nx\ty\tz\tr\n' 0 >"$T/long"
"$B/analyze" "$T/long" >"$T/out" 2>"$T/err"
check 'a long word: exit status' test $? = 3
check 'a long word: what it is' grep -q "^analyze: $T/long:2: t=x000" "$T/err"
check 'a long word: 511 characters' test "$(wc -c <"$T/err")" = \
  $((511 + $(printf 'analyze: \n' | wc -c)))
check_done
