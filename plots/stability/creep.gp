# SPDX-License-Identifier: GPL-3.0-or-later
# Speed of a sphere that friction holds on a slope, as share of vmin, beside the
# closed form 3 s^2 - 2 s^3 = T/(phi F) and the limit that counts as rest. Bars: extremes over half a second.
#   gnuplot -c plots/stability/creep.gp IN OUT
# IN: columns method share measured least most.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 600
columns = "method share measured least most"
call "style.gp" "stability/creep.gp IN OUT" ARG2 ARG1

methods = "merson dopri5 rkf45 rkck rk8pd rkc verlet"
shift(i) = 0.009*(i - 4)
set xlabel "pull by the most that friction holds, {/:Italic T}/({/:Italic φF})"
set ylabel "speed along the slope by {/:Italic v}_{min}"
set xrange [-0.02:1.02]
set yrange [-0.3:1.5]
set parametric
set trange [0:1]
of(m) = strcol("method") eq m && column("share") < 1
# what is beyond the chart is drawn at its edge
edge(v) = v > 1.5 ? 1.5 : v < -0.3 ? -0.3 : v
plot 3*t**2 - 2*t**3, t with lines lw 3*thin lc rgb black \
    title "exact", \
  t, 1 with lines lw 2*thin dt 2 lc rgb grey title "rest", \
  for [i=1:words(methods)] ARG1 using (of(word(methods, i)) ? \
    column("share") + shift(i) : NaN):(edge(column("measured"))): \
    (edge(column("least"))):(edge(column("most"))) with yerrorbars \
    lw line pt method_point(word(methods, i)) ps symbol \
    lc rgb method_colour(word(methods, i)) title method_title(word(methods, i))
