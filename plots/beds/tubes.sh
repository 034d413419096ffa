#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Void share of beds in upright tubes: plots/beds/tubes.sh profile|size BED...
# BED is named .../N-SEED.bed, N the width of its tube in diameters. What is
# measured is between one diameter over the floor and one below the height that
# 90 % of the centres are below.
#   profile: N, distance (from the wall, diameters), void, interval (of 95 %, by
#     Student's distribution over the seeds; 0 of one seed); a block for each N
#   size: N, seeds, void, standard error: mean of the whole section
# B is the directory of the programs.
set -eu -o pipefail
export LC_ALL=C
B=${B:-build}
what=$1
shift
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
for bed in "$@"; do
  name=$(basename "$bed" .bed)
  ends=$(awk '/^# radius=/ { r = substr($0, 10) }
    $1 == "id" { for (k = 1; k <= NF; k++) if ($k == "z") c = k; next }
    !/^#/ && NF { print r, $c }' "$bed" | sort -g -k 2 | awk '
    { r = $1; z[NR] = $2 }
    END { printf "%.10g,%.10g\n", 2 * r, z[int(0.9 * NR)] - 2 * r }')
  "$B/analyze" profile --radial --along "$ends" --points 400 "$bed" |
    awk -v n="${name%-*}" -v OFS='\t' 'NR > 1 && NF {
      print n, 0.5 * n * (1 - (NR - 1.5) / 400), $2, 1 - $4 }'
done >"$tmp/rows"
awk -F '\t' -v OFS='\t' -v what="$what" '
  # of a sorted list of beds, 400 rows each
  { k = (NR - 1) % 400
    if (k == 0) { bed = $1; if (!(bed in beds)) order[++sizes] = bed; beds[bed]++ }
    s[bed, k] += $4; q[bed, k] += $4 * $4; at[bed, k] = $2
    area += $3; void += $3 * $4
    if (k == 399) {
      mean[bed] += void / area; square[bed] += (void / area) ^ 2
      area = void = 0
    } }
  function error(sum, squares, n) {
    v = n > 1 ? (squares - sum * sum / n) / (n - 1) / n : 0
    return sqrt(v > 0 ? v : 0)
  }
  END {
    split("12.71 4.303 3.182 2.776", t, " ")
    for (i = 1; i <= sizes; i++) {
      b = order[i]; n = beds[b]
      if (what == "size") {
        if (i == 1) print "N\tseeds\tvoid\tstandard error"
        printf "%s\t%d\t%.4f\t%.4f\n", b, n, mean[b] / n,
          error(mean[b], square[b], n)
        continue
      }
      print (i > 1 ? "\n\n" : "") "N\tdistance\tvoid\tinterval"
      for (k = 399; k >= 0; k--)
        printf "%s\t%.5g\t%.5g\t%.3g\n", b, at[b, k], s[b, k] / n,
          (n > 1 ? t[n - 1] : 0) * error(s[b, k], q[b, k], n)
    }
  }' "$tmp/rows"
