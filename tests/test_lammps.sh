#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make lammps, and settle-lammps against settle: forces (tests/test_lammps.c),
# whole beds on one rank and two, its fixed step, and what goes wrong.
. tests/harness.sh

if ! command -v mpirun >/dev/null ||
  [[ ! -e ${LAMMPS_INCLUDE:-/usr/include/lammps}/lammps.h ]]; then
  echo 'skipped: LAMMPS as the engine (liblammps-dev is not installed)'
  pass
  check_done
  exit
fi
if sanitized 'LAMMPS as the engine (which is not of the sanitizers)'; then
  pass
  check_done
  exit
fi
check 'make lammps' make -s B="$B" lammps "$B/tests/test_lammps" \
  >"$T/log" 2>&1 || cat "$T/log"
# (make's own are of its jobs)
check 'no warning' test "$(grep -v '^make' "$T/log" | grep -c warning)" = 0
check 'nothing of the GSL is in it' test \
  "$(nm -D "$B/settle-lammps" | grep -c ' gsl_')" = 0
check 'forces' "$B/tests/test_lammps"

# ranks that wait leave the processors to others
host() { # RANKS ARGUMENT...
  if (($1 == 1)); then
    timeout 300 "$B/settle-lammps" "${@:2}" 2>"$T/err"
    return
  fi
  timeout 300 mpirun --allow-run-as-root --oversubscribe \
    --mca mpi_yield_when_idle 1 -np "$1" "$B/settle-lammps" "${@:2}" \
    2>"$T/err"
}
stat() { # KEY FILE
  awk -F '\t' -v key="$1" '$1 == key { print $2 }' "$2"
}
close_to() { # NAME A B TOLERANCE
  within "$1: difference to $3" "$(awk -v a="$2" -v b="$3" \
    'BEGIN { printf "%.9f", (a > b ? a - b : b - a) }')" 0 "$4"
}
union() {
  "$B/analyze" --box 0,0.5,0,0.5,0,0.5 "$1" 2>>"$T/err" |
    awk 'END { print $3 }'
}

# 24 spheres that have fallen and lie in a heap: seconds later single beds part
bed='--count 24 --base 0.5,0.5 --drop 0.3 --time 0.6'
# shellcheck disable=SC2086
"$B/settle" --quiet $bed --method rkc --stats "$T/s0" >"$T/settle.tsv"
# shellcheck disable=SC2086
"$B/settle" --quiet $bed --export-lammps "$T/scene" >"$T/out" 2>"$T/err"
check 'the export' test $? = 0 -a ! -s "$T/out"
for ranks in 1 2; do
  host $ranks --stats "$T/s$ranks" "$T/scene" >"$T/bed$ranks.tsv"
  check "$ranks ranks: exit status" test $? = 0
  close_to "$ranks ranks: union" "$(union "$T/bed$ranks.tsv")" \
    "$(union "$T/settle.tsv")" 1e-4
  within "$ranks ranks: evaluations by those of settle" "$(awk \
    -v a="$(stat rhs_evaluations "$T/s$ranks")" \
    -v b="$(stat rhs_evaluations "$T/s0")" 'BEGIN { print a / b }')" 0.95 1.05
  check "$ranks ranks: same spheres and header" cmp -s \
    <(awk '/^#/ || /^id/ { print; next } { print $1, $5, $6 }' \
      "$T/bed$ranks.tsv") \
    <(awk '/^#/ || /^id/ { print; next } { print $1, $5, $6 }' "$T/settle.tsv")
done
check 'pairs were listed anew' test "$(stat pair_list_builds "$T/s2")" -gt 5
check 'spheres have partners on the other rank' test \
  "$(stat most_ghosts "$T/s2")" -gt 0
check 'the result goes on' test "$("$B/settle" --quiet --scene "$T/bed2.tsv" \
  --time 0.7 | tail -n 1)" = '# status=ok'

# LAMMPS's own fixed step, and unequal spheres
# shellcheck disable=SC2086
"$B/settle" --quiet $bed --sizes uniform:0.06,0.1 --time 0.3 \
  --export-lammps "$T/sizes" 2>"$T/err"
host 2 "$T/sizes" >"$T/rkc.tsv"
check 'unequal spheres' test $? = 0
host 1 --script in.run "$T/sizes"
check 'the fixed step' test $? = 0
check 'its dump has the time' grep -q '^ITEM: TIME$' "$T/sizes/dump.lammps"
"$B/analyze" export --format csv "$T/sizes/dump.lammps" >"$T/fixed.csv"
"$B/analyze" export --format csv "$T/rkc.tsv" >"$T/rkc.csv"
within 'centres by rkc and by the fixed step (m)' "$(paste -d , \
  <(tail -n 24 "$T/fixed.csv" | cut -d , -f 3-5) \
  <(tail -n 24 "$T/rkc.csv" | cut -d , -f 3-5) |
  awk -F , '{ for (k = 1; k <= 3; k++) { d = $k - $(k + 3)
      if (d < 0) d = -d
      if (d > most) most = d } } END { printf "%.9f", most }')" 1e-9 1e-3

# --- what goes wrong ----------------------------------------------------------
wrong() { # STATUS PATTERN ARGUMENT...
  timeout 60 "$B/settle-lammps" "${@:3}" >"$T/out" 2>"$T/err" </dev/null
  local status=$?
  check "$2: exit status $status" test $status = "$1"
  check "$2" grep -q -e "settle-lammps: .*$2" "$T/err"
  check "$2: no bed" test ! -s "$T/out"
}
wrong 2 'expected a folder'
wrong 2 'nonsense: expected a value, or it is no option' --nonsense
wrong 2 'time -1: expected a number above 0' --time -1 "$T/scene"
wrong 3 'no folder with in.scene' "$T"
cp -r "$T/scene" "$T/broken"
sed -i 's/^read_data.*/read_data none/' "$T/broken/in.scene"
wrong 1 'LAMMPS: ERROR: Cannot open file none' "$T/broken"
cp -r "$T/scene" "$T/other"
sed -i '/^variable dem_run/d' "$T/other/in.scene"
wrong 3 'expected the variable dem_run' "$T/other"
# a sphere that leaves the box of LAMMPS
cp -r "$T/scene" "$T/lost"
sed -i 's/^boundary.*/boundary f f f/; s/^fix walls.*//' "$T/lost/in.scene"
wrong 4 'spheres were lost' "$T/lost"
"$B/settle" --scene <(printf '%s\n' \
  $'id\tx\ty\tz\tr\tm\tfixed' $'0\t0\t0\t1\t0.1\t1\t0' \
  $'1\t0\t0\t0\t0.1\t1\t1' '# status=ok') --export-lammps "$T/none" \
  2>"$T/err"
obstacles=$?
"$B/settle" --travel 0 --export-lammps "$T/none" 2>>"$T/err"
check 'no limit of travel' test $? = 2 -a "$(grep -c 'needs a limit' \
  "$T/err")" = 1
"$B/settle" --periodic x --export-lammps "$T/none" 2>"$T/periodic"
check 'periodic' test $? = 2 -a "$(grep -c 'not with --periodic' \
  "$T/periodic")" = 1
check 'obstacles' test $obstacles = 2 -a "$(grep -c 'not with spheres' \
  "$T/err")" = 1
check_done
