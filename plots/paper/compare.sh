#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Two ensembles side by side: DIR NAME:FOLDER NAME:FOLDER. Mean fraction at the
# end with its standard error, evaluations and CPU seconds of all runs.
set -eu
dir=$1
shift
echo "| variant | method | runs | sum, 8 s | standard error | union, 8 s | evaluations | CPU s, all runs |"
echo "|---|---|---|---|---|---|---|---|"
for variant in basic friction rotation-0.2 rotation-0.1; do
  for pair; do
    folder=$dir/${pair#*:}
    for file in "$folder/$variant"-*.tsv; do
      tail -n 1 "$file"
      awk '$1 == "rhs_evaluations" || $1 == "cpu_seconds"' "${file%.tsv}.stats"
    done | awk -v variant=$variant -v method="${pair%%:*}" -F'\t' '
      $1 == "rhs_evaluations" { evaluations += $2; next }
      $1 == "cpu_seconds" { cpu += $2; next }
      { n++; sum += $2; squares += $2 * $2; united += $3 }
      END {
        sum /= n
        printf "| %s | %s | %d | %.4f | %.4f | %.4f | %.0f | %.1f |\n", variant,
          method, n, sum, sqrt((squares / n - sum * sum) / (n - 1)),
          united / n, evaluations / n, cpu
      }'
  done
done
