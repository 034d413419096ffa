#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Markdown table: means over the beds of each variant, with standard errors, of
# the columns of analyze contacts and analyze order.
#   B=build plots/beds/structure.sh DIRECTORY VARIANT...   DIRECTORY/VARIANT-SEED.bed
set -e -o pipefail
B=${B:-build}
directory=$1
shift

# One table of all beds: columns of a verb by name, with their standard errors
means() { # COLUMN... < tables of analyze
  awk -F '\t' -v names="$*" '
    BEGIN {n = split(names, want, " ")}
    /^t\t/ {for (k = 1; k <= NF; k++) at[$k] = k; next}
    {rows++
     for (k = 1; k <= n; k++) {
       s[k] += $at[want[k]]
       q[k] += $at[want[k]] ^ 2}}
    END {
      for (k = 1; k <= n; k++) {
        m = s[k] / rows
        v = q[k] / rows - m * m
        e = rows > 1 && v > 0 ? sqrt(v / (rows - 1)) : 0
        printf " %.*f ± %.*f |", m < 3 ? 3 : 2, m, m < 3 ? 3 : 2, e}}'
}

all() { # VARIANT ARGUMENT...
  local bed variant=$1
  for bed in "$directory/$variant"-*.bed; do
    "$B/analyze" "${@:2}" "$bed"
  done
}

echo '| variant | beds | z, gap <= 0 | rattlers | z without them |' \
  'z, 0.1 weights | mean overlap (d) | largest overlap (d) | floor | sides |' \
  'anisotropy | mean qbar6 | ordered: fcc | hcp | bcc | disordered |'
echo '|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|'
for variant; do
  printf '| %s | %s |' "$variant" "$(ls "$directory/$variant"-*.bed | wc -l)"
  all "$variant" contacts | means z rattlers z_rigid
  all "$variant" contacts --force 0.1 | means z
  all "$variant" contacts |
    means overlap_mean overlap_max floor sides anisotropy
  all "$variant" order | means qbar6 fcc hcp bcc disordered
  echo
done
