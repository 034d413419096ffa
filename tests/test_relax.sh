#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# settle: a start whose spheres overlap is pushed apart and said so, and does not
# fly apart then; beds of its own stay as they are. The pushing is tested in
# tests/test_relax.c.
. tests/harness.sh

rows() { # of the first frame
  awk -F '\t' '/^id/ { on = 1; next } /^$/ { if (on) exit } /^#/ { next } on' "$1"
}
settle() { # OPTION...: into T/bed, messages into T/err
  "$B/settle" --quiet "$@" > "$T/bed" 2> "$T/err"
}
said() { # WORDS: the only line on standard error
  check "'$1' in '$(cat "$T/err")'" grep -q -- "$1" "$T/err"
  check "one line: $(cat "$T/err")" [ "$(wc -l < "$T/err")" = 1 ]
}
silent() { # NAME
  check "$1: silent, but: $(cat "$T/err")" [ ! -s "$T/err" ]
}
relaxed() { # contacts by the header
  sed -n 's/^# relaxed=//p' "$T/bed"
}
most() { # kinetic energy by the log (J)
  awk 'NR > 1 && $5 > most { most = $5 } END { print most + 0 }' "$T/log"
}
box='# wall=0 0 0 0 0 -1\n# wall=0 0 0 -1 0 0\n# wall=1 0 0 1 0 0
# wall=0 0 0 0 -1 0\n# wall=0 1 0 0 1 0\n# base=1,1\n'
crowded() { # N SEED: spheres at random places in the lower half of the box
  awk -v n="$1" -v seed="$2" -v box="$box" 'BEGIN { srand(seed)
    printf "# format=bed-1\n%s", box
    print "# t=0\nid\tx\ty\tz\tr"
    for (i = 0; i < n; i++)
      print i "\t" rand() "\t" rand() "\t" rand() / 2 "\t0.1"
    print "# status=ok" }'
}

# two spheres, and two in one place
for d in 0.02 0; do
  printf '# format=bed-1\n# t=0\nid\tx\ty\tz\tr\n4\t0.5\t0.5\t0.5\t0.1\n5\t0.5\t0.5\t%s\t0.1\n# status=ok\n' \
    "$(awk "BEGIN { print 0.5 + $d }")" > "$T/pair.bed"
  settle --scene "$T/pair.bed" --time 0.05 --gravity 0 --log "$T/log"
  check "a pair $d m apart" [ $? -eq 0 ]
  said 'pair.bed: 1 contacts between spheres and 0 with walls are too deep'
  check 'in the header' [ "$(relaxed)" = 1 ]
  within 'they part slowly' "$(most)" 0.1 1 # of m g r = 0.98 J, and losses
done
printf 'x\ty\tz\tr\n0.5\t0.5\t0.02\t0.1\n' > "$T/half.tsv"
settle --scene "$T/half.tsv" --wall 0,0,0,0,0,-1 --time 0.3 --log "$T/log"
said '0 contacts between spheres and 1 with walls .* by up to 0.08 m (sphere 0)'
within 'a sphere half in the floor' "$(most)" 0 1

# a crowd, and a bed that was settled softer: no more energy in all of it than
# a sphere that falls by some diameters has, and then it is a bed
crowded 150 3 > "$T/crowd.bed"
settle --scene "$T/crowd.bed" --time 5 --log "$T/log"
said 'crowd.bed: [0-9]* contacts between spheres .* denser than one that falls'
within 'a crowd is let go' "$(most)" 0 4
within 'a crowd settles' "$("$B/analyze" --box 0,1,0,1,0,0.6 "$T/bed" |
  awk 'END { print $3 }')" 0.6 0.75
"$B/analyze" contacts "$T/bed" > "$T/tsv"
within 'the floor carries it' "$(awk 'NR == 1 { for (k = 1; k <= NF; k++)
  at[$k] = k } NR == 2 { print $at["floor"] }' "$T/tsv")" 0.9 1.1
"$B/settle" --quiet --count 60 --base 0.6,0.6 --time 2 > "$T/soft.bed"
settle --scene "$T/soft.bed" --kappa 1500 --time 3 --log "$T/log"
said 'soft.bed: [0-9]* contacts between spheres'
within 'a soft bed that is made hard' "$(most)" 0 4
cp "$T/bed" "$T/hard.bed"

# such a bed goes on, and may be below others
settle --scene "$T/hard.bed" --time 3.1
silent 'a bed that was pushed apart is a scene'
check 'its header goes on' [ "$(relaxed)" -gt 10 ]
settle --onto "$T/crowd.bed" --count 20 --time 0.5 --log "$T/log"
said 'crowd.bed: [0-9]* contacts between spheres'
check 'new spheres are there' [ "$(rows "$T/bed" | wc -l)" = 170 ]

# beds of its own go on to the last bit, however deep their contacts are
# this one fell from 4 m, 0.003 s ago
"$B/settle" --quiet --count 1 --drop 4 --jitter 0 --time 0.914 > "$T/falling.bed"
settle --scene "$T/falling.bed" --time 0.914
silent 'a sphere that fell'
check 'it stays' cmp -s <(rows "$T/falling.bed") <(rows "$T/bed")
unsealed "$T/falling.bed" | sed 's/^# program=settle/# program=other/' > "$T/other.bed"
settle --scene "$T/other.bed" --time 0.914
said 'other.bed: 0 contacts between spheres and 1 with'

# no room
awk 'BEGIN { print "x\ty\tz\tr"; for (i = 0; i < 30; i++)
  print rand() / 4 "\t" rand() / 4 "\t" rand() / 4 "\t0.1" }' > "$T/full.tsv"
refused 3 'expected room for all spheres' "$B/settle" --scene "$T/full.tsv" \
  --wall 0,0,0,-1,0,0 --wall 0.26,0,0,1,0,0 --wall 0,0,0,0,-1,0 \
  --wall 0,0.26,0,0,1,0 --wall 0,0,0,0,0,-1 --wall 0,0,0.26,0,0,1
check_done
