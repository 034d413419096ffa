#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Beds without side walls as rows, one for each group, away from floor and surface:
#   bulk.sh BOX BED...
# BOX is x0,x1,y0,y1,z0,z1; BED is named .../GROUP-SEED.bed. Columns: group, beds;
# union; contacts that carry a tenth of a weight or more of a sphere that is held;
# shares of spheres that are not, and that have a lattice around them; means and
# standard errors (none of one bed). B is the directory of the programs.
set -eu -o pipefail
shopt -s extglob
export LC_ALL=C
B=${B:-build}
box=$1
shift
column() { # NAME VERB... : mean +- standard error over the beds
  "$B/analyze" "${@:2}" --mean --box "$box" "${beds[@]}" | awk -F '\t' -v name="$1" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k }
    NR == 2 { v = $at[name] }
    $1 == "mean" { v = $at[name] }
    $1 == "standard_error" { e = $at[name] }
    END { printf "%.4f\t%.4f", v, e }'
}
printf 'group\tbeds\tunion\tits error\tcontacts\tits error\trattlers\tits error\t'
printf 'disordered\tits error\n'
for group in $(printf '%s\n' "$@" | sed 's|.*/||; s/-[0-9]*\.bed$//' | sort -u); do
  beds=()
  for bed; do
    [[ ${bed##*/} != "$group"-[0-9]*([0-9]).bed ]] || beds+=("$bed")
  done
  spheres=$(column spheres contacts --force 0.1 | cut -f 1)
  printf '%s\t%d\t%s\t%s\t%s\t%s\n' "$group" ${#beds[@]} "$(column union fraction)" \
    "$(column z_rigid contacts --force 0.1)" \
    "$(column rattlers contacts --force 0.1 | awk -v OFS='\t' -v n="$spheres" \
      '{ print $1 / n, $2 / n }')" "$(column disordered order)"
done
