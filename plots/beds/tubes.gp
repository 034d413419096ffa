# SPDX-License-Identifier: GPL-3.0-or-later
# Void share of tubes: against the distance from the wall (above), and the mean of
# the section against the width of the tube, with what others found (below).
# Lengths in diameters. Each panel has its own legend.
#   gnuplot -c plots/beds/tubes.gp PROFILE SIZE OUT
# PROFILE: columns N, distance, void, interval, a block for each N.
# SIZE: columns N, seeds, void, standard error.
# docs/walls.md has the sources of the formulas.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1000
columns = "N void"
call "style.gp" "beds/tubes.gp PROFILE SIZE OUT" ARG3 ARG1 ARG2

bulk = 0.36
de_klerk(z) = z <= 0.637 ? 2.14*z**2 - 2.53*z + 1 : \
  bulk + 0.29*exp(-0.6*z)*cos(2.3*pi*(z - 0.16)) + 0.15*exp(-0.9*z)
dixon(N) = 0.4 + 0.05/N + 0.412/N**2
zou_yu(N) = 0.400 + 0.010*(exp(10.686/N) - 1)
benyahia(N) = 0.390 + 1.740/(N + 1.140)**2

stats ARG1 using (blocks = column(-2) + 1) nooutput
array size[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (size[b] = column("N"), 0) nooutput
}
array colour[3] = [vermillion, green, blue]
array dash[3] = [2, 4, 1]

set key samplen 2 maxrows 2
set multiplot
set tmargin at screen 0.985
set bmargin at screen 0.66
set xlabel "distance from the wall (diameters)"
set ylabel "void share"
set xrange [0:4]
set yrange [0:1]
set key at screen 0.53,0.545 center bottom
plot for [b=1:blocks] ARG1 index b-1 using "distance":"void" with lines \
    lw line dt dash[b] lc rgb colour[b] title sprintf("tube of %g", size[b]), \
  [0:4] de_klerk(x) with lines lw line dt 3 lc rgb black title "de Klerk 2003"
set tmargin at screen 0.5
set bmargin at screen 0.17
set xlabel "width of the tube (diameters)"
set logscale x
set xrange [1.8:22]
set yrange [0.36:0.6]
set xtics (2, 3, 4, 5, 7, 10, 15, 20)
set key at screen 0.53,0.01 center bottom maxrows 2
plot ARG2 using "N":"void":"standard error" with yerrorbars pt 7 ps symbol \
    lw thin lc rgb blue title "settled, standard error", \
  [1.8:22] benyahia(x) with lines lw line dt 1 lc rgb sky \
    title "Benyahia, O'Neill 2005", \
  [4:22] zou_yu(x) with lines lw line dt 2 lc rgb green \
    title "Zou, Yu 1995, loose", \
  [1.8:22] dixon(x) with lines lw line dt 4 lc rgb purple title "Dixon 1988"
unset multiplot
