#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Beds as their contacts harden: LAMMPS with its linear and its Hertz contacts,
# and settle, from the same starts, at 8 s. A row for each set and stiffness:
# set (code, contact, friction), the stiffness (k in N/m, or kappa in 1/m), beds,
# the mean overlap of contacts (diameters), the union in the unit cube and the
# contacts of a sphere (z), with standard errors.
#
# Friction of LAMMPS is what the paper's 0.2 is at rest, 2 phi/(1 + e^2) = 0.345.
# Contacts of LAMMPS are those that overlap; ours, whose force has no end, those
# that carry a tenth of a weight.
# SPRINGS, KAPPAS, CREEPING: the stiffnesses, of settle with v_min of 1e-2 and
# 1e-3 m/s, if not all; SEEDS.
set -eu -o pipefail
B=${B:-build}
SEEDS=${SEEDS:-1 2 3}
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT
if [ -n "${QUICK:-}" ]; then
  springs='1e4 1e5' kappas='300 600' creeping=''
  export TIME=1 COUNT=40 BASE=0.5
  SEEDS='1 2'
else
  springs=${SPRINGS-1e4 1e5 1e6} kappas=${KAPPAS-150 300 600 1200 2400}
  creeping=${CREEPING-150 300 600 1200}
fi
sets=() rows=()
add() { # SET STIFFNESS ROW
  sets+=("$1"$'\t'"$2")
  rows+=("$3")
}
for k in $springs; do
  for contact in hooke hertz; do
    for mu in 0 0.345; do
      add "lammps $contact $mu" "$k" "lammps $contact $mu $k"
    done
  done
done
ours() { # SET KAPPA MODEL FRICTION OPTION...
  add "$1" "$2" "settle $3 $4 - --kappa $2 --f0 36.7 --lmax $(awk \
    "BEGIN { print 15 / $2 }") ${*:5}"
}
for k in $kappas; do
  ours 'settle 0' "$k" basic 0
  ours 'settle 0.2 1e-2' "$k" rotation 0.2
done
for k in $creeping; do
  ours 'settle 0.2 1e-3' "$k" rotation 0.2 --vmin 1e-3
done
export B KEEP=$T
here=$(dirname "$0")
# a code that fails, or is not there, has no beds
SEEDS=$SEEDS ROWS=$(printf '%s\n' "${rows[@]}") \
  "$here/../bench/peers/peers.sh" > "$T/table" || true
value() { # COLUMN BED OPTION...
  "$B/analyze" "${@:3}" "$2" 2> "$T/err" | awk -F '\t' -v name="$1" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k } NR == 2 { print $at[name] }'
}
measure() { # the beds of the rows
  local i bed box=0,${BASE:-1},0,${BASE:-1},0,${BASE:-1}
  for i in "${!sets[@]}"; do
    for bed in "$T/$((i + 1))"-*.bed; do
      [ -e "$bed" ] || continue
      local carry=()
      [[ ${sets[i]} != settle* ]] || carry=(--force 0.1)
      printf '%s\t%s\t%s\t%s\n' "${sets[i]}" \
        "$(value overlap_mean "$bed" contacts)" \
        "$(value union "$bed" fraction --box "$box")" \
        "$(value z "$bed" contacts "${carry[@]}")"
    done
  done
}
measure > "$T/beds"
printf 'set\tstiffness\tbeds\toverlap\tunion\terror\tz\tz_error\n'
awk -F '\t' -v OFS='\t' '
  { key = $1 OFS $2 }
  !(key in n) { order[++keys] = key }
  { n[key]++; x[key] += $3; u[key] += $4; uu[key] += $4^2; z[key] += $5; zz[key] += $5^2 }
  function error(s, q, n,  v) {
    v = n > 1 ? (q - s^2 / n) / (n - 1) / n : 0
    return v > 0 ? sqrt(v) : 0
  }
  END {
    for (i = 1; i <= keys; i++) {
      k = order[i]
      printf "%s\t%d\t%.3g\t%.4f\t%.4f\t%.3f\t%.3f\n", k, n[k], x[k] / n[k],
        u[k] / n[k], error(u[k], uu[k], n[k]), z[k] / n[k], error(z[k], zz[k], n[k])
    }
  }' "$T/beds"
