#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Memory that a large bed takes over many evaluations (make million): 200 settled
# spheres between periodic sides, laid side by side TILES by TILES times, settle on
# until there were EVALUATIONS. The figures are in docs/reliability.md.
#
#   tests/million.sh [TILES [EVALUATIONS [ARGUMENT...]]]
[[ ! -w /dev/shm ]] || export TMPDIR="${TMPDIR:-/dev/shm}"
. tests/harness.sh
tiles=${1:-71} evaluations=${2:-1000} most=2 # kB a sphere
shift $(($# < 2 ? $# : 2))
spheres=$((200 * tiles * tiles))

"$B/settle" --quiet --count 200 --periodic xy --base 1,1 --method rkc --time 4 >"$T/tile"
awk -v tiles="$tiles" 'BEGIN { FS = OFS = "\t"; CONVFMT = "%.17g" }
  /^# (count|seed|drop|jitter|checksum|status)=/ { next }
  /^# base=/ { print "# base=" tiles "," tiles; next }
  /^#/ { print; next }
  !head++ { $1 = ""; print substr($0, 2); next }
  { x = $2; y = $3
    for (i = 0; i < tiles; i++)
      for (j = 0; j < tiles; j++) {
        $1 = ""; $2 = x + i; $3 = y + j
        print substr($0, 2)
      } }
  END { print "# status=ok" }' "$T/tile" >"$T/scene"

"$B/settle" --scene "$T/scene" --method rkc --time 1e9 --stats "$T/stats" "$@" \
  >"$T/bed" 2>"$T/err" &
pid=$!
reached=0
while ((reached < evaluations)) && kill -0 $pid 2>/dev/null; do
  sleep 1
  caught=$(awk '/^SigCgt/ { print $2 }' "/proc/$pid/status")
  (((16#${caught:-0} >> 9 & 1) == 0)) || kill -s USR1 $pid # it is ready to tell
  reached=$(grep -o '[0-9]* evaluations' "$T/err" | tail -n 1 | cut -d ' ' -f 1)
  reached=${reached:-0}
done
kill -s TERM $pid
wait $pid
check "it ends when it is asked to" [ $? = 5 ]
value() { # NAME: of the statistics
  awk -F '\t' -v name="$1" '$1 == name { print $2 }' "$T/stats"
}
within 'spheres' "$(value spheres)" $spheres $spheres
within 'evaluations' "$(value rhs_evaluations)" "$evaluations" 1e9
each=$(awk -v kb="$(value peak_memory_kb)" -v n=$spheres 'BEGIN { print kb * 1.024 / n }')
echo "$spheres spheres, $(value method) on $(value threads) threads," \
  "$(value rhs_evaluations) evaluations, $(value cpu_seconds) s of CPU time," \
  "$(value peak_memory_kb) KiB: $each kB a sphere"
within 'kB a sphere' "$each" 0.5 $((spheres < 100000 ? 10 : most))
check_done
