#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Small scenes under valgrind (make valgrind): memory that is not ours, values that
# nobody has set, and memory that is lost.
. tests/harness.sh
clean() { # COMMAND...
  valgrind --quiet --error-exitcode=99 --leak-check=full \
    --errors-for-leak-kinds=definite "$@" >"$T/out" 2>"$T/err"
  local status=$?
  check "${*:1}: exit status $status" [ $status = 0 ]
}
small=(--quiet --count 6 --base 0.4,0.4 --drop 0.1)
for method in merson rk8pd rkc multirate; do
  clean "$B/settle" "${small[@]}" --method $method --time 0.1
done
clean "$B/settle" "${small[@]}" --method verlet --step 1e-4 --time 0.1
clean "$B/settle" --quiet --count 4 --method msbdf --model basic --time 0.1
for model in basic friction; do
  clean "$B/settle" "${small[@]}" --model $model --time 0.2
done
clean "$B/settle" "${small[@]}" --periodic xy --base 0.6,0.6 --sizes uniform:0.07,0.1 \
  --time 0.1
clean "$B/settle" "${small[@]}" --time 0.1 --frames 3 --output "$T/bed" \
  --checkpoint "$T/check" --every 0 --log "$T/log" --stats "$T/stats"
clean "$B/settle" --quiet --resume "$T/check"
for verb in fraction rest 'radius --report' radius gr order profile contacts mixture \
  'export --format csv' 'export --format raw --cells 4' \
  'export --format stl --merged --cells 8' 'export --format bed'; do
  # shellcheck disable=SC2086
  clean "$B/analyze" $verb "$T/bed"
done
clean "$B/bounce" --time 0.5 --samples 10
check_done
