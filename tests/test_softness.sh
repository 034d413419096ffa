#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# settle --overlap and --creep: beds that overlap as much as was asked for, the
# header's numbers, and what is refused.
. tests/harness.sh

# Mean overlap of the contacts that touch the floor, in diameters
floor_overlap() {
  "$B/analyze" contacts --network --gap 0 "$1" | awk -F '\t' -v d="$2" '
    NR > 1 && $4 == 1 && $13 > 0.9 && $10 <= 0 { s -= $10; n++ }
    END { print n ? s / n / d : "nan" }'
}
header() { # FILE KEY
  sed -n "s/^# $2=//p" "$1" | head -n 1
}

# The mean over 17 to 20 contacts is known to a sixth: their loads differ as an
# exponential distribution does, so ln N by 1.28, and its mean is 1.47. So three
# beds each: without friction another compiler makes others of the same seeds.
for options in '--overlap 0.03' '--overlap 0.005 --friction 0.5' \
  '--overlap 0.01 --model basic --restitution 0.8' \
  '--overlap 0.02 --radius 0.00025 --density 2500' \
  '--overlap 0.01 --base 1.5,0.8 --count 120'; do
  asked=$(sed 's/.*--overlap \([0-9.]*\).*/\1/' <<<"$options")
  said=$options
  for seed in 1 2 3; do
    # shellcheck disable=SC2086
    "$B/settle" --quiet --seed $seed $options >"$T/bed" 2>"$T/err"
    check 'without a word' test $? = 0 -a ! -s "$T/err"
    r=$(header "$T/bed" radius)
    floor_overlap "$T/bed" "$(awk -v r="$r" 'BEGIN { print 2 * r }')"
  done >"$T/got"
  got=$(awk '{ s += $1 } END { print s / NR }' "$T/got")
  check "overlap $got for $asked" awk -v a="$asked" -v g="$got" \
    'BEGIN { exit !(g / a > 0.8 && g / a < 1.25) }'
done
said=

# kappa by the overlap alone, F0 by the load, lmax by kappa unless it is given
"$B/settle" --overlap 0.02 --time 0 >"$T/a"
"$B/settle" --overlap 0.01 --count 400 --time 0 >"$T/b"
"$B/settle" --overlap 0.01 --lmax 0.05 --time 0 >"$T/c"
ratio() { # KEY A B
  awk -v a="$(header "$2" "$1")" -v b="$(header "$3" "$1")" \
    'BEGIN { printf "%.12g", b / a }'
}
check 'kappa' test "$(ratio kappa "$T/a" "$T/b")" = 2
check 'F0' test "$(ratio f0 "$T/a" "$T/b")" = 2
check 'lmax' test "$(ratio lmax "$T/a" "$T/b")" = 0.5
check 'lmax as given' test "$(header "$T/c" lmax)" = 0.05
check 'no key of its own' test -z "$(header "$T/a" overlap)"
# of a bed that has been made, by the base in its header
"$B/settle" --overlap 0.01 --scene "$T/a" --time 0 --quiet >"$T/d"
check 'of a scene' test "$(ratio kappa "$T/a" "$T/d")" = 2
# a tube has pi/4 of the area of its square
"$B/settle" --overlap 0.01 --cylinder 0,0,0,0,0,1,0.5 --time 0 --quiet >"$T/d"
"$B/settle" --overlap 0.01 --time 0 --quiet >"$T/c"
check 'of a tube' test "$(ratio f0 "$T/d" "$T/c")" = 0.785398163397

"$B/settle" --creep 0.05 --time 2 --count 4 >"$T/a" 2>"$T/err"
check 'creep: 2 * 0.05 * 0.1 / 2' test "$(ratio vmin "$T/a" \
  <(echo '# vmin=0.005'))" = 1
check 'creep: the cost' grep -q 'vmin is 0.005 m/s.* 2 times as stiff' "$T/err"
"$B/settle" --creep 5 --time 2 --count 4 >"$T/a" 2>"$T/err"
check 'creep: nothing is said where it costs nothing' test ! -s "$T/err"

refuse() { # PATTERN OPTION...
  "$B/settle" --quiet "${@:2}" >"$T/out" 2>"$T/err"
  check "${*:2}: exit status" test $? = 2
  check "${*:2}: one line" grep -Eq -e "$1" "$T/err"
}
refuse '--kappa: follows from --overlap' --overlap 0.01 --kappa 300
refuse '--f0: follows from --overlap' --overlap 0.01 --f0 30
refuse '--vmin: follows from --creep' --creep 0.1 --vmin 0.001
refuse 'gravity downwards' --overlap 0.01 --gravity 0
refuse 'gravity downwards' --overlap 0.01 --gravity 1,0,-9
refuse 'beside other walls' --overlap 0.01 --wall 0,0,0,0,0,-1
refuse 'a cylinder that leans' --overlap 0.01 --cylinder 0,0,0,1,0,9,0.5 \
  --count 1
refuse 'without friction' --creep 0.1 --model basic
refuse 'without friction' --creep 0.1 --friction 0
refuse '--time above 0' --creep 0.1 --time 0
refuse 'overlap' --overlap 0

# A tolerance finer than softness lets see is said once
"$B/settle" --quiet --tol 1e-5 --time 0.05 >"$T/out" 2>"$T/err"
check 'balance: said' grep -q 'larger by some 0.08 (kappa r = 15)' "$T/err"
check 'balance: once' test "$(wc -l <"$T/err")" = 1
"$B/settle" --quiet --time 0.05 >"$T/out" 2>"$T/err"
check 'balance: the default is' test ! -s "$T/err"
"$B/settle" --quiet --tol 1e-5 --time 0.05 --overlap 0.001 --model basic \
  --lmax 0.003 >"$T/out" 2>"$T/err"
check 'balance: hard contacts are' test ! -s "$T/err"

# The limit of hard contacts, of beds with 20, 19 and 18.5 spheres in the box:
# 18 + 60/(kappa r)
pearls() { # KAPPA COUNT [KEY=VALUE]
  awk -v kappa="$1" -v n="$2" -v key="${3:-friction=0.2}" 'BEGIN {
    print "# format=bed-1\n# kappa=" kappa "\n# radius=0.1\n# wall=0 0 0 0 0 -1"
    print "# " key "\nx\ty\tz\tr"
    for (i = 0; i < n; i++) # the last one may be cut in half
      printf("%.17g\t%.17g\t%.17g\t0.1\n",
        (i + 0.5 >= n ? 1 : 0.1 + 0.2 * (i % 4)), 0.1 + 0.2 * (int(i / 4) % 4), 0.1 + 0.2 * int(i / 16))
    print "# status=ok" }'
}
pearls 300 20 >"$T/30"
pearls 600 19 >"$T/60"
pearls 1200 18.5 >"$T/120"
hard() {
  "$B/analyze" hard --box 0,1,0,1,0,1 "$@" >"$T/out" 2>"$T/err"
}
column() {
  awk -F '\t' -v want="$1" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
    { print $at[want] }' "$T/out"
}
near() { # NAME GOT WANT TOLERANCE
  check "$1: $2, expected $3" awk -v g="$2" -v w="$3" -v t="$4" \
    'BEGIN { d = g - w; exit !(g != "nan" && d <= t && -d <= t) }'
}
ball=$(awk 'BEGIN { printf "%.17g", 4 / 3 * atan2(0, -1) * 0.001 }')
of() { awk -v n="$1" -v v="$ball" 'BEGIN { printf "%.17g", n * v }'; }
hard "$T/30" "$T/60" "$T/120"
near 'hard: the limit' "$(column union)" "$(of 18)" 1e-12
near 'hard: the slope' "$(column slope)" "$(of 60)" 1e-9
near 'hard: kappa r' "$(column softest)/$(column hardest)" 30/120 0
near 'hard: no deviation' "$(column high)" "$(of 18)" 1e-9
check 'hard: one row, not a word' test "$(wc -l <"$T/out")" = 2 -a ! -s "$T/err"
hard "$T/30" "$T/60" --deviation 0.01
near 'hard: two beds' "$(column union)" "$(of 18)" 1e-12
near 'hard: their interval' "$(column high)" \
  "$(awk -v u="$(of 18)" 'BEGIN { print u + 1.959964 * sqrt(5) * 0.01 }')" 1e-6
# by default that of a bed of 200, as one of 19 has it
hard "$T/30" "$T/60"
near 'hard: their interval by default' "$(column high)" "$(awk -v u="$(of 18)" \
  'BEGIN { print u + 1.959964 * sqrt(5) * 0.006 * sqrt(200 / 19) }')" 1e-6
pearls 600 19 friction=0.5 >"$T/other"
hard "$T/30" "$T/other"
check 'hard: other beds' grep -q 'differ in friction' "$T/err"
pearls 150 22 >"$T/15"
hard "$T/15" "$T/60"
check 'hard: too soft' grep -q 'from 30 on' "$T/err"
for files in "$T/30" "$T/30 $T/30"; do
  # shellcheck disable=SC2086
  hard $files
  check "hard: refused" test $? != 0 -a "$(wc -l <"$T/err")" = 1
done
check_done
