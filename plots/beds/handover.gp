# SPDX-License-Identifier: GPL-3.0-or-later
# What meshers' gaps (above) and bridges (below) do to the solid fraction of the
# paper's bed: its exact change against their size, one curve for each radius
# that the geometry may have. Lengths in diameters of the dynamics.
#   gnuplot -c plots/beds/handover.gp IN OUT
# IN: columns what, keep, x, fraction, change.
set loadpath system("dirname '".ARG0."'")."/.."
height = 900
columns = "what keep x change"
call "style.gp" "beds/handover.gp IN OUT" ARG2 ARG1

keeps = "nominal contact-mean touching"
colours = vermillion." ".blue." ".green
of(what, keep) = strcol("what") eq what && strcol("keep") eq keep ? \
  column("change") : NaN

set logscale x
set xrange [0.004:0.25]
set xtics (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
set multiplot
set lmargin at screen 0.18
set rmargin at screen 0.97
set tmargin at screen 0.985
set bmargin at screen 0.605
set xlabel "gap between spheres (diameters)"
set ylabel "change of the solid fraction"
set yrange [-0.45:0.02]
unset key
plot for [k=1:3] ARG1 using "x":(of("gap", word(keeps, k))) with linespoints \
  lw line pt 2*k+3 ps symbol lc rgb word(colours, k)
set tmargin at screen 0.48
set bmargin at screen 0.15
set xlabel "radius of bridges (diameters)"
set logscale y
set yrange [1e-8:1]
set ytics 100
unset mytics
set format y "10^{%T}"
set key at screen 0.55,0.01 center bottom maxrows 1 samplen 2
plot for [k=1:3] ARG1 using "x":(of("bridge", word(keeps, k))) \
  with linespoints lw line pt 2*k+3 ps symbol lc rgb word(colours, k) \
  title word(keeps, k)
unset multiplot
