# SPDX-License-Identifier: GPL-3.0-or-later
# Functions that the test scripts share. A script sources this file first, from
# the root of the repository. B is the directory of the programs, T a scratch
# one. A script ends with check_done, or, with CHECK_FIRST in the environment, when
# something fails.
set -u
export LC_ALL=C.UTF-8 # what gnuplot needs for its labels
export OMP_WAIT_POLICY=passive # threads that wait leave a busy machine to others
B=${B:-build}
T=$(mktemp -d) || exit 1
trap 'rm -rf "$T"' EXIT
passed=0 failed=0
declare -A sites=() # lines of the script, or of its parts, that checked something
said= # what a check is of, if that is not in its name

site() { # of the script that called, however many functions there are between
  local i=1
  while [[ ${FUNCNAME[i]} != main && ${FUNCNAME[i]} != source ]]; do
    i=$((i + 1))
  done
  sites[${BASH_SOURCE[i]}:${BASH_LINENO[i - 1]}]=1
}

pass() {
  site
  passed=$((passed + 1))
}

fail() { # NAME; what the last program said, if it is in $T/err, comes after it
  site
  failed=$((failed + 1))
  echo "failed: ${said:+$said: }$1" >&2
  [[ ! -s $T/err ]] || head -n 5 "$T/err" >&2
  [[ ! -v CHECK_FIRST ]] || exit 1
  return 1
}

check() { # NAME CONDITION...: the condition is a command
  if "${@:2}"; then
    pass
  else
    fail "$1"
  fi
}

within() { # NAME VALUE LOW HIGH: a number, and in that range
  check "$1 is '$2', expected $3 to $4" awk -v x="$2" -v a="$3" -v b="$4" \
    'BEGIN { exit !(x ~ /^[+-]?[0-9][0-9.e+-]*$/ && x + 0 >= a && x + 0 <= b) }'
}

refused() { # STATUS WORDS COMMAND...
  # these words on standard error, and no output; scripts may have another
  "${@:3}" > "$T/out" 2> "$T/err"
  local status=$?
  check "status $status for $1: ${*:3}" [ "$status" -eq "$1" ]
  check "no '$2' in '$(head -n 1 "$T/err")': ${*:3}" grep -qF -- "$2" "$T/err"
  check "output without a bed: ${*:3}" [ ! -s "$T/out" ]
}

unsealed() { # FILE...: a bed without its checksums, to be changed
  grep -v '^# checksum=' "$@"
}

sanitized() { # whether the address sanitizer is in: it needs all addresses there are
  nm "$B/analyze" 2>/dev/null | grep -q __asan_init &&
    echo "skipped under the address sanitizer: $1"
}
if sanitized 'the time that things may take, ten times as much is granted'; then
  timeout() {
    command timeout $(($1 * 10)) "${@:2}"
  }
fi

check_done() { # the last line, and the exit status of the script
  echo "${#sites[@]} sites"
  echo "$passed passed, $failed failed"
  ((failed == 0))
}
