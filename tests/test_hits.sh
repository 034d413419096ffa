#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A sphere at rest is hit within a step of multirate, flies off at twice the
# speed and hits another one, which nothing at the step's start gave away: each
# gets the velocity that rkc gives it, and momentum is kept.
. tests/harness.sh

# A large sphere comes at 1 m/s towards a small one, behind which another rests at
# the gap $1; 200 more rest elsewhere, so that long steps of all are worth while.
row() { # GAP
  awk -v g="$1" 'BEGIN {
    OFS = "\t"
    print "id", "x", "y", "z", "r", "m", "vx", "vy", "vz"
    print 0, 0, 0.5, 0.5, 0.1, 1, 1, 0, 0
    print 1, 0.1255, 0.5, 0.5, 0.025, 0.015625, 0, 0, 0
    print 2, 0.1755 + g, 0.5, 0.5, 0.025, 0.015625, 0, 0, 0
    for (i = 0; i < 200; i++)
      print 3 + i, 1.2 + 0.12 * (i % 10), 0.12 * int(i / 10), 1.5, 0.025,
        0.015625, 0, 0, 0 }'
}
velocities() { # METHOD: of the three, along the row
  "$B/settle" --scene "$T/row" --model basic --gravity 0,0,0 --restitution 1 \
    --kappa 4800 --f0 2 --psi 20 --lmax 0.003 --tol 0.004 --time 0.01 --quiet \
    --method "$1" 2>"$T/err" |
    awk -F '\t' 'NF > 5 && $1 ~ /^[012]$/ { printf "%s ", $7 }'
}
for gap in 0.0005 0.001 0.0015 0.002 0.003 0.004 0.006; do
  row $gap >"$T/row"
  said="gap $gap"
  read -r -a one < <(velocities multirate; echo)
  read -r -a all < <(velocities rkc; echo)
  for k in 0 1 2; do
    check "sphere $k: ${one[k]}, by rkc ${all[k]}" awk -v a="${one[k]}" \
      -v b="${all[k]}" 'BEGIN { exit !(b > 0.5 && (a - b)^2 < 0.0081^2) }'
  done
  check "momentum: ${one[*]}" awk -v a="${one[*]}" 'BEGIN {
    split(a, v, " ")
    exit !((v[1] + (v[2] + v[3]) / 64 - 1)^2 < 0.001^2) }'
done
check_done
