#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The long form of tests/test_checkpoint.sh: kills and signals at random instants,
# and each call of the system that can fail, in turn. What was lost, and what was
# wrong, as the rows of the table in docs/reliability.md.
#
#   tests/torture.sh [INSTANTS [SEED]]
[[ ! -w /dev/shm ]] || export TMPDIR="${TMPDIR:-/dev/shm}" # where fsync is fast
. tests/harness.sh
. tests/checkpoints.sh # resume may have arguments, or none
. tests/faults.sh
instants=${1:-200}
RANDOM=${2:-1}
D=$T/d
mkdir "$D"
lost=0 wrong=0 tried=0

row() { # NAME: a row of the table
  printf '| %s | %d | %d | %d |\n' "$1" $tried $lost $wrong
  check "$1: nothing is lost and nothing wrong" test $((lost + wrong)) = 0
  lost=0 wrong=0 tried=0
}

compare() { # the run that has ended with the one that was not stopped
  local file
  for file in out log; do
    cmp -s "$T/whole/$file" "$D/$file" || {
      wrong=$((wrong + 1))
      echo "wrong: $file of settle ${run[*]}" >&2
      return
    }
  done
}

# --- instants ------------------------------------------------------------------
# A run that is ended again and again, and goes on each time
ended() { # NAME SIGNALS ARGUMENT...: as often as there are instants
  local name=$1 signals
  read -ra signals <<<"$2"
  shift 2
  run=("$@")
  unbroken "$@"
  while ((tried < instants)); do
    rm -f "${D:?}"/*
    begin "$@" --every 0.01
    while :; do
      wait_for_checkpoints 2 # so that there is some progress each time
      sleep "0.$((RANDOM % 40 + 10))"
      if ! kill -s "${signals[RANDOM % ${#signals[@]}]}" $pid 2>/dev/null; then
        break # it had ended
      fi
      end
      ((status == 0)) && break
      tried=$((tried + 1))
      [[ -s $D/check ]] || {
        lost=$((lost + 1))
        break
      }
      resume
    done
    end
    ((status == 0)) || {
      lost=$((lost + 1))
      cat "$T/err" >&2
    }
    compare
  done
  row "$name"
}
small=(--count 100 --base '0.7,0.7' --frames 9)
for model in basic friction rotation; do
  ended "KILL, $model, rkc" KILL "${small[@]}" --model $model --method rkc --time 2
done
ended 'KILL, rotation, multirate' KILL "${small[@]}" --time 4
ended 'KILL, basic, merson' KILL "${small[@]}" --model basic --method merson --time 2
ended 'KILL, rotation, verlet' KILL "${small[@]}" --method verlet --step 1e-4 --time 1
ended 'KILL, two threads, multirate' KILL "${small[@]}" --time 4 --threads 2
ended 'INT, TERM, HUP, XCPU, multirate' 'INT TERM HUP XCPU' "${small[@]}" --time 4

# Of a run that met a fault: it ended well, or says why and goes on where it was
survives() { # FAULT PATTERN: of what it says
  tried=$((tried + 1))
  if ((status != 0)); then
    if ((status != 1)) || ! grep -q -e "$2" "$T/err"; then
      wrong=$((wrong + 1))
      echo "$1: exit status $status" >&2
      return
    fi
    # before the first checkpoint there is nothing that could be lost
    [[ -e $D/check ]] || return
    "$B/settle" --quiet --resume "$D/check" 2>"$T/err" || {
      lost=$((lost + 1))
      echo "$1: $(cat "$T/err")" >&2
      return
    }
  fi
  compare
}

# --- calls that fail ------------------------------------------------------------
if make_faults; then
  # Each call in turn
  failing() { # CALL MOST EVERY ARGUMENT...
    local call=$1 most=$2 every=$3 k
    shift 3
    run=("$@")
    unbroken "$@"
    for ((k = 1; k <= most; k++)); do
      rm -f "${D:?}"/* "$T/hit"
      timeout 60 env FAULT="$call:$k" FAULT_DONE="$T/hit" \
        LD_PRELOAD="$T/faults.so" "$B/settle" --quiet --output "$D/out" \
        --log "$D/log" --checkpoint "$D/check" --every "$every" "$@" 2>"$T/err"
      status=$?
      [[ -e $T/hit ]] || break
      survives "$call $k" ''
    done
    row "$call fails"
  }
  short=(--count 30 --base '0.4,0.4' --time 0.2 --frames 3 --method rkc)
  failing fsync 60 0.001 "${short[@]}"
  failing rename 60 0.001 "${short[@]}"
  failing link 60 0.001 "${short[@]}"
  failing close 60 0.001 "${short[@]}"
  failing malloc 2000 1000 "${short[@]}"
  failing malloc 2000 1000 --count 30 --base 0.4,0.4 --time 0.1
  "$B/settle" --quiet --count 12 --base 0.4,0.4 --time 1.5 --frames 2 >"$T/bed"
  for verb in fraction rest 'radius --report' radius gr order profile contacts mixture \
    'contacts --network' 'order --spheres' 'export --format csv' \
    'export --format raw --cells 4' 'export --format stl --merged --cells 6'; do
    fail_memory "$verb" "$T/bed" 1 1
  done
  row 'malloc fails, analyze'
fi

# --- files that may not grow: short writes and a full disk -------------------------
if ! command -v prlimit >/dev/null; then
  echo 'skipped: files that may not grow, which need prlimit (util-linux)'
else
  short=(--count 30 --base '0.4,0.4' --time 0.5 --frames 9)
  run=("${short[@]}")
  unbroken "${short[@]}"
  for ((size = 1000; size < 60000; size += 500 + RANDOM % 500)); do
    rm -f "${D:?}"/*
    prlimit --fsize=$size timeout 60 "$B/settle" --quiet --output "$D/out" \
      --log "$D/log" --checkpoint "$D/check" --every 0.001 "${short[@]}" \
      2>"$T/err"
    status=$?
    survives "size $size" 'File too large'
  done
  row 'a file may not grow'
fi
check_done
