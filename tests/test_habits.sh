#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What users of other programs try first: -h, help, a word that is nearly right.
. tests/harness.sh

says() { # NAME STATUS PATTERN PROGRAM ARGUMENT...: one line, and no output
  timeout 20 "$B/$4" "${@:5}" >"$T/out" 2>"$T/err" </dev/null
  local status=$?
  check "$1: exit status $status" test $status = "$2"
  check "$1: one line" test "$(wc -l <"$T/err")" = 1 -a ! -s "$T/out"
  check "$1: $3" grep -Eqx -e "$3" "$T/err"
}
prints() { # NAME COMMAND...: as --help does, quietly
  "${@:2}" >"$T/out" 2>"$T/err" </dev/null
  check "$1: exit status" test $? = 0
  check "$1: the help" cmp -s "$T/out" "$T/help"
  check "$1: nothing else" test ! -s "$T/err"
}

# --- help ---------------------------------------------------------------------
for program in sweep settle bounce analyze; do
  "$B/$program" --help >"$T/help"
  prints "$program -h" "$B/$program" -h
  check "$program --help says so" grep -q '^  -h, --help ' "$T/help"
  check "$program --help: hidden options stay so" test \
    "$(grep -c -e '--man' -e '--complete' "$T/help")" = 0
  check "$program --help: at most two words too many" awk \
    'length($0) > 160 {bad = 1} END {exit bad || NR < 20}' "$T/help"
done
prints 'analyze help' "$B/analyze" help
verbs=$("$B/analyze" --complete | grep -v '^-')
for verb in $verbs; do
  check "analyze --help lists $verb" grep -q "^  $verb  " "$T/help"
done
for verb in $verbs; do
  "$B/analyze" "$verb" --help >"$T/help"
  prints "analyze help $verb" "$B/analyze" help "$verb"
  prints "analyze $verb -h" "$B/analyze" "$verb" -h
done
says 'help for no verb' 2 "analyze: 'nonsense': expected a verb.*" \
  analyze help nonsense

# --- where the help is --------------------------------------------------------
says 'a usage error' 2 "settle: --count 0: .* \(try 'settle --help'\)" \
  settle --count 0
says 'of a verb' 2 "analyze: --bins x: .* \(try 'analyze gr --help'\)" \
  analyze gr --bins x
says 'an error of input has no such word' 1 'analyze: /none: No such file.*y' \
  analyze /none

# --- did you mean -------------------------------------------------------------
try="\(try '[a-z ]* --help'\)"
near() { # WORD MEANT PROGRAM [VERB]
  says "$3 --$1" 2 "$3: --$1: no such option; did you mean --$2\? $try" \
    "${@:3}" "--$1"
}
far() { # WORD PROGRAM [VERB]
  says "$2 --$1" 2 "$2: --$1: no such option $try" "${@:2}" "--$1"
}
near cuont count settle       # exchanged
near coumt count settle       # changed
near couunt count settle      # added
near resitution restitution settle # left out
near restittutoin restitution settle # two
near heigth height bounce
near netwrok network analyze contacts
near hlep help settle
near verison version analyze
far nonsense settle
far xyz settle                # three letters are no two mistakes from a name
far tnuoc settle                # more than two mistakes
says 'with a value' 2 "settle: --sede: .* mean --seed\? $try" settle --sede=3
says 'several options' 2 "settle: --re: stands for several options $try" \
  settle --re 1
says 'a letter' 2 "settle: -q: no such option $try" settle -q
says 'among letters' 2 "settle: -q: no such option $try" settle -qh
says 'a flag with a value' 2 "settle: --quiet: takes no argument $try" \
  settle --quiet=1
says 'no value' 2 "settle: --seed: expected an argument $try" settle --seed
"$B/settle" --restit 0.5 --count 1 --time 0 --quiet >"$T/out" 2>"$T/err"
check 'the beginning of a name is enough' grep -q '^# restitution=0.5$' "$T/out"

meant() { # WORD VERB
  says "analyze $1" 2 \
    "analyze: '$1': expected a verb or a file; did you mean $2\? $try" \
    analyze "$1"
}
meant contcts contacts
meant conatcts contacts
meant frac fraction
meant exprot export
says 'a file that is not there' 1 'analyze: bed.tsv: No such file.*' \
  analyze bed.tsv
"$B/settle" --quiet --count 2 --time 0 >"$T/contcts"
bin=$(cd "$B" && pwd) # B may be a path from here or from the root
check 'a file with such a name is one' test "$(cd "$T" &&
  "$bin/analyze" contcts 2>/dev/null | wc -l)" = 2
says 'a study' 2 "stability: 'drft': expected a verb; did you mean drift\? $try" \
  stability drft
check_done
