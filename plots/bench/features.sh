#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# CPU time of each feature for one evaluation of a contact, by that of the plain
# scene. Runs of both alternate, and since what else the machine does only makes
# a run slower, the least times of ROUNDS runs of each are compared; the second
# least ones tell how well that is known. Then the contact evaluations of the
# whole run, by the plain one's.
set -eu -o pipefail
B=${B:-build}
ROUNDS=${ROUNDS:-7}
read -r -a SIZE <<< "${SIZE:---count 200 --time 1.5}"
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT

run() { # OPTION...: CPU seconds and contact evaluations
  "$B/settle" --quiet --method rkc --stats "$T/stats" "$@" > "$T/bed" 2> "$T/err" || {
    cat "$T/err" >&2
    exit 1
  }
  awk -F '\t' '$1 == "cpu_seconds" { t = $2 } $1 == "contact_evaluations" { n = $2 }
    END { print t, n }' "$T/stats"
}
feature() { # NAME OPTION...
  local round t n # of the plain scene, of the feature
  for ((round = 0; round < ROUNDS; round++)); do
    t=$(run "${plain[@]}") n=$(run "${@:2}") # a failure ends the script
    echo "$t $n"
  done | awk -v name="$1" '
    function least(of, x) { # the two least of a kind
      if (!(of in first) || x < first[of]) { second[of] = first[of]; first[of] = x }
      else if (second[of] == "" || x < second[of]) second[of] = x
    }
    { least("plain", $1 / $2); least("feature", $3 / $4); work = $4 / $2 }
    END { printf "%s\t%.2f\t%.2f\t%.2f\n", name, first["feature"] / first["plain"],
      second["feature"] / second["plain"], work }'
}

printf 'feature\tCPU of a contact evaluation\tthe same again\tcontact evaluations\n'
plain=("${SIZE[@]}")
feature 'none' "${SIZE[@]}"
feature 'a wall more (`--lid 90`)' "${SIZE[@]}" --lid 90
feature 'tube of the same area' "${SIZE[@]}" \
  --cylinder 0.5642,0.5642,0,0,0,1,0.5642
feature '`--periodic xy`' "${SIZE[@]}" --periodic xy
feature '`--sizes` of 0.1 m, a thousandth more or less' "${SIZE[@]}" \
  --sizes uniform:0.0999,0.1001
feature '`--sizes` of 0.05 to 0.15 m' "${SIZE[@]}" --sizes uniform:0.05,0.15
feature '`--lever contact`' "${SIZE[@]}" --lever contact
feature '`--rolling 0.1`' "${SIZE[@]}" --rolling 0.1
# the spheres on the floor of a bed become obstacles, and the bed goes on
run "${SIZE[@]}" > "$T/none"
mv "$T/bed" "$T/plain.bed"
awk -F '\t' -v OFS='\t' '/^# checksum=/ { next } # not of what it becomes
  /^id/ { print $0, "fixed"; next }
  !/^[0-9]/ { print; next }
  $4 < 0.12 { for (k = 7; k <= 12; k++) $k = 0; print $0, 1; next }
  { print $0, 0 }' "$T/plain.bed" > "$T/fixed.bed"
end=$(awk '/^# t=/ { sub(/.*=/, ""); t = $0 } END { print 2 * t }' "$T/plain.bed")
plain=(--scene "$T/plain.bed" --time "$end")
feature 'obstacles on the floor' --scene "$T/fixed.bed" --time "$end"
