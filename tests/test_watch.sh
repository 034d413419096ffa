#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The warnings of settle and bounce about runs that are made to go wrong here,
# and their silence about good ones. Run from the root of the repository;
# B is the directory of the programs.
. tests/harness.sh

run() { # PROGRAM ARGUMENT...: into $T/out, $T/err, $T/stats and $status
  said="$*"
  rm -f "$T/stats"
  timeout 60 "$B/$1" --stats "$T/stats" "${@:2}" >"$T/out" 2>"$T/err" </dev/null
  status=$?
}

key() { # NAME CONDITION: of the statistics, in terms of x
  check "$1: $2" awk -F '\t' -v name="$1" \
    '$1 == name {found = 1; x = $2; if (x ~ /nan|inf/ || !('"$2"')) bad = 1}
     END {exit bad || !found}' "$T/stats"
}

silent() {
  check 'exit status' test $status = 0
  check 'nothing said' test ! -s "$T/err"
  key warnings 'x == 0'
  key exit_status 'x == 0'
}

warns() { # COUNT PATTERN...: COUNT lines, each pattern in exactly one of them
  local lines=$1
  shift
  check "$lines lines" test "$(wc -l <"$T/err")" = "$lines"
  for pattern; do
    check "'$pattern' once" test "$(grep -Ec -e "$pattern" "$T/err")" = 1
  done
}

warned() { # COUNT PATTERN...: and the run is done
  check 'exit status' test $status = 0
  warns "$@"
  key warnings "x == $1"
}

page() { # NAME: as a warning ends
  echo "\(docs/stability.md, \"$1\"\)\$"
}

mark() { tail -n 1 "$T/out" | cut -d : -f 1; }

narrow=(--count 24 --base 0.5,0.5 --drop 0)
elastic=("${narrow[@]}" --model basic --restitution 1)

# --- good runs say nothing ----------------------------------------------------
run settle
silent
key stages_mean 'x > 2 && x < 20'
key stages_most 'x > 10 && x <= 400'
key power_evaluations 'x > 100'
key spectral_radius 'x > 1e3 && x < 1e6'
key spectral_radius_largest 'x > 5e4 && x < 1e6'
key overlap_deepest 'x > 0.2 && x < 0.5'
key steps_with_deep_overlap 'x == 0'
key energy_gain 'x < 1'
key cut_error 'x > 5.5e-8 && x < 5.7e-8' # sqrt(10/300) exp(-15)
for seed in 2 3; do
  run settle --seed $seed --time 2
  silent
done
for model in basic friction; do
  run settle --model $model --time 1
  silent
done
run settle --method merson --time 0.5
silent
key watch_evaluations 'x > 0 && x < 80'
run settle "${narrow[@]}" --method verlet --step 2e-5 --time 0.6
silent
key stiffness_ratio 'x > 0.05 && x < 1'
run settle "${elastic[@]}" --time 1 --method rkc
silent
# without damping rkc's radius is a frequency, not its square
key stages_mean 'x < 2.5'
key spectral_radius_largest 'x > 300 && x < 1e4'
key rhs_evaluations 'x < 10000' # 22673 by the square
run settle "${narrow[@]}" --model basic --kappa 500 --time 0.6
silent
run settle --count 4 --time 0.4 --method msbdf
silent
run settle --count 1 --time 0
silent
run settle --count 1 --gravity 0 --time 1
silent
# energy has its weight, of contacts that close slowly, and begins at lmax
run settle "${narrow[@]}" --model basic --restitution 0 --tol 1e-6 --time 0.6
silent
key surveys 'x > 30'
# one that hardly moves is looked at every 300 evaluations, here one per step
printf '# format=bed-1\n# t=0\n# wall=0 0 0 0 0 -1\nx\ty\tz\tr\n%s\n# status=ok\n' \
  $'0.5\t0.5\t0.0965\t0.1' >"$T/rests"
run settle --scene "$T/rests" --model basic --method verlet --step 1e-3 --time 3
silent
key surveys 'x >= 10 && x <= 12'
key energy_gain 'x < 1e-3'
run settle "${narrow[@]}" --model basic --restitution 1 --kappa 60 --time 0.6 \
  --method dopri5 --control standard --tol 1e-5
key energy_gain 'x < 5e-4' # one contact begins with 8e-4
run settle "${narrow[@]}" --method verlet --step 7e-5 --time 0.6
silent
key time_beyond_limit 'x > 0.1 && x < 0.5'
for height in 16 0.1 1e-2 3e-3 1e-3 1e-4 1e-6; do
  run bounce --restitution 0 --height $height --psi 1
  silent
  run bounce --height $height --kappa 30
  silent
done
for options in '' --rebound '--restitution 0.4' '--method dopri5' \
  '--method rkc --tol 5e-4 --restitution 0.5' '--method verlet --step 1e-4' \
  '--hinit 1e-12 --time 0.1' '--height 1e-6' '--method msbdf'; do
  # shellcheck disable=SC2086
  run bounce $options
  silent
done

# --- stability sets the steps ------------------------------------------------
run settle "${narrow[@]}" --method merson --time 1
warned 1 "stability, .* [67][0-9] % .*friction.*--method rkc.*$(page 'Stability limits')"
key stiffness_ratio 'x > 0.8 && x < 1.1'
key h_rho_median 'x > 2.8 && x < 3.9'
key h_rho_limit 'x > 3.5 && x < 3.6' # merson, real axis
key steps_at_limit 'x > 0.5 && x < 1'
key time_at_limit 'x > 0.5 && x < 1'
share=$(awk -F '\t' '{s[$1] = $2}
  END {print s["watch_evaluations"] / s["rhs_evaluations"]}' "$T/stats")
check "watching costs $share" awk "BEGIN {exit !($share > 0 && $share < 0.01)}"
run settle "${narrow[@]}" --method dopri5 --control standard --tol 1e-5 --time 0.6
warned 1 "--method rkc.*$(page 'Stability limits')"
run bounce --restitution 0.1 --control paper --tol 1 --time 30 --psi 1000
warned 1 "--method rkc.*$(page 'Stability limits')"

# --- a fixed step beyond what friction allows ---------------------------------
run settle "${narrow[@]}" --method verlet --step 4e-4 --time 1
warned 1 "--step 0.0004 was beyond .*friction.*limit 2.*$(page 'Wrong beds')"
key time_beyond_limit 'x > 0.5'
run settle "${narrow[@]}" --method verlet --step 4e-4 --time 1 --model basic
silent

# too fine a tolerance for so soft a bed is said where it is used, not with a fixed step
run settle --count 60 --base 0.5,0.5 --kappa 60 --method verlet --step 1e-4 \
  --lmax 0.3 --time 0.01 --tol 1e-9
silent

# --- penetration, and the cut at lmax -----------------------------------------
run settle "${narrow[@]}" --kappa 30 --time 0.6
warned 2 "sphere [0-9]+ overlaps by 0.5.* more than 0.5.*$(page Penetration)" \
  "lmax 0.1 leaves errors of 0.02 m/s,.*tolerance 0.002.*$(page 'The cut at lmax')"
key overlap_deepest 'x > 0.5 && x < 1.5'
key steps_with_deep_overlap 'x > 10'
# its centre passes the floor, softly: that is no failure
run settle --count 1 --kappa 30 --lmax 0.3 --drop 3 --time 0.9
warned 1 "overlaps.*$(page Penetration)"
key overlap_deepest 'x > 1'
# Merson's third and fourth stage see 0.7 of the jump, 10 exp(-15) m/s^2
run settle --count 1 --time 0.1 --method merson --tol 1e-6
warned 1 "errors of $(awk 'BEGIN {printf "%.2g", 0.7 * 10 * exp(-15)}') m/s\^2,"
# what it advises is enough
for options in '--kappa 30' '--control standard --tol 1e-9' \
  '--method merson --tol 1e-6' '--kappa 60 --f0 50 --reltol 1e-5'; do
  # shellcheck disable=SC2086
  run settle --count 1 --time 0.1 $options
  warned 1 "$(page 'The cut at lmax')"
  enough=$(sed -n 's/.*; --lmax \([^ ]*\) would do.*/\1/p' "$T/err")
  # shellcheck disable=SC2086
  run settle --count 1 --time 0.1 $options --lmax "$enough"
  silent
  less=$(awk "BEGIN {print $enough - 0.011}")
  # shellcheck disable=SC2086
  run settle --count 1 --time 0.1 $options --lmax "$less"
  warned 1 "$(page 'The cut at lmax')"
done

# --- a bed that begins half in a wall ------------------------------------------
"$B/settle" --count 8 --time 0 >"$T/start"
awk -F '\t' -v OFS='\t' '/^[0-9]/ && !done {$4 = 0.03; done = 1} {print}' \
  <(unsealed "$T/start") >"$T/half"
run settle --scene "$T/half" --time 0.02 --kappa 40
warned 2 "t=0: sphere 0 overlaps by 0.70 radii.*$(page Penetration)" \
  "$(page 'The cut at lmax')"

# by 0.48 and by 0.52 radii: 0.5 is deep
for z in 0.052 0.048; do
  awk -F '\t' -v OFS='\t' -v z=$z '/^[0-9]/ && !done {$4 = z; done = 1} {print}' \
    <(unsealed "$T/start") >"$T/half"
  run settle --scene "$T/half" --time 0
  warns "$([[ $z == 0.048 ]] && echo 1 || echo 0)"
done

# --- energy -------------------------------------------------------------------
run settle "${elastic[@]}" --method rkc --step 1e-3 --time 1
warned 1 "J were gained without a source.*$(page Energy)"
key energy_gain 'x > 1'
run settle "${elastic[@]}" --method merson --step 4e-3 --time 1
warned 1 "J are lost.*e = 1.*$(page Energy)"
run bounce --method rkc --tol 1
warned 1 "J were gained without a source.*$(page Energy)"
run bounce --method merson --step 1e-3
warned 1 "J are lost.*$(page Energy)"

# --- through a wall -------------------------------------------------------------
run settle "${narrow[@]}" --step 0.2 --method verlet --time 2
check 'exit status' test $status = 4
warns 1 "sphere [0-9]+ is .* m outside wall [1-5]; .*$(page 'Missed collisions')"
check mark test "$(mark)" = '# status=failed at t=0.2'
key exit_status 'x == 4'
key energy_gain 'x > 1e6'
check 'last frame' test "$(grep -c '^[0-9]' "$T/out")" = 24
run settle --count 1 --drop 3 --travel 0 --tol 1e4 --control standard \
  --method merson
check 'exit status' test $status = 4
check 'a wall' grep -Eq "outside wall.*$(page 'Missed collisions')" "$T/err"
run settle --count 1 --drop 3 --tol 1e-3 --control standard --method merson \
  --time 1 # the limit of travel prevents it
silent
run settle --count 1 --drop 0.5 --time 3 --step 0.3 --method merson
check 'exit status' test $status = 4
warns 1 "t=0.3: forces overflow with this --step; .*$(page 'Missed collisions')"
run bounce --method verlet --step 1e-2
check 'exit status' test $status = 4
warns 1 "the sphere is .* below the floor, expected at most 0.0518 m .*$(page 'Missed collisions')"

# --- a ruined bed is not called good --------------------------------------------
failed_by() { # PATTERN: a failed mark with it, and no warning but what is said
  check 'exit status' test $status = 4
  key exit_status 'x == 4'
  check "mark: $1" grep -Eq "^# status=failed at t=[^ ]*: $1" <(tail -n 1 "$T/out")
  check "said: $1" grep -Eq "^settle: t=[^ ]*: $1.*; the bed is marked as failed \
\(docs/stability.md, \"[A-Z]" "$T/err"
}

# spheres of 1 and 0.5 mm with forces for 100 mm: nothing holds them
paper=(--kappa 150 --f0 10 --psi 10 --vmin 0.01 --lmax 0.1 --tol 5e-4 --hinit 0.1)
run settle --radius 5e-4 --mass 1 --base 1,1 --drop 1.1 "${paper[@]}" --time 0.5
failed_by '1[0-9]+ of 200 centres are outside of walls, that of sphere [0-9]+ .* m outside wall 1'
run settle --radius 1e-3 --base 0.01,0.01 --drop 0.011 --model basic --count 4 \
  "${paper[@]}" --time 0.2
failed_by '4 of 4 centres are outside of walls'
# at a frame, if it comes back until the end
soft=(--count 1 --kappa 30 --lmax 0.3 --drop 3 --time 0.9)
run settle "${soft[@]}" --frames 2
check 'exit status' test $status = 0
run settle "${soft[@]}" --frames 301
failed_by '1 of 1 centres are outside of walls, that of sphere 0 .* outside wall 1'
check 'and goes on' awk -F '\t' \
  '/^[0-9]/ {z = $4; n++; below += z <= 0} END {exit !(n == 301 && below && z > 0)}' \
  "$T/out"
check 'said once' test "$(grep -c 'marked as failed' "$T/err")" = 1

# what is called good is taken as a start, for too soft spheres as well
for kappa in 15 20 25 30 45 60; do
  run settle --count 32 --base 0.5,0.5 --drop 0 --kappa $kappa --lmax 1 --time 1.5
  code=$status
  cp "$T/out" "$T/bed"
  run settle --scene "$T/bed" --time 1.5
  check "kappa $kappa: $code, as a scene $status" \
    test $((code == 4 ? 3 : code)) = $status
  [[ $kappa != 15 ]] || check 'kappa 15 is a failure' test $code = 4
  [[ $kappa != 60 ]] || check 'kappa 60 is none' test $code = 0
done
# two centres in one place, without walls
printf '%s\n' '# format=bed-1' '# t=0' $'id\tx\ty\tz\tr\tvx' \
  $'0\t-0.3\t0\t0\t0.1\t4' $'1\t0.3\t0\t0\t0.1\t-4' '# status=ok' >"$T/meet"
run settle --scene "$T/meet" --gravity 0 --restitution 0 --friction 0 --kappa 5 \
  --f0 0.1 --lmax 3 --time 0.08
failed_by 'centres of spheres 0 and 1 are .* m apart, expected at least 0.08 m'
run settle --scene "$T/meet" --gravity 0 --restitution 0 --friction 0 --kappa 5 \
  --f0 0.1 --lmax 3 --time 0.3 # through and out again: none of its business
check 'exit status' test $status = 0

# --- numbers that are none ------------------------------------------------------
run settle --method verlet --step 1 --count 20 --time 1
failed_by 'the energy is not finite'
check 'no nan in the statistics' test "$(grep -cE 'nan|inf' "$T/stats")" = 0
# v^2 overflows, though no wall is there to be passed
printf '%s\n' '# format=bed-1' '# t=0' $'id\tx\ty\tz\tr\tvx' \
  $'0\t0\t0\t0\t0.1\t1e153' '# status=ok' >"$T/fast"
run settle --scene "$T/fast" --gravity 0 --step 1e-200 --method merson \
  --time 1e-199
check 'exit status' test $status = 0
sed -i 's/1e153/1e155/' "$T/fast"
run settle --scene "$T/fast" --gravity 0 --step 1e-200 --method merson \
  --time 1e-199
check 'exit status' test $status = 3
warns 1 "the start's energy is not finite"

# --- bounce: the same statistics ------------------------------------------------
run bounce --method merson
silent
key unknowns 'x == 2'
key rhs_evaluations 'x > 1000 && x < 100000'
key steps_accepted 'x > 200'
key t_end 'x == 10'
key energy_start 'x > 156.9 && x < 157'
key h_rho_limit 'x > 3.4 && x < 3.6'
run bounce --method rkc
silent
key stages_most 'x >= 2'
run bounce --method verlet --step 1e-2
key exit_status 'x == 4'
run bounce --rebound --time 1
check 'exit status' test $status = 5
key exit_status 'x == 5'

# --- threads change nothing that is said ---------------------------------------
for threads in 1 2; do
  run settle "${narrow[@]}" --method merson --time 0.6 --threads $threads
  grep -Ev 'seconds|threads|memory' "$T/stats" >"$T/stats$threads"
done
check 'the same statistics' cmp "$T/stats1" "$T/stats2"

check_done
