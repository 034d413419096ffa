# SPDX-License-Identifier: GPL-3.0-or-later
# Which bed a method makes for its CPU time: union fraction less that of Merson's
# bed of the same seed against CPU time, one panel per variant. Bars: 95 %
# confidence of the mean over seeds, and the least and largest CPU time.
#   gnuplot -c plots/bench/bench.gp IN OUT
# IN: blocks of variants by methods.sh.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 4
height = 980
columns = "variant method seeds cpu_seconds cpu_least cpu_most difference ". \
  "interval"
call "style.gp" "bench/bench.gp IN OUT" ARG2 ARG1

methods = "allpairs merson dopri5 rkf45 rk8pd rkc verlet"
colour(m) = m eq "allpairs" ? grey : method_colour(m)
point(m) = m eq "allpairs" ? 2 : method_point(m)
name(m) = m eq "allpairs" ? "Merson, all pairs" : method_title(m)
# a later block begins with its names
interval(s) = s eq "-" || s eq "interval" ? 0 : real(s)

stats ARG1 using (abs(column("difference")) + interval(strcol("interval"))) \
  nooutput
high = STATS_max > 0.005 ? 1.1*STATS_max : 0.005
stats ARG1 using "cpu_least":"cpu_most" nooutput
cpu_low = 10**floor(log10(STATS_min_x))
cpu_high = 10**ceil(log10(STATS_max_y))
stats ARG1 index 0 using (strcol("method") eq "merson" ? column("seeds") : NaN) \
  nooutput
seeds = STATS_max
set logscale x
set xrange [cpu_low:cpu_high]
set yrange [-high:high]
set format x ""
set lmargin at screen 0.19
set arrow 1 from graph 0,first 0 to graph 1,first 0 nohead lw thin lc rgb black
set multiplot
top = 0.985
panel = 0.24
do for [b=0:2] {
  stats ARG1 index b using (variant = strcol("variant"), 0) nooutput
  set tmargin at screen top - b*(panel + 0.02)
  set bmargin at screen top - b*(panel + 0.02) - panel
  if (b == 2) {
    set format x "%h"
    set xlabel "CPU time for ".header(ARG1, "run")." (s)"
  }
  set ylabel b == 1 ? sprintf("union less Merson's, %d seeds", seeds) : ""
  set label 1 variant_title(variant) at graph 0.02,0.9 left
  plot for [m in methods] ARG1 index b \
    using (strcol("method") eq m ? column("cpu_seconds") : NaN): \
      "difference":"cpu_least":"cpu_most": \
      (column("difference") - interval(strcol("interval"))): \
      (column("difference") + interval(strcol("interval"))) \
    with xyerrorbars lw line pt point(m) ps 1.3*symbol lc rgb colour(m) \
    title name(m)
  unset key
}
unset multiplot
