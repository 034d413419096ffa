#!/bin/bash
# Wall time of the full model by threads, 200 and 400 spheres: the first
# simulated second (the busiest), mean of three runs taken in turns.
set -eu
B=${B:-build}
cores=$(nproc)
methods=${METHODS:-merson}
stats=$(mktemp)
trap 'rm -f "$stats"' EXIT
for method in $methods; do
  for n in 200 400; do
    declare -A wall=()
    for run in 1 2 3; do
      for ((threads = 1; threads <= cores; threads++)); do
        "$B/settle" --quiet --count $n --method "$method" --time 1 \
          --threads $threads --stats "$stats" >/dev/null
        w=$(awk '$1 == "wall_seconds" { print $2 }' "$stats")
        wall[$threads]=$(awk -v a="${wall[$threads]:-0}" -v b="$w" \
          'BEGIN { print a + b / 3 }')
      done
    done
    printf 'method\tn\tthreads\twall\tspeedup\tefficiency\n'
    for ((threads = 1; threads <= cores; threads++)); do
      awk -v m="$method" -v n=$n -v p=$threads -v w="${wall[$threads]}" \
        -v one="${wall[1]}" 'BEGIN {
          printf "%s\t%d\t%d\t%.4f\t%.4f\t%.4f\n", m, n, p, w, one / w,
            one / w / p
        }'
    done
    printf '\n\n'
  done
done
