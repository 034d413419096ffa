#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs test programs and scripts, prints the output of each and, last, one line
# "N passed, N failed" for all. A program that ends without its own such line,
# or with an exit status of its own, counts as one more failure.
set -u
passed=0 failed=0
for test in "$@"; do
  name=$(basename "$test")
  start=$SECONDS
  output=$("$test" 2>&1)
  status=$?
  last=$(tail -n 1 <<<"$output")
  if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    p=${BASH_REMATCH[1]} f=${BASH_REMATCH[2]}
    if ((status != 0 && f == 0)) || ((p + f == 0)); then
      f=$((f + 1))
    fi
  else
    p=0 f=1
  fi
  if ((f)); then
    printf '%s\n' "$output"
    echo "$name: exit status $status"
  fi
  printf '%-24s %5d passed, %d failed, %d s\n' "$name" "$p" "$f" \
    $((SECONDS - start))
  passed=$((passed + p)) failed=$((failed + f))
done
echo "$passed passed, $failed failed"
((failed == 0 && passed > 0))
