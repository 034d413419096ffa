# shellcheck shell=bash disable=SC2034 # variables of the script that sources it
# SPDX-License-Identifier: GPL-3.0-or-later
# What tests of checkpoints share: runs of settle with output, log, statistics and
# checkpoint in $D. After harness.sh.

timeless() { # FILE: statistics but for what a stop changes
  grep -vE '^(cpu_seconds|wall_seconds|peak_memory_kb|threads|command)' "$1"
}

unbroken() { # ARGUMENT...: the run that others are compared with, in $T/whole
  mkdir -p "$T/whole"
  "$B/settle" --quiet "$@" --output "$T/whole/out" --log "$T/whole/log" \
    --stats "$T/whole/stats" 2>"$T/err"
  whole=$?
}

# Sets pid, of a program that takes all signals, whatever the caller ignores
begin() { # ARGUMENT...
  env --default-signal "$B/settle" --quiet --output "$D/out" --log "$D/log" \
    --stats "$D/stats" --checkpoint "$D/check" "$@" 2>"$T/err" &
  pid=$!
  before=
}

resume() { # ARGUMENT...
  before=$(stat -c %i "$D/check")
  env --default-signal "$B/settle" --quiet --resume "$D/check" "$@" \
    2>"$T/err" &
  pid=$!
}

end() { # its status
  wait "$pid" 2>/dev/null
  status=$?
}

# Until a run has made checkpoints, or has ended
wait_for_checkpoints() { # NUMBER: at least this number of new ones
  local seen=$before now made=0 k
  for ((k = 0; k < 2000 && made < $1; k++)); do
    kill -0 "$pid" 2>/dev/null || return 0
    now=$(stat -c %i "$D/check" 2>/dev/null)
    [[ $now == "$seen" ]] || made=$((made + 1))
    seen=$now
    sleep 0.01
  done
}
