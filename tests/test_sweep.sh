#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# sweep: its table against settle and analyze by hand, order, resuming after a
# kill, failed runs, wrong tables, means, GNU parallel and Slurm.
. tests/harness.sh
B=$(cd "$B" && pwd)
sweep=$B/sweep
here=$PWD
cd "$T" || exit 1
tiny='--count 12 --base 0.5,0.5 --drop 0.2 --time 0.4'

sweeps() { # STATUS NAME ARGUMENT...: output in out, messages in err
  timeout 60 "$sweep" "${@:3}" >out 2>err </dev/null
  local status=$?
  check "$2: exit status $status" test $status = "$1"
}
cell() { # ROW COLUMN FILE
  awk -F '\t' -v row="$1" -v column="$2" '
    NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
    NR == row + 1 { print $(at[column]) }' "$3"
}

# --- a table of runs, against each run by hand --------------------------------
printf '# three beds\nseed\tfriction\n1\t0.2\n2\t0\n\n3\t-\n' >runs.tsv
sweeps 0 'three runs' --settle "$tiny" --jobs 3 runs.tsv
cp out three
check 'quietly' test ! -s err
check 'its columns' test "$(head -n 1 out)" = \
  $'seed\tfriction\tstatus\tt\tsum\tunion\tmessage'
by_hand() { # ROW OPTION...
  # shellcheck disable=SC2086
  "$B/settle" --quiet $tiny "${@:2}" | "$B/analyze" | tail -n 1 >row
  check "row $1 is that of settle and analyze" test "$(cat row)" = \
    "$(sed -n "$(($1 + 1))p" three | cut -f 4-6)"
}
by_hand 1 --seed 1 --friction 0.2
by_hand 2 --seed 2 --friction 0
by_hand 3 --seed 3
check 'cells are passed on' test \
  "$(cut -f 1,2 three | tail -n 3 | tr '\n\t' '; ')" = '1 0.2;2 0;3 -;'
check 'nothing is left' test "$(echo *.sweep)" = '*.sweep'
timeout 60 "$sweep" --settle "$tiny" <runs.tsv >out 2>err
check 'from standard input' cmp -s out three
# the order is that of the table although the first run is by far the longest
printf 'seed\tcount\ttime\n1\t60\t1\n2\t2\t0.1\n3\t2\t0.1\n' >order.tsv
sweeps 0 order --settle '--base 0.5,0.5' --jobs 3 order.tsv
check 'order of the table' test "$(cut -f 1 out | tr '\n' ' ')" = 'seed 1 2 3 '
printf 'model\tuntil-rest\tbase\tgravity\nbasic\tno\t"0.5,0.5"\t9.81\r\n' \
  >kinds.tsv
sweeps 0 'a choice, a flag, a list, quotes, CRLF' \
  --settle '--count 2 --time 0.1' kinds.tsv
sweeps 0 'several measures' --settle "$tiny" --measure fraction \
  --measure 'contacts' --measure 'fraction --box 0,0.5,0,0.5,0,0.1' runs.tsv
check 't once, and a name that is taken with the number of its measure' test \
  "$(head -n 1 out | tr '\t' '\n' | grep -c -x -e t -e union -e union.3 \
    -e z_rigid)" = 4
check 'each measure in its columns' test "$(cell 1 union.3 out)" = \
  "$("$B/settle" --quiet $tiny --seed 1 | "$B/analyze" \
    --box 0,0.5,0,0.5,0,0.1 | tail -n 1 | cut -f 3)"

# --- runs that fail -----------------------------------------------------------
printf 'seed\tfriction\tuntil-rest\n1\t-1\t0\n2\t0.2\t1\n3\t0.2\t0\n' >fail.tsv
sweeps 4 'two of three fail' --settle "$tiny" fail.tsv
check 'a usage error is a row' test "$(cell 1 status out) $(cell 1 union out)" \
  = '2 nan'
check 'with its message' test "$(cell 1 message out | grep -c \
  'settle: --friction -1: expected')" = 1
check 'a bed not at rest is a row' test "$(cell 2 status out)" = 5
check 'and the rest goes on' test "$(cell 3 union out)" = \
  "$(cell 3 union three)"
check 'one line says so' test "$(wc -l <err)" = 1
sweeps 4 'failed beds are measured on request' --settle "$tiny" \
  --measure 'fraction --allow-partial' fail.tsv
within 'its fraction' "$(cell 2 union out)" 0.01 1

# --- tables that are wrong ----------------------------------------------------
wrong() { # STATUS PATTERN TABLE ARGUMENT...: one line with it, and no output
  printf '%b' "$3" >wrong.tsv
  sweeps "$1" "$2" "${@:4}" wrong.tsv
  check "$2: one line" test "$(wc -l <err)" = 1 -a ! -s out
  check "$2" grep -q -e "$2" err
}
wrong 3 'wrong.tsv:1: column sed: settle has no such option' 'sed\n1\n'
wrong 3 'wrong.tsv:1: column seed is there twice' 'seed\tseed\n1\t2\n'
wrong 3 'wrong.tsv:1: column 2 has no name' 'seed\t\n1\t2\n'
wrong 3 'wrong.tsv:1: column threads: sweep sets it' 'threads\n1\n'
wrong 3 'wrong.tsv:1:.*expected tabs' 'seed,friction\n1,2\n'
wrong 3 'wrong.tsv:3: 1 cells, expected 2' 'seed\tcount\n1\t2\n1\n'
wrong 3 'wrong.tsv:3: column seed: "x": expected a number' 'seed\n1\nx\n'
wrong 3 'wrong.tsv:2: column base: "1,": expected numbers' 'base\n1,\n'
wrong 3 'wrong.tsv:2: column model: "soft": expected one of basic' \
  'model\nsoft\n'
wrong 3 'wrong.tsv:2: column until-rest: "3": expected 1 or 0' 'until-rest\n3\n'
wrong 3 'wrong.tsv:2: the quote of "1 does not end' 'seed\n"1\n'
wrong 3 'wrong.tsv:2: a quote within' 'seed\n1"\n'
wrong 3 'wrong.tsv:0: the table is empty' ''
wrong 3 'wrong.tsv:1: no run' 'seed\n'
good='seed\n1\n'
wrong 2 "measure 'nonsense': expected a verb of analyze" "$good" \
  --measure nonsense
wrong 2 'several rows for one bed' "$good" --measure 'fraction --slab 0.1'
wrong 2 'jobs x: expected a whole number' "$good" --jobs x
wrong 2 'none: no such option' "$good" --none
wrong 2 'expected one table' "$good" runs.tsv
wrong 2 'sbatch: expected --slurm' "$good" --sbatch x
sweeps 1 'no such table' none.tsv
sweeps 2 'an option without its value' runs.tsv --jobs
check 'says so' grep -q 'jobs: expected a value' err
if [[ -e /dev/full ]]; then
  "$sweep" --settle "$tiny" runs.tsv >/dev/full 2>err
  check 'a full disk' test $? = 1
  "$sweep" --help >/dev/full 2>err
  check 'a full disk, help' test $? = 1
fi
rm -rf ./*.sweep

# --- killed, and resumed ------------------------------------------------------
{
  echo seed
  seq 40
} >forty.tsv
sweeps 0 'forty runs' --settle "$tiny" --jobs 2 forty.tsv
cp out forty
killed() { # SIGNAL: in the middle; the results that are there are whole rows
  rm -rf forty.sweep
  "$sweep" --settle "$tiny" --jobs 2 forty.tsv >out 2>err </dev/null &
  local pid=$!
  for ((k = 0; k < 400; k++)); do
    (($(find forty.sweep -name '*.row' 2>/dev/null | wc -l) < 5)) || break
    sleep 0.05
  done
  kill "-$1" $pid
  wait $pid 2>/dev/null
  status=$?
  rows=$(find forty.sweep -name '*.row' | wc -l)
  check "SIG$1 in the middle, $rows rows" test "$rows" -ge 5 -a "$rows" -lt 40
  # what is there is taken as it is
  sed -i '2s/\t0\.4\t/\t1\t/' forty.sweep/1.row
  sweeps 0 "resumed after SIG$1" --settle "$tiny" --jobs 2 forty.tsv
  check "SIG$1: the first row was not run again" test \
    "$(sed -n 2p out | cut -f 2-3)" = $'0\t1'
  check "SIG$1: the other rows are the same" cmp -s <(tail -n +3 out) \
    <(tail -n +3 forty)
  check "SIG$1: nothing is left" test ! -e forty.sweep
}
killed TERM
check 'SIGTERM: exit status 5' test $status = 5
killed KILL
# what something else ended is run again, what failed by itself is not
sweeps 4 'rows of failures' --settle "$tiny" --work f fail.tsv
sed -i '2s/\t2\t/\t1\t/' f/1.row
sed -i '2s/settle:/once:/' f/2.row
sweeps 4 'once more' --settle "$tiny" --work f fail.tsv
check 'status 1 was run again' test "$(cell 1 status out)" = 2
check 'status 5 was not' grep -q '^2.*once: ' out
# other options, and other rows, are other runs
sweeps 0 'a place of its own' --settle "$tiny" --work w runs.tsv
check 'it stays' test -s w/3.row
sed -i '2s/\t0\./\t9./' w/*.row
printf 'seed\tfriction\n1\t0.3\n2\t0\n3\t-\n4\t-\n' >more.tsv
sweeps 0 'a table that has grown' --settle "$tiny" --work w more.tsv
check 'what changed is run again, the same is not' test \
  "$(cut -f 4 out | cut -c 1 | tail -n 4 | tr '\n' ' ')" = '0 9 9 0 '
check 'what is not used is said' test "$(wc -l <err)" = 1 -a \
  "$(grep -c 'w: 1 results are of other options' err)" = 1
printf 'seed\tfriction\n7\t-\n2\t0\n1\t0.3\n1\t0.2\n' >moved.tsv
sweeps 0 'rows that have moved' --settle "$tiny" --work w moved.tsv
check 'only a new one is run, and one that is wanted again is there' test \
  "$(cut -f 4 out | cut -c 1 | tail -n 4 | tr '\n' ' ')" = '0 9 0 9 '
sed -i '2s/\t0\./\t8./' w/1.row
sweeps 0 'another measure' --settle "$tiny" --work w --measure rest moved.tsv
check 'all is run again' test "$(cell 2 status out)" = 0 -a \
  "$(head -n 1 out | cut -f 4-5)" = $'t\tkinetic'
sweeps 0 'the measure of before' --settle "$tiny" --work w moved.tsv
check 'its results were kept' test \
  "$(cut -f 4 out | cut -c 1 | tail -n 4 | tr '\n' ' ')" = '8 9 0 9 '
sweeps 0 'beds that are kept' --settle "$tiny" --work k --keep kept runs.tsv
sed -i '2s/\t0\./\t9./' k/*.row
printf 'seed\tfriction\n2\t0\n1\t0.2\n3\t-\n' >swapped.tsv
sweeps 0 'have the numbers of their runs' --settle "$tiny" --work k \
  --keep kept swapped.tsv
check 'so what has moved is run again' test \
  "$(cut -f 4 out | cut -c 1 | tail -n 3 | tr '\n' ' ')" = '0 0 9 '
mkdir -p busy
(
  flock 8
  timeout 60 "$sweep" --settle "$tiny" --work busy runs.tsv >out 2>err
  echo $? >status
) 8>busy/lock
check 'two at once' test "$(cat status)" = 1 -a \
  "$(grep -c 'another sweep works there' err)" = 1

# --- beds, and command lines --------------------------------------------------
sweeps 0 'kept beds' --settle "$tiny" --keep 'my beds' runs.tsv
check 'each is whole' test \
  "$("$B/analyze" 'my beds/000002.tsv' | tail -n 1)" = "$(sed -n 3p three | cut -f 4-6)"
check 'and there is no other file' test "$(find 'my beds' -type f | wc -l)" = 3
sweeps 0 'command lines' --settle "$tiny" --dry-run runs.tsv
check 'one that runs by itself' test "$(sed -n 2p out | bash | cut -f 2,4-)" = \
  "$(sed -n 3p three | cut -f 3-6)"

# --- means --------------------------------------------------------------------
printf 'friction\tseed\tstatus\tunion\tmessage\n' >results.tsv
printf '%s\t%s\t%s\t%s\t-\n' 0.1 1 0 1 0.2 1 0 5 0.1 2 0 2 0.1 3 0 6 \
  0.2 2 4 nan >>results.tsv
sweeps 0 means --summary friction results.tsv
check 'mean, standard error, number' test "$(sed 1d out | tr '\n\t' '; ')" = \
  '0.1 3 0 3 1.5275252316519468;0.2 1 1 5 nan;'
check 'columns' test "$(head -n 1 out)" = \
  $'friction\tn\tfailed\tunion\tunion_se'
sweeps 0 'over all' --summary '' results.tsv
check 'all rows' test "$(sed 1d out | cut -f 1-3 | tr '\t' ' ')" = '4 1 3.5'
sweeps 0 'by two columns' --summary friction,seed results.tsv
check 'five groups' test "$(wc -l <out)" = 6
sweeps 3 'no such group' --summary radius results.tsv
check 'says so' grep -q 'results.tsv:1: no column radius' err
sweeps 3 'no results' --summary seed runs.tsv
sweeps 0 'of its own results' --settle "$tiny" runs.tsv
"$sweep" --summary friction <out >means 2>err
check 'through a pipe' test "$(sed -n 2p means | cut -f 6)" = \
  "$(cell 1 sum three)" -a "$(wc -l <means)" = 4

# --- GNU parallel -------------------------------------------------------------
if command -v parallel >/dev/null && parallel --version 2>/dev/null |
  grep -q '^GNU parallel'; then
  export HOME=$T # where it notes what it knows of hosts
  sweeps 0 'GNU parallel' --settle "$tiny" --jobs 2 --parallel runs.tsv
  check 'the same table' cmp -s out three
  # hosts that are reached by a command in place of ssh
  printf '#!/bin/bash\nwhile [[ $1 != host? ]]; do shift; done
echo $1 >>%q/reached\nshift\n[[ $1 != -- ]] || shift\nbash -c "$*"\n' \
    "$T" >ssh
  chmod +x ssh
  PARALLEL_SSH=$T/ssh sweeps 0 'on hosts' --settle "$tiny" --jobs 1 \
    --sshlogin 1/host1,1/host2 --sshlogin : runs.tsv
  check 'the same table from the hosts' cmp -s out three
  check 'both were reached' test "$(sort -u reached | tr '\n' ' ')" = \
    'host1 host2 '
  # a host that cannot be reached
  printf '#!/bin/bash\necho no route to host >&2\nexit 255\n' >ssh
  PARALLEL_SSH=$T/ssh sweeps 1 'no host' --settle "$tiny" \
    --sshlogin 1/host1 runs.tsv
  check 'says what is missing' grep -q '3 of 3 runs ended without' err
else
  echo 'skipped: GNU parallel (it is not installed)'
fi

cd "$here" || exit 1
check_done
