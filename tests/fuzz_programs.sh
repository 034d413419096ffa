#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Random options and damaged checkpoints for the programs in B (make fuzz), for
# SECONDS in all. draw and movie, which start gnuplot, are left out.
#
#   tests/fuzz_programs.sh FUZZER SECONDS [SEED]
set -eu
B=$(realpath "${B:-build}") fuzzer=$(realpath "$1") seconds=$2 seed=${3:-1}
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT
cd "$T"
mkdir options checkpoint
"$B/settle" --quiet --count 8 --base 0.4,0.4 --time 0.5 --frames 2 >bed
(cd checkpoint && "$B/settle" --quiet --count 8 --base 0.4,0.4 --time 0.5 \
  --output bed --log log --checkpoint whole)
read -ra verbs <<<"$("$B/analyze" --complete | grep -vE '^(-|draw|movie)' | tr '\n' ' ')"
share=$((seconds / (${#verbs[@]} + 5) + 1)) bad=0
cd options
"$fuzzer" options "$B/settle" ../bed $((3 * share)) "$seed" || bad=1
for verb in "${verbs[@]}"; do
  "$fuzzer" options "$B/analyze" ../bed $share "$seed" "$verb" || bad=1
done
cd ../checkpoint
"$fuzzer" checkpoint "$B/settle" whole $((2 * share)) "$seed" || bad=1
exit $bad
