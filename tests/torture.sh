#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The long form of tests/test_checkpoint.sh: kills and signals at random instants,
# and each call of the system that can fail, in turn. What was lost, and what was
# wrong, as the rows of the table in docs/reliability.md.
#
#   tests/torture.sh [INSTANTS [SEED [ROW]]]
#
# INSTANTS is the number of each of seven ways to stop a run, in each row (of all of
# them together where there are threads); ROW is a pattern of bash for the rows that
# are wanted ('stopped*merson*').
[[ ! -w /dev/shm ]] || export TMPDIR="${TMPDIR:-/dev/shm}" # where fsync is fast
export OMP_WAIT_POLICY=passive # threads that wait leave the processors to others
. tests/harness.sh
. tests/checkpoints.sh # resume may have arguments, or none
. tests/faults.sh
instants=${1:-200}
RANDOM=${2:-1}
wanted=${3:-*}
D=$T/d
mkdir "$D"
lost=0 wrong=0 tried=0

row() { # NAME: a row of the table
  printf '| %s | %d | %d | %d |\n' "$1" $tried $lost $wrong
  check "$1: nothing is lost and nothing wrong" test $((lost + wrong)) = 0
  check "$1: something was tried" test $tried -gt 0
  lost=0 wrong=0 tried=0
}

# The row is not wanted
skips() { # NAME
  # shellcheck disable=SC2053 # a pattern
  [[ $1 != $wanted ]]
}

is_lost() { # WHY
  lost=$((lost + 1))
  echo "lost: settle ${run[*]}: $1: $(head -n 3 "$T/err")" >&2
}

is_wrong() { # WHY
  wrong=$((wrong + 1))
  echo "wrong: settle ${run[*]}: $1: $(head -n 3 "$T/err")" >&2
}

compare() { # the run that has ended with the one that was not stopped
  local file
  for file in out log; do
    cmp -s "$T/whole/$file" "$D/$file" || {
      is_wrong "$file is another"
      return
    }
  done
}

left() { # WHEN FILE...: nothing but these files is there, whatever their number
  local when=$1 file
  shift
  for file in "$D"/*; do
    [[ -e $file ]] || return # there is none
    file=${file##*/}
    [[ " $* " == *" ${file%-*([0-9])} "* ]] || {
      is_wrong "$when $file is there"
      return
    }
  done
}
shopt -s extglob

# --- instants ------------------------------------------------------------------
# A run that is ended again and again, and goes on each time, until each way to end
# it has been tried often enough. Since it goes on, the instants are all over it.
ways=(KILL INT TERM HUP XCPU two USR1)
declare -A counts
threads=1 # of which each start has any number at random

stop() { # WAY: of the process, which has ended if it was sooner done
  case $1 in
    USR1) # no end, but a line
      local k
      kill -s USR1 $pid 2>/dev/null || return
      for ((k = 0; k < 500; k++)); do
        ! grep -q 'settle: t=.* so far' "$T/err" || break
        kill -0 $pid 2>/dev/null || return # the step was its last one
        sleep 0.01
      done
      ((k < 500)) || is_wrong 'USR1: no line'
      return
      ;;
    two) # at once, or the second while it writes for the first one
      local first=$((RANDOM % 4 + 1)) second=$((RANDOM % 4 + 1))
      if ((RANDOM % 2)); then
        kill -s STOP $pid 2>/dev/null
        kill -s ${ways[first]} $pid 2>/dev/null
        kill -s ${ways[second]} $pid 2>/dev/null
        kill -s CONT $pid 2>/dev/null
      else
        kill -s ${ways[first]} $pid 2>/dev/null
        sleep "0.00$((RANDOM % 4))"
        kill -s ${ways[second]} $pid 2>/dev/null
      fi
      ;;
    *) kill -s "$1" $pid 2>/dev/null ;;
  esac
  end
}

stopped() { # WAY: what is there after the end by it
  local open='out.partial log.partial stats.partial'
  case $1:$status in
    KILL:137) return ;;
    two:5 | INT:5 | TERM:5 | HUP:5 | XCPU:5) # well, by the first of two
      grep -q 'interrupted at t=.* goes on' "$T/err" || is_wrong "$1: not said"
      tail -n 1 "$D/out" | grep -q 'status=interrupted' || is_wrong "$1: the bed"
      left "$1:" check check.old out log stats
      ;;
    # some may have their names by then
    two:*) left 'two signals:' check check.old out log stats $open ;;
    *) is_wrong "$1: exit status $status" ;;
  esac
}

ended() { # NAME ARGUMENT...
  local name=$1 way end=0 k
  local each=$((threads > 1 ? (instants + 6) / 7 : instants))
  local -A quarter=()
  ! skips "$name" || return
  shift
  run=("$@")
  unbroken "$@"
  micro "$(awk '$1 == "t_end" { print $2 }' "$T/whole/stats")"
  end=$now
  counts=()
  while choose_way; do
    rm -f "${D:?}"/*
    begin "$@" --every 0.00$((RANDOM % 9 + 1)) --threads $((RANDOM % threads + 1))
    while choose_way; do
      wait_for_progress
      kill -0 $pid 2>/dev/null || break # it had ended
      status=
      stop "$way"
      [[ $status != 0 ]] || break # so it had now
      counts[$way]=$((${counts[$way]:-0} + 1))
      tried=$((tried + 1))
      reached || {
        is_lost "$way: no checkpoint"
        break
      }
      k=$((now < end ? 4 * now / end : 3))
      quarter[$k]=$((${quarter[$k]:-0} + 1))
      [[ $way != USR1 ]] || {
        : >"$T/err"
        continue
      }
      stopped "$way"
      if [[ $way == KILL && -e $D/check.old ]] && ((RANDOM % 8 == 0)); then
        mv "$D/check.old" "$D/check" # from the one before
      fi
      resume --threads $((RANDOM % threads + 1))
    done
    [[ $status == 0 ]] || end
    if ((status != 0)); then
      is_lost "exit status $status"
    else
      compare
      left 'at its end' check check.old out log stats
    fi
  done
  echo "$name: $(for way in "${ways[@]}"; do echo -n "$way ${counts[$way]} "; done)"
  echo "$name: in the quarters of the run ${quarter[0]-0} ${quarter[1]-0}" \
    "${quarter[2]-0} ${quarter[3]-0}"
  for k in 0 1 2 3; do
    check "$name: some in quarter $k" test "${quarter[$k]:-0}" -ge $((each / 10))
  done
  row "$name"
}

choose_way() { # one that is due; false: none is
  local due=()
  for way in "${ways[@]}"; do
    ((${counts[$way]:-0} >= each)) || due+=("$way")
  done
  ((${#due[@]})) && way=${due[RANDOM % ${#due[@]}]}
}

micro() { # SECONDS: sets now to microseconds
  printf -v now '%.6f' "$1" && now=$((10#${now/./}))
}

reached() { # sets now to where the checkpoint is; false: there is none
  local line=
  # shellcheck disable=SC2034
  { read -r _ && read -r _ && read -r _ && read -r _ && read -r line; } \
    2>/dev/null <"$D/check"
  [[ $line == '# t='* ]] && micro "${line#*=}"
}

# Two checkpoints, so that there is some progress each time; then some time, by the
# clock or by the run, whose slow and fast parts both are met so.
wait_for_progress() {
  local k until seen=
  now=
  k=0
  while ((k < 3)) && kill -0 $pid 2>/dev/null; do
    sleep 0.002
    reached
    [[ $now == "$seen" ]] || k=$((k + 1))
    seen=$now
  done
  if ((RANDOM % 2)) && [[ -n $now ]]; then
    until=$((now + end / 10 * (RANDOM % 20) / 10))
    while ((now < until)) && kill -0 $pid 2>/dev/null; do
      sleep 0.002
      reached
    done
    sleep "0.00$((RANDOM % 10))"
  else
    sleep "0.0$((RANDOM % 4))$((RANDOM % 10))"
  fi
}

small=(--count 100 --base '0.7,0.7' --frames 9)
for model in basic friction rotation; do
  ended "stopped, $model, rkc" "${small[@]}" --model $model --method rkc --time 2
done
ended 'stopped, basic, merson' "${small[@]}" --model basic --method merson --time 2
ended 'stopped, rotation, verlet' "${small[@]}" --method verlet --step 1e-4 --time 2
ended 'stopped, rotation, multirate' "${small[@]}" --time 4
# more contacts than a thread takes alone (contact_subset.c)
awk 'BEGIN { print "x\ty\tz\tr"; for (i = 0; i < 2744; i++)
  printf "%.3f\t%.3f\t%.3f\t0.1\n", 0.1 + 0.2 * (i % 14),
    0.1 + 0.2 * (int(i / 14) % 14), 0.1 + 0.2 * int(i / 196) }' >"$T/lattice"
lattice=(--scene "$T/lattice" --wall '0,0,0,0,0,-1' --frames 5)
threads=2
ended 'stopped, rotation, rkc, 1 or 2 threads' "${lattice[@]}" --method rkc --time 0.3
ended 'stopped, basic, merson, 1 or 2 threads' "${lattice[@]}" --model basic \
  --method merson --time 0.5
ended 'stopped, rotation, verlet, 1 or 2 threads' "${lattice[@]}" --method verlet \
  --step 1e-4 --time 0.05
ended 'stopped, rotation, multirate, 1 or 2 threads' "${lattice[@]}" --time 0.3
threads=1

# --- calls that fail ------------------------------------------------------------
# Of a run that met a fault: it ended well, or says why and goes on where it was
survives() { # FAULT PATTERN: of what it says
  tried=$((tried + 1))
  if ((status == 137)) && [[ $1 == killed* ]]; then
    [[ -e $D/check || ! -e $D/check.old ]] || is_lost "$1: only the one before"
    [[ -e $D/check ]] || return
    "$B/settle" --quiet --resume "$D/check" 2>"$T/err" || {
      is_lost "$1"
      return
    }
  elif ((status != 0)); then
    if ((status != 1)) || ! grep -qie "$2" "$T/err"; then
      is_wrong "$1: exit status $status"
      return
    fi
    # before the first checkpoint there is nothing that could be lost
    if [[ ! -e $D/check ]]; then
      left "$1:"
      return
    fi
    left "$1:" check check.old out.partial log.partial out log
    "$B/settle" --quiet --resume "$D/check" 2>"$T/err" || {
      is_lost "$1"
      return
    }
  elif grep -q "$D/log: " "$T/err"; then
    cp "$T/whole/log" "$D/log" # it went on without one, and has said so
  fi
  left "$1, at its end:" check check.old out log
  compare
}

if make_faults; then
  # Each call in turn
  failing() { # NAME CALL PATTERN ARGUMENT...
    local name=$1 call=$2 pattern=$3 k
    ! skips "$name" || return
    shift 3
    run=("$@")
    unbroken "$@"
    for ((k = 1;; k++)); do
      rm -f "${D:?}"/* "$T/hit"
      timeout 60 env FAULT="$call:$k" FAULT_DONE="$T/hit" \
        LD_PRELOAD="$T/faults.so" "$B/settle" --quiet --output "$D/out" \
        --log "$D/log" --checkpoint "$D/check" --every 0 "$@" 2>"$T/err" &
      pid=$!
      end
      [[ -e $T/hit ]] || break
      survives "$call $k" "$pattern"
    done
    row "$name"
  }
  # a checkpoint at each of some 30 steps
  short=(--count 30 --base '0.4,0.4' --time 0.2 --frames 3 --method rkc)
  failing 'fsync fails' fsync 'Input/output error' "${short[@]}"
  failing 'rename fails' rename 'Input/output error' "${short[@]}"
  failing 'link fails' link 'Operation not permitted' "${short[@]}"
  failing 'close fails' close 'Input/output error' "${short[@]}"
  if [[ $(uname -sm) != 'Linux x86_64' ]]; then
    echo 'skipped: writes that fail, which need Linux on x86-64'
  else
    failing 'a write fails' write 'No space left' "${short[@]}"
    failing 'the disk is full from a write on' full 'No space left' "${short[@]}"
    failing 'half of a write' short 'none' "${short[@]}"
  fi
  short=(--count 30 --base '0.4,0.4' --time 0.1 --frames 3)
  failing 'KILL behind each call' killed '' "${short[@]}"
  export FAULT_NO_LINKS=1
  failing 'KILL behind each call, no hard links' killed '' "${short[@]}"
  unset FAULT_NO_LINKS
  failing 'malloc fails, rkc' malloc 'out of memory\|Cannot allocate memory' \
    "${short[@]}" --method rkc
  failing 'malloc fails, multirate' malloc 'out of memory\|Cannot allocate memory' \
    "${short[@]}"
  # The same when a run goes on that was killed, and one that was interrupted
  resuming() { # NAME CALL PATTERN: each call in turn
    local name=$1 call=$2 pattern=$3 k way
    ! skips "$name" || return
    for way in killed asked; do
      rm -f "${D:?}"/*
      env FAULT=$way:130 LD_PRELOAD="$T/faults.so" "$B/settle" --quiet \
        --output "$D/out" --log "$D/log" --checkpoint "$D/check" --every 0 \
        "${run[@]}" 2>"$T/err" &
      pid=$!
      end
      rm -f "$D/check.partial" # that KILL has left
      check "$name: $way in time" test $status != 0 -a -e "$D/check"
      rm -rf "${T:?}/left"
      cp -a "$D" "$T/left"
      for ((k = 1;; k++)); do
        rm -f "${D:?}"/* "$T/hit"
        cp -a "$T/left"/* "$D"
        timeout 60 env FAULT="$call:$k" FAULT_DONE="$T/hit" \
          LD_PRELOAD="$T/faults.so" "$B/settle" --quiet --resume "$D/check" \
          2>"$T/err" &
        pid=$!
        end
        [[ -e $T/hit ]] || break
        survives "$call $k" "$pattern"
      done
    done
    row "$name"
  }
  run=("${short[@]}")
  unbroken "${run[@]}"
  resuming 'fsync fails, --resume' fsync 'Input/output error'
  resuming 'rename fails, --resume' rename 'Input/output error'
  resuming 'close fails, --resume' close 'Input/output error'
  if [[ $(uname -sm) == 'Linux x86_64' ]]; then
    resuming 'the disk is full from a write on, --resume' full 'No space left'
  fi
  resuming 'malloc fails, --resume' malloc 'out of memory\|Cannot allocate memory'
  if ! skips 'malloc fails, analyze'; then
    "$B/settle" --quiet --count 12 --base 0.4,0.4 --time 1.5 --frames 2 >"$T/bed"
    for verb in fraction rest 'radius --report' radius gr order profile contacts \
      mixture 'contacts --network' 'order --spheres' 'export --format csv' \
      'export --format raw --cells 4' 'export --format stl --merged --cells 6'; do
      fail_memory "$verb" "$T/bed" 1 1
    done
    row 'malloc fails, analyze'
  fi
fi

# --- files that may not grow: short writes and a full disk -------------------------
if ! command -v prlimit >/dev/null; then
  echo 'skipped: files that may not grow, which need prlimit (util-linux)'
elif ! skips 'a file may not grow'; then
  short=(--count 30 --base '0.4,0.4' --time 0.5 --frames 9)
  run=("${short[@]}")
  unbroken "${short[@]}"
  for ((size = 1000; size < 60000; size += 100 + RANDOM % 400)); do
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
