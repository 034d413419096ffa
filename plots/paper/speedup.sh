#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Wall time of the full model by threads, 200 and 400 spheres: the first
# simulated second (the busiest), mean of three runs taken in turns. Cores of a
# shared machine may be halves of one, so the last column is what as many
# independent runs of one thread keep of their speed side by side: no program's
# efficiency can be above it.
set -eu
B=${B:-build}
cores=$(nproc)
methods=${METHODS:-merson rkc}
counts=${COUNTS:-200 400}
end=${TIME:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

wall() { # FILE...: mean wall time of the runs
  awk '$1 == "wall_seconds" { s += $2; n++ } END { print s / n }' "$@"
}

for method in $methods; do
  for n in $counts; do
    rm -f "$work"/*
    run() { # FILE THREADS
      "$B/settle" --quiet --count $n --method "$method" --time "$end" \
        --threads "$2" --stats "$work/$1" > /dev/null
    }
    for turn in 1 2 3; do
      for ((p = 1; p <= cores; p++)); do
        run "threads$p.$turn" $p
        for ((k = 0; k < p; k++)); do
          run "alone$p.$turn.$k" 1 &
        done
        wait
      done
    done
    one=$(wall "$work"/threads1.*)
    printf 'method\tn\tthreads\twall\tspeedup\tefficiency\tindependent\n'
    for ((p = 1; p <= cores; p++)); do
      awk -v m="$method" -v n=$n -v p=$p -v w="$(wall "$work/threads$p."*)" \
        -v a="$(wall "$work/alone$p."*)" -v one="$one" 'BEGIN {
          printf "%s\t%d\t%d\t%.4f\t%.4f\t%.4f\t%.4f\n", m, n, p, w, one / w,
            one / w / p, one / a
        }'
    done
    printf '\n\n'
  done
done
