# SPDX-License-Identifier: GPL-3.0-or-later
# Fraction of the bed against the CPU time it took, by method: a fast run with a
# wrong bed shows as such. One panel a variant.
#   gnuplot -c plots/bench/bench.gp IN OUT
# IN: blocks of variants, columns variant, method, cpu_seconds, union,
# standard_error.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 4
height = 960
columns = "variant method cpu_seconds union standard_error"
call "style.gp" "bench/bench.gp IN OUT" ARG2 ARG1

methods = "allpairs merson dopri5 rkf45 rk8pd rkc verlet"
colour(m) = m eq "allpairs" ? grey : method_colour(m)
point(m) = m eq "allpairs" ? 2 : method_point(m)
name(m) = m eq "allpairs" ? "Merson, all pairs" : method_title(m)
error(s) = s eq "-" ? 0 : real(s)

set logscale x
set xrange [0.1:500]
set format x ""
set format y "%.3f"
set lmargin at screen 0.19
step(v) = v eq "basic" ? 0.004 : v eq "friction" ? 0.02 : 0.004
set multiplot
top = 0.975
panel = 0.235
do for [b=0:2] {
  stats ARG1 index b using (variant = strcol("variant"), 0) nooutput
  set tmargin at screen top - b*(panel + 0.02)
  set bmargin at screen top - b*(panel + 0.02) - panel
  if (b == 2) {
    set format x "%h"
    set xlabel "CPU time for ".header(ARG1, "run")." (s)"
  }
  set ylabel b == 1 ? "union fraction" : ""
  set ytics step(variant)
  set label 1 variant_title(variant) at graph 0.98,0.88 right
  set offsets 0,0,graph 0.1,graph 0.1
  plot for [m in methods] ARG1 index b \
    using (strcol("method") eq m ? column("cpu_seconds") : NaN): \
      "union":(error(strcol("standard_error"))) \
    with yerrorbars lw line pt point(m) ps 1.3*symbol lc rgb colour(m) \
    title name(m)
  unset key
}
unset multiplot
