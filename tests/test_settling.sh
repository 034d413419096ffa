#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The main job at its full size: 200 spheres for 8 s. Ranges are the paper's
# levels and those that its author's program reaches (README, "Paper and ours");
# two methods must agree on the bed.
. tests/harness.sh

# settle_bed NAME OPTION...: runs in the background into files of that name
settle_bed() {
  local name=$1
  shift
  "$B/settle" --quiet "$@" --stats "$T/$name.stats" > "$T/$name.bed" &&
    "$B/analyze" "$T/$name.bed" > "$T/$name.tsv"
}
sum() { awk 'NR == 2 { print $2 }' "$T/$1.tsv"; }
union() { awk 'NR == 2 { print $3 }' "$T/$1.tsv"; }
stat() { awk -v key="$2" '$1 == key { print $2 }' "$T/$1.stats"; }
difference() { awk -v a="$1" -v b="$2" 'BEGIN { print a - b }'; }

settle_bed rotation-merson --seed 1 --method merson &
for seed in 1 2 3; do
  settle_bed basic-merson-$seed --model basic --method merson --seed $seed
  settle_bed basic-$seed --model basic --seed $seed
  settle_bed rotation-$seed --seed $seed
done
settle_bed friction --model friction
wait

for seed in 1 2 3; do
  for name in basic-merson-$seed basic-$seed; do
    within "$name: sum" "$(sum $name)" 0.70 0.72
    within "$name: sum - union" \
      "$(difference "$(sum $name)" "$(union $name)")" 0.006 0.010
  done
  within "basic-merson-$seed: evaluations" \
    "$(stat basic-merson-$seed rhs_evaluations)" 65000 90000
  within "rotation-$seed: sum" "$(sum rotation-$seed)" 0.63 0.68
  within "rotation-$seed: evaluations" \
    "$(stat rotation-$seed rhs_evaluations)" 12000 24000
done
within 'friction: sum' "$(sum friction)" 0.43 0.53
within 'rotation-merson: evaluations' \
  "$(stat rotation-merson rhs_evaluations)" 1000000 1300000
within 'rotation: two methods, one bed' \
  "$(difference "$(union rotation-1)" "$(union rotation-merson)")" -0.003 0.003
# 200 spheres of 4/3 pi r^3 in a box as high as the bed: nothing is lost
within 'all volume is there' "$("$B/analyze" --box -9,9,-9,9,-9,99 \
  "$T/rotation-1.bed" | awk 'NR == 2 { print $2 * 18 * 18 * 108 / (200 * 4e-3 / 3 * atan2(0, -1)) - 1
  }')" -1e-12 1e-12
within 'a settled bed is at rest but for creep' "$(awk '
  /^[0-9]/ { v = sqrt($7^2 + $8^2 + $9^2); if (v > most) most = v }
  END { print most }' "$T/rotation-1.bed")" 0 0.05

check_done
