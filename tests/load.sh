#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Many runs, many at once, and a long one (make load): what is left of files,
# descriptors and memory. Figures are in docs/reliability.md.
#
#   tests/load.sh [RUNS [SECONDS]]
[[ ! -w /dev/shm ]] || export TMPDIR=/dev/shm # where fsync is fast
. tests/harness.sh
runs=${1:-10000} seconds=${2:-3600}
mkdir "$T/d"

# --- one after the other --------------------------------------------------------
small=(--quiet --count 3 --base 0.4,0.4 --time 0.02)
"$B/settle" "${small[@]}" --output "$T/whole"
other=0
for ((k = 0; k < runs; k++)); do
  "$B/settle" "${small[@]}" --output "$T/d/bed" --checkpoint "$T/d/check" --every 0 &&
    cmp -s "$T/whole" "$T/d/bed" || other=$((other + 1))
done
check "$runs runs in a row: $other are other beds" [ $other = 0 ]
check 'and nothing else is left' \
  [ "$(ls "$T/d" | tr '\n' ' ')" = 'bed check check.old ' ]

# --- at once --------------------------------------------------------------------
some=(--quiet --count 20 --base 0.4,0.4 --time 0.5)
"$B/settle" "${some[@]}" --output "$T/whole"
rm -f "$T"/d/*
for ((k = 0; k < 64; k++)); do
  "$B/settle" "${some[@]}" --output "$T/d/$k" --checkpoint "$T/d/$k.check" --every 0 &
done
wait
other=0
for ((k = 0; k < 64; k++)); do
  cmp -s "$T/whole" "$T/d/$k" || other=$((other + 1))
done
check "64 at once: $other are other beds" [ $other = 0 ]
check 'and nothing else is left' [ "$(ls "$T/d" | wc -l)" = 192 ]

# --- for long, with a checkpoint each second ------------------------------------
rm -f "$T"/d/*
"$B/settle" --quiet --count 50 --base 0.5,0.5 --time 1e9 --output "$T/d/bed" \
  --checkpoint "$T/d/check" --every 1 2>"$T/err" &
pid=$!
state() { # memory (kB), descriptors, files
  awk '/^VmRSS/ { printf "%s ", $2 }' "/proc/$pid/status"
  echo "$(ls "/proc/$pid/fd" | wc -l) $(ls "$T/d" | wc -l)"
}
while [[ ! -e $T/d/check.old ]]; do sleep 0.1; done
for ((k = 0; k < seconds; k++)); do # its bed has fallen after a quarter
  ((k != seconds / 4)) || read -r memory descriptors files < <(state)
  sleep 1
done
read -r memory_then descriptors_then files_then < <(state)
echo "after $seconds s: $memory to $memory_then kB, $descriptors to $descriptors_then" \
  "descriptors, $files to $files_then files"
within 'memory stays' "$memory_then" 1 $((memory + memory / 10 + 200))
within 'descriptors stay' "$descriptors_then" 1 "$descriptors"
within 'files stay' "$files_then" 3 4 # one of them may be on its way
kill -s TERM $pid
wait $pid
check 'it ends when it is asked to' [ $? = 5 ]
check_done
