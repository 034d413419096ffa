#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Many beds: a table of runs of settle in, a table of what analyze measures of
# each bed out. docs/sweep.md is its page, tests/test_sweep.sh tests it.
#
# Each run is one command line, this script with --run, which prints one line:
# number, status, message, values. So a run is the same here, under GNU parallel
# on another host, and in a Slurm job; and its command line is what a stored
# result is known by: a result is used again if its command is the same.
set -u
export LC_ALL=C
self=$(readlink -f "$0")
PATH=${self%/*}:$PATH # settle and analyze are beside it, or installed elsewhere

usage='[OPTION...] [RUNS] > results.tsv'
summary='Settles many beds and measures each: one row for each run, in order.
RUNS is a table by tabs (- or nothing: standard input). Its first line
names options of settle (seed friction ...), each further line is a
run; an empty cell or - leaves the option to settle. The results have
those columns, the exit status, what analyze measures, and a message.
A sweep that was killed goes on where it was by the same command.'
example="sweep --measure fraction --jobs 8 runs.tsv > results.tsv"
# name, what stands for the value, its kind, help, default; a line for each
options="measure|VERB|text|what analyze is to do, with its options; repeatable: several columns|fraction
settle|OPTIONS|text|for each run, which a cell of the table overrides|
jobs|N|number|runs at a time, 0: one for each core|1
keep|DIR|text|keep the beds there, by the number of the run|
work|DIR|text|where finished runs are kept until all are; else NAME.sweep for NAME.tsv, and nowhere for standard input|
parallel||flag|run by GNU parallel|
sshlogin|HOSTS|text|on these hosts, by GNU parallel; repeatable, : is this host|
slurm||flag|run as an array of Slurm jobs, --jobs at a time, 0: as many as there are|
sbatch|OPTIONS|text|for Slurm, such as '--partition=long'|
dry-run||flag|print the command line of each run instead|
summary|COLUMNS|text|instead, of a table of results: means and standard errors of rows that share these columns; '': of all|
origin||flag|begin with lines # that say what made the table|
quiet||flag|no progress on a terminal|"

die() { # STATUS MESSAGE
  clear_line
  printf 'sweep: %s\n' "$2" >&2
  exit "$1"
}
usage_error() {
  die 2 "$1 (try 'sweep --help')"
}
written() { # of what was printed
  die 1 'standard output: the table could not be written'
}
shown= # whether a line of progress is on the terminal
clear_line() {
  [[ -z $shown ]] || printf '\r\033[K' >&2
  shown=
}

# --- help, man page, completion -----------------------------------------------
version() {
  settle --version | sed 's/.* //'
}
# What made a table, in lines of comment, as settle and analyze have them. Where and
# how runs are run is no part.
origin() { # WORD...: of the command line; more lines come on standard input
  local word
  [[ -n $origin ]] || return 0
  printf '# %s\n' program=sweep "version=$(version)" || written
  sed -n '/^# \(build\|kernel\)=/p' || written
  printf '# command=sweep' || written
  for word; do
    [[ $word =~ ^[A-Za-z0-9_.,:/+=@%-]+$ ]] || word=${word@Q}
    printf ' %s' "$word" || written
  done
  echo || written
}
print_help() {
  printf 'Usage: sweep %s\n%s\n\nOptions (defaults in brackets):\n' "$usage" \
    "$summary"
  local name value kind help default
  while IFS='|' read -r name value kind help default; do
    printf '  %-18s %s%s\n' "--$name${value:+ $value}" "$help" \
      "${default:+ [$default]}"
  done <<<"$options"
  printf '  %-18s %s\n' '-h, --help' 'this text' --version 'name and version'
  printf '\nExit status: 0 done, 1 input, output or memory failed, %s\n' \
    '2 a mistake in the use,'
  printf '  %s\n' '3 bad input, 4 some runs failed, 5 interrupted.'
  printf '\nExample:\n  %s\n' "$example"
}
print_man() {
  local name value kind help default
  printf '.TH SWEEP 1 "" "dem %s" "Beds of settled spheres"\n' "$(version)"
  printf '.SH NAME\nsweep \\- settles many beds and measures each\n'
  printf '.SH SYNOPSIS\n\\fBsweep\\fR %s\n.SH DESCRIPTION\n%s\n.SH OPTIONS\n' \
    "$usage" "$summary" | sed 's/ - / \\- /'
  while IFS='|' read -r name value kind help default; do
    # shellcheck disable=SC2001
    printf '.TP\n\\fB\\-\\-%s\\fR\\fI%s\\fR\n%s.%s\n' "${name//-/\\-}" \
      "${value:+ $value}" "$(sed "s/-/\\\\-/g; s/'/\\\\(aq/g" <<<"$help")" \
      "${default:+ Default: $default.}"
  done <<<"$options"
  printf '.TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\n'
  printf 'The options and their defaults.\n'
  printf '.TP\n\\fB\\-\\-version\\fR\nName and version.\n.SH EXIT STATUS\n'
  printf '.TP\n%s\n%s\n' 0 'done' 1 'input, output or memory failed' \
    2 'a mistake in the use' 3 'bad input' 4 'some runs failed' 5 interrupted
  printf '.SH EXAMPLE\n.nf\n%s\n.fi\n.SH SEE ALSO\n%s\n' "${example//-/\\-}" \
    '.BR settle (1), .BR analyze (1), .BR parallel (1), .BR sbatch (1)' |
    sed 's/), /),\n/g'
}
print_complete() {
  local name value kind help default
  while IFS='|' read -r name value kind help default; do
    printf -- '--%s\t%s\t\n' "$name" "$kind"
  done <<<"$options"
}

# --- one run ------------------------------------------------------------------
# Measures a bed: names and values, or status and message of what went wrong.
measure() { # BED DIRECTORY
  local words k row
  names=() values='' status=0
  for k in "${!measures[@]}"; do
    read -ra words <<<"${measures[k]}"
    analyze "${words[@]}" "$1" >"$2/measured" 2>"$2/err"
    status=$?
    if ((status)); then
      last_message analyze "$2/err"
      return 1
    fi
    # the last row, as the bed's last state is the result; t once
    row=$(awk -F '\t' -v later="$k" '
      NF == 0 || /^#/ { next }
      !head { head = $0; time = $1 == "t"; width = NF; next }
      { rows++; last = $0; t = $1 }
      t == before && time { same++ }
      { before = t }
      END {
        if (later && time) { sub(/^[^\t]*\t/, "", head)
                             sub(/^[^\t]*\t/, "", last) }
        print same + (!time && rows > 1)
        print head
        print last
      }' "$2/measured")
    if [[ ${row%%$'\n'*} != 0 ]]; then
      status=2 message="analyze ${measures[k]}: several rows for one bed"
      return 1
    fi
    row=${row#*$'\n'}
    names+=("${row%%$'\n'*}")
    values+=${values:+$'\t'}${row#*$'\n'}
  done
}
last_message() { # PROGRAM FILE: the last that it said, or what killed it
  message=$(tail -n 1 "$2" 2>/dev/null | tr -s '\t\r' '  ' | cut -c 1-500)
  if ((status > 128)); then
    message="$1: killed by signal $((status - 128))"
  fi
  message=${message:--}
}
run_one() { # ARGUMENT...: of settle
  local bed message=- values=''
  T=$(mktemp -d) || exit 1
  bed=$T/bed
  if [[ -n $keep ]]; then
    bed=$keep/$(printf '%06d' "$run").tsv.partial
  fi
  trap 'rm -rf "$T"' EXIT
  # an interrupted run is no result; settle has ended by itself then
  trap 'rm -f "$bed"; exit 130' INT TERM HUP
  settle --quiet --threads 1 "$@" >"$bed" 2>"$T/err" </dev/null
  status=$?
  last_message settle "$T/err"
  if ((status == 0)) ||
    [[ ${measures[*]} == *--allow-partial* && -s $bed ]]; then
    local settled=$status said=$message
    if measure "$bed" "$T"; then
      status=$settled message=$said
    fi
  fi
  if [[ -n $keep && -s $bed ]]; then
    mv "$bed" "${bed%.partial}"
  elif [[ -n $keep ]]; then
    rm -f "$bed"
  fi
  # in one write, so that lines of several runs do not mix
  printf '%s\n' "$run"$'\t'"$status"$'\t'"$message"$'\t'"$values"
}

# --- the table of runs --------------------------------------------------------
# Prints a line of columns, then for each run: its cells, \001, its arguments.
# What is wrong goes to standard error, and the status is 3 then.
read_table() { # FILE NAME
  settle --complete | awk -v name="$2" '
    function wrong(text) {
      printf "sweep: %s:%d: %s\n", name, line, text > "/dev/stderr"
      bad = 1
      exit 3
    }
    function cell(text) { # without the quotes of a spreadsheet
      if (text !~ /^"/) {
        if (text ~ /"/)
          wrong("a quote within " text ": expected none, or one at each end")
        return text
      }
      if (length(text) < 2 || text !~ /"$/)
        wrong("the quote of " text \
          " does not end: a cell holds no tab and no line")
      text = substr(text, 2, length(text) - 2)
      gsub(/""/, "\002", text)
      if (text ~ /"/) wrong("a quote within \"" text "\"")
      gsub(/\002/, "\"", text)
      return text
    }
    function quoted(text) { # for the shell
      if (text ~ /^[A-Za-z0-9_.,:\/+=@%-]+$/) return text
      gsub(/\047/, "\047\\\047\047", text)
      return "\047" text "\047"
    }
    function number(text) {
      return text ~ /^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$/
    }
    function argument(column, text,   part, n, i) {
      if (text == "" || text == "-") return ""
      if (kind[column] == "flag") {
        if (text == "1" || text == "yes") return " --" column
        if (text == "0" || text == "no") return ""
        wrong("column " column ": \"" text "\": expected 1 or 0")
      }
      if (kind[column] == "number" && !number(text))
        wrong("column " column ": \"" text "\": expected a number")
      if (kind[column] == "numbers") {
        n = split(text, part, ",")
        for (i = 1; i <= n; i++)
          if (!number(part[i]))
            wrong("column " column ": \"" text \
              "\": expected numbers with commas between them")
      }
      if (choices[column] != "" &&
          index(" " choices[column] " ", " " text " ") == 0)
        wrong("column " column ": \"" text "\": expected one of " \
          choices[column])
      return " --" column " " quoted(text)
    }
    BEGIN {
      FS = "\t"
      n = split("threads quiet stats log output checkpoint every resume " \
        "export-lammps", own, " ")
      for (i = 1; i <= n; i++) ours[own[i]] = 1
    }
    # options of settle first: name, kind, choices
    FILENAME == "-" {
      sub(/^--/, "", $1)
      kind[$1] = $2
      choices[$1] = $3
      next
    }
    { line = FNR; sub(/\r$/, "") }
    FNR == 1 { sub(/^\357\273\277/, "") }
    /^[ \t]*$/ || /^#/ { next }
    { if (/[\001\002]/) wrong("a control character") }
    !columns {
      columns = NF
      for (k = 1; k <= NF; k++) {
        c = cell($k)
        if (c == "")
          wrong("column " k " has no name")
        if (!(c in kind) && columns == 1 && c ~ /[ ,;]/)
          wrong("\"" c "\": expected tabs between the columns")
        if (c in ours)
          wrong("column " c ": sweep sets it itself")
        if (!(c in kind))
          wrong("column " c ": settle has no such option (see settle --help)")
        if (c in at)
          wrong("column " c " is there twice")
        at[c] = k
        column[k] = c
        printf "%s%s", (k > 1 ? "\t" : ""), c
      }
      printf "\n"
      next
    }
    {
      if (NF != columns)
        wrong(NF " cells, expected " columns " as in the line of names")
      cells = arguments = ""
      for (k = 1; k <= columns; k++) {
        c = cell($k)
        arguments = arguments argument(column[k], c)
        cells = cells (k > 1 ? "\t" : "") (c == "" ? "-" : c)
      }
      printf "%s\001%s\n", cells, arguments
      runs++
    }
    END {
      if (bad) exit 3
      line = FNR
      if (!columns)
        wrong("the table is empty: expected names of options of settle, " \
          "and runs")
      if (!runs) wrong("no run: expected lines below the names")
    }' - "$1"
}

# --- means over groups --------------------------------------------------------
summarize() { # COLUMNS FILE NAME
  awk -F '\t' -v wanted="$1" -v name="$3" '
    function wrong(text) {
      printf "sweep: %s:%d: %s\n", name, FNR, text > "/dev/stderr"
      bad = 1
      exit 3
    }
    function shortest(x,   digits, text) { # that reads back the same
      if (x != x || x - x != 0) return "nan"
      for (digits = 6; digits < 17; digits++) {
        text = sprintf("%." digits "g", x)
        if (text + 0 == x) return text
      }
      return sprintf("%.17g", x)
    }
    !columns && /^#/ { next }
    !columns {
      sub(/\r$/, "")
      for (k = 1; k <= NF; k++) at[$k] = k
      if (!("status" in at && "message" in at) || at["message"] < at["status"])
        wrong("expected results of sweep, with the columns status and message")
      columns = NF
      groups = split(wanted, group, /[ ,]+/)
      for (g = 1; g <= groups; g++)
        if (!(group[g] in at) || at[group[g]] >= at["status"])
          wrong("no column " group[g] " before the column status")
      for (k = 1; k <= NF; k++) head[k] = $k
      first = at["status"] + 1
      last = at["message"] - 1
      next
    }
    NF != columns { wrong(NF " cells, expected " columns) }
    {
      key = ""
      for (g = 1; g <= groups; g++)
        key = key (g > 1 ? "\t" : "") $(at[group[g]])
      if (!(key in rows)) { rows[key] = failed[key] = 0; order[++n] = key }
      if ($(at["status"]) != 0) { failed[key]++; next }
      rows[key]++
      for (k = first; k <= last; k++) {
        # by steps, which loses no digits to a large mean
        if ($k !~ /^[-+]?[0-9.]/) lost[key, k] = 1
        d = $k - mean[key, k]
        mean[key, k] += d / rows[key]
        square[key, k] += d * ($k - mean[key, k])
      }
    }
    END {
      if (bad) exit 3
      if (!n) wrong("no row of results")
      for (g = 1; g <= groups; g++) printf "%s\t", group[g]
      printf "n\tfailed"
      for (k = first; k <= last; k++) printf "\t%s\t%s_se", head[k], head[k]
      printf "\n"
      for (i = 1; i <= n; i++) {
        key = order[i]
        m = rows[key]
        printf "%s%s%d\t%d", key, groups ? "\t" : "", m, failed[key]
        for (k = first; k <= last; k++)
          if (m == 0 || (key, k) in lost) printf "\tnan\tnan"
          else printf "\t%s\t%s", shortest(mean[key, k]), \
            (m > 1 ? shortest(sqrt(square[key, k] / (m - 1) / m)) : "nan")
        printf "\n"
      }
    }' "$2"
}

# --- stored results -----------------------------------------------------------
# DIR/N.row: version and command, then the line of the run.
store() { # DIR N LINE
  local file=$1/$2.row
  printf '%s\n%s\n' "$version ${commands[$2]}" "$3" >"$file.$HOSTNAME.$$" &&
    mv "$file.$HOSTNAME.$$" "$file"
}
stored() { # DIR N: its line into $line, if the run was this one
  local key
  { read -r key && read -r line; } 2>/dev/null <"$1/$2.row" || return 1
  [[ $key == "$version ${commands[$2]}" ]] || return 1
}
# What DIR has of any run, by its command without the number of the run, into
# known: a row may have moved, and what other options made is kept in a file,
# others, whose keys are in shelved.
recall() { # DIR
  local place key line
  while read -r place && IFS= read -r key && IFS= read -r line; do
    known[$key]=$line
    [[ $place != */others ]] || shelved[$key]=1
  done < <(find "$1" -maxdepth 1 \( -name '*.row' -o -name others \) \
    -exec awk 'FNR % 2 { sub(/--run [0-9]+ -- /, "-- "); key = $0; next }
      { print FILENAME; print key; print }' {} +)
}
of_any_number() { # N: its key in known
  printf -v key '%s' "$version ${commands[$1]/--run $1 -- /-- }"
}
# Puts aside in DIR what is known of no run of the table; aside: how many of
# them are new there.
put_aside() { # DIR
  local n key
  local -A wanted
  for ((n = 1; n <= runs; n++)); do
    of_any_number $n
    wanted[$key]=1
  done
  for key in "${!known[@]}"; do
    [[ -z ${wanted[$key]-} ]] || continue
    [[ -n ${shelved[$key]-} ]] || aside=$((aside + 1))
    printf '%s\n%s\n' "$key" "${known[$key]}"
  done >"$1/others.$HOSTNAME.$$" && mv "$1/others.$HOSTNAME.$$" "$1/others"
}
# Its line into $line, if it was run, under whatever number; a bed that is kept
# has the number that it had.
known_line() { # DIR N
  local key
  if stored "$1" "$2"; then return; fi
  of_any_number "$2"
  [[ -z $keep && -n ${known[$key]-} ]] || return 1
  line=$2$'\t'${known[$key]#*$'\t'}
  stays "$2" && store "$1" "$2" "$line"
}
stays() { # N: whether $line needs no other try
  local status
  IFS=$'\t' read -r _ status _ <<<"$line"
  # what something else than the run ended is tried again
  ((status != 1 && status <= 128)) || return
  [[ -z $keep || $status != 0 || -e $keep/$(printf '%06d' "$1").tsv ]]
}
run_task() { # DIR: the share of a job of Slurm's array: each T-th that is open
  local n command line k=0 version
  local -A commands
  version=$(version)
  trap 'exit 130' INT TERM HUP
  while IFS=$'\t' read -r n command; do
    if ((k++ % SLURM_ARRAY_TASK_COUNT == SLURM_ARRAY_TASK_ID)); then
      commands[$n]=$command
      line=$(bash -c "$command") && store "$1" "$n" "$line" || exit 1
    fi
  done <"$1/open"
}

# --- all runs -----------------------------------------------------------------
take() { # LINE: of a run that is done
  local n=${1%%$'\t'*} status
  IFS=$'\t' read -r _ status _ <<<"$1"
  [[ -z ${line_of[n]-} ]] || return
  line_of[n]=$1
  finished=$((finished + 1))
  if ((status)); then failed=$((failed + 1)); fi
  if ((status == 1 || status > 128)); then again=$((again + 1)); fi
  print_rows
  progress
}
print_rows() { # those whose turn it is
  local n status message values
  while [[ -n ${line_of[next]-} ]]; do
    IFS=$'\t' read -r n status message values <<<"${line_of[next]}"
    line_of[next]=printed
    clear_line
    printf '%s\t%s\t%s\t%s\n' "${cells[next]}" "$status" \
      "${values:-$blank}" "$message" || written
    next=$((next + 1))
  done
}
progress() {
  ((shows)) || return
  local left='' done=$((finished - resumed))
  if ((done > 0)); then
    left="  $(((SECONDS - begun) * (runs - finished) / done)) s left"
  fi
  printf '\r%3d %%  %d of %d%s%s\033[K' $((100 * finished / runs)) $finished \
    "$runs" "$( ((failed)) && printf '  %d failed' "$failed")" "$left" >&2
  shown=1
}
interrupted() {
  trap '' INT TERM HUP
  stop
  die 5 "interrupted after $finished of $runs runs$goes_on"
}
stop() { # what runs
  if [[ -n ${job-} ]]; then scancel "$job" 2>/dev/null; fi
  if [[ -n ${group-} ]]; then
    kill -TERM -- "-$group" 2>/dev/null
    wait "$group" 2>/dev/null
  fi
}
# Starts the command in a process group of its own, so that it can be ended
# whole, with its output in $results.
start() {
  rm -f "$results"
  mkfifo "$results" || die 1 "$results: no pipe"
  set -m
  "$@" >"$results" </dev/null 9>&- &
  group=$!
  set +m
}
local_runs() {
  printf '%s\0' "${todo[@]}" | xargs -0 -n 1 -P "$jobs" bash -c
}
parallel_runs() {
  local hosts=() host
  for host in "${sshlogins[@]}"; do hosts+=(--sshlogin "$host"); done
  ((${#hosts[@]} == 0)) || hosts+=(--workdir "$PWD")
  printf '%s\n' "${todo[@]}" |
    PARALLEL_SHELL=/bin/bash parallel ${jobs:+-j "$jobs"} "${hosts[@]}"
}
collect() { # lines of runs that end
  local line
  while IFS= read -r line; do
    [[ $line == [0-9]*$'\t'[0-9]*$'\t'*$'\t'* ]] || continue
    store "$work" "${line%%$'\t'*}" "$line" ||
      { stop; die 1 "$work: a result could not be stored"; }
    take "$line"
  done <"$results"
  wait "$group"
  group=
}
slurm_runs() { # submits, and waits for files
  local most tasks words n
  most=$(scontrol show config 2>/dev/null |
    sed -n 's/^MaxArraySize *= *\([0-9]*\).*/\1/p')
  most=${most:-1001}
  tasks=$((${#todo[@]} < most ? ${#todo[@]} : most))
  read -ra words <<<"$sbatch"
  printf '%s\n' "${open[@]}" >"$work/open"
  start sbatch --parsable --wait --job-name=sweep --export=ALL \
    --array="0-$((tasks - 1))${jobs:+%$jobs}" --output="$work/task-%a.log" \
    "${words[@]}" --wrap "$(printf '%q ' "$self" --task "$work")"
  exec 3<"$results"
  IFS=';' read -r job _ <&3 ||
    { wait "$group"; die 1 'sbatch: no job was made'; }
  local running=1
  while ((running)); do
    kill -0 "$group" 2>/dev/null || running=0
    # once more after the end
    for n in "${numbers[@]}"; do
      [[ -z ${line_of[n]-} ]] || continue
      if stored "$work" "$n"; then take "$line"; fi
    done
    # sbatch looks every ten seconds only
    ((finished < runs)) || break
    ((!running)) || sleep 0.5
  done
  kill "$group" 2>/dev/null
  wait "$group" 2>/dev/null
  group='' job=''
}

sweep_all() {
  local table=$file name=$file n part line version
  [[ $file != - ]] || name='standard input'
  T=$(mktemp -d) || exit 1
  trap 'rm -rf "$T"' EXIT
  version=$(version)
  if [[ $file == - ]]; then
    [[ ! -t 0 ]] ||
      usage_error 'expected a table of runs on standard input or a file'
    table=$T/table
    cat >"$table" || exit 1
  fi
  [[ -r $table && ! -d $table ]] ||
    die 1 "$file: no such table, or it cannot be read"
  read_table "$table" "$name" >"$T/runs" || exit 3

  local verb verbs
  verbs=$(analyze --complete | grep -v '^-')
  for verb in "${measures[@]%%[[:blank:]]*}"; do
    [[ $verb == -* ]] || grep -qx -e "$verb" <<<"$verbs" ||
      usage_error "--measure '$verb': expected a verb of analyze"
  done
  # what the columns will be, and whether analyze can do what is asked
  settle --quiet --count 8 --time 0.01 >"$T/bed" || exit
  local message columns=() k taken
  if ! measure "$T/bed" "$T"; then
    die 2 "--measure '${measures[-1]}': $message"
  fi
  local -a cells=() line_of=() todo=() open=() numbers=()
  local -A commands known shelved
  IFS= read -r header <"$T/runs"
  header+=$'\tstatus'
  for k in "${!names[@]}"; do
    IFS=$'\t' read -ra part <<<"${names[k]}"
    for taken in "${part[@]}"; do
      [[ $'\t'$header$'\t'message$'\t' != *$'\t'"$taken"$'\t'* ]] ||
        taken+=.$((k + 1))
      header+=$'\t'$taken
      columns+=(nan)
    done
  done
  local IFS=$'\t'
  blank="${columns[*]}"
  IFS=$' \t\n'

  # the command line of each run
  local words=("$self") common m
  for m in "${measures[@]}"; do words+=(--measure "$m"); done
  [[ -z $keep ]] || words+=(--keep "$keep")
  common=$(printf '%q ' "${words[@]}")
  runs=0
  while IFS=$'\001' read -r line part; do
    runs=$((runs + 1))
    cells[runs]=$line
    commands[$runs]="$common--run $runs -- $settle$part"
  done < <(tail -n +2 "$T/runs")
  if ((dry)); then
    for ((n = 1; n <= runs; n++)); do
      printf '%s\n' "${commands[$n]}" || written
    done
    return
  fi

  # where results are kept
  kept=$work
  if [[ -z $work && $file != - ]]; then
    kept=${file##*/}
    kept=${kept%.tsv}.sweep
  fi
  local goes_on=${kept:+; the same command goes on}
  named=$work
  work=${kept:-$T/work}
  mkdir -p "$work" ${keep:+"$keep"} || die 1 "$work: it could not be made"
  [[ $work == /* ]] || work=$PWD/$work
  results=$T/results
  exec 9>"$work/lock"
  flock -n 9 || die 1 "$work: another sweep works there; see --work"

  local finished=0 failed=0 again=0 next=1 resumed=0 shows=0 begun=$SECONDS
  group='' job=''
  [[ ! -t 2 || -n $quiet ]] || shows=1
  words=(--settle "$settle")
  [[ -n $settle ]] || words=()
  for m in "${measures[@]}"; do words+=(--measure "$m"); done
  origin "${words[@]}" "$file" <"$T/bed"
  printf '%s\n' "$header"$'\tmessage' || written
  local aside=0
  recall "$work"
  put_aside "$work" || die 1 "$work: a result could not be stored"
  ((aside == 0)) || [[ -n $quiet ]] ||
    printf 'sweep: %s: %d results are of other options or another version %s\n' \
      "$work" $aside 'and are not used; they stay there' >&2
  for ((n = 1; n <= runs; n++)); do
    if known_line "$work" $n && stays $n; then
      take "$line"
    else
      rm -f "$work/$n.row"
      todo+=("${commands[$n]}")
      open+=("$n"$'\t'"${commands[$n]}")
      numbers+=("$n")
    fi
  done
  resumed=$finished
  trap interrupted INT TERM HUP
  if ((${#todo[@]})); then
    if [[ -n $slurm ]]; then
      slurm_runs
    elif [[ -n $parallel ]]; then
      start parallel_runs
      collect
    else
      start local_runs
      collect
    fi
  fi
  clear_line
  if ((finished < runs)); then
    die 1 "$((runs - finished)) of $runs runs ended without a result$goes_on"
  fi
  [[ -n $named ]] || ((again)) || rm -rf "$work"
  ((failed == 0)) ||
    die 4 "$failed of $runs runs failed; their rows have status and message"
}

# --- the command line ---------------------------------------------------------
file=- measures=() settle='' jobs=1 keep='' work='' parallel='' sshlogins=()
slurm='' sbatch='' dry=0 groups='' origin='' quiet='' run='' task='' operands=0
summarizes=''
for program in settle analyze; do
  command -v $program >/dev/null ||
    die 1 "$program: neither beside sweep nor in PATH"
done
while (($#)); do
  option=$1 value=${2-}
  case $option in
    --*=*) value=${option#*=} option=${option%%=*} given=1 ;;
    *) given=0 ;;
  esac
  case $option in
    --measure | --settle | --jobs | --keep | --work | --sshlogin | --sbatch | \
      --summary | --run | --task)
      ((given || $# > 1)) || usage_error "$option: expected a value"
      shift $((given ? 1 : 2))
      ;;
    *)
      ((!given)) || usage_error "$option: takes no value, or is no option"
      shift
      ;;
  esac
  case $option in
    --measure) measures+=("$value") ;;
    --settle) settle+=${settle:+ }$value ;;
    --jobs)
      [[ $value =~ ^[0-9]{1,6}$ ]] ||
        usage_error "--jobs $value: expected a whole number of at least 0"
      jobs=$((10#$value))
      ;;
    --keep | --work)
      [[ -n $value ]] || usage_error "$option: expected a directory"
      if [[ $option == --keep ]]; then keep=$value; else work=$value; fi
      ;;
    --parallel) parallel=1 ;;
    --sshlogin) sshlogins+=("$value") parallel=1 ;;
    --slurm) slurm=1 ;;
    --sbatch) sbatch+=${sbatch:+ }$value ;;
    --dry-run) dry=1 ;;
    --summary) groups=$value summarizes=1 ;;
    --origin) origin=1 ;;
    --quiet) quiet=1 ;;
    --run) run=$value ;;
    --task) task=$value ;;
    --version)
      printf 'sweep %s\n' "$(version)" || written
      exit
      ;;
    -h | --help) print_help || written; exit ;;
    --man) print_man || written; exit ;;
    --complete) print_complete || written; exit ;;
    --) break ;;
    -?*) usage_error "$option: no such option" ;;
    *)
      ((operands++ == 0)) || usage_error "'$option': expected one table"
      file=$option
      ;;
  esac
done
[[ -z $keep || $keep == /* ]] || keep=$PWD/$keep
((${#measures[@]})) || measures=(fraction)
if [[ -n $run ]]; then
  run_one "$@"
elif [[ -n $task ]]; then
  run_task "$task"
elif [[ -n $summarizes ]]; then
  [[ $file == - || -r $file && ! -d $file ]] ||
    die 1 "$file: no such table, or it cannot be read"
  [[ $file == - ]] && name='standard input' || name=$file
  origin --summary "$groups" "$file" </dev/null
  summarize "$groups" "$file" "$name"
  exit
else
  [[ -z $slurm || -z $parallel ]] ||
    usage_error '--slurm: expected without --parallel and --sshlogin'
  [[ -z $sbatch || -n $slurm ]] ||
    usage_error '--sbatch: expected --slurm as well'
  [[ -z $parallel ]] || command -v parallel >/dev/null ||
    die 1 'parallel: GNU parallel is not installed'
  [[ -z $slurm ]] || command -v sbatch >/dev/null ||
    die 1 'sbatch: Slurm is not installed'
  if ((jobs == 0)); then
    [[ -n $slurm || -n $parallel ]] && jobs= || jobs=$(nproc)
  fi
  sweep_all
fi
