#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# settle --sizes: the spheres that were asked for, equal ones with the bits that
# they have without it, lengths by 4^k and masses by 2^j, and what is refused.
. tests/harness.sh

run() { # FILE OPTION...
  "$B"/settle --quiet "${@:2}" > "$T/$1" 2> "$T/err"
  check "settle ${*:2}" test $? = 0
}
rows() { # FILE...: the spheres
  grep -h '^[0-9]' "$@"
}
radii() { # FILE
  rows "$1" | cut -f5
}
header() { # FILE KEY
  sed -n "s/^# $2=//p" "$1" | head -n 1
}

# Equal sizes are the plain bed.
run a --count 30 --time 0.7
run b --count 30 --time 0.7 --sizes uniform:0.1,0.1
check 'equal sizes' cmp -s <(rows "$T/a") <(rows "$T/b")
check 'no key for what was not asked' test -z "$(header "$T/a" sizes)$(header "$T/a" shares)"
check 'key sizes' test "$(header "$T/b" sizes)" = uniform:0.1,0.1

# A mix: counts, masses by density or by the mass of the mean radius.
run a --count 100 --sizes 'mix:0.1*0.3,0.025*0.7' --time 0 --density 1000
check 'thirty large' test "$(radii "$T/a" | grep -c '^0.1$')" = 30
within 'masses by density' "$(rows "$T/a" |
  awk '{ print $6 / ($5 ^ 3 * 4 / 3 * 3.14159265358979) }' | sort -g | sed -n '1p;$p' |
  awk '{ d += ($1 - 1000) ^ 2 } END { print d }')" 0 1e-6
run a --count 100 --sizes uniform:0.05,0.15 --time 0
within 'mass of the mean radius' "$(rows "$T/a" | awk -v r="$(header "$T/a" radius)" \
  '{ print $6 * (r / $5) ^ 3 }' | sort -g | tail -n 1)" 0.999999 1.000001
within 'mean radius' "$(header "$T/a" radius)" 0.0995 0.1005
check 'defaults follow the mean radius' awk -v r="$(header "$T/a" radius)" \
  -v l="$(header "$T/a" lmax)" 'BEGIN { exit !((r / l - 1) ^ 2 < 1e-20) }'

# On the way nothing is lost: from its own scene the bed goes on alike.
run b --scene "$T/a" --time 0.1
check 'a scene keeps the sizes' test "$(header "$T/b" sizes)" = uniform:0.05,0.15
check 'and the radii' cmp -s <(radii "$T/a") <(radii "$T/b")
run c --count 100 --sizes uniform:0.05,0.15 --time 0.1
check 'resumed as in one go' cmp -s <(rows "$T/b" | cut -f1,5,6) <(rows "$T/c" | cut -f1,5,6)

# The same bed on another scale, to the last bit: 4^-3 and 2^-2.
similar() { # OPTION...
  run a --count 40 --sizes 'mix:0.1*0.4,0.05*0.6' --kappa 300 --time 0.8 \
    --base 0.75,0.75 "$@"
  run b --count 40 --sizes 'mix:0.0015625*0.4,0.00078125*0.6' --kappa 19200 --time 0.1 \
    --mass 0.25 --base 0.01171875,0.01171875 "$@"
  paste <(rows "$T/a") <(rows "$T/b") | awk '{
      for (c = 2; c <= 12; c++) {
        unit = c <= 5 ? 0.015625 : c == 6 ? 0.25 : c <= 9 ? 0.125 : 8
        bad += $c * unit != $(c + 12) + 0
      }
    } END { exit !(NR == 40 && !bad) }'
  check "similar mixtures: $*" test $? = 0
}
for method in multirate rkc; do
  similar --method $method
  similar --method $method --lever contact --rolling 0.1
done
check 'lever and rolling are in the header' test \
  "$(header "$T/b" lever),$(header "$T/b" rolling)" = contact,0.1
run c --scene "$T/b" --time 0.11
check 'and stay there' test "$(header "$T/c" lever),$(header "$T/c" rolling)" = contact,0.1
run d --scene "$T/b" --time 0.11 --rolling 0 --lever paper
check 'and go' test -z "$(header "$T/d" rolling)"
check 'another law, another bed' test "$(rows "$T/c" | md5sum)" != "$(rows "$T/d" | md5sum)"

# Classes add up to the whole, across periodic sides too.
for sides in '' '--periodic xy'; do
  # shellcheck disable=SC2086 # words
  run a --count 60 --sizes 'mix:0.1*0.4,0.05*0.6' --kappa 600 --time 1 \
    --base 0.75,0.75 $sides
  "$B"/analyze "$T/a" > "$T/whole" 2> "$T/err"
  "$B"/analyze mixture "$T/a" > "$T/classes" 2> "$T/err"
  within "sum of the classes, sides '$sides'" "$(paste <(tail -n 1 "$T/whole") \
    <(awk 'NR > 1 { s += $7 } END { printf "%.17g\n", s }' "$T/classes") |
    awk '{ print $4 / $2 }')" 0.999999999 1.000000001
  "$B"/analyze mixture --profile 7 "$T/a" > "$T/slabs" 2> "$T/err"
  within "sum of the slabs, sides '$sides'" "$(paste <(tail -n 1 "$T/whole") \
    <(awk 'NR > 1 && NF { s += $4 / 7 } END { printf "%.17g\n", s }' "$T/slabs") |
    awk '{ print $4 / $2 }')" 0.999999999 1.000000001
done

# Sieves: diameters, in any order, with names or without; percent too.
printf '# sand\nmesh share\n0.4,0\n0.2 60\n0.1;40\n' > "$T/down.txt"
printf '0.1\t0.4\n0.2\t0.6\n0.4\t0\n' > "$T/up.txt"
run a --count 200 --sizes "sieve:$T/down.txt" --time 0
run b --count 200 --sizes "sieve:$T/up.txt" --time 0 --shares volume
check 'a sieve either way' cmp -s <(rows "$T/a") <(rows "$T/b")
within 'what stays on 0.2' "$(radii "$T/a" | awk '{ v += $1 ^ 3; large += $1 >= 0.1 ? $1 ^ 3 : 0 }
  END { print large / v }')" 0.57 0.63

refused() { # STATUS TEXT OPTION...: one line that has the text
  "$B"/settle --quiet "${@:3}" > /dev/null 2> "$T/err"
  check "${*:3}: status $1" test $? = "$1"
  check "${*:3}: says $2" grep -qF -- "$2" "$T/err"
  check "${*:3}: one line" test "$(wc -l < "$T/err")" = 1
}
refused 2 'expected uniform:R1,R2' --sizes round
refused 2 'expected normal:MEAN,SD' --sizes normal:0.1
refused 2 'expected lognormal:MEDIAN,SIGMA' --sizes lognormal:0.1,0.2,0.3
refused 2 'expected mix:R1*SHARE' --sizes mix:0.1
refused 2 'shares add up to 0.9, expected 1 or 100' --sizes 'mix:0.1*0.3,0.2*0.6'
refused 2 'expected shares of at least 0' --sizes 'mix:0.1*1.5,0.2*-0.5'
refused 2 'sizes without an end' --sizes normal:0.1,0.05
refused 2 'sizes without an end' --sizes lognormal:0.1,2
refused 2 'not one sphere of radius 0.5 fits' --sizes 'mix:0.1*0.5,0.5*0.5' --base 1,1
refused 2 '--sizes: makes a start' --sizes uniform:1,2 --scene "$T/b"
refused 2 '--shares: makes a start' --shares volume --scene "$T/b"
refused 2 '--shares: expected --sizes' --shares volume
refused 2 '--radius: expected no --sizes' --radius 1 --sizes uniform:1,2
refused 2 "a sieve's are by volume" --shares number --sizes "sieve:$T/up.txt"
refused 2 '--rolling: nothing turns' --rolling 0.1 --model friction
refused 2 '--lever: nothing turns' --lever contact --friction 0
refused 1 'no.txt' --sizes "sieve:$T/no.txt"
bad_sieve() { # TEXT CONTENTS
  printf "$2" > "$T/bad.txt"
  refused 3 "$1" --sizes "sieve:$T/bad.txt"
}
bad_sieve 'bad.txt:2: expected two numbers' '0.1 1\n0.2\n'
bad_sieve 'bad.txt:3: expected two numbers' 'mesh share\n0.1 1\n0.2 0 7\n'
bad_sieve 'bad.txt:1: mesh 0: sizes without an end' '0 0.5\n0.1 0.5\n0.2 0\n'
bad_sieve 'bad.txt:2: share -1' '0.1 2\n0.2 -1\n0.3 0\n'
bad_sieve 'bad.txt:3: mesh 0.15: expected meshes in order' '0.1 1\n0.2 0\n0.15 0\n'
bad_sieve 'bad.txt:2: mesh 0.1' '0.1 1\n0.1 0\n'
bad_sieve 'stays on the largest mesh 0.2: sizes without an end' '0.1 0.5\n0.2 0.5\n'
bad_sieve 'shares add up to 0.5' '0.1 0.5\n0.2 0\n'
bad_sieve 'expected at least two' '# nothing\n'
check_done
