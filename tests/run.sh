#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs test programs and scripts, JOBS=2 at a time, and prints of each a line
# with its checks, its sites (places in the source that check something: one
# place in a loop checks often) and its time; before that its output, if
# something failed. What failed is named again at the end, as "test: what". The
# last line is "N passed, N failed" for all. A program that ends without its own
# such line, or with an exit status of its own, counts as one more failure.
set -u

run_one() { # TEST: its line, "PASSED FAILED SITES" into a file of $RUN_RESULTS
  local name start=$SECONDS output status last p=0 f=1 sites=0
  name=$(basename "$1")
  output=$("$1" 2>&1 </dev/null)
  status=$?
  last=$(tail -n 1 <<<"$output")
  if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    p=${BASH_REMATCH[1]} f=${BASH_REMATCH[2]}
    if ((status != 0 && f == 0)) || ((p + f == 0)); then
      f=$((f + 1))
    fi
  fi
  last=$(tail -n 2 <<<"$output" | head -n 1)
  [[ $last =~ ^([0-9]+)\ sites$ ]] && sites=${BASH_REMATCH[1]}
  echo "$p $f $sites" >"$RUN_RESULTS/$name"
  if ((f > 0)); then # what failed
    grep -aE '^failed|^[^ ]+: failed: ' <<<"$output" || echo "exit status $status"
  fi | sed "s/^failed: *//; s/: failed: /: /; s/^/failed in $name: /" >"$RUN_RESULTS/$name.failed"
  # in one write, so that the lines of two tests do not mix
  ((f == 0)) || printf '%s\n%s: exit status %d\n' "$output" "$name" "$status"
  grep '^skipped' <<<"$output" | sed "s/^/$name: /"
  printf '%-24s %6d passed, %d failed, %4d sites, %d s\n' "$name" "$p" "$f" \
    "$sites" $((SECONDS - start))
}

if [[ ${1-} == --one ]]; then
  run_one "$2"
  exit
fi
RUN_RESULTS=$(mktemp -d) || exit 1
# Two tests share the cores: threads that wait must not spin.
export RUN_RESULTS OMP_WAIT_POLICY=passive
trap 'rm -rf "$RUN_RESULTS"' EXIT
shopt -s nullglob
printf '%s\0' "$@" | xargs -0 -n 1 -P "${JOBS:-2}" "$0" --one
cat /dev/null "$RUN_RESULTS"/*.failed
rm -f "$RUN_RESULTS"/*.failed
# a test that took the runner with it has left no file
cat "$RUN_RESULTS"/* /dev/null | awk -v tests=$# '
  {passed += $1; failed += $2; sites += $3}
  END {
    failed += tests - NR
    printf "%d tests with %d sites\n", tests, sites
    printf "%d passed, %d failed\n", passed, failed
    exit !(failed == 0 && passed > 0)}'
