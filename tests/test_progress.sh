#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Long verbs say on a terminal how far they are, and end soon when nobody reads
# their rows any more. Run from the root of the repository; B is the directory of
# the programs.
. tests/harness.sh

# 8,000 spheres of a dense random bed, three frames of it, and a short one
awk 'BEGIN {srand(1); print "t,x,y,z,r"
  for (t = 0; t < 3; t++) for (i = 0; i < 8000; i++)
    printf "%d,%.6f,%.6f,%.6f,0.03\n", t, rand(), rand(), rand()}' >"$T/three.csv"
awk -F, '$1 == 0 || $1 == "t"' "$T/three.csv" >"$T/one.csv"

# --- closed pipes: the first row comes at once, and the rest is not computed ---
# Each of these takes minutes and more to its end.
for verb in 'profile --points 100000000' 'fraction --slab 0.000001'; do
  start=$SECONDS
  timeout 60 "$B/analyze" $verb "$T/three.csv" 2>"$T/err" | head -n 1 >"$T/out"
  status=${PIPESTATUS[0]}
  said="| head -1, $verb"
  check "status $status, $((SECONDS - start)) s" test $status = 1 -a \
    $((SECONDS - start)) -lt 20
  check "a row" test -s "$T/out"
  check "no message" test ! -s "$T/err"
done
# nobody there from the start, and no row before the end
for verb in 'fraction --sampled 1500' 'order --cutoff 10 --spheres' \
  'gr --bins 1000000'; do
  said="closed pipe, $verb"
  start=$SECONDS
  timeout 60 "$B/analyze" $verb "$T/one.csv" 2>"$T/err" | exec true
  status=${PIPESTATUS[0]}
  check "status $status, $((SECONDS - start)) s" test $status = 1 -a \
    $((SECONDS - start)) -lt 20
done
said=

# --- the line on a terminal ----------------------------------------------------
if ! command -v script >/dev/null; then
  echo 'skipped: progress on a terminal (script is not installed)'
  check_done
  exit
fi
# The line comes after half a second: on a fast machine too, for each command is
# held up for one second, in parts.
cat >"$T/slowly" <<'END'
#!/bin/bash
"$@" <&0 &
for _ in 1 2 3 4; do
  sleep 0.03
  kill -STOP $! 2>/dev/null || break
  sleep 0.25
  kill -CONT $!
done
wait $!
END
chmod +x "$T/slowly"
terminal_of() { # COMMAND: what it writes to a terminal as standard error
  script -qec "timeout 120 '$T/slowly' $* 2>&1 >'$T/rows'" /dev/null |
    tr '\r' '\n' >"$T/screen"
}
terminal() { # ARGUMENT...: of analyze
  terminal_of "'$B/analyze' $*"
}
shows() { # NAME PATTERN
  check "$1: shows '$2'" grep -Eq "$2" "$T/screen"
}
share='^analyze: +[0-9]+ %  '
for verb in 'profile --points 3000' 'fraction --sampled 500' 'gr --bins 3000' \
  'order --cutoff 3' 'radius --report'; do
  terminal "$verb '$T/one.csv'"
  shows "$verb" "$share.*frame 1  [0-9]+ s left"
  check "$verb: the line is gone" test "$(tail -n 1 "$T/screen")" = $'\e[K'
done
terminal "fraction --sampled 400 '$T/three.csv'"
shows 'frames of a file' "$share.*frame [23]  [0-9]+ s left"
terminal "profile --points 3000 <'$T/one.csv'"
shows 'a file as standard input' "$share.*frame 1  [0-9]+ s left"
script -qec "cat '$T/one.csv' | '$T/slowly' '$B/analyze' profile --points 3000 2>&1 \
  >'$T/rows'" /dev/null | tr '\r' '\n' >"$T/screen"
shows 'a pipe' "$share.*of frame 1  [0-9]+ s left"
terminal "export --format raw --cells 50 --output '$T/raw' '$T/one.csv'"
shows 'voxels' "$share.*layer [0-9]+ of 50  [0-9]+ s left"
terminal "profile --quiet --points 3000 '$T/one.csv'"
check '--quiet' test ! -s "$T/screen"
if command -v gnuplot >/dev/null; then
  terminal "draw --output '$T/x.png' '$T/one.csv'"
  shows 'draw' '^analyze: gnuplot draws  [0-9]+ s'
  terminal "movie --output '$T/x.gif' '$T/three.csv'"
  shows 'movie' "$share.*frame [23] of 3  [0-9]+ s left"
else
  echo 'skipped: draw and movie (gnuplot is not installed)'
fi
# settle and bounce have the same line
terminal_of "'$B/settle' --time 8"
shows 'settle' '^settle: +[0-9]+ %  t=[0-9.]+ s  h=.* [0-9]+ evaluations  [0-9]+ s left'
check 'settle: the line is gone' test "$(tail -n 1 "$T/screen")" = $'\e[K'
terminal_of "'$B/settle' --quiet --time 1"
check 'settle --quiet' test ! -s "$T/screen"
terminal_of "'$B/bounce' --tol 1e-13 --control standard --method rkf45 --time 3000"
shows 'bounce' '^bounce: +[0-9]+ %  t=[0-9.]+ s .* s left'
# rows on the same terminal: each on a line of its own
script -qec "timeout 120 '$T/slowly' '$B/analyze' profile --points 3000 '$T/one.csv'" \
  /dev/null | tr -d '\r' >"$T/screen"
"$B/analyze" profile --points 3000 "$T/one.csv" >"$T/rows"
shows 'rows on the terminal' 'frame 1  [0-9]+ s left'
check 'rows on the terminal: whole' cmp -s "$T/rows" \
  <(sed 's/^.*\x1b\[K//; s/analyze: .* left //' "$T/screen")

# a message takes the line's place
terminal "radius --keep fraction=0.5 '$T/one.csv'"
shows 'radius' "$share.*frame 1  [0-9]+ s left"
check 'a message has a line of its own' test \
  "$(grep -c $'^\e\\[Kanalyze: t=0: radius' "$T/screen")" = 1

check_done
