#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every target of `make help` that makes figures or tables, in its small form
# (QUICK=1): each picture has its size, something is drawn and nothing cut off,
# each table has its rows; and what the pages say is in the data
# (tests/figures_*.sh). Run from the root of the repository; B is the directory
# of the programs.
. tests/harness.sh

# What a target makes: figures by name, and tables with their least number of
# rows.
declare -A makes=(
  [fig4.1]='fig4.1.svg' [fig4.2]='fig4.2.png' [fig4.3]='fig4.3.svg'
  [fig4.3-rkc]='fig4.3-rkc.svg fig4.3-rkc.md:8' [fig4.4]='fig4.4.svg'
  [fig4.5]='fig4.5.svg' [table4.1]='table4.1.md:9' [table-costs]='table-costs.md:15'
  [kappa]='kappa.md:3' [figures]=''
  [fig-gr]='gr.svg' [structure]='structure.md:2'
  [softness]='hardness.svg budget.svg softness.md:8 softness-limits.md:2'
  [table-radius]='table-radius.md:8' [fig-walls]='walls.svg walls.md:10'
  [fig-tubes]='tubes.svg tubes.md:2' [fig-bulk]='bulk.svg bulk.md:2'
  [real-beds]='real.md:5'
  [fig-hardening]='hardening.svg hardening.md:4'
  [fig-handover]='handover.svg' [fig-friction]='friction.svg'
  [fig-mixtures]='mixtures.svg mixtures.md:4'
  [precision]='precision-bounce-150-time-evaluations.svg
    precision-rolling-steps-velocity-step.svg precision-contrast.svg
    precision-work.md:60
    precision-orders.md:14'
  [impacts]='impacts.svg'
  [settling]='precision-settling.svg precision-settling.md:18'
  [seeds]='precision-seeds.md:3'
  [tolerance]='precision-tolerance.svg precision-tolerance.md:16'
  [trajectories]='precision-trajectory-8-position-evaluations.svg
    precision-trajectory-8-position-cpu_seconds.svg
    precision-trajectory-8-basic-position-evaluations.svg
    precision-trajectory-8-basic-position-cpu_seconds.svg
    precision-horizon.svg'
  [stability-map]='stability-map.svg' [stability]=''
  [stability-regions]='stability-regions.svg stability-limits.md:17'
  [stability-tunnel]='stability-tunnel.svg stability-tunnel.md:24'
  [stability-drift]='stability-drift.svg' [stability-creep]='stability-creep.svg'
  [stability-cut]='stability-cut.svg' [stability-steps]='stability-steps.svg'
  [stability-vibration]='stability-vibration.svg'
  [stability-wrong-bed]='stability-wrong-bed.svg'
  [bench]='bench.svg bench.md:24 scaling.svg scaling.md:2'
  [features]='features.md:9'
  [bench-peers]='peers.md:2' [growth]='growth.svg growth.md:6'
  [growth-rest]='growth-rest.svg growth-rest.md:4'
)
# Targets that make no figure; bench-clean comes last.
others=' all check clients fuzz deps demo install uninstall clean help readme'
others+=' docs-figures bench-clean'
others+=' lammps torture threads load million valgrind mutants fuzz-programs sanitize tidy check-long check-quick deps-developer man '

targets=()
while read -r target _; do
  if [[ -v makes[$target] ]]; then
    targets+=("$target")
  else
    check "make help: $target is neither in makes nor in others" \
      grep -q " $target " <<<"$others"
  fi
done < <(make -s --no-print-directory help)
check 'all figures are in make help' test ${#targets[@]} = ${#makes[@]}

quick() {
  make -s QUICK=1 B="$B" D="$T/data" F="$F" "$@"
}

F=$T/figures
charts=1
if ! command -v gnuplot >/dev/null; then
  echo 'skipped: no gnuplot, so data and tables are made, but no charts'
  charts=0
fi
if ((charts)); then
  quick -k -j "$(nproc)" "${targets[@]}" >"$T/log" 2>&1
  check 'make QUICK=1' test $? = 0 || grep -a '\*\*\*' "$T/log" >&2
else
  read -r -a data <<<"$(printf '%s\n' ${makes[*]} | grep '\.md')"
  quick -k -j "$(nproc)" "${data[@]/#/$F/}" >"$T/log" 2>&1
  check 'make QUICK=1' test $? = 0 || grep -a '\*\*\*' "$T/log" >&2
fi
grep -a '^peers.sh: no' "$T/log" | sed 's/^/skipped: /'

# look PNG: its width and height, and of its pixels the shares (%) of those that
# are not white and that have a colour, and the number of dark ones on its edge
look() {
  local size
  read -r -a size < <(od -A n -t u1 -j 16 -N 8 "$1" | awk '{
    print $1 * 2^24 + $2 * 65536 + $3 * 256 + $4,
      $5 * 2^24 + $6 * 65536 + $7 * 256 + $8 }')
  gnuplot 2>/dev/null <<END
set terminal unknown
columns = ${size[0]}
rows = ${size[1]}
n = ink = colour = edge = 0
count(r, g, b) = (n = n + 1, dark = r + g + b < 750, ink = ink + dark, \
  colour = colour + (dark && (abs(r - g) > 30 || abs(g - b) > 30)), \
  edge = edge + (dark && (n <= columns || n > columns*(rows - 1) || \
  n % columns < 2)), 0)
plot "$1" binary filetype=png using (count(\$1, \$2, \$3)):2:3 with rgbimage
set print "-"
print sprintf("%d %d %.3f %.3f %d", columns, rows, 100.*ink/n, 100.*colour/n, edge)
END
}

table_rows() { # FILE: rows of its tables, all with as many cells as their head
  awk -F '|' '!/^\|/ { head = 0; next } /^\|---/ { next }
    !head { head = NF; next } { n++; ragged += NF != head }
    END { print ragged ? "ragged" : n }' "$1"
}

for product in ${makes[*]}; do
  figure=$F/${product%.*}
  if [[ $product == *.md:* ]]; then
    within "$product: rows" "$(table_rows "$F/${product%:*}")" \
      "${product#*:}" 1000
    continue
  fi
  ((charts)) || continue
  read -r width height ink colour edge < <(look "$figure.png")
  expected='700 800' # of a figure without SVG
  if [[ $product == *.svg ]]; then
    expected=$(sed -n 's/.*<svg.* width="\([0-9]*\)" height="\([0-9]*\)".*/\1 \2/p
      s/^ width="\([0-9]*\)" height="\([0-9]*\)".*/\1 \2/p' "$figure.svg" |
      head -n 1)
    check "$product is a whole picture" grep -q '</svg>' "$figure.svg"
  fi
  check "$product: size is $width x $height, expected $expected" \
    test "$width $height" = "$expected"
  within "$product: ink (%)" "${ink:-none}" 1.5 99
  within "$product: colour (%)" "${colour:-none}" 0.05 99
  within "$product: dark pixels on the edge" "${edge:-none}" 0 0
done
# what the small figures say that they are
if ((charts)); then
  check 'settling: axis says what was run' \
    grep -q '2 s of 40 spheres' "$F/precision-settling.svg"
  check 'bench: axis says what was run' \
    grep -q '1 s of 16 spheres' "$F/bench.svg"
fi
# the test of pictures itself
if ((charts)); then
  gnuplot <<END
set terminal pngcairo size 64,48
set output "$T/blank.png"
unset tics; unset border; unset key
plot [0:1] [0:1] 2
set output "$T/cut.png"
set margins 0,0,0,0
set border
plot [0:1] [0:1] x lw 9
END
  check 'a blank picture is seen' test \
    "$(look "$T/blank.png")" = '64 48 0.000 0.000 0'
  check 'a picture that is cut off is seen' awk \
    -v e="$(look "$T/cut.png" | cut -d ' ' -f 5)" 'BEGIN { exit !(e > 60) }'
fi

for part in tests/figures_*.sh; do
  . "$part"
done

quick bench-clean
check 'bench-clean' test ! -e "$T/data/bench"
check_done
