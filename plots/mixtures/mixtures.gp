# SPDX-License-Identifier: GPL-3.0-or-later
# Frictionless mixtures: solid fraction against the volume share of the large of
# two sizes 4:1 (above), and against the spread of lognormal radii (below), with
# what others expect of hard spheres. Both panels have the same range of
# fractions.
#   gnuplot -c plots/mixtures/mixtures.gp MIXTURES OUT
# MIXTURES: columns kind, value, deviation, share, union, interval, rods,
# spread.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1000
columns = "kind value deviation union interval rods spread"
call "style.gp" "mixtures/mixtures.gp MIXTURES" ARG2 ARG1

of(what, name) = strcol("kind") eq what ? column(name) : NaN
set key samplen 1.7 width -1 maxrows 3
set multiplot
set lmargin 8.5
set rmargin 4
set yrange [*<0.55:0.8<*]
set ylabel "solid fraction (union)"
set tmargin at screen 0.985
set bmargin at screen 0.66
set xlabel "share of the large spheres in the volume"
set xrange [0.3:1]
unset key
plot ARG1 using (of("two", "value")):(of("two", "rods")) with linespoints \
    lw line pt 6 ps symbol lc rgb blue, \
  ARG1 using (of("two", "share")):(of("two", "union")):"interval" \
    with yerrorbars pt 7 ps symbol lw thin lc rgb vermillion, \
  ARG1 using (of("two", "share")):(of("two", "union")) with points \
    pt 7 ps symbol lc rgb vermillion
set tmargin at screen 0.565
set bmargin at screen 0.22
set xlabel "standard deviation of the radii by their mean"
set xrange [-0.02:0.35]
set key at screen 0.5,0.005 center bottom
plot ARG1 using (of("lognormal", "deviation")):(of("lognormal", "rods")) \
    with linespoints lw line pt 6 ps symbol lc rgb blue \
    title "Farr, Groot 2009", \
  ARG1 using (of("lognormal", "deviation")):(of("lognormal", "spread")) \
    with linespoints lw line dt 2 pt 4 ps symbol lc rgb black \
    title "Desmond, Weeks 2014", \
  ARG1 using (of("lognormal", "deviation")):(of("lognormal", "union")): \
    "interval" with yerrorbars pt 7 ps symbol lw thin lc rgb vermillion \
    notitle, \
  ARG1 using (of("lognormal", "deviation")):(of("lognormal", "union")) \
    with points pt 7 ps symbol lc rgb vermillion \
    title "settle; 95 % interval where there are several beds"
unset multiplot
