# SPDX-License-Identifier: GPL-3.0-or-later
# Errors of the impacts of Chung and Ooi against the tolerance (above), and what
# is left to a hard sphere's against psi times the speed (below).
#   gnuplot -c plots/precision/impacts.gp IMPACTS OUT
# IMPACTS: by plots/precision/impacts.sh.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 2
height = 900
columns = "kind test x error"
call "style.gp" "precision/impacts.gp IMPACTS" ARG2 ARG1

of(what, i) = strcol("kind") eq what && column("test") == i && \
  column("error") > 0 ? column("error") : NaN
colours = sprintf("%s %s %s %s %s %s %s %s", grey, black, orange, green, sky, \
  blue, purple, vermillion)
points = "3 6 5 7 9 11 4 13"
set logscale xy
set format "10^{%T}"
set multiplot
set lmargin at screen 0.17
set rmargin at screen 0.95
set tmargin at screen 0.985
set bmargin at screen 0.64
set xlabel "tolerance / speed of the impact"
set ylabel "relative error"
set xtics 100
set ytics 100
set mxtics 1
set mytics 1
set yrange [1e-15:1]
unset key
plot for [i=1:8] ARG1 using "x":(of("tolerance", i)) with linespoints \
  lw line pt int(word(points, i)) ps symbol lc rgb word(colours, i)
set tmargin at screen 0.535
set bmargin at screen 0.165
set xtics 10
set mxtics 10
set xlabel "{/:Italic ψ} × speed of the impact"
set ylabel "difference from a hard sphere"
set yrange [1e-12:1]
set key at screen 0.5,0.005 center bottom maxrows 2
plot for [i=1:8] keyentry with linespoints lw line pt int(word(points, i)) \
    ps symbol lc rgb word(colours, i) title "test ".i, \
  for [i=3:8] ARG1 using "x":(of("limit", i)) with linespoints lw line \
    pt int(word(points, i)) ps symbol lc rgb word(colours, i) notitle, \
  2/x with lines lw 1.5*thin dt 2 lc rgb grey notitle
unset multiplot
