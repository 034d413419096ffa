#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Whether two threads touch the same memory at once, by clang's thread sanitizer
# and its tool for OpenMP, archer (make threads). B has programs that are built so.
. tests/harness.sh
CC=${CC:-clang}
export TSAN_OPTIONS='ignore_noninstrumented_modules=1 exitcode=66'
OMP_TOOL_LIBRARIES=$($CC -print-file-name=libarcher.so)
export OMP_TOOL_LIBRARIES

# a sum that two threads share is found, so that silence means something
cat >"$T/race.c" <<'END'
int main(int argc, char **argv) {
  double sum = 0, each[2];
  (void)argv;
#pragma omp parallel for num_threads(2)
  for (int i = 0; i < 2; i++) {
    each[i] = i;
    if (argc > 1)
      sum += each[i];
  }
#pragma omp parallel for num_threads(2)
  for (int i = 0; i < 2; i++)
    each[1 - i] += sum;
  return each[0] > 9;
}
END
$CC -g -O1 -fopenmp -fsanitize=thread "$T/race.c" -o "$T/race" || exit 1
"$T/race" >"$T/out" 2>"$T/err"
check 'loops one after the other are no race' [ $? = 0 ]
"$T/race" race >"$T/out" 2>"$T/err"
check 'a shared sum is one' [ $? = 66 ]

# more contacts than a thread takes alone (contact_subset.c)
awk 'BEGIN { print "x\ty\tz\tr"; for (i = 0; i < 1728; i++)
  printf "%.3f\t%.3f\t%.3f\t0.1\n", 0.1 + 0.2 * (i % 12),
    0.1 + 0.2 * (int(i / 12) % 12), 0.1 + 0.2 * int(i / 144) }' >"$T/lattice"
two=(--quiet --scene "$T/lattice" --wall 0,0,0,0,0,-1 --time 0.01 --threads 2)
for method in merson rkc multirate; do
  for model in basic rotation; do
    "$B/settle" "${two[@]}" --method $method --model $model >"$T/bed" 2>"$T/err"
    check "$method, $model: no race" [ $? = 0 ]
  done
done
for verb in 'export --format raw --cells 24 --threads 2' \
  'export --format palabos --cells 16 --threads 2'; do
  # shellcheck disable=SC2086
  "$B/analyze" $verb "$T/bed" >"$T/out" 2>"$T/err"
  check "$verb: no race" [ $? = 0 ]
done
check_done
