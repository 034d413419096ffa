#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Impacts and slopes of `precision`: errors fall with the tolerance to rounding,
# and with psi and vmin the law comes to Coulomb's friction of phi/e.
. tests/harness.sh

run() { # SCENE OPTION...: into T/tsv
  "$B/precision" "$1" --method rk8pd --timed 0 "${@:2}" > "$T/tsv" 2> "$T/err"
  check "$*: exit status" [ $? -eq 0 ]
  check "$*: all ok" [ "$(grep -c 'ok$' "$T/tsv")" = "$(grep -c ^rk8pd "$T/tsv")" ]
}
value() { # COLUMN ROW
  awk -F '\t' -v name="$1" -v row="$2" '/^#/ { next }
    /^method/ { for (k = 1; k <= NF; k++) at[$k] = k; next }
    ++rows == row { print $at[name] }' "$T/tsv"
}
share() { # of two numbers
  awk "BEGIN { print ($1) / ($2) }"
}

# speed of the impact (m/s), the least tolerance by 1e-12 of it; some hundred
# steps of at most that error
speeds=(20 0.2 3.9 3.9 5 0.2 0.4)
for test in 1 2 3 4 5 6 7; do
  v=${speeds[test - 1]}
  rungs=()
  for x in 1e-4 1e-8 1e-12; do
    rungs+=(--rung "$(awk "BEGIN { print $x * $v }")")
  done
  run impact-$test "${rungs[@]}"
  for error in speed slip; do
    within "impact-$test: error of $error" "$(value error_$error 3)" 0 1e-10
    within "the same at 1e-8" "$(value error_$error 2)" 0 1e-6
    within "the same at 1e-4" "$(value error_$error 1)" 0 1e-2
  done
done
# ten times the psi and a tenth of vmin: 1/psi where friction loses energy, else
# 1/psi^2
limit() { # TEST SPEED LOW HIGH: what is left falls by so much
  local hard=() x
  for x in 100 1000; do
    run "impact-$1" --rung 1e-11 --psi "$(share $x "$2")" \
      --vmin "$(share "0.1 * $2" $x)"
    hard+=("$(value error_hard 1)")
  done
  within "impact-$1: to the hard sphere" "$(share "${hard[0]}" "${hard[1]}")" "$3" "$4"
  within "impact-$1: near the hard sphere" "${hard[1]}" 1e-12 1e-3
}
limit 3 3.9 90 110
limit 5 5 90 110
limit 6 0.2 9 11
limit 7 0.4 90 110
# pairs that rub turn by some 1/(kappa r)
for kappa in 3e5 3e6; do
  run impact-8 --rung 1e-10 --kappa $kappa
  turned+=("$(value error_slip 1)")
done
within 'impact-8: turns as 1/kappa' "$(share "${turned[0]}" "${turned[1]}")" 9 11
within 'impact-8: by little' "${turned[1]}" 0 1e-5

# a few steps of at most the tolerance; sliding is linear, so exact
run slope --rung 1e-6 --rung 1e-12
within 'creep on a slope' "$(value error_creep 2)" 0 2e-12
within 'sliding on a slope' "$(value error_sliding 2)" 0 1e-15
run slope --rung 1e-12 --restitution 0.9 --friction 0.5
within 'the same for another law' "$(value error_creep 1)" 0 2e-12
check_done
