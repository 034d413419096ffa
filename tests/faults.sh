# shellcheck shell=bash disable=SC2034 # variables of the script that sources it
# SPDX-License-Identifier: GPL-3.0-or-later
# Memory that fails within a verb of analyze, for tests/test_limits.sh and
# tests/torture.sh, which source this after tests/harness.sh. A verb either ends well
# with the table that it has otherwise, or with exit status 1 and why.

# What lets calls fail into $T/faults.so; false, and said, where that cannot be built.
make_faults() {
  ! sanitized 'calls that fail' || return 1
  ${CC:-cc} -shared -fPIC -o "$T/faults.so" tests/faults.c -ldl 2>"$T/err" ||
    ! echo 'skipped: calls that fail, which need a compiler and a loader that preloads'
}

# VERB FILE FROM STEP: the FROM-th allocation fails, and each STEP-th after it, in
# runs of their own; counts them in tried and those that were wrong in wrong.
fail_memory() {
  local verb=$1 file=$2 k status
  # shellcheck disable=SC2086
  "$B/analyze" $verb "$file" >"$T/want" 2>"$T/err" || wrong=$((wrong + 1))
  for ((k = $3;; k += $4)); do
    rm -f "$T/hit"
    # shellcheck disable=SC2086
    timeout 60 env FAULT="malloc:$k" FAULT_DONE="$T/hit" \
      LD_PRELOAD="$T/faults.so" "$B/analyze" $verb "$file" >"$T/got" 2>"$T/err"
    status=$?
    [[ -e $T/hit ]] || return
    tried=$((tried + 1))
    case $status in
      0) cmp -s "$T/want" "$T/got" ;;
      1) grep -qiE 'out of memory|cannot allocate memory' "$T/err" ;;
      134) grep -qiE '^OMP: Error.*(memory|SHM)' "$T/err" ;; # clang's threads end so
      *) false ;;
    esac || {
      wrong=$((wrong + 1))
      echo "wrong: analyze $verb, allocation $k: exit status $status" >&2
    }
  done
}
