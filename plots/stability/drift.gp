# SPDX-License-Identifier: GPL-3.0-or-later
# Relative error of the energy over time, one curve per method at equal cost.
# Upper panel: a bouncing sphere at its apexes; lower: a closed box, the largest
# error of each stretch.
#   gnuplot -c plots/stability/drift.gp BOUNCE BOX OUT
# IN: columns method units error largest status.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 860
columns = "method units error largest status"
call "style.gp" "stability/drift.gp BOUNCE BOX OUT" ARG3 ARG1 ARG2

methods = "merson dopri5 rkf45 rkck rk8pd rkc verlet"
tics(low, high) = log10(high/low) > 9 ? 1000 : log10(high/low) > 4.5 ? 100 : 10
of(m) = strcol("method") eq m
set lmargin at screen 0.19
set logscale xy
set format y "10^{%T}"
set xtics 10
set multiplot
unset key
do for [p=1:2] {
  in = value("ARG".p)
  name = p == 1 ? "error" : "largest"
  set tmargin at screen p == 1 ? 0.98 : 0.54
  set bmargin at screen p == 1 ? 0.64 : 0.20
  set autoscale
  stats in using (abs(column(name)) > 0 ? abs(column(name)) : NaN) nooutput
  low = 10**floor(log10(STATS_min))
  high = 10**ceil(log10(STATS_max))
  stats in using "units" nooutput
  set xrange [0.8:1.05*STATS_max]
  set yrange [low:high]
  set ytics tics(low, high)
  set mytics tics(low, high) == 10 ? 10 : 1
  set xlabel p == 1 ? "bounces" : "time in the box (s)"
  set ylabel p == 1 ? "relative energy error, apex" : "largest relative error"
  if (p == 2) {
    set key at screen 0.5,0.01 center bottom vertical maxrows key_rows
  }
  plot for [m in methods] in using (of(m) ? column("units") : NaN): \
      (abs(column(name))) with lines lw line lc rgb method_colour(m) notitle, \
    for [m in methods] in every 4 using (of(m) ? column("units") : NaN): \
      (abs(column(name))) with points pt method_point(m) ps symbol \
      lc rgb method_colour(m) notitle, \
    sqrt(low*high)/30*x with lines lw thin dt 2 lc rgb grey notitle, \
    for [m in methods] keyentry with linespoints lw line \
      pt method_point(m) ps symbol lc rgb method_colour(m) \
      title p == 2 ? method_title(m) : "", \
    keyentry with lines lw thin dt 2 lc rgb grey \
      title p == 2 ? "∝ time" : ""
}
unset multiplot
