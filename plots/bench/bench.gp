# SPDX-License-Identifier: GPL-3.0-or-later
# CPU time of a bed by method (left), and the bed that it buys: the union
# fraction less that of Merson's bed of the same seed (right); a row per method,
# a panel per variant. Bars: least and largest CPU time; 95 % confidence of the
# mean over seeds.
#   gnuplot -c plots/bench/bench.gp IN OUT
# IN: blocks of variants by methods.sh.
set loadpath system("dirname '".ARG0."'")."/.."
height = 900
columns = "variant method seeds cpu_seconds cpu_least cpu_most difference ". \
  "interval"
call "style.gp" "bench/bench.gp IN OUT" ARG2 ARG1

methods = "multirate rkc verlet merson rkf45 dopri5 rk8pd allpairs"
colour(m) = m eq "allpairs" ? grey : method_colour(m)
point(m) = m eq "allpairs" ? 2 : method_point(m)
# a later block begins with its names
interval(s) = s eq "-" || s eq "interval" ? 0 : real(s)
set datafile missing "none"

stats ARG1 using (abs(column("difference")) + interval(strcol("interval"))) \
  nooutput
half = STATS_max > 0.005 ? 1.1*STATS_max : 0.005
stats ARG1 using "cpu_least":"cpu_most" nooutput
cpu_low = 10**floor(log10(STATS_min_x))
cpu_high = 10**ceil(log10(STATS_max_y))
stats ARG1 index 0 using (strcol("method") eq "rkc" ? column("seeds") : NaN) \
  nooutput
seeds = sprintf("%d seeds", STATS_max)
array variant[3]
do for [b=1:3] {
  stats ARG1 index b-1 using (variant[b] = strcol("variant"), 0) nooutput
}
set yrange [words(methods) + 0.6:0.4]
set ytics 1
set format y ""
unset key
set multiplot
high = 0.265
do for [b=0:2] {
  set tmargin at screen 0.955 - b*(high + 0.025)
  set bmargin at screen 0.955 - b*(high + 0.025) - high
  do for [side=1:2] {
    set lmargin at screen side == 1 ? 0.29 : 0.665
    set rmargin at screen side == 1 ? 0.625 : 0.965
    unset arrow
    unset label
    if (side == 1) {
      set logscale x
      set xrange [cpu_low:cpu_high]
      set xtics 10
      do for [i=1:words(methods)] {
        m = word(methods, i)
        name = m eq "allpairs" ? "Merson, all pairs" : method_title(m)
        set label i name at graph -0.05,first i right
      }
      set label 9 variant_title(variant[b+1]) at screen 0.035,graph 0.5 center \
        rotate by 90
    } else {
      unset logscale x
      set xrange [-half:half]
      set xtics 10**floor(log10(half))*(half/10**floor(log10(half)) > 4 ? 2 : 1)
      set arrow 1 from 0,graph 0 to 0,graph 1 nohead lw thin lc rgb black
    }
    set format x b == 2 ? "%h" : ""
    set xlabel b < 2 ? "" : side == 1 ? "CPU time (s)" : "union less Merson's"
    set title b > 0 ? "" : side == 1 ? header(ARG1, "run") : seeds \
      offset 0,-0.8
    plot for [i=1:words(methods)] m = word(methods, i) ARG1 index b using \
      (strcol("method") eq m ? (side == 1 ? column("cpu_seconds") : \
        column("difference")) : NaN):(i): \
      (side == 1 ? column("cpu_least") : \
        column("difference") - interval(strcol("interval"))): \
      (side == 1 ? column("cpu_most") : \
        column("difference") + interval(strcol("interval"))) \
      with xerrorbars lw line pt point(m) ps 1.2*symbol lc rgb colour(m)
  }
}
unset multiplot
