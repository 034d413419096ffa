#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Where analyze looks: its default box and what it says of one without spheres,
# the reach of contacts, shells that spheres only touch, memory that fails.
# Files in tests/cases are situations that went wrong once. Run from the root of
# the repository; B is the directory of the programs.
. tests/harness.sh

run() { # ARGUMENT...: of analyze; into $T/out, $T/err and $status
  timeout 60 "$B/analyze" "$@" >"$T/out" 2>"$T/err" </dev/null
  status=$?
}

last() { # NAME: a column of the last row in $T/out
  awk -F '\t' -v name="$1" '/^#/ || !NF {next}
    /^[a-z]/ {for (k = 1; k <= NF; k++) if ($k == name) column = k; next}
    {value = $column}
    END {print value}' "$T/out"
}

says() { # NAME PATTERN: the one line of standard error
  one_line() {
    [[ $(wc -l <"$T/err") == 1 ]] && grep -Eq -e "^analyze: $1" "$T/err"
  }
  check "$1: says '$2'" one_line "$2"
}

silent() { # NAME: nothing on standard error, and status 0
  nothing() { [[ $status == 0 && ! -s $T/err ]]; }
  check "$1: status $status, no message" nothing
}

# --- the default box -----------------------------------------------------------
# 2 x 3 x 2 spheres of 0.25 m, and two more that are above the bottom cube
container() { # X0 X1 Y0 Y1 Z0: a bed with walls there
  printf '# format=bed-1\n# t=0\n# radius=0.25\n'
  printf '# wall=%s\n' "0 0 $5 0 0 -1" "$1 0 0 -1 0 0" "$2 0 0 1 0 0" \
    "0 $3 0 0 -1 0" "0 $4 0 0 1 0"
  printf 'x\ty\tz\n'
  awk -v x="$1" -v y="$3" -v z="$5" 'BEGIN {OFS = "\t"
    for (i = 0; i < 2; i++) for (j = 0; j < 3; j++) for (k = 0; k < 6; k++)
      print x + 0.25 + i / 2, y + 0.25 + j / 2, z + 0.25 + k / 2}'
  echo '# status=ok'
}
container 0 1 0 1.5 0 >"$T/base"
container 7 8 -3 -1.5 2 >"$T/elsewhere"
for bed in base elsewhere; do
  # any cube of their lattice is filled by pi/6
  run "$T/$bed"
  silent "$bed: fraction"
  within "$bed: sum" "$(last sum)" 0.523598775598 0.523598775599
  within "$bed: union" "$(last union)" 0.523598775598 0.523598775599
  run fraction --slab 0.5 "$T/$bed"
  silent "$bed: slabs"
  check "$bed: slabs of the cube" test "$(wc -l <"$T/out")" = 3
  run fraction --until 100 "$T/$bed"
  silent "$bed: until"
  within "$bed: from the floor on" "$(last sum)" 0.015 0.017
  run profile --points 2 "$T/$bed"
  silent "$bed: profile"
  run profile --from-wall 0.5 --points 1 "$T/$bed"
  silent "$bed: as far as the middle"
  run rest "$T/$bed"
  within "$bed: rest" "$(last union)" 0.523598775598 0.523598775599
  run radius --report "$T/$bed"
  within "$bed: radius" "$(awk '$2 == "touching" {print $5}' "$T/out")" \
    0.523598775598 0.523598775599
done
run profile --points 2 "$T/elsewhere"
within 'the profile is of the cube' "$(last z)" 2.75 2.75

# Without walls the box is the unit cube, which may be no answer.
awk '!/wall/' "$T/base" >"$T/bare"
run "$T/bare"
silent 'no walls: the unit cube'
awk '!/wall/' "$T/elsewhere" >"$T/far"
span='the spheres span 7,8,-3,-1\.5,2,5 m'
for verb in fraction 'fraction --slab 0.5' 'profile --points 2' rest \
  'radius --report'; do
  run $verb "$T/far"
  check "$verb, elsewhere: status" test "$status" = 0
  says "$verb, elsewhere" "$T/far: no sphere is in the box 0,1,.* $span"
done
for verb in fraction profile contacts gr order rest 'radius --report'; do
  run $verb --box 1,2,3,4,5,6 "$T/far"
  says "$verb, a box elsewhere" \
    "$T/far: no sphere is in the box 1,2,3,4,5,6; $span"
  run $verb --box 7,8,-3,-2,2,3 "$T/far"
  silent "$verb, the box of the bed"
done
# an image of nothing; csv is of the spheres, wherever they are
warned() { # NAME PATTERN: one such line among others
  check "$1: '$2'" test "$(grep -Ec "^analyze: $2" "$T/err")" = 1
}
export() { # FORMAT FILE OPTION...
  run export --format "$1" --output "$T/of.$1" "${@:3}" "$2"
  check "export $1: status" test "$status" = 0
}
for format in 'raw --cells 4' 'vti --cells 4' 'palabos --cells 4' geo \
  'openfoam --cells 4' 'mhd --cells 4'; do
  export ${format%% *} "$T/far" $(cut -s -d ' ' -f 2- <<<"$format") --quiet
  warned "export $format, elsewhere" "$T/far: no sphere is in the box 0,1,.* $span"
done
rm -r "$T/of.openfoam"
export raw "$T/far" --cells 4 --box 7,8,-3,-2,2,3 --offset=-7,3,-2
check 'export, the box of the bed' test "$(grep -c 'no sphere' "$T/err")" = 0
export csv "$T/far"
check 'export csv: no remark' test "$(grep -c 'no sphere' "$T/err")" = 0
printf 'x,y,z,r,t\n1e6,0,0,1,0\n1000000.5,0,0,1,1\n' >"$T/frames"
export raw "$T/frames" --cells 4 # the last of two frames, and its digits
warned 'far away' "$T/frames: no sphere .*span 999999\.5,1000001\.5,-1,1,-1,1 m"
run --boxes <(echo 0 1 0 1 0 1; echo 7 8 -3 -2 2 3) "$T/far"
silent 'one of several boxes'
# one that reaches into the unit cube from outside; grains in its corner
printf 'x,y,z,r\n1.0999,0.5,0.5,0.1\n1.3,0.5,0.5,0.1\n' >"$T/cap"
run "$T/cap"
says 'a cap in the unit cube' "$T/cap: no sphere is in the box 0,1,0,1,0,1 .*"
run --box 0,1,0,1,0,1 "$T/cap"
silent 'a cap in a box that was given'
printf 'x,y,z,r\n0.004,0.004,0.001,0.001\n0.006,0.004,0.001,0.001\n' >"$T/grains"
run "$T/grains"
says 'grains of a millimetre' "$T/grains: has no walls, .*span 0\.003,0\.007,.*"
run --box 0,1,0,1,0,1 "$T/grains"
silent 'grains in a box that was given'
# frames: from above into the box
"$B/settle" --count 8 --model basic --time 0.5 --frames 6 >"$T/falling"
run "$T/falling"
silent 'spheres that fall into the box'
head -n -1 "$T/falling" | awk '/^# t=/ && $2 != "t=0" {exit} {print}
  END {print "# status=ok"}' >"$T/first"
run "$T/first"
says 'before they are in it' "$T/first: no sphere is in the box 0,1,0,1,0,1; .*"
printf 'ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS x y z radius\n' \
  >"$T/none"
run "$T/none"
silent 'no spheres at all'

# --- reach follows the spheres -------------------------------------------------
# 10,000 at random with some 400 pairs, in millimetres and a thousand times that
grains() { # SCALE
  awk -v s="$1" 'BEGIN {srand(1); print "x,y,z,r"
    for (i = 0; i < 10000; i++)
      printf "%.15g,%.15g,%.15g,%g\n", s * 161 * rand(), s * 161 * rand(),
        s * 161 * rand(), s}'
}
grains 0.001 >"$T/mm"
grains 1 >"$T/m"
# plain: all pairs
want=$(awk -F, 'NR > 1 {for (i = 0; i < n; i++) {
      dx = $1 - x[i]; if (dx > 2 || dx < -2) continue
      dy = $2 - y[i]; dz = $3 - z[i]; if (dx * dx + dy * dy + dz * dz <= 4) c++}
    x[n] = $1; y[n] = $2; z[n++] = $3}
  END {print c}' "$T/m")
within 'pairs to find' "$want" 300 500
limit='ulimit -v 300000'
! sanitized "memory's limits" || limit=:
for f in mm m; do
  for verb in contacts 'contacts --force 1' 'contacts --network' gr order \
    'radius --keep touching' rest; do
    ($limit && timeout 60 "$B/analyze" $verb "$T/$f") >"$T/out" \
      2>"$T/err"
    check "$verb of $f: little memory" test $? = 0
    [[ $verb != contacts ]] || check "pairs of $f" test "$(last pairs)" = "$want"
  done
done

# --- single precision ----------------------------------------------------------
printf 'x,y,z,r\n1000000,1000000,1000000,0.01\n' >"$T/far.csv"
for place in '' '--scale 1e-3' '--offset 1e39,0,0'; do
  "$B/analyze" export --format stl $place "$T/far.csv" >"$T/out" 2>"$T/err"
  check "STL, far from the origin $place: status $?" test $? = 3 -a ! -s "$T/out"
  says "STL, far from the origin $place" "t=0: single precision cannot hold .*"
done
offset=$(sed -n 's/.*expected \(--offset [^ ]*\).*/\1/p' "$T/err")
check 'the offset that is expected' test -n "$offset"
"$B/analyze" export --quiet --format stl --offset -1e6,-1e6,-1e6 "$T/far.csv" \
  >"$T/out"
check 'STL, as was expected' test "$(wc -c <"$T/out")" = $((84 + 320 * 50))

# --- memory that fails ---------------------------------------------------------
# With ever more of it: exit status 1 and "out of memory", or the right answer;
# never a row that has nan for want of memory. 80 kB a step hits allocations one
# by one, which take 80 kB and more.
if ! sanitized 'memory that fails'; then
  least=4000 # kB with which the program begins at all
  for ((step = 65536; step > 30; step /= 2)); do
    (ulimit -v $((least + step)) && exec "$B/analyze" --version) >"$T/out" 2>&1 ||
      least=$((least + step))
  done
  room=(--box 0,161,0,161,0,161)
  for verb in "fraction ${room[*]}" "rest ${room[*]}" \
    "radius --report --keep fraction=1e-3 ${room[*]}" contacts \
    "profile --points 1 --cylinder 80,80,161 ${room[*]}"; do
    "$B/analyze" $verb "$T/m" >"$T/want" 2>"$T/err" || fail "$verb: once"
    short=0 wrong=
    for ((limit = least + 80; limit < least + 100000; limit += 80)); do
      (ulimit -v $limit && exec "$B/analyze" $verb "$T/m") >"$T/out" 2>"$T/err" &&
        break
      status=$?
      short=$((short + 1))
      if [[ $status == 134 ]]; then # clang's threads end so
        grep -qiE '^OMP: Error.*(memory|SHM)' "$T/err"
      else
        [[ $status == 1 ]] && grep -q '^analyze: .*out of memory' "$T/err" &&
          ! grep -q nan "$T/out"
      fi || wrong="$wrong $limit: $status $(cat "$T/err")"
    done
    check "$verb: wrong for want of memory: $wrong" test -z "$wrong"
    check "$verb: out of memory at times" test $short -gt 10
    check "$verb: right with enough" cmp -s "$T/want" "$T/out"
  done
fi

# --- shells that spheres touch -------------------------------------------------
run profile --cylinder 0,0,0.5 --points 1 --box -1,1,-1,1,-1,1 \
  tests/cases/shell-far-point.csv
within 'far point: sum' "$(last sum)" 0.6395980275 0.6395980277
within 'far point: union' "$(last union)" 0.5043949749 0.5043949751
run profile --cylinder 0,0,2 --points 1 --box -2,2,-2,2,-1,0.75 \
  tests/cases/shell-tangent.csv
within 'tangent: sum' "$(last sum)" 0 1e-8
within 'tangent: union' "$(last union)" 0 "$(last sum)"

check_done
