# SPDX-License-Identifier: GPL-3.0-or-later
# The error budget: the error of the union that each source leaves against the
# CPU time that it takes, of a bed or, for chance, of all beds of the mean.
#   gnuplot -c plots/beds/budget.gp BUDGET OUT
# Columns source, setting, cpu, error, uncertainty, limit; errors that are less
# than their uncertainty are arrows from it.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 640
columns = "source setting cpu error uncertainty limit"
call "style.gp" "beds/budget.gp BUDGET OUT" ARG2 ARG1

sources = "softness walls creep not_at_rest chance integration"
name(k) = k == 4 ? "not at rest" : word(sources, k)
of(k, known) = strcol("source") eq name(k) && column("limit") == (known ? 0 : 1) ? \
  column("error") : NaN
colour(k) = word(vermillion." ".purple." ".orange." ".green." ".black." ".blue, k)
point(k) = int(word("7 5 9 11 13 15", k))
set logscale xy
set format y "10^{%T}"
set format x "%g"
set xlabel "CPU time (s)"
set ylabel "error of the union"
set xrange [*<0.1:60<*]
set yrange [1e-4:0.1<*]
set lmargin at screen 0.16
# of any source, by name: its number and its colour as one
number_of(s) = s eq "softness" ? 1 : s eq "walls" ? 2 : s eq "creep" ? 3 : \
  s eq "not at rest" ? 4 : s eq "chance" ? 5 : 6
rgb(s) = int(word("13983232 13400487 15113984 40563 0 29362", number_of(s)))
all(known) = column("limit") == (known ? 0 : 1) ? column("error") : NaN
plot for [k=1:6] ARG1 using "cpu":(of(k, 1)) with linespoints pt point(k) \
    ps symbol lw line lc rgb colour(k) title name(k), \
  ARG1 using "cpu":(all(1)):(sprintf("%g", column("setting"))): \
    (rgb(strcol("source"))) with labels left offset 0.6,0.35 font ",13" \
    tc rgb variable notitle, \
  ARG1 using "cpu":(all(0)):(0):(-0.4*column("error")):(rgb(strcol("source"))) \
    with vectors lw thin lc rgb variable notitle, \
  ARG1 using "cpu":(all(0)):(sprintf("%g", column("setting"))): \
    (rgb(strcol("source"))) with labels left offset 0.6,0 font ",13" \
    tc rgb variable notitle
