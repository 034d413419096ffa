#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs that are killed and go on from their checkpoints: to the last bit as if they
# had not been stopped. tests/torture.sh is the long form.
[[ ! -w /dev/shm ]] || export TMPDIR="${TMPDIR:-/dev/shm}" # where fsync is fast
. tests/harness.sh
. tests/checkpoints.sh # resume may have arguments, or none
. tests/faults.sh

D=$T/d
mkdir "$D"

# --- killed at some instants, each method -------------------------------------
same_after_kills() { # NAME ARGUMENT...: killed three times
  local name=$1 k want
  shift
  unbroken "$@"
  want=$whole
  rm -f "${D:?}"/*
  begin "$@" --every 0.002
  for k in 1 2 3; do
    wait_for_checkpoints 2
    kill -s KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    status=$?
    if [[ -e $D/out ]]; then # it was done, or killed on its way out
      ((status == 137)) && want=137
      break
    fi
    head -c 300 "$D/check" | grep -a '^# t=' >>"$T/times"
    resume
  done
  end
  check "$name: exit status $status" test "$status" = "$want"
  check "$name: output" cmp -s "$T/whole/out" "$D/out"
  check "$name: log" cmp -s "$T/whole/log" "$D/log"
  check "$name: statistics" cmp -s <(timeless "$T/whole/stats") \
    <(timeless "$D/stats")
  check "$name: nothing else is left" test "$(ls "$D" | tr '\n' ' ')" = \
    'check check.old log out stats '
}
small=(--count 60 --base '0.5,0.5' --frames 6)
same_after_kills merson "${small[@]}" --method merson --model basic --time 1
same_after_kills dopri5 "${small[@]}" --method dopri5 --model friction \
  --time 0.7 --restitution 1
same_after_kills 'rk8pd, standard' "${small[@]}" --method rk8pd \
  --control standard --model basic --time 1
same_after_kills rkc "${small[@]}" --method rkc --time 1
same_after_kills 'rkc, all pairs' "${small[@]}" --pairs all --method rkc \
  --control standard --time 0.6
same_after_kills verlet "${small[@]}" --method verlet --step 1e-4 --time 0.8
same_after_kills multirate "${small[@]}" --method multirate --time 2
same_after_kills 'multirate, until rest' "${small[@]}" --until-rest --time 10 \
  --model basic
same_after_kills 'sizes in the order of space' --count 1100 --base 2,2 \
  --sizes uniform:0.07,0.1 --time 0.1 --frames 2
check 'they were in the middle' test "$(sort -u "$T/times" | wc -l)" -gt 8
# another number of threads
unbroken "${small[@]}" --time 1
rm -f "${D:?}"/*
begin "${small[@]}" --time 1 --every 0.002 --threads 2
wait_for_checkpoints 2
kill -s KILL $pid
wait $pid 2>/dev/null
resume --threads 1
end
check 'other threads: output' cmp -s "$T/whole/out" "$D/out"
# a scene that is gone by then, and the checkpoint before the last one
"$B/settle" --quiet --count 30 --base 0.4,0.4 --time 0.3 >"$T/scene"
unbroken --scene "$T/scene" --time 1
rm -f "${D:?}"/*
begin --scene "$T/scene" --time 1 --every 0.002
wait_for_checkpoints 2
kill -s KILL $pid
wait $pid 2>/dev/null
rm "$T/scene"
mv "$D/check.old" "$D/check"
resume
end
check 'from the one before: output' cmp -s "$T/whole/out" "$D/out"
resume # of a run that has ended
end
check "it has ended: exit status $status" test "$status" = 0
check 'it has ended: the same again' cmp -s "$T/whole/out" "$D/out"

# what has been said is not said again: a bed that begins half in a wall
"$B/settle" --quiet --count 8 --time 0 >"$T/start"
awk -F '\t' -v OFS='\t' '/^[0-9]/ && !done {$4 = 0.03; done = 1} {print}' \
  <(unsealed "$T/start") >"$T/scene"
rm -f "${D:?}"/*
begin --scene "$T/scene" --time 0.02 --kappa 40 --every 1e-9
end
check 'a deep overlap: said once' test "$(grep -c 'overlaps by 0.70' "$T/err")" = 1
mv "$D/check.old" "$D/check"
resume
end
check 'a deep overlap: not said again' test "$(grep -c 'overlaps by' "$T/err")" = 0

# --- killed behind each call of the system -------------------------------------
# also where there are no hard links, so that one checkpoint is all there is
if make_faults; then
  few=(--count 5 --base '0.4,0.4' --time 0.02 --frames 2)
  unbroken "${few[@]}"
  for links in '' FAULT_NO_LINKS=1; do
    kills=0 others=0
    for ((k = 1;; k++)); do
      rm -f "${D:?}"/* "$T/hit"
      env $links FAULT=killed:$k FAULT_DONE="$T/hit" LD_PRELOAD="$T/faults.so" \
        "$B/settle" --quiet --output "$D/out" --log "$D/log" \
        --checkpoint "$D/check" --every 0 "${few[@]}" 2>"$T/err" &
      pid=$!
      end
      [[ -e $T/hit ]] || break
      kills=$((kills + 1))
      if [[ -e $D/check ]]; then
        "$B/settle" --quiet --resume "$D/check" 2>"$T/err" &&
          cmp -s "$T/whole/out" "$D/out" && cmp -s "$T/whole/log" "$D/log"
      else
        [[ ! -e $D/check.old ]]
      fi || others=$((others + 1))
    done
    check "$links: $others of $kills kills lost something" test $others = 0 -a \
      $kills -gt 20
  done
fi

# --- signals ------------------------------------------------------------------
unbroken "${small[@]}" --time 1
for signal in INT TERM HUP XCPU; do
  rm -f "${D:?}"/*
  begin "${small[@]}" --time 1 --every 0.002
  wait_for_checkpoints 2
  kill -s $signal $pid
  end
  check "$signal: exit status $status" test "$status" = 5
  check "$signal: says how to go on" grep -q \
    "interrupted at t=.*--resume $D/check goes on" "$T/err"
  check "$signal: the state reached" test "$(tail -n 1 "$D/out" |
    grep -c 'status=interrupted')" = 1 -a \
    $(($(grep -c '^[0-9]' "$D/out") % 60)) = 0
  resume
  end
  check "$signal: goes on to the same bed" cmp -s "$T/whole/out" "$D/out"
  check "$signal: and log" cmp -s "$T/whole/log" "$D/log"
done
# Two at once: it ends at once, and what the checkpoint needs stays.
rm -f "${D:?}"/*
begin "${small[@]}" --time 1 --every 0.002
wait_for_checkpoints 2
kill -s STOP "$pid"
kill -s INT $pid
kill -s TERM $pid
kill -s CONT $pid
end
check "two signals: exit status $status" test "$status" -gt 128
resume
end
check 'two signals: goes on to the same bed' cmp -s "$T/whole/out" "$D/out"
# USR1 asks for progress
rm -f "${D:?}"/*
begin "${small[@]}" --time 1000 --every 1000
wait_for_checkpoints 1
for ((k = 0; k < 500; k++)); do
  kill -s USR1 $pid
  grep -q 'settle: t=.* %  h=.* evaluations' "$T/err" && break
  sleep 0.02
done
check 'USR1: a line of progress' grep -q 'settle: t=.* %  h=.* evaluations' \
  "$T/err"
check 'USR1: it goes on' kill -0 $pid
kill -s KILL $pid
wait $pid 2>/dev/null

# --- what does not fit --------------------------------------------------------
refused() { # NAME STATUS PATTERN ARGUMENT...
  timeout 20 "$B/settle" --quiet "${@:4}" >"$T/stdout" 2>"$T/err"
  status=$?
  check "$1: exit status $status" test "$status" = "$2"
  check "$1: one line with '$3'" one_line "$3"
}
one_line() { # PATTERN
  [[ $(wc -l <"$T/err") == 1 && ! -s $T/stdout ]] && grep -Eq -e "$1" "$T/err"
}
rm -rf "${D:?}"/* "$T/done"
begin "${small[@]}" --time 1 --every 0.002
wait_for_checkpoints 2
kill -s INT $pid
end
rm "$D/check.old"
cp -r "$D" "$T/done"
flip() { # FILE BYTE: its bits
  local byte
  byte=$(od -An -tu1 -j "$2" -N 1 "$1")
  printf '%b' "\\x$(printf %x $((255 - byte)))" |
    dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}
size=$(wc -c <"$D/check")
for at in 400 $((size / 3)) $((size / 2)) $((size - 5)) $((size - 1)); do
  cp "$T/done/check" "$T/bad"
  flip "$T/bad" $at
  refused "byte $at of $size is wrong" 3 'bad: is cut short or damaged' \
    --resume "$T/bad"
done
for length in 0 20 100 200 $((size / 2)) $((size - 1)); do
  head -c $length "$T/done/check" >"$T/bad"
  refused "cut to $length of $size" 3 'bad: (is|expected)' --resume "$T/bad"
done
(cat "$T/done/check"; echo) >"$T/bad"
refused 'a byte more' 3 'bad: is cut short or damaged' --resume "$T/bad"
altered() { # PATTERN: what sed changes
  LC_ALL=C sed "1,6$1" "$T/done/check" >"$T/bad"
}
altered 's/^# version=.*/# version=0.2.9/'
refused 'another version' 3 'bad: was made by version 0.2.9, this is' \
  --resume "$T/bad"
altered 's/^# build=/# build=another compiler, /'
refused 'another build' 3 'bad: was made by a build with another compiler' \
  --resume "$T/bad"
altered 's/checkpoint-1/checkpoint-9/'
refused 'another format' 3 'bad: is no checkpoint of this' --resume "$T/bad"
refused 'a bed' 3 'out: is no checkpoint of this' --resume "$D/out"
refused 'not there' 1 'none: No such file' --resume "$T/none"
refused 'options beside it' 2 '--seed: --resume goes on with the options' \
  --resume "$D/check" --seed 4
refused 'no output' 2 '--checkpoint: expected --output' --count 1 \
  --checkpoint "$D/c"
refused 'no checkpoint' 2 '--every: expected --checkpoint' --count 1 --every 3
refused 'a method without' 2 '--checkpoint: not for --method msbdf' --count 1 \
  --method msbdf --output "$D/o" --checkpoint "$D/c"
refused 'one file for two' 2 'out: expected another file' --count 1 \
  --output "$D/out" --checkpoint "$D/out"
mkfifo "$D/fifo"
cat "$D/fifo" >"$T/through" &
refused 'no regular file' 2 '--checkpoint: expected files for --output' \
  --count 1 --output "$D/fifo" --checkpoint "$D/c"
wait
# the output was changed, or is gone, meanwhile
sed -i 's/^0/7/' "$D/out"
refused 'the output is another' 3 \
  'out: expected to begin with the [0-9]+ bytes' --resume "$D/check"
rm "$D/out"
refused 'the output is gone' 3 'out: expected to begin with the [0-9]+ bytes' \
  --resume "$D/check"
check 'nothing is lost by that' cmp -s "$T/done/check" "$D/check"
# while the run is on
rm -f "${D:?}"/*
begin "${small[@]}" --time 1000 --every 1000
wait_for_checkpoints 1
refused 'is on' 2 'is being written by another run' --resume "$D/check"
kill -s KILL $pid
wait $pid 2>/dev/null
# another kernel, where the machine has several
if [[ $(uname -m) == x86_64 ]] && ! grep -qa 'kernel=x86_64 ' "$D/check"; then
  DEM_ISA=x86_64 refused 'another kernel' 3 \
    'check: was made with the kernel x86_64_v. on x86_64_v., this is x86_64 on' \
    --resume "$D/check"
fi

# a kernel that was asked for is asked for again
unbroken "${small[@]}" --time 1
kernel=$("$B/settle" --help | sed -n '/--kernel/{n;s/.*one of \([^ ]*\).*/\1/p}')
rm -f "${D:?}"/*
begin "${small[@]}" --time 1 --every 0.002 --kernel "${kernel:-native}"
wait_for_checkpoints 2
kill -s KILL $pid
wait $pid 2>/dev/null
resume
end
check "kernel $kernel: exit status $status" test "$status" = 0
check "kernel $kernel: that of the run" test \
  "$(sed -n 's/^kernel\t//p' "$D/stats")" = "${kernel:-native}"

# --- a checkpoint that cannot be written --------------------------------------
rm -f "${D:?}"/*
(ulimit -f 8; exec timeout 20 "$B/settle" --quiet "${small[@]}" --time 1 \
  --output "$D/out" --checkpoint "$D/check" 2>"$T/err")
status=$?
check "too large, the first: exit status $status" test "$status" = 1
check 'too large, the first: named' grep -q 'check: File too large' "$T/err"
check 'too large, the first: nothing is left' test "$(ls "$D")" = ''
mkdir "$D/in"
begin "${small[@]}" --time 1 --every 0.002 --checkpoint "$D/in/check"
for ((k = 0; k < 1000; k++)); do
  [[ -e $D/in/check.old ]] && break
  sleep 0.01
done
kill -s STOP "$pid"
mv "$D/in" "$D/away"
kill -s CONT $pid
end
check "a later one: exit status $status" test "$status" = 0
check 'a later one: named' grep -q \
  't=.*in/check: No such file.*the one before is still there' "$T/err"
check 'a later one: the bed is there' cmp -s "$T/whole/out" "$D/out"
check_done
