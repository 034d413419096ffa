#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Means over seeds of DIR/VARIANT-METHOD-SEED.{stats,tsv}: costs, fraction with
# its standard error, and the factor in CPU time to the paper's way (every pair
# twice) with Merson's method.
set -eu
dir=$1
awk '$1 == "spheres" { n = $2 } $1 == "t_end" { t = $2 }
  END { printf "# run=%g s of %d spheres\n", t, n }' "$dir"/basic-merson-1.stats
for variant in basic friction rotation; do
  printf 'variant\tmethod\tseeds\tcpu_seconds\tevaluations\tus_per_evaluation'
  printf '\tsum\tunion\tstandard_error\ttimes_cheaper\n'
  base=$(awk '$1 == "cpu_seconds" { print $2 }' "$dir/$variant-allpairs-1.stats")
  for method in allpairs merson dopri5 rkf45 rk8pd rkc verlet; do
    paste <(awk '$1 == "cpu_seconds" { print $2 }' \
        "$dir/$variant-$method"-*.stats) \
      <(awk '$1 == "rhs_evaluations" { print $2 }' \
        "$dir/$variant-$method"-*.stats) \
      <(awk 'FNR > 1 { print $2 "\t" $3 }' "$dir/$variant-$method"-*.tsv) |
      awk -v variant="$variant" -v method="$method" -v base="$base" '
        { n++; cpu += $1; evals += $2; sum += $3; u += $4; uu += $4 * $4 }
        END {
          u /= n
          variance = uu / n - u * u
          se = "-"
          if (n > 1) se = sprintf("%.4f", sqrt(variance > 0 ? variance / (n - 1) : 0))
          printf "%s\t%s\t%d\t%.3f\t%.0f\t%.1f\t%.4f\t%.4f\t%s\t%.3g\n",
            variant, method, n, cpu / n, evals / n, 1e6 * cpu / evals,
            sum / n, u, se, base * n / cpu
        }'
  done
  printf '\n\n'
done
