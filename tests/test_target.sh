#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# settle --target-fraction: the friction that it finds, the bed that it makes,
# and what is not reachable.
. tests/harness.sh

bed=(--count 60 --base 0.6,0.6 --time 2)
fraction() {
  "$B/analyze" fraction "$1" | awk 'END { print $3 }'
}
header() { # FILE KEY
  sed -n "s/^# $2=//p" "$1" | head -n 1
}
within() { # NAME VALUE LOW HIGH
  check "$1: $2 is not in $3 to $4" awk -v x="$2" -v a="$3" -v b="$4" \
    'BEGIN { exit !(x != "nan" && x >= a && x <= b) }'
}

# What can be had, from beds of their own
"$B/settle" --quiet "${bed[@]}" --friction 0 >"$T/smooth"
"$B/settle" --quiet "${bed[@]}" --friction 1 >"$T/rough"
most=$(fraction "$T/smooth") least=$(fraction "$T/rough")
within 'friction makes room' "$(awk -v a="$most" -v b="$least" \
  'BEGIN { print a - b }')" 0.05 0.2

middle=$(awk -v a="$most" -v b="$least" 'BEGIN { printf "%.3g", (a + b) / 2 }')
"$B/settle" --quiet "${bed[@]}" --target-fraction "$middle" >"$T/bed" 2>"$T/err"
check 'found' test $? = 0
check 'says friction and interval' grep -Eq \
  "^settle: --target-fraction $middle: friction [0-9.e-]+ \([0-9.e-]+ to [0-9.e-]+\) by [0-9]+ trial beds" "$T/err"
# beds of 60 differ by 0.006 sqrt(200/60) = 0.011: three of these, and those of
# the line
within 'the bed has it' "$(fraction "$T/bed")" \
  "$(awk -v m="$middle" 'BEGIN { print m - 0.04 }')" \
  "$(awk -v m="$middle" 'BEGIN { print m + 0.04 }')"
said=$(awk '/the bed fills/ { print $NF }' "$T/err")
within 'and it says so' "$(fraction "$T/bed")" \
  "$(awk -v s="$said" 'BEGIN { print s - 0.00006 }')" \
  "$(awk -v s="$said" 'BEGIN { print s + 0.00006 }')"
said=
friction=$(header "$T/bed" friction)
within 'between the ends' "$friction" 0.001 0.999
"$B/settle" --quiet "${bed[@]}" --friction "$friction" >"$T/again"
check 'the same bed by --friction' cmp -s "$T/bed" "$T/again"
# denser takes less friction
denser=$(awk -v a="$most" -v b="$middle" 'BEGIN { printf "%.3f", (a + b) / 2 }')
"$B/settle" --quiet "${bed[@]}" --target-fraction "$denser" >"$T/denser" \
  2>"$T/err"
within 'denser: friction' "$(header "$T/denser" friction)" 0 "$friction"

for x in 0.9 0.3; do
  "$B/settle" --quiet "${bed[@]}" --target-fraction $x >"$T/out" 2>"$T/err"
  check "$x: exit status" test $? = 5
  check "$x: no bed" test ! -s "$T/out"
  check "$x: says what is" grep -Eq \
    "not reachable with this softness and box: 0\.[0-9]{3} to 0\.[0-9]{3}$" \
    "$T/err"
done
read -r a b < <(sed 's/.*box: \(.*\) to \(.*\)$/\1 \2/' "$T/err")
within 'from the loosest' "$a" "$(awk -v x="$least" 'BEGIN { print x - 0.04 }')" \
  "$(awk -v x="$least" 'BEGIN { print x + 0.04 }')"
within 'to the densest' "$b" "$(awk -v x="$most" 'BEGIN { print x - 0.04 }')" \
  "$(awk -v x="$most" 'BEGIN { print x + 0.04 }')"

# in other containers, measured as analyze does: images, and the square in a tube
while read -r -a walls; do
  most=$("$B/settle" --quiet --count 40 --time 1.5 "${walls[@]}" --friction 0 |
    fraction -)
  x=$(awk "BEGIN { printf \"%.3f\", $most - 0.02 }")
  "$B/settle" --quiet --count 40 --time 1.5 "${walls[@]}" --target-fraction "$x" \
    > "$T/bed" 2> "$T/err"
  check "${walls[*]}: found" test $? = 0
  within "${walls[*]}: the densest" \
    "$(sed -n 's/.* of \([0-9.]*\) without friction.*/\1/p' "$T/err")" \
    "$(awk "BEGIN { print $most - 0.0006 }")" "$(awk "BEGIN { print $most + 0.0006 }")"
  said=$(awk '/the bed fills/ { print $NF }' "$T/err")
  within "${walls[*]}: it says what it fills" "$(fraction "$T/bed")" \
    "$(awk -v s="$said" 'BEGIN { print s - 0.00006 }')" \
    "$(awk -v s="$said" 'BEGIN { print s + 0.00006 }')"
  said=
done << END
--cylinder 0.3,0.2,0,0,0,1,0.35
--periodic xy --base 0.6,0.62
--periodic x --base 0.6,0.5
--lid 9 --base 0.6,0.6
--wall 0,0,0,0,0,-1 --wall 0.1,0,0,-1,0,0 --wall 0.7,0,0,1,0,0 --wall 0,0.1,0,0,-1,0 --wall 0,0.7,0,0,1,0 --base 0.8,0.8
END

refuse() { # PATTERN OPTION...
  "$B/settle" --quiet "${@:2}" --target-fraction 0.6 >"$T/out" 2>"$T/err"
  check "${*:2}: exit status" test $? = 2
  check "${*:2}: one line" grep -Eq -e "$1" "$T/err"
}
refuse 'no --friction' --friction 0.3
refuse 'no --scene' --scene "$T/bed"
refuse 'needs a bottom cube' --wall 0,0,0,0,0,-1
refuse 'needs a bottom cube' --count 1 --cylinder 0.5,0.5,1,0,1,1,2
refuse 'another model than basic' --model basic
refuse 'no --step' --step 1e-4 --method verlet
check_done
