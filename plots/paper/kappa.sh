#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fraction over time and residual motion, from pairs of files NAME.tsv
# (analyze of nine frames) and NAME.log (settle --log), NAME = ...-KAPPA.
set -eu
echo "| kappa (1/m) | sum, t = 1 | 2 | 4 | 8 s | union, t = 8 s | kinetic energy per sphere at 8 s (J) |"
echo "|---|---|---|---|---|---|---|"
for name; do
  kinetic=$(tail -n 1 "$name.log" | cut -f 5)
  awk -v kappa="${name##*-}" -v kinetic="$kinetic" -F'\t' '
    { sum[$1] = $2; united[$1] = $3 }
    END {
      printf "| %s | %.4f | %.4f | %.4f | %.4f | %.4f | %.1e |\n", kappa,
        sum[1], sum[2], sum[4], sum[8], united[8], kinetic / 200
    }' "$name.tsv"
done
