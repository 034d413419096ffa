#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A frictionless bed of a mixture between periodic sides:
# plots/mixtures/bed.sh KIND VALUE SEED
#   two VALUE: radii of 0.1 and 0.025 m, VALUE of the volume large
#   lognormal VALUE: median 0.1 m, VALUE the deviation of the logarithm
# kappa times the smallest radius is 60 and more; F0 is about what contacts carry.
# B is the directory of the programs; QUICK=1: far too small and short.
set -eu
B=${B:-build}
kind=$1 value=$2 seed=$3
if [[ $kind == two ]]; then
  volume=0.3 base=0.7 time=2.5
  [[ -z ${QUICK-} ]] || volume=0.04 base=0.6 time=0.3
  read -r small count < <(awk -v x="$value" -v v=$volume 'BEGIN {
    pi = atan2(0, -1)
    large = v * x / (4 / 3 * pi * 0.1 ^ 3)
    small = v * (1 - x) / (4 / 3 * pi * 0.025 ^ 3)
    print 1 - x, int(large + 0.5) + int(small + 0.5)}')
  options=(--sizes "mix:0.1*$value,0.025*$small" --shares volume --density 300
    --kappa 4800 --f0 2 --psi 20 --lmax 0.003 --tol 0.004)
else
  # three diameters of the largest sphere that a seed may draw, four deviations off
  base=$(awk -v s="$value" 'BEGIN {
    least = 6 * 0.1 * exp(4 * s); printf "%.3g", (least > 1.6 ? least + 0.01 : 1.6) }')
  count=1000 time=5
  [[ -z ${QUICK-} ]] || count=40 base=1.4 time=0.5
  options=(--sizes "lognormal:0.1,$value" --f0 70
    --kappa "$(awk -v s="$value" 'BEGIN { print 60 / (0.1 * exp(-4 * s)) }')")
fi
"$B/settle" --quiet --model basic --count "$count" --base "$base,$base" \
  --periodic xy --drop 0.1 --time $time --seed "$seed" "${options[@]}"
