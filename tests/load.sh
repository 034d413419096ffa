#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Many runs, many at once, and a long one (make load): what is left of files,
# descriptors and memory. Figures are in docs/reliability.md.
#
#   tests/load.sh [RUNS [SECONDS]]
[[ ! -w /dev/shm ]] || export TMPDIR="${TMPDIR:-/dev/shm}" # where fsync is fast
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
soak=(--quiet --count 50 --base '0.5,0.5' --restitution 1 --time 1e9)
"$B/settle" "${soak[@]}" --output "$T/d/bed" --checkpoint "$T/d/check" --every 1 \
  2>"$T/err" &
pid=$!
state() { # memory (kB), descriptors, files
  awk '/^VmRSS/ { printf "%s ", $2 }' "/proc/$pid/status"
  echo "$(ls "/proc/$pid/fd" | wc -l) $(ls "$T/d" | wc -l)"
}
while [[ ! -e $T/d/check.old ]]; do sleep 0.1; done
checkpoints=0 last=
end=$((SECONDS + seconds))
while ((SECONDS < end)); do # nothing grows after the first quarter
  ((SECONDS < end - seconds * 3 / 4)) || [[ -n ${memory-} ]] ||
    read -r memory descriptors files < <(state)
  sleep 0.5
  now=$(stat -c %i-%Y "$T/d/check" 2>/dev/null)
  [[ $now == "$last" ]] || checkpoints=$((checkpoints + 1))
  last=$now
done
read -r memory_then descriptors_then files_then < <(state)
read -r cpu < <(ps -o time= -p $pid)
echo "after $seconds s ($cpu of CPU time, $checkpoints checkpoints):" \
  "$memory to $memory_then kB, $descriptors to $descriptors_then" \
  "descriptors, $files to $files_then files"
within 'memory stays' "$memory_then" 1 $((memory + memory / 10 + 200))
within 'descriptors stay' "$descriptors_then" 1 "$descriptors"
within 'files stay' "$files_then" 3 4 # one of them may be on its way
kill -s TERM $pid
wait $pid
check 'it ends when it is asked to' [ $? = 5 ]
reached() { # the time of the checkpoint
  head -c 400 "$T/d/check" | grep -a '^# t=' | cut -c 5-
}
before=$(reached)
"$B/settle" --quiet --resume "$T/d/check" 2>"$T/err" &
pid=$!
for ((k = 0; k < 600; k++)); do
  after=$(reached)
  [[ $after == "$before" ]] || break
  sleep 0.1
done
kill -s TERM $pid
wait $pid
check 'and goes on' [ $? = 5 ]
within 'further on' "$after" "$before" 1e9
check_done
