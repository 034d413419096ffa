# SPDX-License-Identifier: GPL-3.0-or-later
# A bed from the side, each sphere coloured by how many steps of its own it took
# in a span of time: while the first spheres hit the floor, and while the bed
# closes.
#   gnuplot -c plots/stability/steps.gp IMPACT BED OUT
# IMPACT, BED: stability steps.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 0
height = 760
columns = "x y z r steps"
call "style.gp" "stability/steps.gp IMPACT BED OUT" ARG3 ARG1 ARG2

# the nearest are drawn last
sorted(in) = "<awk '/^#/ || !NF { next } !n++ { print; next } { print | ". \
  "\"sort -t \\\"\\t\\\" -k 2,2gr\" }' '".in."'"
top = 0
do for [in in ARG1." ".ARG2] {
  stats in using "steps" nooutput
  least = exists("least") && least < STATS_min ? least : STATS_min
  most = exists("most") && most > STATS_max ? most : STATS_max
  stats in using "z" nooutput
  top = STATS_max > top ? STATS_max : top
}
unset key
unset grid
set style fill solid 1 border rgb "#555555"
set logscale cb
set cbrange [least:most]
set cbtics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
set palette defined (0 "#F7F4E9", 0.35 sky, 0.7 blue, 1 vermillion)
set size ratio -1
set yrange [0:1.04*top]
set xtics 0,0.5
set xlabel "x (m)"
set multiplot
do for [p=1:2] {
  in = p == 1 ? ARG1 : ARG2
  stats sorted(in) using "x" nooutput
  set xrange [0:STATS_max > 0.45 ? 1 : 0.5]
  set lmargin at screen p == 1 ? 0.10 : 0.47
  set rmargin at screen p == 1 ? 0.44 : 0.81
  set tmargin at screen 0.97
  set bmargin at screen 0.09
  set ylabel p == 1 ? "z (m)" : ""
  set format y p == 1 ? "%h" : ""
  set title header(in, "from")." to ".header(in, "to")." s" offset 0,-0.8
  if (p == 2) {
    set colorbox user origin screen 0.84,0.1 size screen 0.03,0.81
    set cblabel "steps of its own" offset 0.5,0
  } else { unset colorbox }
  plot sorted(in) using "x":"z":"r":"steps" with circles fillcolor palette
}
unset multiplot
