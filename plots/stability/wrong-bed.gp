# SPDX-License-Identifier: GPL-3.0-or-later
# The fraction of beds with friction less that of a sharp run of the same seed:
# against a fixed step, above the share of the contacts' force whose slip that
# step makes oscillate; and against the tolerance of adaptive methods, left rkc
# and multirate, right the embedded ones, whose units differ.
#   gnuplot -c plots/stability/wrong-bed.gp IN SLIP OUT
# IN: blocks by ../precision/settling.awk; SLIP: columns step and share by
# slip.awk.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1080
columns = ""
call "style.gp" "stability/wrong-bed.gp IN SLIP OUT" ARG3 ARG1 ARG2

stats ARG1 using (blocks = column(-2) + 1) nooutput
array method[blocks]
fixed = chebyshev = embedded = seen = ""
do for [b=1:blocks] {
  stats ARG1 index b-1 using (method[b] = word(strcol("method"), 1), \
    step = strcol("step"), 0) nooutput
  number = sprintf(" %d", b)
  seen = seen." ".method[b]
  if (step ne "-") {
    fixed = fixed.number
  } else {
    if (method[b] eq "rkc" || method[b] eq "multirate") {
      chebyshev = chebyshev.number
    } else {
      embedded = embedded.number
    }
  }
}
ci(i) = strcol("interval") eq "nan" ? 0 : column("interval")
# beside each other where methods have the same tolerance
beside(i, n) = 1.09**(i - 0.5*n - 0.5)
good(name) = strcol("status") eq "ok" || strcol("status") eq "reference" ? \
  column(name) : NaN
difference(i) = strcol("status") eq "reference" ? 0 : column("difference")
nth(list, i) = int(word(list, i))
# a range that holds all bars, the same for panels of the same thing
bar(adaptive) = strcol("status") eq "ok" && \
  (strcol("step") eq "-") == adaptive ? abs(column("difference")) + ci(0) : NaN
stats ARG1 using (bar(1)) nooutput
half = STATS_max > 0.012 ? 1.05*STATS_max : 0.013
stats ARG1 using (bar(0)) nooutput
high = STATS_max > 0.05 ? 1.05*STATS_max : 0.055
stats ARG1 using (strcol("status") eq "ok" && strcol("step") ne "-" ? \
  column("difference") - ci(0) : NaN) nooutput
low = STATS_min < -0.005 ? 1.05*STATS_min : -0.005

set logscale x
set lmargin at screen 0.2
set format y "%h"
set key off
set multiplot
set tmargin at screen 0.98
set bmargin at screen 0.68
set xrange [1e-5:2e-3]
set yrange [low:high]
set ytics autofreq
set format x ""
set ylabel "union less that of\na sharp run" offset -0.5,0
set arrow 1 from graph 0,first 0 to graph 1,first 0 nohead lw thin lc rgb black
plot for [i=1:words(fixed)] ARG1 index nth(fixed, i)-1 using (good("step")): \
    (difference(0)):(ci(0)) with yerrorbars lw thin \
    pt method_point(method[nth(fixed, i)]) ps symbol \
    lc rgb method_colour(method[nth(fixed, i)]), \
  for [i=1:words(fixed)] ARG1 index nth(fixed, i)-1 using (good("step")): \
    (difference(0)) with linespoints lw line \
    pt method_point(method[nth(fixed, i)]) ps symbol \
    lc rgb method_colour(method[nth(fixed, i)])
unset arrow 1
set tmargin at screen 0.665
set bmargin at screen 0.525
set yrange [0:1]
set ytics 0.5
set format x "10^{%T}"
set format y "%h"
set xlabel "fixed step (s)"
set ylabel "force in\nunstable slip" offset -0.5,0
plot ARG2 using "step":"share" with lines lw line lc rgb grey
set arrow 1 from graph 0,first 0 to graph 1,first 0 nohead lw thin lc rgb black
set tmargin at screen 0.42
set bmargin at screen 0.205
set yrange [-half:half]
if (half < 0.03) { set ytics 0.01 } else { set ytics autofreq }
set format y "%h"
set xtics 10
set ylabel "union less that of\na sharp run" offset -0.5,0
do for [p=1:2] {
  list = p == 1 ? chebyshev : embedded
  set lmargin at screen p == 1 ? 0.2 : 0.63
  set rmargin at screen p == 1 ? 0.60 : 0.965
  set xrange [p == 1 ? 5e-5 : 5e-3:p == 1 ? 2 : 20]
  set xlabel p == 1 ? "tolerance (m/s)" : "{/:Italic δ} (m/s^2)"
  if (p == 2) {
    unset ylabel
    set format y ""
    set key on at screen 0.5,0.005 center bottom vertical maxrows 3 width -1
  }
  plot for [i=1:words(list)] ARG1 index nth(list, i)-1 using \
      (good("tol")*beside(i, words(list))):(difference(0)):(ci(0)) \
      with yerrorbars lw thin pt method_point(method[nth(list, i)]) \
      ps symbol lc rgb method_colour(method[nth(list, i)]) notitle, \
    for [i=1:words(list)] ARG1 index nth(list, i)-1 using \
      (good("tol")*beside(i, words(list))):(difference(0)) with linespoints \
      lw line pt method_point(method[nth(list, i)]) ps symbol \
      lc rgb method_colour(method[nth(list, i)]) notitle, \
    for [m in "merson dopri5 rkf45 rkck rk8pd rkc multirate verlet"] keyentry \
      with linespoints lw line pt method_point(m) ps symbol \
      lc rgb method_colour(m) \
      title strstrt(seen." ", " ".m." ") > 0 ? method_title(m) : ""
}
unset multiplot
