#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Table 4.1: rebound times beside the paper's and the hard-contact limit, and
# the remark that F0 hardly matters. Two methods bound the integration's error.
set -eu
B=${B:-build}

rebound() { # METHOD TOL OPTION...: t_rebound
  local method=$1 tol=$2
  shift 2
  "$B/bounce" --rebound --method "$method" --control standard --tol "$tol" \
    "$@" | awk '!/^#/ && $1 != "restitution" { print $4 }'
}

row() { # KAPPA E NAME PAPER
  local ours other
  ours=$(rebound rk8pd 1e-13 --kappa "$1" --restitution "$2")
  other=$(rebound merson 1e-12 --kappa "$1" --restitution "$2")
  awk -v k="$1" -v e="$2" -v name="$3" -v paper="$4" -v t="$ours" \
    -v u="$other" 'BEGIN {
      hard = (1 + e) * sqrt(2 * 16 / 9.81)
      d = t > u ? t - u : u - t
      printf "| %s | %s | %.4f | %.4f | %+.2f | %.9f | %+.3f | %+.4f | %.0e |\n",
        k, name, hard, paper, 100 * (paper / hard - 1), t,
        100 * (t / hard - 1), t - paper, d
    }'
}

echo "| kappa (1/m) | e | hard contact (s) | paper (s) | paper (%) | ours (s) | ours (%) | ours - paper (s) | two methods differ by (s) |"
echo "|---|---|---|---|---|---|---|---|---|"
row 30 1 1 3.6409
row 30 0.70710678118654757 "√2/2" 3.108
row 150 1 1 3.6184
row 150 0.70710678118654757 "√2/2" 3.0883
row 500 1 1 3.6134
row 500 0.70710678118654757 "√2/2" 3.0858
echo
echo "| F0 (N), kappa = 150 | e = 1 (s) | e = √2/2 (s) |"
echo "|---|---|---|"
for f0 in 1 10 100; do
  printf '| %s | %.6f | %.6f |\n' $f0 \
    "$(rebound rk8pd 1e-13 --f0 $f0 --restitution 1)" \
    "$(rebound rk8pd 1e-13 --f0 $f0 --restitution 0.70710678118654757)"
done
