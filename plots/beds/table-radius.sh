#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Means over the seeds of `analyze radius --report`, with the standard error of
# the union: table-radius.sh DIRECTORY MODEL... reads DIRECTORY/MODEL-*.tsv
set -eu
dir=$1
shift
printf 'model\tradius\tseeds\tr (m)\tsum\tunion\tstandard error\t'
printf 'mean overlap (%%)\tlargest (%%)\n'
for model in "$@"; do
  awk -F '\t' -v model="$model" '
    $1 == "t" {next}
    NF {
      if (!($2 in n)) order[++choices] = $2
      k = $2; n[k]++; r[k] += $3; sum[k] += $4
      united[k] += $5; squares[k] += $5 * $5
      mean[k] += $7; if ($8 > most[k]) most[k] = $8
    }
    END {
      for (c = 1; c <= choices; c++) {
        k = order[c]
        m = united[k] / n[k]
        v = n[k] > 1 ? (squares[k] - n[k] * m * m) / (n[k] - 1) : 0
        printf "%s\t%s\t%d\t%.4f\t%.4f\t%.4f\t%.4f\t%.1f\t%.1f\n", model, k,
          n[k], r[k] / n[k], sum[k] / n[k], m, sqrt((v > 0 ? v : 0) / n[k]),
          100 * mean[k] / n[k], 100 * most[k]
      }
    }' "$dir/$model"-*.tsv
done
