#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Costs by variant and method, from pairs of files NAME.tsv (analyze) and
# NAME.stats (settle --stats), NAME = variant-method.
set -eu
echo "| variant | method | evaluations | accepted | rejected | CPU (s) | sum | union |"
echo "|---|---|---|---|---|---|---|---|"
for file; do
  name=$(basename "$file" .tsv)
  awk -v variant="${name%-*}" -v method="${name##*-}" -F'\t' '
    FILENAME ~ /stats$/ { stat[$1] = $2; next }
    { sum = $2; united = $3 }
    END {
      printf "| %s | %s | %d | %d | %d | %.2f | %.4f | %.4f |\n", variant,
        method, stat["rhs_evaluations"], stat["steps_accepted"],
        stat["steps_rejected"], stat["cpu_seconds"], sum, united
    }' "${file%.tsv}.stats" "$file"
done
