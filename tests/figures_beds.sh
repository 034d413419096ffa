# SPDX-License-Identifier: GPL-3.0-or-later
# A part of tests/test_figures.sh: make settling seeds trajectories stability-map
# stability-wrong-bed stability-vibration. What docs/precision.md and
# docs/stability.md say of whole beds and trajectories must be in the data, and
# the scripts that count it must count right.
D=$T/data

# cell FILE CONDITION COLUMN: of the row where a condition on c("NAME") holds
cell() {
  awk -F '\t' -v name="$3" '
    function c(n) { return $(at[n]) }
    /^#/ || !NF { next }
    !named++ { header = $0; for (k = 1; k <= NF; k++) at[$k] = k; next }
    $0 != header && ('"$2"') { print c(name) }' "$1"
}
settled() { # METHOD SETTING COLUMN, of the full model
  cell "$D/beds/settling.tsv" "c(\"variant\") == \"rotation\" && \
    c(\"method\") == \"$1\" && (c(\"step\") == \"$2\" || c(\"tol\") == \"$2\")" \
    "$3"
}

# The whole settling. Two seeds and 40 spheres for 2 s: ten times fewer than the
# chart's, so bounds are those of the chart's single seeds.
check 'settling: nothing failed' test \
  "$(cell "$D/beds/settling.tsv" 'c("status") == "failed"' method)" = ''
within 'Verlet at 1e-3 s is denser' "$(settled verlet 1e-3 difference)" 0.01 0.1
within 'rkc at its default, every seed' "$(settled rkc 5e-4 largest)" 0 0.003
within 'multirate at its default, every seed' \
  "$(settled multirate 2e-3 largest)" 0 0.005
within 'Merson at 0.1, every seed' "$(settled merson 0.1 largest)" 0 1e-4
within 'rkc takes less than a fifth of the evaluations of Merson' \
  "$(awk -v a="$(settled rkc 5e-4 evaluations)" \
    -v b="$(settled merson 0.1 evaluations)" 'BEGIN { print a / b }')" 0 0.2
check 'seeds: one row per seed' test \
  "$(grep -c '^| [12] ' "$T/figures/precision-seeds.md")" = 2

# Results of settling.awk for given rows: differences of 0.001, 0.003, 0.006, of
# mean 1/300 and variance 19/3 1e-6; t of two degrees of freedom is 4.303
head='model\tmethod\ttol\tstep\tseed\tstatus\tcpu_seconds\tevaluations\tunion\n'
mkdir -p "$T/timed"
for seed in 1 2 3; do
  # shellcheck disable=SC2059 # a format
  { printf "$head"; printf 'rotation\tmerson\t0.01\t-\t%d\tok\t9\t10\t%s\n' \
    $seed "0.6$seed"; } >"$T/timed/$seed.tsv"
  # shellcheck disable=SC2059 # a format
  { printf "$head"; printf 'rotation\trkc\t0.1\t-\t%d\tok\t%d\t10\t%s\n' \
    $seed $seed "0.6$seed$(awk -v s=$seed 'BEGIN { print s * (s + 1) / 2 }')"
  } >"$T/$seed.tsv"
done
mv "$T/2.tsv" "$T/timed/two.tsv"
awk -f plots/precision/settling.awk "$T"/timed/*.tsv "$T"/[13].tsv >"$T/out"
is_rkc='c("method") == "rkc"'
within 'settling.awk: mean' "$(cell "$T/out" "$is_rkc" difference)" 0.003333 \
  0.003334
within 'settling.awk: interval' "$(cell "$T/out" "$is_rkc" interval)" 0.006251 \
  0.006253
within 'settling.awk: rms' "$(cell "$T/out" "$is_rkc" rms)" 0.003915 0.003917
within 'settling.awk: largest' "$(cell "$T/out" "$is_rkc" largest)" 0.006 0.006
within 'settling.awk: CPU of the timed run alone' \
  "$(cell "$T/out" "$is_rkc" cpu_seconds)" 2 2
sed -i 's/\tok\t/\tgave_up\t/' "$T/1.tsv"
awk -f plots/precision/settling.awk "$T"/timed/*.tsv "$T"/[13].tsv >"$T/out"
check 'settling.awk: one failure fails all' test \
  "$(cell "$T/out" "$is_rkc" status)" = failed

# Trajectories of 2 x 2 x 2 spheres
trajectory() { # SET METHOD CONDITION COLUMN
  cell "$D/precision/$1/$2.tsv" "$3" "$4"
}
for set in trajectory-8 trajectory-8-basic; do
  within "$set: error of the reference" \
    "$(sed -n 's/^# reference_error_position=//p' "$D/precision/$set/rkc.tsv")" \
    1e-16 1e-7
  for method in merson rk8pd rkc; do
    check "$set, $method: ok" test "$(trajectory $set $method \
      'c("status") != "ok"' tol)" = ''
    within "$set, $method: error at 1e-7 by that at 1e-3" "$(awk \
      -v a="$(trajectory $set $method 'c("tol") == "0.001"' error_position)" \
      -v b="$(trajectory $set $method 'c("tol") == "1e-07"' error_position)" \
      'BEGIN { print b / a }')" 0 0.02
  done
done
# The same by settle, whose end is interpolated instead of stepped to
eight() {
  "$B/settle" --quiet --base 0.5,0.5 --count 8 --time 2 --lmax 0.2 \
    --control standard --hinit 1e-3 "$@" 2>"$T/err"
}
eight --method rk8pd --tol 1e-11 >"$T/sharp.bed"
eight --method merson --tol 1e-3 >"$T/merson.bed"
within 'error of position by settle over that by precision' "$(awk -f \
  plots/precision/horizon.awk "$T/sharp.bed" "$T/merson.bed" | awk -F '\t' \
  -v e="$(trajectory trajectory-8 merson 'c("tol") == "0.001"' error_position)" \
  'NR == 2 { print $4 / e }')" 0.98 1.02
# with friction stability pays for Merson's accuracy: better at equal cost
within 'with friction Merson at 1e-3 is sharper than rkc at 1e-5' "$(awk \
  -v a="$(trajectory trajectory-8 merson 'c("tol") == "0.001"' error_position)" \
  -v b="$(trajectory trajectory-8 rkc 'c("tol") == "1e-05"' error_position)" \
  'BEGIN { print a / b }')" 0 0.9
# Verlet halves its error when the step is halved, no more: between 2.5e-5 and
# 6.25e-6 orders 1 and 2 differ by a factor 4
within 'Verlet is of first order with friction' "$(awk \
  -v a="$(trajectory trajectory-8 verlet 'c("step") == "2.5e-05"' \
    error_position)" \
  -v b="$(trajectory trajectory-8 verlet 'c("step") == "6.25e-06"' \
    error_position)" 'BEGIN { print log(a / b) / log(4) }')" 0.5 1.5
horizon() { # VARIANT METHOD
  awk -F '\t' -v v="$1" -v m="$2" '$1 == v && $2 == m && $4 > most {
    most = $4 } END { print most + 0 }' "$D/precision/horizon.tsv"
}
for variant in basic rotation; do
  within "$variant: two sharp runs agree" "$(horizon $variant again)" 1e-16 1e-6
  within "$variant: rkc is within them" "$(horizon $variant rkc)" 1e-5 0.1
done
within 'friction: Merson is nearer than rkc by' "$(awk \
  -v a="$(horizon rotation merson)" -v b="$(horizon rotation rkc)" \
  'BEGIN { print b / a }')" 20 1e6

# The map: provoked outcomes
outcome() { # LIMIT SETTINGS...: of one cell, with rkc's bed to compare with
  local limit=$1 k=0
  shift
  for s in "$@"; do
    k=$((k + 1))
    LIMIT=$limit B=$B plots/beds/bed.sh "$s" >"$T/row$k.tsv" || return
  done
  eval "plots/stability/map.sh $(printf "'$T/row%d.tsv' " $(seq $k))" |
    awk 'NR == 2 { print $4 }'
}
small=count-32/time-3/frames-17/kappa-300/model-basic
check 'map: without the cap Merson gives up' test \
  "$(outcome 10 $small/method-merson/travel-0)" = gave_up
check 'map: with it the same settles' test \
  "$(outcome 10 $small/method-merson/tol-0.1)" = settled
check 'map: what takes too long has given up' test \
  "$(outcome 1 model-rotation/kappa-150/method-merson/frames-17)" = gave_up
check 'map: too soft for its load goes through the floor' test \
  "$(outcome 10 model-basic/kappa-30/time-0.55/frames-17)" = tunnelled
check 'map: a long fixed step blows up' test \
  "$(outcome 10 $small/method-verlet/step-4e-3)" = stopped
check 'map: falling is not rest' test \
  "$(outcome 10 model-basic/kappa-150/count-32/time-0.4/frames-17/tol-1)" = \
  jitter
M=$D/beds/map.tsv
map() { # PANEL KAPPA
  cell "$M" "c(\"panel\") == \"$1\" && c(\"kappa\") == $2" outcome
}
check 'map: Verlet melts the bed' test "$(map rotation-verlet 150)" = denser
check 'map: Verlet blows up' test "$(map rotation-verlet 500)" = stopped
for panel in basic-merson basic-rkc rotation-rkc; do
  check "map: $panel settles" test "$(map $panel 150) $(map $panel 500)" = \
    'settled settled'
done

# Slip: two spheres that overlap by 10 mm rub with phi F0 exp(1.5) 1.5/vmin
# times 2 (1/m + r^2/I) = 7, 9412 per second: Euler's limit is 2.125e-4 s
printf '%s\n' '# f0=10' '# kappa=150' '# friction=0.2' '# vmin=0.01' \
  '# lmax=0.1' $'id\tx\ty\tz\tr\tm' $'0\t0\t0\t0\t0.1\t1' \
  $'1\t0.19\t0\t0\t0.1\t1' '# status=ok' >"$T/two.bed"
awk -f plots/stability/slip.awk "$T/two.bed" >"$T/two.tsv"
within 'slip: the last stable step' "$(awk '$2 == 0 { h = $1 }
  END { print h }' "$T/two.tsv")" 1.89e-4 2.125e-4
within 'slip: the first unstable one' "$(awk '$2 == 1 { print $1; exit }' \
  "$T/two.tsv")" 2.125e-4 2.39e-4
share() { awk -v h="$1" 'NR > 1 && $1 > h * 0.999 { print $2; exit }' \
  "$D/beds/slip.tsv"; }
within 'slip: nothing is unstable at 1e-5 s' "$(share 1e-5)" 0 0
within 'slip: most of the force at 5e-4 s' "$(share 5e-4)" 0.8 1

# Stiff spheres come to rest: energies per sphere in a fall of metres are tens
# of J
last() { awk 'END { print $3 }' "$D/beds/vibration/$1.tsv"; }
for run in 500-rkc 500-merson; do
  within "vibration: $run at 2 s" "$(last $run)" 0 0.01
done
