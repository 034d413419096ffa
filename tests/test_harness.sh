#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tests' own tools: what run.sh adds up, what counts as failed, how sites
# are counted. Small tests of known results are written for it.
. tests/harness.sh

test_of() { # NAME LINE...: a test script of these lines
  printf '%s\n' '#!/bin/bash' "${@:2}" >"$T/$1"
  chmod +x "$T/$1"
}
run() { # TEST...: into $T/out and $status
  (cd "$T" && env -u JOBS "$OLDPWD/tests/run.sh" "${@/#/./}") >"$T/out" 2>&1
  status=$?
}
ends() { # LINE, and the exit status
  [[ $(tail -n 1 "$T/out") == "$1" && $status == "$2" ]]
}

test_of good 'echo "2 sites"; echo "3 passed, 0 failed"'
test_of bad 'echo "what it said"; echo "5 passed, 2 failed"; exit 1'
test_of liar 'echo "4 passed, 0 failed"; exit 1'
test_of silent ':'
test_of empty 'echo "0 passed, 0 failed"'
test_of killed 'echo "7 passed, 0 failed"; kill -9 $$'
test_of late 'echo "9 passed, 0 failed"; echo "more"'
run good
check 'a good test' ends '3 passed, 0 failed' 0
check 'its sites' grep -q '^1 tests with 2 sites$' "$T/out"
run good bad
check 'a failed check' ends '8 passed, 2 failed' 1
check 'with its output' grep -qx 'what it said' "$T/out"
check 'and its name at the end' test "$(tail -n 3 "$T/out" | head -n 1)" = \
  'failed in bad: exit status 1'
test_of names 'echo "failed: the first"; echo "a.c:7: failed: x == y"' \
  'echo "1 passed, 2 failed"; exit 1'
run names
check 'what failed is named at the end' cmp -s <(head -n -2 "$T/out" | tail -n 2) \
  <(printf 'failed in names: %s\n' 'the first' 'a.c:7: x == y')
run good liar
check 'an exit status of its own' ends '7 passed, 1 failed' 1
run good silent
check 'no last line' ends '3 passed, 1 failed' 1
run good empty
check 'no checks at all' ends '3 passed, 1 failed' 1
run good killed
check 'killed' ends '10 passed, 1 failed' 1
run good late
check 'something after the last line' ends '3 passed, 1 failed' 1
run good none
check 'a test that is not there' ends '3 passed, 1 failed' 1
run
check 'nothing run is nothing passed' ends '0 passed, 0 failed' 1

# two at a time: each waits for the other
test_of one 'touch one.up; for k in {1..50}; do [ -e two.up ] && break
  sleep 0.1; done; [ -e two.up ] && echo "1 passed, 0 failed"'
test_of two 'touch two.up; for k in {1..50}; do [ -e one.up ] && break
  sleep 0.1; done; [ -e one.up ] && echo "1 passed, 0 failed"'
run one two
check 'two at a time' ends '2 passed, 0 failed' 0

# --- sites --------------------------------------------------------------------
test_of loop ". '$PWD/tests/harness.sh'" 'for k in 1 2 3; do' \
  'check "in a loop" true' 'done' 'deep() { check "deep" test "$1"; }' \
  'deep 1' 'deep 2; deep 3' 'within number 1 0 2' 'check_done'
check 'a script: lines that check' test \
  "$("$T/loop" | grep -v '^skipped' | tr '\n' ' ')" = '4 sites 7 passed, 0 failed '
cat >"$T/sites.c" <<'END'
#include "check.h"
static void deep(int x) { CHECK(x > 0); }
int main(void) {
  for (int k = 0; k < 1000; k++)
    CHECK(k >= 0);
  deep(1); deep(2);
  CHECK_CLOSE(1, 1, 0);
  CHECK_REL(1, 1, 0);
  CHECK(1 == 2); CHECK_CLOSE(NAN, 0, 1);
  return check_done();
}
END
${CC:-gcc} -Itests "$T/sites.c" -o "$T/sites" -lm
check 'a program: places that check, NaN never passes' test \
  "$("$T/sites" 2>"$T/err" | tr '\n' ' ')" = '5 sites 1004 passed, 2 failed '
: >"$T/err"
check_done
