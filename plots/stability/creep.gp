# SPDX-License-Identifier: GPL-3.0-or-later
# Speed of a sphere that friction holds on a slope, as share of vmin, beside the
# closed form 3 s^2 - 2 s^3 = T/(phi F): one panel per method. Bars: extremes
# over half a second; an arrow: beyond the chart.
#   gnuplot -c plots/stability/creep.gp IN OUT
# IN: columns method share measured least most.
set loadpath system("dirname '".ARG0."'")."/.."
height = 920
columns = "method share measured least most"
call "style.gp" "stability/creep.gp IN OUT" ARG2 ARG1

methods = "rkc verlet merson dopri5 rkf45 rkck rk8pd"
low = -0.3
high = 1.3
set xrange [-0.05:1.05]
set yrange [low:high]
set xtics 0.25
set ytics 0.5
set parametric
set trange [0:1]
# so that gnuplot says nothing of curves without points
set datafile missing "none"
of(m) = strcol("method") eq m && column("share") < 1
beyond(m) = of(m) && column("measured") > high
within(v) = v > high ? high : v < low ? low : v
unset key
set label 1 "speed along the slope / {/:Italic v}_{min}" \
  at screen 0.035,0.54 center rotate by 90
set label 2 "pull / most that friction holds, {/:Italic T}/({/:Italic φF})" \
  at screen 0.56,0.02 center
set multiplot
do for [i=1:words(methods)] {
  m = word(methods, i)
  row = (i - 1)/2
  across = (i - 1)%2
  set lmargin at screen 0.15 + 0.425*across
  set rmargin at screen 0.15 + 0.425*across + 0.39
  set tmargin at screen 0.985 - 0.228*row
  set bmargin at screen 0.985 - 0.228*row - 0.205
  set format x row == 3 || i == 6 ? "%h" : ""
  set format y across == 0 ? "%h" : ""
  set label 3 method_title(m) at graph 0.04,0.88 left
  if (i == words(methods)) {
    set key at screen 0.62,0.16 left top vertical maxrows 3
  }
  plot 3*t**2 - 2*t**3, t with lines lw 1.5*line lc rgb "#BBBBBB" \
      title "exact", \
    ARG1 using (of(m) ? column("share") : NaN):(within(column("measured"))): \
      (within(column("least"))):(within(column("most"))) with yerrorbars \
      lw line pt method_point(m) ps symbol lc rgb method_colour(m) \
      title "least, mean, most", \
    ARG1 using (beyond(m) ? column("share") : NaN):(high - 0.3):(0):(0.3) \
      with vectors head filled lw line lc rgb method_colour(m) notitle
  unset label 1
  unset label 2
}
unset multiplot
