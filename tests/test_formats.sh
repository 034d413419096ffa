#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# analyze reads what others write: from a file or a pipe, by content, whatever
# the name; and files that LAMMPS and ASE themselves wrote, where they are
# installed. Run from the root of the repository; B is the directory of the
# programs.
. tests/harness.sh

refuse() { # NAME STATUS PATTERN ARGUMENT...: one line, and it fits
  local name=$1 want=$2 pattern=$3
  "$B/analyze" "${@:4}" >"$T/out" 2>"$T/err" </dev/null
  local status=$?
  check "$name: exit status $status" test $status = "$want"
  check "$name: $(head -n 3 "$T/err")" test "$(wc -l <"$T/err")" = 1 -a \
    "$(grep -Ec "^analyze: $pattern" "$T/err")" = 1
}

# --- one bed in every format --------------------------------------------------
"$B/settle" --count 60 --base 0.8,0.8 --model basic --time 0.4 --frames 3 \
  >"$T/bed"
rows() { # AWK-PROGRAM: run with the columns by name, t and n of the frame
  awk -F '\t' '
    function flush() {if (n) frame(); n = 0}
    /^# t=/ {flush(); t = substr($0, 5)}
    /^id/ {next}
    /^[0-9]/ {row[++n] = $0}
    END {flush()}
    function cut(k) {
      split(row[k], c, "\t")
      id = c[1]; x = c[2]; y = c[3]; z = c[4]; r = c[5]}
    '"$1" "$T/bed"
}
rows 'BEGIN {print "Radius,Z,Y,X,ID,t,colour"}
  function frame() {for (k = 1; k <= n; k++) {
    cut(k); print r "," z "," y "," x "," id "," t ",red"}}' >"$T/a.xyz"
rows 'BEGIN {print "t;x;y;z;d"}
  function frame() {for (k = 1; k <= n; k++) {cut(k)
    s = sprintf("%s;%s;%s;%s;%.17g", t, x, y, z, 2 * r)
    gsub("[.]", ",", s); printf "%s\r\n", s}}' >"$T/b.dump"
rows 'function frame() {
    print n; print "Properties=species:S:1:pos:R:3:radius:R:1 Time=" t
    for (k = 1; k <= n; k++) {cut(k); print "A", x, y, z, r}}' >"$T/c.csv"
rows 'function frame() {
    print "ITEM: TIME\n" t "\nITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n" n
    print "ITEM: BOX BOUNDS pp pp ff\n0 1\n0 1\n0 1"
    print "ITEM: ATOMS id xs ys zs radius"
    for (k = 1; k <= n; k++) {cut(k); print id, x, y, z, r}}' >"$T/d.bed"
# of a box that does not depend on the walls, which only a bed has
box=(--box 0,1,0,1,0,1)
"$B/analyze" "${box[@]}" "$T/bed" >"$T/want"
check 'three frames' test "$(wc -l <"$T/want")" = 4
for f in a.xyz b.dump c.csv d.bed; do
  "$B/analyze" "${box[@]}" "$T/$f" >"$T/got"
  check "$f, a file" cmp -s "$T/want" "$T/got"
  cat "$T/$f" | "$B/analyze" "${box[@]}" >"$T/got"
  check "$f, a pipe" cmp -s "$T/want" "$T/got"
  { head -c 3 "$T/$f"; sleep 0.1; tail -c +4 "$T/$f"; } |
    "$B/analyze" "${box[@]}" - >"$T/got"
  check "$f, a slow pipe" cmp -s "$T/want" "$T/got"
done

# --- options and messages -----------------------------------------------------
printf 'x y z\n0.5 0.5 0.5\n' >"$T/bare"
refuse 'no radius' 3 "$T/bare:1: .*--radius" "$T/bare"
refuse 'a radius of 0' 2 '--radius 0: expected a number above 0' --radius 0 \
  "$T/bare"
"$B/analyze" --radius 0.25 "$T/bare" >"$T/got"
check '--radius' awk 'NR == 2 {d = $2 - 3.14159265358979 / 48
  exit !(d < 1e-14 && -d < 1e-14)}' "$T/got"
printf 'hello\nworld\n' >"$T/text"
refuse 'none of them' 3 "$T/text:1: 'hello': expected a bed, a table .*LAMMPS.*XYZ" \
  "$T/text"
refuse 'a program' 3 "$B/analyze:[0-9]*: a NUL byte" "$B/analyze"
head -c -2 "$T/a.xyz" >"$T/cut"
refuse 'cut short' 3 "$T/cut:181: .*cut short" "$T/cut"
"$B/analyze" "${box[@]}" --allow-partial "$T/cut" >"$T/got"
check '--allow-partial' cmp -s <(head -n 3 "$T/want") <(head -n 3 "$T/got")
printf 'ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS x y z radius\n' \
  >"$T/none"
check 'no spheres, no volume' test "$("$B/analyze" "$T/none" | tail -n 1)" = \
  $'0\t0\t0'
# a count is no reason to take memory: 4e9 spheres would be 500 GB
printf '4000000000\n\nA 1 2 3\n' >"$T/many"
refuse 'a wrong count' 3 "$T/many:3: .*cut short" --radius 1 "$T/many"

# --- files that others wrote --------------------------------------------------
near() { # FILE: is it the last frame's fraction, to a file's digits?
  "$B/analyze" "${box[@]}" "${@:2}" "$1" | awk -v tol=1e-5 '
    NR == FNR {want = $3; next} {got = $3}
    END {d = got - want; exit !(d < tol && -d < tol && want > 0)}' "$T/want" -
}
rows 'function frame() {if (t + 0 > 0.3) {
    print "a bed\n\n" n " atoms\n1 atom types\n"
    print "0 1 xlo xhi\n0 1 ylo yhi\n0 2 zlo zhi\n\nAtoms\n"
    for (k = 1; k <= n; k++) {
      cut(k); printf "%d 1 %.17g 1 %s %s %s\n", id + 1, 2 * r, x, y, z}}}' \
  >"$T/data"
cat >"$T/in" <<'END'
atom_style sphere
boundary f f f
read_data data
pair_style zero 1.0
pair_coeff * *
comm_modify vel yes
write_dump all custom dump id type x y z radius mass vx vy vz modify sort id
write_dump all custom scaled xs ys zs diameter
write_dump all custom short id xu yu zu
write_dump all xyz plain
END
lammps=$(command -v lmp || command -v lmp_stable || command -v lammps)
if [[ $lammps ]] && (cd "$T" && OMP_NUM_THREADS=1 timeout 60 "$lammps" -in in \
  -log none) >"$T/log" 2>&1; then
  for f in dump scaled 'short --radius 0.1' 'plain --radius 0.1'; do
    check "LAMMPS: $f" near "$T/"$f
  done
else
  echo 'skipped: LAMMPS (lmp) is not installed or did not run'
  tail -n 3 "$T/log" 2>/dev/null
fi

cat >"$T/write.py" <<'END'
import sys
from ase import Atoms
from ase.io import write
rows = [line.split() for line in open(sys.argv[1])]
x = [[float(c) for c in row[1:4]] for row in rows]
bed = Atoms('X%d' % len(x), positions=x, cell=[1, 1, 2])
bed.set_array('radius', __import__('numpy').array([float(r[4]) for r in rows]))
bed.info['Time'] = 0.4
write(sys.argv[2], [bed, bed], format='extxyz')
write(sys.argv[3], bed, format='xyz')
END
python=python3 # Debian's, where another one comes first
"$python" -c 'import ase' 2>"$T/log" || python=/usr/bin/python3
if "$python" -c 'import ase' 2>"$T/log"; then
  rows 'function frame() {if (t + 0 > 0.3) for (k = 1; k <= n; k++) {
    cut(k); print id, x, y, z, r}}' >"$T/numbers"
  "$python" "$T/write.py" "$T/numbers" "$T/extended" "$T/simple"
  check 'ASE: extended XYZ' near "$T/extended"
  check 'ASE: its time, twice' test "$("$B/analyze" "$T/extended" |
    cut -f 1 | tr '\n' ' ')" = 't 0.4 0.4 '
  check 'ASE: plain XYZ' near "$T/simple" --radius 0.1
else
  echo 'skipped: ASE (python3-ase) is not installed'
fi

check_done
