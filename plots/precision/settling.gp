# SPDX-License-Identifier: GPL-3.0-or-later
# Error of the fraction of settled beds: of single beds with friction and
# rotation, of their mean, and of the mean without friction. Left: multirate, rkc
# and Verlet against CPU time, each marker with its tolerance or step; right: the
# embedded methods against their tolerance. An arrow is the upper limit of an error that
# the seeds cannot tell from zero; runs that failed are crosses at the top. The
# default of settle has a ring, the spread of seeds is a dashed line.
#   gnuplot -c plots/precision/settling.gp IN OUT
# IN: rows by panels.awk.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1370
columns = "panel side method setting seeds x y low high kind default"
call "style.gp" "precision/settling.gp IN OUT" ARG2 ARG1

bottom = 1e-6
top = 0.3
is(m, k) = strcol("panel") eq panel && strcol("side") eq side && \
  strcol("method") eq m && strcol("kind") eq k
# embedded methods beside each other
x(m) = column("x")*(side eq "left" ? 1 : m eq "merson" ? 0.8 : \
  m eq "rkf45" ? 1.25 : 1)
above(y) = y > 1.3*bottom ? y : 1.3*bottom

stats ARG1 using (strcol("side") eq "left" ? column("x") : NaN) nooutput
cpu_low = 0.5*STATS_min
cpu_high = 4*STATS_max
# so that gnuplot says nothing of curves without points
set datafile missing "none"
set logscale xy
set yrange [bottom:top]
set ytics 100
set mytics 1
set xtics 10
panels = "single mean plain"
headings = "'single beds, friction and rotation' ". \
  "'mean, friction and rotation' 'mean, no friction'"
high = 0.254
unset key
set multiplot
do for [p=1:3] {
  panel = word(panels, p)
  set tmargin at screen 0.985 - (p - 1)*(high + 0.02)
  set bmargin at screen 0.985 - (p - 1)*(high + 0.02) - high
  spread = real(header(ARG1, "spread_".panel))
  set arrow 1 from graph 0,first spread to graph 1,first spread nohead dt 2 \
    lw 1.5*thin lc rgb grey
  do for [side in "left right"] {
    left = side eq "left"
    set lmargin at screen left ? 0.16 : 0.69
    set rmargin at screen left ? 0.67 : 0.965
    set xrange [left ? cpu_low : 0.03:left ? cpu_high : 40]
    set format x p < 3 ? "" : left ? "%h" : "%h"
    set xlabel p < 3 ? "" : left ? "CPU time for ".header(ARG1, "run")." (s)" \
      : "tolerance {/:Italic δ} (m/s^2)"
    set format y left ? "10^{%T}" : ""
    set ylabel !left ? "" : p == 1 ? "rms error of union" : "error of mean union"
    label = left ? word(headings, p) : header(ARG1, "cost_".panel)
    place = left ? 0.07 : 0.93
    set label 1 label at graph 0.03,place left
    methods = left ? "multirate rkc verlet" : "merson dopri5 rkf45"
    if (p == 3 && !left) {
      set key at screen 0.5,0.005 center bottom vertical maxrows 5 width -1
    }
    plot for [m in methods] ARG1 using (is(m, "limit") ? x(m) : NaN):"y":(0): \
        (-0.7*column("y")) with vectors filled head lw 1.5*thin \
        lc rgb method_colour(m) notitle, \
      for [m in methods] ARG1 using (is(m, "point") ? x(m) : NaN): \
        (above(column("y"))):(above(column("low"))):(above(column("high"))) \
        with yerrorbars lw thin pt 0 lc rgb method_colour(m) notitle, \
      for [m in methods] ARG1 using (is(m, "point") ? x(m) : NaN): \
        (above(column("y"))) with linespoints lw line pt method_point(m) \
        ps symbol lc rgb method_colour(m) notitle, \
      for [m in methods] ARG1 using (is(m, "failed") ? x(m) : NaN):(top/2) \
        with points pt 2 ps 1.6*symbol lw line lc rgb method_colour(m) \
        notitle, \
      for [m in left && p == 1 ? "rkc verlet" : ""] ARG1 using (is(m, "point") ? \
        x(m) : NaN):(above(column("y"))):(strcol("setting")) with labels left \
        offset 0.8,0.6 font ",16" tc rgb method_colour(m) notitle, \
      for [m in left && p == 1 ? "multirate" : ""] ARG1 using (is(m, "point") ? \
        x(m) : NaN):(above(column("y"))):(strcol("setting") eq "5e-4" ? "" : \
        strcol("setting")) with labels right offset -1.8,0 font ",16" \
        tc rgb method_colour(m) notitle, \
      for [m in left && p == 1 ? "multirate" : ""] ARG1 using (is(m, "point") && \
        strcol("setting") eq "5e-4" ? x(m) : NaN):(above(column("y"))): \
        (strcol("setting")) with labels center offset 0,-1.3 font ",16" \
        tc rgb method_colour(m) notitle, \
      for [m in left && p == 3 ? "verlet" : ""] ARG1 using (is(m, "point") || \
        is(m, "limit") ? x(m) : NaN):(above(column("high"))): \
        (strcol("setting")) with labels left rotate by 90 offset 0,0.4 \
        font ",16" tc rgb method_colour(m) notitle, \
      for [m in left && p == 3 ? "rkc" : ""] ARG1 using \
        (is(m, "point") || is(m, "limit") ? x(m) : NaN):(0.25*column("y")):(strcol("setting")) with labels right \
        rotate by 90 font ",16" tc rgb method_colour(m) notitle, \
      for [m in left ? "multirate" : ""] ARG1 using (column("default") == 1 && \
        (is(m, "point") || is(m, "limit")) ? x(m) : NaN): \
        (above(column("y"))) with points pt 6 ps 2.6*symbol lw line \
        lc rgb black notitle, \
      for [m in "multirate rkc verlet merson dopri5 rkf45"] keyentry with linespoints \
        lw line pt method_point(m) ps symbol lc rgb method_colour(m) \
        title method_title(m).", ".header(ARG1, "seeds_".m), \
      keyentry with points pt 6 ps 2.6*symbol lw line lc rgb black \
        title "settle's default", \
      keyentry with vectors filled head lw 1.5*thin lc rgb black \
        title "upper limit", \
      keyentry with lines dt 2 lw 1.5*thin lc rgb grey title "spread of seeds"
  }
}
unset multiplot
