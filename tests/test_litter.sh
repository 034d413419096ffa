#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Programs that are ended leave nothing half-written and nothing running, and end
# as signals have it.
. tests/harness.sh
. tests/faults.sh

export TMPDIR=$T/scratch
D=$T/d
mkdir "$D" "$TMPDIR"
"$B/settle" --quiet --count 20 --base 0.4,0.4 --time 0.2 --frames 3 >"$T/bed"

waits() { # CONDITION...: until it holds, for ten seconds
  local k
  for ((k = 0; k < 500; k++)); do
    "$@" && return
    sleep 0.02
  done
  return 1
}
there() {
  compgen -G "$1" >/dev/null
}
gone() {
  ! there "$1"
}
number() {
  kill -l "$1"
}

# A run of hours, with files beside it
begin() { # ARGUMENT...: settle, in the background, until it has its log
  # bash has its background ignore INT and QUIT: env sets them right again
  env --default-signal "$B/settle" --quiet --count 200 --method merson \
    --time 1000 --log "$D/log" --stats "$D/stats" >"$T/out" 2>"$T/err" &
  pid=$!
  check "$1: it has begun" waits there "$D/log.partial-*"
}
end() { # its status
  wait $pid 2>/dev/null
  status=$?
}
# What ends it at once
for signal in QUIT ABRT; do
  begin $signal
  kill -s $signal $pid
  end
  check "$signal: the status is $status" test $status = $((128 + $(number $signal)))
  check "$signal: nothing is left" test -z "$(ls "$D")"
done
# What lets it end its step: all that it has is written
for signal in HUP INT TERM XCPU; do
  begin $signal
  waits test -s "$T/out" # not before it is ready to wait
  sleep 0.2
  kill -s $signal $pid
  end
  check "$signal: the status is $status" test $status = 5
  # how far it came decides whether it has found what limits its steps
  check "$signal: one line" test \
    "$(grep -vc '^settle: stability, not the tolerance' "$T/err")" = 1 -a \
    "$(grep -c '^settle: interrupted at t=' "$T/err")" = 1
  check "$signal: log and stats" test "$(ls "$D" | tr '\n' ' ')" = 'log stats '
  check "$signal: the bed is marked" grep -q '^# status=interrupted at t=' "$T/out"
  check "$signal: with the state reached" test \
    "$(grep '^# t=' "$T/out" | tail -n 1)" = \
    "# t=$(tail -n 1 "$D/log" | cut -f 1)"
  check "$signal: of all spheres" test "$(grep -c '^[0-9]' "$T/out")" = 200
  check "$signal: refused as it is" eval \
    '! "$B/settle" --quiet --scene "$T/out" --time 1000 >"$T/next" 2>&1'
  rm "$D"/*
done
t=$(sed -n 's/^# t=//p' "$T/out" | tail -n 1)
"$B/settle" --quiet --allow-partial --scene "$T/out" --time "$t" >"$T/next" \
  2>"$T/said"
check 'it goes on from there' cmp -s <(grep '^[0-9]' "$T/out") \
  <(grep '^[0-9]' "$T/next")
# The second signal does not wait; while it is stopped, both come.
begin twice
sleep 0.2
kill -s STOP $pid
kill -s INT $pid
kill -s TERM $pid
kill -s CONT $pid
end
check "a second signal: the status is $status" test $status = 130 -o \
  $status = 143
check 'a second signal: nothing is left' test -z "$(ls "$D")"
# At the moment at which a file or folder is made
made() { # LEAST COMMAND...: each of its files in turn
  local least=$1 k
  shift
  for ((k = 1;; k++)); do
    rm -f "$T/hit"
    timeout 60 env --default-signal FAULT=made:$k FAULT_DONE="$T/hit" \
      LD_PRELOAD="$T/faults.so" "$@" >"$T/out" 2>"$T/err" &
    pid=$!
    end
    [[ -e $T/hit ]] || break
    check "file $k of $*: the status is $status" test $status = 131
    check "file $k of $*: nothing is left" test -z "$(ls "$D")$(ls "$TMPDIR")"
  done
  check "$least files of $*" test $k -gt "$least"
  rm -rf "${D:?}"/*
}
if make_faults; then
  made 4 "$B/settle" --quiet --count 2 --time 0.01 --output "$D/out" \
    --log "$D/log" --stats "$D/stats" --checkpoint "$D/check" --every 1000
  made 5 "$B/analyze" export --format openfoam --output "$D/case" "$T/bed"
  made 2 "$B/analyze" draw --output "$D/x.png" "$T/bed"
fi
# as nohup starts it
env --default-signal --ignore-signal=HUP "$B/settle" --quiet --count 200 \
  --method merson --time 1000 --log "$D/log" >"$T/out" 2>"$T/err" &
pid=$!
check 'nohup: it has begun' waits there "$D/log.partial-*"
kill -s HUP $pid
sleep 0.2
check 'nohup: it goes on' kill -0 $pid
kill -s QUIT $pid
end
check 'nohup: nothing is left' test -z "$(ls "$D")"

# A picture that takes a while: its program goes too
mkdir "$T/bin"
printf '#!/bin/sh\necho $$ >"%s/pid"\nexec sleep 60\n' "$T" >"$T/bin/gnuplot"
chmod +x "$T/bin/gnuplot"
for signal in INT TERM; do
  for verb in "draw --output $D/x.png" "movie --output $D/x.gif"; do
    rm -f "$T/pid"
    start=$SECONDS
    # shellcheck disable=SC2086 # several words
    PATH=$T/bin:$PATH env --default-signal "$B/analyze" $verb "$T/bed" \
      >"$T/out" 2>"$T/err" &
    pid=$!
    check "$verb, $signal: gnuplot runs" waits test -s "$T/pid"
    kill -s $signal $pid
    wait $pid 2>/dev/null
    status=$?
    check "$verb, $signal: the status is $status" test $status = \
      $((128 + $(number $signal)))
    check "$verb, $signal: gnuplot is ended" \
      waits eval '! kill -0 "$(cat "$T/pid")" 2>/dev/null'
    check "$verb, $signal: soon" test $((SECONDS - start)) -lt 40
    check "$verb, $signal: nothing is left" test -z "$(ls "$D")$(ls "$TMPDIR")"
  done
done
# and its program's own end is an error as before
printf '#!/bin/sh\nkill -TERM $$\n' >"$T/bin/gnuplot"
PATH=$T/bin:$PATH "$B/analyze" draw --output "$D/x.png" "$T/bed" 2>"$T/err"
status=$?
check 'gnuplot ended by a signal' test $status = 1 -a \
  "$(grep -c 'gnuplot: ended by signal 15' "$T/err")" = 1
check 'nothing is left' test -z "$(ls "$D")$(ls "$TMPDIR")"

# A reader that goes away: the end comes at once, not after all is computed.
quiet_end() { # NAME PROGRAM ARGUMENT...
  local start=$SECONDS
  timeout 30 "$B/$2" "${@:3}" 2>"$T/err" | head -n 1 >"$T/out"
  status=${PIPESTATUS[0]}
  check "$1 | head -n 1: status $status" test "$status" = 1
  check "$1 | head -n 1: without a word" test ! -s "$T/err"
  check "$1 | head -n 1: soon" test $((SECONDS - start)) -lt 10
  check "$1 | head -n 1: the line" test -s "$T/out"
}
quiet_end bounce bounce --samples 1000000000
quiet_end profile analyze profile --points 1000000 "$T/bed"
quiet_end settle settle --quiet --count 8 --method merson --time 1000 \
  --frames 1000000 --log "$D/log"
check 'nothing is left' test -z "$(ls "$D")"
# the same where the caller has pipes' signals ignored
(trap '' PIPE; failed=0; quiet_end 'ignored' bounce --samples 1000000000
  check_done >"$T/sum")
check 'ignored signals: as well' grep -q ' 0 failed' "$T/sum"
# Another pipe than standard output is an error that is named, and the bed is
# not lost.
mkfifo "$D/fifo"
: <"$D/fifo" & # opened, and closed at once
timeout 60 "$B/settle" --quiet --count 8 --method merson --time 10 \
  --log "$D/fifo" >"$T/out" 2>"$T/err"
status=$?
check "a pipe beside it breaks: status $status" test $status = 1
check 'a pipe beside it breaks: named' grep -q 'fifo: Broken pipe' "$T/err"
check 'a pipe beside it breaks: the bed is there' grep -q '^# status=ok' "$T/out"
rm "$D/fifo"

# A file that grows too large is an error of its write, by name.
limited() { # NAME PATTERN PROGRAM ARGUMENT...
  (ulimit -f 8; exec timeout 30 "$B/$3" "${@:4}" >"$D/out" 2>"$T/err")
  status=$?
  check "$1, too large: status $status" test $status = 1
  check "$1, too large: named" grep -Eq "$2: File too large" "$T/err"
  rm -f "$D/out"
  check "$1, too large: nothing is left" test -z "$(ls "$D")"
}
limited bounce 'standard output' bounce --samples 5000
limited settle 'standard output' settle --quiet --count 20 --time 0.1 --frames 50
limited 'settle --log' log settle --quiet --count 2 --method merson --time 4 --log "$D/log"
limited profile 'standard output' analyze profile --points 2000 "$T/bed"
limited 'export --output' 'x.csv' analyze export --format csv --output "$D/x.csv" \
  "$T/bed"
check_done
