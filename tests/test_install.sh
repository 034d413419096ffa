#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make install into a place of its own, what is there and works from there, and
# make uninstall down to nothing.
. tests/harness.sh
unset DEM_PLOTS

P=$T/root/opt/beds # DESTDIR, PREFIX
make_() {
  make -s B="$B" DESTDIR="$T/root" PREFIX=/opt/beds "$@" >"$T/log" 2>&1
}
check 'make install' make_ install || cat "$T/log"
verbs=$("$B/analyze" --complete | grep -v '^-')
check 'there are verbs' test "$(wc -w <<<"$verbs")" -ge 10

# --- the programs, from elsewhere ---------------------------------------------
cd "$T" || exit 1
PATH=$P/bin:$PATH
settle --quiet --count 8 --base 0.4,0.4 --time 0.2 >bed.tsv 2>err
check 'settle | analyze' test "$(analyze bed.tsv | wc -l)" = 2
check 'sweep' test "$(printf 'seed\n1\n2\n' | sweep --settle \
  '--count 8 --base 0.4,0.4 --time 0.2' 2>err | wc -l)" = 3
check 'bounce' test "$(bounce --rebound | tail -n 1 | wc -w)" = 6
if command -v gnuplot >/dev/null; then
  analyze draw --output bed.png bed.tsv 2>err
  check 'draw' test "$(head -c 4 bed.png | od -An -c | tr -d ' ')" = '211PNG'
else
  echo 'skipped: draw from where it is installed (gnuplot is not installed)'
fi
mv "$P/share/dem/plots" away
analyze draw --output none.png bed.tsv 2>err
check 'draw takes its scripts from there and from nowhere else' test $? = 1 -a \
  "$(grep -c 'bed.gp: not found in share/dem/plots' err)" = 1
mv away "$P/share/dem/plots"
: >err

# --- man pages ----------------------------------------------------------------
pages=0
page() { # NAME COMMAND...: has a name, all of its options, and is for roff
  local file=$P/share/man/man1/$1.1 option
  pages=$((pages + 1))
  check "man $1" test -s "$file"
  check "man $1: title and name" test "$(sed -n '1s/ .*//p; 3p' "$file" |
    tr -d '\\' | grep -c -e '^\.TH$' -e "^$1 - [a-zA-Z].*")" = 2
  sed "s/\\\\f[BIR]//g; s/\\\\-/-/g" "$file" >plain
  for option in $("${@:2}" --help | grep -oE '^  (-h, )?--[a-z0-9-]+' |
    grep -o -e '--.*'); do
    check "man $1: $option" grep -Eq -e "^(-h, )?$option( |\$)" plain
  done
  if command -v groff >/dev/null; then
    check "man $1: roff without a warning" test -z \
      "$(groff -man -Tutf8 -ww "$file" 2>&1 >/dev/null)"
  fi
}
command -v groff >/dev/null ||
  echo 'skipped: man pages through roff (groff is not installed)'
for program in settle bounce analyze sweep; do
  page $program $program
done
for verb in $verbs; do
  page "analyze-$verb" analyze "$verb"
  check "analyze names $verb" grep -q "^\.BR analyze.*-$verb (1)" \
    "$P/share/man/man1/analyze.1"
done
check 'a page each and no more' test \
  "$(find "$P/share/man/man1" -type f | wc -l)" = $pages

# --- the pages that warnings name ---------------------------------------------
for name in $(grep -ahoE 'docs/[a-z-]+\.md' "$P"/bin/* | sort -u); do
  check "$name is there" test -s "$P/share/doc/dem/$name"
done
check 'warnings name pages' test -n \
  "$(grep -aoE 'docs/[a-z-]+\.md' "$P/bin/settle")"
for picture in $(grep -ohE '\(([a-z0-9.-]+\.png)\)' "$P"/share/doc/dem/docs/*.md |
  tr -d '()' | sort -u); do
  check "$picture, which a page shows" test -s \
    "$P/share/doc/dem/docs/$picture"
done

# --- completion ---------------------------------------------------------------
complete_() { # WORD...: what bash would offer for the last one
  . "$P/share/bash-completion/completions/$1"
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  local function
  function=$(complete -p "$1" | grep -o -e '-F [^ ]*' | cut -d ' ' -f 2)
  "$function"
  tr ' ' '\n' <<<"${COMPREPLY[*]}" | sort | tr '\n' ' '
}
check 'an option' test "$(complete_ settle --rest)" = '--restitution '
check 'two options' test "$(complete_ bounce --re)" = \
  '--rebound --reltol --restitution '
check 'choices' test "$(complete_ settle --model '')" = \
  'basic friction rotation '
check 'choices after =' test "$(complete_ settle --model = fr)" = 'friction '
check 'choices right after =' test "$(complete_ settle --model =)" = \
  'basic friction rotation '
check 'a file for a text' test "$(complete_ settle --scene bed.t)" = 'bed.tsv '
check 'nothing for a number' test "$(complete_ settle --kappa b)" = ' '
check 'an option of sweep' test "$(complete_ sweep --meas)" = '--measure '
check 'a verb' test "$(complete_ analyze contac)" = 'contacts '
check 'a file or a verb' test "$(complete_ analyze be)" = "bed.png bed.tsv " -o \
  "$(complete_ analyze be)" = 'bed.tsv '
check "a verb's option" test "$(complete_ analyze contacts --netw)" = \
  '--network '
check "a verb's choices" test "$(complete_ analyze export --format lammps)" = \
  'lammps lammps-data '
check "not another verb's" test "$(complete_ analyze contacts --form)" = ' '
check 'a file after a flag' test "$(complete_ analyze rest --quiet bed.t)" = \
  'bed.tsv '

# --- uninstall ----------------------------------------------------------------
cd "$OLDPWD" || exit 1
echo other >"$P/bin/other"
check 'make uninstall' make_ uninstall || cat "$T/log"
check 'what others have there stays' test \
  "$(find "$T/root" -type f)" = "$P/bin/other"
rm "$P/bin/other"
check 'make install, again' make_ install
check 'make uninstall, again' make_ uninstall
check 'nothing is left' test -z "$(find "$T/root" -mindepth 2)"
# outside of a DESTDIR the folders are others'
check 'make install PREFIX' make -s B="$B" PREFIX="$P" install >"$T/log" 2>&1
check 'make uninstall PREFIX' make -s B="$B" PREFIX="$P" uninstall \
  >"$T/log" 2>&1
check 'bin and man1 stay, nothing in them' test -d "$P/bin" -a \
  -d "$P/share/man/man1" -a -z "$(find "$P" -type f)"
check 'no folder of ours' test -z "$(find "$P" -name 'dem*')"
check_done
