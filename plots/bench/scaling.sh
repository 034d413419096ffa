#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Cost per sphere and evaluation, and memory, from 200 to 100,000 spheres at the
# same depth: a settled bed of 200 is laid out side by side and goes on for some
# 0.05 s while the seams close. One thread, rkc, the least of three runs taken
# in turns.
set -eu
B=${B:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$B/settle" --quiet > "$work/one"
tiles=${TILES:-1x1 2x2 2x5 5x5 10x10 15x15 20x25}
for tile in $tiles; do
  awk -v a="${tile%x*}" -v b="${tile#*x}" -f plots/bench/tile.awk "$work/one" \
    > "$work/$tile"
done
for run in 1 2 3; do
  for tile in $tiles; do
    # small beds go on for longer, so that there is something to measure
    end=8.05
    [ "$tile" = 1x1 ] && end=${LONGEST:-14}
    "$B/settle" --quiet --scene "$work/$tile" --method rkc --time $end \
      --stats "$work/$tile.$run" > /dev/null
  done
done
printf 'spheres\tns_per_sphere_and_evaluation\tns_per_contact_and_evaluation'
printf '\tevaluations\tlist_builds\tbytes_per_sphere\n'
for tile in $tiles; do
  awk -F'\t' '
    FNR == 1 { runs++ }
    { stat[$1] = $2 }
    $1 == "exit_status" {
      cost = 1e9 * stat["cpu_seconds"] / stat["rhs_evaluations"]
      if (runs == 1 || cost < least) least = cost
    }
    END {
      # what the program itself takes, some 6 MB, is no matter of spheres
      printf "%d\t%.1f\t%.2f\t%d\t%d\t%.0f\n", stat["spheres"],
        least / stat["spheres"], least / stat["contacts_listed"],
        stat["rhs_evaluations"], stat["pair_list_builds"],
        1024 * stat["peak_memory_kb"] / stat["spheres"]
    }' "$work/$tile".[123]
done
