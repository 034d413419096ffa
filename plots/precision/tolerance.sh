#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a tolerance of multirate does to beds, seed by seed:
#   tolerance.sh run NAME METHOD,TOL SEEDS [--OPTION VALUE]... > RUNS
#   tolerance.sh table RUNS...
# RUNS has a row for each seed: name, method and tolerance, seed, union of the
# box (the inside where the base is wider than 2 m), contact evaluations and CPU
# seconds. SEEDS seeds, the first is 1. The table compares runs of the same name
# with those by multirate at 5e-4, seeds that both have: sharp is that. 95 %
# intervals. Columns: see its first row. B is the directory of the programs.
set -eu -o pipefail
B=${B:-build}
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT

run() { # NAME METHOD,TOL SEEDS OPTION...
  local name=$1 how=$2 seeds=$3 seed box=()
  shift 3
  [[ " $* " != *" --base 3.16,"* ]] || box=(--box 1,2.16,1,2.16,0.2,1)
  printf 'bed\thow\tseed\tunion\tcontacts\tcpu\n'
  for ((seed = 1; seed <= seeds; seed++)); do
    "$B/settle" --quiet "$@" --method "${how%,*}" --tol "${how#*,}" \
      --seed "$seed" --stats "$T/stats" --output "$T/bed"
    printf '%s\t%s\t%s\t%s\t%s\n' "$name" "$how" "$seed" \
      "$("$B/analyze" "${box[@]}" "$T/bed" | awk 'END { print $3 }')" \
      "$(awk '$1 == "contact_evaluations" { c = $2 }
              $1 == "cpu_seconds" { t = $2 }
              END { print c "\t" t }' "$T/stats")"
  done
}

if [ "$1" = run ]; then
  shift
  run "$@"
  exit
fi
shift
awk -F '\t' '
  FNR == 1 { next }
  {
    key = $1 SUBSEP $2
    if (!(key in runs)) order[++keys] = key
    last[key] = $3
    runs[key]++
    union[key, $3] = $4
    contacts[key] += $5
    cpu[key, $3] = $6
  }
  END {
    OFS = "\t"
    print "bed", "method and tolerance (m/s)", "seeds", \
      "contact evaluations (million)", "CPU time by that of the sharp runs", \
      "mean difference of the union", "rms of single beds", "largest", \
      "between seeds"
    for (k = 1; k <= keys; k++) {
      key = order[k]
      split(key, part, SUBSEP)
      sharp = part[1] SUBSEP "multirate,5e-4"
      n = sum = square = most = mean = spread = own = other = 0
      for (s = 1; s <= last[key]; s++) {
        if (!((key, s) in union) || !((sharp, s) in union)) continue
        n++
        d = union[key, s] - union[sharp, s]
        sum += d
        square += d * d
        if (d < 0) d = -d
        if (d > most) most = d
        mean += union[key, s]
        spread += union[key, s]^2
        own += cpu[key, s]
        other += cpu[sharp, s]
      }
      if (n < 2) continue
      between = sprintf("%.4f", sqrt((spread - mean^2 / n) / (n - 1)))
      how = part[2]
      sub(/,/, ", ", how)
      if (key == sharp) {
        print part[1], how, n, sprintf("%.0f", contacts[key] / runs[key] / 1e6), \
          1, "-", "-", "-", between
        continue
      }
      deviation = (square - sum^2 / n) / (n - 1)
      print part[1], how, n, sprintf("%.0f", contacts[key] / runs[key] / 1e6), \
        sprintf("%.2f", own / other), \
        sprintf("%+.5f ± %.5f", sum / n, 1.96 * sqrt(deviation / n)), \
        sprintf("%.4f", sqrt(square / n)), sprintf("%.4f", most), between
    }
  }' "$@"
