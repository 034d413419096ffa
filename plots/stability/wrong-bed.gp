# SPDX-License-Identifier: GPL-3.0-or-later
# The fraction of beds with friction less that of a sharp run of the same seed:
# against a fixed step, with the share of the contacts' force whose slip that
# step makes oscillate; and against the tolerance of adaptive methods.
#   gnuplot -c plots/stability/wrong-bed.gp IN SLIP OUT
# IN: blocks by ../precision/settling.awk; SLIP: columns step and share by
# slip.awk.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 4
height = 1000
columns = ""
call "style.gp" "stability/wrong-bed.gp IN SLIP OUT" ARG3 ARG1 ARG2

stats ARG1 using (blocks = column(-2) + 1) nooutput
array method[blocks]
array fixed[blocks]
steps = tolerances = ""
do for [b=1:blocks] {
  stats ARG1 index b-1 using (method[b] = strcol("method"), \
    fixed[b] = strcol("step") ne "-", 0) nooutput
  if (fixed[b]) { steps = steps.sprintf(" %d", b) }
  if (!fixed[b]) { tolerances = tolerances.sprintf(" %d", b) }
}
of(list, i) = i > words(list) ? 1 : int(word(list, i))
ci(i) = strcol("interval") eq "nan" ? 0 : column("interval")
good(name) = strcol("status") eq "ok" || strcol("status") eq "reference" ? \
  column(name) : NaN
d(i) = strcol("status") eq "reference" ? \
  0 : column("difference")

set logscale x
set lmargin at screen 0.18
set rmargin at screen 0.85
set ylabel "union less that of a sharp run"
set yrange [-0.015:0.055]
set ytics 0.02
set format y "%.2f"
set format x "10^{%T}"
set multiplot
set tmargin at screen 0.975
set bmargin at screen 0.62
set xrange [1e-5:2e-3]
set xlabel "fixed step (s)"
set y2label "share of unstable slip" offset -0.5,0
set y2range [-0.015/0.055:1]
set y2tics 0,0.5,1 nomirror
set ytics nomirror
set arrow from graph 0,first 0 to graph 1,first 0 nohead lw thin lc rgb black
plot ARG2 using "step":"share" axes x1y2 with lines lw line dt 2 lc rgb grey \
    title "share of unstable slip", \
  for [i=1:words(steps)] ARG1 index of(steps, i)-1 using (good("step")): \
    (d(0)):(ci(0)) with yerrorbars lw thin pt method_point(method[of(steps, i)]) \
    ps symbol lc rgb method_colour(method[of(steps, i)]) notitle, \
  for [i=1:words(steps)] ARG1 index of(steps, i)-1 using (good("step")): \
    (d(0)) with linespoints lw line pt method_point(method[of(steps, i)]) \
    ps symbol lc rgb method_colour(method[of(steps, i)]) notitle, \
  for [m in "merson dopri5 rkf45 rkck rk8pd rkc verlet"] keyentry \
    with linespoints lw line pt method_point(m) ps symbol \
    lc rgb method_colour(m) title method_title(m)
unset key
unset y2label
unset y2tics
set tmargin at screen 0.53
set bmargin at screen 0.22
set xrange [5e-5:20]
set yrange [-0.013:0.013]
set ytics 0.01
set xlabel "tolerance ({/:Italic δ} in m/s^2; RKC in m/s)"
plot for [i=1:words(tolerances)] ARG1 index of(tolerances, i)-1 using \
    (good("tol")):(d(0)):(ci(0)) with yerrorbars lw thin \
    pt method_point(method[of(tolerances, i)]) ps symbol \
    lc rgb method_colour(method[of(tolerances, i)]), \
  for [i=1:words(tolerances)] ARG1 index of(tolerances, i)-1 using \
    (good("tol")):(d(0)) with linespoints lw line \
    pt method_point(method[of(tolerances, i)]) ps symbol \
    lc rgb method_colour(method[of(tolerances, i)])
unset multiplot
