#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Solid fractions of mixtures beside what others expect of their sizes:
# plots/mixtures/table.sh BED..., named .../KIND-VALUE-SEED.bed, those of a KIND
# and VALUE one after the other. The union is taken from 0.2 to 0.75 of the height
# that the spheres would have at a fraction of 0.65. Columns: kind, value,
# deviation (of the radii by their mean), beds, share (of the large of two sizes
# there), union, interval (95 %, Student's t; nan for one bed), rods, spread (see
# analyze mixture --help; nan for two sizes, which it is not made for).
# B is the directory of the programs.
set -eu
B=${B:-build}
for bed in "$@"; do
  name=$(basename "$bed" .bed)
  box=$(awk -F '[=,\t]' '
    /^# base=/ { b = $2 }
    /^[0-9]/ { v += 4 / 3 * atan2(0, -1) * $5 ^ 3 }
    END {
      h = v / (b * b * 0.65)
      print "0," b ",0," b "," 0.2 * h "," 0.75 * h
    }' "$bed")
  union=$("$B/analyze" --box "$box" "$bed" | awk 'END { print $3 }')
  share=$("$B/analyze" mixture --classes 0.05 --box "$box" "$bed" |
    awk -F '\t' 'NR > 1 { v[NR] = $7; all += $7 } END { print v[3] / all }')
  printf '%s\t%s\t%s\t%s\n' "${name%-*}" "$union" "$share" \
    "$("$B/analyze" mixture --close "$bed" | tail -n 1)"
done | awk -F '\t' -v OFS='\t' '
  function flush(  m, v, interval) {
    if (!n)
      return
    split(last, part, "-")
    m = sum / n
    v = n > 1 ? (squares - n * m * m) / (n - 1) / n : 0
    split("12.706 4.303 3.182 2.776 2.571 2.447", student, " ")
    interval = "nan"
    if (n > 1)
      interval = sprintf("%.4f", student[n - 1] * sqrt(v > 0 ? v : 0))
    printf "%s\t%s\t%.3f\t%d\t%s\t%.4f\t%s\t%.4f\t%s\n", part[1],
      part[2], deviation / n, n,
      (part[1] == "two" ? sprintf("%.2f", share / n) : "nan"), m, interval,
      rods / n,
      (part[1] == "two" ? "nan" : sprintf("%.4f", spread / n))
    n = sum = squares = share = deviation = rods = spread = 0
  }
  BEGIN {
    print "kind", "value", "deviation", "beds", "share", "union",
      "interval", "rods", "spread"
  }
  $1 != last { flush() }
  {
    last = $1
    n++
    sum += $2
    squares += $2 * $2
    share += $3
    deviation += $6
    rods += $8
    spread += $9
  }
  END { flush() }'
