# SPDX-License-Identifier: GPL-3.0-or-later
# The order that is left of methods by the smoothness of the contact's law: error
# of the gap after a collision against the fixed step, one panel per law, on the
# same axes. The grey lines are of the same order in all.
#   gnuplot -c plots/precision/contrast.gp IN1 IN2 IN3 IN4 OUT
# IN: blocks by method, columns method, step, error_gap and status.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 860
columns = "method step error_gap status"
call "style.gp" "precision/contrast.gp IN1 IN2 IN3 IN4 OUT" \
  ARG5 ARG1 ARG2 ARG3 ARG4

titles = "'exponential, e = 1' 'exponential, e = 0.4' 'linear spring, e = 1' ". \
  "'Walton and Braun, e = 0.4'"
methods = "merson dopri5 rkf45 rkck rk8pd rkc verlet"
good(m) = strcol("method") eq m && strcol("status") eq "ok" && \
  column("error_gap") > 0
set logscale xy
set xrange [1e-5:1e-2]
set yrange [1e-15:1]
set xtics (1e-4, 1e-3)
set ytics 1000
set mytics 1
guide(order) = order == 2 ? 0.5 : order == 5 ? 4e7 : 1e14
unset key
set multiplot
do for [p=1:4] {
  row = (p - 1)/2
  across = (p - 1)%2
  set lmargin at screen 0.18 + 0.405*across
  set rmargin at screen 0.18 + 0.405*across + 0.38
  set tmargin at screen 0.955 - 0.40*row
  set bmargin at screen 0.955 - 0.40*row - 0.345
  set format x row == 1 ? "10^{%T}" : ""
  set format y across == 0 ? "10^{%T}" : ""
  set xlabel row == 1 ? "step (s)" : ""
  set ylabel across == 0 ? "error of gap (m)" : ""
  set title word(titles, p) offset 0,-0.7
  unset label
  if (p > 2) {            # where there are no curves
    set label 1 "order 2" at 1.3e-5,1e-11 left tc rgb grey
    set label 2 "order 5" at 9e-5,1e-12 right tc rgb grey
    set label 3 "order 8" at 5.5e-4,2e-14 left tc rgb grey
  }
  if (p == 4) {
    set key at screen 0.5,0.005 center bottom vertical maxrows key_rows
  }
  in = value("ARG".p)
  plot for [o=2:8:3] guide(o)*x**o with lines \
      lw 1.5*thin dt 2 lc rgb grey notitle, \
    for [m in methods] in using (good(m) ? column("step") : NaN):"error_gap" \
      with linespoints lw line pt method_point(m) ps symbol \
      lc rgb method_colour(m) title method_title(m)
}
unset multiplot
