#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What gaps and bridges for meshers do to the solid fraction of a bed, for each
# choice of its radius: plots/beds/handover.sh BED X..., X in diameters of the
# dynamics, gaps between spheres or radii of bridges. Columns what, keep, x,
# fraction, change; one block per what and keep. A bridge is thinner than the
# spheres, a gap narrower than the centres are apart: what cannot be is left out.
# B is the directory of the programs.
set -eu
B=${B:-build}
bed=$1
shift
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
d=$(awk -F = '/^# radius=/ {print 2 * $2; exit}' "$bed")
box=$(awk -F '[=,]' '/^# base=/ {print "0," $2 ",0," $3 ",0," $2; exit}' "$bed")
printf 'what\tkeep\tx\tfraction\tchange\n'
for what in gap bridge; do
  for keep in nominal contact-mean touching; do
    "$B/analyze" radius --quiet --keep $keep "$bed" >"$tmp/bed"
    [[ $what$keep == gapnominal ]] || printf '\n\n'
    for x in "$@"; do
      # the statement on standard error; gmsh's script is what takes no time
      "$B/analyze" export --format geo --box "$box" \
        --$what "$(awk -v x="$x" -v d="$d" 'BEGIN {print x * d}')" \
        "$tmp/bed" 2>"$tmp/said" >/dev/null || [[ $? == 3 ]]
      sed -n "s/.*solid fraction \([0-9.e-]*\) .*change of the fraction \([-+0-9.e]*\).*/$what\t$keep\t$x\t\1\t\2/p" \
        "$tmp/said"
    done
  done
done
