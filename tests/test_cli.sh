#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The programs as their users meet them: what they refuse and how they say so,
# what they promise about output, restarts and files. Run from the root of the
# repository; B is the directory of the programs.
. tests/harness.sh
unset DEM_ISA

run() { # PROGRAM ARGUMENT...: into $T/out, $T/err and $status
  local program=$1
  shift
  timeout 20 "$B/$program" "$@" >"$T/out" 2>"$T/err" </dev/null
  status=$?
}

one_line() { # PROGRAM PATTERN: all that was said is one line by it
  [[ $(wc -l <"$T/err") == 1 ]] && grep -q "^$1: ." "$T/err" &&
    grep -Eq -e "$2" "$T/err"
}

judge() { # NAME PROGRAM STATUS PATTERN, after a run
  if ! { [[ $status == "$3" ]] && one_line "$2" "$4" && [[ ! -s $T/out ]]; }
  then
    fail "$1: exit status $status, expected $3 and one line with '$4', and no \
output: $(head -n 5 "$T/out")"
  else
    pass
  fi
}

refuse() { # NAME STATUS PATTERN PROGRAM ARGUMENT...: and no result
  local name=$1 code=$2 pattern=$3 program=$4
  run "${@:4}"
  judge "$name" "$program" "$code" "$pattern"
}

succeed() { # NAME PROGRAM ARGUMENT...: quietly
  local name=$1
  run "${@:2}"
  check "$name: exit status $status" test "$status" = 0 -a ! -s "$T/err"
}

rows() { # of the last frame in a bed
  awk '/^[0-9+-]/ {if (new) {text = ""; new = 0} text = text $0 "\n"; next}
       {new = 1} END {printf "%s", text}' "$1"
}

near() { # A B TOLERANCE: the last frames' numbers; NaN is never near
  paste <(rows "$1") <(rows "$2") | awk -v tol="$3" -F '\t' '
    NF == 0 || NF % 2 {bad = 1}
    {n = NF / 2
     for (k = 1; k <= n; k++) {
       d = $k - $(k + n)
       if (!(d <= tol && -d <= tol) || $k ~ /nan|inf/) bad = 1}}
    END {exit bad || NR == 0}'
}

value() { # ROW COLUMN FILE: of the last frame, by the column's name
  awk -F '\t' -v row="$1" -v name="$2" '
    /^[a-z]/ {n = 0; for (k = 1; k <= NF; k++) if ($k == name) c = k}
    /^[0-9+-]/ {if (++n == row) x = $c} END {print x}' "$3"
}

key() { # NAME FILE
  sed -n "s/^# $1=//p" "$2"
}

is_close() { # GOT WANT TOLERANCE
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
    d = a - b
    exit !(a != "" && a !~ /nan|inf/ && d <= t && -d <= t)}'
}

bed() { # FILE HEADER ROWS END: a small bed; \n and \t are expanded
  printf '%b' "# format=bed-1\n# t=0\n$2id\tx\ty\tz\tr\n$3$4" >"$1"
}
ok='# status=ok\n'
floor='# wall=0 0 0 0 0 -1\n'

# --- beds for the cases below -------------------------------------------------
bed "$T/good" "$floor" '0\t0.5\t0.5\t0.5\t0.1\n' "$ok"
bed "$T/cut" "$floor" '0\t0.5\t0.5\t0.5\t0.1\n' ''
bed "$T/midcut" "$floor" '0\t0.5\t0.5\t0.5\t0.1\n1\t0.5\t0.' ''
bed "$T/negative" "$floor" '0\t0.5\t0.5\t0.5\t-0.1\n' "$ok"
bed "$T/nan" "$floor" '0\t0.5\tnan\t0.5\t0.1\n' "$ok"
bed "$T/text" "$floor" '0\t0.5\tx\t0.5\t0.1\n' "$ok"
bed "$T/short" "$floor" '0\t0.5\t0.5\n' "$ok"
bed "$T/norows" "$floor" '' "$ok"
bed "$T/failed" "$floor" '0\t0.5\t0.5\t0.5\t0.1\n' \
  '# status=failed at t=0: example\n'
bed "$T/outside" "$floor" '7\t0.5\t0.5\t-0.5\t0.1\n' "$ok"
bed "$T/late" '# t=1\n' '0\t0.5\t0.5\t0.5\t0.1\n' "$ok"
sed -i "/# t=0/d" "$T/late"
: >"$T/empty"
printf '# format=bed-1\nx\ty\tz\tcolour\n1\t2\t3\t4\n# status=ok\n' >"$T/column"
printf '# format=bed-2\nx\ty\tz\n1\t2\t3\n# status=ok\n' >"$T/format"
mkdir "$T/directory"

# --- files that are refused ---------------------------------------------------
for p in settle analyze; do
  option=
  [[ $p == settle ]] && option=--scene
  bad() { # NAME FILE LINE PATTERN
    refuse "$p: $1" 3 "$T/$2:$3: .*$4" $p $option "$T/$2"
  }
  bad 'negative radius' negative 5 'radius -0.1.*above 0'
  bad 'NaN in a file' nan 5 "column y.*'nan'.*expected"
  bad 'text in a file' text 5 "column y.*'x'.*expected"
  bad 'too few fields' short 5 'column z.*expected'
  bad 'unknown column' column 2 "'colour'.*expected"
  bad 'another format' format 1 'bed-2.*expected bed-1'
  bad 'empty file' empty 0 "status=ok"
  bad 'no spheres' norows 5 'no spheres'
  bad 'truncated bed' cut 5 'status=ok'
  bad 'truncated row' midcut 6 'cut'
  bad 'marked as failed' failed 6 'status=failed'
  refuse "$p: no such file" 1 "$T/none: No such file" $p $option "$T/none"
  refuse "$p: directory as file" 1 "$T/directory: .*irectory" \
    $p $option "$T/directory"
  timeout 20 "$B/$p" $option - <"$T/cut" >"$T/out" 2>"$T/err"
  status=$?
  judge "$p: truncated pipe" $p 3 'standard input:5: .*status=ok'
  partial() { # FILE LINE PATTERN: taken, and what it lacks is said
    run $p --allow-partial $option "$T/$1" ${option:+--time 0.1}
    check "$p --allow-partial: $1: exit status $status" test "$status" = 0 -a \
      "$(grep -c . "$T/err")" = 1 -a "$(grep -c "$T/$1:$2: $3" "$T/err")" = 1
  }
  partial failed 6 'the file is marked status=failed at t=0: example'
  partial cut 5 'cut short: 1 spheres of the last frame, t=0, were read'
  partial midcut 6 'cut short: 1 spheres of the last frame, t=0, were read'
done
# The centre that is outside is named, wherever it is in the file.
bed "$T/second" "$floor" '0\t0.5\t0.5\t0.5\t0.1\n7\t1\t2\t-3\t0.1\n' "$ok"
refuse 'a centre outside' 3 \
  "$T/second: sphere 7 at \(1, 2, -3\) has its centre outside wall 1" \
  settle --scene "$T/second"
# The file's method has the file's tolerance, one that is given has its own.
bed "$T/tolerance" "# method=merson\n# tol=1e-3\n$floor" \
  '0\t0.5\t0.5\t0.5\t0.1\n' "$ok"
run settle --scene "$T/tolerance" --time 0
check "the file's tolerance" grep -qx '# tol=0.001' "$T/out"
for method in merson rkc; do
  "$B/settle" --count 1 --time 0 --method $method >"$T/own"
  run settle --scene "$T/tolerance" --time 0 --method $method
  check "the tolerance of $method" cmp -s <(grep '^# tol=' "$T/own") \
    <(grep '^# tol=' "$T/out")
done
# A cut frame is no start: the last whole one is.
"$B/settle" --quiet --count 20 --base 0.4,0.4 --time 0.2 --frames 3 >"$T/frames"
whole=$(wc -c <"$T/frames") third=$(grep -n '^# t=0.2' "$T/frames" | cut -d: -f 1)
head -c $((whole - 1000)) "$T/frames" >"$T/third"
run settle --allow-partial --scene "$T/third" --time 0.1
check 'a cut frame: the start is the one before' test "$status" = 0 -a \
  "$(grep -c '^[0-9]' "$T/out")" = 20 -a \
  "$(grep -c 't=0.2 is left out.* of 20 spheres.*t=0.1$' "$T/err")" = 1
head -n $((third + 1 + 20)) "$T/frames" >"$T/third"
run settle --allow-partial --scene "$T/third" --time 0.2
check 'only its last line is missing: it is the start' test "$status" = 0 -a \
  "$(grep -c '^[0-9]' "$T/out")" = 20
head -n $(($(grep -n -m 1 '^id' "$T/frames" | cut -d: -f 1) + 5)) "$T/frames" \
  >"$T/third"
run settle --allow-partial --scene "$T/third"
check "no whole frame: exit status $status" test "$status" = 3 -a ! -s "$T/out" \
  -a "$(grep -c 'has 5 of 20 spheres.*expected a whole frame' "$T/err")" = 1
# Frames are there once they are written, not at the end of the run.
: >"$T/killed"
"$B/settle" --quiet --count 20 --base 0.4,0.4 --method verlet --step 1e-7 \
  --time 100 --frames 1000000 >"$T/killed" &
for ((k = 0; k < 500 && $(grep -c '^id' "$T/killed") < 5; k++)); do sleep 0.02; done
kill -s KILL $! && wait $! 2>/dev/null
check 'killed: the last frame is whole' test "$(wc -l <"$T/killed")" -gt 100 -a \
  $(($(grep -c '^[0-9]' "$T/killed") % 20)) = 0
# A full log is said at once and at the end, and the bed is there.
run settle --count 20 --base 0.4,0.4 --time 1 --log /dev/full
check 'a full log: status, what is wrong, the bed' test "$status" = 1 \
  -a "$(grep -c 'full: No space left.*goes on' "$T/err")" = 1 -a \
  "$(tail -n 1 "$T/err")" = 'settle: /dev/full: No space left on device' -a \
  "$(tail -n 1 "$T/out")" = '# status=ok'
refuse 'sphere outside a wall' 3 "$T/outside: sphere 7 .*wall 1" \
  settle --scene "$T/outside"
refuse 'sphere outside an option'"'"'s wall' 3 "$T/good: sphere 0 .*wall 1" \
  settle --scene "$T/good" --wall 0,0,1,0,0,-1
refuse 'end before the start' 2 '--time 0.5: .*t=1' \
  settle --scene "$T/late" --time 0.5

# --- keys of a file that are refused ------------------------------------------
for bad in restitution=2 restitution=x friction=-1 model=rubbish kappa=0 \
  gravity=nan 'gravity=1 2' 'wall=0 0 0 0 0 0' 'wall=0 0 0 0 0' radius=-1 \
  method=rubbish tol=0; do
  bed "$T/key" "# $bad\n" '0\t0.5\t0.5\t0.5\t0.1\n' "$ok"
  refuse "key $bad" 3 "$T/key:.*${bad%%=*}.*expected" settle --scene "$T/key"
done

# --- options that are refused -------------------------------------------------
refuse 'negative radius' 2 '--radius -1: expected' settle --radius -1
refuse 'no spheres' 2 '--count 0: expected' settle --count 0
refuse 'half a sphere' 2 '--count 1.5: expected' settle --count 1.5
refuse 'too many spheres' 2 '--count 1e30: expected' settle --count 1e30
refuse 'msbdf with 200 spheres' 2 'msbdf.*200.*expected' settle --method msbdf
refuse 'msbdf with fixed steps' 2 'msbdf' \
  settle --count 2 --method msbdf --step 0.001
for program in settle bounce; do
  refuse "$program: verlet without a step" 2 \
    '^'$program': --method verlet: expected a fixed --step \(try' \
    $program --method verlet
  refuse "$program: msbdf with fixed steps" 2 \
    '^'$program': --method msbdf: has no fixed step \(try' \
    $program --method msbdf --step 0.001
done

# A file is not written that is read, or written by another option, or standard
# output; pipes and devices are shared.
mkdir "$T/twice"
"$B/settle" --count 2 --time 0 >"$T/twice/bed"
cp "$T/twice/bed" "$T/twice/copy"
ln -s bed "$T/twice/link"
refuse 'scene and stats' 2 'twice/bed: expected another file' \
  settle --scene "$T/twice/bed" --time 0.1 --stats "$T/twice/bed"
refuse 'scene by a link, and log' 2 'twice/link: expected another file' \
  settle --scene "$T/twice/bed" --time 0.1 --log "$T/twice/link"
refuse 'one file twice, not there yet' 2 'twice/.*new: expected another file' \
  settle --count 2 --time 0.1 --stats "$T/twice/new" --log "$T/twice/./new"
check 'nothing was made' test "$(ls "$T/twice")" = $'bed\ncopy\nlink'
into() { # NAME FILE PROGRAM ARGUMENT...: with standard output into the file
  "$B/$3" "${@:4}" >"$2" 2>"$T/err"
  status=$?
  check "$1: $status" test $status = 2
  check "$1: one line" one_line "$3" 'expected another file'
}
into 'stats is standard output' "$T/twice/out" settle --count 2 --time 0.1 \
  --stats "$T/twice/out"
into 'bounce: stats is standard output' "$T/twice/out" bounce --time 0.1 \
  --stats "$T/twice/out"
into 'the scene is standard output' "$T/twice/copy" settle --time 0.1 \
  --scene "$T/twice/copy"
"$B/settle" --scene - --stats "$T/twice/bed" <"$T/twice/bed" 2>"$T/err"
check 'standard input and stats' test $? = 2
check 'the bed is as it was' grep -q '^# status=ok' "$T/twice/bed"
succeed 'two nulls' settle --count 2 --time 0.1 --stats /dev/null --log /dev/null
for program in settle bounce; do
  refuse "$program --stats -" 2 '^[a-z]*: -: expected .*/dev/stderr' \
    $program --time 0.1 --stats -
  "$B/$program" --time 0.1 --stats /dev/stderr >"$T/out" 2>"$T/err"
  check "$program --stats /dev/stderr: $?" \
    grep -q $'^rhs_evaluations\t[1-9]' "$T/err"
done

# --help tells the defaults in use: bounce has its own, settle leaves them to the
# method and the control.
help_says() { # PROGRAM OPTION DEFAULT
  "$B/$1" --help | sed -n "s/^  --$2 .*\\[\\(.*\\)\\]$/\\1/p" | grep -qxF -- "$3"
}
check 'bounce --help: control' help_says bounce control standard
check 'bounce --help: tol' help_says bounce tol 1e-10
check 'settle --help: control' help_says settle control \
  'paper; predictive for rkc; local for multirate'
check 'settle --help: tol' help_says settle tol \
  '0.1 for paper; 0.0005 for standard; 0.0005 for predictive; 0.002 for local'
for name in merson rkc verlet paper predictive basic rotation; do
  check "settle --help: $name" grep -Eq "^ +$name +[a-zA-Z]" <("$B/settle" --help)
done
refuse 'multirate with another control' 2 \
  '^settle: --method multirate: expected --control local ' \
  settle --method multirate --control paper
refuse 'its control with another method' 2 \
  '^settle: --control local: not for --method rkc ' settle --method rkc --control local
refuse 'multirate with a relative tolerance' 2 \
  '^settle: --method multirate: has no relative tolerance ' \
  settle --method multirate --reltol 1e-3
refuse 'multirate with a fixed step' 2 \
  '^settle: --method multirate: has no fixed step ' \
  settle --method multirate --step 1e-3
refuse 'multirate with all pairs' 2 \
  '^settle: --pairs all: not for --method multirate ' \
  settle --method multirate --pairs all
refuse 'bounce has no spheres to take apart' 2 '^bounce: --method multirate: ' \
  bounce --method multirate --control local
refuse 'two numbers for gravity' 2 '--gravity.*expected one.*three' \
  settle --gravity 1,2
refuse 'wall without a normal' 2 '--wall 0,0,0,0,0,0: expected' \
  settle --wall 0,0,0,0,0,0
refuse 'wall of five numbers' 2 '--wall 0,0,0,0,1: expected 6' \
  settle --wall 0,0,0,0,1
refuse 'wall that is not finite' 2 '--wall 0,0,nan,0,0,1: expected' \
  settle --wall 0,0,nan,0,0,1
refuse 'no base' 2 '--base' settle --base 0,0
refuse 'base too small' 2 '--base.*radius' settle --base 0.1,0.1
refuse 'an operand' 2 "'bed.tsv'.*expected" settle bed.tsv
refuse 'unknown model' 2 '--model rubbish: expected one of basic' \
  settle --model rubbish
refuse 'unknown pairs' 2 '--pairs rubbish: expected' settle --pairs rubbish
refuse 'too jittery' 2 '--jitter 1: expected' settle --jitter 1
refuse 'no frames' 2 '--frames 0: expected' settle --frames 0
refuse 'threads' 2 '--threads -1: expected' settle --threads -1
refuse 'friction' 2 '--friction -0.1: expected' settle --friction -0.1
refuse 'box of no volume' 2 '--box.*expected' analyze --box 0,1,0,1,1,1 \
  "$T/good"
refuse 'box inside out' 2 '--box.*expected' analyze --box 1,0,0,1,0,1 "$T/good"
refuse 'box of five' 2 '--box 0,1,0,1,0: expected 6' \
  analyze --box 0,1,0,1,0 "$T/good"
refuse 'box not a number' 2 '--box 0,1,0,1,0,x: expected' \
  analyze --box 0,1,0,1,0,x "$T/good"
refuse 'sampled' 2 '--sampled -1: expected' analyze --sampled -1 "$T/good"
refuse 'two files' 2 "'$T/a' after '$T/good': expected one file" \
  analyze radius "$T/good" "$T/a"
refuse 'no height' 2 '--height 0: expected' bounce --height 0
refuse 'no samples' 2 '--samples 0: expected' bounce --samples 0
for p in settle bounce; do
  refuse "$p: unknown method" 2 '--method rubbish: expected one of merson' \
    $p --method rubbish
  refuse "$p: unknown control" 2 '--control rubbish: expected one of' \
    $p --control rubbish
  for bad in 0 -1 x 1x '' nan inf -inf 1e999 0,1; do
    refuse "$p --tol '$bad'" 2 "--tol $bad: expected a number" $p --tol "$bad"
  done
  refuse "$p: restitution" 2 '--restitution 1.5: expected' \
    $p --restitution=1.5
  refuse "$p: kappa" 2 '--kappa 0: expected' $p --kappa 0
  refuse "$p: time" 2 '--time -1: expected' $p --time -1
  refuse "$p: endless" 2 '--time inf: expected' $p --time inf
done
for p in settle bounce analyze; do
  refuse "$p: unknown option" 2 '--rubbish' $p --rubbish
  refuse "$p: unknown letter" 2 "x" $p -x
  refuse "$p: a flag with a value" 2 "--help" $p --help=1
done
refuse 'option without value' 2 "--count.*argument" settle --count
refuse 'option without value' 2 "--tol.*argument" bounce --tol
refuse 'option without value' 2 "--box.*argument" analyze --box

# --- help and version ---------------------------------------------------------
lists() { # PROGRAM OPTION...
  local program=$1 option
  for option in "${@:2}"; do
    check "$program --help lists --$option" \
      grep -Eq -e "^  (-h, )?--$option " "$T/out"
  done
}
for p in settle bounce analyze; do
  succeed "$p --version" $p --version
  check "$p --version: one line" test "$(grep -c "^$p [0-9]" "$T/out")" = 1
  succeed "$p --help" $p --help
  check "$p --help: at least as an example" grep -q "^  $p \|| $p" "$T/out"
  lists $p help version
done
succeed 'help of bounce' bounce --help
lists bounce stats quiet
succeed 'help of settle' settle --help
lists settle scene count radius base drop jitter seed model restitution \
  friction gravity f0 kappa psi vmin lmax time wall method control tol abstol \
  reltol hinit hmax step travel frames stats log until-rest threads pairs \
  allow-partial quiet
check 'defaults in the help' test "$(grep -c -e '--count.*\[200\]' \
  -e '--gravity.*m/s^2.*\[9.81\]' -e '--hinit.*\[0.1\]' "$T/out")" = 3
succeed 'help of bounce' bounce --help
lists bounce height restitution kappa f0 psi gravity time samples method \
  control tol rebound
succeed 'help of analyze' analyze --help
lists analyze box sampled allow-partial

# --- output that cannot be written --------------------------------------------
"$B/settle" --count 8 --model basic --time 0.2 --frames 600 >"$T/frames" \
  2>"$T/err"
check 'many frames' test "$(grep -c '^# t=' "$T/frames")" = 600
full() { # NAME PROGRAM ARGUMENT...
  local name=$1 program=$2
  timeout 20 "$B/$program" "${@:3}" >/dev/full 2>"$T/err" </dev/null
  status=$?
  : >"$T/out"
  judge "$name > /dev/full" "$program" 1 'standard output: .*space'
}
full settle settle --count 4 --time 0.1
full 'settle, frames' settle --count 8 --time 0.1 --frames 500
full analyze analyze "$T/good"
full 'analyze, frames' analyze "$T/frames"
full bounce bounce --time 1 --samples 10
full 'bounce --rebound' bounce --rebound
full 'bounce, samples' bounce --time 1 --samples 20000
for p in settle bounce analyze; do
  full "$p --help" $p --help
  full "$p --version" $p --version
done
closed() { # NAME PROGRAM ARGUMENT...
  local name=$1 program=$2
  timeout 20 "$B/$program" "${@:3}" 2>"$T/err" | true
  status=${PIPESTATUS[0]}
  check "$name, closed pipe: quietly" test $status = 1 -a ! -s "$T/err"
}
closed settle settle --count 8 --model basic --time 0.2 --frames 2000
closed bounce bounce --time 1 --samples 20000
for k in 1 2 3 4; do
  grep -v '^# status' "$T/frames"
  printf '\n\n'
done >"$T/many"
echo '# status=ok' >>"$T/many"
closed analyze analyze "$T/many"
timeout 20 "$B/settle" --count 1 --time 0.1 >&- 2>"$T/err"
status=$?
: >"$T/out"
judge 'standard output closed' settle 1 'standard output'
timeout 20 "$B/settle" --count 1 --time 0.1 --log "$T/log" >&- 2>"$T/err"
check 'standard output closed: the bed is not in the log' \
  test $? = 1 -a ! -e "$T/log"

# --- files beside the output --------------------------------------------------
small=(--count 4 --model basic --time 0.1)
refuse 'no directory for --log' 1 "$T/none/x: No such" \
  settle "${small[@]}" --log "$T/none/x"
# before the run, not after hours of it: so there is no bed either
refuse 'no directory for --stats' 1 "$T/none/x: No such" \
  settle "${small[@]}" --stats "$T/none/x"
refuse 'a directory for --stats' 1 "$T/directory: .*irectory" \
  settle "${small[@]}" --stats "$T/directory"
for option in --log --stats; do
  run settle "${small[@]}" $option /dev/full
  check "$option /dev/full" test $status = 1
  check "$option /dev/full: one line" one_line settle '/dev/full: .*space'
done
# more than a buffer: the end of the file may be written though its middle was
# not
run settle --count 8 --time 0.6 --log /dev/full
check 'a long --log /dev/full' test $status = 1
files() { # EXPECTED...: all that is in a directory
  [[ "$(ls "$T/files" | tr '\n' ' ')" == "$*" ]]
}
mkdir "$T/files"
echo old >"$T/files/log"
echo old >"$T/files/stats"
both=(--log "$T/files/log" --stats "$T/files/stats")
unchanged() {
  [[ $(cat "$T/files/log" "$T/files/stats") == $'old\nold' ]]
}
refuse 'usage' 2 '--count' settle "${both[@]}" --count x
check 'a mistake changes no file' unchanged
refuse 'input' 3 'sphere' settle "${both[@]}" --scene "$T/outside"
check 'bad input changes no file' unchanged
timeout 20 "$B/settle" "${small[@]}" "${both[@]}" >/dev/full 2>"$T/err"
check 'a full disk: exit status' test $? = 1
check 'a full disk changes no file' unchanged
check 'a full disk leaves nothing half-written' files 'log stats '
rm "$T"/files/*
timeout 20 "$B/settle" --count 8 --time 0.2 --frames 3000 "${both[@]}" \
  2>"$T/err" | true
check 'a closed pipe leaves nothing half-written' files ''
rm -f "$T"/files/*
run settle "${small[@]}" --log "$T/files/log" --stats "$T/none/x"
check 'an unwritable --stats leaves nothing half-written' \
  test -z "$(ls "$T/files" | grep partial)"
rm -f "$T"/files/*
succeed 'log and stats' settle --count 8 --time 0.6 "${both[@]}"
check 'log and stats: nothing else' files 'log stats '

for k in method rhs_evaluations steps_accepted steps_rejected cpu_seconds \
  wall_seconds threads t_end pair_list_builds; do
  check "--stats: $k" test "$(cut -f 1 "$T/files/stats" | grep -cx $k)" = 1
done
check '--stats: two fields a line' awk -F '\t' \
  'NF != 2 || $2 == "" {bad = 1} END {exit bad || NR == 0}' "$T/files/stats"
stat() {
  awk -F '\t' -v k="$1" '$1 == k {print $2}' "$T/files/stats"
}
check '--stats: t_end' is_close "$(stat t_end)" 0.6 0
check '--log: columns' test "$(head -n 1 "$T/files/log")" = \
  $'t\th\tsteps\tevaluations\tkinetic\tpotential'
check '--log: a row for each step' test "$(tail -n +2 "$T/files/log" | wc -l)" \
  = "$(stat steps_accepted)"
# times add up: each is the one before and h, rounded
check '--log: rows' awk -F '\t' -v evaluations="$(stat rhs_evaluations)" '
  NR == 1 {next}
  {d = $1 - (t + $2)
   if (NF != 6 || $3 != NR - 1 || !($2 > 0) || !(d < 1e-12 && -d < 1e-12) ||
       $4 < last || !($5 >= 0) || $6 != $6 + 0) bad = 1
   t = $1; last = $4}
  END {exit bad || !(t >= 0.6) || last != evaluations}' "$T/files/log"

# --- what a scene's header says -------------------------------------------------
for option in 'count 3' 'base 1,1' 'drop 2' 'jitter 0' 'seed 9'; do
  # shellcheck disable=SC2086
  refuse "--$option beside --scene" 2 "--${option% *}: .*--scene" \
    settle --scene "$T/good" --time 1 --$option
done
says() { # KEY VALUE: the header of the last output; empty: it has no such key
  check "header: $1=$2" test "$(key "$1" "$T/out")" = "$2"
}
# a start of our own: what its file says of it stays, but for what is not so
"$B/settle" --count 5 --seed 9 --drop 2 --base 2,3 --jitter 0.1 --time 0 |
  unsealed | sed 's/^# count=5/# count=77/' >"$T/seeded"
succeed 'goes on' settle --scene "$T/seeded" --time 0.01
says count 5
says seed 9
says drop 2
says base 2,3
says jitter 0.1
says radius 0.1
# one that somebody else made
bed "$T/other" "${floor}" '0\t0\t0\t1\t0.0625\n1\t0\t0\t2\t0.125\n' "$ok"
succeed 'goes on' settle --scene "$T/other" --time 0.01
says count 2
says radius 0.09375
for absent in seed drop base jitter; do says $absent ''; done
refuse 'another radius' 2 '--radius 0.0625: sphere 1 .*0.125 m' \
  settle --scene "$T/other" --time 0.01 --radius 0.0625

# --- a run that fails ---------------------------------------------------------
rm -f "$T"/files/*
run settle --count 8 --drop 0.5 --time 3 --step 0.3 "${both[@]}"
check 'failed integration: exit status' test $status = 4
check 'failed integration: message' one_line settle '^settle: t=0.*: .*failed'
check 'failed integration: mark' test \
  "$(tail -n 1 "$T/out" | cut -c 1-15)" = '# status=failed'
check 'failed integration: nothing half-written' files 'log stats '
cp "$T/out" "$T/crashed"
refuse 'its bed, analysed' 3 "$T/crashed:[0-9]*: .*status=failed" \
  analyze "$T/crashed"
refuse 'its bed, as a start' 3 "$T/crashed:[0-9]*: .*status=failed" \
  settle --scene "$T/crashed"

# --- trajectories -------------------------------------------------------------
scene=(--count 8 --model basic)
for time in 0.35 0.4 0.6 1; do
  "$B/settle" "${scene[@]}" --time $time >"$T/one"
  for frames in 2 7 40; do
    "$B/settle" "${scene[@]}" --time $time --frames $frames >"$T/several"
    check "--time $time --frames $frames: as many frames" \
      test "$(grep -c '^# t=' "$T/several")" = $frames
    check "--time $time --frames $frames: the last is that of --frames 1" \
      cmp -s <(key t "$T/one"; rows "$T/one") \
      <(key t "$T/several" | tail -n 1; rows "$T/several")
  done
done
"$B/settle" "${scene[@]}" --time 0.1 >"$T/first"
"$B/settle" --scene "$T/first" --time 0.8 >"$T/one"
"$B/settle" --scene "$T/first" --time 0.8 --frames 7 >"$T/several"
check 'frames of a continued run' cmp -s \
  <(key t "$T/one"; rows "$T/one") \
  <(key t "$T/several" | tail -n 1; rows "$T/several")
check 'its first frame is the start' test \
  "$(key t "$T/several" | head -n 1)" = "$(key t "$T/first")"

for model in basic friction rotation; do
  settling=(--count 40 --base 0.6,0.6 --drop 0.2 --model $model --time 0.4)
  for threads in 1 2 3; do
    "$B/settle" "${settling[@]}" --frames 3 --threads $threads >"$T/$threads"
  done
  check "$model: two threads, the same bytes" cmp -s "$T/1" "$T/2"
  check "$model: three threads, the same bytes" cmp -s "$T/1" "$T/3"
  check "$model: a bed at all" test "$(rows "$T/1" | wc -l)" = 40
done

# The paper's control grants an error of delta a second, in m or m/s, any other
# one of tol for each step; half a second among frictionless spheres does not
# multiply it by much, so that is granted for the whole second.
for tol in '1e-3 --method merson' '1e-6 --method merson' 1e-3 1e-6; do
  "$B/settle" "${scene[@]}" --tol $tol --time 1 --stats "$T/files/stats" \
    >"$T/whole"
  "$B/settle" "${scene[@]}" --tol $tol --time 0.5 >"$T/half"
  "$B/settle" --scene "$T/half" --time 1 >"$T/rest"
  granted=${tol% --*}
  [[ $tol == *merson ]] ||
    granted=$(awk "BEGIN {print $tol * $(stat steps_accepted)}")
  check "--tol $tol: stopped, saved and continued" \
    near "$T/whole" "$T/rest" "$granted"
  check "--tol $tol: that went on" test "$(key t "$T/rest")" = 1
  check "--tol $tol: and moved" eval '! near "$T/half" "$T/rest" 0.01'
  check "--tol $tol: the same header" cmp -s \
    <(unsealed "$T/whole" | grep '^#') <(unsealed "$T/rest" | grep '^#')
done
"$B/settle" --scene - --time 1 <"$T/half" >"$T/piped"
check '--scene - reads a pipe' cmp -s "$T/rest" "$T/piped"
"$B/settle" "${scene[@]}" --tol 1e-6 --time 0.5 --frames 4 |
  "$B/settle" --scene - --time 1 >"$T/piped"
check 'the last frame is the start' cmp -s <(rows "$T/rest") \
  <(rows "$T/piped")
"$B/settle" "${scene[@]}" --tol 1e-6 --time 1 --pairs all >"$T/all"
check '--pairs all' near "$T/whole" "$T/all" 1e-6
"$B/settle" --scene "$T/half" --time 0.5 >"$T/still"
check 'no time to go: nothing changes' cmp -s "$T/half" "$T/still"

# Spheres listed in another order are the same bed. Only the first stays: large
# beds are sorted by place, in columns as wide as it reaches. So much friction
# makes the spins decide on the steps.
awk 'BEGIN {
  srand(1)
  print "# format=bed-1\n# wall=0 0 0 0 0 -1\nid\tx\ty\tz\tr\twx\twy\twz"
  for (i = 0; i < 1100; i++)
    printf "%d\t%.6f\t%.6f\t%.6f\t%g\t%.4f\t%.4f\t%.4f\n", i,
      0.19 * (i % 10) + 0.01 * rand(), 0.19 * (int(i / 10) % 11),
      0.1 + 0.19 * int(i / 110), i % 3 ? 0.1 : 0.03,
      60 * rand(), 60 * rand(), 60 * rand()
  print "# status=ok"}' >"$T/sorted"
{ head -n 4 "$T/sorted"
  sed -n '5,$p' "$T/sorted" | grep -v '^#' | awk '
    {row[NR] = $0}
    END {for (i = 0; i < NR; i++) print row[i * 467 % NR + 1]}'
  echo '# status=ok'
} >"$T/shuffled"
for control in '' '--method merson --control standard'; do
  for f in sorted shuffled; do
    "$B/settle" --scene "$T/$f" --time 0.002 $control --friction 5 >"$T/$f.bed"
  done
  check "spheres listed in another order $control" cmp -s \
    <(rows "$T/sorted.bed" | sort -n) <(rows "$T/shuffled.bed" | sort -n)
  check "1100 of them" test "$(rows "$T/shuffled.bed" | wc -l)" = 1100
done

# --- headers ------------------------------------------------------------------
mine='# author=A. Author\n# restitution=0.9\n# friction=0.7\n# kappa=90\n'
mine+='# model=friction\n# gravity=1,2,-3\n# tol=1e-4\n# lmax=0.1\n# note=a=b\n'
dropped='-3\t0.1\t0.2\t0.15\t0.1\n17\t0.4\t0.1\t0.12\t0.05\n'
bed "$T/mine" "$mine$floor" "$dropped" "$ok"
bed "$T/bare" "$floor" "$dropped" "$ok"
succeed 'a header' settle --scene "$T/mine" --time 0.3
cp "$T/out" "$T/a"
check 'unknown keys are passed on' test \
  "$(key author "$T/a")/$(key note "$T/a")" = 'A. Author/a=b'
check 'ids are kept' test "$(rows "$T/a" | cut -f 1 | tr '\n' ' ')" = '-3 17 '
check 'radii are kept' is_close "$(value 2 r "$T/a")" 0.05 0
for k in restitution=0.9 friction=0.7 kappa=90 model=friction gravity=1,2,-3; do
  check "the header's $k stays" test "$(key "${k%%=*}" "$T/a")" = "${k#*=}"
done
check 'one status' test "$(key status "$T/a")" = ok
check 'one time' is_close "$(key t "$T/a")" 0.3 0
options=(--restitution 0.9 --friction 0.7 --kappa 90 --model friction
  --gravity 1,2,-3 --tol 1e-4 --lmax 0.1)
"$B/settle" --scene "$T/bare" --time 0.3 "${options[@]}" >"$T/b"
check "a header's parameters are used" cmp -s <(rows "$T/a") <(rows "$T/b")
"$B/settle" --scene "$T/bare" --time 0.3 >"$T/b"
check 'and they matter' eval '! near "$T/a" "$T/b" 1e-3'
"$B/settle" --scene "$T/mine" --time 0.3 --restitution 0.2 --model=basic \
  >"$T/c"
check 'options override the header' test \
  "$(key restitution "$T/c")/$(key model "$T/c")" = 0.2/basic
"$B/settle" --scene "$T/bare" --time 0.3 "${options[@]}" --restitution 0.2 \
  --model basic >"$T/b"
check 'and are used' cmp -s <(rows "$T/c") <(rows "$T/b")

# --- walls and gravity --------------------------------------------------------
bed "$T/falling" '' '0\t0.5\t0.25\t100\t0.1\n' "$ok"
"$B/settle" --scene "$T/falling" --time 1.5 >"$T/a"
check 'no wall line, no wall' test -z "$(key wall "$T/a")"
# a polynomial that any method integrates up to rounding: of 1e-14 m at 100 m
# in each of some thousand steps
check 'free fall' is_close "$(value 1 z "$T/a")" \
  "$(awk 'BEGIN {printf "%.17g", 100 - 9.81 * 1.5 * 1.5 / 2}')" 1e-10
check 'free fall: velocity' is_close "$(value 1 vz "$T/a")" -14.715 1e-10
check 'straight down' test "$(value 1 x "$T/a")/$(value 1 y "$T/a")" = 0.5/0.25
"$B/settle" --scene "$T/falling" --time 1 --gravity 1,-2,0 >"$T/a"
check 'gravity has three components' is_close "$(value 1 x "$T/a")" 1 1e-10
check 'gravity has three components' is_close "$(value 1 y "$T/a")" -0.75 1e-10
check 'gravity has three components' is_close "$(value 1 z "$T/a")" 100 0

"$B/settle" --scene "$T/good" --time 1 >"$T/a"
check 'walls from the file' test "$(key wall "$T/a")" = '0 0 0 0 0 -1'
check 'walls from the file hold' is_close "$(value 1 z "$T/a")" 0.1 0.2
"$B/settle" --scene "$T/good" --time 1 --wall 0,0,-9,0,0,-2 >"$T/a"
check '--wall replaces them' test "$(key wall "$T/a")" = '0 0 -9 0 0 -1'
check 'the sphere falls through' is_close "$(value 1 z "$T/a")" -4.405 1e-9
"$B/settle" --count 1 --time 0.1 --wall 0,0,0,0,0,-1 --wall 5,0,0,1,0,0 \
  >"$T/a"
check '--wall replaces the box, twice' test "$(key wall "$T/a" | wc -l)" = 2
"$B/settle" --count 1 --time 0.1 >"$T/a"
check 'the box' test "$(key wall "$T/a" | wc -l)" = 5

# --- the usual method, and that of what it cannot do --------------------------
for options in '' '--step 1e-3' '--reltol 1e-3' '--pairs all' '--control standard'; do
  # shellcheck disable=SC2086 # several words
  run settle --count 1 --time 0 $options --stats "$T/files/stats"
  check "the method of '$options'" test "$(stat method)" = \
    "$([[ $options ]] && echo rkc || echo multirate)"
done

# --- until rest ---------------------------------------------------------------
succeed '--until-rest' settle --count 30 --base 0.5,0.5 --model basic \
  --time 30 --until-rest --stats "$T/files/stats"
check '--until-rest: before the end' eval \
  'is_close "$(stat t_end)" 7 1 && [[ $(key t "$T/out") == $(stat t_end) ]]'
check '--until-rest: at rest' is_close "$(value 1 vz "$T/out")" 0 0.01
check '--until-rest: a whole bed' test "$(key status "$T/out")" = ok
# for 5 s from where the run begins, not from 0
bed "$T/rests" "# model=basic\n$floor" '0\t0.5\t0.5\t0.0965\t0.1\n' "$ok"
sed -i 's/^# t=0/# t=7/' "$T/rests"
run settle --scene "$T/rests" --until-rest --time 100 --stats "$T/files/stats"
check '--until-rest: a later start' is_close "$(stat t_end)" 12.5 0.5
run settle --count 1 --time 0.2 --until-rest
check '--until-rest, not reached: exit status' test $status = 5
check '--until-rest, not reached: message' one_line settle \
  't=0.2: .*moved.*expected'
check '--until-rest, not reached: mark' test "$(key status "$T/out" |
  cut -c 1-5)" = limit
run settle --scene "$T/rests" --until-rest --time 9
check '--until-rest, not seen for so long' one_line settle \
  't=9: seen for 2 s, expected 5 s'
# down a slope of 0.15, below vmin: slowly, but for ever. In 5 sqrt(r/g)/0.1 it
# loses m g_x v_x of that, in shares of m g r.
bed "$T/slides" "# model=friction\n$floor" '0\t0.5\t0.5\t0.0965\t0.1\n' "$ok"
run settle --scene "$T/slides" --gravity 1.4715,0,-9.81 --until-rest --time 8
share=$(awk -v v="$(value 1 vx "$T/out")" 'BEGIN {g = sqrt(1.4715 ^ 2 + 9.81 ^ 2)
  print 100 * 5 * sqrt(9.81 / g) * v * 1.4715 / (g * 0.1)}')
check '--until-rest, it creeps' one_line settle \
  't=8: in .* s the bed lost .* % of the energy of its height, expected below 0.5 %'
check '--until-rest, what it lost' is_close \
  "$(sed -n 's/.* the bed lost \([^ ]*\) %.*/\1/p' "$T/err")" "$share" 0.06

# --- analyze and bounce, at all -----------------------------------------------
succeed 'analyze' analyze "$T/good"
ball=$(awk 'BEGIN {printf "%.17g", 4 * atan2(0, -1) / 3 * 0.001}')
check 'analyze: columns' test "$(head -n 1 "$T/out")" = $'t\tsum\tunion'
check 'analyze: a ball' is_close "$(tail -n 1 "$T/out" | cut -f 2)" "$ball" \
  1e-16
cp "$T/out" "$T/a"
succeed 'analyze fraction' analyze fraction "$T/good"
check 'fraction is the default verb' cmp -s "$T/a" "$T/out"
"$B/analyze" <"$T/good" >"$T/b"
"$B/analyze" - <"$T/good" >"$T/c"
check 'analyze reads a pipe' cmp -s "$T/a" "$T/b"
check 'analyze - reads a pipe' cmp -s "$T/a" "$T/c"
succeed 'analyze: a box' analyze --box 0,0.5,0,1,0,2 "$T/good"
# half a ball in a box of volume 1
check 'analyze: half a ball' is_close "$(tail -n 1 "$T/out" | cut -f 3)" \
  "$(awk -v b="$ball" 'BEGIN {printf "%.17g", b / 2}')" 1e-16
succeed 'analyze: frames' analyze "$T/frames"
check 'analyze: a row for each frame' test "$(wc -l <"$T/out")" = 601
check 'analyze: their times' cmp -s <(tail -n +2 "$T/out" | cut -f 1) \
  <(key t "$T/frames")
succeed 'bounce' bounce --samples 5 --time 1
check 'bounce: columns' grep -qx $'t\tz\tv\tenergy' "$T/out"
check 'bounce: rows' test "$(grep -c '^[0-9]' "$T/out")" = 5
succeed 'bounce --rebound' bounce --rebound
check 'bounce --rebound: columns' grep -qx \
  $'restitution\tkappa\tt_hard\tt_rebound\terror_percent\tz_peak' "$T/out"
run bounce --method verlet --step 3
check 'bounce --step, too long: exit status' test $status = 4
check 'bounce --step, too long: message' one_line bounce 'with this --step'
run bounce --rebound --time 1
check 'bounce --rebound, too short: exit status' test $status = 5
check 'bounce --rebound, too short: message' one_line bounce '--time'
succeed 'msbdf with a few spheres' settle --count 4 --time 0.05 --method msbdf

check_done
