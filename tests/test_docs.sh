#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The pages are in step with the captions they include, every file and every
# function that they name is there, every command that they print runs and says
# what is printed, and every option and target of make that they mention exists.
. tests/harness.sh
shopt -s extglob

report() { # NAME STATUS
  check "$1" test "$2" = 0
}

pages="README.md CONTRIBUTING.md docs/*.md"

# Captions and links
headings() { # PAGE: its headings as links name them
  sed -n 's/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' |
    sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}
included=0
for page in $pages; do
  awk -f plots/captions.awk "$page" | cmp -s - "$page"
  report "$page: captions are not those of docs/ (make readme)" $?
  n=$(grep -c '^<!-- docs/' "$page")
  included=$((included + n))
  dir=$(dirname "$page")
  for link in $(grep -oE '\]\([^) ]*\)' "$page" | tr -d '()]' | grep -v ://); do
    file=${link%%#*}
    if [ -z "$file" ]; then
      file=$page
    elif [ -e "$dir/$file" ]; then
      file=$dir/$file
    fi # else a caption's, whose links are from the page that includes it
    [ -e "$file" ]
    report "$page: no file $link" $?
    [[ $link != *#* ]] || headings "$file" | grep -qx -- "${link#*#}"
    report "$page: no heading $link" $?
  done
done
((included > 0))
report 'no page includes a caption' $?
printf '<!-- docs/none.md -->\n<!-- end -->\n' > "$T/page"
! awk -f plots/captions.awk "$T/page" > /dev/null 2>&1
report 'a missing caption passes' $?

# Paths of the sources, and names said to be in them: `NAME` in `PATH`
code() { # PAGE: the text between backticks, a line each
  tr '\n' ' ' < "$1" | grep -o '`[^`]*`' | tr -d '`'
}
rooms='^(\.ci|common|settle|sweep|bounce|analyze|precision|stability|plots|tests|docs)/'
paths=0
for page in $pages; do
  for path in $(code "$page" | grep -E "$rooms[^ ]*$" | grep -v '[A-Z]'); do
    paths=$((paths + 1))
    [ -e "$path" ]
    report "$page: no file $path" $?
  done
  while read -r name path; do
    grep -q "\<$name\>" "$path"
    report "$page: no $name in $path" $?
  done < <(tr '\n' ' ' < "$page" | grep -oE '`[a-z0-9_.]+` in `[^`]+`' |
    tr -d '`' | sed 's/ in / /')
done
((paths > 10))
report "$paths paths found in the pages" $?

# Options: of each program and verb, by its help
options_of() { # PROGRAM [VERB]: its options, a line each
  local help=$T/help-${1##*/}-${2-}
  [ -e "$help" ] ||
    "$B/$1" ${2+"$2"} --help 2> /dev/null | grep -oE -- '^  (-h, )?--[a-z-]+' |
    grep -o -- '--.*' > "$help"
  cat "$help"
}
verbs=$("$B/analyze" --complete | grep -v '^--')
((${#verbs} > 0))
report 'analyze --help lists no verbs' $?
make -s "$B/precision" "$B/stability" B="$B" > "$T/log" 2>&1
report 'precision and stability cannot be built' $?
scenes() { # PROGRAM of a study: its scenes
  "$B/$1" --help | sed -n 's/^  \([a-z-]*\)  *[^ ].*/\1/p' | grep -v '^-'
}

known_options() { # PAGE COMMAND: every --option of a command is in its help
  local word words verb option unknown=
  read -ra words <<< "$2"
  verb=
  case ${words[0]} in
  analyze | precision | stability)
    [[ ${words[1]-} == [a-z]* && ${words[1]} != *.* ]] && verb=${words[1]}
    ;;
  esac
  for word in "${words[@]:1}"; do
    [[ $word == --[a-z]* ]] || continue
    option=${word%%=*}
    options_of "${words[0]}" $verb | grep -qx -- "$option" ||
      [[ $option == --help || $option == --version ]] || unknown+=" $option"
  done
  [ -z "$unknown" ]
  report "$1: '$2': unknown:$unknown" $?
}

for program in settle bounce analyze sweep; do
  options_of $program
done > "$T/all"
for verb in $verbs; do
  options_of analyze "$verb"
done >> "$T/all"
for study in precision stability; do
  for scene in $(scenes $study); do
    options_of $study "$scene"
  done
done >> "$T/all"
make help > "$T/targets"
mentioned=0
for page in $pages; do
  while read -r span; do
    case ${span#build/} in
    settle\ * | sweep\ * | bounce\ * | analyze\ * | precision\ * | stability\ *)
      known_options "$page" "${span#build/}"
      ;;
    --[a-z]*)
      for option in $(grep -oE -- '(^| )--[a-z-]+' <<< "$span"); do
        grep -qx -- "$option" "$T/all"
        report "$page: no program has $option" $?
        mentioned=$((mentioned + 1))
      done
      ;;
    make\ *)
      for word in ${span#make }; do
        [[ $word == *[/=A-Z]* ]] || grep -q "^$word " "$T/targets"
        report "$page: make help has no $word" $?
      done
      ;;
    esac
  done < <(code "$page" | grep -v '\.\.\. *[a-z]')
done
((mentioned > 50))
report "$mentioned options found in the pages" $?

# Commands: the indented lines that begin with a program, joined with what
# continues them; lines that follow are what it prints, where ... stands for
# anything.
commands() { # PAGE: a line each: command, then \x01 and a line of output, ...
  awk '
    function flush() { if (command != "") print command output
                       command = output = ""; more = 0 }
    !/^    / { flush(); next }
    {
      line = substr($0, 5)
      text = line
      sub(/  +#.*/, "", text)
      if (more) {
        command = command " " text
      } else if (line ~ /^(settle|sweep|bounce|analyze|make|gzip|printf|gnuplot) /) {
        flush()
        command = text
      } else if (command != "") {
        output = output "\001" line
        next
      } else next
      more = text ~ /(\\|\|)$/
      sub(/\\$/, "", command)
    }
    END { flush() }' "$1"
}

# What takes minutes, and the form that the test runs instead.
shorter() { # COMMAND
  case $1 in
  # 2,000 spheres to 8 s
  'settle --count 2000 --base 2,5 '*) echo "${1/ --base 2,5/ --base 2,5 --time 0.001}" ;;
  # 0.9 s for each picture of a movie
  *'| analyze movie '*) echo "${1/--frames 81/--frames 2}" ;;
  # 8 million voxels: seconds and 64 MB
  *' --cells 200 '*) echo "${1/--cells 200/--cells 20}" ;;
  # 800 hard spheres: 14 s to 8 s
  'settle --overlap 0.003 '*) echo "${1/ --count 800/ --count 800 --time 0.001}" ;;
  # hard beds to rest: up to 13 s
  *' --until-rest --time 20 '*) echo "${1/ --until-rest --time 20/ --time 0.001}" ;;
  # four beds of 200 spheres each
  'sweep runs.tsv '*) echo "sweep --settle '--count 40 --time 0.1' ${1#sweep }" ;;
  # other machines
  'sweep --slurm '* | 'sweep --sshlogin '*) echo true ;;
  # the tests themselves, and packages
  make\ *) echo "make -n -C '$PWD' ${1#make }" ;;
  *) echo "$1" ;;
  esac
}

# Files that the reader of a page has, made from the bed that the page makes.
provide() { # COMMAND
  case $1 in
  *' dump.lammps'*)
    analyze export --format lammps bed.tsv > dump.lammps
    ;;
  *' positions.xyz'*)
    analyze export --format positions bed.tsv |
      awk '{ row[NR] = "C " $0 } END { print NR "\n"
        for (i = 1; i <= NR; i++) print row[i] }' > positions.xyz
    ;;
  *' plain.txt'*)
    analyze export --format csv bed.tsv | tr , ' ' |
      awk 'NR > 1 { print $2, $3, $4, $5, 2 * $6 }' > plain.txt
    ;;
  *' run.csv.gz'*)
    analyze export --format csv bed.tsv | gzip > run.csv.gz
    ;;
  esac
}

programs=$(cd "$B" && pwd)
ran=0 printed=0
run_page() { # PAGE
  local page=$1 line command wanted got i
  mkdir -p "$T/run/$page"
  while IFS= read -r line; do
    IFS=$'\001' read -ra wanted <<< "$line"
    command=$(shorter "${wanted[0]}")
    ran=$((ran + 1))
    got=$(
      cd "$T/run/$page" || exit
      PATH=$programs:$PATH
      provide "$command"
      set -o pipefail
      export -n B
      eval "$command" 2> "$T/err"
    )
    report "$page: $command: exit status $?" $?
    : > "$T/err"
    mapfile -t got <<< "$got"
    for ((i = 1; i < ${#wanted[@]}; i++)); do
      printed=$((printed + 1))
      # the pattern is the line with ... for anything
      # shellcheck disable=SC2053
      [[ ${got[i - 1]-} == ${wanted[i]//.../*} ]]
      report "$page: ${wanted[0]}: '${got[i - 1]-}', printed '${wanted[i]}'" $?
    done
  done < <(commands "$page")
}
for page in $pages; do
  run_page "$page"
done
((ran >= 30 && printed >= 4))
report "$ran commands and $printed lines of output found in the pages" $?
check_done
