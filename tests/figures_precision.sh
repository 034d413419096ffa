# SPDX-License-Identifier: GPL-3.0-or-later
# A part of tests/test_figures.sh: make precision. Errors are as small as
# tolerances promise, orders are those of the methods and of the contact laws'
# smoothness, failures are marked.
D=$T/data/precision

# value SET METHOD ROW COLUMN, rows from 1, negative ones from the end
value() {
  awk -F '\t' -v row="$3" -v name="$4" '/^#/ || !NF {next}
    $1 == "method" {for (i = 1; i <= NF; i++) if ($i == name) c = i; next}
    {v[++n] = $c} END {print v[row < 0 ? n + 1 + row : row]}' "$D/$1/$2.tsv"
}

# Local errors of at most 1.1 tol in each unknown's unit add up and grow: in a
# collision that takes t by at most 1 + a t, where a t is 40 here (two unknowns,
# or six); the others let them grow by less.
embedded='merson dopri5 rkf45 rkck rk8pd'
for set in bounce-150:time bounce-150:energy collision:gap collision:velocity \
  restitution:speed toda-6:eigenvalue rolling:velocity transition:time \
  exponential:gap exponential-inelastic:gap spring:gap; do
  error=error_${set#*:} set=${set%:*}
  for method in $embedded rkc; do
    check "$set, $method: ok" test "$(value $set $method -1 status)" = ok
    within "$set, $method: $error" "$(value $set $method -1 $error)" 0 \
      "$(awk -v n="$(value $set $method -1 accepted)" \
        'BEGIN {print 6 * 41 * 1.1e-7 * (n + 1)}')"
    check "$set, $method: $error falls" awk \
      -v a="$(value $set $method 1 $error)" \
      -v b="$(value $set $method -1 $error)" 'BEGIN {exit !(b < a / 10)}'
  done
  # a multistep method's errors are known in advance only to some factor
  within "$set, msbdf: $error" "$(value $set msbdf -1 $error)" 0 1e-3
done
# The law with a memory that is updated between steps: no step control sees the
# effect of a long step on it.
within 'walton-braun, rk8pd at 1e-7: error' \
  "$(value walton-braun rk8pd -1 error_gap)" 1e-3 1

# The factor by which an error falls as the step is halved: second order, and
# first where the contact's force depends on the velocity.
for set in collision:gap:4 exponential:gap:4 toda-6:eigenvalue:4 \
  bounce-150:time:4 restitution:speed:2 exponential-inelastic:gap:2 \
  rolling:velocity:2; do
  IFS=: read -r name error factor <<<"$set"
  within "$name, verlet: halved step" "$(awk \
    -v a="$(value $name verlet -2 error_$error)" \
    -v b="$(value $name verlet -1 error_$error)" 'BEGIN {print a / b}')" \
    "$(awk "BEGIN {print 0.8 * $factor}")" \
    "$(awk "BEGIN {print 1.3 * $factor}")"
done
# symmetric in time: v0 again, and again as much energy, but for rounding in
# each step
within 'collision, verlet: velocity' \
  "$(value collision verlet -1 error_velocity)" 0 1e-12
within 'bounce, verlet: energy' "$(value bounce-150 verlet -1 error_energy)" 0 \
  1e-11

# order METHOD SET
order() {
  awk -F ' *\\| *' -v m="$1" -v set="$2" '$2 ~ /^order/ {
      for (i = 3; i <= NF; i++) if ($i == set) c = i; next}
    $2 == m && c {print $c; exit}' "$T/figures/precision-orders.md"
}
orders() { # SET ORDER TOLERANCE METHOD...
  local method set=$1 low high
  low=$(awk "BEGIN {print $2 - $3}") high=$(awk "BEGIN {print $2 + $3}")
  for method in "${@:4}"; do
    within "$set, $method: order" "$(order $method $set)" $low $high
  done
}
orders exponential 2 0.1 verlet
orders exponential 2 0.4 rkc
orders exponential 4 0.6 merson
orders exponential 5 0.6 dopri5 rkf45 rkck
orders exponential 8.5 1.5 rk8pd
# a kink at touch leaves two; its place within a step is chance, which eight
# runs do not average out
orders spring 2 0.8 $embedded rkc verlet
orders walton-braun 2 0.8 $embedded rkc verlet
# C^1 leaves three
orders rolling 3 0.4 $embedded
orders rolling 2 0.3 rkc
orders rolling 1 0.1 verlet

for method in merson verlet; do
  check "the reference's own error is stated" grep -q \
    '^# reference_error_time=[0-9.]*e-1[2-9]$' "$D/bounce-150/$method.tsv"
done
# failures: the word in the data, a cross in the chart
words() {
  "$B/precision" "$@" | awk -F '\t' '!/^#/ && $1 != "method" {print $NF}' |
    tr '\n' ' '
}
check 'a step into the wall' test \
  "$(words bounce --method merson --step-rung 3)" = 'gave_up '
check 'energy from nothing' test "$(words bounce --kappa 500 \
  --restitution 0.7071 --method verlet --step-rung 4e-4)" = 'lost '
check 'a line torn apart' test "$(words toda-open --method verlet \
  --step-rung 0.05 --step-rung 1e-4)" = 'lost ok '
"$B/precision" bounce --method merson --step-rung 3 --step-rung 1e-4 \
  --step-rung 1e-5 >"$T/failed.tsv"
if ((charts)); then
  gnuplot -c plots/precision/precision.gp "$T/failed.tsv" "$T/failed.svg" \
    title step error_time step error
  check 'a failure is drawn' grep -q 'failed' "$T/failed.svg"
fi

for arguments in '' bounce '--rung 1e-3 bounce' 'nosuch --rung 1e-3' \
  'bounce --rung 0x' 'bounce --method msbdf --step-rung 1e-3' 'bounce --method verlet --rung 1'; do
  "$B/precision" $arguments >/dev/null 2>"$T/err"
  check "precision $arguments: exit status" test $? = 2
done
