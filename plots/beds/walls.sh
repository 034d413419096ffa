#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The effect of walls on beds: plots/beds/walls.sh profile|size BED...
# BED is named .../BASE-SEED.bed, BASE the side of its box in m, or
# .../rotation-SEED.bed, the paper's bed of 200 spheres, of which the cube above
# the floor is measured. Each is taken with the
# radius of its dynamics and with that of contact-mean; means over the seeds.
#   profile: base, keep, wall (distance from the side walls), union, at 0.4 to
#     2 m over the floor; one block per base and radius
#   size: base, keep, region, seeds, side, union, standard error; at the same
#     heights the whole section, and inner: further than 0.4 m from the side
#     walls; paper: the unit cube
# Base in the dynamics' diameters, wall and side in those of the geometry.
# B is the directory of the programs.
set -eu
B=${B:-build}
what=$1
shift
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
for bed in "$@"; do
  name=$(basename "$bed" .bed)
  base=${name%-*}
  for keep in nominal contact-mean; do
    "$B/analyze" radius --quiet --keep $keep "$bed" >"$tmp/bed"
    d=$(awk -F = '/^# radius=/ {print 2 * $2; exit}' "$tmp/bed")
    # base, keep, region or row, length in diameters, union
    if [[ $base == rotation ]]; then
      side=$(awk -F '[=,]' '/^# base=/ {print $2; exit}' "$tmp/bed")
      [[ $what == profile ]] ||
        "$B/analyze" --box "0,$side,0,$side,0,$side" "$tmp/bed" |
        awk -v OFS='\t' -v keep=$keep -v b="$side" -v d="$d" \
          'NR > 1 {print b / 0.2, keep, "paper", b / d, $3}'
    elif [[ $what == profile ]]; then
      "$B/analyze" profile --box "0,$base,0,$base,0.4,2" --points 200 \
        --from-wall "$(awk -v b="$base" 'BEGIN {print b < 2 ? b / 2 : 1}')" \
        "$tmp/bed" |
        awk -v OFS='\t' -v b="$base" -v keep=$keep -v d="$d" \
          'NR > 1 {print b / 0.2, keep, NR, $2 / d, $4}'
    else
      awk -v b="$base" 'BEGIN {
        print 0, b, 0, b, 0.4, 2
        print 0.4, b - 0.4, 0.4, b - 0.4, 0.4, 2}' >"$tmp/boxes"
      "$B/analyze" --boxes "$tmp/boxes" "$tmp/bed" |
        awk -v OFS='\t' -v b="$base" -v keep=$keep -v d="$d" 'NR > 1 {
          print b / 0.2, keep, NR == 2 ? "whole" : "inner", b / d, $9}'
    fi
  done
done >"$tmp/rows"
awk -F '\t' -v OFS='\t' -v what="$what" '
  {
    k = $1 OFS $2 OFS $3
    if (!(k in n)) order[++keys] = k
    n[k]++; length_[k] += $4; s[k] += $5; q[k] += $5 * $5
  }
  END {
    names = "base\tkeep\tregion\tseeds\tside\tunion\tstandard error"
    if (what == "profile")
      names = "base\tkeep\twall\tunion"
    for (i = 1; i <= keys; i++) {
      k = order[i]
      split(k, part, OFS)
      if (i == 1)
        print names
      else if (what == "profile" && part[1] OFS part[2] != last)
        print "\n\n" names
      last = part[1] OFS part[2]
      m = s[k] / n[k]
      v = n[k] > 1 ? (q[k] - n[k] * m * m) / (n[k] - 1) / n[k] : 0
      if (what == "profile")
        print part[1], part[2], length_[k] / n[k], m
      else
        printf "%s\t%s\t%s\t%d\t%.2f\t%.4f\t%.4f\n", part[1], part[2],
          part[3], n[k], length_[k] / n[k], m, sqrt(v > 0 ? v : 0)
    }
  }' "$tmp/rows"
