#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Breaks the sources at one place at a time, and looks whether a test notices. Such
# a broken source is a mutant, and a mutant that no test kills shows what is not
# tested. Prints a line for each, then how many were killed, and the survivors.
#
#   tests/mutants.sh [NUMBER [SEED [FILE...]]]
#
# JOBS=1    so many at a time, each in a tree of its own
# FEW=5     seconds of tests for a mutant at first; then those that have survived go on
# MOST=60   to so many; what has survived these counts as survived
# LIST=F    mutants of one's own: FILE, line number, its text, a line in its place; tabs
#           between. NUMBER is then of no account
# B=build   where results are kept (B/mutants): when started again it goes on. A
#           mutant is tried again when its file has changed, a survivor also by tests
#           that are new or have changed
#
# Mutants are spread over files by their length and over kinds: comparisons shifted
# by the case of equality, conditions negated, && and ||, + - * /, constants, true,
# false and the like, statements left out; not how much memory there is and what
# frees it, which is for the sanitizers. Which ones depends on SEED, the lines
# and their numbers alone, so that more of them (NUMBER) are those and others.
#
# What is tried on a mutant are the tests that run its line, as gcov has seen once
# (B/mutants/cover; minutes, and again for tests that have changed): first those that
# take the least time for each line of the file that they run, and those that its header
# names before others. The first check that fails ends it (CHECK_FIRST). A test fails
# also by using four times its own time. Equal machine code is no mutant ("void"); those
# of tests/mutants.equivalent change nothing that can be seen, and it says why.
#
# A broken program may write where it should not: it runs in a scratch copy, with
# limits, and never as root, since that would include devices.
set -u -o pipefail
shopt -s extglob
export LC_ALL=C.UTF-8 OMP_WAIT_POLICY=passive
unset MAKEFLAGS MFLAGS MAKELEVEL # of the make that has started this
number=${1:-300} seed=${2:-1}
jobs=${JOBS:-1} few=${FEW:-5} most=${MOST:-60}
safely=()
if ((EUID == 0)); then
  command -v setpriv >/dev/null || {
    echo 'mutants: expected another user than root, or setpriv (util-linux)' >&2
    exit 2
  }
  safely=(setpriv --reuid=65534 --regid=65534 --clear-groups)
fi
mkdir -p "${B:-build}/mutants/cover" || exit 1
W=$(cd "${B:-build}/mutants" && pwd)
T=$(mktemp -d) || exit 1
trap 'kill $(jobs -p) 2>/dev/null; wait; rm -rf --one-file-system "$T"' EXIT
trap 'exit 1' HUP INT TERM
chmod 755 "$T"
files=("${@:3}")
[[ ${#files[@]} -gt 0 ]] || files=({common/*,settle,analyze}/*.[ch])
make=(make -s WARNINGS=-w CC="$(command -v ccache) ${CC:-gcc}" B=build)
programs=(all build/precision build/stability)
whole=(CFLAGS=-O2)
seen=(CFLAGS='-O1 --coverage')

# Every place that can be broken: KIND, FILE, line number, line, what takes its place
candidates() { # FILE...
  awk -v OFS='\t' '
    function trimmed(s) {
      gsub(/^ +| +$/, "", s)
      return s
    }
    function give(kind, new) {
      if (!given[FILENAME, text, new]++)
        print kind, FILENAME, FNR, trimmed(text), new
    }
    function put(at, length_, to) {
      return substr(text, 1, at - 1) to substr(text, at + length_)
    }
    function mutate(kind, from, to,   at, begin) {
      for (begin = 1; (at = index(substr(code, begin), from)) > 0;
           begin += length(from)) {
        begin += at - 1
        if (from != " !" || substr(code, begin, 3) != " !=")
          give(kind, put(begin, length(from), to))
      }
    }
    function either(kind, a, b) {
      mutate(kind, a, b)
      mutate(kind, b, a)
    }
    function blank(from, n,   s) { # what is no code
      s = sprintf("%" n "s", "")
      gsub(/ /, "\001", s)
      code = substr(code, 1, from - 1) s substr(code, from + n)
    }
    function constants(   at, begin, c) {
      for (begin = 1; match(substr(code, begin),
           /[^A-Za-z0-9_.][0-9]+(\.[0-9]*)?(e[-+]?[0-9]+)?[^A-Za-z0-9_.]/);
           begin = at + RLENGTH - 2) {
        at = begin + RSTART
        c = substr(text, at, RLENGTH - 2)
        if (substr(code, at - 1, RLENGTH) ~ /\{0\}/)
          continue
        if (c ~ /e/)
          give("constant", put(at, length(c), c ~ /e-/ ? "1e3 * " c : "1e-3 * " c))
        else if (c ~ /\./)
          give("constant", put(at, length(c), "1.5 * " c))
        else
          give("constant", put(at, length(c), c + 1))
      }
    }
    FNR == 1 {comment = 0; before = ";"}
    /\t/ {next}
    {
      text = code = $0
      if (comment) {
        if (!/\*\//)
          next
        blank(1, index(code, "*/") + 1)
        comment = 0
      }
      while (match(code, /"([^"\\]|\\.)*"|\047[^\047]+\047|\/\*([^*]|\*[^\/])*\*\//))
        blank(RSTART, RLENGTH)
      if ((at = index(code, "/*")) > 0) {
        comment = 1
        blank(at, length(code) - at + 1)
      }
      bare = code
      gsub(/\001/, "", bare)
      bare = trimmed(bare)
      if (bare == "")
        next
    }
    {last = before; before = bare}
    /^ *#/ || /\\$/ || code ~ /assert/ {next}
    /^(static )?(const|enum)/ {constants(); next}
    /^[^ ]/ {next}
    {
      either("boundary", " < ", " <= ")
      either("boundary", " > ", " >= ")
      either("logic", " && ", " || ")
      either("logic", " == ", " != ")
      either("logic", "true", "false")
      mutate("logic", "(!", "(")
      mutate("logic", " !", " ")
      either("arithmetic", " += ", " -= ")
      mutate("arithmetic", "++;", "--;")
      # how much memory is for the sanitizers
      if (bare !~ /sizeof|alloc|^[a-z_0-9 ]+ [^=(]*;$|^(const )?[a-z_0-9]+ [^=(]*[,)]$/) {
        either("arithmetic", " + ", " - ")
        either("arithmetic", " * ", " / ")
        either("arithmetic", "GSL_MAX(", "GSL_MIN(")
        either("arithmetic", "fmax(", "fmin(")
        constants()
      }
      s = bare
      if (match(bare, /(if|while) \(/) && bare ~ /\)( \{)?$/ && \
          gsub(/\(/, "(", s) == gsub(/\)/, ")", s)) {
        at = index(text, "(")
        s = bare ~ /\{$/ ? " {" : ""
        give("negated", substr(text, 1, at) "!" substr(text, at, \
          length(trimmed2(text)) - at + 1 - length(s)) ")" s)
      }
    }
    last ~ /[;{})]$|^else$|:$/ && bare !~ /free\(|close\(|va_end\(|^\(void\)/ &&
      (bare ~ /^[a-z*][a-zA-Z_0-9>.\[\]*+ -]*( [-+*\/|&]?= .*|\(.*\)|\+\+|--);$/ ||
       bare ~ /^(break|continue);$/) && bare !~ /^[a-z][A-Za-z_0-9]* \**[a-z(]/ {
      give("deleted", "  ; /* nothing */")
    }
    function trimmed2(s) {
      sub(/ +(\/\*.*)?$/, "", s)
      return s
    }' "$@"
}

# NUMBER of them, spread over files by their length and over kinds: FILE, line
# number, line, what takes its place
choose() {
  candidates "${files[@]}" | sort -R --random-source=<(yes "$seed") |
    awk -F '\t' -v OFS='\t' '{print n[$2, $1]++, $0}' | sort -s -n -k 1,1 |
    awk -F '\t' -v OFS='\t' -v number="$number" '
      {row[NR] = $3 OFS $4 OFS $5 OFS $6; file[NR] = $3; n[$3]++}
      END {
        for (i = 1; i <= NR; i++) # the first of each file come first
          print (at[file[i]]++ + 0.5) / n[file[i]], row[i]
      }' | sort -s -g -k 1,1 | head -n "$number" | cut -f 2-
}

tests_of() { # FILE: what its header names, and what has its name
  local name
  name=$(basename "${1%.*}")
  {
    cat "$1" "${1%.c}.h" 2>/dev/null | tr '\n' ' ' |
      grep -oE 'tests/test_[a-z_0-9]+\.(c|sh)'
    ls "tests/test_$name.c" "tests/test_$name.sh" 2>/dev/null
  } | xargs -r -n 1 basename | sort -u
}

tests_for() { # FILE LINE: KEY, seconds and TEST of what runs it, else what runs its file
  tests_of "$1" | awk -F '\t' -v OFS='\t' '
    FILENAME == "-" {own[$1] = 1; next}
    FILENAME == ARGV[2] {
      if ($2 != "-")
        time[$1] = $2
      next
    }
    FILENAME == ARGV[3] {lines[$1] = $2; next}
    $1 in time {print time[$1] / lines[$1] * ($1 in own ? 0.1 : 1), time[$1], $1}
  ' - "$W/times" <(cd "$W/cover" && grep -cF -- "$1"$'\t' * | tr : '\t') <(
    cd "$W/cover" && { grep -lxF -- "$1"$'\t'"$2" * || grep -lF -- "$1"$'\t' *; }
  ) | sort -k 1,1g
}

run_test() { # TEST SECONDS DIRECTORY: whether it passes; the directory is for its files
  local limit command=("build/tests/${1%.c}")
  [[ $1 == *.c ]] || command=(bash "tests/$1")
  limit=$(awk -v s="$2" 'BEGIN {print int(4 * s) + 5}')
  rm -rf --one-file-system "$3"
  mkdir "$3"
  ((EUID != 0)) || chown 65534:65534 "$3"
  ( # time of the processor; on the clock only for what waits forever
    ulimit -c 0 -f 5000000 -v 4000000 -t "$limit"
    CHECK_FIRST=1 B=build HOME=$3 TMPDIR=$3 timeout -s KILL $((10 * limit + 100)) \
      "${safely[@]}" "${command[@]}"
  ) >"$3.log" 2>&1 </dev/null
}

tree() { # NAME FLAGS...: a copy of the sources, with the programs
  mkdir "$T/$1"
  tar -c --exclude='./build*' --exclude=.git . | tar -x -C "$T/$1"
  cd "$T/$1" && "${make[@]}" "${@:2}" "${programs[@]}" >/dev/null
}

# The tests of which it is not known which lines they run, or which have changed since.
# Those that run whole studies, or build elsewhere, are left out.
unseen() {
  local test
  for test in $(cd tests && ls test_*.c test_*.sh); do
    case $test in
      test_figures.sh | test_settling.sh | test_builds.sh | test_install.sh | \
        test_lammps.sh | test_make.sh | test_harness.sh | test_rooms.sh) ;;
      *) row "$test" "$(cksum <"tests/$test")" ;;
    esac
  done | grep -vxFf <(cut -f 1,3 "$W/times")
}

# Which lines each of them runs, and how long it takes: TEST, seconds, or - if it
# fails, and its checksum
look() {
  local test sum time TIMEFORMAT='%U %S'
  echo 'mutants: which test runs which line; once, minutes' >&2
  tree seen "${seen[@]}" || return
  export GCOV_PREFIX=$T/gcda
  while IFS=$'\t' read -r test sum; do
    [[ $test == *.sh ]] ||
      "${make[@]}" "${seen[@]}" "build/tests/${test%.c}" >/dev/null || return
    mkdir -m 777 "$GCOV_PREFIX"
    if { time run_test "$test" 100 "$T/look"; } 2>"$T/took"; then
      lines "$GCOV_PREFIX$PWD" >"$W/cover/$test"
      time=$(awk '{print $1 + $2}' "$T/took")
    else
      echo "mutants: not used, as it fails on the whole sources: $test" >&2
      tail -n 3 "$T/look.log" >&2
      rm -f "$W/cover/$test"
      time=-
    fi
    rm -rf --one-file-system "$GCOV_PREFIX"
    awk -F '\t' -v test="$test" '$1 != test' "$W/times" >"$T/times"
    row "$test" "$time" "$sum" >>"$T/times"
    cp "$T/times" "$W/times"
  done <"$T/unseen"
  unset GCOV_PREFIX
}

lines() { # DIRECTORY of what gcov wrote: FILE, line, of those that were run
  local data
  while read -r data; do
    cp "${data%.gcda}.gcno" "$1/${data%.gcda}.gcno"
    echo "$1/$data"
  done < <(cd "$1" 2>/dev/null && find . -name '*.gcda') >"$T/data"
  [[ -s $T/data ]] || return 0 # runs nothing of ours
  xargs gcov -t <"$T/data" 2>/dev/null | awk -v OFS='\t' '
    /^ *-: +0:/ {
      if (sub(/^ *-: +0:Source:/, "")) {
        file = $0
        run = 0
      }
      next
    }
    match($0, /^ *[^:]+: *[0-9]+:/) { # the rest of a statement has no count
      count = $1
      text = substr($0, RLENGTH + 1)
      gsub(/^ +| +$/, "", text)
      if (count !~ /^-/)
        run = count ~ /^[0-9]/
      if (run && text != "" && file ~ /^[a-z]/)
        print file, text
    }' | sort -u
}

# Sets verdict and by, in the tree where we are, after at most so many seconds of
# tests, of which it may have passed some before; false if there is nothing new
judge() { # FILE LINE-NUMBER LINE NEW SECONDS PASSED
  local file=$1 object=build/obj/${1%.?} sum=0 first=libdem.a test time seen plan=()
  verdict=survived by=
  while IFS=$'\t' read -r _ time test; do
    if awk -v s="$sum" -v t="$time" -v most="$5" \
      'BEGIN {exit !(s > most || t > 4 * most)}'; then
      by+=' ...'
      break
    fi
    sum=$(awk -v a="$sum" -v b="$time" 'BEGIN {print a + b}')
    seen=$test=$(cksum <"tests/$test" | tr ' ' :)
    if [[ " $6 " == *" $seen "* ]]; then
      by+=" $seen"
    else
      plan+=("$test $time $seen")
    fi
  done < <(tests_for "$file" "$3")
  [[ ${#plan[@]} -gt 0 || ! $6 ]] || return
  [[ $file == common/* ]] || first=${file%%/*}
  cp -p "$file" "$T/$tree.whole"
  NEW=$4 awk -v n="$2" 'NR == n {print ENVIRON["NEW"]; next} {print}' \
    "$T/$tree.whole" >"$file"
  if ! "${make[@]}" "${whole[@]}" "build/$first" >/dev/null 2>&1; then
    verdict=void by='does not compile'
  elif [[ $file == *.c ]] && same "$object"*.o; then
    verdict=void by='the same machine code'
  elif [[ ${#plan[@]} -eq 0 ]]; then
    [[ $by ]] || by='no test runs it'
  else
    try "${plan[@]}"
  fi
  cp -p "$T/$tree.whole" "$file"
  cp -r build/whole/. build/obj/
  [[ $file == *.c ]] || rm -rf build/obj/tests # which may have had the header
}

try() { # 'TEST SECONDS NAME'...: the rest of judge
  local test time seen targets
  for test; do
    read -r test time seen <<<"$test"
    targets=("${programs[@]}")
    [[ $test != *.c ]] || targets=("build/tests/${test%.c}")
    if ! "${make[@]}" "${whole[@]}" "${targets[@]}" >/dev/null 2>&1; then
      echo "mutants: cannot be built: ${targets[*]}" >&2
    elif run_test "$test" "$time" "$T/$tree.run"; then
      by="$seen $by"
    else
      verdict=killed by=$test
      return
    fi
  done
}

same() { # OBJECT...: whether all are those of the whole source
  local object
  for object in "$@"; do
    cmp -s "$object" "build/whole/${object#build/obj/}" || return
  done
}

trimmed() {
  sed 's/^ *//; s/ *$//' <<<"$1"
}

work() { # TREE: every jobs-th of those that are left, then of those that survived
  local tree=$1 seconds k file line old new passed verdict by
  tree "$tree" "${whole[@]}" && cp -r build/obj build/whole || return
  for seconds in "$few" "$most"; do
    k=0
    while IFS=$'\t' read -r file line old new passed; do
      ((k++ % jobs == tree)) || continue
      judge "$file" "$line" "$old" "$new" "$seconds" "$passed" || continue
      row "$verdict" "$file:$line" "$old" '->' "$(trimmed "$new")" \
        "${by//=+([0-9:])/}"
      row "$(cksum <"$file")" "$file" "$old" "$new" "$verdict" "$by" >>"$W/verdicts"
    done < <(judged | left)
  done
}

# FILE, line number, line, NEW, tests passed, of those that are to be tried, maybe by
# no more tests than before
left() {
  awk -F '\t' -v OFS='\t' '$1 == "left" || $1 == "survived" {print $2, $3, $4, $5, $6}'
}

row() { # FIELD...
  local IFS=$'\t'
  echo "$*"
}

# The chosen ones with their verdict, if they have one for this file: VERDICT (or
# left), FILE, line number, line, NEW, by
judged() {
  awk -F '\t' -v OFS='\t' '
    function trimmed(s) {
      gsub(/^ +| +$/, "", s)
      return s
    }
    FILENAME == ARGV[1] {sum[$1] = $2; next}
    FILENAME == ARGV[2] {argued[$1, $2, $3]; next}
    FILENAME == ARGV[3] {
      if ($1 == sum[$2]) {
        verdict[$2, $3, $4] = $5
        by[$2, $3, $4] = $6
      }
      next
    }
    {
      is = ($1, $3, $4) in verdict ? verdict[$1, $3, $4] : "left"
      if (is == "survived" && ($1, $3, trimmed($4)) in argued)
        is = "equivalent"
      print is, $0, by[$1, $3, $4]
    }' "$T/sums" tests/mutants.equivalent "$W/verdicts" "$T/mutants"
}

touch "$W/verdicts" "$W/times"
if [[ ${LIST-} ]]; then
  cp "$LIST" "$T/mutants" || exit
else
  choose >"$T/mutants"
fi
for file in "${files[@]}"; do
  row "$file" "$(cksum <"$file")"
done >"$T/sums"
if [[ $(judged | left) ]]; then
  unseen >"$T/unseen"
  if [[ -s $T/unseen ]]; then # behind, so that a signal need not wait for it
    (look) &
    wait $! || exit 1
  fi
  for ((j = 0; j < jobs; j++)); do
    (work $j) &
  done
  wait
fi
judged >"$T/judged"
echo
awk -F '\t' '$1 == "survived" {print $1 ": " $2 ":" $3 ": " $4 " -> " $5}' "$T/judged"
awk -F '\t' '{n[$1]++} END {
  tried = n["killed"] + n["survived"]
  printf "%d killed, %d survived, %d argued equivalent, %d void\n", n["killed"],
    n["survived"], n["equivalent"], n["void"]
  if (n["left"])
    printf "%d not tried\n", n["left"]
  if (tried)
    printf "%.1f %% of those that are not argued equivalent are killed\n",
      100 * n["killed"] / tried
  exit n["left"] > 0
}' "$T/judged"
