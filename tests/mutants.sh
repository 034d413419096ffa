#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Breaks the sources at random places, one at a time, and looks whether a test
# notices: those that the header of the broken file names ("Tested in"), and that
# of its own name. A mutant that no test kills is printed with its place; those of
# tests/mutants.equivalent change nothing that can be seen, and it says why.
#
#   tests/mutants.sh [NUMBER [SEED [FILE...]]]      JOBS=1 at a time
#
# Works in copies of the tree, so several may run side by side. A broken program may
# write where it should not: not as root, since that includes devices.
set -u -o pipefail
export LC_ALL=C.UTF-8
number=${1:-300} seed=${2:-1}
jobs=${JOBS:-1}
if ((EUID == 0)); then
  command -v setpriv >/dev/null || {
    echo 'mutants: expected another user than root, or setpriv (util-linux)' >&2
    exit 2
  }
  safely=(setpriv --reuid=65534 --regid=65534 --clear-groups)
else
  safely=()
fi
T=$(mktemp -d) || exit 1
trap 'rm -rf "$T"' EXIT
files=("${@:3}")
[[ ${#files[@]} -gt 0 ]] || mapfile -t files < <(ls common/*/*.c settle/*.c analyze/*.c)

# Every place that can be broken: FILE, line, text that takes its place
candidates() { # FILE...
  awk -v OFS='\t' '
    function mutate(from, to,   at, rest, begin) {
      begin = 1
      while ((at = index(substr(text, begin), from)) > 0) {
        begin += at - 1
        print FILENAME, FNR, substr(text, 1, begin - 1) to \
          substr(text, begin + length(from))
        begin += length(from)
      }
    }
    FNR == 1 {comment = 0}
    {
      text = $0
      if (comment || /\/\*/) {
        comment = !/\*\//
        if (!/^[^\/]*;.*\/\*.*\*\/ *$/)
          next
      }
    }
    /^[ ]*[#*]/ || /"/ || /^[^ ]/ || /assert/ || /\t/ {next}
    {
      mutate(" < ", " <= "); mutate(" <= ", " < ")
      mutate(" > ", " >= "); mutate(" >= ", " > ")
      mutate(" == ", " != "); mutate(" != ", " == ")
      mutate(" && ", " || "); mutate(" || ", " && ")
      mutate(" + ", " - "); mutate(" - ", " + ")
      mutate(" * ", " / "); mutate(" / ", " * ")
      mutate(" += ", " -= "); mutate(" -= ", " += ")
      mutate("GSL_MAX(", "GSL_MIN("); mutate("GSL_MIN(", "GSL_MAX(")
      mutate("true", "false"); mutate("false", "true")
      mutate("(!", "("); mutate("++;", "--;")
      mutate(" 0;", " 1;"); mutate(" 1;", " 0;"); mutate("0.5 ", "0.6 ")
    }
    /^ +[a-z][a-zA-Z_0-9>.\[\]-]*(\(.*\)| [-+*]?= .*);$/ &&
      !/^ +(return|const|double|size_t|int|struct|static|free|char|bool)/ {
      print FILENAME, FNR, "  ; /* nothing */"
    }' "$@"
}

# The tests of a source
tests_of() { # FILE
  local name header
  name=$(basename "${1%.*}")
  header=${1%.c}.h
  {
    cat "$1" "$header" 2>/dev/null | tr '\n' ' ' |
      grep -oE 'tests/test_[a-z_0-9]+\.(c|sh)'
    ls "tests/test_$name.c" "tests/test_$name.sh" 2>/dev/null
    [[ $1 != analyze/* ]] || echo tests/test_cli.sh
    [[ $1 != settle/* ]] || printf '%s\n' tests/test_cli.sh tests/test_watch.sh
  } | sort -u | while read -r test; do
    [[ ! -e $test ]] || echo "$test"
  done
}

run_test() { # FILE of a test: its status
  if [[ $1 == *.c ]]; then
    make -s "build/${1%.c}" >/dev/null 2>&1 || return 0 # cannot be built: no verdict
    timeout 300 "${safely[@]}" "build/${1%.c}" >/dev/null 2>&1
  else
    B=build timeout 600 "${safely[@]}" bash "$1" >/dev/null 2>&1
  fi
}

judge() { # FILE LINE TEXT: killed, survived, equivalent or void
  local file=$1 line=$2 text=$3 test passed=0
  cp "$file" "$file.whole"
  TEXT=$text awk -v n="$line" 'NR == n {print ENVIRON["TEXT"]; next} {print}' \
    "$file.whole" >"$file"
  if make -s all >/dev/null 2>&1; then
    verdict=survived
    while read -r test; do
      if ! run_test "$test"; then
        verdict="killed by $test"
        break
      fi
      passed=$((passed + 1))
    done < <(tests_of "$file")
    ((passed > 0)) || [[ $verdict != survived ]] || verdict='void: no test'
  else
    verdict='void: does not compile'
  fi
  [[ $verdict != survived ]] || ! grep -qF "$file"$'\t'"$text"$'\t' \
    tests/mutants.equivalent || verdict=equivalent
  mv "$file.whole" "$file"
}

work() { # JOB: every jobs-th of the mutants
  local k=0 file line text verdict
  cd "$T/$1" || exit 1
  while IFS=$'\t' read -r _ file line text; do
    ((k++ % jobs == $1)) || continue
    judge "$file" "$line" "$text"
    printf '%s\t%s:%s\t%s\t%s\n' "${verdict%% *}" "$file" "$line" "$text" \
      "$verdict" | tee -a "$T/verdicts"
  done <"$T/mutants"
}

candidates "${files[@]}" | awk -v seed="$seed" 'BEGIN {srand(seed)}
  {printf "%.9f\t%s\n", rand(), $0}' | sort -k 1,1 | head -n "$number" >"$T/mutants"
chmod 755 "$T"
for ((j = 0; j < jobs; j++)); do
  mkdir "$T/$j"
  tar -c --exclude=./build --exclude=.git . | tar -x -C "$T/$j"
  make -s -C "$T/$j" all >/dev/null || exit 1
  ((EUID != 0)) || chown -R 65534:65534 "$T/$j"
done
for ((j = 0; j < jobs; j++)); do
  work $j &
done
wait
awk -F '\t' '{n[$1]++} END {
  tried = n["killed"] + n["survived"]
  printf "%d killed, %d survived, %d argued equivalent, %d void\n", n["killed"],
    n["survived"], n["equivalent"], n["void:"]
  if (tried)
    printf "%.0f %% of those that are not argued equivalent\n",
      100 * n["killed"] / tried
}' "$T/verdicts"
