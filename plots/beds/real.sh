#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Five beds as people have them, at rest, beside published figures:
#   real.sh bed NAME SEED > BED
#   real.sh table BED...     each named .../NAME-SEED.bed
# Columns of the table: bed, beds, spheres, the union with the half width of its
# 95 % interval, the reference and where it is from. Of beds between walls the
# section from one diameter above the floor to one below the height that 90 % of
# the centres are below, of periodic ones that from a quarter to three quarters
# of that. B is the directory of the programs; QUICK=1: small and short.
set -eu -o pipefail
B=${B:-build}
declare -A options=(
  [glass]='--radius 0.00025 --density 2500 --base 0.003,0.003 --count 300
    --vmin 6e-5'
  [steel]='--radius 0.002 --density 7800 --cylinder 0.016,0.016,0,0,0,1,0.016
    --count 384 --vmin 1.8e-4'
  [sand]='--sizes lognormal:0.00025,0.3 --density 2650 --periodic xy
    --base 0.0046,0.0046 --count 400 --vmin 6e-5'
  [two]='--sizes mix:0.002*0.7,0.0005*0.3 --shares volume --density 2500
    --periodic xy --base 0.0125,0.0125 --count 450 --fill random
    --vmin 9e-5'
  [periodic]='--radius 0.001 --density 2500 --periodic xy --base 0.01,0.01
    --count 300 --friction 0.174 --vmin 1.25e-4'
)
# vmin is an eighth of the default, so that friction creeps less until rest
common='--overlap 0.01 --until-rest --time 20'
[ -z "${QUICK:-}" ] || common='--overlap 0.02 --time 0.05'

if [ "$1" = bed ]; then
  # shellcheck disable=SC2086
  "$B/settle" --quiet ${options[$2]} $common --seed "$3"
  exit
fi

heights() { # BED: the section's ends
  awk -F '\t' '
    /^# periodic/ { periodic = 1 }
    /^#/ || !NF { next }
    /^id/ { for (k = 1; k <= NF; k++) at[$k] = k; n = 0; next }
    { z[++n] = $at["z"]; r += $at["r"] }
    END {
      for (i = 2; i <= n; i++)
        for (j = i; j > 1 && z[j] < z[j - 1]; j--) {
          x = z[j]; z[j] = z[j - 1]; z[j - 1] = x }
      top = z[int(0.9 * n)]; d = 2 * r / n
      if (periodic) print top / 4, 3 * top / 4
      else print d, top - d
    }' "$1"
}
union() { # BED LOW HIGH
  local base tube
  tube=$(sed -n 's/^# cylinder=\([^ ]*\) \([^ ]*\) .* \([^ ]*\)$/\1,\2,\3/p' "$1")
  if [ -n "$tube" ]; then # shells, by the area of each
    "$B/analyze" profile --cylinder "$tube" --points 40 \
      --box "-1e9,1e9,-1e9,1e9,$2,$3" "$1" |
      awk -F '\t' 'NR > 1 && NF { s += $2 * $4; w += $2 } END { print s / w }'
    return
  fi
  base=$(sed -n 's/^# base=//p' "$1")
  "$B/analyze" --box "0,${base%,*},0,${base#*,},$2,$3" "$1" |
    awk -F '\t' 'END { print $3 }'
}
rods() { # what Farr and Groot expect of hard spheres of these sizes
  "$B/analyze" mixture --close "$1" | awk -F '\t' 'END { print $5 }'
}
tube_of() { # of so many diameters: Benyahia and O'Neill 2005
  awk -v n="$1" 'BEGIN { printf "%.3f", 1 - 0.390 - 1.740 / (n + 1.140)^2 }'
}
shift
for bed in "$@"; do
  name=$(basename "$bed" .bed)
  read -r low high < <(heights "$bed")
  printf '%s\t%s\t%s\t%s\n' "${name%-*}" "$(union "$bed" "$low" "$high")" \
    "$(grep -c '^[0-9]' "$bed")" "$(rods "$bed")"
done | awk -F '\t' -v OFS='\t' -v six="$(tube_of 6)" -v eight="$(tube_of 8)" '
  function flush(  m, v, reference) {
    if (!n) return
    m = sum / n
    v = n > 1 ? (squares - n * m * m) / (n - 1) / n : 0
    split("12.706 4.303 3.182 2.776", student, " ")
    reference["glass"] = six "\ttubes of 6 diameters, Benyahia and O'\''Neill 2005"
    reference["steel"] = eight "\ttubes of 8 diameters, the same"
    reference["sand"] = reference["two"] = sprintf("below %.3f", rods / n) \
      "\twithout friction, Farr and Groot 2009"
    reference["periodic"] = "0.593\tfriction 0.3, Agnolin and Roux 2007"
    printf "%s\t%d\t%d\t%.3f\t%s\t%s\n", last, n, count, m,
      (n > 1 ? sprintf("%.3f", student[n - 1] * sqrt(v > 0 ? v : 0)) : "-"),
      reference[last]
    n = sum = squares = rods = 0
  }
  BEGIN { print "bed", "beds", "spheres", "union", "interval", "reference", "of" }
  $1 != last { flush() }
  { last = $1; n++; sum += $2; squares += $2^2; count = $3; rods += $4 }
  END { flush() }'
