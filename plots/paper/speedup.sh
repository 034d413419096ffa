#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Wall time of the full model by threads, 200 and 400 spheres: the first
# simulated second (the busiest), three runs taken in turns. Speed-up and
# efficiency are those of each turn: mean, least and largest. Cores of a shared
# machine may be halves of one, so "independent" is what as many independent
# runs of one thread keep of their speed side by side: no program's efficiency
# can be above it. METHODS, COUNTS and TIME (s) may be set.
set -eu
B=${B:-build}
cores=$(nproc)
methods=${METHODS:-merson rkc}
counts=${COUNTS:-200 400}
end=${TIME:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

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
    awk -v m="$method" -v n="$n" -v cores="$cores" '
      $1 != "wall_seconds" { next }
      {
        k = split(FILENAME, name, /[\/.]/)
        if (name[k - 1] ~ /^threads/) wall[substr(name[k - 1], 8), name[k]] = $2
        else alone[substr(name[k - 2], 6), name[k - 1]] += $2
      }
      function turns(p, what,  k, x, s) {
        for (k = 1; k <= 3; k++) {
          x = wall[1, k] / (what == "speedup" ? wall[p, k] : alone[p, k] / p)
          if (k == 1 || x < least) least = x
          if (k == 1 || x > most) most = x
          s += x
        }
        mean = s / 3
      }
      END {
        OFS = "\t"
        print "method", "n", "threads", "wall", "speedup", "least", "most", \
          "independent", "independent_least", "independent_most"
        for (p = 1; p <= cores; p++) {
          turns(p, "speedup")
          printf "%s\t%d\t%d\t%.4f\t%.4f\t%.4f\t%.4f\t", m, n, p, \
            (wall[p, 1] + wall[p, 2] + wall[p, 3]) / 3, mean, least, most
          turns(p, "independent")
          printf "%.4f\t%.4f\t%.4f\n", mean, least, most
        }
        print "\n"
      }' "$work"/*
  done
done
