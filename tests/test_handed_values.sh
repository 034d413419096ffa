#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Single values of what analyze hands on and settle begins with, each against what a
# scene of a few spheres has by hand. Run from the root of the repository; B is the
# directory of the programs.
. tests/harness.sh

hand() { # FORMAT FILE OPTION...: what is said goes to $T/said
  timeout 60 "$B/analyze" export --format "$1" "${@:3}" "$2" </dev/null \
    2>"$T/said"
}

# --- LAMMPS: obstacles are of type 2, what moves of type 1
printf 'id\tx\ty\tz\tr\tfixed\n3\t.2\t.5\t.5\t.1\t0\n4\t.7\t.5\t.5\t.1\t1\n' \
  >"$T/obstacle"
hand lammps-data "$T/obstacle" >"$T/data"
check 'lammps-data: types' test "$(awk '
  $2 " " $3 == "atom types" {types = $1}
  /^Atoms/ {on = 1; next} /^Velocities/ {on = 0}
  on && NF {row = row " " $1 ":" $2}
  END {print types row}' "$T/data")" = '2 3:1 4:2'

# --- gmsh: a box around each sphere, with 1/1000 of the least radius to spare
{
  printf '# format=bed-1\n# t=0\n# wall=0 0 0 0 0 -1\n'
  printf '# cylinder=0.5 0.5 0 0 0 1 1\nx\ty\tz\tr\n'
  printf '.25\t.3\t.35\t.2\n.6\t.65\t.7\t.125\n# status=ok\n'
} >"$T/two"
hand geo "$T/two" --walls >"$T/geo"
check 'geo: boxes of spheres' awk '
  {x[1] = 0.25; x[2] = 0.3; x[3] = 0.35; r = 0.2}
  /^part\(\)/ {
    if (n++) {x[1] = 0.6; x[2] = 0.65; x[3] = 0.7; r = 0.125}
    gsub(/^[^{]*[{]|[}].*/, ""); split($0, c, /, */)
    for (k = 1; k <= 3; k++) {
      d = c[k] - (x[k] - r - 1.25e-4); e = c[k + 3] - (x[k] + r + 1.25e-4)
      if (d * d > 1e-20 || e * e > 1e-20) bad = 1
    }
  }
  END {exit bad || n != 2}' "$T/geo"
check 'geo: no sphere is cut' grep -q 'walls and faces cut no sphere' "$T/said"

# --- OpenFOAM: the axis of a leaning tube and the normal of the wall across it
{
  printf '# format=bed-1\n# t=0\n# cylinder=0.5 0.5 0 0.6 0 0.8 0.4\n'
  printf '# wall=0.5 0.5 0.1 -0.6 0 -0.8\n'
  printf 'x\ty\tz\tr\n0.7\t0.5\t0.4\t0.1\n# status=ok\n'
} >"$T/lean"
hand openfoam "$T/lean" --walls --cells 8 --output "$T/foam"
check 'openfoam: the tube and the wall' awk '
  function is(d, want) {d -= want; return d * d < 1e-20}
  {gsub(/[();]/, "")}
  $1 == "point1" {for (k = 2; k <= 4; k++) p[k] = $k}
  $1 == "point2" {
    for (k = 2; k <= 4; k++) {d[k] = $k - p[k]; dd += d[k] * d[k]}
    l = sqrt(dd); tube = is(d[2] / l, 0.6) && is(d[3], 0) && is(d[4] / l, 0.8)
  }
  $1 == "normal" && NF == 4 && is($3, 0) && $4 < -0.1 {
    wall = is($2 / $4, 0.75)
  }
  END {exit !(tube && wall)}' "$T/foam/system/snappyHexMeshDict"

# --- slabs: the last is what is left, here too thin beside a sphere
timeout 60 "$B/analyze" fraction --box 0,1,0,1,0,0.500000000000001 --slab 0.25 \
  "$T/two" >"$T/out" 2>"$T/err"
check 'fraction: as good as two slabs' test $? = 0
refused 3 'a box too small' "$B/analyze" fraction \
  --box 0,1e-4,0,1e-4,0,0.50000001 --slab 0.25 "$T/two"

# --- settle: a tube that is wider than a sphere and narrower than a place
"$B/settle" --quiet --count 3 --cylinder 0,0,0,0,0,1,0.115 --jitter 0 --time 0 \
  >"$T/narrow" 2>"$T/err"
check 'a narrow tube: one above the other on its axis' test "$(awk '
  /^[0-9]/ && $2 == 0 && $3 == 0 && $4 > z + 0.2 {n++; z = $4}
  END {print n}' "$T/narrow")" = 3

check_done
