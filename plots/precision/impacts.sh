#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The impacts of Chung and Ooi by our law: errors over tolerances, and what is
# left to a hard sphere's as the law comes near it. One row per run:
# kind   tolerance: of the integration, by the speed of the impact; limit: psi
#        by that speed, with a tenth of its inverse for vmin and 15 times it for
#        kappa r
# x      one of these; error the larger of those of speed and slip, or what is
#        left, by the speed (root mean squares over the impacts of a test)
set -eu -o pipefail
B=${B:-build}
speeds=(20 0.2 3.9 3.9 5 0.2 0.4 0.2)
radii=(0.01 0.1 0.0025 0.0025 1e-5 0.1 0.1 0.1)
run() { # TEST OPTION...
  "$B/precision" "impact-$1" --method rk8pd --timed 0 "${@:2}"
}
times() {
  awk "BEGIN { printf \"%.6g\", ($1) * ($2) }"
}
if [ -n "${QUICK:-}" ]; then
  rungs='1e-4 1e-8' limits='10 100'
else
  rungs='1e-2 1e-3 1e-4 1e-5 1e-6 1e-7 1e-8 1e-9 1e-10 1e-11 1e-12'
  limits='10 30 100 300 1000 3000 10000'
fi
printf 'kind\ttest\tx\terror\tevaluations\n'
for test in 1 2 3 4 5 6 7 8; do
  v=${speeds[test - 1]} r=${radii[test - 1]}
  ladder=()
  for x in $rungs; do
    ladder+=(--rung "$(times "$x" "$v")")
  done
  # pairs that rub turn by some 1/(kappa r)
  stiff=()
  [ $test != 8 ] || stiff=(--kappa "$(times 1e7 "1 / $r")")
  run $test "${ladder[@]}" "${stiff[@]}" |
    awk -F '\t' -v OFS='\t' -v v="$v" -v test=$test '
      /^#/ { next }
      $1 == "method" { for (k = 1; k <= NF; k++) at[$k] = k; next }
      $at["status"] != "ok" { print "impact-" test ": " $0 > "/dev/stderr"; exit 1 }
      { a = $at["error_speed"]; b = $at["error_slip"]
        print "tolerance", test, $at["tol"] / v, (a > b ? a : b), $at["evaluations"] }'
done
for test in 3 4 5 6 7 8; do
  v=${speeds[test - 1]} r=${radii[test - 1]}
  for x in $limits; do
    run $test --rung "$(times 1e-10 "$v")" --psi "$(times "$x" "1 / $v")" \
      --vmin "$(times "$v" "0.1 / $x")" --kappa "$(times "15 * $x" "1 / $r")" |
      awk -F '\t' -v OFS='\t' -v x="$x" -v test=$test '
        /^#/ { next }
        $1 == "method" { for (k = 1; k <= NF; k++) at[$k] = k; next }
        { print "limit", test, x, $at["error_hard"], $at["evaluations"] }'
  done
done
