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
without_places() { # FILE: header, but for what built it; ids, radii, masses and
  # the column fixed
  unsealed "$1" | awk '/^# (build|kernel)=/ { next } /^#/ || /^id/ { print; next }
    { print $1, $5, $6, $13 }'
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
    <(without_places "$T/bed$ranks.tsv") <(without_places "$T/settle.tsv")
done
check 'pairs were listed anew' test "$(stat pair_list_builds "$T/s2")" -gt 5
check 'near ones are chosen more often' test \
  "$(stat near_list_builds "$T/s1")" -gt \
  $((2 * $(stat pair_list_builds "$T/s1")))
per_evaluation() { # FILE
  awk -F '\t' '{ of[$1] = $2 }
    END { print of["contact_evaluations"] / of["rhs_evaluations"] }' "$1"
}
within 'contacts of an evaluation by those of settle' "$(awk \
  -v a="$(per_evaluation "$T/s1")" -v b="$(per_evaluation "$T/s0")" \
  'BEGIN { print a / b }')" 0.8 1.1
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

# periodic sides and an obstacle, on a floor that is nearly closed
seq 0 15 | awk '
  BEGIN { OFS = "\t"; print "# format=bed-1"; print "# base=0.7,0.7"
          print "id", "x", "y", "z", "r", "m", "vx", "vy", "vz", "fixed" }
  { moves = $1 != 4
    print $1, 0.1 + 0.21 * ($1 % 3), 0.1 + 0.21 * (int($1 / 3) % 3),
      0.1 + 0.2 * int($1 / 9), 0.1, 1, moves * (0.3 - 0.04 * $1), moves * 0.2,
      0, !moves }
  END { print "# status=ok" }' >"$T/start"
around="--scene $T/start --wall 0,0,0,0,0,-1 --periodic xy --time 0.3"
# shellcheck disable=SC2086
"$B/settle" --quiet $around --method rkc >"$T/settle.tsv"
# shellcheck disable=SC2086
"$B/settle" --quiet $around --export-lammps "$T/around" 2>"$T/err"
host 2 --stats "$T/s" "$T/around" >"$T/around.tsv"
check 'periodic sides and an obstacle' test $? = 0
check 'same spheres, header and columns' cmp -s \
  <(without_places "$T/around.tsv") <(without_places "$T/settle.tsv")
most_off() { # BED BED: the largest difference of a coordinate
  paste <(grep -v '^[#i]' "$1") <(grep -v '^[#i]' "$2") | awk '
    { for (k = 2; k <= 4; k++) { d = $k - $(k + NF / 2)
        if (d < 0) d = -d
        if (d > most) most = d } } END { printf "%.9f", most }'
}
within 'their centres (m)' "$(most_off "$T/around.tsv" "$T/settle.tsv")" 0 1e-4
within 'spheres that went around' "$(awk '!/^[#i]/ { rows++
  if ($2 < 0.07 || $3 < 0.07) near++
  if ($2 < 0 || $2 > 0.7 || $3 < 0 || $3 > 0.7) out++ }
  END { print rows == 16 && !out ? near : 0 }' "$T/around.tsv")" 1 16
check 'the obstacle stays' test "$(awk '$1 == "4" { print $2, $3, $4 }' \
  "$T/around.tsv")" = '0.31 0.31 0.1'

# --- a bed meanwhile, and a run that is ended ---------------------------------
ended() { # SIGNAL NAME COMMAND...: once there is a bed
  rm -f "$T/part.tsv"
  "${@:3}" --time 1e6 --output "$T/part.tsv" --every 0.01 "$T/scene" \
    >"$T/out" 2>"$T/err" &
  local pid=$! k
  for ((k = 0; k < 1200; k++)); do
    [[ ! -e $T/part.tsv ]] || break
    sleep 0.05
  done
  check "$2: a bed meanwhile" test "$(tail -n 1 "$T/part.tsv" |
    cut -c 1-25)" = '# status=interrupted at t'
  kill "-$1" $pid
  wait $pid
  check "$2: exit status" test $? = 5
  check "$2: says when" grep -q 'settle-lammps: interrupted at t=' "$T/err"
  check "$2: the bed is of this time" test "$(tail -n 1 "$T/part.tsv" |
    sed 's/# status=//')" = "$(sed -n 's/^settle-lammps: //p' "$T/err")"
  check "$2: nothing else" test ! -s "$T/out" -a ! -e "$T/part.tsv.partial"
}
ended TERM 'one rank' "$B/settle-lammps"
ended USR1 'two ranks' mpirun --allow-run-as-root --oversubscribe \
  --mca mpi_yield_when_idle 1 -np 2 "$B/settle-lammps"
"$B/settle" --quiet --scene "$T/part.tsv" --allow-partial --time 1e6 \
  --export-lammps "$T/again" 2>"$T/err"
check 'it goes on' test $? = 0

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
wrong 2 'every: expected --output' --every 1 "$T/scene"
wrong 1 'none/bed: it could not be written' --time 0.01 --output "$T/none/bed" \
  "$T/scene"
wrong 3 'no folder with in.scene' "$T"
cp -r "$T/scene" "$T/broken"
sed -i 's/^read_data.*/read_data none/' "$T/broken/in.scene"
wrong 1 'LAMMPS: ERROR: Cannot open file none' "$T/broken"
cp -r "$T/scene" "$T/other"
sed -i '/^variable dem_run/d' "$T/other/in.scene"
wrong 3 'expected the variable dem_run' "$T/other"
# that only one rank meets: the last sphere is on the other one
cp -r "$T/scene" "$T/type"
sed -i -E '/^Atoms/,/^Velocities/s/^24 1 /24 7 /' "$T/type/bed.data"
wrong 1 'LAMMPS: ERROR on proc 0: Invalid atom type' "$T/type"
host 2 "$T/type" >"$T/out"
check 'an error on one of two ranks' test $? = 1 -a ! -s "$T/out" -a \
  "$(grep -c 'settle-lammps: LAMMPS: ERROR on proc 1: Invalid' "$T/err")" = 1
# a sphere that leaves the box of LAMMPS
cp -r "$T/scene" "$T/lost"
sed -i 's/^boundary.*/boundary f f f/; s/^fix walls.*//' "$T/lost/in.scene"
wrong 4 'spheres were lost' "$T/lost"
# what the host does not do is refused
not_exported() { # WORDS OPTION...
  refused 2 "$1" "$B/settle" --quiet "${@:2}" --export-lammps "$T/none"
  check "no folder: ${*:2}" test ! -e "$T/none"
}
not_exported 'needs a limit' --travel 0
not_exported 'whose method is rkc' --method merson
not_exported '--until-rest: expected none beside' --until-rest
not_exported '--hmax 0.1: expected none beside' --hmax 0.1
# a bed by another method does not hand its tolerance on
"$B/settle" --quiet --count 2 --time 0.01 >"$T/multirate"
"$B/settle" --quiet --scene "$T/multirate" --time 0.02 \
  --export-lammps "$T/next" 2>"$T/err"
check 'the tolerance of rkc' grep -q \
  '^variable dem_run string "0.01 0.02 0.0005 ' "$T/next/in.scene"
check 'the method in the result' grep -q '^# method=rkc' "$T/next/start.tsv"
# an error that all ranks meet
host 2 "$T/broken" >"$T/out"
check 'an error on two ranks' test $? = 1 -a ! -s "$T/out" -a \
  "$(grep -c 'settle-lammps: LAMMPS: ERROR: Cannot open' "$T/err")" = 1
check_done
