#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One run of settle and what depends on how soft its contacts are, as a row.
#   soft.sh SETTINGS [--OPTION VALUE]... > ROW
# SETTINGS is a path that is the command line, as of plots/beds/bed.sh, with
# until-rest for a flag; further options come after it.
# Columns: the settings, "-" where settle chose; kr, kappa times the radius; t,
# the end (s); the union in the cube over the floor, up to 1 m, or as BOX, options
# of analyze, says; the contacts of a sphere that carry a tenth of a weight or
# more (z), also of those that are held (held); mean and largest overlap of
# spheres that touch (diameters); evaluations and CPU time (s).
set -eu -o pipefail
export LC_ALL=C
B=${B:-build}
columns='model friction vmin tol time until-rest base count seed'
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT

declare -A value
arguments=()
IFS=/ read -r -a settings <<<"$1"
shift
for s in "${settings[@]}"; do
  name=${s%%-*} text=${s#*-}
  [[ $s != until-rest ]] || name=until-rest text=
  arguments+=("--$name" ${text:+"$text"})
  value[$name]=${text:-yes}
done
"$B/settle" --quiet "${arguments[@]}" "$@" --stats "$T/stats" \
  >"$T/bed" 2>"$T/err" || [[ $? == 5 ]] || { # 5: not at rest in --time
  cat "$T/err" >&2
  exit 1
}
stat() {
  awk -F '\t' -v key="$1" '$1 == key { print $2 }' "$T/stats"
}
last() { # VERB... -- COLUMN...
  local verb=()
  while [[ $1 != -- ]]; do
    verb+=("$1")
    shift
  done
  "$B/analyze" "${verb[@]}" --allow-partial "$T/bed" 2>"$T/err" |
    awk -F '\t' -v want="${*:2}" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
    { n = split(want, c, " "); row = ""
      for (k = 1; k <= n; k++) row = row "\t" $at[c[k]] }
    END { print row }'
}
# a wide bed is no higher than the paper's, 1.3 m
read -r -a box <<<"${BOX:-}"
[[ -n ${BOX:-} || ${value[base]:-0} == [01],* || ${value[base]:-0} == 0* ]] ||
  box=(--until 1)
for c in $columns; do printf '%s\t' "$c"; done
printf 'kr\tt\tunion\tz\theld\toverlap\tlargest\tevaluations\tcpu\n'
for c in $columns; do printf '%s\t' "${value[$c]:--}"; done
printf '%s\t%s%s%s%s\t%s\t%s\n' "$(awk -F = '
  /^# kappa=/ { k = $2 } /^# radius=/ { r = $2 } END { print k * r }' \
  "$T/bed")" "$(stat t_end)" "$(last fraction "${box[@]}" -- union)" \
  "$(last contacts --force 0.1 -- z z_rigid)" \
  "$(last contacts -- overlap_mean overlap_max)" \
  "$(stat rhs_evaluations)" "$(stat cpu_seconds)"
