#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One run of settle and its bed as a row, for the charts over many of them.
#   bed.sh SETTINGS [--OPTION VALUE]... > ROW
# SETTINGS is a path that is the command line: model-rotation/tol-1e-3/seed-3
# runs settle --model rotation --tol 1e-3 --seed 3, so that a file is named by
# what made it; further options come after it. RUN is a command to run it under,
# such as a lock.
# Columns: the settings, "-" where settle chose, but for count and time; status
# (ok, outside where a centre was outside of the walls at a frame, gave_up where
# no step was short enough, stuck where LIMIT seconds of CPU time were not
# enough); cost; fractions up to 1 m above the base; spheres whose centre is outside the
# walls in the end; and, of frames-K, the kinetic energy per sphere (J), mean
# over the last eighth of the time and over the one before it.
set -u
export LC_ALL=C
B=${B:-build}
LIMIT=${LIMIT:-120}
columns='model method tol step kappa lmax travel count time seed frames'
T=$(mktemp -d) || exit 1
trap 'rm -rf "$T"' EXIT

declare -A value
arguments=()
IFS=/ read -r -a settings <<<"$1"
for s in "${settings[@]}"; do
  arguments+=("--${s%%-*}" "${s#*-}")
  value[${s%%-*}]=${s#*-}
done
shift
arguments+=("$@")
while (($#)); do
  value[${1#--}]=$2
  shift 2
done

# A killed settle leaves no statistics.
# shellcheck disable=SC2016,SC2086 # RUN is a command with its arguments
${RUN:-} bash -c 'ulimit -t "$0"; "$@"; exit $?' "$LIMIT" "$B/settle" --quiet \
  "${arguments[@]}" --stats "$T/stats" >"$T/bed" 2>"$T/err"
code=$?
case $code in
  0) status=ok ;;
  4)
    status=gave_up
    tail -n 1 "$T/bed" | grep -q ' centres ' && status=outside
    ;;
  137 | 152) status=stuck ;; # by the limit on CPU time
  *)
    cat "$T/err" >&2
    echo "bed.sh: settle ${arguments[*]}: exit status $code" >&2
    exit 1
    ;;
esac
base=${value[base]:-1,1}
fractions=$'nan\tnan'
if [[ $status == ok ]]; then
  fractions=$("$B/analyze" --box "0,${base%,*},0,${base#*,},0,1" "$T/bed" |
    awk 'END { print $2 "\t" $3 }') || exit 1
fi
stat() {
  awk -v key="$1" '$1 == key { v = $2 } END { print v == "" ? "nan" : v }' \
    "$T/stats" 2>/dev/null || echo nan
}
motion=$(awk -F '\t' -v width="${base%,*}" -v depth="${base#*,}" '
  /^# t=/ { t[++frames] = substr($0, 5) }
  /^#/ || NF < 5 { next }
  $1 == "id" { for (k = 1; k <= NF; k++) at[$k] = k; next }
  {
    n[frames]++
    e = 0
    for (k = 1; k <= 3; k++) {
      e += $(at["v" substr("xyz", k, 1)])^2
      if ("wx" in at)
        e += 0.4 * ($(at["r"]) * $(at["w" substr("xyz", k, 1)]))^2
    }
    kinetic[frames] += $(at["m"]) * e / 2
    x = $(at["x"]); y = $(at["y"]); z = $(at["z"])
    outside[frames] += !(x > 0 && x < width && y > 0 && y < depth && z > 0)
  }
  function mean(a, b,  k, s, m) {
    for (k = 1; k <= frames; k++)
      if (t[k] > a && t[k] <= b) { s += kinetic[k] / n[k]; m++ }
    return m ? s / m : "nan"
  }
  END {
    end = t[frames]
    print outside[frames] + 0 "\t" mean(0.875 * end, end) "\t" \
      mean(0.75 * end, 0.875 * end)
  }' "$T/bed")

# what settle chose, of what tells the size of the run
for c in count time; do
  value[$c]=${value[$c]:-$("$B/settle" --help |
    sed -n "s/^ *--$c .*\\[\\([0-9.]*\\)\\]\$/\\1/p")}
done
row=
for c in $columns; do row+="${value[$c]:--}"$'\t'; done
printf '%s\t' $columns status cpu_seconds evaluations accepted rejected sum \
  union outside kinetic
printf 'kinetic_before\n'
printf '%s%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$row" $status "$(stat cpu_seconds)" \
  "$(stat rhs_evaluations)" "$(stat steps_accepted)" \
  "$(stat steps_rejected)" "$fractions" "$motion"
